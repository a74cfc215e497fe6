#pragma once

#include <cmath>

#include "casepush/common/random.h"
#include "casepush/model/world_model.h"
#include "casepush/world/map.h"

namespace casepush {

inline Eigen::Isometry3d placed(double x_m, double y_m, double z_m, double yaw_rad = 0.0,
                                double tilt_rad = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(x_m, y_m, z_m));
  pose.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  pose.rotate(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(0.6, 0.8, 0.0)));
  return pose;
}

/// A walled square room of the given size with randomly placed and turned boxes.
inline WorldModel randomRoom(Random* random, double size_m, int boxes) {
  WorldModel world;
  world.min_m = {0.0, 0.0};
  world.max_m = {size_m, size_m};
  const double half_m = size_m / 2.0;
  for (int side = 0; side < 4; ++side) {
    const double angle = side * M_PI / 2.0;
    world.boxes.push_back({"wall",
                           {{0.1, size_m, 1.5}},
                           placed(half_m + (half_m - 0.05) * std::cos(angle),
                                  half_m + (half_m - 0.05) * std::sin(angle), 0.75, angle)});
  }
  for (int i = 0; i < boxes; ++i) {
    const Eigen::Vector3d size(random->uniform(0.05, 0.8), random->uniform(0.05, 0.8),
                               random->uniform(0.03, 1.0));
    const double x_m = random->uniform(0.4, size_m - 0.4);
    const double y_m = random->uniform(0.4, size_m - 0.4);
    const double lift_m = random->chance(0.5) ? 0.0 : random->uniform(0.0, 1.0);
    world.boxes.push_back({"box",
                           {size},
                           placed(x_m, y_m, lift_m + size.z() / 2.0, random->uniform(-M_PI, M_PI),
                                  random->chance(0.3) ? random->uniform(0.0, 0.5) : 0.0)});
  }
  return world;
}

inline Map mapOf(const WorldModel& world, double resolution_m) {
  Map map(resolution_m);
  map.addSurvey(surveyPoints(world, resolution_m));
  return map;
}

inline Pose2 randomPose(Random* random, double low_m, double high_m) {
  const double x_m = random->uniform(low_m, high_m);
  const double y_m = random->uniform(low_m, high_m);
  return {x_m, y_m, random->uniform(-M_PI, M_PI)};
}

/// Table top on a column on a base: parts of different width at different heights.
inline Solid overbedTable() {
  return {{Box{{0.80, 0.40, 0.04}}, placed(0.1, 0.0, 0.80), "top"},
          {Cylinder{0.04, 0.70}, placed(-0.2, 0.0, 0.43), "column"},
          {Box{{0.60, 0.45, 0.08}}, placed(0.0, 0.0, 0.06), "base"}};
}

}  // namespace casepush
