#pragma once

#include <optional>

namespace casepush {

/// For how long has something been missing? Counted from tick to tick, each as 0.2 s at most: a
/// clock that jumps forwards makes all that was heard before look old, which says nothing about
/// how long nothing came.
class SilenceTimer {
 public:
  /// To be asked at every tick.
  /// @param now_s  Stamp of this tick. Going back in time adds nothing.
  /// @return seconds since the first tick in a row at which it was missing; 0 if it is there.
  double update(double now_s, bool is_missing);

  void reset();

 private:
  std::optional<double> last_s_;
  double missing_s_ = 0.0;
  bool was_missing_ = false;
};

}  // namespace casepush
