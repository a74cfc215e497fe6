#include "casepush/execution/clear_way.h"

#include <gtest/gtest.h>

#include "casepush/common/input_error.h"
#include "execution/push_task_fixture.h"

namespace casepush::test {
namespace {

constexpr double kClearM = 0.9;

/// The chair of the fake world stands on a straight way along x.
class ClearWayTest : public testing::Test {
 protected:
  ClearWayTest() {
    way.object = {"table_1", "disc", Pose2(-3.0, 0.0, 0.0)};
    way.pushes.resize(3);
    services.blockers = [this](const PushPlan& plan, const Observation& now, int) {
      const ObjectState* chair = now.object("chair_1");
      const bool blocked = plan.object.id == "table_1" && chair != nullptr &&
                           std::abs(chair->map_T_object.y()) < kClearM;
      return blocked ? std::vector<std::string>{"chair_1"} : std::vector<std::string>{};
    };
    services.clear = searchAtOnce([this](const ClearingRequest& request) {
      requests.push_back(request);
      return sideways(request);
    });
    services.go_on = [](const PushPlan&, const Observation&) { return std::optional<PushPlan>(); };
    services.is_movable = [](const PlacedObject&) { return true; };
    services.cases = [](const std::string&) { return learntCases(); };
    services.approach = [](const std::string&) { return detour; };
    services.touches = [](const std::string&) { return TouchCheck(); };
    services.on_report = [this](const PushReport& report) { reports.push_back(report); };
  }

  // The single push that brings the obstacle farthest from the x axis.
  static ClearingResult sideways(const ClearingRequest& request) {
    ClearingResult result;
    result.plan.object = request.obstacle;
    const Pose2& start = request.obstacle.map_T_object;
    double best_m = 0.0;
    for (const Case& push_case : learntCases()) {
      const PoseGaussian outcome = transform(start, push_case.start_outcome);
      if (std::abs(outcome.mean.y()) <= best_m) continue;
      best_m = std::abs(outcome.mean.y());
      result.plan.pushes = {{push_case.id, start, outcome}};
    }
    result.found = !result.plan.pushes.empty();
    return result;
  }

  ClearWay clearWay() { return {way, fakeRobot(), services, options}; }

  FakeWorld world{3};
  PushPlan way;
  ClearWayServices services;
  ClearWayOptions options;
  std::vector<ClearingRequest> requests;
  std::vector<PushReport> reports;
};

TEST_F(ClearWayTest, DoesNothingIfNothingIsInTheWay) {
  world.object = Pose2(0.0, 2.0, 0.0);
  ClearWay clear = clearWay();
  EXPECT_EQ(run(clear, world), BehaviourStatus::kSucceeded);
  EXPECT_EQ(clear.pushes(), 0);
  EXPECT_TRUE(requests.empty());
}

TEST_F(ClearWayTest, PushesUntilTheWayIsClear) {
  ClearWay clear = clearWay();
  ASSERT_EQ(run(clear, world, 300.0), BehaviourStatus::kSucceeded) << clear.describe();
  EXPECT_GE(std::abs(world.object.y()), kClearM - 0.02);
  EXPECT_GE(clear.pushes(), 1);
  EXPECT_EQ(reports.size(), static_cast<std::size_t>(clear.pushes()));
  ASSERT_FALSE(requests.empty());
  EXPECT_EQ(requests.front().obstacle.id, "chair_1");
  EXPECT_EQ(requests.front().ways.front().object.id, "table_1");
}

TEST_F(ClearWayTest, NamesWhatCannotBeClearedAndCommandsZero) {
  services.clear = searchAtOnce([](const ClearingRequest&) {
    ClearingResult result;
    result.explanation = "no room";
    return result;
  });
  ClearWay clear = clearWay();
  EXPECT_EQ(run(clear, world), BehaviourStatus::kFailed);
  EXPECT_EQ(clear.stuckObstacle(), "chair_1");
  EXPECT_NE(clear.describe().find("no room"), std::string::npos);
  EXPECT_TRUE(isZero(clear.tick(world.observe()).command.twist));
}

TEST_F(ClearWayTest, GoesOnWithThePlanOfAnObstacleAsLongAsItMay) {
  services.clear = searchAtOnce([this](const ClearingRequest& request) {
    requests.push_back(request);
    ClearingResult result = sideways(request);
    result.plan.pushes.push_back(result.plan.pushes.front());
    return result;
  });
  std::size_t rests = 0;
  services.go_on = [&rests](const PushPlan& rest, const Observation&) {
    ++rests;
    return rest.pushes.empty() ? std::nullopt : std::optional<PushPlan>(rest);
  };
  ClearWay clear = clearWay();
  ASSERT_EQ(run(clear, world, 300.0), BehaviourStatus::kSucceeded) << clear.describe();
  EXPECT_EQ(clear.pushes(), 2);
  EXPECT_EQ(rests, 2U);
  EXPECT_EQ(requests.size(), 1U);
}

TEST_F(ClearWayTest, GivesUpAfterTheAllowedPushes) {
  world.object_fixed = true;
  options.max_pushes = 2;
  ClearWay clear = clearWay();
  EXPECT_EQ(run(clear, world, 600.0), BehaviourStatus::kFailed);
  EXPECT_EQ(clear.pushes(), 2);
  EXPECT_EQ(clear.stuckObstacle(), "chair_1");
}

TEST_F(ClearWayTest, GivesUpOnAnObstacleThatRollsOnForEver) {
  ClearWay clear = clearWay();
  world.object_velocity = {0.5, 0.0, 0.0};
  world.deceleration_mps2 = 0.0;
  EXPECT_EQ(run(clear, world), BehaviourStatus::kFailed);
  EXPECT_EQ(clear.stuckObstacle(), "chair_1");
  EXPECT_EQ(clear.pushes(), 0);
}

TEST_F(ClearWayTest, StandsStillWhilePushesAreLookedFor) {
  int asked = 0;
  const BeginClearing at_once = services.clear;
  services.clear = [&](const ClearingRequest& request) -> PendingClearing {
    return [&asked, pending = at_once(request)] { return ++asked < 10 ? std::nullopt : pending(); };
  };
  ClearWay clear = clearWay();
  while (asked < 9) {
    const Tick tick = clear.tick(world.observe());
    ASSERT_EQ(tick.status, BehaviourStatus::kRunning);
    ASSERT_TRUE(isZero(tick.command.twist));
    world.advance(tick.command.twist);
  }
  EXPECT_EQ(requests.size(), 1U);
  EXPECT_EQ(run(clear, world, 300.0), BehaviourStatus::kSucceeded) << clear.describe();
}

TEST_F(ClearWayTest, GivesUpASearchWhenCancelled) {
  const auto is_alive = std::make_shared<int>();
  services.clear = [&](const ClearingRequest&) -> PendingClearing {
    return [is_alive] { return std::optional<ClearingResult>(); };
  };
  ClearWay clear = clearWay();
  clear.tick(world.observe());
  ASSERT_GT(is_alive.use_count(), 1);
  clear.cancel();
  EXPECT_EQ(is_alive.use_count(), 1);
  EXPECT_EQ(clear.tick(world.observe()).status, BehaviourStatus::kFailed);
}

TEST_F(ClearWayTest, StopsWhenCancelled) {
  ClearWay clear = clearWay();
  for (int i = 0; i < 100; ++i) world.advance(clear.tick(world.observe()).command.twist);
  clear.cancel();
  const Tick tick = clear.tick(world.observe());
  EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
  EXPECT_TRUE(isZero(tick.command.twist));
}

/// A second obstacle, which does not move in the fake world, in the way of the last of eight
/// pushes.
class ClearWayTripTest : public ClearWayTest {
 protected:
  ClearWayTripTest() {
    way.pushes.resize(8);
    for (int i = 0; i < 8; ++i) way.pushes[i].map_outcome.mean = Pose2(-2.5 + 0.5 * i, 0.0, 0.0);
    services.blockers = [chair = services.blockers](const PushPlan& plan, const Observation& now,
                                                    int pushes) {
      const std::vector<std::string> ids = chair(plan, now, pushes);
      return ids.empty() && pushes == 8 ? std::vector<std::string>{"crate_1"} : ids;
    };
    services.clear = searchAtOnce([this](const ClearingRequest& request) {
      requests.push_back(request);
      return request.obstacle.id == "crate_1" ? ClearingResult{} : sideways(request);
    });
  }

  BehaviourStatus runBeside(ClearWay* clear, const Pose2& map_T_crate) {
    BehaviourStatus status = BehaviourStatus::kRunning;
    while (status == BehaviourStatus::kRunning && world.now_s < 300.0) {
      Observation now = world.observe();
      ObjectState crate = *now.object("chair_1");
      crate.id = "crate_1";
      crate.map_T_object = map_T_crate;
      now.objects.push_back(crate);
      const Tick tick = clear->tick(now);
      status = tick.status;
      world.advance(tick.command.twist);
    }
    return status;
  }
};

TEST_F(ClearWayTripTest, TakesWhatItWouldComeBackForAndLeavesItWhereItIsStuck) {
  ClearWay clear = clearWay();
  EXPECT_EQ(runBeside(&clear, Pose2(0.5, 0.0, 0.0)), BehaviourStatus::kSucceeded);
  EXPECT_GE(clear.pushes(), 1);
  EXPECT_EQ(requests.back().obstacle.id, "crate_1");
  EXPECT_EQ(clear.stuckObstacle(), "");
  EXPECT_NE(clear.describe().find("crate_1 stays"), std::string::npos) << clear.describe();
}

TEST_F(ClearWayTripTest, LeavesWhatIsFarOffForLater) {
  ClearWay clear = clearWay();
  EXPECT_EQ(runBeside(&clear, Pose2(20.0, 0.0, 0.0)), BehaviourStatus::kSucceeded);
  EXPECT_GE(clear.pushes(), 1);
  for (const ClearingRequest& request : requests) EXPECT_EQ(request.obstacle.id, "chair_1");
}

TEST_F(ClearWayTripTest, MakesNoTripForWhatIsNotReachedYet) {
  world.object = Pose2(0.0, 2.0, 0.0);
  ClearWay clear = clearWay();
  EXPECT_EQ(runBeside(&clear, Pose2(0.5, 0.0, 0.0)), BehaviourStatus::kSucceeded);
  EXPECT_EQ(clear.pushes(), 0);
}

TEST_F(ClearWayTest, ClearsFirstWhatIsInTheWayOfTheObstacle) {
  // A second obstacle, which does not move in the fake world, keeps the search from finding
  // anything unless it may be pushed through; then it turns out to be in the way.
  const ObjectState crate = [] {
    ObjectState state;
    state.id = "crate_1";
    state.model = "crate";
    state.map_T_object = Pose2(0.0, 1.2, 0.0);
    return state;
  }();
  bool crate_is_away = false;
  std::vector<std::string> asked;
  const auto stands = [](const ClearingRequest& request) {
    return std::any_of(request.standing.begin(), request.standing.end(),
                       [](const PlacedObject& each) { return each.id == "crate_1"; });
  };
  services.blockers = [&](const PushPlan& plan, const Observation& now, int) {
    if (plan.object.id == "chair_1" && !crate_is_away) return std::vector<std::string>{"crate_1"};
    const bool blocked =
        plan.object.id == "table_1" && std::abs(now.object("chair_1")->map_T_object.y()) < kClearM;
    return blocked ? std::vector<std::string>{"chair_1"} : std::vector<std::string>{};
  };
  services.clear = searchAtOnce([&](const ClearingRequest& request) {
    asked.push_back(request.obstacle.id);
    if (request.obstacle.id == "crate_1") {
      EXPECT_EQ(request.ways.size(), 2U);
      crate_is_away = true;  // By its push: of another object of the fake world, so none is needed.
    }
    ClearingResult result = sideways(request);
    result.found = !(request.obstacle.id == "chair_1" && !crate_is_away && stands(request));
    if (request.obstacle.id == "crate_1") result.plan.object.id = "chair_1";
    return result;
  });
  ClearWay clear = clearWay();
  const auto end_s = world.now_s + 300.0;
  BehaviourStatus status = BehaviourStatus::kRunning;
  double crate_stamp_s = world.now_s;
  while (status == BehaviourStatus::kRunning && world.now_s < end_s) {
    Observation now = world.observe();
    now.objects.push_back(crate);
    now.objects.back().stamp_s = crate_stamp_s = now.stamp_s;
    const Tick tick = clear.tick(now);
    status = tick.status;
    world.advance(tick.command.twist);
  }
  EXPECT_EQ(status, BehaviourStatus::kSucceeded) << clear.describe();
  ASSERT_GE(asked.size(), 3U);
  EXPECT_EQ(asked[0], "chair_1");  // With the crate as it stands,
  EXPECT_EQ(asked[1], "chair_1");  // then through it,
  EXPECT_EQ(asked[2], "crate_1");  // so that it has to go first.
}

TEST_F(ClearWayTest, BadOptionsAreNamed) {
  options.max_depth = 0;
  EXPECT_THROW(clearWay(), InputError);
}

}  // namespace
}  // namespace casepush::test
