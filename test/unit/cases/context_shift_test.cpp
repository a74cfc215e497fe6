#include "casepush/cases/context_shift.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "case_fixtures.h"

namespace casepush {
namespace {

const Eigen::Matrix3d kScatter = Eigen::Vector3d(1e-4, 4e-4, 1e-3).asDiagonal();

Case caseTo(const Pose2& mean, double count = 20.0) {
  Case push_case = recordedCase(1);
  push_case.start_outcome = {mean, kScatter};
  push_case.effective_count = count;
  return push_case;
}

/// Turns by 0.4 rad less for each metre to the left, and gets nine tenths as far.
Pose2 shifted(const Pose2& mean) {
  return {0.9 * mean.x(), 0.9 * mean.y(), mean.yaw() - 0.4 * mean.y()};
}

TEST(ContextShift, expectsNoChangeButLessCertaintyWhenNothingWasSeen) {
  const Case known = caseTo(Pose2(0.5, -0.3, 0.2));
  const Case guess = ContextShift().conjecture(known);
  expectSamePose(guess.start_outcome.mean, known.start_outcome.mean);
  EXPECT_LT(guess.effective_count, 1.0);
  const Eigen::Matrix3d more = guess.start_outcome.covariance - known.start_outcome.covariance;
  EXPECT_GT(more.eigenvalues().real().minCoeff(), 0.0);
  EXPECT_GT(std::sqrt(guess.start_outcome.covariance(2, 2)), 0.6 * 0.3);
}

TEST(ContextShift, learnsFromSomeCasesWhatHappensToOthers) {
  Random random(2);
  ContextShift shift;
  for (int i = 0; i < 12; ++i) {
    const Pose2 mean = randomPose(random, 0.4, 0.4);
    shift.add(caseTo(mean), caseTo(shifted(mean)));
  }
  for (int i = 0; i < 20; ++i) {
    const Pose2 mean = randomPose(random, 0.4, 0.4);
    const Pose2 truth = shifted(mean);
    const Case guess = shift.conjecture(caseTo(mean));
    EXPECT_LT(distance(guess.start_outcome.mean, truth), 0.015 + 0.03 * mean.position().norm());
    EXPECT_LT(std::abs(yawDifference(guess.start_outcome.mean, truth)), 0.03);
    EXPECT_LT(std::sqrt(guess.start_outcome.covariance(2, 2)), 0.25);
  }
}

TEST(ContextShift, oneCaseSaysMostAboutThoseLikeIt) {
  ContextShift shift;
  const Pose2 seen(0.0, 0.5, 0.0);
  shift.add(caseTo(seen), caseTo(shifted(seen)));
  const auto sigmaOfTurn = [&](const Pose2& mean) {
    return std::sqrt(shift.conjecture(caseTo(mean)).start_outcome.covariance(2, 2));
  };
  EXPECT_LT(sigmaOfTurn(Pose2(0.0, 0.5, 0.0)), 0.6 * sigmaOfTurn(Pose2(0.5, 0.0, 0.0)));
  const Case guess = shift.conjecture(caseTo(Pose2(0.0, 0.4, 0.3)));
  EXPECT_NEAR(guess.start_outcome.mean.yaw(), 0.3 - 0.4 * 0.4, 0.04);
}

/// The share of truths inside the 90 % regions of conjectures, over changes drawn from the prior.
TEST(ContextShift, isAsCertainAsItMayBe) {
  Random random(5);
  const ContextShiftOptions options;
  int inside = 0;
  constexpr int kRounds = 300;
  constexpr double kChiSquare90 = 6.251;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d weights;
    for (int axis = 0; axis < 3; ++axis) {
      const bool turns = axis == 2;
      const double per_m = turns ? options.yaw_per_m : options.position_per_m;
      weights.row(axis) << random.normal(per_m), random.normal(per_m),
          random.normal(turns ? options.yaw_per_rad : options.position_per_rad);
    }
    const auto truthOf = [&](const Pose2& mean) {
      const Eigen::Vector3d change = weights * Eigen::Vector3d(mean.x(), mean.y(), mean.yaw()) +
                                     Eigen::Vector3d(random.normal(options.unexplained_m),
                                                     random.normal(options.unexplained_m),
                                                     random.normal(options.unexplained_rad));
      return Pose2(mean.x() + change.x(), mean.y() + change.y(), mean.yaw() + change.z());
    };
    ContextShift shift;
    for (int i = 0; i < round % 6; ++i) {
      const Pose2 mean = randomPose(random, 0.4, 0.4);
      shift.add(caseTo(mean), caseTo(truthOf(mean)));
    }
    const Pose2 mean = randomPose(random, 0.4, 0.4);
    const Case guess = shift.conjecture(caseTo(mean));
    const Pose2 truth = truthOf(mean);
    const Eigen::Vector3d e = logSe2(guess.start_outcome.mean.inverse() * truth);
    inside += e.dot(guess.start_outcome.covariance.ldlt().solve(e)) < kChiSquare90 ? 1 : 0;
  }
  EXPECT_GT(inside, 0.88 * kRounds);
}

}  // namespace
}  // namespace casepush
