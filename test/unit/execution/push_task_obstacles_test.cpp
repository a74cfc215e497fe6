// PushTask among other objects: those that come in sight late, and those that can be cleared away.
#include <gtest/gtest.h>

#include <algorithm>

#include "execution/push_task_fixture.h"

namespace casepush::test {
namespace {

/// Another object beside the fake world's chair.
class PushTaskObstaclesTest : public PushTaskTest {
 protected:
  PushTaskObstaclesTest() {
    services.in_the_way = [this](const PushPlan&, const std::vector<PlacedObject>& objects) {
      ++asked;
      std::vector<std::string> ids;
      for (const PlacedObject& object : objects) {
        if (is_in_the_way) ids.push_back(object.id);
      }
      return ids;
    };
  }

  /// The other object can be pushed, but nowhere to, and there is no way around it.
  void makeMovable() {
    ClearWayServices clearing;
    clearing.blockers = [this](const PushPlan&, const Observation&, int) {
      ++looks;
      return is_in_the_way ? std::vector<std::string>{"cart_1"} : std::vector<std::string>{};
    };
    clearing.clear = searchAtOnce([](const ClearingRequest&) {
      ClearingResult none;
      none.explanation = "no room";
      return none;
    });
    clearing.go_on = [](const PushPlan&, const Observation&) { return std::optional<PushPlan>(); };
    clearing.is_movable = [](const PlacedObject&) { return true; };
    clearing.cases = [](const std::string&) { return learntCases(); };
    clearing.approach = [](const std::string&) { return detour; };
    clearing.touches = [](const std::string&) { return TouchCheck(); };
    services.clearing = clearing;
    goal.clear_obstacles = true;
    plans.answer = [](const PlanRequest& request) {
      PlanResult none;
      none.status = PlanStatus::kUnreachable;
      return request.obstacles.empty() ? searchPlan(request) : none;
    };
  }

  Observation observe() {
    Observation observation = world.observe();
    if (cart_is_seen) {
      ObjectState cart;
      cart.id = "cart_1";
      cart.model = "cart";
      cart.map_T_object = cart_pose;
      cart.stamp_s = observation.stamp_s;
      observation.objects.push_back(cart);
    }
    return observation;
  }

  /// Until the task ends, or until `stop` says so.
  void runUntilTrue(PushTask& push_task, const std::function<bool()>& stop) {
    for (int i = 0; i < 40000 && push_task.status() == PushTaskStatus::kRunning && !stop(); ++i) {
      world.advance(push_task.tick(observe()).command.twist);
    }
  }

  bool cart_is_seen = false;
  Pose2 cart_pose{1.0, 0.5, 0.0};
  bool is_in_the_way = true;
  int asked = 0;
  int looks = 0;
};

TEST_F(PushTaskObstaclesTest, PlansAnewAsSoonAsSomethingInTheWayComesInSight) {
  PushTask push_task = task();
  runUntilTrue(push_task, [&] { return push_task.progress().phase == "push"; });
  EXPECT_TRUE(plans.requests.front().obstacles.empty());
  cart_is_seen = true;
  runUntilTrue(push_task, [&] { return push_task.progress().replans > 0; });
  ASSERT_EQ(push_task.progress().replan_reasons.size(), 1U);
  EXPECT_EQ(push_task.progress().replan_reasons[0], "cart_1 came in sight in the way");
  EXPECT_EQ(push_task.progress().pushes, 1);
  runUntilTrue(push_task, [&] { return plans.requests.size() > 1; });
  ASSERT_EQ(plans.requests.back().obstacles.size(), 1U);
  EXPECT_EQ(plans.requests.back().obstacles[0].id, "cart_1");
}

TEST_F(PushTaskObstaclesTest, GoesOnIfWhatComesInSightIsNotInTheWay) {
  is_in_the_way = false;
  PushTask push_task = task();
  runUntilTrue(push_task, [&] { return push_task.progress().phase == "push"; });
  cart_is_seen = true;
  runUntilTrue(push_task, [] { return false; });
  EXPECT_EQ(push_task.status(), PushTaskStatus::kSucceeded);
  EXPECT_EQ(asked, 1);
  for (const std::string& why : push_task.progress().replan_reasons) {
    EXPECT_EQ(why.find("cart_1"), std::string::npos) << why;
  }
}

TEST_F(PushTaskObstaclesTest, LooksAgainIfItWasMoved) {
  cart_is_seen = true;
  PushTask push_task = task();
  runUntilTrue(push_task, [&] { return push_task.progress().pushes >= 1; });
  EXPECT_EQ(asked, 0) << "the plan was made with it";
  cart_pose = Pose2(1.5, 0.5, 0.0);
  runUntilTrue(push_task, [&] { return asked > 0; });
  EXPECT_EQ(asked, 1);
}

TEST_F(PushTaskObstaclesTest, LooksOnceWhoIsInTheWayWhenClearingBegins) {
  makeMovable();
  cart_is_seen = true;
  PushTask push_task = task();
  runUntilTrue(push_task, [&] { return push_task.progress().replans > 0; });
  EXPECT_EQ(looks, 1);
}

TEST_F(PushTaskObstaclesTest, WhatCannotBeClearedIsFixedUntilThereIsNoPlanWithIt) {
  makeMovable();
  cart_is_seen = true;
  PushTask push_task = task();
  runUntilTrue(push_task, [&] { return push_task.progress().replans > 0; });
  ASSERT_EQ(push_task.progress().replan_causes.count(ReplanCause::kObstacleStuck), 1U);
  const std::size_t before = plans.requests.size();
  // Then someone takes it away.
  runUntilTrue(push_task, [&] { return plans.requests.size() > before; });
  EXPECT_EQ(plans.requests.back().obstacles.size(), 1U);
  is_in_the_way = false;
  runUntilTrue(push_task, [] { return false; });
  EXPECT_EQ(push_task.status(), PushTaskStatus::kSucceeded) << push_task.describe();
  EXPECT_TRUE(plans.requests.back().obstacles.empty());
}

}  // namespace
}  // namespace casepush::test
