#include "casepush/cases/change_detector.h"

#include <gtest/gtest.h>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"

namespace casepush {
namespace {

/// @param add  One push under which nothing has changed.
template <typename Add>
void expectFewFalseAlarms(const Add& add) {
  ChangeDetectorOptions options;
  options.alarm = 50.0;
  ChangeDetector detector(options);
  constexpr int kPushes = 200000;
  int alarms = 0;
  for (int i = 0; i < kPushes; ++i) {
    add(&detector);
    if (detector.isRaised()) {
      ++alarms;
      detector.reset();
    }
  }
  EXPECT_LT(alarms, kPushes / options.alarm);
  EXPECT_GT(alarms, 0);
}

TEST(ChangeDetector, raisesFalseAlarmsNoMoreOftenThanItsLevel) {
  Random random(7);
  expectFewFalseAlarms(
      [&random](ChangeDetector* detector) { detector->add(random.uniform(0.0, 1.0)); });
}

/// Outcomes ~ N(0, 1); the alternative is N(1, 1).
TEST(ChangeDetector, likelihoodRatiosRaiseFalseAlarmsNoMoreOftenThanItsLevel) {
  Random random(8);
  expectFewFalseAlarms(
      [&random](ChangeDetector* detector) { detector->addLogRatio(random.normal(1.0) - 0.5); });
}

TEST(ChangeDetector, datesTheChange) {
  ChangeDetectorOptions options;
  options.alarm = 1000.0;
  ChangeDetector detector(options);
  for (int i = 0; i < 30; ++i) {
    detector.add(0.5);
    EXPECT_FALSE(detector.isRaised());
  }
  EXPECT_EQ(detector.pushesSinceChange(), 0);
  detector.addNothing();
  EXPECT_EQ(detector.pushesSinceChange(), 0);
  detector.add(0.002);
  detector.addNothing();
  detector.add(0.02);
  EXPECT_FALSE(detector.isRaised());
  detector.add(0.0001);
  EXPECT_TRUE(detector.isRaised());
  EXPECT_EQ(detector.pushesSinceChange(), 4);
}

TEST(ChangeDetector, forgetsASurpriseThatOrdinaryPushesFollow) {
  ChangeDetector detector;
  detector.add(0.01);
  for (int i = 0; i < 6; ++i) {
    detector.add(0.6);
  }
  EXPECT_EQ(detector.pushesSinceChange(), 0);
  detector.add(0.01);
  EXPECT_FALSE(detector.isRaised());
}

TEST(ChangeDetector, noSinglePushIsWorthMoreThanItMayBe) {
  ChangeDetectorOptions options;
  options.alarm = 1001.0;
  ChangeDetector detector(options);
  detector.add(0.0);
  EXPECT_FALSE(detector.isRaised());
  detector.reset();
  detector.addLogRatio(1e6);
  EXPECT_FALSE(detector.isRaised());
  detector.addLogRatio(1.0);
  EXPECT_TRUE(detector.isRaised());
}

TEST(ChangeDetector, refusesOptionsThatMakeNoSense) {
  ChangeDetectorOptions options;
  options.betting = 1.0;
  EXPECT_THROW(ChangeDetector{options}, InputError);
}

}  // namespace
}  // namespace casepush
