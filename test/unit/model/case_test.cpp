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
  push_case.effective_count = 1.0;
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

TEST(ValidateCase, namesWhatIsWrongWithTubeAndContext) {
  EXPECT_EQ(errorAfter([](Case* c) { c->tube.resize(2); }),
            "case 7: tube: holds 2 poses; must hold one for each of the 3 steps, or none");
  EXPECT_EQ(
      errorAfter([](Case* c) {
        c->tube.assign(3, c->start_outcome);
        c->tube[1].covariance(0, 0) = -1.0;
      }),
      "case 7: tube[1].covariance: must be finite, symmetric and without negative eigenvalues");
  EXPECT_EQ(errorAfter([](Case* c) { c->context.load_kg = kNan; }),
            "case 7: load_kg: is nan; must be in [0, 10000] kg");
  EXPECT_EQ(errorAfter([](Case* c) { c->context.floor = "a\nb"; }),
            "case 7: floor: holds a control character; must be a text on one line");
}

TEST(ValidateCase, namesWhatIsWrong) {
  EXPECT_EQ(errorAfter([](Case* c) { c->object.clear(); }),
            "case 7: object: is empty; must name an object model");
  EXPECT_EQ(errorAfter([](Case* c) { c->period_s = 0.0; }),
            "case 7: period_s: is 0; must be in [0.001, 10] s");
  EXPECT_NE(errorAfter([](Case* c) { c->period_s = kNan; }), "");
  EXPECT_EQ(errorAfter([](Case* c) { c->steps.clear(); }),
            "case 7: steps: is empty; must hold at least one");
  EXPECT_EQ(errorAfter([](Case* c) { c->push_steps = 4; }),
            "case 7: push_steps: is 4; must be in [1, 3], the number of steps");
  EXPECT_EQ(errorAfter([](Case* c) { c->push_steps = 0; }),
            "case 7: push_steps: is 0; must be in [1, 3], the number of steps");
  EXPECT_EQ(errorAfter([](Case* c) { c->steps[2].action.vy_mps = kNan; }),
            "case 7: steps[2].action: is not finite");
  EXPECT_EQ(errorAfter([](Case* c) { c->steps[0].object_T_robot = Pose2(0, kNan, 0); }),
            "case 7: steps[0].object_T_robot: is not finite");
  EXPECT_EQ(errorAfter([](Case* c) { c->start_outcome.mean = Pose2(kNan, 0, 0); }),
            "case 7: start_outcome.mean: is not finite");
  EXPECT_EQ(errorAfter([](Case* c) { c->start_outcome.covariance(0, 0) = -1.0; }),
            "case 7: start_outcome.covariance: must be finite, symmetric and without negative "
            "eigenvalues");
  EXPECT_EQ(errorAfter([](Case* c) { c->effective_count = -1.0; }),
            "case 7: effective_count: is -1; must be above 0 and at most 1e+09");
  EXPECT_EQ(errorAfter([](Case* c) { c->observation_count = -1; }),
            "case 7: observation_count: must not be negative");
}

TEST(ValidateCase, refusesHugeValues) {
  EXPECT_EQ(errorAfter([](Case* c) { c->steps[1].start_T_object = Pose2(1e7, 0, 0); }),
            "case 7: steps[1].start_T_object: is at (1e+07, 0); x and y must be within 100 m of 0");
  EXPECT_EQ(
      errorAfter([](Case* c) { c->steps[1].object_T_robot = Pose2(0, -100.1, 0); }),
      "case 7: steps[1].object_T_robot: is at (0, -100.1); x and y must be within 100 m of 0");
  EXPECT_EQ(errorAfter([](Case* c) { c->start_outcome.mean = Pose2(0, 1e300, 0); }),
            "case 7: start_outcome.mean: is at (0, 1e+300); x and y must be within 100 m of 0");
  EXPECT_EQ(
      errorAfter([](Case* c) { c->steps[2].action.wz_rps = -1e300; }),
      "case 7: steps[2].action: is (0, 0, -1e+300); each must be within 10 (m/s, rad/s) of 0");
  EXPECT_EQ(errorAfter([](Case* c) { c->period_s = 1e300; }),
            "case 7: period_s: is 1e+300; must be in [0.001, 10] s");
  EXPECT_EQ(errorAfter([](Case* c) { c->period_s = 0.0009; }),
            "case 7: period_s: is 0.0009; must be in [0.001, 10] s");
  EXPECT_EQ(errorAfter([](Case* c) { c->steps.resize(10001); }),
            "case 7: steps: are 10001; must be at most 10000");
  EXPECT_EQ(
      errorAfter([](Case* c) { c->start_outcome.covariance(1, 1) = 40000.0; }),
      "case 7: start_outcome.covariance: has a standard deviation of 200; must be at most 100 "
      "(m, rad)");
  EXPECT_EQ(errorAfter([](Case* c) { c->start_outcome.covariance(2, 2) = 10001.0; }).substr(0, 34),
            "case 7: start_outcome.covariance: ");
  EXPECT_EQ(errorAfter([](Case* c) { c->effective_count = 2e9; }),
            "case 7: effective_count: is 2e+09; must be above 0 and at most 1e+09");
  EXPECT_NE(errorAfter([](Case* c) { c->effective_count = 0.0; }), "");
}

TEST(ValidateCase, refusesPathsThatNeverEnd) {
  const auto move_to_and_fro = [](Case* c, Pose2 CaseStep::*pose) {
    c->steps.resize(1000);
    for (std::size_t i = 0; i < c->steps.size(); i += 2) c->steps[i].*pose = Pose2(2, 0, 0);
  };
  EXPECT_EQ(errorAfter([&](Case* c) {
              c->steps[1] = {};
              move_to_and_fro(c, &CaseStep::start_T_object);
            }),
            "case 7: steps: let the object travel 1998 m; must be at most 1000 m");
  EXPECT_EQ(errorAfter([&](Case* c) {
              c->steps[1] = {};
              move_to_and_fro(c, &CaseStep::object_T_robot);
            }),
            "case 7: steps: let the robot travel 1998 m; must be at most 1000 m");
}

TEST(ValidateCase, acceptsTheBoundsThemselves) {
  EXPECT_EQ(errorAfter([](Case* c) {
              c->steps.resize(10000);
              c->steps[1].start_T_object = Pose2(100, -100, 0);
              c->steps[2].action = {10, -10, 10};
              c->period_s = 10.0;
              c->start_outcome.covariance = 1e4 * Eigen::Matrix3d::Identity();
              c->effective_count = 1e9;
            }),
            "");
}

}  // namespace
}  // namespace casepush
