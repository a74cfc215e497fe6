#include "casepush/model/push_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "casepush/model/push_report.h"

namespace casepush {
namespace {

TEST(GoalTolerance, needsBothPositionAndHeading) {
  const GoalTolerance tolerance;
  const Pose2 goal(1.0, 2.0, M_PI);
  EXPECT_TRUE(tolerance.isMet(goal, goal));
  EXPECT_TRUE(tolerance.isMet(goal, Pose2(1.0, 2.19, -M_PI + 0.34)));
  EXPECT_FALSE(tolerance.isMet(goal, Pose2(1.0, 2.21, M_PI)));
  EXPECT_FALSE(tolerance.isMet(goal, Pose2(1.0, 2.0, -M_PI + 0.36)));
  EXPECT_FALSE(tolerance.isMet(goal, Pose2(1.15, 2.15, M_PI)));
  EXPECT_FALSE(tolerance.isMet(goal, Pose2(std::nan(""), 2.0, M_PI)));
}

TEST(PushPlan, measuresThePathOfRestingPoses) {
  PushPlan plan;
  plan.object.map_T_object = Pose2(1.0, 1.0, 0.0);
  EXPECT_EQ(plan.lengthM(), 0.0);
  plan.pushes.resize(2);
  plan.pushes[0].map_outcome.mean = Pose2(4.0, 5.0, 1.0);
  plan.pushes[1].map_outcome.mean = Pose2(4.0, 6.5, -1.0);
  EXPECT_NEAR(plan.lengthM(), 6.5, 1e-12);
}

TEST(PlanStatus, hasATextOfItsOwnForEachValue) {
  std::set<std::string> texts;
  for (int i = 0; i <= static_cast<int>(PlanStatus::kPlannerGone); ++i) {
    texts.insert(toString(static_cast<PlanStatus>(i)));
  }
  EXPECT_EQ(texts.size(), 10U);
  EXPECT_EQ(texts.count("planner gone"), 1U);
}

TEST(PushOutcome, hasATextOfItsOwnForEachValue) {
  std::set<std::string> texts;
  for (int i = 0; i <= static_cast<int>(PushOutcome::kTimeout); ++i) {
    texts.insert(toString(static_cast<PushOutcome>(i)));
  }
  EXPECT_EQ(texts.size(), 7U);
  EXPECT_EQ(texts.count("timeout"), 1U);
}

}  // namespace
}  // namespace casepush
