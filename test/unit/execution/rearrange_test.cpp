#include "casepush/execution/rearrange.h"

#include <gtest/gtest.h>

#include <numeric>

#include "casepush/common/input_error.h"
#include "execution/push_task_fixture.h"

namespace casepush::test {
namespace {

using Wishes = std::vector<std::pair<int, int>>;

TEST(BestOrder, KeepsTheGivenOneWithoutWishes) {
  EXPECT_EQ(bestOrder(4, {}), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_TRUE(bestOrder(0, {}).empty());
}

TEST(BestOrder, MeetsWishesThatCanBeMet) {
  EXPECT_EQ(bestOrder(3, {{2, 1}, {1, 0}}), (std::vector<int>{2, 1, 0}));
  EXPECT_EQ(bestOrder(3, {{2, 0}}), (std::vector<int>{1, 2, 0}));
}

TEST(BestOrder, BreaksAsFewAsPossibleInACircle) {
  const Wishes circle = {{0, 1}, {1, 2}, {2, 0}};
  const std::vector<int> order = bestOrder(3, circle);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2}));
}

TEST(BestOrder, OfManyThingsMeetsAChain) {
  constexpr int kCount = 12;
  Wishes chain;
  for (int i = 0; i + 1 < kCount; ++i) chain.emplace_back(i + 1, i);
  std::vector<int> expected(kCount);
  std::iota(expected.rbegin(), expected.rend(), 0);
  EXPECT_EQ(bestOrder(kCount, chain), expected);
}

class RearrangeTest : public PushTaskTest {
 protected:
  RearrangeTest() {
    rearranging.plans = &plans;
    rearranging.make_task = [this](const PushTaskGoal& each) {
      started.push_back(each.object_id);
      return std::make_unique<PushTask>(each, fakeRobot(), services, options);
    };
    rearranging.in_the_way = [](const PushPlan&, const std::vector<PlacedObject>&) {
      return std::vector<std::string>{};
    };
    rearranging.on_task_end = [this](const PushTaskGoal& each, const PushTask& task,
                                     PushTaskStatus how, const std::string& why, double began_s) {
      ended.emplace_back(each.object_id, how);
      EXPECT_FALSE(why.empty());
      EXPECT_LE(began_s, world.now_s);
      EXPECT_GE(task.progress().pushes, 0);
    };
    wanted.tasks = {goal};
  }

  // A second object, which stands still in the fake world.
  void addCrate(const Pose2& pose, const Pose2& target) {
    crate.id = "crate_1";
    crate.model = "disc";
    crate.map_T_object = pose;
    PushTaskGoal second = goal;
    second.object_id = "crate_1";
    second.map_T_goal = target;
    wanted.tasks.push_back(second);
  }

  BehaviourStatus runAll(Rearrange& rearrange, double limit_s = 900.0) {
    const double end_s = world.now_s + limit_s;
    while (world.now_s < end_s) {
      Observation now = world.observe();
      if (!crate.id.empty()) {
        crate.stamp_s = now.stamp_s;
        now.objects.push_back(crate);
      }
      const Tick tick = rearrange.tick(now);
      if (tick.status != BehaviourStatus::kRunning) return tick.status;
      world.advance(tick.command.twist);
    }
    return BehaviourStatus::kRunning;
  }

  using Ends = std::vector<std::pair<std::string, PushTaskStatus>>;

  Ends ended;
  RearrangeRequest wanted;
  RearrangeServices rearranging;
  RearrangeOptions rearrange_options;
  std::vector<std::string> started;
  ObjectState crate;
};

TEST_F(RearrangeTest, BringsAnObjectToItsGoal) {
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  ASSERT_EQ(runAll(rearrange), BehaviourStatus::kSucceeded) << rearrange.describe();
  EXPECT_TRUE(goal.tolerance.isMet(goal.map_T_goal, world.object));
  EXPECT_EQ(rearrange.items().front().status, PushTaskStatus::kSucceeded);
  EXPECT_GT(rearrange.items().front().pushes, 0);
  EXPECT_EQ(rearrange.items().front().attempts, 1);
}

TEST_F(RearrangeTest, LeavesAloneWhatIsAtItsGoal) {
  addCrate(Pose2(-4.0, 3.0, 0.0), Pose2(-4.0, 3.1, 0.0));
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  ASSERT_EQ(runAll(rearrange), BehaviourStatus::kSucceeded) << rearrange.describe();
  EXPECT_EQ(started, std::vector<std::string>{"chair_1"});
}

TEST_F(RearrangeTest, WhoStandsInTheWayGoesFirstAndFailuresAreTriedAgain) {
  addCrate(Pose2(1.0, 0.5, 0.0), Pose2(4.0, 3.0, 0.0));
  wanted.tasks[1].time_limit_s = 0.01;  // Fails at once.
  rearranging.in_the_way = [](const PushPlan& plan, const std::vector<PlacedObject>& there) {
    const bool blocked = plan.object.id == "chair_1" && there.front().id == "crate_1" &&
                         there.front().map_T_object.x() < 2.0;
    return blocked ? std::vector<std::string>{"crate_1"} : std::vector<std::string>{};
  };
  rearrange_options.max_rounds = 2;
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  EXPECT_EQ(runAll(rearrange), BehaviourStatus::kFailed);
  EXPECT_EQ(started, (std::vector<std::string>{"crate_1", "chair_1", "crate_1"}));
  EXPECT_EQ(rearrange.items()[0].status, PushTaskStatus::kSucceeded);
  EXPECT_EQ(rearrange.items()[1].status, PushTaskStatus::kTimeout);
  EXPECT_NE(rearrange.describe().find("crate_1"), std::string::npos);
  EXPECT_EQ(rearrange.status(), PushTaskStatus::kNoProgress);
  EXPECT_EQ(ended, (Ends{{"crate_1", PushTaskStatus::kTimeout},
                         {"chair_1", PushTaskStatus::kSucceeded},
                         {"crate_1", PushTaskStatus::kTimeout}}));
}

TEST_F(RearrangeTest, RefusesGoalsThatMakeNoSense) {
  addCrate(Pose2(-4.0, 3.0, 0.0), Pose2(4.0, 3.0, 0.0));
  wanted.tasks[1].tolerance.position_m = 0.0;
  try {
    Rearrange rearrange(wanted, rearranging, rearrange_options);
    FAIL() << "nobody noticed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("crate_1: the goal pose must be finite"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(RearrangeTest, PushesNothingIfAGoalCanNeverBeMet) {
  addCrate(Pose2(-4.0, 3.0, 0.0), Pose2(4.0, 3.0, 0.0));
  plans.answer = [](const PlanRequest& request) {
    if (request.object.id != "crate_1") return searchPlan(request);
    PlanResult none;
    none.status = PlanStatus::kGoalInCollision;
    none.explanation = "the goal is in a wall";
    return none;
  };
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  EXPECT_EQ(runAll(rearrange), BehaviourStatus::kFailed);
  EXPECT_TRUE(started.empty());
  EXPECT_EQ(rearrange.status(), PushTaskStatus::kInvalidGoal);
  EXPECT_EQ(rearrange.describe(), "crate_1: the goal is in a wall");
  EXPECT_EQ(rearrange.items()[1].status, PushTaskStatus::kInvalidGoal);
}

TEST_F(RearrangeTest, PushesNothingIfGoalsContradictEachOther) {
  addCrate(Pose2(-4.0, 3.0, 0.0), wanted.tasks[0].map_T_goal);
  plans.answer = [](const PlanRequest& request) {
    const bool is_met = request.object.map_T_object.position() == request.map_T_goal.position();
    if (!is_met || request.obstacles.empty()) return searchPlan(request);
    EXPECT_EQ(request.obstacles.front().id, "crate_1");
    EXPECT_EQ(request.obstacles.front().map_T_object.position(), request.map_T_goal.position());
    PlanResult none;
    none.status = PlanStatus::kStartInCollision;
    none.explanation = "object chair_1: overlaps crate_1";
    return none;
  };
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  EXPECT_EQ(runAll(rearrange), BehaviourStatus::kFailed);
  EXPECT_TRUE(started.empty());
  EXPECT_EQ(rearrange.status(), PushTaskStatus::kInvalidGoal);
  EXPECT_EQ(rearrange.describe(),
            "with all objects at their goals: object chair_1: overlaps crate_1");
}

TEST_F(RearrangeTest, PlansTheOrderWithoutWhatMayBeClearedAway) {
  crate.id = "crate_1";  // Without a goal of its own.
  crate.model = "disc";
  crate.map_T_object = wanted.tasks[0].map_T_goal;
  for (const bool clear : {false, true}) {
    plans.requests.clear();
    wanted.tasks[0].clear_obstacles = clear;
    Rearrange rearrange(wanted, rearranging, rearrange_options);
    runAll(rearrange, 1.0);
    ASSERT_FALSE(plans.requests.empty());
    EXPECT_EQ(plans.requests.front().obstacles.size(), clear ? 0U : 1U);
  }
}

TEST_F(RearrangeTest, AGoalOnAnothersWayGoesLast) {
  addCrate(Pose2(-4.0, 3.0, 0.0), Pose2(1.0, 0.5, 0.0));
  std::swap(wanted.tasks[0], wanted.tasks[1]);
  wanted.tasks[0].time_limit_s = 0.01;
  rearranging.in_the_way = [](const PushPlan& plan, const std::vector<PlacedObject>& there) {
    const bool blocked = plan.object.id == "chair_1" && there.front().map_T_object.x() > 0.0;
    return blocked ? std::vector<std::string>{"crate_1"} : std::vector<std::string>{};
  };
  rearrange_options.max_rounds = 1;
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  EXPECT_EQ(runAll(rearrange), BehaviourStatus::kFailed);
  EXPECT_EQ(started, (std::vector<std::string>{"chair_1", "crate_1"}));
}

TEST_F(RearrangeTest, CancelEndsItStandingStill) {
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  for (int i = 0; i < 400; ++i) world.advance(rearrange.tick(world.observe()).command.twist);
  rearrange.cancel();
  const Tick tick = rearrange.tick(world.observe());
  EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
  EXPECT_TRUE(isZero(tick.command.twist));
  EXPECT_EQ(rearrange.status(), PushTaskStatus::kCancelled);
  EXPECT_EQ(rearrange.items()[0].status, PushTaskStatus::kCancelled);
  EXPECT_EQ(ended, (Ends{{"chair_1", PushTaskStatus::kCancelled}}));
}

TEST_F(RearrangeTest, EndsWhenItsTimeIsUp) {
  wanted.time_limit_s = 8.0;
  const double began_s = world.now_s;
  Rearrange rearrange(wanted, rearranging, rearrange_options);
  EXPECT_EQ(runAll(rearrange), BehaviourStatus::kFailed);
  EXPECT_LT(world.now_s, began_s + 10.0);
  EXPECT_EQ(rearrange.status(), PushTaskStatus::kTimeout);
  EXPECT_EQ(rearrange.items()[0].status, PushTaskStatus::kTimeout);
  EXPECT_EQ(ended, (Ends{{"chair_1", PushTaskStatus::kTimeout}}));
}

TEST_F(RearrangeTest, RefusesBadGoals) {
  EXPECT_THROW(Rearrange(RearrangeRequest{}, rearranging, rearrange_options), InputError);
  wanted.tasks.push_back(goal);
  EXPECT_THROW(Rearrange(wanted, rearranging, rearrange_options), InputError);
  wanted.tasks.pop_back();
  rearranging.make_task = nullptr;
  EXPECT_THROW(Rearrange(wanted, rearranging, rearrange_options), InputError);
}

}  // namespace
}  // namespace casepush::test
