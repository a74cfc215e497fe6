#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "casepush/execution/behaviour.h"
#include "casepush/model/catalog.h"
#include "casepush/perception/pose_tracker.h"
#include "casepush/sim/simulator.h"

namespace casepush {

struct LabOptions {
  SimulatorOptions simulator;
  PoseTrackerOptions tracker;
  double tick_period_s = 0.02;  ///< Of behaviours, as under ROS (50 Hz).
};

/// Simulator, tracker and behaviour in one process, without ROS, as fast as possible.
///
/// Behaviours see nothing but tracked poses; ground truth is for judging.
class ClosedLoop {
 public:
  /// @throws InputError from the catalog and the simulator.
  ClosedLoop(const Catalog& catalog, const WorldModel& world, LabOptions options);

  /// What a behaviour would see now.
  Observation observe() const;

  /// Ticks the behaviour until it ends, or fails it after `time_limit_s` of simulated time.
  /// @param watch  Called after each tick; may be empty.
  BehaviourStatus run(Behaviour& behaviour, double time_limit_s,
                      const std::function<void()>& watch = {});

  /// Lets the world go on with the robot standing still.
  void idle(double duration_s);

  /// Teleports bodies and forgets their tracks, then waits until the robot has seen them again.
  void place(const std::map<std::string, Pose2>& map_T_bodies);

  /// The world as at the start, with a new seed for the simulator; time starts at 0. What follows
  /// is as in a new loop.
  void reset(std::uint64_t seed);

  Simulator& simulator() { return simulator_; }
  const Simulator& simulator() const { return simulator_; }

  /// Contacts of robot or objects with static structure that began so far.
  int collisions() const { return collisions_; }
  /// Names of what was hit, as "chair_1/seat - desk_2".
  const std::vector<std::string>& collisionNames() const { return collision_names_; }

 private:
  void advance(const Twist2& robot_twist);
  void perceive();
  void countCollisions();
  Pose2 robotPoseAt(double stamp_s) const;

  LabOptions options_;
  Simulator simulator_;
  std::vector<TrackedObject> tracked_;
  std::unique_ptr<PoseTracker> tracker_;
  std::map<std::string, Eigen::Isometry3d> base_T_camera_;
  std::vector<std::pair<double, Pose2>> robot_poses_;  ///< Recent estimates, oldest first.
  std::set<std::string> static_names_;
  std::set<std::pair<std::string, std::string>> touching_;
  std::vector<std::string> collision_names_;
  int collisions_ = 0;
  double next_tick_s_ = 0.0;
  double placed_s_ = 0.0;  ///< Time of the last teleport.
};

}  // namespace casepush
