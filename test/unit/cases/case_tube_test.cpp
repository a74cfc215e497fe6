#include "casepush/cases/case_tube.h"

#include <Eigen/LU>
#include <vector>

#include "case_fixtures.h"
#include "casepush/cases/observed_push.h"

namespace casepush {
namespace {

constexpr int kSteps = 40;
const CovarianceFloor kFine{1e-6, 1e-6};

// A smooth push that ends across +-pi, at a share of its way.
Pose2 meanAt(double share) {
  return Pose2(0.0, 0.0, 2.8) * expSe2({0.7 * share, 0.1 * share, 0.8 * share});
}

Case pushCase(const CovarianceFloor& floor) {
  Case push_case = recordedCase(1, kSteps + 1);
  for (int i = 0; i <= kSteps; ++i) {
    push_case.steps[i].start_T_object = meanAt(static_cast<double>(i) / kSteps);
  }
  const OutcomeStatistics first = addObservation({}, meanAt(1.0), floor);
  push_case.start_outcome = first.start_outcome;
  push_case.tube = tubeFromOutcome(push_case.steps, push_case.start_outcome, floor);
  return push_case;
}

// The push done again: deviating more and more, with its own timing share -> share^power.
std::vector<Pose2> practised(const Eigen::Vector3d& deviation, double power) {
  std::vector<Pose2> path;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = std::pow(static_cast<double>(i) / kSteps, power);
    path.push_back(meanAt(share) * expSe2(share * deviation));
  }
  return path;
}

Case observed(const Case& push_case, const std::vector<Pose2>& path, const CovarianceFloor& floor) {
  return withObservation(push_case, path.back(), path, push_case.effective_count, floor);
}

TEST(CaseTube, ofOneTrialIsTheTrialWithTheFloor) {
  const Case push_case = pushCase({});
  ASSERT_EQ(push_case.tube.size(), push_case.steps.size());
  for (std::size_t i = 0; i < push_case.tube.size(); ++i) {
    EXPECT_LT(distance(push_case.tube[i].mean, push_case.steps[i].start_T_object), 1e-12);
    EXPECT_NEAR(push_case.tube[i].covariance(0, 0), 25e-6, 1e-12);
    EXPECT_NEAR(push_case.tube[i].covariance(2, 2), 1e-4, 1e-12);
  }
}

TEST(CaseTube, fromAnOutcomeEndsThereAndWidensWithTheWay) {
  const Case push_case = pushCase(kFine);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.01, 0.09).asDiagonal();
  const PoseGaussian outcome{push_case.start_outcome.mean * Pose2(0.1, 0.05, 0.1), covariance};
  const std::vector<PoseGaussian> tube = tubeFromOutcome(push_case.steps, outcome, kFine);
  expectSamePose(tube.front().mean, push_case.steps.front().start_T_object);
  expectSamePose(tube.back().mean, outcome.mean);
  EXPECT_EQ(tube.back().covariance, covariance);
  EXPECT_NEAR(tube[kSteps / 2].covariance(0, 0), 0.25 * 0.04, 1e-6) << "half of the deviation";
}

// Deviations that are the same at all times and timings that are equal: mean and covariance of each
// step have closed forms.
TEST(CaseTube, equalsClosedFormsWithEqualTiming) {
  Case push_case = pushCase(kFine);
  for (const double side_m : {0.02, -0.02}) {
    std::vector<Pose2> path;
    for (const CaseStep& step : push_case.steps) {
      path.push_back(step.start_T_object * Pose2(0.0, side_m, 0.0));
    }
    push_case = observed(push_case, path, kFine);
  }
  for (int i = 2; i + 2 <= kSteps; ++i) {
    const PoseGaussian& step = push_case.tube[i];
    const Pose2 error = meanAt(static_cast<double>(i) / kSteps).inverse() * step.mean;
    EXPECT_LT(error.position().norm(), 5e-3) << i;
    EXPECT_LT(std::abs(error.yaw()), 5e-3) << i;
    EXPECT_NEAR(step.covariance(1, 1), 2.0 * 4e-4 / 3.0, 3e-5) << i;
    EXPECT_LT(step.covariance(0, 0), 3e-5) << i;
  }
}

TEST(CaseTube, hardlySeesAnotherTiming) {
  Random random(3);
  Case push_case = pushCase(kFine);
  double unaligned_variance = 0.0;
  for (int k = 0; k < 19; ++k) {
    const std::vector<Pose2> path = practised(Eigen::Vector3d::Zero(), random.uniform(0.6, 1.6));
    unaligned_variance += (path[kSteps / 2].position() - meanAt(0.5).position()).squaredNorm() / 19;
    push_case = observed(push_case, path, kFine);
  }
  ASSERT_GT(std::sqrt(unaligned_variance), 0.05) << "step by step it would be uncertain";
  for (int i = 0; i <= kSteps; ++i) {
    const PoseGaussian& step = push_case.tube[i];
    EXPECT_LT(distance(step.mean, meanAt(static_cast<double>(i) / kSteps)), 0.02) << i;
    EXPECT_LT(std::sqrt(step.covariance.topLeftCorner<2, 2>().trace()), 0.015) << i;
  }
}

TEST(CaseTube, recoversASpreadThatGrowsAlongThePushInAnyTiming) {
  Random random(4);
  Case push_case = pushCase(kFine);
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3d deviation(0.0, random.normal(0.06), random.normal(0.1));
    push_case = observed(push_case, practised(deviation, random.uniform(0.7, 1.4)), kFine);
  }
  for (const int i : {kSteps / 4, kSteps / 2, 3 * kSteps / 4}) {
    const double share = static_cast<double>(i) / kSteps;
    const PoseGaussian& step = push_case.tube[i];
    EXPECT_LT(distance(step.mean, meanAt(share)), 0.02) << i;
    EXPECT_NEAR(std::sqrt(step.covariance(1, 1)), 0.06 * share, 0.012) << i;
    EXPECT_NEAR(std::sqrt(step.covariance(2, 2)), 0.1 * share, 0.02) << i;
  }
}

TEST(CaseTube, endsAtTheOutcomeAfterAnyHistory) {
  Random random(5);
  Case push_case = pushCase({});
  for (int k = 0; k < 30; ++k) {
    std::vector<Pose2> path = practised({0.0, random.normal(0.05), random.normal(0.1)}, 1.1);
    const Pose2 end = path.back();
    if (k % 3 == 0) {
      path.clear();
    }
    const double weight = k % 4 == 3 ? 2.0 : push_case.effective_count;
    push_case = withObservation(push_case, end, path, weight, {});
    ASSERT_EQ(push_case.tube.size(), push_case.steps.size());
    expectSamePose(push_case.tube.back().mean, push_case.start_outcome.mean);
    EXPECT_EQ(push_case.tube.back().covariance, push_case.start_outcome.covariance);
    for (const PoseGaussian& step : push_case.tube) {
      ASSERT_TRUE(isCovariance(step.covariance));
      ASSERT_GT(step.covariance.determinant(), 0.0);
    }
  }
}

TEST(CaseTube, bendsTheMeanWhenOnlyTheOutcomeIsKnown) {
  const Case push_case = pushCase(kFine);
  const Pose2 end = meanAt(1.0) * expSe2({0.0, 0.2, 0.0});
  const Case updated = withObservation(push_case, end, {}, 1.0, kFine);
  const Eigen::Vector3d middle = logSe2(meanAt(0.5).inverse() * updated.tube[kSteps / 2].mean);
  EXPECT_NEAR(middle.y(), 0.5 * 0.5 * 0.2, 1e-6) << "half weight, half of the way";
  expectSamePose(updated.tube.front().mean, push_case.tube.front().mean);
}

TEST(CaseTube, followsNewDynamicsAsTheOutcomeDoes) {
  Case push_case = pushCase({});
  push_case.effective_count = 20.0;
  const std::vector<Pose2> changed = practised({0.0, 0.3, 0.4}, 1.0);
  const Case adapted = withObservation(push_case, changed.back(), changed, 1.0, {});
  const double share = distance(adapted.tube[kSteps / 2].mean, meanAt(0.5)) /
                       distance(changed[kSteps / 2], meanAt(0.5));
  EXPECT_NEAR(share, 0.5, 0.1);
}

TEST(CaseTube, copesWithPathsOfAnyLength) {
  const Case push_case = pushCase({});
  for (const std::size_t length : {std::size_t{1}, std::size_t{2}, std::size_t{500}}) {
    std::vector<Pose2> path(length, Pose2(0.3, 0.1, 3.0));
    const Case updated = observed(push_case, path, {});
    EXPECT_EQ(updated.tube.size(), push_case.steps.size());
  }
  Case single = recordedCase(6, 1);
  single.tube = tubeFromOutcome(single.steps, single.start_outcome, {});
  single = observed(single, {Pose2(), Pose2(0.1, 0.0, 0.0)}, {});
  ASSERT_EQ(single.tube.size(), 1u);
  expectSamePose(single.tube[0].mean, single.start_outcome.mean);
}

}  // namespace
}  // namespace casepush
