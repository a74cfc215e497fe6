#include "watches.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr double kLostAfterS = 2.0;
constexpr double kClockSlackS = 0.5;
constexpr double kLongestTickS = 0.2;
// How far apart two estimates of a resting object may be: in so many of their standard deviations,
// at least, and at most.
constexpr double kSameSigmas = 5.0;
constexpr double kSamePlaceM = 0.01;
constexpr double kSameYawRad = 0.03;
constexpr double kFarPlaceM = 0.04;
constexpr double kFarYawRad = 0.1;

}  // namespace

RobotWatch::Status RobotWatch::check(const Observation& observation) {
  if (!std::isfinite(observation.stamp_s)) {
    return Status::kStale;
  }
  const bool is_fresh = observation.map_T_robot.isFinite() &&
                        observation.stamp_s - observation.robot_stamp_s <= stale_s_;
  const double stale_for_s = silence_.update(observation.stamp_s, !is_fresh);
  if (is_fresh) {
    return Status::kFresh;
  }
  return stale_for_s > kLostAfterS ? Status::kLost : Status::kStale;
}

std::optional<double> TickClock::advance(double stamp_s) {
  const double dt_s = last_s_ ? stamp_s - *last_s_ : 0.0;
  if (dt_s < -kClockSlackS) {
    return std::nullopt;
  }
  last_s_ = last_s_ ? std::max(stamp_s, *last_s_) : stamp_s;
  return std::clamp(dt_s, 0.0, kLongestTickS);
}

RestWatch::RestWatch(const ExecutePushOptions& options)
    : speed_mps_(options.rest_speed_mps),
      yaw_rate_rps_(options.rest_yaw_rate_rps),
      time_s_(options.rest_time_s) {}

void RestWatch::reset() {
  last_stamp_s_.reset();
  at_rest_ = false;
}

bool RestWatch::isAtRest(const ObjectState& object) {
  if (last_stamp_s_ && object.stamp_s <= *last_stamp_s_) {
    return at_rest_;
  }
  const bool is_first = !last_stamp_s_;
  last_stamp_s_ = object.stamp_s;
  const bool is_slow = !object.moving && object.twist.speed() < speed_mps_ &&
                       std::abs(object.twist.wz_rps) < yaw_rate_rps_;
  const Eigen::Vector3d variance = object.covariance.diagonal().cwiseMax(0.0);
  const double scatter_m = kSameSigmas * std::sqrt(variance.head<2>().maxCoeff());
  const double scatter_rad = kSameSigmas * std::sqrt(variance.z());
  const bool is_here =
      distance(object.map_T_object, began_at_) < std::clamp(scatter_m, kSamePlaceM, kFarPlaceM) &&
      std::abs(yawDifference(object.map_T_object, began_at_)) <
          std::clamp(scatter_rad, kSameYawRad, kFarYawRad);
  if (is_first || !is_slow || !is_here) {
    began_at_ = object.map_T_object;
    began_s_ = object.stamp_s;
  }
  at_rest_ = is_slow && object.stamp_s - began_s_ >= time_s_;
  return at_rest_;
}

bool HoldWatch::isHeld(double now_s, double off_m) {
  if (off_m <= far_m_) {
    far_since_s_.reset();
    return false;
  }
  far_since_s_ = far_since_s_.value_or(now_s);
  return now_s - *far_since_s_ >= time_s_;
}

bool isUsable(const ObjectState& object) {
  return object.map_T_object.isFinite() && object.twist.isFinite() && std::isfinite(object.stamp_s);
}

const ObjectState* usableObject(const Observation& observation, const std::string& id) {
  const ObjectState* object = observation.object(id);
  return object != nullptr && isUsable(*object) ? object : nullptr;
}

}  // namespace casepush
