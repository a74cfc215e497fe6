#include "planning/disposal.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace casepush {
namespace {

/// Tells who freed it.
struct Garbage {
  Garbage(std::atomic<int>* freed_here, std::atomic<int>* freed_elsewhere)
      : here(freed_here), elsewhere(freed_elsewhere) {}
  Garbage(const Garbage&) = delete;
  Garbage& operator=(const Garbage&) = delete;
  ~Garbage() { ++*(std::this_thread::get_id() == maker ? here : elsewhere); }

  std::atomic<int>* here;
  std::atomic<int>* elsewhere;
  std::thread::id maker = std::this_thread::get_id();
};

TEST(Disposal, freesAllInAnotherThreadBeforeItEnds) {
  constexpr int kCount = 200;
  std::atomic<int> here{0};
  std::atomic<int> elsewhere{0};
  {
    Disposal disposal;
    for (int i = 0; i < kCount; ++i) {
      disposal.take(std::make_shared<const Garbage>(&here, &elsewhere));
    }
  }
  EXPECT_EQ(here, 0);
  EXPECT_EQ(elsewhere, kCount);
}

TEST(Disposal, leavesAloneWhatOthersStillUse) {
  std::atomic<int> here{0};
  std::atomic<int> elsewhere{0};
  auto garbage = std::make_shared<const Garbage>(&here, &elsewhere);
  { Disposal().take(garbage); }
  EXPECT_EQ(elsewhere, 0);
  garbage.reset();
  EXPECT_EQ(here, 1);
}

}  // namespace
}  // namespace casepush
