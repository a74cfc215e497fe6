#include "casepush/planning/push_planner.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "casepush/common/input_error.h"
#include "planning/planner_fixture.h"

namespace casepush {
namespace {

double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Checks a plan without the planner's own data structures.
void expectAchievable(const PlanRequest& request, const PlanResult& result,
                      const std::vector<Case>& cases, const CollisionChecker& checker,
                      const PushPlanner& planner) {
  const auto object = checker.footprint(testChair().solid);
  const auto robot = checker.footprint(testRobot().solid);
  Pose2 pose = request.object.map_T_object;
  Pose2 map_T_robot = request.map_T_robot;
  for (const PlannedPush& push : result.plan.pushes) {
    const Case& used = cases.at(push.case_id - 1);
    ASSERT_EQ(used.id, push.case_id);
    ASSERT_NEAR(distance(push.map_T_start, pose), 0.0, 1e-9);
    ASSERT_NEAR(yawDifference(push.map_T_start, pose), 0.0, 1e-9);
    const Pose2 robot_start = pose * used.steps.front().start_T_robot();
    ASSERT_TRUE(planner
                    .approachPath({"chair_1", "chair", pose}, request.obstacles, map_T_robot,
                                  robot_start, robot_start.yaw())
                    .found);
    for (const CaseStep& step : used.steps) {
      ASSERT_FALSE(checker.collides(*object, pose * step.start_T_object));
      ASSERT_FALSE(checker.collides(*robot, pose * step.start_T_robot()));
    }
    for (const Pose2& sigma : sigmaPoints(used.start_outcome, result.plan.zeta)) {
      ASSERT_FALSE(checker.collides(*object, pose * sigma));
    }
    pose = pose * used.start_outcome.mean;
    map_T_robot = pose * used.steps.back().object_T_robot;
    ASSERT_NEAR(distance(push.map_outcome.mean, pose), 0.0, 1e-9);
  }
  EXPECT_TRUE(request.tolerance.isMet(request.map_T_goal, pose));
}

TEST(PushPlanner, solvesRandomProblemsWithAchievablePlans) {
  const auto planner = plannerFor(furnishedRoom(), quick());
  const auto map = mapOf(furnishedRoom());
  const CollisionChecker checker(*map);
  // Room to get away from the start and to come to rest at the goal.
  const auto roomy = checker.footprint(testChair().solid, 0.6);
  const auto robot = checker.footprint(testRobot().solid, 0.05);
  const std::vector<Case> cases = syntheticPushes(14, 7);
  Random random(21);
  for (int k = 0; k < 12; ++k) {
    PlanRequest request = requestFor(randomFreePose(checker, *roomy, &random),
                                     randomFreePose(checker, *roomy, &random));
    do {
      request.map_T_robot = randomFreePose(checker, *robot, &random);
    } while (distance(request.map_T_robot, request.object.map_T_object) < 0.8);
    request.seed = k;
    const PlanResult result = planner->plan(request, cases);
    ASSERT_EQ(result.status, PlanStatus::kSolved) << k << ": " << result.explanation;
    EXPECT_EQ(result.plan.zeta, 3.0);
    EXPECT_GT(result.nodes, 0);
    EXPECT_GT(result.collision_checks, 0);
    EXPECT_FALSE(result.tree.empty());
    expectAchievable(request, result, cases, checker, *planner);
  }
}

TEST(PushPlanner, isReproducible) {
  const auto planner = plannerFor(furnishedRoom(), quick());
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanResult a = planner->plan(requestFor(kStart, kGoal), cases);
  const PlanResult b = planner->plan(requestFor(kStart, kGoal), cases);
  ASSERT_EQ(a.status, PlanStatus::kSolved) << a.explanation;
  ASSERT_EQ(a.plan.pushes.size(), b.plan.pushes.size());
  for (std::size_t i = 0; i < a.plan.pushes.size(); ++i) {
    EXPECT_EQ(a.plan.pushes[i].case_id, b.plan.pushes[i].case_id);
    EXPECT_EQ(a.plan.pushes[i].map_outcome.mean.x(), b.plan.pushes[i].map_outcome.mean.x());
  }
  EXPECT_EQ(a.explanation, b.explanation);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.collision_checks, b.collision_checks);
}

TEST(PushPlanner, aLongerSearchFindsACheaperPlan) {
  PushPlannerOptions first = quick();
  first.improvement_extensions = 0;
  first.solutions = 1;
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const auto hasty = plannerFor(furnishedRoom(), first);
  const auto patient = plannerFor(furnishedRoom(), PushPlannerOptions{});
  std::size_t hasty_pushes = 0;
  std::size_t patient_pushes = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    PlanRequest request = requestFor(kStart, kGoal);
    request.seed = seed;
    hasty_pushes += hasty->plan(request, cases).plan.pushes.size();
    patient_pushes += patient->plan(request, cases).plan.pushes.size();
  }
  EXPECT_GT(patient_pushes, 0U);
  EXPECT_LT(patient_pushes, hasty_pushes);
}

TEST(PushPlanner, solvesInThePapersModeToo) {
  PushPlannerOptions options;
  options.similarity = Similarity::kPaper;
  options.goal_bias = 0.95;
  const auto planner = plannerFor(furnishedRoom(), options);
  const auto map = mapOf(furnishedRoom());
  const CollisionChecker checker(*map);
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanRequest request = requestFor(kStart, Pose2(6.5, 7.5, 0.5));
  const PlanResult result = planner->plan(request, cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  expectAchievable(request, result, cases, checker, *planner);
}

TEST(PushPlanner, plansNothingIfTheObjectIsThereAlready) {
  const auto planner = plannerFor(emptyRoom(), quick());
  const PlanResult result =
      planner->plan(requestFor(kStart, kStart * Pose2(0.1, 0.0, 0.1)), syntheticPushes(14, 7));
  EXPECT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_TRUE(result.plan.pushes.empty());
}

TEST(PushPlanner, goesAroundOtherObjects) {
  const auto planner = plannerFor(emptyRoom(), quick());
  PlanRequest request = requestFor(Pose2(4.0, 7.5, 0.0), Pose2(10.0, 7.5, 0.0));
  for (int i = 0; i < 7; ++i) {
    request.obstacles.push_back(
        {"other_" + std::to_string(i), "chair", Pose2(7.0, 5.4 + 0.7 * i, 0.0)});
  }
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanResult result = planner->plan(request, cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  const auto map = mapOf(emptyRoom());
  CollisionChecker checker(*map);
  std::vector<PlacedSolid> others;
  for (const PlacedObject& obstacle : request.obstacles) {
    others.push_back({testChair().solid, obstacle.map_T_object, obstacle.id});
  }
  checker.setObstacles(others);
  expectAchievable(request, result, cases, checker, *planner);
}

TEST(PushPlanner, acceptsASmallerSpreadOnlyWhereNothingElseIsPossible) {
  // A corridor with 15 cm on each side of the chair: too little for three standard deviations (18
  // cm), enough for two (12 cm).
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("left", 7.5, 8.95, 3.0, 2.0, 1.5));
  world.boxes.push_back(standing("right", 7.5, 6.55, 3.0, 1.0, 1.5));
  world.boxes.push_back(standing("far_left", 7.5, 12.4, 0.2, 5.0, 1.5));
  world.boxes.push_back(standing("far_right", 7.5, 3.1, 0.2, 6.0, 1.5));
  const auto planner = plannerFor(world, quick());
  SyntheticPushOptions uncertain;
  uncertain.position_sigma_m = 0.06;
  uncertain.yaw_sigma_rad = 0.02;
  const std::vector<Case> cases = {syntheticPush(1, 0.0, 3.0, 0.0, uncertain)};
  PlanRequest request = requestFor(Pose2(5.0, 7.5, 0.0), Pose2(9.5, 7.5, 0.0));
  request.map_T_robot = Pose2(3.0, 7.5, 0.0);
  const PlanResult result = planner->plan(request, cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_EQ(result.plan.zeta, 2.0);
  EXPECT_NE(result.explanation.find("safe only for zeta 2.0 instead of 3.0"), std::string::npos);
}

TEST(PushPlanner, needsTwoSearchesToSayThatThereIsNoPlan) {
  // The chair's origin would fit through the door, the chair does not.
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("wall_1", 7.5, 3.6, 0.2, 7.2, 1.5));
  world.boxes.push_back(standing("wall_2", 7.5, 11.4, 0.2, 7.2, 1.5));
  PushPlannerOptions options = quick();
  options.max_nodes = 3000;
  const PlanResult result =
      plannerFor(world, options)
          ->plan(requestFor(Pose2(5.0, 7.5, 0.0), Pose2(10.0, 7.5, 0.0)), syntheticPushes(14, 7));
  EXPECT_EQ(result.status, PlanStatus::kUnreachable);
  // Each with quick and with thorough checks of the robot's ways.
  EXPECT_LE(result.nodes, 4 * 3000);
}

TEST(PushPlanner, doesNotPlanPushesThatTheRobotCannotGetTo) {
  // The robot stands in a cell of its own; the chair does not.
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("cell_1", 2.0, 1.5, 0.1, 3.0, 1.5));
  world.boxes.push_back(standing("cell_2", 1.0, 3.0, 2.1, 0.1, 1.5));
  const auto planner = plannerFor(world, [] {
    PushPlannerOptions options = quick();
    options.max_nodes = 5000;
    return options;
  }());
  PlanRequest request = requestFor(Pose2(7.0, 7.0, 0.0), Pose2(9.0, 7.0, 0.0));
  request.map_T_robot = Pose2(1.0, 1.0, 0.0);
  const PlanResult result = planner->plan(request, syntheticPushes(14, 7));
  EXPECT_EQ(result.status, PlanStatus::kUnreachable);
  EXPECT_NE(result.explanation.find("the robot could not get to a push"), std::string::npos)
      << result.explanation;
  EXPECT_TRUE(result.plan.pushes.empty());
}

TEST(PushPlanner, saysWhenNothingLeadsToTheGoal) {
  PushPlannerOptions options = quick();
  options.max_nodes = 10;
  const PlanResult result =
      plannerFor(furnishedRoom(), options)->plan(requestFor(kStart, kGoal), syntheticPushes(14, 7));
  EXPECT_EQ(result.status, PlanStatus::kUnreachable);
  EXPECT_NE(result.explanation.find("no plan within 10 poses; raise max_nodes"), std::string::npos)
      << result.explanation;
}

TEST(PushPlanner, letsAnObjectAtAWallAway) {
  const auto planner = plannerFor(emptyRoom(), quick());
  // The chair overlaps the wall's cells by 5 mm; one case takes it along the wall and away from it.
  const PlanRequest request = requestFor(Pose2(5.0, 0.395, 0.0), Pose2(6.0, 3.0, 0.0));
  std::vector<Case> cases = syntheticPushes(14, 7);
  EXPECT_EQ(planner->plan(request, cases).status, PlanStatus::kUnreachable);
  Case along = syntheticPush(15, -0.03, 3.0, 0.0, {});
  along.start_outcome.mean = Pose2(0.9, 0.15, 0.0);
  for (int i = 0; i <= along.push_steps; ++i) {
    along.steps[i].start_T_object =
        interpolate(Pose2(), along.start_outcome.mean, static_cast<double>(i) / along.push_steps);
  }
  cases.push_back(along);
  const PlanResult result = planner->plan(request, cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_EQ(result.plan.pushes.front().case_id, 15);
}

struct Refusal {
  const char* name;
  std::function<void(PlanRequest*)> spoil;
  PlanStatus status;
  const char* text;
};

class PushPlannerRefusals : public testing::TestWithParam<Refusal> {};

TEST_P(PushPlannerRefusals, saysWhatIsWrong) {
  const auto planner = plannerFor(furnishedRoom(), quick());
  PlanRequest request = requestFor(kStart, kGoal);
  GetParam().spoil(&request);
  const PlanResult result = planner->plan(request, syntheticPushes(14, 7));
  EXPECT_EQ(result.status, GetParam().status) << toString(result.status);
  EXPECT_NE(result.explanation.find(GetParam().text), std::string::npos) << result.explanation;
  EXPECT_EQ(result.explanation.find('\n'), std::string::npos);
  EXPECT_TRUE(result.plan.pushes.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Requests, PushPlannerRefusals,
    testing::Values(
        Refusal{"unknownModel", [](PlanRequest* r) { r->object.model = "piano"; },
                PlanStatus::kInvalidRequest, "unknown model \"piano\"; known are: chair"},
        Refusal{"nanStart", [](PlanRequest* r) { r->object.map_T_object = Pose2(kNan, 0, 0); },
                PlanStatus::kInvalidRequest, "object \"chair_1\": its pose is not finite"},
        Refusal{"nanGoal", [](PlanRequest* r) { r->map_T_goal = Pose2(1, 1, kNan); },
                PlanStatus::kInvalidRequest, "goal: its pose is not finite"},
        Refusal{"nanRobot", [](PlanRequest* r) { r->map_T_robot = Pose2(1, kNan, 0); },
                PlanStatus::kInvalidRequest, "robot: its pose is not finite"},
        Refusal{"zeroTolerance", [](PlanRequest* r) { r->tolerance.position_m = 0.0; },
                PlanStatus::kInvalidRequest, "tolerance.position_m"},
        Refusal{"nanTolerance", [](PlanRequest* r) { r->tolerance.yaw_rad = kNan; },
                PlanStatus::kInvalidRequest, "tolerance.yaw_rad"},
        Refusal{"noTime", [](PlanRequest* r) { r->deadline_s = 0.0; }, PlanStatus::kInvalidRequest,
                "deadline_s"},
        Refusal{"unknownObstacle",
                [](PlanRequest* r) {
                  r->obstacles = {{"thing", "harp", Pose2(5, 5, 0)}};
                },
                PlanStatus::kInvalidRequest, "object \"thing\": unknown model \"harp\""},
        Refusal{"nanObstacle",
                [](PlanRequest* r) {
                  r->obstacles = {{"other", "chair", Pose2(5, kNan, 0)}};
                },
                PlanStatus::kInvalidRequest, "object \"other\": its pose is not finite"},
        Refusal{"ownObstacle", [](PlanRequest* r) { r->obstacles = {r->object}; },
                PlanStatus::kInvalidRequest, "is its own obstacle"},
        Refusal{"goalOutside", [](PlanRequest* r) { r->map_T_goal = Pose2(40, 3, 0); },
                PlanStatus::kGoalOutsideMap, "goal (40.00, 3.00, 0 deg): lies outside of the map"},
        Refusal{"goalInWall", [](PlanRequest* r) { r->map_T_goal = Pose2(7.5, 3, 0); },
                PlanStatus::kGoalInCollision, "the object would overlap the map"},
        Refusal{"goalOnObject",
                [](PlanRequest* r) {
                  r->obstacles = {{"other", "chair", r->map_T_goal * Pose2(0.2, 0, 0)}};
                },
                PlanStatus::kGoalInCollision, "the object would overlap other"},
        Refusal{"startInWall", [](PlanRequest* r) { r->object.map_T_object = Pose2(7.5, 3, 0); },
                PlanStatus::kStartInCollision, "overlaps the map"},
        Refusal{"startOutside", [](PlanRequest* r) { r->object.map_T_object = Pose2(-3, 3, 0); },
                PlanStatus::kStartInCollision, "stands outside of the map"}),
    [](const auto& instance) { return instance.param.name; });

TEST(PushPlanner, needsCasesOfTheObject) {
  const auto planner = plannerFor(emptyRoom(), quick());
  SyntheticPushOptions other;
  other.object = "table";
  const PlanResult result = planner->plan(requestFor(kStart, kGoal), syntheticPushes(14, 7, other));
  EXPECT_EQ(result.status, PlanStatus::kNoCases);
  EXPECT_EQ(result.explanation,
            "there are no cases of \"chair\" pushed by robot \"robot\"; learn some first");
}

TEST(PushPlanner, refusesADamagedCase) {
  const auto planner = plannerFor(emptyRoom(), quick());
  std::vector<Case> cases = syntheticPushes(3, 7);
  cases[1].start_outcome.covariance(0, 0) = kNan;
  const PlanResult result = planner->plan(requestFor(kStart, kGoal), cases);
  EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
  EXPECT_NE(result.explanation.find("case 2"), std::string::npos) << result.explanation;
}

/// A search that would take very long: nothing is in the way, but no chain ends so exactly there.
PlanRequest hopelessRequest() {
  PlanRequest request = requestFor(kStart, kGoal);
  request.tolerance = {1e-6, 1e-6};
  return request;
}

PushPlannerOptions endless() {
  PushPlannerOptions options;
  options.max_nodes = 10000000;
  options.spacing_m = 1e-4;
  return options;
}

TEST(PushPlanner, stopsSoonWhenCancelled) {
  const auto planner = plannerFor(emptyRoom(), endless());
  const auto begin = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point asked;
  bool is_asked = false;
  const PlanResult result = planner->plan(hopelessRequest(), syntheticPushes(14, 7), [&] {
    if (!is_asked && secondsSince(begin) > 0.2) {
      is_asked = true;
      asked = std::chrono::steady_clock::now();
    }
    return is_asked;
  });
  EXPECT_EQ(result.status, PlanStatus::kCancelled);
  EXPECT_EQ(result.explanation, "cancelled while planning");
  EXPECT_LT(secondsSince(asked), 0.2) << "a busy machine included";
}

TEST(PushPlanner, reportsItsProgress) {
  const auto planner = plannerFor(furnishedRoom(), quick());
  std::vector<PlanProgress> reports;
  const PlanResult result =
      planner->plan(requestFor(kStart, kGoal), syntheticPushes(14, 7), {},
                    [&reports](const PlanProgress& progress) { reports.push_back(progress); });
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  ASSERT_FALSE(reports.empty());
  for (std::size_t i = 1; i < reports.size(); ++i) {
    EXPECT_GE(reports[i].elapsed_s, reports[i - 1].elapsed_s);
    EXPECT_GE(reports[i].nodes, reports[i - 1].nodes);
  }
  EXPECT_GT(reports.back().nodes, 0);
  EXPECT_LE(reports.back().nodes, result.nodes);
  EXPECT_TRUE(std::isfinite(reports.back().best_cost_s));
}

TEST(PushPlanner, keepsItsDeadline) {
  const auto planner = plannerFor(emptyRoom(), endless());
  PlanRequest request = hopelessRequest();
  request.deadline_s = 0.3;
  const PlanResult result = planner->plan(request, syntheticPushes(14, 7));
  EXPECT_EQ(result.status, PlanStatus::kDeadline);
  EXPECT_NE(result.explanation.find("no plan within 0.3 s"), std::string::npos);
  EXPECT_LT(result.planning_s, 0.5) << "a busy machine included";
  EXPECT_FALSE(result.tree.empty());
}

TEST(PushPlanner, refusesAnEmptyMapAndBadOptions) {
  const std::map<std::string, ObjectModel> objects = {{"chair", testChair()}};
  EXPECT_THROW(PushPlanner(std::make_shared<Map>(0.05), testRobot(), objects, {}), InputError);
  PushPlannerOptions options;
  options.goal_bias = 1.5;
  options.max_nodes = 0;
  options.zeta = kNan;
  try {
    options.validate();
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("goal_bias is 1.5, must be in [0, 1]"), std::string::npos) << text;
    EXPECT_NE(text.find("max_nodes is 0"), std::string::npos) << text;
    EXPECT_NE(text.find("zeta is nan"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace casepush
