#include "planning/drive_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/furnished_room.h"
#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

/// The room of 15 m, divided along y = 7.5 m by a wall from its west side.
ClearanceGrid dividedRoom(double wall_m = 12.0) {
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("between", 0.5 * wall_m, 7.5, wall_m, 0.2, 1.5));
  const auto map = mapOf(world);
  const CollisionChecker checker(*map);
  return {*checker.mapColumns(), travelDiscs(testRobot().solid, 0.0)};
}

TEST(DriveField, IsAsLongAsTheStraightWayIfThatIsFree) {
  const DriveField field(dividedRoom(), 0.0, {2.0, 3.0});
  EXPECT_NEAR(field.lengthTo({9.0, 3.0}), 7.0, 0.1);
  EXPECT_NEAR(field.lengthTo({2.0, 3.0}), 0.0, 0.05);
}

TEST(DriveField, LeadsAroundWalls) {
  const DriveField field(dividedRoom(), 0.0, {2.0, 6.5});
  const double around_m = 2.0 * std::hypot(10.4, 1.0);
  EXPECT_GT(field.lengthTo({2.0, 8.5}), around_m - 0.5);
  EXPECT_LT(field.lengthTo({2.0, 8.5}), 1.1 * around_m);
}

TEST(DriveField, IsInfiniteWhereNothingLeadsTo) {
  const DriveField field(dividedRoom(15.0), 0.0, {2.0, 6.5});
  EXPECT_TRUE(std::isinf(field.lengthTo({2.0, 8.5})));
  EXPECT_TRUE(std::isinf(field.lengthTo({-50.0, 0.0})));
}

TEST(DriveField, BeginsBesideAnObjectWhereTheRobotCanTravel) {
  // Docked at the wall's south side, closer than it may travel.
  const DriveField field(dividedRoom(), 0.1, {2.0, 7.4 - testRobot().radius_m - 0.01});
  EXPECT_NEAR(field.lengthTo({2.0, 5.0}), 2.1, 0.35);
  EXPECT_GT(field.lengthTo({2.0, 8.5}), 15.0);
}

}  // namespace
}  // namespace casepush
