#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/control/PathControl.h>
#include <ompl/control/SimpleDirectedControlSampler.h>
#include <ompl/control/SpaceInformation.h>
#include <ompl/control/planners/est/EST.h>
#include <ompl/control/planners/kpiece/KPIECE1.h>
#include <ompl/control/planners/pdst/PDST.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/control/planners/sst/SST.h>
#include <ompl/control/spaces/DiscreteControlSpace.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chain_search.h"
#include "disposal.h"
#include "exp_rrt.h"
#include "se2_state.h"

namespace casepush {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;
using Se2 = ob::SE2StateSpace;
using Discrete = oc::DiscreteControlSpace;

constexpr double kNowhere_m = 1e6;  // Where pushes end that are not safe: outside of the bounds.

/// One step of propagation is one push.
class PushPropagator : public oc::StatePropagator {
 public:
  PushPropagator(const oc::SpaceInformationPtr& space, const ChainProblem& problem,
                 const std::function<bool()>& stop)
      : StatePropagator(space), problem_(problem), stop_(stop) {}

  void propagate(const ob::State* state, const oc::Control* control, double,
                 ob::State* result) const override {
    const int push = control->as<Discrete::ControlType>()->value;
    const Pose2 from = poseOf(state);
    // Some planners ask for as many pushes as there are cases before they look whether to stop.
    if (stop_() || !problem_.checker.isSafe(problem_.cases[push], from)) {
      setPose(Pose2(kNowhere_m, kNowhere_m, 0.0), result);
      return;
    }
    ++safe_;
    setPose(from * problem_.cases[push].start_outcome.mean, result);
  }
  bool canPropagateBackward() const override { return false; }
  int safeCount() const { return safe_; }  ///< Pushes that could be added to a tree so far.

 private:
  const ChainProblem& problem_;
  const std::function<bool()>& stop_;
  mutable int safe_ = 0;
};

oc::SpaceInformationPtr makeSpace(const ChainProblem& problem, const std::function<bool()>& stop) {
  const CollisionChecker::Columns& columns = problem.checker.collisions().columns();
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, columns.origin_m.x());
  bounds.setLow(1, columns.origin_m.y());
  bounds.setHigh(0, columns.origin_m.x() + columns.width * columns.resolution_m);
  bounds.setHigh(1, columns.origin_m.y() + columns.height * columns.resolution_m);
  const auto states = std::make_shared<Se2>();
  states->setBounds(bounds);
  const auto last = static_cast<int>(problem.cases.size()) - 1;
  const auto controls = std::make_shared<Discrete>(states, 0, last);
  const auto space = std::make_shared<oc::SpaceInformation>(states, controls);
  ob::SpaceInformation* raw = space.get();
  space->setStateValidityChecker(
      [raw](const ob::State* state) { return raw->satisfiesBounds(state); });
  space->setStatePropagator(std::make_shared<PushPropagator>(space, problem, stop));
  space->setPropagationStepSize(1.0);
  space->setMinMaxControlDuration(1, 1);
  // As directed as Exp-RRT's EXTEND: of as many tries as there are cases the best one.
  const auto tries = static_cast<unsigned>(problem.cases.size());
  space->setDirectedControlSamplerAllocator([tries](const oc::SpaceInformation* information) {
    return std::make_shared<oc::SimpleDirectedControlSampler>(information, tries);
  });
  space->setup();
  return space;
}

ob::PlannerPtr makePlanner(PlannerKind kind, const oc::SpaceInformationPtr& space) {
  switch (kind) {
    case PlannerKind::kOmplSst:
      return std::make_shared<oc::SST>(space);
    case PlannerKind::kOmplEst:
      return std::make_shared<oc::EST>(space);
    case PlannerKind::kOmplPdst:
      return std::make_shared<oc::PDST>(space);
    case PlannerKind::kOmplKpiece:
      return std::make_shared<oc::KPIECE1>(space);
    default:
      return std::make_shared<oc::RRT>(space);
  }
}

}  // namespace

ChainResult searchWithOmpl(PlannerKind kind, const ChainProblem& problem,
                           const std::function<bool()>& stop, Disposal* disposal) {
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  const oc::SpaceInformationPtr space = makeSpace(problem, stop);
  const auto* pushes = static_cast<const PushPropagator*>(space->getStatePropagator().get());
  const auto definition = std::make_shared<ob::ProblemDefinition>(space);
  ob::ScopedState<Se2> start(space);
  setPose(problem.map_T_start, start.get());
  definition->addStartState(start);
  definition->setGoal(std::make_shared<PushGoal>(space, problem.map_T_goal, problem.tolerance));
  // SST goes on improving until the objective is met: any solution meets this one.
  const auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(space);
  objective->setCostThreshold(objective->infiniteCost());
  definition->setOptimizationObjective(objective);
  ob::PlannerPtr planner = makePlanner(kind, space);
  planner->setProblemDefinition(definition);
  planner->setup();
  const ob::PlannerTerminationCondition condition(stop);
  ChainResult result;
  const ob::PlannerStatus status = planner->solve(condition);
  // The planner's own data takes seconds to collect.
  result.nodes = pushes->safeCount();
  disposal->take(std::move(planner));
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return result;
  const auto* path = definition->getSolutionPath()->as<oc::PathControl>();
  Pose2 pose = problem.map_T_start;
  int previous = -1;
  for (std::size_t i = 0; i < path->getControlCount(); ++i) {
    const int push = path->getControl(i)->as<Discrete::ControlType>()->value;
    result.cost_s += previous < 0 ? problem.time.first(pose.inverse() * problem.map_T_robot, push)
                                  : problem.time.after(previous, push);
    pose = pose * problem.cases[push].start_outcome.mean;
    previous = push;
    result.pushes.push_back(push);
  }
  result.found = problem.tolerance.isMet(problem.map_T_goal, pose);
  return result;
}

}  // namespace casepush
