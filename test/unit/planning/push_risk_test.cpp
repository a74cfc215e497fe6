#include "planning/push_risk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/common/input_error.h"
#include "casepush/model/plan_scatter.h"
#include "planning/furnished_room.h"
#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

class PushRiskTest : public testing::Test {
 protected:
  void setUp(const WorldModel& world, std::vector<Case> cases, const RiskOptions& options = {}) {
    map_ = mapOf(world);
    collisions_ = std::make_unique<CollisionChecker>(*map_);
    object_ = collisions_->footprint(chair_.solid);
    cases_ = std::move(cases);
    prepared_ = prepareCases(cases_, 0.0, 0.025, chair_.radius_m, robot_.radius_m);
    checker_ = std::make_unique<PushChecker>(
        *collisions_, PushChecker::Body{object_, chair_.radius_m},
        PushChecker::Body{collisions_->footprint(robot_.solid), robot_.radius_m});
    std::vector<const Case*> cases_of_risk;
    for (const Case& each : cases_) cases_of_risk.push_back(&each);
    risk_ =
        std::make_unique<PushRisk>(std::move(cases_of_risk), prepared_, checker_.get(), options);
  }

  Eigen::Vector3d normal() {
    return {random_.normal(1.0), random_.normal(1.0), random_.normal(1.0)};
  }

  /// Share of random outcomes, from a start that scatters, at which the object collides, or its
  /// whole push from there does.
  double drawn(int push, const Pose2& start, const Eigen::Matrix3d& start_covariance) {
    constexpr int kDraws = 1500;
    const Eigen::Matrix3d start_root = covarianceRoot(start_covariance);
    const Eigen::Matrix3d root = covarianceRoot(cases_[push].start_outcome.covariance);
    int hits = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Pose2 from = start * expSe2(start_root * normal());
      const Pose2 to = from * cases_[push].start_outcome.mean * expSe2(root * normal());
      hits += !checker_->isFree(to) || !checker_->isSafe(prepared_[push], from) ? 1 : 0;
    }
    return static_cast<double>(hits) / kDraws;
  }

  Random random_{1};
  ObjectModel chair_ = testChair();
  RobotModel robot_ = testRobot();
  std::shared_ptr<const Map> map_;
  std::unique_ptr<CollisionChecker> collisions_;
  std::shared_ptr<const Footprint> object_;
  std::vector<Case> cases_;
  std::vector<PreparedCase> prepared_;
  std::unique_ptr<PushChecker> checker_;
  std::unique_ptr<PushRisk> risk_;
};

TEST_F(PushRiskTest, isThatOfAWallAtTheOutcome) {
  // The base's edge ends up 0.06 m from a wall, two standard deviations: 2.3 %.
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("wall", 6.5, 5.0, 0.2, 6.0, 1.0));
  SyntheticPushOptions options;
  options.yaw_sigma_rad = 1e-6;
  setUp(world, {syntheticPush(1, 0.0, 2.0, 0.0, options)});
  const Pose2 start(6.4 - 0.06 - 0.30 - 0.6, 5.0, 0.0);
  EXPECT_NEAR(risk_->collisionProbability(0, start, Eigen::Matrix3d::Zero()), 0.023, 0.008);
  EXPECT_EQ(risk_->collisionProbability(0, Pose2(4.0, 5.0, 0.0), Eigen::Matrix3d::Zero()), 0.0);
  EXPECT_EQ(risk_->collisionProbability(0, Pose2(5.8, 5.0, 0.0), Eigen::Matrix3d::Zero()), 1.0);
}

TEST_F(PushRiskTest, isNearTheShareOfDrawnPushes) {
  setUp(furnishedRoom(), syntheticPushes(6, 5));
  double estimated = 0.0;
  double drawn_share = 0.0;
  int compared = 0;
  while (compared < 60) {
    const Pose2 start = randomFreePose(*collisions_, *object_, &random_);
    const int push = static_cast<int>(random_.below(cases_.size()));
    const Eigen::Matrix3d scatter = risk_->startCovariance({compared % 6});
    const double probability = risk_->collisionProbability(push, start, scatter);
    if (probability == 0.0 || probability == 1.0) continue;
    const double share = drawn(push, start, scatter);
    EXPECT_NEAR(probability, share, 0.12) << "push " << push;
    estimated += probability / 60.0;
    drawn_share += share / 60.0;
    ++compared;
  }
  EXPECT_NEAR(estimated, drawn_share, 0.15 * drawn_share);
}

TEST_F(PushRiskTest, growsWithTheScatterOfThePushesBefore) {
  RiskOptions options;
  options.horizon = 3;
  setUp(emptyRoom(), syntheticPushes(6, 5), options);
  EXPECT_TRUE(risk_->startCovariance({}).isZero(0.0));
  EXPECT_EQ(risk_->startCovariance({4}), cases_[4].start_outcome.covariance);
  const Eigen::Matrix3d both =
      compound({Pose2(), cases_[2].start_outcome.covariance}, cases_[4].start_outcome).covariance;
  EXPECT_LT((risk_->startCovariance({4, 2}) - both).norm(), 1e-12);
  EXPECT_LT((risk_->startCovariance({4, 2, 1, 0}) - both).norm(), 1e-12) << "beyond the horizon";
}

TEST_F(PushRiskTest, comparesWithThePlanUntilItIsChanged) {
  setUp(emptyRoom(), syntheticPushes(6, 5));
  EXPECT_TRUE(risk_->driftedCovariance({}).isZero(0.0));
  EXPECT_EQ(risk_->driftedCovariance({4}), risk_->startCovariance({4}));
  PoseGaussian both{Pose2(), cases_[2].start_outcome.covariance};
  both = compound(both, cases_[4].start_outcome);
  EXPECT_LT((risk_->driftedCovariance({4, 2}) - both.covariance).norm(), 1e-12);
  const std::vector<int> nine(PushRisk::kUncorrected + 1, 3);
  const std::vector<int> eight(PushRisk::kUncorrected, 3);
  EXPECT_EQ(risk_->driftedCovariance(nine), risk_->driftedCovariance(eight));
  EXPECT_GT(risk_->driftedCovariance(eight).trace(), risk_->startCovariance(eight).trace());
}

TEST_F(PushRiskTest, isObstructedAsOftenAsDrawnStartsAre) {
  setUp(furnishedRoom(), syntheticPushes(6, 5));
  double estimated = 0.0;
  double drawn_share = 0.0;
  int compared = 0;
  while (compared < 60) {
    const Pose2 start = randomFreePose(*collisions_, *object_, &random_);
    const int push = static_cast<int>(random_.below(cases_.size()));
    if (!checker_->isSafe(prepared_[push], start)) continue;
    const Eigen::Matrix3d drifted = risk_->driftedCovariance({compared % 6, 1, 4, 2});
    const double probability = risk_->obstructionProbability(push, start, drifted);
    if (probability == 0.0) continue;
    constexpr int kDraws = 500;
    const Eigen::Matrix3d root = covarianceRoot(drifted);
    int obstructed = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      obstructed += checker_->isSafe(prepared_[push], start * expSe2(root * normal())) ? 0 : 1;
    }
    EXPECT_NEAR(probability, static_cast<double>(obstructed) / kDraws, 0.2) << "push " << push;
    estimated += probability / 60.0;
    drawn_share += static_cast<double>(obstructed) / kDraws / 60.0;
    ++compared;
  }
  EXPECT_NEAR(estimated, drawn_share, 0.15 * drawn_share);
  EXPECT_EQ(risk_->obstructionProbability(0, Pose2(4.0, 5.0, 0.0), Eigen::Matrix3d::Zero()), 0.0);
}

TEST_F(PushRiskTest, missesTheGoalAsTheScatterSays) {
  setUp(emptyRoom(), {syntheticPush(1, 0.0, 2.0, 0.0, {})});
  const GoalTolerance tolerance;
  const Pose2 start(5.0, 5.0, 0.0);
  const Pose2 end = start * cases_[0].start_outcome.mean;
  const Eigen::Matrix3d known = Eigen::Matrix3d::Zero();
  EXPECT_LT(risk_->missProbability(0, start, known, end, tolerance), 0.01);
  EXPECT_NEAR(risk_->missProbability(0, start, known, end * Pose2(0.2, 0, 0), tolerance), 0.5, 0.1);
  EXPECT_GT(risk_->missProbability(0, start, known, end * Pose2(0.4, 0, 0), tolerance), 0.99);
}

TEST_F(PushRiskTest, expectsReplansAsARandomWalkLeavesTheTolerance) {
  SyntheticPushOptions options;
  options.position_sigma_m = 0.02;
  options.yaw_sigma_rad = 1e-9;
  setUp(emptyRoom(), {syntheticPush(1, 0.0, 2.0, 0.0, options)});
  const GoalTolerance tolerance;
  int steps = 0;
  constexpr int kWalks = 2000;
  for (int walk = 0; walk < kWalks; ++walk) {
    for (Eigen::Vector2d at(0.0, 0.0); at.norm() < tolerance.position_m; ++steps) {
      at += Eigen::Vector2d(random_.normal(0.02), random_.normal(0.02));
    }
  }
  // Discrete steps overshoot the border: they need a little more.
  const double drawn = static_cast<double>(kWalks) / steps;
  EXPECT_NEAR(risk_->expectedReplans(0, tolerance), 1.0 / 50.0, 1e-6);
  EXPECT_NEAR(drawn, 1.0 / 50.0, 0.15 / 50.0);
}

TEST_F(PushRiskTest, endsEarlyBeyondTheLimit) {
  setUp(furnishedRoom(), syntheticPushes(6, 5));
  for (int k = 0; k < 300; ++k) {
    const Pose2 start = randomFreePose(*collisions_, *object_, &random_);
    const double all = risk_->collisionProbability(k % 6, start, Eigen::Matrix3d::Zero());
    const double limited = risk_->collisionProbability(k % 6, start, Eigen::Matrix3d::Zero(), 0.02);
    if (all <= 0.02) {
      EXPECT_EQ(limited, all);
    } else {
      EXPECT_GT(limited, 0.02);
    }
  }
}

TEST(RiskOf, addsUpWhereProbabilitiesDoNot) {
  EXPECT_NEAR(probabilityOf(riskOf(0.1) + riskOf(0.2)), 1.0 - 0.9 * 0.8, 1e-12);
  EXPECT_EQ(riskOf(0.0), 0.0);
  EXPECT_TRUE(std::isinf(riskOf(1.0)));
  EXPECT_EQ(probabilityOf(riskOf(1.0)), 1.0);
}

TEST(BearablePushes, areThoseBeforeTheRiskGetsTwiceAsLargeAsWanted) {
  PushPlan rest;
  rest.pushes.resize(4);
  rest.max_collision_probability = 0.05;
  EXPECT_EQ(bearablePushes(rest), 4);
  rest.pushes[1].collision_probability = 0.08;
  EXPECT_EQ(bearablePushes(rest), 4);
  rest.pushes[2].collision_probability = 0.03;
  EXPECT_EQ(bearablePushes(rest), 2) << "together 0.108";
  rest.pushes[0].collision_probability = 0.11;
  EXPECT_EQ(bearablePushes(rest), 0);
}

TEST(SafetyLevels, fallFromWhatIsWantedToTheMeanMotion) {
  RiskOptions options;
  EXPECT_EQ(safetyLevels(options, 2.5).size(), 4U);
  EXPECT_EQ(safetyLevels(options, 2.5).back().zeta, 0.0);
  options.model = RiskModel::kChance;
  options.max_collision_probability = 0.15;
  const std::vector<SafetyLevel> levels = safetyLevels(options, 3.0);
  ASSERT_EQ(levels.size(), 4U);
  EXPECT_EQ(*levels[0].max_collision_probability, 0.15);
  EXPECT_EQ(*levels[1].max_collision_probability, 0.2);
  EXPECT_EQ(*levels[3].max_collision_probability, 1.0);
}

TEST(RiskModel, namesAreReadBackAndOthersRefused) {
  for (const RiskModel model : {RiskModel::kSigmaPoints, RiskModel::kChance}) {
    EXPECT_EQ(riskModel(toString(model)), model);
  }
  EXPECT_THROW(riskModel("none"), InputError);
}

}  // namespace
}  // namespace casepush
