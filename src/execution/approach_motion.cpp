#include "approach_motion.h"

#include <cmath>
#include <cstdio>
#include <utility>

namespace casepush {
namespace {

constexpr int kMaxPlans = 20;
constexpr int kMaxDocks = 4;
// Shift of the start pose that asks for a new path: far off the estimate of the object is rough.
constexpr double kFarShiftM = 0.08;
constexpr double kFarShiftRad = 0.15;
constexpr double kNearM = 1.0;
constexpr double kNearShiftM = 0.03;
constexpr double kNearShiftRad = 0.06;
// Without headway for so long, something is in the way.
constexpr double kStalledS = 5.0;
constexpr double kSettleTimeoutS = 6.0;
constexpr double kStandingSpeedMps = 0.03;
constexpr double kStandingYawRateRps = 0.05;

std::string centimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f cm", 100.0 * metres);
  return text;
}

}  // namespace

ApproachMotion::ApproachMotion(std::string object_id, const PushTrajectory& trajectory,
                               const RobotLimits& limits, ApproachPlanner planner,
                               const ExecutePushOptions& options)
    : object_id_(std::move(object_id)),
      object_T_start_(trajectory.start_T_robot.front()),
      object_yaw_direction_(trajectory.startDirectionRad()),
      limits_(limits),
      planner_(std::move(planner)),
      options_(options),
      rest_(options) {}

ApproachMotion::Step ApproachMotion::fail(PushOutcome outcome,
                                          const std::string& explanation) const {
  Step step;
  step.failure = Failure{outcome, explanation};
  return step;
}

Pose2 ApproachMotion::startPose(const ObjectState& object) const {
  return object.map_T_object * object_T_start_;
}

bool ApproachMotion::hasShifted(const ObjectState& object, double position_m,
                                double yaw_rad) const {
  const Pose2 start = startPose(object);
  return distance(planned_map_T_start_, start) > position_m ||
         std::abs(yawDifference(planned_map_T_start_, start)) > yaw_rad;
}

bool ApproachMotion::isInPlace(const Observation& observation, const Pose2& map_T_start) const {
  const Twist2& twist = observation.robot_twist;
  return distance(observation.map_T_robot, map_T_start) <= options_.dock_tolerance_m &&
         std::abs(yawDifference(observation.map_T_robot, map_T_start)) <=
             options_.dock_tolerance_rad &&
         twist.speed() < kStandingSpeedMps && std::abs(twist.wz_rps) < kStandingYawRateRps;
}

ApproachMotion::Step ApproachMotion::step(const Observation& observation, const ObjectState* object,
                                          double dt_s) {
  if (!stage_began_s_) {
    stage_began_s_ = observation.stamp_s;
  }
  if (object == nullptr || stage_ == Stage::kWait) {
    return wait(observation, object);
  }
  return stage_ == Stage::kFollow ? follow(observation, *object, dt_s)
                                  : settle(observation, *object);
}

ApproachMotion::Step ApproachMotion::wait(const Observation& observation,
                                          const ObjectState* object) {
  const double waited_s = observation.stamp_s - *stage_began_s_;
  if (object == nullptr) {
    return waited_s > options_.lost_object_s
               ? fail(PushOutcome::kObjectLost, object_id_ + " has not been seen")
               : Step{};
  }
  if (object->moving) {
    return waited_s > options_.rest_timeout_s
               ? fail(PushOutcome::kTimeout, object_id_ + " does not come to rest")
               : Step{};
  }
  return plan(observation, *object);
}

ApproachMotion::Step ApproachMotion::plan(const Observation& observation,
                                          const ObjectState& object) {
  if (++plans_ > kMaxPlans) {
    return fail(PushOutcome::kApproachFailed,
                "gave up after " + std::to_string(kMaxPlans) + " approach paths to " + object_id_);
  }
  planned_map_T_start_ = startPose(object);
  const RobotPath path = planner_(observation, planned_map_T_start_,
                                  wrapAngle(object.map_T_object.yaw() + object_yaw_direction_));
  if (!path.found || path.waypoints.empty()) {
    return fail(PushOutcome::kApproachFailed,
                path.explanation.empty() ? "no path to the start of the push" : path.explanation);
  }
  follower_.emplace(path.waypoints, limits_,
                    PathFollower::Speeds{options_.approach_speed_mps, options_.dock_speed_mps});
  bystanders_.note(observation, object_id_, path.waypoints);
  stage_ = Stage::kFollow;
  stage_began_s_ = observation.stamp_s;
  stalled_since_s_ = observation.stamp_s;
  last_remaining_ = follower_->remaining();
  return Step{};
}

ApproachMotion::Step ApproachMotion::follow(const Observation& observation,
                                            const ObjectState& object, double dt_s) {
  const bool is_near = follower_->remaining() < kNearM;
  if (!object.moving && hasShifted(object, is_near ? kNearShiftM : kFarShiftM,
                                   is_near ? kNearShiftRad : kFarShiftRad)) {
    return plan(observation, object);
  }
  if (bystanders_.haveChanged(observation)) {
    return plan(observation, object);
  }
  if (is_near) rest_.isAtRest(object);  // Then one look is enough once the robot stands.
  const Reference reference = follower_->advance(dt_s, observation.map_T_robot);
  if (follower_->remaining() < last_remaining_ - 0.01) {
    last_remaining_ = follower_->remaining();
    stalled_since_s_ = observation.stamp_s;
  } else if (observation.stamp_s - *stalled_since_s_ > kStalledS && !follower_->atEnd()) {
    return plan(observation, object);
  }
  if (follower_->atEnd()) {
    stage_ = Stage::kSettle;
    stage_began_s_ = observation.stamp_s;
  }
  Step step;
  step.wanted =
      track(observation.map_T_robot, reference, {options_.position_gain, options_.yaw_gain});
  return step;
}

ApproachMotion::Step ApproachMotion::settle(const Observation& observation,
                                            const ObjectState& object) {
  // What was seen before the robot came to a stop does not count.
  const bool is_seen = object.stamp_s >= *stage_began_s_;
  const bool at_rest = is_seen && rest_.isAtRest(object);
  const Pose2 map_T_start = at_rest ? startPose(object) : planned_map_T_start_;
  const double waited_s = observation.stamp_s - *stage_began_s_;
  if (at_rest &&
      hasShifted(object, 2.0 * options_.dock_tolerance_m, 2.0 * options_.dock_tolerance_rad)) {
    if (++docks_ >= kMaxDocks) {
      return fail(
          PushOutcome::kApproachFailed,
          object_id_ + " was moved " + std::to_string(kMaxDocks) + " times by docking at it");
    }
    return plan(observation, object);
  }
  if (at_rest && isInPlace(observation, map_T_start)) {
    Step step;
    step.arrived = true;
    return step;
  }
  if (!is_seen && waited_s > options_.lost_object_s) {
    return fail(PushOutcome::kObjectLost,
                object_id_ + " is not in sight where it should be pushed");
  }
  if (at_rest && waited_s > kSettleTimeoutS) {
    return fail(PushOutcome::kApproachFailed,
                "stuck " + centimetres(distance(observation.map_T_robot, map_T_start)) +
                    " from the start of the push");
  }
  if (waited_s > options_.rest_timeout_s) {
    return fail(PushOutcome::kTimeout, object_id_ + " does not come to rest");
  }
  Step step;
  step.wanted = track(observation.map_T_robot, {map_T_start, Twist2{}},
                      {options_.position_gain, options_.yaw_gain});
  return step;
}

std::string ApproachMotion::describe() const {
  if (stage_ == Stage::kWait || !follower_) {
    return "waiting for " + object_id_ + " to be seen at rest";
  }
  if (stage_ == Stage::kSettle) {
    return "settling beside " + object_id_;
  }
  char text[32];
  std::snprintf(text, sizeof(text), ", %.1f m to go", follower_->remaining());
  return (docking() ? "docking at " : "approaching ") + object_id_ + text;
}

}  // namespace casepush
