#include "casepush/ros/stand_tally.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace casepush {
namespace {

constexpr double kLongestTickS = 0.2;  // Jumps of the clock do not count.
constexpr double kPeriodS = 60.0;

}  // namespace

std::string StandTally::add(double now_s, double wall_s, const std::string& reason) {
  const double lasted_s = std::clamp(now_s - last_s_, 0.0, kLongestTickS);
  if (!last_reason_.empty() && (reason == last_reason_ || untold_.count(last_reason_) > 0)) {
    untold_[last_reason_].duration_s += lasted_s;
  }
  const bool begins = !reason.empty() && reason != last_reason_;
  last_reason_ = reason;
  last_s_ = now_s;
  if (begins) ++untold_[reason].times;
  if (untold_.empty() || (told_wall_s_ && wall_s - *told_wall_s_ < kPeriodS)) return "";
  const std::string line = told_wall_s_ ? sumUp(wall_s) : "the base is told to stand: " + reason;
  untold_.clear();
  told_wall_s_ = wall_s;
  return line;
}

std::string StandTally::sumUp(double wall_s) const {
  std::ostringstream line;
  line << std::fixed << std::setprecision(0) << "in the last " << wall_s - *told_wall_s_
       << " s the base was told to stand";
  for (const auto& [reason, entry] : untold_) {
    line << (&entry == &untold_.begin()->second ? " " : ", ");
    if (entry.times == 0) {
      line << "still";
    } else {
      line << entry.times << (entry.times == 1 ? " time" : " times");
    }
    line << std::setprecision(2) << " (" << entry.duration_s << " s in all) because " << reason;
  }
  return line.str();
}

}  // namespace casepush
