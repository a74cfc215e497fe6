#include "casepush/execution/demonstration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "casepush/common/violations.h"
#include "casepush/world/collision_checker.h"
#include "push_recorder.h"
#include "watches.h"

namespace casepush {
namespace {

// More often than this would add nothing but memory.
constexpr double kSampleS = 0.015;
constexpr int kBearings = 12;
// Seen to be displaced by more than its estimate scatters.
constexpr double kNoticeableM = 0.02;
constexpr double kNoticeableRad = 0.05;
constexpr double kStandingMps = 0.02;
constexpr double kStandingRps = 0.03;
// Below the robot's limit, so that a replay can follow.
constexpr double kRunUpShare = 0.8;

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", value);
  return text;
}

bool isStanding(const Twist2& twist) {
  return twist.speed() < kStandingMps && std::abs(twist.wz_rps) < kStandingRps;
}

}  // namespace

void DemonstrationOptions::validate() const {
  Violations violations;
  violations.require("sample_period_s", sample_period_s, 0.02, 1.0);
  violations.require("contact_gap_m", contact_gap_m, 0.005, 0.5);
  violations.require("min_displacement_m", min_displacement_m, 0.03, 10.0);
  violations.require("min_rotation_rad", min_rotation_rad, 0.06, 3.0);
  violations.require("max_push_s", max_push_s, 0.5, 60.0);
  violations.require("max_recording_s", max_recording_s, 1.0, 3600.0);
  violations.require("lost_object_s", lost_object_s, 0.05, 60.0);
  violations.require("rest_time_s", rest_time_s, 0.05, 10.0);
  violations.throwIfAny("demonstration options");
}

Demonstration::Demonstration(std::string object_id, ObjectModel object, RobotModel robot,
                             DemonstrationOptions options)
    : object_id_(std::move(object_id)),
      object_(std::move(object)),
      robot_(std::move(robot)),
      options_(options) {
  options_.validate();
}

bool Demonstration::hasMoved(const Pose2& from, const Pose2& to) const {
  return distance(from, to) > kNoticeableM || std::abs(yawDifference(from, to)) > kNoticeableRad;
}

bool Demonstration::isTouching(const Pose2& map_T_object, const Pose2& map_T_robot) const {
  const double apart_m = distance(map_T_object, map_T_robot);
  if (apart_m > object_.radius_m + robot_.radius_m + options_.contact_gap_m) {
    return false;
  }
  for (int i = 0; i < kBearings; ++i) {
    const double bearing = 2.0 * M_PI * i / kBearings;
    const Pose2 nearer(map_T_robot.x() + options_.contact_gap_m * std::cos(bearing),
                       map_T_robot.y() + options_.contact_gap_m * std::sin(bearing),
                       map_T_robot.yaw());
    if (solidsOverlap(object_.solid, map_T_object, robot_.solid, nearer)) {
      return true;
    }
  }
  return false;
}

void Demonstration::add(const Observation& observation) {
  const ObjectState* object = usableObject(observation, object_id_);
  const bool is_new = samples_.empty() || observation.stamp_s >= samples_.back().t_s + kSampleS;
  if (object == nullptr || !is_new || !observation.map_T_robot.isFinite() ||
      !observation.robot_twist.isFinite()) {
    return;
  }
  if (!samples_.empty() && observation.stamp_s > samples_.front().t_s + options_.max_recording_s) {
    overflow_ = true;
    return;
  }
  samples_.push_back({observation.stamp_s, observation.map_T_robot, observation.robot_twist,
                      object->map_T_object, object->stamp_s, object->moving,
                      isTouching(object->map_T_object, observation.map_T_robot)});
}

std::string Demonstration::whyNothing() const {
  if (samples_.empty()) {
    return object_id_ + " was not seen; turn the robot so that a camera sees its tags";
  }
  if (overflow_) {
    return "the recording is longer than " + seconds(options_.max_recording_s) +
           "; demonstrate one push at a time";
  }
  const Pose2& first = samples_.front().map_T_robot;
  const bool robot_moved = std::any_of(samples_.begin(), samples_.end(), [&](const Sample& sample) {
    return hasMoved(first, sample.map_T_robot);
  });
  if (!robot_moved) {
    return "the robot did not move; does the joystick reach it (teleop_cmd_vel)?";
  }
  if (samples_.front().moving) {
    return object_id_ + " was moving when the demonstration began; start while it stands";
  }
  return "";
}

std::optional<std::size_t> Demonstration::firstMotion() const {
  const Pose2& start = samples_.front().map_T_object;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (hasMoved(start, samples_[i].map_T_object)) {
      return i;
    }
  }
  return std::nullopt;
}

Demonstration::Result Demonstration::findContact(Contact& contact) const {
  const std::optional<std::size_t> moved = firstMotion();
  const Sample& last = samples_.back();
  if (!moved) {
    return {std::nullopt, object_id_ + " never moved; drive the robot against it", false};
  }
  std::size_t touch = *moved;
  while (touch > 0 && !samples_[touch].touching) {
    --touch;
  }
  if (!samples_[touch].touching) {
    return {std::nullopt, object_id_ + " moved, but the robot did not touch it", false};
  }
  contact.clear = touch;
  while (contact.clear > 0 && samples_[contact.clear].touching) {
    --contact.clear;
  }
  if (samples_[contact.clear].touching) {
    return {std::nullopt,
            "the robot touched " + object_id_ + " already when the demonstration began; start " +
                "from a little distance",
            false};
  }
  // The final rest: no motion and no displacement from there to the end.
  contact.rest = samples_.size() - 1;
  while (contact.rest > 0 && !samples_[contact.rest - 1].moving &&
         !hasMoved(samples_[contact.rest - 1].map_T_object, last.map_T_object)) {
    --contact.rest;
  }
  if (last.moving || last.t_s - samples_[contact.rest].t_s < options_.rest_time_s) {
    return {std::nullopt, object_id_ + " has not come to rest yet; stop again when it stands",
            true};
  }
  contact.end = touch;
  for (std::size_t i = touch; i <= contact.rest; ++i) {
    if (samples_[i].touching && !isStanding(samples_[i].robot_twist)) {
      contact.end = i;
    }
  }
  return checkContact(contact);
}

Demonstration::Result Demonstration::checkContact(const Contact& contact) const {
  const Pose2 start_T_end = samples_.front().map_T_object.inverse() * samples_.back().map_T_object;
  if (start_T_end.position().norm() < options_.min_displacement_m &&
      std::abs(start_T_end.yaw()) < options_.min_rotation_rad) {
    return {std::nullopt, object_id_ + " hardly moved; push it farther", false};
  }
  const double push_s = samples_[contact.end].t_s - samples_[contact.clear].t_s;
  if (push_s > options_.max_push_s) {
    return {std::nullopt,
            "the push took " + seconds(push_s) + ", the longest allowed is " +
                seconds(options_.max_push_s) + "; demonstrate shorter pushes, one at a time",
            false};
  }
  double still_since_s = samples_[contact.clear].t_s;
  for (std::size_t i = contact.clear; i <= contact.rest; ++i) {
    const Sample& sample = samples_[i];
    if (sample.t_s - sample.seen_s > options_.lost_object_s) {
      return {std::nullopt,
              object_id_ + " was out of sight for more than " + seconds(options_.lost_object_s) +
                  " while it was pushed",
              false};
    }
    const bool before_motion = !hasMoved(samples_.front().map_T_object, sample.map_T_object);
    if (sample.moving || before_motion) {
      still_since_s = sample.t_s;
    }
    if (i < contact.end && sample.t_s - still_since_s > options_.rest_time_s &&
        hasMoved(sample.map_T_object, samples_.back().map_T_object)) {
      return {std::nullopt,
              object_id_ + " was pushed more than once: it came to rest in between; stop after " +
                  "each push",
              false};
    }
  }
  return {};
}

Case Demonstration::record(const Contact& contact) const {
  const Sample& first = samples_[contact.clear];
  // A constant acceleration to the speed that the robot had, along the way it went.
  const Twist2& twist = first.robot_twist;
  const double acceleration = kRunUpShare * robot_.limits.max_acceleration_mps2;
  const double turning = kRunUpShare * robot_.limits.max_yaw_acceleration_rps2;
  const double run_up_s = std::max(twist.speed() / acceleration, std::abs(twist.wz_rps) / turning);
  const Pose2& map_T_start = samples_.front().map_T_object;
  PushRecorder recorder(options_.sample_period_s, map_T_start);
  constexpr int kRunUpSamples = 20;
  for (int i = 0; i < kRunUpSamples && run_up_s > 1e-3; ++i) {
    const double share = static_cast<double>(i) / kRunUpSamples;
    const double left_s = 0.5 * run_up_s * (1.0 - share * share);
    const Pose2 map_T_robot =
        first.map_T_robot *
        expSe2(-left_s * Eigen::Vector3d(twist.vx_mps, twist.vy_mps, twist.wz_rps));
    recorder.add(share * run_up_s, map_T_robot, map_T_start,
                 {share * twist.vx_mps, share * twist.vy_mps, share * twist.wz_rps});
  }
  for (std::size_t i = contact.clear; i < samples_.size(); ++i) {
    const Sample& sample = samples_[i];
    const Twist2 action = i <= contact.end ? sample.robot_twist : Twist2{};
    recorder.add(run_up_s + sample.t_s - first.t_s, sample.map_T_robot, sample.map_T_object,
                 action);
    if (i == contact.end) {
      recorder.endPush();
    }
  }
  Case recorded = recorder.finish(run_up_s + samples_[contact.rest].t_s - first.t_s,
                                  samples_.back().map_T_object);
  recorded.object = object_.name;
  recorded.robot = robot_.name;
  recorded.origin = CaseOrigin::kDemonstrated;
  return recorded;
}

Demonstration::Result Demonstration::result() const {
  const std::string nothing = whyNothing();
  if (!nothing.empty()) {
    return {std::nullopt, nothing, false};
  }
  Contact contact{};
  Result result = findContact(contact);
  if (!result.explanation.empty()) {
    return result;
  }
  result.recorded = record(contact);
  const Pose2& outcome = result.recorded->start_outcome.mean;
  char text[160];
  std::snprintf(text, sizeof text,
                "a push of %.1f s that moved %s by %.2f m and turned it by %.0f deg",
                result.recorded->pushDurationS(), object_id_.c_str(), outcome.position().norm(),
                outcome.yaw() * 180.0 / M_PI);
  result.explanation = text;
  return result;
}

}  // namespace casepush
