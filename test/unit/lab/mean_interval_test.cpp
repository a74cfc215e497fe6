#include "casepush/lab/mean_interval.h"

#include <gtest/gtest.h>

#include "casepush/common/random.h"

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

TEST(BootstrapInterval, isStudentsForManyNormalValues) {
  Random random(1);
  std::vector<double> values;
  for (int i = 0; i < 200; ++i) values.push_back(3.0 + random.normal(2.0));
  const MeanInterval student = meanInterval(values);
  const MeanInterval bootstrap = bootstrapInterval(values, 1);
  EXPECT_DOUBLE_EQ(bootstrap.mean, student.mean);
  EXPECT_NEAR(bootstrap.low, student.low, 0.03);
  EXPECT_NEAR(bootstrap.high, student.high, 0.03);
  EXPECT_EQ(bootstrapInterval(values, 1).low, bootstrap.low);
}

TEST(BootstrapInterval, isTheValueItselfForOne) {
  EXPECT_EQ(bootstrapInterval({0.7}, 1).low, 0.7);
  EXPECT_EQ(bootstrapInterval({0.7}, 1).high, 0.7);
}

TEST(BootstrapRatio, isThatOfTheMeansAndResamplesPairs) {
  const std::vector<double> below = {1.0, 2.0, 4.0, 8.0};
  const std::vector<double> above = {2.0, 4.0, 8.0, 16.0};
  const MeanInterval same = bootstrapRatio(above, below, 1);
  EXPECT_DOUBLE_EQ(same.mean, 2.0);
  EXPECT_DOUBLE_EQ(same.low, 2.0);
  EXPECT_DOUBLE_EQ(same.high, 2.0);
  const MeanInterval other = bootstrapRatio({16.0, 8.0, 4.0, 2.0}, below, 1);
  EXPECT_DOUBLE_EQ(other.mean, 2.0);
  EXPECT_LT(other.low, 1.0);
  EXPECT_GT(other.high, 4.0);
}

}  // namespace
}  // namespace casepush
