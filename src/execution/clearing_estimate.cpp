#include "clearing_estimate.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace casepush {

ClearingEstimate::ClearingEstimate(PushPlan way, std::vector<std::string> blockers,
                                   std::vector<PlacedObject> others, const Pose2& map_T_robot,
                                   const ClearWayServices& services, const ClearWayOptions& options)
    : way_(std::move(way)),
      left_(std::move(blockers)),
      others_(std::move(others)),
      map_T_robot_(map_T_robot),
      services_(services),
      options_(options) {}

PlacedObject& ClearingEstimate::next() {
  return *std::find_if(others_.begin(), others_.end(),
                       [this](const PlacedObject& each) { return each.id == left_[next_]; });
}

ClearingRequest ClearingEstimate::request() const {
  ClearingRequest request;
  for (const PlacedObject& each : others_) {
    if (each.id == left_[next_]) {
      request.obstacle = each;
    } else {
      request.standing.push_back(each);
    }
  }
  request.standing.push_back(way_.object);
  request.ways = {way_};
  request.next_pushes = options_.pushes_ahead;
  request.map_T_robot = map_T_robot_;
  request.deadline_s = options_.deadline_s;
  return request;
}

void ClearingEstimate::take(const ClearingResult& found) {
  if (!found.found || found.plan.pushes.empty()) {
    ++next_;
    return;
  }
  const PlannedPush& last = found.plan.pushes.back();
  PlacedObject& obstacle = next();
  const std::vector<Case> cases = services_.cases(obstacle.model);
  if (const Case* push_case = findCase(cases, last.case_id)) {
    map_T_robot_ = last.map_T_start * push_case->steps.back().start_T_robot();
  }
  obstacle.map_T_object = last.map_outcome.mean;
  time_s_ += found.expected_s;
  back_s_ = found.back_s;
  has_cleared_ = true;
  left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(next_));
}

// Those that cannot be pushed away at first may be later.
std::optional<double> ClearingEstimate::poll() {
  while (!left_.empty()) {
    if (!pending_ && next_ == left_.size()) {
      if (!has_cleared_) return std::numeric_limits<double>::infinity();
      next_ = 0;
      has_cleared_ = false;
    }
    if (!pending_) pending_ = services_.clear(request());
    const std::optional<ClearingResult> found = pending_();
    if (!found) return std::nullopt;
    pending_ = nullptr;
    take(*found);
  }
  return time_s_ + back_s_;
}

}  // namespace casepush
