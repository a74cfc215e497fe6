#include "casepush/cases/outcome_statistics.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <vector>

#include "case_fixtures.h"

namespace casepush {
namespace {

const CovarianceFloor kNoFloor{1e-9, 1e-9};

OutcomeStatistics learn(const std::vector<Pose2>& outcomes, const CovarianceFloor& floor) {
  OutcomeStatistics statistics;
  for (const Pose2& outcome : outcomes) {
    statistics = addObservation(statistics, outcome, floor);
  }
  return statistics;
}

// The oracle: mean by Gauss-Newton on the group, population covariance about it.
PoseGaussian batch(const std::vector<Pose2>& outcomes) {
  PoseGaussian result{outcomes.front(), Eigen::Matrix3d::Zero()};
  const auto count = static_cast<double>(outcomes.size());
  for (int iteration = 0; iteration < 50; ++iteration) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Pose2& outcome : outcomes) {
      sum += logSe2(result.mean.inverse() * outcome);
    }
    result.mean = result.mean * expSe2(sum / count);
  }
  for (const Pose2& outcome : outcomes) {
    const Eigen::Vector3d e = logSe2(result.mean.inverse() * outcome);
    result.covariance += e * e.transpose() / count;
  }
  return result;
}

// A push about 0.6 m long with strongly correlated scatter of 0.1 m and 0.2 rad.
std::vector<Pose2> pushOutcomes(Random& random, int count) {
  Eigen::Matrix3d root;
  root << 0.1, 0.0, 0.0, 0.05, 0.1, 0.0, 0.1, -0.1, 0.15;
  std::vector<Pose2> outcomes;
  for (int i = 0; i < count; ++i) {
    const double a = random.normal(1.0);
    const double b = random.normal(1.0);
    const Eigen::Vector3d noise(a, b, random.normal(1.0));
    outcomes.push_back(Pose2(0.5, 0.3, 0.4) * expSe2(root * noise));
  }
  return outcomes;
}

double smallestEigenvalue(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvalues().minCoeff();
}

TEST(AddObservation, equalsBatchStatisticsOnStraightData) {
  Random random(1);
  for (const double yaw : {0.0, 1.3, -2.9}) {
    std::vector<Pose2> outcomes;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int i = 0; i < 20; ++i) {
      const double x = 0.6 + random.normal(0.1);
      outcomes.emplace_back(x, random.normal(0.05), yaw);
      sum += outcomes.back().position();
      const OutcomeStatistics learnt = learn(outcomes, kNoFloor);
      const Eigen::Vector2d mean = sum / (i + 1.0);
      EXPECT_LT((learnt.start_outcome.mean.position() - mean).norm(), 1e-13);
      EXPECT_EQ(learnt.effective_count, i + 1.0);
      Eigen::Matrix2d map_covariance = Eigen::Matrix2d::Zero();
      for (const Pose2& outcome : outcomes) {
        const Eigen::Vector2d d = outcome.position() - mean;
        map_covariance += d * d.transpose() / (i + 1.0);
      }
      const Eigen::Matrix3d turn = adjointSe2({0.0, 0.0, yaw});
      const Eigen::Matrix3d turned = turn * learnt.start_outcome.covariance * turn.transpose();
      const Eigen::Matrix2d difference = turned.topLeftCorner<2, 2>() - map_covariance;
      EXPECT_LT(difference.norm(), 1e-14);
    }
  }
}

TEST(AddObservation, equalsBatchStatisticsOnPureRotation) {
  std::vector<Pose2> outcomes;
  for (const double yaw : {0.1, 0.5, -0.3, 0.9}) {
    outcomes.emplace_back(0.0, 0.0, yaw);
  }
  const PoseGaussian learnt = learn(outcomes, kNoFloor).start_outcome;
  EXPECT_NEAR(learnt.mean.yaw(), 0.3, 1e-15);
  EXPECT_NEAR(learnt.covariance(2, 2), 0.2, 1e-15);
}

TEST(AddObservation, isCloseToTheBatchOnTheGroup) {
  Random random(2);
  double relative_error = 0.0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<Pose2> outcomes = pushOutcomes(random, 20);
    const PoseGaussian learnt = learn(outcomes, kNoFloor).start_outcome;
    const PoseGaussian oracle = batch(outcomes);
    EXPECT_LT(logSe2(oracle.mean.inverse() * learnt.mean).norm(), 2e-3);
    relative_error +=
        (learnt.covariance - oracle.covariance).norm() / oracle.covariance.norm() / kRuns;
  }
  // What eq. 2 loses by leaving the past covariance in its old frame; the estimate itself scatters
  // by 30 % at 20 observations.
  EXPECT_LT(relative_error, 0.03);
}

TEST(AddObservation, followsTheFormulaOfTheMethod) {
  Random random(3);
  OutcomeStatistics past = learn(pushOutcomes(random, 4), kNoFloor);
  const Pose2 x(0.7, 0.1, 0.9);
  const OutcomeStatistics updated = addObservation(past, x, kNoFloor);
  const double t = 5.0;
  const Eigen::Vector3d e = logSe2(past.start_outcome.mean.inverse() * x);
  const Pose2 mean = past.start_outcome.mean * expSe2(e / t);
  const Eigen::Vector3d e_new = logSe2(mean.inverse() * x);
  const Eigen::Matrix3d sigma =
      ((t - 1.0) * past.start_outcome.covariance + e_new * e.transpose()) / t;
  EXPECT_LT(logSe2(mean.inverse() * updated.start_outcome.mean).norm(), 1e-14);
  EXPECT_LT((updated.start_outcome.covariance - sigma).norm(), 1e-14);
}

TEST(AddObservation, isRightAcrossPi) {
  Random random(4);
  std::vector<Pose2> ahead;
  std::vector<Pose2> across;
  for (int i = 0; i < 20; ++i) {
    const Pose2 scatter = randomPose(random, 0.05, 0.2);
    ahead.push_back(scatter);
    across.push_back(Pose2(0.0, 0.0, M_PI) * scatter);
  }
  const PoseGaussian a = learn(ahead, kNoFloor).start_outcome;
  const PoseGaussian b = learn(across, kNoFloor).start_outcome;
  EXPECT_LT(std::abs(yawDifference(b.mean, Pose2(0.0, 0.0, M_PI) * a.mean)), 1e-13);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-13);
  EXPECT_LT(b.covariance(2, 2), 0.1);
}

TEST(AddObservation, isInvariantUnderRigidTransformsOfTheStart) {
  Random random(5);
  for (int run = 0; run < 200; ++run) {
    const std::vector<Pose2> outcomes = pushOutcomes(random, 2 + run % 20);
    const Pose2 a_T_b(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0),
                      random.uniform(-M_PI, M_PI));
    std::vector<Pose2> moved;
    for (const Pose2& outcome : outcomes) {
      moved.push_back(a_T_b * outcome);
    }
    const PoseGaussian expected = transform(a_T_b, learn(outcomes, {}).start_outcome);
    const PoseGaussian learnt = learn(moved, {}).start_outcome;
    EXPECT_LT(logSe2(expected.mean.inverse() * learnt.mean).norm(), 1e-12);
    EXPECT_LT((expected.covariance - learnt.covariance).norm(), 1e-12);
  }
}

TEST(AddObservation, staysPositiveDefiniteAfterAnyHistory) {
  Random random(6);
  const CovarianceFloor floor;
  const Eigen::Vector3d scale(floor.position_m, floor.position_m, floor.yaw_rad);
  for (int run = 0; run < 300; ++run) {
    OutcomeStatistics statistics;
    const double spread = std::pow(10.0, random.uniform(-9.0, 1.0));
    for (int i = 0; i < 40; ++i) {
      const Pose2 outcome(random.normal(spread), 0.0,
                          random.chance(0.2) ? random.uniform(-M_PI, M_PI) : random.normal(spread));
      const double n = statistics.effective_count;
      statistics = n >= 1.0 && random.chance(0.5)
                       ? adapt(statistics, outcome, random.uniform(1.0, n), floor)
                       : addObservation(statistics, outcome, floor);
      const Eigen::Matrix3d& covariance = statistics.start_outcome.covariance;
      ASSERT_TRUE(isCovariance(covariance));
      ASSERT_EQ(covariance, covariance.transpose());
      const Eigen::Matrix3d scaled =
          scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
      ASSERT_GT(smallestEigenvalue(scaled), 1.0 - 1e-6);
    }
  }
}

TEST(AddObservation, firstObservationIsTheMeanWithTheFloorAsCovariance) {
  const OutcomeStatistics first = addObservation({}, {0.4, -0.2, 3.0}, {0.01, 0.02});
  expectSamePose(first.start_outcome.mean, {0.4, -0.2, 3.0});
  EXPECT_EQ(first.effective_count, 1.0);
  const Eigen::Matrix3d expected = Eigen::Vector3d(1e-4, 1e-4, 4e-4).asDiagonal();
  EXPECT_LT((first.start_outcome.covariance - expected).norm(), 1e-16);
}

TEST(AddObservation, floorDoesNotPileUp) {
  const CovarianceFloor floor;
  const OutcomeStatistics repeated = learn(std::vector<Pose2>(1000, Pose2(0.5, 0.1, 0.2)), floor);
  const Eigen::Matrix3d floor_covariance =
      Eigen::Vector3d(floor.position_m, floor.position_m, floor.yaw_rad).cwiseAbs2().asDiagonal();
  EXPECT_LT((repeated.start_outcome.covariance - floor_covariance).norm(), 1e-12);

  // Scatter of four floors: the excess is below three floors at first, and fades.
  Random random(7);
  std::vector<Pose2> outcomes;
  for (int i = 0; i < 200; ++i) {
    outcomes.push_back(randomPose(random, 4.0 * floor.position_m, 4.0 * floor.yaw_rad));
    const Eigen::Matrix3d excess = learn(outcomes, floor).start_outcome.covariance -
                                   learn(outcomes, kNoFloor).start_outcome.covariance;
    if (i >= 10) {
      EXPECT_LT(excess.trace(), 9.0 * floor_covariance.trace() / (i + 1.0)) << i;
    }
  }
}

TEST(RaiseToFloor, leavesWhatIsAboveAndIsIdempotent) {
  Random random(8);
  const CovarianceFloor floor{0.1, 0.2};
  for (int run = 0; run < 200; ++run) {
    Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 9; ++i) {
      root(i) = random.normal(0.2);
    }
    const Eigen::Matrix3d covariance = root * root.transpose();
    const Eigen::Matrix3d raised = raiseToFloor(covariance, floor);
    EXPECT_LT((raiseToFloor(raised, floor) - raised).norm(), 1e-13);
    EXPECT_GT(smallestEigenvalue(raised - covariance), -1e-13);
  }
  const Eigen::Matrix3d wide = Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal();
  EXPECT_EQ(raiseToFloor(wide, floor), wide);
}

TEST(Adapt, equalsAddObservationAtFullWeight) {
  Random random(9);
  const OutcomeStatistics past = learn(pushOutcomes(random, 10), {});
  const OutcomeStatistics a = adapt(past, {0.4, 0.3, 0.5}, 10.0, {});
  const OutcomeStatistics b = addObservation(past, {0.4, 0.3, 0.5}, {});
  expectSamePose(a.start_outcome.mean, b.start_outcome.mean);
  EXPECT_EQ(a.start_outcome.covariance, b.start_outcome.covariance);
  EXPECT_EQ(a.effective_count, 11.0);
}

// The robot's loop: test, weigh, adapt.
OutcomeStatistics testAndAdapt(const OutcomeStatistics& past, const Pose2& x, double scale_k) {
  const PredictionTest test = testPrediction(past, x, 0.01);
  AdaptationOptions options;
  options.scale_k = scale_k;
  const double weight = adaptationWeight(past, x, test.p_value, options);
  return adapt(past, x, weight, {});
}

TEST(Adapt, movesToNewDynamicsWithinThreeObservations) {
  Random random(10);
  std::vector<Pose2> outcomes;
  for (int i = 0; i < 20; ++i) {
    outcomes.push_back(randomPose(random, 0.04, 0.08));
  }
  const OutcomeStatistics learnt = learn(outcomes, {});
  const Pose2 changed(0.4, -0.1, 0.5);
  ASSERT_TRUE(testPrediction(learnt, changed, 0.01).rejected);

  OutcomeStatistics adapted = testAndAdapt(learnt, changed, 20.0);
  EXPECT_EQ(adapted.effective_count, 2.0);
  EXPECT_NEAR(distance(adapted.start_outcome.mean, changed),
              0.5 * distance(learnt.start_outcome.mean, changed), 0.01);
  EXPECT_FALSE(testPrediction(adapted, changed, 0.01).rejected);
  for (int i = 0; i < 2; ++i) {
    adapted = testAndAdapt(adapted, changed * randomPose(random, 0.02, 0.04), 20.0);
  }
  EXPECT_LT(distance(adapted.start_outcome.mean, changed),
            0.3 * distance(learnt.start_outcome.mean, changed));

  // Without the weight, three observations out of 23 hardly count.
  OutcomeStatistics stubborn = learnt;
  for (int i = 0; i < 3; ++i) {
    stubborn = addObservation(stubborn, changed, {});
  }
  EXPECT_GT(distance(stubborn.start_outcome.mean, changed),
            0.8 * distance(learnt.start_outcome.mean, changed));
}

TEST(Adapt, hardlyMovesOnConsistentObservations) {
  Random random(11);
  std::vector<Pose2> outcomes;
  for (int i = 0; i < 20; ++i) {
    outcomes.push_back(randomPose(random, 0.04, 0.08));
  }
  const OutcomeStatistics learnt = learn(outcomes, {});
  const Pose2& mean = learnt.start_outcome.mean;
  const Pose2 near = mean * Pose2(0.015, -0.01, 0.02);
  const OutcomeStatistics adapted = testAndAdapt(learnt, near, 20.0);
  EXPECT_GT(adapted.effective_count, 15.0);
  EXPECT_LT(distance(adapted.start_outcome.mean, mean), 0.08 * distance(near, mean));
}

TEST(AdaptationWeight, isBounded) {
  OutcomeStatistics past;
  const auto weight = [&](double p_value, double count) {
    past.effective_count = count;
    return adaptationWeight(past, {}, p_value, {});
  };
  EXPECT_EQ(weight(0.0, 15.0), 1.0);
  EXPECT_EQ(weight(1.0, 15.0), 15.0);
  EXPECT_EQ(weight(0.25, 15.0), 5.0);
  EXPECT_EQ(weight(1.0, 1.0), 1.0);
  EXPECT_EQ(weight(0.0, 0.1), 0.1) << "a past that is worth less is not made worth more";
}

TEST(AdaptationWeight, ofThePaperHardlyEverLetsThePastGo) {
  AdaptationOptions paper;
  paper.weight = pastWeightFromString("paper", "");
  OutcomeStatistics past;
  past.effective_count = 20.0;
  const auto weight = [&](const Pose2& x) { return adaptationWeight(past, x, 0.0, paper); };
  EXPECT_NEAR(weight({1.0, 0.0, 0.0}), 20.0 * 21.2, 1e-9);
  EXPECT_NEAR(weight({2.0, 0.0, M_PI / 3.0}), 0.25 * 20.0 * 21.2, 1e-9);
  EXPECT_EQ(weight({2.0, 0.0, 2.0}), 0.0)
      << "the sign of the printed formula flips past 90 degrees";
  const Pose2 changed(0.4, -0.1, 0.5);
  EXPECT_GT(distance(adapt(past, changed, weight(changed), {}).start_outcome.mean, changed), 0.4);
}

TEST(AdaptationOptions, areChecked) {
  EXPECT_EQ(inputErrorOf([] { pastWeightFromString("none", "--weight"); }),
            "--weight: is 'none'; must be bounded or paper");
  AdaptationOptions options;
  options.scale_k = 0.0;
  EXPECT_NE(inputErrorOf([&] { options.validate(); }).find("adaptation: scale_k: is 0"),
            std::string::npos);
}

TEST(OutcomeStatistics, refusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(inputErrorOf([&] {
              addObservation({}, {nan, 0.0, 0.0}, {});
            }),
            "observed outcome: is not finite");
  EXPECT_EQ(inputErrorOf([&] {
              testPrediction({}, {0.0, 0.0, nan}, 0.01);
            }),
            "observed outcome: is not finite");
  EXPECT_NE(inputErrorOf([&] {
              addObservation({}, {}, {0.0, 0.1});
            }).find("covariance floor: position_m: is 0"),
            std::string::npos);
  EXPECT_NE(inputErrorOf([&] {
              addObservation({}, {}, {0.1, nan});
            }).find("yaw_rad"),
            std::string::npos);
}

}  // namespace
}  // namespace casepush
