#include "casepush/lab/detour.h"

#include <gtest/gtest.h>

#include <cmath>

namespace casepush {
namespace {

TaskRun task(double shortest_m, double time_s, bool success = true) {
  TaskRun run;
  PlanTrial longer, shortest;
  longer.is_solved = shortest.is_solved = true;
  longer.length_m = shortest_m + 1.0;
  shortest.length_m = shortest_m;
  run.plans = {longer, shortest, PlanTrial{}};
  run.result.sim_time_s = time_s;
  run.result.success = success;
  return run;
}

TEST(BinByDetour, SortsPairsByTheShortestPlansAndComparesTheirTimes) {
  const std::vector<TaskRun> stationary = {task(10.0, 100.0), task(12.0, 200.0), task(12.5, 260.0),
                                           task(25.0, 400.0)};
  const std::vector<TaskRun> movable = {task(10.0, 100.0), task(5.0, 100.0), task(5.0, 130.0),
                                        task(5.0, 100.0)};
  const std::vector<DetourBin> bins = binByDetour(obstaclePairs(stationary, movable), 1);
  ASSERT_EQ(bins.size(), 6U);
  const DetourBin& all = bins[0];
  EXPECT_EQ(all.pairs, 4);
  EXPECT_NEAR(all.ratio.mean, 960.0 / 430.0, 1e-12);
  EXPECT_EQ(bins[1].pairs, 1);
  EXPECT_EQ(bins[2].pairs, 0);
  const DetourBin& twice = bins[3];
  EXPECT_EQ(twice.from, 2.0);
  EXPECT_EQ(twice.to, 3.0);
  EXPECT_EQ(twice.pairs, 2);
  EXPECT_NEAR(twice.detour, 2.45, 1e-12);
  EXPECT_NEAR(twice.around_m, 12.25, 1e-12);
  EXPECT_NEAR(twice.through_m, 5.0, 1e-12);
  EXPECT_NEAR(twice.stationary_s, 230.0, 1e-12);
  EXPECT_NEAR(twice.movable_s, 115.0, 1e-12);
  EXPECT_NEAR(twice.ratio.mean, 2.0, 1e-12);
  EXPECT_TRUE(std::isinf(bins[5].to));
  EXPECT_EQ(bins[5].pairs, 1);
}

TEST(BinByDetour, CountsPairsThatFailedWithoutTheirTimes) {
  TaskRun without_plan = task(5.0, 300.0);
  without_plan.plans = {PlanTrial{}};
  const std::vector<DetourBin> bins =
      binByDetour(obstaclePairs({task(10.0, 100.0, false), task(10.0, 180.0), without_plan},
                                {task(5.0, 1.0), task(5.0, 90.0), task(5.0, 90.0)}),
                  1);
  EXPECT_EQ(bins[0].pairs, 1);
  EXPECT_EQ(bins[0].failed, 2);
  EXPECT_NEAR(bins[0].ratio.mean, 2.0, 1e-12);
  EXPECT_EQ(bins[3].failed, 1);
  EXPECT_EQ(bins[5].failed, 1);
}

}  // namespace
}  // namespace casepush
