#include <gtest/gtest.h>

#include <algorithm>

#include "planning/planner_fixture.h"

namespace casepush {
namespace {

class ContinuePlanTest : public testing::Test {
 protected:
  void SetUp() override {
    result_ = planner_->plan(requestFor(kStart, kGoal), cases_);
    ASSERT_EQ(result_.status, PlanStatus::kSolved) << result_.explanation;
    ASSERT_GE(result_.plan.pushes.size(), 3U);
  }

  std::vector<Case> cases_ = syntheticPushes(14, 7);
  std::unique_ptr<PushPlanner> planner_ = plannerFor(furnishedRoom(), quick());
  PlanResult result_;
};

TEST_F(ContinuePlanTest, goesOnAsPlannedFromTheExpectedPose) {
  PushPlan rest = result_.plan;
  const Pose2 expected = rest.pushes.front().map_outcome.mean;
  rest.pushes.erase(rest.pushes.begin());
  const auto continuation = planner_->continuePlan(rest, expected, cases_, {});
  EXPECT_TRUE(continuation.valid) << continuation.explanation;
  EXPECT_TRUE(continuation.explanation.empty());
  EXPECT_NEAR(distance(continuation.plan.pushes.back().map_outcome.mean,
                       result_.plan.pushes.back().map_outcome.mean),
              0.0, 1e-9);
}

TEST_F(ContinuePlanTest, shiftsTheRestWithTheObservedPose) {
  PushPlan rest = result_.plan;
  rest.pushes.erase(rest.pushes.begin(), rest.pushes.end() - 1);
  const Pose2 observed = rest.pushes.front().map_T_start * Pose2(0.01, -0.01, 0.0);
  const auto continuation = planner_->continuePlan(rest, observed, cases_, {});
  ASSERT_EQ(continuation.plan.pushes.size(), 1U);
  EXPECT_EQ(continuation.plan.object.map_T_object.x(), observed.x());
  EXPECT_NEAR(distance(continuation.plan.pushes.front().map_outcome.mean,
                       rest.pushes.front().map_outcome.mean),
              std::hypot(0.01, 0.01), 1e-9);
}

TEST_F(ContinuePlanTest, saysWhyItCannotGoOn) {
  const PushPlan& plan = result_.plan;
  const auto turned = planner_->continuePlan(plan, kStart * Pose2(0, 0, 1.0), cases_, {});
  EXPECT_FALSE(turned.valid);
  EXPECT_FALSE(turned.explanation.empty());

  PushPlan last = plan;
  last.pushes.erase(last.pushes.begin(), last.pushes.end() - 1);
  const Pose2 aside = last.pushes.front().map_T_start * Pose2(0.0, 0.0, 0.5);
  const auto missed = planner_->continuePlan(last, aside, cases_, {});
  EXPECT_FALSE(missed.valid);

  const auto blocked = planner_->continuePlan(
      plan, kStart, cases_, {{"other", "chair", plan.pushes[1].map_outcome.mean}});
  EXPECT_FALSE(blocked.valid);
  EXPECT_NE(blocked.explanation.find("(case "), std::string::npos) << blocked.explanation;

  const auto forgotten = planner_->continuePlan(plan, kStart, {}, {});
  EXPECT_FALSE(forgotten.valid);
  EXPECT_NE(forgotten.explanation.find("the case no longer exists"), std::string::npos);

  EXPECT_FALSE(planner_->continuePlan(plan, Pose2(kNan, 0, 0), cases_, {}).valid);
}

TEST_F(ContinuePlanTest, anEmptyRestIsDoneOnlyAtTheGoal) {
  PushPlan rest = result_.plan;
  rest.pushes.clear();
  EXPECT_TRUE(planner_->continuePlan(rest, kGoal, cases_, {}).valid);
  const auto elsewhere = planner_->continuePlan(rest, kStart, cases_, {});
  EXPECT_FALSE(elsewhere.valid);
  EXPECT_NE(elsewhere.explanation.find("m from the goal"), std::string::npos);
}

TEST(ApproachPath, goesAroundTheObjectAndRefusesWhatItDoesNotKnow) {
  const auto planner = plannerFor(emptyRoom(), quick());
  const PlacedObject chair = {"chair_1", "chair", Pose2(5, 5, 0)};
  const RobotPath path = planner->approachPath(chair, {}, Pose2(7, 5, 0), Pose2(4.2, 5, 0), 0.0);
  ASSERT_TRUE(path.found) << path.explanation;
  EXPECT_GT(path.length_m, 2.8);
  const RobotPath unknown = planner->approachPath(chair, {{"x", "harp", Pose2(1, 1, 0)}},
                                                  Pose2(7, 5, 0), Pose2(4.2, 5, 0), 0.0);
  EXPECT_FALSE(unknown.found);
  EXPECT_NE(unknown.explanation.find("unknown model \"harp\""), std::string::npos);
  EXPECT_FALSE(planner->approachPath(chair, {}, Pose2(kNan, 5, 0), Pose2(4.2, 5, 0), 0.0).found);
}

TEST(PushPlannerTouched, tellsWhatAnObjectWouldTouch) {
  const auto planner = plannerFor(furnishedRoom(), quick());
  const auto map = mapOf(furnishedRoom());
  const CollisionChecker checker(*map);
  const auto footprint = checker.footprint(testChair().solid);
  Random random(5);
  int touching = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose2 free = randomFreePose(checker, *footprint, &random);
    const Pose2 any = free * Pose2(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.3);
    const std::string touched = planner->touched("chair", {free, any, free}, {});
    EXPECT_EQ(touched.empty(), !checker.collides(*footprint, any));
    if (!touched.empty()) {
      EXPECT_EQ(touched.rfind("the ", 0), 0u) << touched;
      ++touching;
    }
    double deepest_m = 0.0;
    for (const Contact& contact : checker.contacts(*footprint, any)) {
      deepest_m = std::max(deepest_m, contact.depth_m);
    }
    EXPECT_EQ(planner->touched("chair", {free, any}, {}, 0.02).empty(), deepest_m <= 0.02);
    EXPECT_EQ(planner->touched("chair", {free}, {{"chair_2", "chair", free}}).rfind("chair_2", 0),
              0u);
  }
  EXPECT_GT(touching, 10);
  EXPECT_EQ(planner->touched("chair", {}, {}), "");
  EXPECT_EQ(planner->touched("unknown", {Pose2()}, {}), "");
}

}  // namespace
}  // namespace casepush
