#include "casepush/lab/task_experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

TaskExperimentOptions small() {
  TaskExperimentOptions options;
  options.setting = TaskSetting::kDiagonal;
  options.goal_distance_m = 1.5;
  options.tasks = 3;
  options.case_bases = 2;
  options.learning.exploration.cases = 8;
  options.learning.exploration.practices = 4;
  options.learning.lab.simulator.caster_model = CasterModel::kPlanar;
  options.run.lab.simulator.caster_model = CasterModel::kPlanar;
  options.run.task.plan_deadline_s = 60.0;
  return options;
}

TEST(RunTasks, givesTheSameResultWithAnyNumberOfThreads) {
  TaskExperimentOptions options = small();
  const Catalog catalog = Catalog::standard();
  const std::vector<TaskRun> one = runTasks(catalog, options);
  options.jobs = 3;
  int told = 0;
  const std::vector<TaskRun> three =
      runTasks(catalog, options, [&](const char*, int, int) { ++told; });
  EXPECT_EQ(told, 5);
  ASSERT_EQ(one.size(), 3U);
  ASSERT_EQ(three.size(), 3U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].seed, three[i].seed);
    EXPECT_EQ(one[i].result.sim_time_s, three[i].result.sim_time_s);
    EXPECT_EQ(one[i].result.position_error_m, three[i].result.position_error_m);
  }
}

TEST(RunTasks, accountsForEveryPushAndReplan) {
  for (const TaskRun& run : runTasks(Catalog::standard(), small())) {
    const PushTaskProgress& progress = run.result.progress;
    const std::vector<int>& rows = progress.pushes_per_plan;
    EXPECT_EQ(std::accumulate(rows.begin(), rows.end(), 0), progress.pushes);
    int causes = 0;
    for (const auto& [cause, count] : progress.replan_causes) {
      causes += count;
    }
    EXPECT_EQ(causes, progress.replans);
    EXPECT_EQ(static_cast<int>(rows.size()), progress.replans + 1);
  }
}

TEST(DiagonalProblem, hasTheDistanceAskedForAndRoomAround) {
  const Catalog catalog = Catalog::standard();
  for (int seed = 1; seed <= 20; ++seed) {
    const PushProblem problem = diagonalProblem(catalog, "stretcher", "cobot", 4.0, seed);
    const Pose2& start = problem.world.objects.front().map_T_object;
    EXPECT_NEAR(distance(start, problem.map_T_goal), 4.0, 1e-9);
    EXPECT_TRUE(problem.world.contains(problem.world.map_T_robot));
    EXPECT_GT(distance(start, problem.world.map_T_robot), 1.0);
  }
}

TEST(TaskProblem, isSetWhereTheOptionsSay) {
  const Catalog catalog = Catalog::standard();
  TaskExperimentOptions options = small();
  options.object = "overbed_table";
  options.movable = {"utility_cart"};
  options.setting = TaskSetting::kDividedRooms;
  const PushProblem divided = taskProblem(catalog, options, 3);
  EXPECT_EQ(divided.world.name, "divided_room_3");
  ASSERT_EQ(divided.world.objects.size(), 2U);
  EXPECT_EQ(divided.world.objects[1].model, "utility_cart");
  options.setting = TaskSetting::kVariedRooms;
  const PushProblem varied = taskProblem(catalog, options, 3);
  EXPECT_EQ(varied.world.name, "divided_room_3");
  EXPECT_NE(varied.world.max_m, divided.world.max_m);
  EXPECT_EQ(varied.world.objects[1].model, "utility_cart");
  options.setting = TaskSetting::kRandomRooms;
  const PushProblem random = taskProblem(catalog, options, 3);
  EXPECT_EQ(random.world.name, "room_3");
  EXPECT_EQ(random.world.objects.size(), 2U);
  options.setting = TaskSetting::kWorld;
  options.world = "corridor";
  const PushProblem world = taskProblem(catalog, options, 3);
  EXPECT_EQ(world.world.name, "corridor");
  EXPECT_GT(distance(world.map_T_goal, taskProblem(catalog, options, 4).map_T_goal), 0.0);
}

TEST(RunTasks, plansWithoutExecutingWhereAsked) {
  TaskExperimentOptions options = small();
  options.tasks = 2;
  options.case_bases = 1;
  options.plans = 3;
  options.execute = false;
  const std::vector<TaskRun> runs = runTasks(Catalog::standard(), options);
  for (const TaskRun& run : runs) {
    EXPECT_EQ(run.result.sim_time_s, 0.0);
    ASSERT_EQ(run.plans.size(), 3U);
    double least_m = 100.0;
    for (const PlanTrial& plan : run.plans) {
      ASSERT_TRUE(plan.is_solved);
      EXPECT_GT(plan.length_m, 1.2);
      EXPECT_GT(plan.pushes, 0);
      EXPECT_GT(plan.nodes, 0);
      EXPECT_GT(plan.planning_s, 0.0);
      least_m = std::min(least_m, plan.length_m);
    }
    EXPECT_EQ(shortestM(run.plans), least_m);
  }
  EXPECT_TRUE(std::isinf(shortestM({PlanTrial{}})));
}

TEST(PlanTrials, ThoseWithoutMovableObstaclesTakeTheShortWay) {
  TaskExperimentOptions options = small();
  options.object = "overbed_table";
  options.setting = TaskSetting::kDividedRooms;
  options.tasks = 1;
  options.case_bases = 1;
  options.learning.exploration.cases = 12;
  options.plans = 1;
  options.execute = false;
  options.room_density = 0.0;
  options.movable = {"office_chair", "office_chair"};
  const TaskRun fixed = runTasks(Catalog::standard(), options).front();
  options.run.clear_obstacles = true;
  const TaskRun movable = runTasks(Catalog::standard(), options).front();
  ASSERT_TRUE(fixed.plans.front().is_solved);
  ASSERT_TRUE(movable.plans.front().is_solved);
  EXPECT_GT(fixed.plans.front().length_m, movable.plans.front().length_m + 5.0);
}

TEST(RunTasks, refusesBadOptions) {
  TaskExperimentOptions options = small();
  options.tasks = 0;
  options.jobs = 0;
  try {
    runTasks(Catalog::standard(), options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tasks is 0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("jobs is 0"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace casepush
