#include "object_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"
#include "chi_square.h"

namespace casepush {
namespace {

constexpr double kHistoryS = 1.0;
// Probabilities of motion at which an object begins and ceases to count as moving.
constexpr double kStartAbove = 0.95;
constexpr double kStopBelow = 0.5;

}  // namespace

int ObjectTrack::add(TrackImage image) {
  const auto later = std::upper_bound(
      history_.begin(), history_.end(), image.stamp_s,
      [](double stamp_s, const Entry& entry) { return stamp_s < entry.image.stamp_s; });
  const auto index = static_cast<std::size_t>(later - history_.begin());
  history_.insert(later, Entry{std::move(image), {}, 0});
  for (std::size_t i = index; i < history_.size(); ++i) {
    process(i == 0 ? State{} : history_[i - 1].after, history_[i]);
  }
  const int outliers = history_[index].outliers;
  while (history_.size() > 1 &&
         history_.front().image.stamp_s < history_.back().image.stamp_s - kHistoryS) {
    history_.pop_front();
  }
  return outliers;
}

void ObjectTrack::forgetAfter(double stamp_s) {
  while (!history_.empty() && history_.back().image.stamp_s > stamp_s) {
    history_.pop_back();
  }
}

int ObjectTrack::fuse(MotionFilter& filter, const TrackImage& image) const {
  filter.predict(image.stamp_s);
  int used = 0;
  for (const PoseMeasurement& measurement : image.measurements) {
    if (chiSquareTail3(filter.squaredDistance(measurement)) >= options_.gate_p_value) {
      filter.update(measurement);
      ++used;
    }
  }
  return used;
}

// Outliers that agree among themselves make a candidate, which becomes the track in the end.
void ObjectTrack::follow(State& state, const TrackImage& image) const {
  if (state.candidate && fuse(*state.candidate, image) > 0) {
    ++state.candidate_images;
  } else {
    state.candidate.emplace(image.measurements.front(), image.stamp_s, options_.motion);
    state.candidate_images = 1;
  }
  if (state.candidate_images >= options_.reacquire_after) {
    state.filter = state.candidate;
    state.last_seen_s = image.stamp_s;
    state.candidate.reset();
  }
}

void ObjectTrack::process(const State& before, Entry& entry) const {
  State& state = entry.after;
  const TrackImage& image = entry.image;
  state = before;
  if (!state.filter) {
    state.filter.emplace(image.measurements.front(), image.stamp_s, options_.motion);
  }
  MotionFilter filter = *state.filter;
  const int used = fuse(filter, image);
  entry.outliers = static_cast<int>(image.measurements.size()) - used;
  if (used > 0) {
    state.filter = filter;
    state.last_seen_s = image.stamp_s;
    state.candidate.reset();
  } else {
    follow(state, image);
  }
  state.moving = isMoving(state);
}

bool ObjectTrack::isMoving(const State& state) const {
  const MotionFilter::Estimate estimate = state.filter->estimate();
  const bool is_fast = estimate.map_velocity.head<2>().norm() > options_.moving_speed_mps ||
                       std::abs(estimate.map_velocity.z()) > options_.moving_yaw_rate_rps;
  return is_fast && estimate.moving_probability > (state.moving ? kStopBelow : kStartAbove);
}

MotionFilter::Estimate ObjectTrack::predicted(double stamp_s) const {
  CASEPUSH_CHECK(isSeen(), "prediction of an object that was never seen");
  MotionFilter filter = *history_.back().after.filter;
  filter.predict(stamp_s);
  return filter.estimate();
}

}  // namespace casepush
