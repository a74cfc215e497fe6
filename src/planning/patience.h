#pragma once

#include <cstddef>
#include <functional>
#include <utility>

namespace casepush {

/// Asks now and then, in the midst of long work, whether to stop, and remembers that it was told
/// to. Whoever was given one and finds it over afterwards throws the result away.
class Patience {
 public:
  Patience() = default;  ///< Endless.
  explicit Patience(std::function<bool()> stop) : stop_(std::move(stop)) {}

  /// @param steps  Of some 10 ns each, done since the last call.
  /// @return  True from when somebody wished to stop.
  bool isOverAfter(std::size_t steps) const {
    constexpr std::size_t kUnasked = 1 << 15;
    done_ += steps;
    if (done_ < kUnasked || is_over_) return is_over_;
    done_ = 0;
    is_over_ = stop_ && stop_();
    return is_over_;
  }
  bool isOver() const { return is_over_; }

 private:
  std::function<bool()> stop_;
  mutable std::size_t done_ = 0;
  mutable bool is_over_ = false;
};

}  // namespace casepush
