#include "casepush/common/violations.h"

#include <gtest/gtest.h>

#include <limits>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string textOf(const Violations& violations) {
  try {
    violations.throwIfAny("options");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Violations, AcceptsTheBoundsThemselves) {
  Violations violations;
  violations.require("a", 0.0, 0.0, 1.0);
  violations.require("b", 1.0, 0.0, 1.0);
  violations.require("c", 1e9, 0.0, kInfinity);
  violations.requirePositive("d", 2.0, 2.0);
  EXPECT_EQ(textOf(violations), "");
}

TEST(Violations, TellsEveryOneWithItsBound) {
  Violations violations;
  violations.require("a", -0.5, 0.0, 1.0);
  violations.require("b", -1.0, 2.0, kInfinity);
  violations.requirePositive("c", 0.0, 3.0);
  violations.requirePositive("d", 0.0, kInfinity);
  EXPECT_EQ(textOf(violations),
            "options: a is -0.5, must be in [0, 1]; b is -1, must be at least 2; "
            "c is 0, must be in (0, 3]; d is 0, must be positive");
}

TEST(Violations, RefusesWhatIsNotFinite) {
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    Violations bounded;
    bounded.require("a", value, 0.0, kInfinity);
    EXPECT_NE(textOf(bounded), "") << value;
    Violations positive;
    positive.requirePositive("a", value, kInfinity);
    EXPECT_NE(textOf(positive), "") << value;
  }
}

}  // namespace
}  // namespace casepush
