#include "casepush/common/check.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(CheckDeathTest, endsTheProgramAndPrintsTheValues) {
  const int wheels = 3;
  EXPECT_DEATH(CASEPUSH_CHECK(wheels == 5, "wheels = " << wheels),
               "internal check failed: wheels == 5 \\(wheels = 3\\) at .*check_test.cpp");
}

TEST(Check, doesNotEvaluateTheMessageWhenItHolds) {
  int evaluations = 0;
  CASEPUSH_CHECK(evaluations == 0, ++evaluations);
  EXPECT_EQ(evaluations, 0);
}

}  // namespace
}  // namespace casepush
