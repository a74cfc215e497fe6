#include "casepush/model/plan_scatter.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "casepush/common/random.h"

namespace casepush {
namespace {

Eigen::Matrix3d diagonal(double x_m, double y_m, double yaw_rad) {
  return Eigen::Vector3d(x_m * x_m, y_m * y_m, yaw_rad * yaw_rad).asDiagonal();
}

/// Pushes of 0.3 to 0.8 m with turns, each with a scatter of its own, `scale` times some
/// centimetres and degrees.
PushPlan randomPlan(Random* random, int pushes, double scale) {
  PushPlan plan;
  plan.object.map_T_object = Pose2(random->uniform(-3.0, 3.0), 1.0, random->uniform(-3.0, 3.0));
  Pose2 pose = plan.object.map_T_object;
  for (int i = 0; i < pushes; ++i) {
    Eigen::Matrix3d root;
    for (int k = 0; k < 9; ++k) {
      root(k / 3, k % 3) = scale * random->uniform(-0.03, 0.03);
    }
    const Pose2 moved(random->uniform(0.3, 0.8), random->uniform(-0.2, 0.2),
                      random->uniform(-1.0, 1.0));
    plan.pushes.push_back({i + 1, pose, {pose * moved, root * root.transpose()}});
    pose = pose * moved;
  }
  plan.map_T_goal = pose;
  return plan;
}

/// An end of the plan if all pushes are drawn from their Gaussians one after the other.
Pose2 drawEnd(const PushPlan& plan, Random* random) {
  Pose2 pose = plan.object.map_T_object;
  for (const PlannedPush& push : plan.pushes) {
    const Eigen::Vector3d normal(random->normal(1.0), random->normal(1.0), random->normal(1.0));
    pose = pose * push.map_T_start.inverse() * push.map_outcome.mean *
           expSe2(covarianceRoot(push.map_outcome.covariance) * normal);
  }
  return pose;
}

Eigen::Matrix3d drawnCovariance(const PushPlan& plan, const Pose2& mean, Random* random) {
  constexpr int kDraws = 20000;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::Vector3d e = logSe2(mean.inverse() * drawEnd(plan, random));
    sum += e * e.transpose();
  }
  return sum / kDraws;
}

TEST(CompoundedEnd, hasTheCovarianceOfDrawnChains) {
  Random random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const PushPlan plan = randomPlan(&random, 1 + trial, 1.0);
    const PoseGaussian end = compoundedEnd(plan.pushes, PoseGaussian{plan.object.map_T_object});
    EXPECT_LT(distance(end.mean, plan.pushes.back().map_outcome.mean), 1e-9);
    const Eigen::Matrix3d drawn = drawnCovariance(plan, end.mean, &random);
    // First order, and the error of 20 000 draws: some per cent.
    EXPECT_LT((end.covariance - drawn).norm(), 0.06 * drawn.norm()) << trial;
  }
}

TEST(CompoundedEnd, carriesAHeadingErrorAlongTheWay) {
  // 0.01 rad at the start is 0.05 m across after 5 m.
  PushPlan plan;
  for (int i = 0; i < 5; ++i) {
    plan.pushes.push_back({1, Pose2(i, 0, 0), {Pose2(i + 1.0, 0, 0), diagonal(0, 0, 0)}});
  }
  const PoseGaussian end = compoundedEnd(plan.pushes, {Pose2(), diagonal(0.0, 0.0, 0.01)});
  EXPECT_NEAR(std::sqrt(end.covariance(1, 1)), 0.05, 1e-9);
  EXPECT_NEAR(std::sqrt(end.covariance(2, 2)), 0.01, 1e-9);
  EXPECT_NEAR(end.covariance(0, 0), 0.0, 1e-12);
}

TEST(CompoundedEnd, isTheStartWithoutPushes) {
  const PoseGaussian start{Pose2(1, 2, 3), diagonal(0.1, 0.2, 0.3)};
  EXPECT_LT(distance(compoundedEnd({}, start).mean, start.mean), 1e-12);
  EXPECT_EQ(compoundedEnd({}, start).covariance, start.covariance);
}

TEST(CompoundedEnd, takesARestFromWhereverItStarts) {
  Random random(2);
  const PushPlan plan = randomPlan(&random, 4, 1.0);
  const Pose2 elsewhere(7.0, 8.0, 2.0);
  const PoseGaussian end = compoundedEnd(plan.pushes, PoseGaussian{elsewhere});
  const Pose2 moved = plan.object.map_T_object.inverse() * plan.pushes.back().map_outcome.mean;
  EXPECT_LT(distance(end.mean, elsewhere * moved), 1e-9);
}

TEST(CompoundPushes, setsEveryPushAndTheGoalProbability) {
  Random random(3);
  PushPlan plan = randomPlan(&random, 6, 1.0);
  compoundPushes(&plan);
  EXPECT_LT(
      (plan.pushes[0].map_compounded.covariance - plan.pushes[0].map_outcome.covariance).norm(),
      1e-12);
  for (std::size_t i = 0; i < plan.pushes.size(); ++i) {
    const PlannedPush& push = plan.pushes[i];
    EXPECT_LT(distance(push.map_compounded.mean, push.map_outcome.mean), 1e-9);
    EXPECT_TRUE(isCovariance(push.map_compounded.covariance));
    if (i > 0) {
      EXPECT_GT(push.map_compounded.covariance.determinant(),
                plan.pushes[i - 1].map_compounded.covariance.determinant());
    }
  }
  int met = 0;
  constexpr int kDraws = 20000;
  for (int draw = 0; draw < kDraws; ++draw) {
    met += plan.tolerance.isMet(plan.map_T_goal, drawEnd(plan, &random)) ? 1 : 0;
  }
  EXPECT_NEAR(plan.goal_probability, static_cast<double>(met) / kDraws, 0.03);
  EXPECT_LT(plan.goal_probability, 1.0);
}

TEST(GoalProbability, isThatOfTheRegion) {
  const GoalTolerance tolerance{0.2, 10.0};
  // Rayleigh: 1 - exp(-r^2 / 2 s^2) within r.
  EXPECT_NEAR(goalProbability({Pose2(), diagonal(0.1, 0.1, 0.1)}, Pose2(), tolerance),
              1.0 - std::exp(-2.0), 0.015);
  EXPECT_EQ(goalProbability({Pose2(), diagonal(0, 0, 0)}, Pose2(0.1, 0, 0), tolerance), 1.0);
  EXPECT_EQ(goalProbability({Pose2(), diagonal(0, 0, 0)}, Pose2(0.3, 0, 0), tolerance), 0.0);
}

}  // namespace
}  // namespace casepush
