#include "casepush/perception/pose_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "object_track.h"

namespace casepush {
namespace {

constexpr double kMaxLatenessS = 1.0;
constexpr double kMaxPredictionS = 0.2;

Eigen::Matrix3d toObjectAxes(const Eigen::Matrix3d& map_covariance, double yaw_rad) {
  Eigen::Matrix3d object_R_map = Eigen::Matrix3d::Identity();
  object_R_map.topLeftCorner<2, 2>() << std::cos(yaw_rad), std::sin(yaw_rad), -std::sin(yaw_rad),
      std::cos(yaw_rad);
  const Eigen::Matrix3d covariance = object_R_map * map_covariance * object_R_map.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

MeasurementNoise measurementNoise(const PoseTrackerOptions& options) {
  return {options.upright_sigma_m, options.upright_sigma_rad, options.localisation_sigma_m,
          options.localisation_sigma_rad};
}

TrackOptions trackOptions(const PoseTrackerOptions& options) {
  return {{options.acceleration_noise_mps2, options.yaw_acceleration_noise_rps2},
          options.gate_p_value,
          options.reacquire_after,
          options.moving_speed_mps,
          options.moving_yaw_rate_rps};
}

}  // namespace

void PoseTrackerOptions::validate() const {
  Violations violations;
  violations.require("acceleration_noise_mps2", acceleration_noise_mps2, 0.01, 100.0);
  violations.require("yaw_acceleration_noise_rps2", yaw_acceleration_noise_rps2, 0.01, 100.0);
  violations.require("gate_p_value", gate_p_value, 1e-12, 0.1);
  violations.require("reacquire_after", reacquire_after, 1, 1000);
  violations.require("moving_speed_mps", moving_speed_mps, 0.001, 1.0);
  violations.require("moving_yaw_rate_rps", moving_yaw_rate_rps, 0.001, 1.0);
  violations.require("forget_after_s", forget_after_s, 0.1, 1e6);
  violations.require("localisation_sigma_m", localisation_sigma_m, 0.0, 1.0);
  violations.require("localisation_sigma_rad", localisation_sigma_rad, 0.0, 1.0);
  violations.require("upright_sigma_m", upright_sigma_m, 0.001, 1.0);
  violations.require("upright_sigma_rad", upright_sigma_rad, 0.001, 1.0);
  violations.throwIfAny("pose tracker options");
}

struct PoseTracker::Data {
  struct Mount {
    std::size_t object;
    Eigen::Isometry3d object_T_tag;
  };
  std::vector<TrackedObject> objects;
  PoseTrackerOptions options;
  std::map<int, Mount> mounts;  ///< By tag id.
  std::vector<ObjectTrack> tracks;
  double newest_frame_s = -std::numeric_limits<double>::infinity();
  double last_stale_s = 0.0;
  int stale_frames = 0;  ///< In a row, each within 1 s of the one before.
  int ignored = 0;

  void mountTags(std::size_t index);
  bool accepts(const TagFrame& frame, const Pose2& map_T_robot,
               const Eigen::Isometry3d& base_T_camera);
  bool isStale(double stamp_s);
};

void PoseTracker::Data::mountTags(std::size_t index) {
  const TrackedObject& object = objects[index];
  if (object.model.tags.empty()) {
    throw InputError(object.id, "object model '" + object.model.name +
                                    "' has no tags, so it can not be tracked");
  }
  for (const TagMount& tag : object.model.tags) {
    const int id = tag.id + object.tag_offset;
    const auto [other, is_new] = mounts.emplace(id, Mount{index, tag.object_T_tag});
    if (!is_new) {
      throw InputError(object.id, "tag " + std::to_string(id) + " belongs to " +
                                      objects[other->second.object].id +
                                      " too; give each instance a tag_offset of its own");
    }
  }
}

// One frame from the future would make all that follow stale. So when they go on, they are right.
bool PoseTracker::Data::isStale(double stamp_s) {
  if (stamp_s >= newest_frame_s - kMaxLatenessS) {
    stale_frames = 0;
    return false;
  }
  const bool goes_on = stale_frames > 0 && std::abs(stamp_s - last_stale_s) <= kMaxLatenessS;
  stale_frames = goes_on ? stale_frames + 1 : 1;
  last_stale_s = stamp_s;
  if (stale_frames < options.reacquire_after) {
    return true;
  }
  for (ObjectTrack& track : tracks) {
    track.forgetAfter(stamp_s);
  }
  newest_frame_s = stamp_s;
  stale_frames = 0;
  return false;
}

bool PoseTracker::Data::accepts(const TagFrame& frame, const Pose2& map_T_robot,
                                const Eigen::Isometry3d& base_T_camera) {
  if (!std::isfinite(frame.stamp_s) || !map_T_robot.isFinite() ||
      !base_T_camera.matrix().allFinite() || isStale(frame.stamp_s)) {
    return false;
  }
  newest_frame_s = std::max(newest_frame_s, frame.stamp_s);
  return true;
}

PoseTracker::PoseTracker(std::vector<TrackedObject> objects, PoseTrackerOptions options)
    : data_(std::make_unique<Data>()) {
  options.validate();
  data_->objects = std::move(objects);
  data_->options = options;
  std::set<std::string> ids;
  for (std::size_t i = 0; i < data_->objects.size(); ++i) {
    if (!ids.insert(data_->objects[i].id).second) {
      throw InputError(data_->objects[i].id, "is given twice; object ids must be unique");
    }
    data_->mountTags(i);
    data_->tracks.emplace_back(trackOptions(options));
  }
}

PoseTracker::~PoseTracker() = default;
PoseTracker::PoseTracker(PoseTracker&&) noexcept = default;
PoseTracker& PoseTracker::operator=(PoseTracker&&) noexcept = default;

void PoseTracker::addFrame(const TagFrame& frame, const Pose2& map_T_robot,
                           const Eigen::Isometry3d& base_T_camera) {
  if (!data_->accepts(frame, map_T_robot, base_T_camera)) {
    data_->ignored += std::max<int>(1, static_cast<int>(frame.detections.size()));
    return;
  }
  std::map<std::size_t, TrackImage> images;
  for (const TagDetection& detection : frame.detections) {
    const auto mount = data_->mounts.find(detection.id);
    if (mount == data_->mounts.end()) {
      ++data_->ignored;
      continue;
    }
    const TagView view{map_T_robot, base_T_camera, mount->second.object_T_tag};
    const auto measurement = measureObject(detection, view, measurementNoise(data_->options),
                                           data_->options.gate_p_value);
    if (!measurement) {
      ++data_->ignored;
      continue;
    }
    TrackImage& image = images[mount->second.object];
    image.stamp_s = frame.stamp_s;
    image.map_T_robot = map_T_robot;
    image.measurements.push_back(*measurement);
  }
  for (auto& [object, image] : images) {
    data_->ignored += data_->tracks[object].add(std::move(image));
  }
}

std::vector<ObjectState> PoseTracker::states(double now_s) const {
  std::vector<ObjectState> states;
  for (std::size_t i = 0; i < data_->objects.size(); ++i) {
    const ObjectTrack& track = data_->tracks[i];
    if (!track.isSeen() || now_s - track.lastSeenS() > data_->options.forget_after_s) {
      continue;
    }
    const double ahead_s = std::clamp(now_s - track.lastSeenS(), 0.0, kMaxPredictionS);
    const MotionFilter::Estimate estimate = track.predicted(track.lastSeenS() + ahead_s);
    const Pose2& pose = estimate.map_T_object;
    // The robot's own error hardly changes from image to image, so that averaging does not remove
    // it from the estimate.
    const Eigen::Matrix3d map_covariance =
        estimate.covariance + localisationCovariance(track.lastRobotPose(), pose.position(),
                                                     measurementNoise(data_->options));
    ObjectState state;
    state.id = data_->objects[i].id;
    state.model = data_->objects[i].model.name;
    state.map_T_object = pose;
    state.covariance = toObjectAxes(map_covariance, pose.yaw());
    const Eigen::Vector3d& velocity = estimate.map_velocity;
    state.twist = rotate(Twist2{velocity.x(), velocity.y(), velocity.z()}, -pose.yaw());
    state.stamp_s = track.lastSeenS();
    state.moving = track.isMoving();
    states.push_back(state);
  }
  return states;
}

int PoseTracker::ignoredDetections() const { return data_->ignored; }

void PoseTracker::clear() {
  for (ObjectTrack& track : data_->tracks) {
    track.clear();
  }
  data_->newest_frame_s = -std::numeric_limits<double>::infinity();
  data_->stale_frames = 0;
}

}  // namespace casepush
