#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "planning/planner_fixture.h"

namespace casepush {
namespace {

/// A promise that every planner keeps.
class PlannerKindsTest : public testing::TestWithParam<PlannerKind> {
 protected:
  PlannerKindsTest() : cases_(syntheticPushes(14, 7)) {}

  PushPlannerOptions options() const {
    PushPlannerOptions options = PushPlannerOptions::forPlanner(GetParam());
    options.improvement_extensions = 500;
    return options;
  }

  std::vector<Case> cases_;
};

double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Somebody who wishes to stop after some CPU time, and notes how often he is asked.
class Asked {
 public:
  explicit Asked(double patience_s) : end_s_(threadSeconds() + patience_s) {}
  /// How long a call goes on that was last asked now. Once it was told to stop, that counts.
  void note() {
    const double now_s = threadSeconds();
    longest_s_ = std::max(longest_s_, now_s - last_s_);
    if (last_s_ < end_s_) last_s_ = now_s;
  }
  bool wishesToStop() {
    note();
    return last_s_ >= end_s_;
  }
  double longestPauseS() const { return longest_s_; }

 private:
  double end_s_;
  double last_s_ = threadSeconds();
  double longest_s_ = 0.0;
};

// Near and with a wide goal, so that planners that are made for other things are quick, too.
PlanRequest shortRequest() {
  PlanRequest request = requestFor(Pose2(4.0, 4.0, 0.0), Pose2(6.0, 4.5, 0.4));
  request.tolerance = {0.5, 1.2};
  return request;
}

TEST_P(PlannerKindsTest, chainsOutcomesIntoTheGoal) {
  const auto planner = plannerFor(emptyRoom(), options());
  const PlanRequest request = shortRequest();
  const PlanResult result = planner->plan(request, cases_);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  Pose2 pose = request.object.map_T_object;
  for (const PlannedPush& push : result.plan.pushes) {
    EXPECT_NEAR(distance(push.map_T_start, pose), 0.0, 1e-9);
    pose = push.map_outcome.mean;
  }
  EXPECT_TRUE(request.tolerance.isMet(request.map_T_goal, pose));
  const auto rest = planner->continuePlan(result.plan, request.object.map_T_object, cases_, {});
  EXPECT_TRUE(rest.valid) << rest.explanation;
  EXPECT_GT(result.nodes, 0);
}

// Half a turn is pi, and no state of OMPL's.
TEST_P(PlannerKindsTest, startsFromExactlyBackwards) {
  const auto planner = plannerFor(emptyRoom(), options());
  PlanRequest request = shortRequest();
  const Pose2 start = request.object.map_T_object;
  const Pose2 turn = Pose2(start.x(), start.y(), M_PI) * start.inverse();
  for (Pose2* pose : {&request.object.map_T_object, &request.map_T_goal, &request.map_T_robot}) {
    *pose = turn * *pose;
  }
  request.object.map_T_object = Pose2(start.x(), start.y(), M_PI);
  const PlanResult result = planner->plan(request, cases_);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
}

TEST_P(PlannerKindsTest, staysWhereItIsWhenAtTheGoal) {
  const auto planner = plannerFor(emptyRoom(), options());
  PlanRequest request = shortRequest();
  request.map_T_goal = Pose2(4.05, 4.0, 0.05);
  const PlanResult result = planner->plan(request, cases_);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_TRUE(result.plan.pushes.empty());
}

TEST_P(PlannerKindsTest, endsWhenCancelled) {
  const auto planner = plannerFor(furnishedRoom(), options());
  int asked = 0;
  const PlanResult result =
      planner->plan(requestFor(kStart, kGoal), cases_, [&asked] { return ++asked > 20; });
  EXPECT_EQ(result.status, PlanStatus::kCancelled) << result.explanation;
}

// Preparing them alone takes longer than this.
TEST_P(PlannerKindsTest, endsSoonWithTenThousandCases) {
  const auto planner = plannerFor(furnishedRoom(), options());
  PlanRequest request = requestFor(kStart, kGoal);
  request.deadline_s = 0.001;
  const PlanResult result = planner->plan(request, syntheticPushes(10000, 7));
  EXPECT_EQ(result.status, PlanStatus::kDeadline) << result.explanation;
  EXPECT_EQ(result.nodes, 0);
}

// However large a tree is when the time is over. A generous bound: other programs run as well.
TEST_P(PlannerKindsTest, returnsSoonAfterItsDeadline) {
  constexpr double kLate_s = 0.3;
  const auto planner = plannerFor(emptyRoom(), options());
  PlanRequest request = requestFor(kStart, kGoal);
  request.tolerance = {1e-6, 1e-6};
  const std::vector<std::vector<Case>> sets = {cases_, syntheticPushes(10000, 7)};
  for (const double deadline_s : {0.001, 0.2}) {
    request.deadline_s = deadline_s;
    for (const std::vector<Case>& cases : sets) {
      const auto begin = std::chrono::steady_clock::now();
      planner->plan(request, cases);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      EXPECT_LT(spent.count(), deadline_s + kLate_s) << cases.size() << " cases";
    }
  }
}

// In CPU time, with dead ends looked for and far more masks than there is memory for. Mostly it
// asks every millisecond; the bound leaves room for a busy processor and what happens within OMPL.
TEST_P(PlannerKindsTest, asksOftenWhetherToStop) {
  constexpr double kLongest_s = 0.04;
  const std::vector<Case> many = syntheticPushes(10000, 7);
  PushPlannerOptions narrow = options();
  narrow.mask_memory_mb = 20;
  const auto planner = plannerFor(furnishedRoom(), narrow);
  for (const double patience_s : {0.05, 0.3, 0.3}) {
    for (const std::vector<Case>* cases :
         std::initializer_list<const std::vector<Case>*>{&cases_, &many}) {
      Asked asked(patience_s);
      planner->plan(requestFor(kStart, kGoal), *cases, [&asked] { return asked.wishesToStop(); });
      asked.note();
      EXPECT_LT(asked.longestPauseS(), kLongest_s) << cases->size() << " cases, " << patience_s;
    }
  }
}

TEST_P(PlannerKindsTest, noticesAGoalBehindWalls) {
  WorldModel world = emptyRoom();
  for (int side = 0; side < 4; ++side) {
    const bool across = side % 2 == 0;
    const double off = side < 2 ? 1.5 : -1.5;
    world.boxes.push_back(standing("cell_" + std::to_string(side), 11.0 + (across ? off : 0.0),
                                   11.0 + (across ? 0.0 : off), across ? 0.1 : 3.1,
                                   across ? 3.1 : 0.1, 1.5));
  }
  const auto planner = plannerFor(world, options());
  const PlanResult result = planner->plan(requestFor(kStart, Pose2(11.0, 11.0, 0.0)), cases_);
  EXPECT_EQ(result.status, PlanStatus::kUnreachable);
  EXPECT_NE(result.explanation.find("goal region cannot be reached"), std::string::npos)
      << result.explanation;
  EXPECT_LT(result.nodes, 8000);
}

INSTANTIATE_TEST_SUITE_P(Planners, PlannerKindsTest, testing::ValuesIn(allPlannerKinds()),
                         [](const auto& instance) { return toString(instance.param); });

TEST(CaseLattice, isDeterministicAndCheaperWithMoreSearch) {
  PushPlannerOptions options = PushPlannerOptions::forPlanner(PlannerKind::kLattice);
  const auto patient = plannerFor(furnishedRoom(), options);
  options.improvement_extensions = 0;
  const auto quick_one = plannerFor(furnishedRoom(), options);
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanRequest request = requestFor(kStart, kGoal);
  const PlanResult first = quick_one->plan(request, cases);
  const PlanResult again = quick_one->plan(request, cases);
  const PlanResult best = patient->plan(request, cases);
  ASSERT_EQ(first.status, PlanStatus::kSolved) << first.explanation;
  ASSERT_EQ(best.status, PlanStatus::kSolved) << best.explanation;
  EXPECT_EQ(first.nodes, again.nodes);
  EXPECT_EQ(first.explanation, again.explanation);
  EXPECT_LE(best.plan.pushes.size(), first.plan.pushes.size());
  EXPECT_GT(best.nodes, first.nodes);
}

TEST(PlannerKind, namesAreReadBackAndOthersRefused) {
  for (const PlannerKind kind : allPlannerKinds()) EXPECT_EQ(plannerKind(toString(kind)), kind);
  try {
    plannerKind("astar");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("lattice"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace casepush
