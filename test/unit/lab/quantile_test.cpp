#include "casepush/lab/quantile.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(Quantile, liesBetweenTheSortedValues) {
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(quantile({4.0, 1.0, 2.0, 3.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 1.0), 3.0);
  EXPECT_DOUBLE_EQ(quantile({0.0, 10.0}, 0.9), 9.0);
}

TEST(Quantile, ofNothingIsZero) { EXPECT_EQ(quantile({}, 0.9), 0.0); }

}  // namespace
}  // namespace casepush
