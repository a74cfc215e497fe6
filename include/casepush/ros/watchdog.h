#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace casepush {

/// Calls `on_silence` again and again, from a thread of its own, while it is armed and has not been
/// fed for `patience_s` of steady wall time. Works while simulated time or the main thread stands
/// still.
class Watchdog {
 public:
  Watchdog(double patience_s, std::function<void()> on_silence);
  ~Watchdog();

  void arm();
  void disarm();
  void feed();

 private:
  void run();

  const double patience_s_;
  const std::function<void()> on_silence_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool armed_ = false;
  bool fed_ = false;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace casepush
