#pragma once

#include <map>
#include <optional>
#include <string>

namespace casepush {

/// Counts how often and how long the base was told to stand, and tells it in few lines: the first
/// time at once, what follows summed up once a minute.
class StandTally {
 public:
  /// One tick. @param reason  Why the base is told to stand; empty: it is not.
  /// @param wall_s  By a clock that never jumps.
  /// @return  What a person should read now, mostly nothing.
  std::string add(double now_s, double wall_s, const std::string& reason);

 private:
  struct Entry {
    int times = 0;
    double duration_s = 0.0;
  };
  std::string sumUp(double wall_s) const;

  std::map<std::string, Entry> untold_;  ///< By reason.
  std::optional<double> told_wall_s_;    ///< When the last line was told.
  std::string last_reason_;
  double last_s_ = 0.0;
};

}  // namespace casepush
