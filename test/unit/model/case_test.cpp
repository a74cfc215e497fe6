#include "casepush/model/case.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/input_error_text.h"

namespace casepush {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Case goodCase() {
  Case push_case;
  push_case.object = "office_chair";
  push_case.robot = "cobot";
  push_case.push_steps = 2;
  push_case.steps.resize(3);
  push_case.steps[1].start_T_object = Pose2(0.1, 0, 0.2);
  push_case.steps[1].object_T_robot = Pose2(-0.6, 0, 0);
  push_case.start_outcome.covariance = 0.01 * Eigen::Matrix3d::Identity();
  return push_case;
}

std::string errorAfter(const std::function<void(Case*)>& change) {
  Case push_case = goodCase();
  change(&push_case);
  return inputErrorText([&] { validateCase(push_case, "case 7"); });
}

TEST(Case, knowsItsDurations) {
  const Case push_case = goodCase();
  EXPECT_NEAR(push_case.durationS(), 0.3, 1e-12);
  EXPECT_NEAR(push_case.pushDurationS(), 0.2, 1e-12);
}

TEST(CaseStep, placesTheRobotInTheStartFrame) {
  const Pose2 start_T_robot = goodCase().steps[1].start_T_robot();
  EXPECT_NEAR(start_T_robot.x(), 0.1 - 0.6 * std::cos(0.2), 1e-12);
  EXPECT_NEAR(start_T_robot.y(), -0.6 * std::sin(0.2), 1e-12);
}

TEST(ValidateCase, acceptsAGoodOne) {
  EXPECT_EQ(errorAfter([](Case*) {}), "");
}

TEST(ValidateCase, namesWhatIsWrong) {
  EXPECT_EQ(errorAfter([](Case* c) { c->object.clear(); }),
            "case 7: object: is empty; must name an object model");
  EXPECT_EQ(errorAfter([](Case* c) { c->period_s = 0.0; }),
            "case 7: period_s: is 0.000000; must be finite and above 0");
  EXPECT_NE(errorAfter([](Case* c) { c->period_s = kNan; }), "");
  EXPECT_EQ(errorAfter([](Case* c) { c->steps.clear(); }),
            "case 7: steps: is empty; must hold at least one");
  EXPECT_EQ(errorAfter([](Case* c) { c->push_steps = 4; }),
            "case 7: push_steps: is 4; must be in [1, 3], the number of steps");
  EXPECT_EQ(errorAfter([](Case* c) { c->push_steps = 0; }),
            "case 7: push_steps: is 0; must be in [1, 3], the number of steps");
  EXPECT_EQ(errorAfter([](Case* c) { c->steps[2].action.vy_mps = kNan; }),
            "case 7: steps[2]: is not finite");
  EXPECT_EQ(errorAfter([](Case* c) { c->steps[0].object_T_robot = Pose2(0, kNan, 0); }),
            "case 7: steps[0]: is not finite");
  EXPECT_EQ(errorAfter([](Case* c) { c->start_outcome.mean = Pose2(kNan, 0, 0); }),
            "case 7: start_outcome.mean: is not finite");
  EXPECT_EQ(errorAfter([](Case* c) { c->start_outcome.covariance(0, 0) = -1.0; }),
            "case 7: start_outcome.covariance: must be finite, symmetric and without negative "
            "eigenvalues");
  EXPECT_EQ(errorAfter([](Case* c) { c->effective_count = -1.0; }),
            "case 7: effective_count: must be finite and not negative");
  EXPECT_EQ(errorAfter([](Case* c) { c->observation_count = -1; }),
            "case 7: observation_count: must not be negative");
}

}  // namespace
}  // namespace casepush
