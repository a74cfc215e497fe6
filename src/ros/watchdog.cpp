#include "casepush/ros/watchdog.h"

#include <chrono>
#include <utility>

namespace casepush {

Watchdog::Watchdog(double patience_s, std::function<void()> on_silence)
    : patience_s_(patience_s), on_silence_(std::move(on_silence)), thread_([this] { run(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Watchdog::arm() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    armed_ = true;
    fed_ = true;
  }
  changed_.notify_one();
}

void Watchdog::disarm() {
  const std::lock_guard<std::mutex> lock(mutex_);
  armed_ = false;
}

void Watchdog::feed() {
  const std::lock_guard<std::mutex> lock(mutex_);
  fed_ = true;
}

void Watchdog::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  // Looks twice within the patience: silence is noticed after one to one and a half of it at most.
  const std::chrono::duration<double> look(patience_s_ / 2.0);
  int silent_looks = 0;
  while (!ending_) {
    if (!armed_) {
      changed_.wait(lock, [this] { return armed_ || ending_; });
      silent_looks = 0;
      continue;
    }
    changed_.wait_for(lock, look, [this] { return ending_; });
    silent_looks = fed_ ? 0 : silent_looks + 1;
    fed_ = false;
    if (armed_ && !ending_ && silent_looks >= 2) {
      lock.unlock();
      on_silence_();
      lock.lock();
    }
  }
}

}  // namespace casepush
