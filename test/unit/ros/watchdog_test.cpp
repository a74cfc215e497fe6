#include "casepush/ros/watchdog.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace casepush {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Counts calls and lets a test wait for them.
class Calls {
 public:
  void add() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++count_;
    changed_.notify_all();
  }
  bool waitFor(int count, std::chrono::milliseconds patience) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, patience, [&] { return count_ >= count; });
  }
  int count() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return count_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int count_ = 0;
};

TEST(Watchdog, callsAgainAndAgainWhileArmedAndNotFed) {
  Calls calls;
  Watchdog watchdog(0.05, [&] { calls.add(); });
  const SteadyClock::time_point start = SteadyClock::now();
  watchdog.arm();
  ASSERT_TRUE(calls.waitFor(3, std::chrono::seconds(5)));
  EXPECT_GE(SteadyClock::now() - start, std::chrono::milliseconds(50));
}

TEST(Watchdog, keepsQuietUnlessArmed) {
  Calls calls;
  Watchdog watchdog(0.02, [&] { calls.add(); });
  EXPECT_FALSE(calls.waitFor(1, std::chrono::milliseconds(100)));
  watchdog.arm();
  ASSERT_TRUE(calls.waitFor(1, std::chrono::seconds(5)));
  watchdog.disarm();
  const int count = calls.count();
  // One call may have been under way.
  EXPECT_FALSE(calls.waitFor(count + 2, std::chrono::milliseconds(100)));
}

TEST(Watchdog, keepsQuietWhileFed) {
  Calls calls;
  Watchdog watchdog(0.5, [&] { calls.add(); });
  watchdog.arm();
  const SteadyClock::time_point end = SteadyClock::now() + std::chrono::milliseconds(1200);
  while (SteadyClock::now() < end) {
    watchdog.feed();
    ASSERT_FALSE(calls.waitFor(1, std::chrono::milliseconds(10)));
  }
}

TEST(Watchdog, endsWhileArmed) {
  Calls calls;
  Watchdog watchdog(10.0, [&] { calls.add(); });
  watchdog.arm();
}

}  // namespace
}  // namespace casepush
