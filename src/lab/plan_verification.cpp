#include "casepush/lab/plan_verification.h"

#include <algorithm>
#include <cmath>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/lab/binomial_interval.h"
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
  bool isHit() const { return !result_.valid; }
  void forget() { result_ = {}; }
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

/// @param deviation  Of the object at the end, in the frame of the outcome; grows up to there.
void testMotion(const Case& push_case, const Pose2& map_T_start, double step_m,
                const Eigen::Vector3d& deviation, const std::string& name, Verifier* verifier) {
  const double count = static_cast<double>(push_case.steps.size());
  for (std::size_t i = 0; i < push_case.steps.size(); ++i) {
    const CaseStep& to = push_case.steps[i];
    const CaseStep& from = push_case.steps[i > 0 ? i - 1 : 0];
    const double way_m = std::max(distance(from.start_T_object, to.start_T_object),
                                  distance(from.start_T_robot(), to.start_T_robot()));
    const int pieces = std::max(1, static_cast<int>(std::ceil(way_m / step_m)));
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      const Pose2 off = expSe2((static_cast<double>(i) + t) / count * deviation);
      verifier->testObject(
          map_T_start * interpolate(from.start_T_object, to.start_T_object, t) * off,
          name + ": the object collides on its way");
      verifier->testRobot(map_T_start * interpolate(from.start_T_robot(), to.start_T_robot(), t),
                          name + ": the robot collides on its way");
    }
  }
}

void testPush(const Case& push_case, const Pose2& map_T_start, double zeta, const std::string& name,
              Verifier* verifier) {
  for (const Pose2& pose : sigmaPoints(push_case.start_outcome, zeta)) {
    verifier->testObject(map_T_start * pose, name + ": the object collides at a sigma point");
  }
  testMotion(push_case, map_T_start, kStep_m, Eigen::Vector3d::Zero(), name, verifier);
}

const Case& caseOf(const PushPlan& plan, std::size_t push, const std::vector<Case>& cases) {
  const Case* found = findCase(cases, plan.pushes[push].case_id);
  if (found == nullptr) {
    throw InputError("plan", "push " + std::to_string(push + 1) + " needs case " +
                                 std::to_string(plan.pushes[push].case_id) +
                                 ", which is not there");
  }
  return *found;
}

/// One random execution; true if something collides.
bool drawCollides(const PushPlan& plan, const std::vector<Case>& cases, std::size_t horizon,
                  Random* random, Verifier* verifier, Pose2* map_T_end) {
  verifier->forget();
  std::vector<Pose2> moves;  // What each push really does to the object, in its start frame.
  *map_T_end = plan.object.map_T_object;
  for (std::size_t i = 0; i < plan.pushes.size(); ++i) {
    const Case& push_case = caseOf(plan, i, cases);
    const Eigen::Vector3d normal(random->normal(1.0), random->normal(1.0), random->normal(1.0));
    const Eigen::Vector3d deviation = covarianceRoot(push_case.start_outcome.covariance) * normal;
    const std::size_t first = i + 1 > horizon ? i + 1 - horizon : 0;
    Pose2 start = plan.pushes[first].map_T_start;
    for (std::size_t before = first; before < i; ++before) start = start * moves[before];
    moves.push_back(push_case.start_outcome.mean * expSe2(deviation));
    *map_T_end = *map_T_end * moves.back();
    if (verifier->isHit()) continue;
    verifier->testObject(start * moves.back(), "outcome");
    constexpr double kCoarse_m = 0.04;
    if (!verifier->isHit()) testMotion(push_case, start, kCoarse_m, deviation, "", verifier);
  }
  return verifier->isHit();
}

}  // namespace

PlanVerification verifyPlan(const Map& map, const std::vector<PlacedSolid>& obstacles,
                            const ObjectModel& object, const RobotModel& robot,
                            const PushPlan& plan, const std::vector<Case>& cases) {
  Verifier verifier(map, obstacles, object, robot, plan.object.map_T_object);
  Pose2 pose = plan.object.map_T_object;
  for (std::size_t i = 0; i < plan.pushes.size(); ++i) {
    const std::string name = "push " + std::to_string(i + 1);
    const Case& push_case = caseOf(plan, i, cases);
    constexpr double kSame = 1e-6;
    if (distance(pose, plan.pushes[i].map_T_start) > kSame ||
        std::abs(yawDifference(pose, plan.pushes[i].map_T_start)) > kSame) {
      verifier.fail(name + ": does not start where the push before it ends");
    }
    testPush(push_case, pose, plan.zeta, name, &verifier);
    pose = pose * push_case.start_outcome.mean;
  }
  if (!plan.tolerance.isMet(plan.map_T_goal, pose)) verifier.fail("the plan misses the goal");
  return verifier.result();
}

RiskVerification verifyRisk(const Map& map, const std::vector<PlacedSolid>& obstacles,
                            const ObjectModel& object, const RobotModel& robot,
                            const PushPlan& plan, const std::vector<Case>& cases, int horizon,
                            int draws, std::uint64_t seed) {
  Verifier verifier(map, obstacles, object, robot, plan.object.map_T_object);
  Random random = Random::stream(seed, "plan verification");
  RiskVerification result;
  result.draws = draws;
  const double n = draws;
  int hits = 0;
  for (int draw = 0; draw < draws; ++draw) {
    Pose2 end;
    const bool hit =
        drawCollides(plan, cases, static_cast<std::size_t>(horizon), &random, &verifier, &end);
    hits += hit ? 1 : 0;
    result.goal_probability += plan.tolerance.isMet(plan.map_T_goal, end) ? 1.0 / n : 0.0;
  }
  const BinomialInterval interval = wilsonInterval(hits, draws);
  result.collision_probability = interval.share;
  result.low = interval.low;
  result.high = interval.high;
  result.valid = result.low <= plan.max_collision_probability.value_or(1.0);
  return result;
}

}  // namespace casepush
