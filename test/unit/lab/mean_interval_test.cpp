#include "casepush/lab/mean_interval.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(MeanInterval, isStudentsForAFewValues) {
  const MeanInterval interval = meanInterval({1.0, 2.0, 3.0});
  EXPECT_DOUBLE_EQ(interval.mean, 2.0);
  // t = 4.303 for two degrees of freedom, standard error 1 / sqrt(3).
  EXPECT_NEAR(interval.high - interval.mean, 4.303 / 1.7320508, 1e-6);
  EXPECT_NEAR(interval.mean - interval.low, 4.303 / 1.7320508, 1e-6);
}

TEST(MeanInterval, isTheValueItselfForOne) {
  const MeanInterval interval = meanInterval({0.7});
  EXPECT_EQ(interval.low, 0.7);
  EXPECT_EQ(interval.high, 0.7);
}

}  // namespace
}  // namespace casepush
