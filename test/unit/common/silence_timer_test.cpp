#include "casepush/common/silence_timer.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(SilenceTimer, countsWhileSomethingIsMissing) {
  SilenceTimer timer;
  EXPECT_EQ(timer.update(10.0, false), 0.0);
  EXPECT_EQ(timer.update(10.1, true), 0.0);
  EXPECT_NEAR(timer.update(10.2, true), 0.1, 1e-9);
  EXPECT_NEAR(timer.update(10.35, true), 0.25, 1e-9);
  EXPECT_EQ(timer.update(10.4, false), 0.0);
  EXPECT_EQ(timer.update(10.5, true), 0.0);
}

TEST(SilenceTimer, takesNoJumpOfTheClockForSilence) {
  SilenceTimer timer;
  timer.update(10.0, false);
  timer.update(10.1, true);
  EXPECT_NEAR(timer.update(40.1, true), 0.2, 1e-9);
  EXPECT_NEAR(timer.update(3.0, true), 0.2, 1e-9);
  EXPECT_NEAR(timer.update(3.1, true), 0.3, 1e-9);
}

TEST(SilenceTimer, forgetsWhenReset) {
  SilenceTimer timer;
  timer.update(1.0, true);
  timer.update(1.1, true);
  timer.reset();
  EXPECT_EQ(timer.update(1.2, true), 0.0);
}

}  // namespace
}  // namespace casepush
