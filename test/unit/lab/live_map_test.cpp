#include "casepush/world/live_map.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "casepush/common/input_error.h"
#include "casepush/model/catalog.h"
#include "casepush/sim/simulator.h"
#include "casepush/world/collision_checker.h"

namespace casepush {
namespace {

using Cells = std::set<std::array<int, 3>>;
constexpr double kResolution_m = 0.05;
const Pose2 kChair(0.8, 0.6, 0.5);

StaticBox box(const std::string& name, double x_m, double y_m, Eigen::Vector3d size_m) {
  StaticBox result{name, {size_m}, Eigen::Isometry3d::Identity()};
  result.map_T_box.translation() << x_m, y_m, size_m.z() / 2.0;
  return result;
}

/// A room of 6 m x 6 m with a cabinet and a pillar; walls' faces lie amid cells.
WorldModel room(bool with_chair, bool with_crate = false) {
  WorldModel world;
  world.name = "room";
  world.min_m = {-3.2, -3.2};
  world.max_m = {3.2, 3.2};
  const double wall_m = 3.075;
  world.boxes = {
      box("west", -wall_m, 0.0, {0.1, 6.2, 1.5}),  box("east", wall_m, 0.0, {0.1, 6.2, 1.5}),
      box("south", 0.0, -wall_m, {6.0, 0.1, 1.5}), box("north", 0.0, wall_m, {6.0, 0.1, 1.5}),
      box("cabinet", 1.8, 2.2, {0.85, 0.45, 1.2}), box("pillar", -1.8, -1.6, {0.35, 0.35, 1.5})};
  if (with_crate) world.boxes.push_back(box("crate", 1.025, -1.0, {0.5, 0.5, 0.6}));
  if (with_chair) world.objects = {{"chair_1", "office_chair", kChair}};
  world.map_T_robot = Pose2(-2.0, 2.0, 0.0);
  return world;
}

/// Places from which all of the room can be seen.
std::vector<Pose2> viewpoints() {
  std::vector<Pose2> poses;
  for (const Eigen::Vector2d& position :
       {Eigen::Vector2d(-2.2, 2.2), Eigen::Vector2d(-0.2, 1.9), Eigen::Vector2d(2.3, 1.2),
        Eigen::Vector2d(2.3, -2.2), Eigen::Vector2d(0.0, -2.2), Eigen::Vector2d(-0.8, -0.4)}) {
    for (int turn = 0; turn < 2; ++turn) {
      poses.emplace_back(position.x(), position.y(), 0.2 + turn * M_PI);
    }
  }
  return poses;
}

/// A simulated room with the robot that scans it, and the map that it makes.
class Scene {
 public:
  explicit Scene(const WorldModel& world, bool noise = true)
      : catalog_(Catalog::standard()),
        robot_(catalog_.robotOf(world)),
        simulator_(world, robot_, catalog_.objectsOf(world), options(noise)) {
    simulator_.setScanning(true);
  }

  LiveMap emptyMap() const { return liveMap(Map(kResolution_m)); }
  LiveMap liveMap(Map start) const {
    return {std::move(start), robot_, {{"office_chair", catalog_.object("office_chair")}}, {}};
  }
  std::vector<ObjectState> objects() const {
    ObjectState state;
    state.id = "chair_1";
    state.model = "office_chair";
    state.map_T_object = simulator_.trueObjectPose(state.id);
    state.stamp_s = simulator_.time();
    return {state};
  }

  /// Goes on until there is a scan and integrates it.
  LiveMap::Integration scan(LiveMap* map) {
    const RangeScan scan = next();
    const Pose2 map_T_robot = simulator_.trueRobotPose();
    Eigen::Isometry3d map_T_sensor = Eigen::Isometry3d::Identity();
    map_T_sensor.translation() << map_T_robot.position(), 0.0;
    map_T_sensor.rotate(Eigen::AngleAxisd(map_T_robot.yaw(), Eigen::Vector3d::UnitZ()));
    return map->integrate(scan, map_T_sensor * robot_.range_sensors.front().base_T_sensor,
                          map_T_robot);
  }

  void tour(LiveMap* map, int rounds, bool tracked) {
    for (int round = 0; round < rounds; ++round) {
      for (const Pose2& pose : viewpoints()) {
        simulator_.setPose("robot", pose);
        if (tracked) map->observe(objects());
        scan(map);
      }
    }
  }

  Simulator& simulator() { return simulator_; }
  Solid chair() const { return catalog_.object("office_chair").solid; }

 private:
  static SimulatorOptions options(bool noise) {
    SimulatorOptions options;
    options.sensor_noise = noise;
    return options;
  }
  RangeScan next() {
    // What is under way was measured from an earlier place.
    simulator_.step(10);
    simulator_.takeScans();
    for (;;) {
      simulator_.step(1);
      std::vector<RangeScan> scans = simulator_.takeScans();
      if (!scans.empty()) return scans.back();
    }
  }

  Catalog catalog_;
  RobotModel robot_;
  Simulator simulator_;
};

Cells cellsOf(const Map& map) {
  Cells cells;
  for (const Map::Voxel& voxel : map.occupied()) {
    const int size = static_cast<int>(std::lround(voxel.size_m / map.resolution()));
    const Eigen::Vector3d corner =
        (voxel.centre_m.cast<double>().array() - voxel.size_m / 2.0) / map.resolution();
    for (int i = 0; i < size * size * size; ++i) {
      cells.insert({static_cast<int>(std::lround(corner.x())) + i % size,
                    static_cast<int>(std::lround(corner.y())) + i / size % size,
                    static_cast<int>(std::lround(corner.z())) + i / size / size});
    }
  }
  return cells;
}

Map surveyOf(const WorldModel& world) {
  Map map(kResolution_m);
  map.addSurvey(surveyPoints(world, kResolution_m));
  return map;
}

/// Cells of one map that have none of the other within a cell.
int strangers(const Cells& cells, const Cells& others) {
  int count = 0;
  for (const auto& cell : cells) {
    bool found = false;
    for (int i = 0; i < 27 && !found; ++i) {
      found = others.count({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1}) > 0;
    }
    count += found ? 0 : 1;
  }
  return count;
}

bool chairCollides(const Map& map, const Scene& scene, const Pose2& pose) {
  const CollisionChecker checker(map);
  return checker.collides(*checker.footprint(scene.chair()), pose);
}

bool occupiedAt(const Map& map, const Eigen::Vector3d& point) {
  const Eigen::Array3d index = (point.array() / map.resolution()).floor();
  return cellsOf(map).count({static_cast<int>(index.x()), static_cast<int>(index.y()),
                             static_cast<int>(index.z())}) > 0;
}

// What the chair hides from one place is seen from another one, but for single cells.
TEST(LiveMapTest, seesTheSameRoomWithAndWithoutFurniture) {
  for (const bool noise : {false, true}) {
    Scene empty(room(false), noise);
    LiveMap without = empty.emptyMap();
    empty.tour(&without, 2, false);
    Scene furnished(room(true), noise);
    LiveMap with = furnished.emptyMap();
    furnished.tour(&with, 2, true);
    const Cells expected = cellsOf(without.map());
    const Cells found = cellsOf(with.map());
    EXPECT_GT(expected.size(), 5000U);
    EXPECT_LE(strangers(found, expected), noise ? 4 : 0);
    EXPECT_LE(strangers(expected, found), static_cast<int>(expected.size() / 100));
    EXPECT_FALSE(chairCollides(with.map(), furnished, kChair));
  }
}

TEST(LiveMapTest, agreesWithTheSurvey) {
  Scene scene(room(true));
  LiveMap live = scene.emptyMap();
  scene.tour(&live, 2, true);
  const Cells survey = cellsOf(surveyOf(room(true)));
  const Cells found = cellsOf(live.map());
  EXPECT_EQ(strangers(found, survey), 0) << "something in the air";
}

TEST(LiveMapTest, doesNotWearWallsAway) {
  Scene scene(room(true));
  const Cells before = cellsOf(surveyOf(room(true)));
  LiveMap live = scene.liveMap(surveyOf(room(true)));
  scene.tour(&live, 4, true);
  const Cells after = cellsOf(live.map());
  int lost = 0;
  for (const auto& cell : before) lost += after.count(cell) == 0 ? 1 : 0;
  // Along edges, rays pass through the free half of a cell.
  EXPECT_LT(lost, 0.01 * static_cast<double>(before.size()));
  EXPECT_EQ(strangers(before, after), 0);
}

TEST(LiveMapTest, removesWhatAnObjectLeftBeforeItWasKnown) {
  Scene scene(room(true));
  LiveMap live = scene.emptyMap();
  scene.tour(&live, 1, false);
  ASSERT_TRUE(chairCollides(live.map(), scene, kChair));
  EXPECT_GT(live.observe(scene.objects()).cells, 50);
  EXPECT_FALSE(chairCollides(live.map(), scene, kChair));
  EXPECT_EQ(live.observe(scene.objects()).cells, 0);
  scene.simulator().setPose("robot", Pose2(-0.8, 0.6, 0.0));
  EXPECT_GT(scene.scan(&live).masked, 20);
  EXPECT_FALSE(chairCollides(live.map(), scene, kChair));
  // What sticks out of it goes with the beams that end on it, but for single cells between beams.
  scene.tour(&live, 2, true);
  int left = 0;
  for (const auto& cell : cellsOf(live.map())) {
    const Eigen::Vector2d centre = Eigen::Vector2d(cell[0], cell[1]) * kResolution_m;
    left += (centre - kChair.position()).norm() < 0.6 ? 1 : 0;
  }
  EXPECT_LE(left, 5);
}

TEST(LiveMapTest, removesWhatAnObjectLeftWhereItIsPutAtOnce) {
  Scene scene(room(true));
  LiveMap live = scene.emptyMap();
  std::vector<ObjectState> objects = scene.objects();
  live.observe(objects);
  const Pose2 elsewhere(1.3, -0.9, 0.0);
  scene.simulator().setPose("chair_1", elsewhere);
  scene.tour(&live, 1, false);
  ASSERT_TRUE(chairCollides(live.map(), scene, elsewhere));
  objects[0].map_T_object = elsewhere;
  objects[0].moving = true;  // What moves is removed by the next scan.
  EXPECT_EQ(live.observe(objects).cells, 0);
  objects[0].moving = false;
  EXPECT_GT(live.observe(objects).cells, 50);
  EXPECT_FALSE(chairCollides(live.map(), scene, elsewhere));
}

TEST(LiveMapTest, leavesNoTrailOfAMovingObject) {
  Scene scene(room(true));
  LiveMap live = scene.emptyMap();
  scene.simulator().setPose("robot", Pose2(-2.2, 0.0, 0.0));
  for (int step = 0; step < 30; ++step) {
    const Pose2 pose(-0.5 + 0.05 * step, 0.0, 0.1 * step);
    // Tracked poses come a step, i.e. 0.1 s, late; the object moves at 0.5 m/s.
    std::vector<ObjectState> objects = scene.objects();
    objects[0].moving = true;
    objects[0].twist = {0.5, 0.0, 0.0};
    scene.simulator().setPose("chair_1", pose);
    live.observe(objects);
    scene.scan(&live);
  }
  for (const auto& cell : cellsOf(live.map())) {
    const Eigen::Vector3d centre = Eigen::Vector3d(cell[0], cell[1], cell[2]) * kResolution_m;
    EXPECT_FALSE(centre.x() > -1.2 && centre.x() < 1.6 && std::abs(centre.y()) < 0.7)
        << centre.transpose();
  }
}

TEST(LiveMapTest, noticesWhatAppearsAndWhatLeaves) {
  Scene before(room(true));
  Scene after(room(true, true));
  const Eigen::Vector3d face(0.775, -1.02, 0.37);  // Of the crate, towards the robot.
  LiveMap live = before.liveMap(surveyOf(room(true)));
  const auto scansUntil = [&](Scene* scene, bool wanted) {
    scene->simulator().setPose("robot", Pose2(-0.8, -1.0, 0.0));
    live.observe(scene->objects());
    int scans = 0;
    while (occupiedAt(live.map(), face) != wanted && scans < 50) {
      scene->scan(&live);
      ++scans;
    }
    return scans;
  };
  for (int i = 0; i < 10; ++i) before.scan(&live);
  const int appear = scansUntil(&after, true);
  for (int i = 0; i < 10; ++i) after.scan(&live);
  const int leave = scansUntil(&before, false);
  EXPECT_LE(appear, 5);
  EXPECT_LE(leave, 12);
  EXPECT_GT(leave, 1);
}

TEST(LiveMapTest, refusesPosesThatAreNotFinite) {
  Scene scene(room(true));
  LiveMap live = scene.emptyMap();
  Eigen::Isometry3d nowhere = Eigen::Isometry3d::Identity();
  nowhere.translation().x() = std::nan("");
  RangeScan scan;
  scan.sensor = "scanner";
  EXPECT_THROW(live.integrate(scan, nowhere, Pose2()), InputError);
  LiveMapOptions options;
  options.max_range_m = -1.0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace casepush
