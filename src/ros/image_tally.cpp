#include "casepush/ros/image_tally.h"

#include <algorithm>
#include <sstream>

namespace casepush {
namespace {

// An object that is pushed may be unseen for 0.3 s (push/blind_push).
constexpr double kLeastRateHz = 8.0;
constexpr double kMostDelayS = 0.3;

}  // namespace

void ImageTally::add(const std::string& frame_id, double stamp_s, double now_s) {
  const auto [entry, is_new] = cameras_.try_emplace(frame_id);
  Camera& camera = entry->second;
  if (!is_new && stamp_s > camera.last_s) {
    camera.sum_s += stamp_s - camera.last_s;
    ++camera.intervals;
  }
  camera.last_s = stamp_s;
  camera.latest_s = std::max(camera.latest_s, now_s - stamp_s);
}

std::string ImageTally::complaint() {
  std::ostringstream text;
  text.precision(2);
  for (auto& [frame_id, camera] : cameras_) {
    const char* const comma = text.tellp() > 0 ? "; " : "";
    if (camera.intervals < kLeastRateHz * camera.sum_s) {
      text << comma << frame_id << " sends " << camera.intervals / camera.sum_s
           << " images a second, pushing needs 10";
    } else if (camera.latest_s > kMostDelayS) {
      text << comma << frame_id << "'s images come " << camera.latest_s
           << " s late, pushing needs 0.1";
    }
    camera.sum_s = camera.latest_s = 0.0;
    camera.intervals = 0;
  }
  return text.str();
}

}  // namespace casepush
