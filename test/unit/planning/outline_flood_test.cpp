#include "planning/outline_flood.h"

#include <gtest/gtest.h>

#include "planning/furnished_room.h"
#include "planning/narrow_place.h"
#include "planning/planner_fixture.h"

namespace casepush {
namespace {

constexpr double kStep_m = 0.025;
constexpr double kStep_rad = 0.06;
constexpr double kWallX_m = 7.5;

/// A room in two halves with a door in the wall between them.
struct DoorRoom {
  double door_m;
  double door_y_m;
  double thickness_m;

  WorldModel world() const {
    WorldModel world = emptyRoom();
    const double low = door_y_m - 0.5 * door_m;
    const double high = door_y_m + 0.5 * door_m;
    world.boxes.push_back(standing("south_wall", kWallX_m, 0.5 * low, thickness_m, low, 1.5));
    world.boxes.push_back(
        standing("north_wall", kWallX_m, 0.5 * (high + 15.0), thickness_m, 15.0 - high, 1.5));
    return world;
  }
};

Solid benchSolid() { return {upright(Box{{1.0, 0.4, 0.5}}, 0, 0, 0.3, "seat")}; }

struct Scene {
  Scene(const WorldModel& world, const Solid& solid)
      : map(mapOf(world)),
        checker(*map),
        object(checker.footprint(solid)),
        sweeps(checker, SweepChecker::heightClasses(checker, {object}), 3.0),
        clearance(checker.columns()),
        radius_m(circumscribedRadius(solid)) {}

  bool isShutOut(const Pose2& start, const Pose2& goal, double lenient_m = 0.0) const {
    const Patience endless;
    const OutlineFlood flood(
        {sweeps, object, radius_m, start, goal, {0.3, 0.5}, lenient_m, kStep_m, kStep_rad},
        clearance, endless);
    return flood.isShutOut();
  }

  /// Straight through the door at some heading, each centimetre by the true shapes.
  bool getsThrough(const DoorRoom& room) const {
    for (int heading = 0; heading < 24; ++heading) {
      for (const double beside_m : {0.0, -0.02, 0.02}) {
        bool is_free = true;
        for (double x = kWallX_m - 1.5; is_free && x < kWallX_m + 1.5; x += 0.01) {
          const Pose2 pose(x, room.door_y_m + beside_m, wrapAngle(heading * M_PI / 12.0));
          is_free = !checker.collides(*object, pose);
        }
        if (is_free) return true;
      }
    }
    return false;
  }

  std::shared_ptr<const Map> map;
  CollisionChecker checker;
  std::shared_ptr<const Footprint> object;
  SweepChecker sweeps;
  ClearanceField clearance;
  double radius_m;
};

// Random doors in random places, about as wide as two objects: where a way through is known, none
// is said to be shut out; where the door is too narrow by more than two cells, it is noticed.
TEST(OutlineFlood, neverShutsOutWhatGetsThroughAndNoticesDoorsThatAreTooNarrow) {
  Random random(5);
  int through = 0;
  int noticed = 0;
  for (int i = 0; i < 14; ++i) {
    const bool is_chair = i % 2 == 0;
    const double needed_m = is_chair ? 0.6 : 0.4;
    const DoorRoom room{needed_m + random.uniform(-0.22, 0.22), random.uniform(2.0, 13.0),
                        random.uniform(0.1, 0.5)};
    const Scene scene(room.world(), is_chair ? testChair().solid : benchSolid());
    const Pose2 start(random.uniform(2.0, 5.0), random.uniform(2.0, 13.0), random.uniform(-3, 3));
    const Pose2 goal(random.uniform(10.0, 13.0), random.uniform(2.0, 13.0), random.uniform(-3, 3));
    const bool is_shut_out = scene.isShutOut(start, goal);
    const bool gets_through = scene.getsThrough(room);
    EXPECT_FALSE(gets_through && is_shut_out) << room.door_m << " m at " << room.door_y_m;
    if (room.door_m < needed_m - 0.15) {
      EXPECT_TRUE(is_shut_out) << room.door_m << " m at " << room.door_y_m;
    }
    through += gets_through;
    noticed += is_shut_out;
  }
  EXPECT_GT(through, 3);
  EXPECT_GT(noticed, 3);
}

TEST(OutlineFlood, isLenientAroundAStartThatOverlapsSomething) {
  WorldModel world = emptyRoom();
  for (const double side : {-1.0, 1.0}) {
    world.boxes.push_back(standing("plank", 4.0, 7.5 + 0.27 * side, 0.1, 0.06, 1.0));
  }
  const Scene scene(world, testChair().solid);
  const Pose2 start(4.0, 7.5, 0.0);
  EXPECT_TRUE(scene.isShutOut(start, Pose2(10.0, 7.5, 0.0)));
  EXPECT_FALSE(scene.isShutOut(start, Pose2(10.0, 7.5, 0.0), 0.3));
}

TEST(OutlineFlood, saysNothingWithoutPatience) {
  const DoorRoom room{0.3, 7.5, 0.2};
  const Scene scene(room.world(), testChair().solid);
  const Patience none([] { return true; });
  const OutlineFlood flood({scene.sweeps,
                            scene.object,
                            scene.radius_m,
                            Pose2(4.0, 7.0, 0.0),
                            Pose2(11.0, 7.0, 0.0),
                            {0.3, 0.5},
                            0.0,
                            kStep_m,
                            kStep_rad},
                           scene.clearance, none);
  EXPECT_FALSE(flood.isShutOut());
}

TEST(NarrowPlace, isTheDoorAndToldInItsWidth) {
  const DoorRoom room{0.5, 6.0, 0.2};
  const Scene scene(room.world(), testChair().solid);
  std::vector<Eigen::Vector2d> way;
  for (double x = 6.5; x < 8.5; x += 0.05) way.emplace_back(x, 6.1);
  const auto place = narrowestPlace(scene.checker.columns(), testChair().solid, way);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->where_m.x(), kWallX_m, 0.2);
  EXPECT_NEAR(place->width_m, 0.5, 0.1);
  EXPECT_NEAR(place->needed_m, 0.6, 1e-3);
  EXPECT_FALSE(narrowestPlace(scene.checker.columns(), testChair().solid, {{3.0, 3.0}}));
}

// Nothing lies above or below its origin, which gets through everything. (With one side open it
// would get through narrow doors, around a post.)
ObjectModel frame() {
  ObjectModel frame;
  frame.name = "chair";
  frame.solid = {upright(Box{{0.62, 0.16, 0.3}}, 0, 0.25, 0.2, "left"),
                 upright(Box{{0.62, 0.16, 0.3}}, 0, -0.25, 0.2, "right"),
                 upright(Box{{0.16, 0.66, 0.3}}, 0.23, 0, 0.2, "front"),
                 upright(Box{{0.16, 0.66, 0.3}}, -0.23, 0, 0.2, "back")};
  frame.radius_m = circumscribedRadius(frame.solid);
  frame.gyration_radius_m = 0.3;
  return frame;
}

// Long before the search is used up.
TEST(PushPlanner, saysWhichDoorIsTooNarrowForTheWholeOutline) {
  const DoorRoom room{0.45, 7.0, 0.2};
  for (const PlannerKind kind : {PlannerKind::kExpRrt, PlannerKind::kLattice}) {
    PushPlannerOptions options = PushPlannerOptions::forPlanner(kind);
    options.max_nodes = 20000;
    const PushPlanner planner(mapOf(room.world()), testRobot(), {{"chair", frame()}}, options);
    const PlanResult result = planner.plan(requestFor(kStart, kGoal), syntheticPushes(14, 7));
    EXPECT_EQ(result.status, PlanStatus::kUnreachable);
    EXPECT_NE(result.explanation.find("goal region cannot be reached: at (7."), std::string::npos)
        << result.explanation;
    EXPECT_NE(result.explanation.find("needs more than 0.6"), std::string::npos)
        << result.explanation;
    if (kind == PlannerKind::kExpRrt) {
      EXPECT_LT(result.nodes, 8000);
    }
  }
}

TEST(PushPlanner, saysWhichDoorIsTooNarrowForTheOrigin) {
  const DoorRoom room{0.3, 7.0, 0.2};
  for (const PlannerKind kind : {PlannerKind::kExpRrt, PlannerKind::kLattice}) {
    const auto planner = plannerFor(room.world(), PushPlannerOptions::forPlanner(kind));
    const PlanResult result = planner->plan(requestFor(kStart, kGoal), syntheticPushes(14, 7));
    EXPECT_EQ(result.status, PlanStatus::kUnreachable);
    EXPECT_NE(result.explanation.find("goal region cannot be reached: at (7."), std::string::npos)
        << result.explanation;
    EXPECT_NE(result.explanation.find("needs more than 0.60 m"), std::string::npos)
        << result.explanation;
    EXPECT_LT(result.nodes, 10);
  }
}

// Cells that another object only touches must not count as occupied.
TEST(PushPlanner, doesNotTakeAnObjectForShutInBesideAnother) {
  for (const PlannerKind kind : {PlannerKind::kExpRrt, PlannerKind::kLattice}) {
    const auto planner = plannerFor(emptyRoom(), PushPlannerOptions::forPlanner(kind));
    for (int i = 0; i < 24; ++i) {
      const double bearing_rad = i * M_PI / 12.0;
      const Pose2 start(4.0 + 0.013 * i, 7.5, 0.0);
      PlanRequest request = requestFor(start, kGoal);
      request.obstacles = {{"chair_2", "chair",
                            Pose2(start.x() + 0.602 * std::cos(bearing_rad),
                                  start.y() + 0.602 * std::sin(bearing_rad), 1.0)}};
      const PlanResult result =
          planner->plan(request, {syntheticPush(1, bearing_rad, 2.0, 0.0, {})});
      EXPECT_EQ(result.status, PlanStatus::kUnreachable);
      EXPECT_EQ(result.explanation.find("cannot be reached"), std::string::npos)
          << toString(kind) << ", " << bearing_rad << " rad: " << result.explanation;
    }
  }
}

// The same door in a room where the object gets through.
TEST(PushPlanner, goesThroughADoorThatIsJustWideEnough) {
  const DoorRoom room{1.0, 7.0, 0.2};
  const auto planner = plannerFor(room.world(), quick());
  const PlanResult result = planner->plan(requestFor(kStart, kGoal), syntheticPushes(14, 7));
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
}

}  // namespace
}  // namespace casepush
