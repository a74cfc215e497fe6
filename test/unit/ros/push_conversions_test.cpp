#include "casepush/ros/push_conversions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "casepush/common/input_error.h"
#include "common/input_error_text.h"

namespace casepush {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Case someCase() {
  Case push_case;
  push_case.id = 42;
  push_case.object = "office_chair";
  push_case.robot = "cobot";
  push_case.origin = CaseOrigin::kDemonstrated;
  push_case.period_s = 0.1;
  push_case.push_steps = 2;
  push_case.steps = {{Pose2(-0.7, 0.1, 0.2), {0.3, 0.0, 0.1}, Pose2()},
                     {Pose2(-0.6, 0.1, 0.1), {0.3, 0.0, 0.1}, Pose2(0.1, 0, 0.05)},
                     {Pose2(-0.7, 0.1, 0.1), {0.0, 0.0, 0.0}, Pose2(0.3, 0.02, 0.1)}};
  push_case.start_outcome.mean = Pose2(0.3, 0.02, 0.1);
  push_case.start_outcome.covariance = Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal();
  push_case.effective_count = 7.5;
  push_case.observation_count = 12;
  push_case.source_id = 17;
  push_case.context = {2.5, "vinyl"};
  push_case.tube.assign(3, push_case.start_outcome);
  push_case.tube[1].mean = Pose2(0.1, 0.01, 0.04);
  return push_case;
}

PlanRequest someRequest() {
  PlanRequest request;
  request.object = {"chair_1", "office_chair", Pose2(1, 2, 0.3)};
  request.map_T_goal = Pose2(5, 6, -1);
  request.tolerance = {0.1, 0.2};
  request.map_T_robot = Pose2(0, 1, 2);
  request.obstacles = {{"cart_1", "cart", Pose2(3, 3, 0)}};
  request.seed = 9;
  request.deadline_s = 4.0;
  return request;
}

TEST(PushConversions, casesComeBack) {
  const Case push_case = someCase();
  const Case back = fromMessage(toMessage(std::vector<Case>{push_case}, 1.0)).at(0);
  EXPECT_EQ(back.id, 42);
  EXPECT_EQ(back.object, push_case.object);
  EXPECT_EQ(back.robot, push_case.robot);
  EXPECT_EQ(back.origin, push_case.origin);
  EXPECT_DOUBLE_EQ(back.period_s, push_case.period_s);
  EXPECT_EQ(back.push_steps, 2);
  ASSERT_EQ(back.steps.size(), 3U);
  EXPECT_DOUBLE_EQ(back.steps[1].object_T_robot.x(), -0.6);
  EXPECT_DOUBLE_EQ(back.steps[1].action.wz_rps, 0.1);
  EXPECT_DOUBLE_EQ(back.steps[2].start_T_object.yaw(), 0.1);
  EXPECT_TRUE(back.start_outcome.covariance.isApprox(push_case.start_outcome.covariance));
  EXPECT_DOUBLE_EQ(back.effective_count, 7.5);
  EXPECT_EQ(back.observation_count, 12);
  EXPECT_EQ(back.source_id, 17);
  EXPECT_EQ(back.context, push_case.context);
  ASSERT_EQ(back.tube.size(), 3U);
  EXPECT_DOUBLE_EQ(back.tube[1].mean.yaw(), 0.04);
  EXPECT_TRUE(back.tube[2].covariance.isApprox(push_case.tube[2].covariance));
}

TEST(PushConversions, knowsWhatIsUnknownOfACase) {
  Case push_case = someCase();
  push_case.context = {};
  push_case.tube.clear();
  const Case back = fromMessage(toMessage(push_case));
  EXPECT_FALSE(back.context.load_kg.has_value());
  EXPECT_TRUE(back.tube.empty());
}

TEST(PushConversions, refusesBadCases) {
  PushCaseArray message = toMessage(std::vector<Case>{someCase()}, 1.0);
  message.cases[0].origin = 9;
  EXPECT_THROW(fromMessage(message), InputError);
  message = toMessage(std::vector<Case>{someCase()}, 1.0);
  message.cases[0].steps[1].start_T_object.x = kNan;
  EXPECT_THROW(fromMessage(message), InputError);
  message = toMessage(std::vector<Case>{someCase()}, 1.0);
  message.cases[0].outcome.covariance[0] = -1.0;
  EXPECT_THROW(fromMessage(message), InputError);
  message = toMessage(std::vector<Case>{someCase()}, 1.0);
  message.cases[0].tube.pop_back();
  EXPECT_THROW(fromMessage(message), InputError);
  message = toMessage(std::vector<Case>{someCase()}, 1.0);
  message.cases[0].steps.clear();
  EXPECT_THROW(fromMessage(message), InputError);
}

TEST(PushConversions, configurationsComeBack) {
  PushConfiguration configuration;
  configuration.object_T_robot = Pose2(-0.8, 0.2, 0.1);
  configuration.direction_rad = 0.4;
  configuration.speed_mps = 0.25;
  configuration.yaw_rate_rps = -0.2;
  configuration.duration_s = 1.5;
  const PushConfiguration back = fromMessage(toMessage(configuration));
  EXPECT_DOUBLE_EQ(back.object_T_robot.y(), 0.2);
  EXPECT_DOUBLE_EQ(back.direction_rad, 0.4);
  EXPECT_DOUBLE_EQ(back.speed_mps, 0.25);
  EXPECT_DOUBLE_EQ(back.yaw_rate_rps, -0.2);
  EXPECT_DOUBLE_EQ(back.duration_s, 1.5);
  TrialPush bad = toMessage(configuration);
  bad.duration = kNan;
  EXPECT_THROW(fromMessage(bad), InputError);
}

TEST(PushConversions, plansComeBack) {
  PushPlan plan;
  plan.object = {"chair_1", "office_chair", Pose2(1, 2, 0.3)};
  plan.map_T_goal = Pose2(3, 4, 0.5);
  plan.tolerance = {0.1, 0.2};
  plan.zeta = 2.0;
  PlannedPush push;
  push.case_id = 5;
  push.map_T_start = plan.object.map_T_object;
  push.map_outcome.mean = Pose2(2, 3, 0.4);
  push.map_outcome.covariance = 0.01 * Eigen::Matrix3d::Identity();
  plan.pushes = {push, push};
  const Plan message = toMessage(plan, 3.0);
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_DOUBLE_EQ(message.length, plan.lengthM());
  const PushPlan back = fromMessage(message);
  EXPECT_EQ(back.object.id, "chair_1");
  EXPECT_DOUBLE_EQ(back.map_T_goal.yaw(), 0.5);
  EXPECT_DOUBLE_EQ(back.tolerance.yaw_rad, 0.2);
  EXPECT_DOUBLE_EQ(back.zeta, 2.0);
  ASSERT_EQ(back.pushes.size(), 2U);
  EXPECT_EQ(back.pushes[1].case_id, 5);
  EXPECT_DOUBLE_EQ(back.pushes[1].map_outcome.mean.x(), 2.0);
  EXPECT_EQ(message.risk, "sigma_points");
  EXPECT_FALSE(back.max_collision_probability);
}

TEST(PushConversions, risksOfPlansComeBack) {
  PushPlan plan;
  plan.zeta = 0.0;
  plan.max_collision_probability = 0.1;
  plan.collision_probability = 0.04;
  plan.goal_probability = 0.7;
  plan.pushes.resize(1);
  plan.pushes[0].collision_probability = 0.03;
  plan.pushes[0].map_compounded.mean = Pose2(1, 2, 0.3);
  plan.pushes[0].map_compounded.covariance = 0.02 * Eigen::Matrix3d::Identity();
  const Plan message = toMessage(plan, 1.0);
  EXPECT_EQ(message.risk, "chance");
  const PushPlan back = fromMessage(message);
  EXPECT_EQ(back.max_collision_probability, 0.1);
  EXPECT_DOUBLE_EQ(back.collision_probability, 0.04);
  EXPECT_DOUBLE_EQ(back.goal_probability, 0.7);
  EXPECT_DOUBLE_EQ(back.pushes[0].collision_probability, 0.03);
  EXPECT_DOUBLE_EQ(back.pushes[0].map_compounded.mean.y(), 2.0);
  EXPECT_DOUBLE_EQ(back.pushes[0].map_compounded.covariance(1, 1), 0.02);
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    Plan wrong = message;
    wrong.collision_probability = bad;
    EXPECT_THROW(fromMessage(wrong), InputError) << bad;
  }
  Plan wrong = message;
  wrong.risk = "luck";
  EXPECT_THROW(fromMessage(wrong), InputError);
}

TEST(PushConversions, reportsComeBack) {
  PushReport report;
  report.object_id = "chair_1";
  report.case_id = 3;
  report.outcome = PushOutcome::kNotMoved;
  report.explanation = "why";
  report.start_stamp_s = 1.5;
  report.end_stamp_s = 4.25;
  report.map_T_start = Pose2(1, 2, 3);
  report.map_T_end = Pose2(2, 3, -3);
  report.map_expected.mean = Pose2(2.1, 3, -3);
  report.map_expected.covariance = 0.02 * Eigen::Matrix3d::Identity();
  report.test = {4.5, 0.03, true};
  report.recorded = someCase();
  const PushReport back = fromMessage(toMessage(report));
  EXPECT_EQ(back.object_id, report.object_id);
  EXPECT_EQ(back.case_id, 3);
  EXPECT_EQ(back.outcome, PushOutcome::kNotMoved);
  EXPECT_EQ(back.explanation, "why");
  EXPECT_NEAR(back.end_stamp_s, 4.25, 1e-9);
  EXPECT_DOUBLE_EQ(back.map_T_end.yaw(), -3);
  EXPECT_DOUBLE_EQ(back.map_expected.mean.x(), 2.1);
  EXPECT_DOUBLE_EQ(back.test.p_value, 0.03);
  EXPECT_TRUE(back.test.rejected);
  EXPECT_EQ(back.recorded.steps.size(), 3U);
  for (int i = 0; i <= static_cast<int>(kLastPushOutcome); ++i) {
    report.outcome = static_cast<PushOutcome>(i);
    EXPECT_EQ(fromMessage(toMessage(report)).outcome, report.outcome);
    EXPECT_STRNE(toString(report.outcome), "");
  }
  ExecutedPush bad = toMessage(report);
  bad.outcome = 200;
  EXPECT_THROW(fromMessage(bad), InputError);
}

TEST(PushConversions, requestsComeBack) {
  const PlanRequest back = fromMessage(toMessage(someRequest()));
  EXPECT_EQ(back.object.id, "chair_1");
  EXPECT_DOUBLE_EQ(back.object.map_T_object.yaw(), 0.3);
  EXPECT_DOUBLE_EQ(back.map_T_goal.x(), 5);
  EXPECT_DOUBLE_EQ(back.tolerance.position_m, 0.1);
  EXPECT_DOUBLE_EQ(back.map_T_robot.yaw(), 2);
  ASSERT_EQ(back.obstacles.size(), 1U);
  EXPECT_EQ(back.obstacles[0].model, "cart");
  EXPECT_EQ(back.seed, 9U);
  EXPECT_DOUBLE_EQ(back.deadline_s, 4.0);
}

TEST(PushConversions, namesTheObjectThatNobodyKnows) {
  PlanPushGoal goal = toMessage(someRequest());
  goal.object_id = "sofa_1";
  EXPECT_EQ(inputErrorText([&] { fromMessage(goal); }),
            "goal: object_id: no object 'sofa_1' is known (has it been seen?)");
}

TEST(PushConversions, refusesAnObjectThatIsListedTwice) {
  PlanPushGoal goal = toMessage(someRequest());
  goal.objects.push_back(goal.objects.back());
  EXPECT_EQ(inputErrorText([&] { fromMessage(goal); }),
            "goal: objects: '" + goal.objects.back().id + "' is listed twice");
}

TEST(PushConversions, zeroToleranceStandsForTheDefault) {
  EXPECT_DOUBLE_EQ(goalTolerance(0, 0).position_m, GoalTolerance().position_m);
  EXPECT_DOUBLE_EQ(goalTolerance(0.3, 0).position_m, 0.3);
}

TEST(PushConversions, namesTheToleranceThatIsOutOfBounds) {
  EXPECT_EQ(inputErrorText([] { goalTolerance(-0.1, 7.0); }),
            "goal: position_tolerance [m] is -0.1, must be in [0, 1000]; "
            "yaw_tolerance [rad] is 7, must be in [0, 3.15]");
  EXPECT_EQ(inputErrorText([] { goalTolerance(0.1, kNan); }),
            "goal: yaw_tolerance [rad] is nan, must be in [0, 3.15]");
  EXPECT_DOUBLE_EQ(goalTolerance(0.1, 3.1416).yaw_rad, M_PI);
}

TEST(PushConversions, planResultsComeBack) {
  PlanResult result;
  result.status = PlanStatus::kDeadline;
  result.explanation = "too slow";
  result.nodes = 12;
  result.collision_checks = 34;
  result.planning_s = 0.5;
  result.expected_s = 61.5;
  result.bound = 1.5;
  const PlanResult back = fromMessage(toMessage(result, 1.0));
  EXPECT_EQ(back.status, PlanStatus::kDeadline);
  EXPECT_EQ(back.explanation, "too slow");
  EXPECT_EQ(back.nodes, 12);
  EXPECT_EQ(back.collision_checks, 34);
  EXPECT_DOUBLE_EQ(back.planning_s, 0.5);
  EXPECT_DOUBLE_EQ(back.expected_s, 61.5);
  EXPECT_DOUBLE_EQ(back.bound, 1.5);
}

}  // namespace
}  // namespace casepush
