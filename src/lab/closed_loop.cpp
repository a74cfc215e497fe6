#include "casepush/lab/closed_loop.h"

#include <algorithm>

namespace casepush {
namespace {

constexpr double kPoseHistoryS = 1.0;
// Time for the tracker to settle on an object that was put somewhere, and for it to be seen at all.
constexpr double kLookAfterPlacingS = 0.3;
constexpr double kLookLimitS = 1.5;

std::vector<TrackedObject> trackedObjects(const Simulator& simulator) {
  std::vector<TrackedObject> tracked;
  for (const ObjectPlacement& placement : simulator.world().objects) {
    tracked.push_back({placement.id, simulator.object(placement.id), placement.tag_offset});
  }
  return tracked;
}

}  // namespace

ClosedLoop::ClosedLoop(const Catalog& catalog, const WorldModel& world, LabOptions options)
    : options_(options),
      simulator_(world, catalog.robotOf(world), catalog.objectsOf(world), options.simulator),
      tracked_(trackedObjects(simulator_)),
      tracker_(std::make_unique<PoseTracker>(tracked_, options.tracker)) {
  for (const CameraModel& camera : simulator_.robot().cameras) {
    base_T_camera_[camera.name] = camera.base_T_camera;
  }
  for (const StaticBox& box : world.boxes) {
    static_names_.insert(box.name);
  }
}

Observation ClosedLoop::observe() const {
  const OdometryReading odometry = simulator_.odometry();
  Observation observation;
  observation.stamp_s = simulator_.time();
  observation.map_T_robot = odometry.map_T_odom * odometry.odom_T_robot;
  observation.robot_stamp_s = odometry.stamp_s;
  observation.robot_twist = odometry.robot_twist;
  observation.objects = tracker_->states(observation.stamp_s);
  return observation;
}

BehaviourStatus ClosedLoop::run(Behaviour& behaviour, double time_limit_s,
                                const std::function<void()>& watch) {
  const double end_s = simulator_.time() + time_limit_s;
  while (simulator_.time() < end_s) {
    const Tick tick = behaviour.tick(observe());
    if (watch) {
      watch();
    }
    if (tick.status != BehaviourStatus::kRunning) {
      simulator_.setCommand(Twist2{});
      return tick.status;
    }
    advance(tick.command.twist);
  }
  simulator_.setCommand(Twist2{});
  return BehaviourStatus::kFailed;
}

void ClosedLoop::idle(double duration_s) {
  const double end_s = simulator_.time() + duration_s;
  while (simulator_.time() < end_s) {
    advance(Twist2{});
  }
}

void ClosedLoop::place(const std::map<std::string, Pose2>& map_T_bodies) {
  simulator_.setPoses(map_T_bodies);
  placed_s_ = simulator_.time();
  robot_poses_.clear();
  tracker_ = std::make_unique<PoseTracker>(tracked_, options_.tracker);
  const auto seen = [this](const std::string& id) {
    const Observation now = observe();
    const ObjectState* object = now.object(id);
    return object != nullptr && object->stamp_s >= placed_s_ + kLookAfterPlacingS;
  };
  for (const auto& [id, pose] : map_T_bodies) {
    const double give_up_s = placed_s_ + kLookLimitS;
    while (id != "robot" && !seen(id) && simulator_.time() < give_up_s) {
      advance(Twist2{});
    }
  }
}

void ClosedLoop::reset(std::uint64_t seed) {
  simulator_.reset(seed);
  tracker_ = std::make_unique<PoseTracker>(tracked_, options_.tracker);
  robot_poses_.clear();
  touching_.clear();
  collision_names_.clear();
  collisions_ = 0;
  next_tick_s_ = 0.0;
  placed_s_ = 0.0;
}

void ClosedLoop::advance(const Twist2& robot_twist) {
  simulator_.setCommand(robot_twist);
  // 1/50 s is no whole number of physics steps: keep the rate right on average, as a clock would.
  next_tick_s_ += options_.tick_period_s;
  if (next_tick_s_ <= simulator_.time()) {
    next_tick_s_ = simulator_.time() + options_.tick_period_s;
  }
  const double half_step_s = 0.5 * simulator_.stepSeconds();
  const int steps =
      static_cast<int>((next_tick_s_ - simulator_.time() + half_step_s) / simulator_.stepSeconds());
  simulator_.step(std::max(1, steps));
  perceive();
  countCollisions();
}

void ClosedLoop::perceive() {
  const OdometryReading odometry = simulator_.odometry();
  robot_poses_.emplace_back(odometry.stamp_s, odometry.map_T_odom * odometry.odom_T_robot);
  while (robot_poses_.front().first < odometry.stamp_s - kPoseHistoryS) {
    robot_poses_.erase(robot_poses_.begin());
  }
  for (const TagFrame& frame : simulator_.takeTagFrames()) {
    if (frame.stamp_s < placed_s_) {
      continue;  // Shows the world as it was before a teleport.
    }
    tracker_->addFrame(frame, robotPoseAt(frame.stamp_s), base_T_camera_.at(frame.camera));
  }
}

Pose2 ClosedLoop::robotPoseAt(double stamp_s) const {
  const auto after = std::lower_bound(
      robot_poses_.begin(), robot_poses_.end(), stamp_s,
      [](const std::pair<double, Pose2>& entry, double stamp) { return entry.first < stamp; });
  if (after == robot_poses_.end()) {
    return robot_poses_.back().second;
  }
  if (after == robot_poses_.begin()) {
    return after->second;
  }
  const auto before = std::prev(after);
  const double t = (stamp_s - before->first) / (after->first - before->first);
  return interpolate(before->second, after->second, t);
}

void ClosedLoop::countCollisions() {
  std::set<std::pair<std::string, std::string>> touching;
  for (const ContactReport& contact : simulator_.takeContacts()) {
    const bool a_static = static_names_.count(contact.body_a) > 0;
    const bool b_static = static_names_.count(contact.body_b) > 0;
    if (a_static == b_static) {
      continue;
    }
    const std::string& body = a_static ? contact.body_b : contact.body_a;
    const std::string& part = a_static ? contact.part_b : contact.part_a;
    const std::string& wall = a_static ? contact.body_a : contact.body_b;
    if (touching_.count({body, wall}) == 0 && touching.count({body, wall}) == 0) {
      ++collisions_;
      collision_names_.push_back(body + "/" + part + " - " + wall);
    }
    touching.insert({body, wall});
  }
  touching_ = std::move(touching);
}

}  // namespace casepush
