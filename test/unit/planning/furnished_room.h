#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/object_model.h"
#include "casepush/model/robot_model.h"
#include "casepush/world/collision_checker.h"
#include "casepush/world/map.h"

namespace casepush {

inline PlacedShape upright(const Shape& shape, double x, double y, double z, std::string part) {
  return {shape, Eigen::Isometry3d(Eigen::Translation3d(x, y, z)), std::move(part)};
}

/// A chair: star base, column, seat, backrest.
inline ObjectModel testChair() {
  ObjectModel chair;
  chair.name = "chair";
  chair.class_name = "chair";
  chair.solid = {upright(Cylinder{0.30, 0.12}, 0, 0, 0.06, "base"),
                 upright(Cylinder{0.04, 0.30}, 0, 0, 0.27, "column"),
                 upright(Cylinder{0.25, 0.08}, 0, 0, 0.46, "seat"),
                 upright(Box{{0.06, 0.44, 0.45}}, -0.24, 0, 0.73, "backrest")};
  chair.radius_m = circumscribedRadius(chair.solid);
  chair.gyration_radius_m = 0.2;
  return chair;
}

inline RobotModel testRobot() {
  RobotModel robot;
  robot.name = "robot";
  robot.solid = {upright(Cylinder{0.26, 0.30}, 0, 0, 0.17, "base"),
                 upright(Cylinder{0.18, 0.90}, 0, 0, 0.80, "body")};
  robot.radius_m = circumscribedRadius(robot.solid);
  return robot;
}

inline StaticBox standing(const std::string& name, double x, double y, double size_x, double size_y,
                          double height, double floor_gap = 0.0) {
  StaticBox box;
  box.name = name;
  box.box.size_m = {size_x, size_y, height - floor_gap};
  box.map_T_box = Eigen::Translation3d(x, y, 0.5 * (height + floor_gap));
  return box;
}

/// 15 m x 15 m with outer walls only.
inline WorldModel emptyRoom() {
  WorldModel world;
  world.name = "room";
  world.min_m = {0, 0};
  world.max_m = {15, 15};
  world.boxes = {
      standing("south", 7.5, 0.05, 15, 0.1, 1.5), standing("north", 7.5, 14.95, 15, 0.1, 1.5),
      standing("west", 0.05, 7.5, 0.1, 14.8, 1.5), standing("east", 14.95, 7.5, 0.1, 14.8, 1.5)};
  return world;
}

/// The same with partitions, tables, cupboards and low boxes.
inline WorldModel furnishedRoom() {
  WorldModel world = emptyRoom();
  const std::vector<StaticBox> furniture = {standing("partition_south", 7.5, 2.6, 0.1, 5.0, 1.5),
                                            standing("partition_north", 7.5, 12.4, 0.1, 5.0, 1.5),
                                            standing("partition_west", 2.5, 7.5, 4.8, 0.1, 1.5),
                                            standing("partition_east", 12.5, 7.5, 4.8, 0.1, 1.5),
                                            standing("cupboard", 3.0, 0.4, 1.6, 0.5, 1.4),
                                            standing("sofa", 11.5, 14.4, 2.0, 0.9, 0.8),
                                            standing("box", 10.8, 3.2, 0.6, 0.6, 0.4),
                                            standing("low_table", 3.2, 11.4, 1.2, 0.7, 0.45),
                                            standing("table_top", 11.5, 10.8, 1.6, 0.8, 0.75, 0.72),
                                            standing("table_leg_1", 10.8, 10.5, 0.06, 0.06, 0.72),
                                            standing("table_leg_2", 12.2, 10.5, 0.06, 0.06, 0.72),
                                            standing("table_leg_3", 10.8, 11.1, 0.06, 0.06, 0.72),
                                            standing("table_leg_4", 12.2, 11.1, 0.06, 0.06, 0.72)};
  world.boxes.insert(world.boxes.end(), furniture.begin(), furniture.end());
  return world;
}

inline std::shared_ptr<const Map> mapOf(const WorldModel& world) {
  constexpr double kResolution_m = 0.05;
  auto map = std::make_shared<Map>(kResolution_m);
  map->addSurvey(surveyPoints(world, kResolution_m));
  return map;
}

/// A random pose in the room where the footprint is free.
inline Pose2 randomFreePose(const CollisionChecker& checker, const Footprint& footprint,
                            Random* random) {
  while (true) {
    const double x = random->uniform(0.0, 15.0);
    const double y = random->uniform(0.0, 15.0);
    const Pose2 pose(x, y, random->uniform(-3.14159, 3.14159));
    if (!checker.collides(footprint, pose)) {
      return pose;
    }
  }
}

}  // namespace casepush
