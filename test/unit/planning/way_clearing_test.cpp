// PushPlanner among movable obstacles: who is in the way, and how to push it away.
#include <gtest/gtest.h>

#include "planning/planner_fixture.h"

namespace casepush {
namespace {

using Ids = std::vector<std::string>;

constexpr double kY_m = 7.5;

/// A chair that is to be pushed straight to the east, 0.6 m at a time.
class WayClearing : public ::testing::Test {
 protected:
  WayClearing() {
    cases_ = syntheticPushes(14, 3);
    cases_.push_back(syntheticPush(100, 0.0, 2.0, 0.0, SyntheticPushOptions()));
  }

  PushPlan straight(int pushes) const {
    PushPlan plan;
    plan.object = {"chair_1", "chair", Pose2(3.0, kY_m, 0.0)};
    Pose2 pose = plan.object.map_T_object;
    for (int i = 0; i < pushes; ++i) {
      plan.pushes.push_back({100, pose, transform(pose, cases_.back().start_outcome)});
      pose = plan.pushes.back().map_outcome.mean;
    }
    return plan;
  }

  static PlacedObject chair(const std::string& id, double x_m, double y_m) {
    return {id, "chair", Pose2(x_m, y_m, 0.3)};
  }

  ClearingRequest requestFor(const PlacedObject& obstacle, const PushPlan& way) const {
    ClearingRequest request;
    request.obstacle = obstacle;
    request.ways = {way};
    request.standing = {way.object};
    request.map_T_robot = Pose2(4.5, kY_m, 0.0);
    request.deadline_s = 60.0;
    return request;
  }

  std::vector<Case> cases_;
};

TEST_F(WayClearing, NamesWhomThePushesHitTheNearestFirst) {
  const auto planner = plannerFor(emptyRoom(), quick());
  const std::vector<PlacedObject> others = {chair("far", 7.5, kY_m), chair("near", 6.0, kY_m),
                                            chair("beside", 6.0, kY_m + 2.5)};
  EXPECT_EQ(planner->inTheWay(straight(8), cases_, others), (Ids{"near", "far"}));
  EXPECT_EQ(planner->inTheWay(straight(8), cases_, others, 4), Ids{"near"});
  EXPECT_EQ(planner->inTheWay(straight(8), cases_, others, 1), Ids{});
}

TEST_F(WayClearing, BlamesNobodyForTheMapNorTheMapForAnObstacle) {
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("post", 6.0, kY_m + 0.4, 0.2, 0.2, 1.0));
  const auto planner = plannerFor(world, quick());
  EXPECT_EQ(planner->inTheWay(straight(8), cases_, {chair("beside", 6.0, kY_m + 2.5)}), Ids{});
  EXPECT_EQ(planner->inTheWay(straight(8), cases_, {chair("there", 6.0, kY_m - 0.5)}),
            Ids{"there"});
}

TEST_F(WayClearing, PutsAnObstacleWhereNoPushHitsIt) {
  const auto planner = plannerFor(emptyRoom(), quick());
  const PushPlan way = straight(8);
  PlacedObject obstacle = chair("chair_2", 6.0, kY_m);
  const ClearingResult cleared = planner->clear(requestFor(obstacle, way), cases_);
  ASSERT_TRUE(cleared.found) << cleared.explanation;
  EXPECT_TRUE(cleared.off_all_pushes);
  obstacle.map_T_object = cleared.plan.pushes.back().map_outcome.mean;
  EXPECT_EQ(planner->inTheWay(way, cases_, {obstacle}), Ids{});
}

TEST_F(WayClearing, WhereNoPlaceIsOffAllPushesItIsOffTheNextOnes) {
  WorldModel world = emptyRoom();  // With a blind alley.
  world.boxes.push_back(standing("left", 7.5, kY_m + 1.0, 13.0, 0.2, 1.0));
  world.boxes.push_back(standing("right", 7.5, kY_m - 1.0, 13.0, 0.2, 1.0));
  world.boxes.push_back(standing("end", 10.0, kY_m, 0.2, 2.0, 1.0));
  world.boxes.push_back(standing("begin", 1.5, kY_m, 0.2, 2.0, 1.0));
  const auto planner = plannerFor(world, quick());
  const PushPlan way = straight(10);
  PlacedObject obstacle = chair("chair_2", 5.7, kY_m);
  ClearingRequest request = requestFor(obstacle, way);
  request.next_pushes = 3;
  const ClearingResult cleared = planner->clear(request, cases_);
  ASSERT_TRUE(cleared.found) << cleared.explanation;
  EXPECT_FALSE(cleared.off_all_pushes);
  obstacle.map_T_object = cleared.plan.pushes.back().map_outcome.mean;
  EXPECT_EQ(planner->inTheWay(way, cases_, {obstacle}, 3), Ids{});
  request.ways = {straight(12)};  // As far as the end of the alley.
  request.next_pushes = 12;
  EXPECT_FALSE(planner->clear(request, cases_).found);
}

}  // namespace
}  // namespace casepush
