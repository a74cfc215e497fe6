#include "casepush/lab/plan_verification.h"

#include <algorithm>
#include <cmath>

#include "casepush/common/input_error.h"
#include "casepush/world/fcl_checker.h"

namespace casepush {
namespace {

constexpr double kContact_m = 1e-3;
constexpr double kStep_m = 0.01;
constexpr double kLeaving_m = 0.3;  // As far from a start that overlaps the object may overlap.

/// Tests poses and remembers what was wrong first.
class Verifier {
 public:
  Verifier(const Map& map, const std::vector<PlacedSolid>& obstacles, const ObjectModel& object,
           const RobotModel& robot, const Pose2& map_T_start)
      : fcl_(map),
        object_(object.solid, kContact_m),
        robot_(robot.solid, kContact_m),
        map_T_start_(map_T_start) {
    fcl_.setObstacles(obstacles);
    starts_free_ = !fcl_.collides(object_, map_T_start);
  }

  void testObject(const Pose2& pose, const std::string& what) {
    const bool leaving = !starts_free_ && distance(pose, map_T_start_) < kLeaving_m;
    ++result_.poses;
    if (!leaving && fcl_.collides(object_, pose)) fail(what);
  }
  void testRobot(const Pose2& pose, const std::string& what) {
    ++result_.poses;
    if (fcl_.collides(robot_, pose)) fail(what);
  }
  void fail(const std::string& what) {
    if (result_.valid) result_.explanation = what;
    result_.valid = false;
  }
  const PlanVerification& result() const { return result_; }

 private:
  FclChecker fcl_;
  FclChecker::Body object_;
  FclChecker::Body robot_;
  Pose2 map_T_start_;
  bool starts_free_ = true;
  PlanVerification result_;
};

void testPush(const Case& push_case, const Pose2& map_T_start, double zeta, const std::string& name,
              Verifier* verifier) {
  for (const Pose2& pose : sigmaPoints(push_case.start_outcome, zeta)) {
    verifier->testObject(map_T_start * pose, name + ": the object collides at a sigma point");
  }
  for (std::size_t i = 0; i < push_case.steps.size(); ++i) {
    const CaseStep& to = push_case.steps[i];
    const CaseStep& from = push_case.steps[i > 0 ? i - 1 : 0];
    const double way_m = std::max(distance(from.start_T_object, to.start_T_object),
                                  distance(from.start_T_robot(), to.start_T_robot()));
    const int pieces = std::max(1, static_cast<int>(std::ceil(way_m / kStep_m)));
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      verifier->testObject(map_T_start * interpolate(from.start_T_object, to.start_T_object, t),
                           name + ": the object collides on its way");
      verifier->testRobot(map_T_start * interpolate(from.start_T_robot(), to.start_T_robot(), t),
                          name + ": the robot collides on its way");
    }
  }
}

}  // namespace

PlanVerification verifyPlan(const Map& map, const std::vector<PlacedSolid>& obstacles,
                            const ObjectModel& object, const RobotModel& robot,
                            const PushPlan& plan, const std::vector<Case>& cases) {
  Verifier verifier(map, obstacles, object, robot, plan.object.map_T_object);
  Pose2 pose = plan.object.map_T_object;
  for (std::size_t i = 0; i < plan.pushes.size(); ++i) {
    const std::string name = "push " + std::to_string(i + 1);
    const auto found = std::find_if(cases.begin(), cases.end(), [&](const Case& push_case) {
      return push_case.id == plan.pushes[i].case_id;
    });
    if (found == cases.end()) {
      throw InputError("plan", name + " needs case " + std::to_string(plan.pushes[i].case_id) +
                                   ", which is not there");
    }
    constexpr double kSame = 1e-6;
    if (distance(pose, plan.pushes[i].map_T_start) > kSame ||
        std::abs(yawDifference(pose, plan.pushes[i].map_T_start)) > kSame) {
      verifier.fail(name + ": does not start where the push before it ends");
    }
    testPush(*found, pose, plan.zeta, name, &verifier);
    pose = pose * found->start_outcome.mean;
  }
  if (!plan.tolerance.isMet(plan.map_T_goal, pose)) verifier.fail("the plan misses the goal");
  return verifier.result();
}

}  // namespace casepush
