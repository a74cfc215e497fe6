#pragma once

#include <vector>

#include "casepush/world/sweep_checker.h"
#include "world/random_scene.h"

namespace casepush {

/// A push as the planner tests it: the object on a curved path and at points around its end, the
/// robot behind it.
struct RandomMotion {
  std::vector<Pose2> object;
  std::vector<Pose2> ends;
  std::vector<Pose2> robot;
};

inline RandomMotion randomMotion(Random* random, int poses, double contact_m = 0.75) {
  RandomMotion motion;
  const double bearing = random->uniform(-M_PI, M_PI);
  const double length_m = random->uniform(0.2, 1.4);
  const Eigen::Vector3d twist(length_m * std::cos(bearing), length_m * std::sin(bearing),
                              random->uniform(-1.0, 1.0));
  const Pose2 object_T_robot(-contact_m * std::cos(bearing), -contact_m * std::sin(bearing),
                             bearing);
  for (int i = 0; i < poses; ++i) {
    motion.object.push_back(expSe2(twist * i / (poses - 1.0)));
    motion.robot.push_back(motion.object.back() * object_T_robot);
  }
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d off(random->uniform(-0.1, 0.1), random->uniform(-0.1, 0.1),
                              random->uniform(-0.2, 0.2));
    motion.ends.push_back(motion.object.back() * expSe2(off));
  }
  return motion;
}

inline std::vector<Track> tracksOf(const RandomMotion& motion,
                                   const std::shared_ptr<const Footprint>& object,
                                   const std::shared_ptr<const Footprint>& robot) {
  return {{object, motion.object, Track::Kind::kPath},
          {object, motion.ends, Track::Kind::kSeparate},
          {robot, motion.robot, Track::Kind::kPath}};
}

/// A round base with a slimmer body.
inline Solid roundRobot() {
  return {{Cylinder{0.26, 0.30}, placed(0.0, 0.0, 0.17), "base"},
          {Cylinder{0.18, 0.90}, placed(0.0, 0.0, 0.80), "body"}};
}

inline Solid leaningSolid() {
  Solid solid = overbedTable();
  solid.push_back({Box{{0.4, 0.05, 0.5}}, placed(-0.2, 0.1, 0.4, 0.3, 0.5), "back"});
  solid.push_back({Sphere{0.12}, placed(0.3, -0.2, 0.3), "ball"});
  return solid;
}

}  // namespace casepush
