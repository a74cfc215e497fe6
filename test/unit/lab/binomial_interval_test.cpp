#include "casepush/lab/binomial_interval.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(WilsonInterval, agreesWithPublishedValues) {
  // Newcombe, Statistics in Medicine 17 (1998), table I, method 3.
  const BinomialInterval some = wilsonInterval(81, 263);
  EXPECT_NEAR(some.low, 0.2553, 5e-5);
  EXPECT_NEAR(some.high, 0.3662, 5e-5);
  const BinomialInterval few = wilsonInterval(1, 29);
  EXPECT_NEAR(few.low, 0.0061, 5e-5);
  EXPECT_NEAR(few.high, 0.1718, 5e-5);
}

TEST(WilsonInterval, neverLeavesZeroToOne) {
  EXPECT_EQ(wilsonInterval(0, 20).low, 0.0);
  EXPECT_NEAR(wilsonInterval(0, 20).high, 0.1611, 5e-5);
  EXPECT_EQ(wilsonInterval(100, 100).share, 1.0);
  EXPECT_NEAR(wilsonInterval(100, 100).low, 0.9630, 5e-5);
  EXPECT_EQ(wilsonInterval(100, 100).high, 1.0);
}

}  // namespace
}  // namespace casepush
