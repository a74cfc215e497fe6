#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "motion_filter.h"

namespace casepush {

/// All that one image says about one object.
struct TrackImage {
  double stamp_s = 0.0;
  Pose2 map_T_robot;  ///< For the share of its error in the estimate.
  std::vector<PoseMeasurement> measurements;
};

struct TrackOptions {
  MotionFilter::Noise motion;
  double gate_p_value;
  int reacquire_after;
  double moving_speed_mps;
  double moving_yaw_rate_rps;
};

/// The estimate of one object over time. Keeps the images of the last second, so that a late one
/// can be put in its place and the later ones repeated.
class ObjectTrack {
 public:
  explicit ObjectTrack(const TrackOptions& options) : options_(options) {}

  /// Returns the number of measurements that were outliers.
  int add(TrackImage image);

  bool isSeen() const { return !history_.empty() && history_.back().after.filter.has_value(); }

  /// @pre isSeen().
  double lastSeenS() const { return history_.back().after.last_seen_s; }
  bool isMoving() const { return history_.back().after.moving; }
  const Pose2& lastRobotPose() const { return history_.back().image.map_T_robot; }
  MotionFilter::Estimate predicted(double stamp_s) const;

  void clear() { history_.clear(); }

  /// Undoes all images later than `stamp_s`.
  void forgetAfter(double stamp_s);

 private:
  struct State {
    std::optional<MotionFilter> filter;
    double last_seen_s = 0.0;
    bool moving = false;
    std::optional<MotionFilter> candidate;  ///< Where outliers agree that the object is instead.
    int candidate_images = 0;
  };
  struct Entry {
    TrackImage image;
    State after;
    int outliers = 0;
  };
  void process(const State& before, Entry& entry) const;
  int fuse(MotionFilter& filter, const TrackImage& image) const;
  bool isMoving(const State& state) const;
  void follow(State& state, const TrackImage& image) const;

  TrackOptions options_;
  std::deque<Entry> history_;  ///< By stamp.
};

}  // namespace casepush
