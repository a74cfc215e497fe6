#include "casepush/execution/push_task.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <tuple>

#include "casepush/common/input_error.h"
#include "execution/fake_world.h"

namespace casepush {
namespace {

using test::fakeRobot;
using test::FakeWorld;

// Cases all around the object, each pushed once in a quiet world, with the scatter that others
// have.
const std::vector<Case>& learntCases() {
  static const std::vector<Case> cases = [] {
    std::vector<Case> learnt;
    for (int i = 0; i < 24; ++i) {
      FakeWorld world(500 + i);
      world.noise_m = 0.0;
      world.noise_rad = 0.0;
      PushConfiguration push;
      const double direction = 2.0 * M_PI * (i / 2) / 12.0;
      push.object_T_robot =
          Pose2(0.0, 0.0, direction) * Pose2(-0.66, i % 4 < 2 ? 0.04 : -0.12, 0.0);
      push.duration_s = i % 2 == 0 ? 2.5 : 1.2;
      world.robot = push.object_T_robot;
      ExecutePush trial("chair_1", push, fakeRobot(), test::detour, ExecutePushOptions{});
      test::run(trial, world);
      Case push_case = trial.report()->recorded;
      push_case.id = i + 1;
      push_case.start_outcome.covariance =
          Eigen::Vector3d(0.05, 0.05, 0.15).cwiseAbs2().asDiagonal();
      push_case.effective_count = 20;
      learnt.push_back(push_case);
    }
    return learnt;
  }();
  return cases;
}

double cost(const Pose2& a, const Pose2& b) {
  return std::hypot(distance(a, b), 0.5 * yawDifference(a, b));
}

// A search over the mean outcomes in open space: always extends the most promising pose.
PlanResult searchPlan(const PlanRequest& request) {
  struct Node {
    Pose2 pose;
    int parent;
    int case_index;
    int depth;
  };
  std::vector<Node> nodes{{request.object.map_T_object, -1, -1, 0}};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> open;
  open.push({0.0, 0});
  std::set<std::tuple<long, long, long>> visited;
  Random random(request.seed);
  PlanResult result;
  for (int round = 0; round < 3000 && !open.empty(); ++round) {
    const int best = open.top().second;
    open.pop();
    const Node node = nodes[best];
    if (request.tolerance.isMet(request.map_T_goal, node.pose)) {
      result.status = PlanStatus::kSolved;
      result.plan.object = request.object;
      result.plan.map_T_goal = request.map_T_goal;
      result.plan.tolerance = request.tolerance;
      for (int i = best; nodes[i].parent >= 0; i = nodes[i].parent) {
        const Case& push_case = learntCases()[nodes[i].case_index];
        const Pose2 start = nodes[nodes[i].parent].pose;
        result.plan.pushes.insert(result.plan.pushes.begin(),
                                  {push_case.id, start, transform(start, push_case.start_outcome)});
      }
      return result;
    }
    for (std::size_t c = 0; c < learntCases().size(); ++c) {
      const Pose2 next = node.pose * learntCases()[c].start_outcome.mean;
      if (!visited
               .insert({std::lround(next.x() / 0.08), std::lround(next.y() / 0.08),
                        std::lround(next.yaw() / 0.15)})
               .second) {
        continue;
      }
      nodes.push_back({next, best, static_cast<int>(c), node.depth + 1});
      open.push({2.0 * cost(next, request.map_T_goal) + 0.3 * (node.depth + 1) +
                     random.uniform(0.0, 0.02),
                 static_cast<int>(nodes.size()) - 1});
    }
  }
  result.status = PlanStatus::kUnreachable;
  result.explanation = "the tree was exhausted";
  return result;
}

class FakePlans : public PlanClient {
 public:
  void request(const PlanRequest& request) override {
    requests.push_back(request);
    polls_left = 5;
  }
  std::optional<PlanResult> poll() override {
    if (polls_left < 0 || --polls_left >= 0) {
      return std::nullopt;
    }
    return answer(requests.back());
  }
  void cancel() override { ++cancels; }
  bool isAlive() const override { return alive; }

  std::function<PlanResult(const PlanRequest&)> answer = searchPlan;
  std::vector<PlanRequest> requests;
  int polls_left = -1;
  int cancels = 0;
  bool alive = true;
};

PushPlanner::Continuation reanchored(const PushPlan& rest, const Pose2& map_T_object) {
  PushPlanner::Continuation continuation;
  continuation.plan = rest;
  Pose2 pose = map_T_object;
  for (PlannedPush& push : continuation.plan.pushes) {
    push.map_T_start = pose;
    push.map_outcome = transform(pose, learntCases()[push.case_id - 1].start_outcome);
    pose = push.map_outcome.mean;
  }
  continuation.valid = rest.tolerance.isMet(rest.map_T_goal, pose);
  continuation.explanation = continuation.valid ? "" : "the rest does not end in the goal any more";
  return continuation;
}

class PushTaskTest : public testing::Test {
 protected:
  PushTaskTest() {
    world.scatter = 0.05;
    goal.object_id = "chair_1";
    goal.map_T_goal = Pose2(2.0, 1.0, 0.5);
    services.plans = &plans;
    services.cases = [] { return learntCases(); };
    services.approach = test::detour;
    services.continue_plan = [](const PushPlan& rest, const Pose2& pose, const std::vector<Case>&,
                                const std::vector<PlacedObject>&) {
      return reanchored(rest, pose);
    };
    services.on_report = [this](const PushReport& report) { reports.push_back(report); };
    services.on_plan = [this](const PlanResult&) { ++plan_reports; };
  }

  PushTask task() { return {goal, fakeRobot(), services, options}; }

  // Ticks until the task is in a phase of the given name.
  bool runUntil(PushTask& push_task, const std::string& phase) {
    for (int i = 0; i < 20000 && push_task.progress().phase != phase; ++i) {
      world.advance(push_task.tick(world.observe()).command.twist);
    }
    return push_task.progress().phase == phase;
  }

  FakeWorld world{1};
  FakePlans plans;
  PushTaskGoal goal;
  PushTaskServices services;
  PushTaskOptions options;
  std::vector<PushReport> reports;
  int plan_reports = 0;
};

TEST_F(PushTaskTest, bringsTheObjectToTheGoalByGroundTruth) {
  for (int seed = 1; seed <= 8; ++seed) {
    world = FakeWorld(seed);
    world.scatter = 0.08;
    world.noise_m = 0.005;
    goal.seed = seed;
    reports.clear();
    plan_reports = 0;
    PushTask push_task = task();
    ASSERT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded)
        << "seed " << seed << ": " << push_task.describe();
    EXPECT_EQ(push_task.status(), PushTaskStatus::kSucceeded);
    EXPECT_TRUE(goal.tolerance.isMet(goal.map_T_goal, world.object)) << "seed " << seed;
    const PushTaskProgress& progress = push_task.progress();
    EXPECT_EQ(progress.pushes, static_cast<int>(reports.size()));
    EXPECT_EQ(progress.plans, plan_reports);
    EXPECT_EQ(progress.plans, progress.replans + 1);
    EXPECT_GT(progress.plan_length_m, 1.5);
    EXPECT_LT(progress.distance_to_goal_m, 0.2);
    EXPECT_EQ(progress.phase, "done");
    EXPECT_TRUE(test::isZero(push_task.tick(world.observe()).command.twist));
  }
}

TEST_F(PushTaskTest, doesNothingIfTheObjectIsAtTheGoalAlready) {
  goal.map_T_goal = Pose2(0.05, 0.0, 0.1);
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kSucceeded);
  EXPECT_TRUE(plans.requests.empty());
  EXPECT_LT(distance(world.robot, Pose2(-1.5, 0.0, 0.0)), 1e-9);
}

TEST_F(PushTaskTest, aimsForTheInnerPartOfTheToleranceButAcceptsItsEdge) {
  goal.map_T_goal = Pose2(0.193, 0.0, 0.0);  // Within 0.2 m, but not for sure.
  world.noise_m = 0.0;
  plans.answer = [](const PlanRequest&) {
    PlanResult none;
    none.status = PlanStatus::kUnreachable;
    return none;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kSucceeded);
  ASSERT_EQ(plans.requests.size(), 1u);
  EXPECT_NEAR(plans.requests[0].tolerance.position_m, 0.18, 1e-12);
  EXPECT_EQ(push_task.describe(), "chair_1 is at the goal, within the tolerance");
}

TEST_F(PushTaskTest, plansAnewWhenThePredictionIsRejected) {
  world.scatter = 0.0;
  world.deceleration_mps2 = 0.08;  // It rolls on much farther than the cases say.
  PushTask push_task = task();
  for (int i = 0; i < 30000 && push_task.progress().replans == 0; ++i) {
    world.advance(push_task.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(push_task.progress().replans, 1);
  EXPECT_GE(push_task.progress().rejected_predictions, 1);
  EXPECT_EQ(push_task.describe(), "planning anew: chair_1 rests elsewhere than predicted");
}

TEST_F(PushTaskTest, plansAnewWhenTheRestIsNotValidAnyMore) {
  services.continue_plan = [](const PushPlan&, const Pose2&, const std::vector<Case>&,
                              const std::vector<PlacedObject>&) {
    PushPlanner::Continuation blocked;
    blocked.explanation = "push 1: the chair would hit a wall";
    return blocked;
  };
  world.scatter = 0.0;
  PushTask push_task = task();
  for (int i = 0; i < 30000 && push_task.progress().replans == 0; ++i) {
    world.advance(push_task.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(reports.size(), 1u);
  EXPECT_EQ(push_task.describe(), "planning anew: push 1: the chair would hit a wall");
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded);
}

TEST_F(PushTaskTest, failsAtOnceWithThePlannersWordsIfTheGoalIsInvalid) {
  for (const PlanStatus status : {PlanStatus::kInvalidRequest, PlanStatus::kNoCases,
                                  PlanStatus::kGoalInCollision, PlanStatus::kGoalOutsideMap}) {
    plans = FakePlans();
    plans.answer = [status](const PlanRequest&) {
      PlanResult result;
      result.status = status;
      result.explanation = "the goal is in a wall";
      return result;
    };
    PushTask push_task = task();
    EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kInvalidGoal);
    EXPECT_EQ(push_task.describe(), "the goal is in a wall");
    EXPECT_EQ(plans.requests.size(), 1u);
  }
}

TEST_F(PushTaskTest, refusesAGoalThatIsNotFinite) {
  goal.map_T_goal = Pose2(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  PushTask push_task = task();
  EXPECT_EQ(push_task.tick(world.observe()).status, BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kInvalidGoal);
  EXPECT_TRUE(plans.requests.empty());
}

TEST_F(PushTaskTest, triesFailedPlansWithOtherSeeds) {
  plans.answer = [](const PlanRequest&) {
    PlanResult result;
    result.status = PlanStatus::kDeadline;
    result.explanation = "no plan within 10 s";
    return result;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kNoPlan);
  EXPECT_EQ(push_task.describe(), "no plan after 5 attempts: no plan within 10 s");
  std::set<std::uint64_t> seeds;
  for (const PlanRequest& request : plans.requests) {
    seeds.insert(request.seed);
  }
  EXPECT_EQ(seeds.size(), 5u);
}

TEST_F(PushTaskTest, aPlanWithAnUnknownCaseIsAFailedPlan) {
  plans.answer = [](const PlanRequest& request) {
    PlanResult result = searchPlan(request);
    result.plan.pushes.front().case_id = 999;
    return result;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kNoPlan);
  EXPECT_NE(push_task.describe().find("case 999"), std::string::npos);
}

TEST_F(PushTaskTest, stopsInTheSameTickWhenThePlannerIsGone) {
  for (const char* phase : {"look", "planning", "approach", "dock", "push", "rest"}) {
    world = FakeWorld(1);
    plans = FakePlans();
    PushTask push_task = task();
    ASSERT_TRUE(runUntil(push_task, phase)) << phase;
    plans.alive = false;
    const Tick tick = push_task.tick(world.observe());
    EXPECT_TRUE(test::isZero(tick.command.twist));
    EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kPlannerGone);
    EXPECT_EQ(push_task.describe(), "the planner does not answer");
  }
}

TEST_F(PushTaskTest, cancelsInEveryPhase) {
  for (const char* phase : {"look", "planning", "approach", "dock", "push", "rest"}) {
    world = FakeWorld(1);
    plans = FakePlans();
    PushTask push_task = task();
    ASSERT_TRUE(runUntil(push_task, phase)) << phase;
    push_task.cancel();
    const Tick tick = push_task.tick(world.observe());
    EXPECT_TRUE(test::isZero(tick.command.twist));
    EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kCancelled);
    EXPECT_EQ(plans.cancels, std::string(phase) == "planning" ? 1 : 0);
  }
}

TEST_F(PushTaskTest, failsWhenTheObjectIsNotInSight) {
  world.object_visible = false;
  PushTask push_task = task();
  const double began_s = world.now_s;
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kObjectLost);
  EXPECT_EQ(push_task.describe(), "chair_1 is not in sight");
  EXPECT_NEAR(world.now_s - began_s, 10.0, 0.1);
}

TEST_F(PushTaskTest, looksAgainWhenTheObjectIsLostDuringAPush) {
  PushTask push_task = task();
  ASSERT_TRUE(runUntil(push_task, "push"));
  world.object_visible = false;
  ASSERT_TRUE(runUntil(push_task, "look"));
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].outcome, PushOutcome::kObjectLost);
  EXPECT_EQ(push_task.progress().pushes, 0);
  world.object_visible = true;
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded)
      << push_task.describe();
}

TEST_F(PushTaskTest, stopsAndFailsWhenTheRobotIsLost) {
  for (const char* phase : {"look", "planning", "push"}) {
    world = FakeWorld(1);
    plans = FakePlans();
    PushTask push_task = task();
    ASSERT_TRUE(runUntil(push_task, phase)) << phase;
    world.robot_localised = false;
    plans.polls_left = 1000;
    const double lost_s = world.now_s;
    const BehaviourStatus status =
        test::run(push_task, world, 10.0, [&](const Observation& observation, const Tick& tick) {
          if (observation.stamp_s > lost_s + 0.21) {
            EXPECT_TRUE(test::isZero(tick.command.twist));
          }
        });
    EXPECT_EQ(status, BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kRobotLost) << phase;
  }
}

TEST_F(PushTaskTest, triesOtherPlansWhenTheRobotCanNotApproach) {
  services.approach = [](const Observation&, const Pose2&, double) {
    RobotPath none;
    none.explanation = "a desk is in the way";
    return none;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kNoProgress);
  EXPECT_EQ(push_task.describe(), "the robot can not get to the next push: a desk is in the way");
  EXPECT_EQ(plans.requests.size(), 5u);
  EXPECT_NE(plans.requests[0].seed, plans.requests[1].seed);
}

TEST_F(PushTaskTest, givesUpAfterItsLimits) {
  world.object_fixed = true;
  options.max_replans = 3;
  PushTask few_plans = task();
  EXPECT_EQ(test::run(few_plans, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(few_plans.status(), PushTaskStatus::kNoProgress);
  EXPECT_NE(few_plans.describe().find("not at the goal after 3 new plans: still 2.2"),
            std::string::npos)
      << few_plans.describe();

  options = PushTaskOptions();
  options.max_pushes = 2;
  PushTask few_pushes = task();
  EXPECT_EQ(test::run(few_pushes, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(few_pushes.status(), PushTaskStatus::kNoProgress);
  EXPECT_NE(few_pushes.describe().find("after 2 pushes"), std::string::npos);

  options = PushTaskOptions();
  options.max_plans_without_progress = 4;
  PushTask no_progress = task();
  EXPECT_EQ(test::run(no_progress, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(no_progress.status(), PushTaskStatus::kNoProgress);
  EXPECT_NE(no_progress.describe().find("4 plans in a row brought chair_1 no nearer"),
            std::string::npos)
      << no_progress.describe();

  goal.time_limit_s = 5.0;
  options = PushTaskOptions();
  PushTask short_time = task();
  EXPECT_EQ(test::run(short_time, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(short_time.status(), PushTaskStatus::kTimeout);
}

TEST_F(PushTaskTest, isDeterministic) {
  std::vector<PushReport> first;
  for (int round = 0; round < 2; ++round) {
    world = FakeWorld(3);
    world.scatter = 0.08;
    plans = FakePlans();
    reports.clear();
    PushTask push_task = task();
    test::run(push_task, world, 900.0);
    if (round == 0) {
      first = reports;
    }
  }
  ASSERT_EQ(reports.size(), first.size());
  EXPECT_DOUBLE_EQ(reports.back().map_T_end.x(), first.back().map_T_end.x());
  EXPECT_DOUBLE_EQ(reports.back().end_stamp_s, first.back().end_stamp_s);
}

TEST_F(PushTaskTest, refusesMissingServicesAndBadOptions) {
  services.continue_plan = nullptr;
  EXPECT_THROW(task(), InputError);
  services.plans = nullptr;
  EXPECT_THROW(task(), InputError);
  options.max_pushes = 0;
  try {
    task();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "push task options: max_pushes is 0, must be in [1, 100000]");
  }
}

}  // namespace
}  // namespace casepush
