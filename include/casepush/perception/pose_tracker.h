#pragma once

#include <memory>
#include <string>
#include <vector>

#include "casepush/model/object_model.h"
#include "casepush/model/observation.h"
#include "casepush/model/tag_detection.h"

namespace casepush {

struct PoseTrackerOptions {
  double acceleration_noise_mps2 = 1.5;  ///< Process noise while an object is pushed.
  double yaw_acceleration_noise_rps2 = 4.0;
  double gate_p_value = 1e-4;      ///< Detections less probable than this are outliers.
  int reacquire_after = 5;         ///< Consecutive outlier images (or frames too old) after which
                                   ///< the track restarts.
  double moving_speed_mps = 0.03;  ///< Above either, an object counts as moving.
  double moving_yaw_rate_rps = 0.06;
  /// Unseen for so long, an object is no longer reported, and stands in nobody's way any more.
  double forget_after_s = 1800.0;
  double localisation_sigma_m = 0.005;  ///< Of the robot's own pose, added to each detection.
  double localisation_sigma_rad = 0.003;
  double upright_sigma_m = 0.01;    ///< How well objects keep to the floor: height,
  double upright_sigma_rad = 0.02;  ///< roll and pitch.
  void validate() const;            ///< @throws InputError listing every violation.
};

/// An instance to track.
struct TrackedObject {
  std::string id;
  ObjectModel model;
  int tag_offset = 0;
};

/// Fuses tag detections of all cameras to one pose with covariance per object.
///
/// An interacting multiple-model Kalman filter on SE(2): one model rests, the other moves with
/// constant velocity. So a resting object settles to millimetres and a pushed one is followed at
/// once. Each tag updates it, gated by Mahalanobis distance. Objects stand upright on the floor:
/// that knowledge is fused with each detection, since a planar tag's tilt is poorly observed.
/// Images may arrive up to 1 s late (cameras differ in latency); they are put in their place.
///
/// Thread safety: none; one thread per instance. Cost: some 20 us for each tag.
class PoseTracker {
 public:
  /// @throws InputError if two instances share a tag id or an id, or an object has no tags.
  PoseTracker(std::vector<TrackedObject> objects, PoseTrackerOptions options);
  ~PoseTracker();
  PoseTracker(PoseTracker&&) noexcept;
  PoseTracker& operator=(PoseTracker&&) noexcept;

  /// @param map_T_robot  At the image's stamp.
  /// @param base_T_camera  Of the camera that took it.
  /// Frames older than the newest one by more than 1 s, and values that are not finite, are ignored
  /// and counted. When `reacquire_after` such old frames follow one another, it was the newest one
  /// whose stamp was wrong: what is later than they are is forgotten, and they count again.
  void addFrame(const TagFrame& frame, const Pose2& map_T_robot,
                const Eigen::Isometry3d& base_T_camera);

  /// Every object seen so far, predicted to `now_s` (at most 0.2 s ahead); stamp_s is when it was
  /// last seen. The covariance includes that of the robot's own pose.
  std::vector<ObjectState> states(double now_s) const;

  int ignoredDetections() const;  ///< Unknown tags, outliers, stale or bad frames.

  /// Forgets everything seen, e.g. when the clock starts anew.
  void clear();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
