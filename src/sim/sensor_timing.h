#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/sensors.h"

namespace casepush::sim {

constexpr double kTimeEpsilon_s = 1e-9;

/// Each sensor draws from a stream of its own, so that none changes what another one reports.
inline Random noiseStream(const SensorSwitches& switches, std::uint64_t simulator_seed,
                          const std::string& name) {
  return Random::stream(switches.seed != 0 ? switches.seed : simulator_seed, "sensor " + name);
}

/// Tells when a sensor of a fixed rate is due.
class SampleClock {
 public:
  explicit SampleClock(double rate_hz) : rate_hz_(rate_hz) {}

  bool isDue(double time_s) const {
    return time_s + kTimeEpsilon_s >= static_cast<double>(samples_) / rate_hz_;
  }
  /// Counting from the clock keeps the rate when a step is longer than a period.
  void advance(double time_s) {
    samples_ = 1 + static_cast<std::int64_t>(std::floor((time_s + kTimeEpsilon_s) * rate_hz_));
  }
  std::int64_t samples() const { return samples_; }  ///< So far, those that were skipped included.

 private:
  double rate_hz_;
  std::int64_t samples_ = 0;
};

/// Measurements that wait until their latency has passed.
template <typename T>
class DelayLine {
 public:
  /// @param most  Nobody reads the sensors of a world that is only driven; they must not pile up.
  explicit DelayLine(std::size_t most) : most_(most) {}

  void push(double due_s, T value) {
    if (waiting_.size() >= most_) waiting_.pop_front();
    waiting_.push_back({due_s, std::move(value)});
  }

  /// Those that are due, in the order in which they were pushed.
  std::vector<T> take(double time_s) {
    std::vector<T> due;
    std::deque<Entry> later;
    for (Entry& entry : waiting_) {
      if (entry.due_s <= time_s + kTimeEpsilon_s) {
        due.push_back(std::move(entry.value));
      } else {
        later.push_back(std::move(entry));
      }
    }
    waiting_.swap(later);
    return due;
  }

 private:
  struct Entry {
    double due_s;
    T value;
  };
  std::size_t most_;
  std::deque<Entry> waiting_;
};

}  // namespace casepush::sim
