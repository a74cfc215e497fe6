#include "plan_search.h"

#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/SE2StateSpace.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cut_off.h"
#include "dead_end_check.h"
#include "se2_state.h"

namespace casepush {
namespace {

namespace ob = ompl::base;
using Se2 = ob::SE2StateSpace;

// Improving a plan must leave time for the robot's paths to be verified, if they are not yet.
constexpr double kThoroughShare = 0.5;
constexpr double kSimpleShare = 0.97;

std::unique_ptr<SearchSpace> borrowSpace(const SearchProblem& problem, PushChecker* checker) {
  std::unique_ptr<SearchSpace> space = problem.spaces->borrow(checker->collisions().columns());
  space->use(checker);
  return space;
}

ob::ProblemDefinitionPtr makeDefinition(const ob::SpaceInformationPtr& space,
                                        const PlanRequest& request) {
  const auto definition = std::make_shared<ob::ProblemDefinition>(space);
  ob::ScopedState<Se2> start(space);
  setPose(request.object.map_T_object, start.get());
  definition->addStartState(start);
  definition->setGoal(std::make_shared<PushGoal>(space, request.map_T_goal, request.tolerance));
  return definition;
}

ExpRrt makeRrt(const SearchProblem& problem, const ob::SpaceInformationPtr& space,
               PushChecker* checker, std::shared_ptr<const CaseSet> cases, ChanceConstraint* chance,
               GoalGuide* guide, CanApproach can_approach) {
  const PushPlannerOptions& options = problem.options;
  ExpRrtOptions rrt;
  rrt.similarity = options.similarity;
  rrt.goal_bias = options.goal_bias;
  rrt.max_nodes = options.max_nodes;
  rrt.gyration_radius_m = problem.object.gyration_radius_m;
  // As printed, the algorithm knows no cost: there only the very same pose is a duplicate.
  constexpr double kSamePose_m = 1e-3;
  rrt.spacing_m = options.similarity == Similarity::kPaper ? kSamePose_m : options.spacing_m;
  rrt.seed = problem.request.seed;
  rrt.chance = chance;
  const Pose2 object_T_robot =
      problem.request.object.map_T_object.inverse() * problem.request.map_T_robot;
  return ExpRrt(space, checker, std::move(cases), guide, object_T_robot, std::move(can_approach),
                rrt);
}

}  // namespace

bool isMetricExpRrt(const PushPlannerOptions& options) {
  return options.planner == PlannerKind::kExpRrt && options.similarity == Similarity::kMetric;
}

bool keepsOutOfDeadEnds(const PushPlannerOptions& options) {
  return isMetricExpRrt(options) && options.improvement_extensions > 0;
}

std::shared_ptr<const CaseSet> caseSetFor(const SearchProblem& problem, const PushChecker& checker,
                                          double zeta, const SearchClock& clock) {
  const double step_m = kStepPerCell * checker.collisions().columns().resolution_m;
  const auto make = [&]() -> std::shared_ptr<const CaseSet> {
    std::vector<PreparedCase> cases;
    cases.reserve(problem.cases.size());
    for (const Case* push_case : problem.cases) {
      if (clock.isOver()) return nullptr;
      validateCase(*push_case, "case " + std::to_string(push_case->id));
      cases.push_back(
          prepareCase(*push_case, zeta, step_m, problem.object.radius_m, problem.robot.radius_m));
    }
    if (!problem.attach_sweeps(&cases, clock.patience())) return nullptr;
    return std::make_shared<const CaseSet>(std::move(cases), problem.options.time);
  };
  return problem.case_sets->get(problem.cases, zeta, make);
}

SearchChance::SearchChance(const SearchProblem& problem, const std::vector<PreparedCase>& cases,
                           PushChecker* checker, const SafetyLevel& safety) {
  if (!safety.max_collision_probability) return;
  risk_.emplace(problem.cases, cases, checker, problem.options.risk);
  constraint_.emplace(*risk_, *safety.max_collision_probability, problem.request.map_T_goal,
                      problem.request.tolerance);
}

PushPlan planOf(const PlanRequest& request, const std::vector<PreparedCase>& cases,
                const std::vector<int>& pushes, const SafetyLevel& safety, const PushRisk* risk) {
  PushPlan plan;
  plan.object = request.object;
  plan.map_T_goal = request.map_T_goal;
  plan.tolerance = request.tolerance;
  plan.zeta = safety.zeta;
  plan.max_collision_probability = safety.max_collision_probability;
  plan.pushes.reserve(pushes.size());
  Pose2 pose = plan.object.map_T_object;
  for (const int push : pushes) {
    plan.pushes.push_back({cases[push].id, pose, transform(pose, cases[push].start_outcome)});
    pose = pose * cases[push].start_outcome.mean;
  }
  if (risk != nullptr) assessPlan(*risk, pushes, &plan);
  return plan;
}

SearchClock::SearchClock(double deadline_s, std::function<bool()> stop,
                         std::function<void(const PlanProgress&)> report)
    : begin_(std::chrono::steady_clock::now()),
      deadline_s_(deadline_s),
      stop_(std::move(stop)),
      report_(std::move(report)) {}

bool SearchClock::isCancelled() const { return stop_ && stop_(); }

bool SearchClock::isOver(double share) const {
  return isCancelled() || elapsedS() >= share * deadline_s_;
}

double SearchClock::elapsedS() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

Patience SearchClock::patience() const {
  return Patience([this] { return isOver(); });
}

void SearchClock::report(int nodes, double best_cost_s) const {
  constexpr double kPeriod_s = 0.02;
  if (!report_) return;
  const double now_s = elapsedS();
  if (now_s < reported_s_ + kPeriod_s && best_cost_s >= reported_cost_s_) return;
  reported_s_ = now_s;
  reported_cost_s_ = std::min(reported_cost_s_, best_cost_s);
  report_({now_s, nodes_ + nodes, reported_cost_s_});
}

PlanSearch::PlanSearch(const SearchProblem& problem, PushChecker* checker,
                       const SafetyLevel& safety, std::shared_ptr<const CaseSet> cases,
                       GoalGuide* guide, Approaches approaches, const SearchClock& clock)
    : problem_(problem),
      clock_(clock),
      safety_(safety),
      chance_(problem, cases->cases, checker, safety),
      space_(borrowSpace(problem, checker)),
      definition_(makeDefinition(space_->information(), problem.request)),
      rrt_(makeRrt(problem, space_->information(), checker, std::move(cases), chance_.constraint(),
                   guide, approaches == Approaches::kSimple ? simpleApproach() : CanApproach())),
      checker_(checker),
      approaches_how_(approaches),
      approaches_(
          problem, checker->collisions(), [&clock] { return clock.isOver(); }, rrt_.caseSet()) {
  rrt_.setProblemDefinition(definition_);
  rrt_.setup();
  if (keepsOutOfDeadEnds(problem.options) && !safety.first_plan_will_do) {
    const auto get = [this](int push) -> const PreparedCase& { return rrt_.cases()[push]; };
    dead_ends_ = std::make_unique<DeadEndCheck>(
        problem.request, static_cast<int>(rrt_.cases().size()), get, checker, &approaches_);
  }
}

CanApproach PlanSearch::simpleApproach() {
  return [this](const Pose2& map_T_object, const PreparedCase* previous, const PreparedCase& next) {
    const bool can = approaches_.canApproachSimply(map_T_object, previous, next);
    has_rejected_ = has_rejected_ || !can;
    return can;
  };
}

PlanSearch::~PlanSearch() { problem_.spaces->giveBack(std::move(space_)); }

PlanSearch::End PlanSearch::run() {
  constexpr int kMostDeadEnds = 40;
  while (!rrt_.solutions().empty() || findFirst()) {
    improve();
    const std::vector<int> chain = rrt_.chain(rrt_.solutions().front());
    const std::optional<int> unreachable =
        approaches_how_ == Approaches::kSimple ? -1 : findUnreachable(chain);
    if (!unreachable) {
      return solution_ ? End::kFound : End::kStopped;
    }
    if (*unreachable >= 0) {
      has_rejected_ = true;
      rrt_.reject(*unreachable);
      continue;
    }
    const int dead_end = findDeadEnd(chain);
    if (dead_end < 0 || !solution_) solution_ = solutionOf(chain, dead_end);
    if (dead_end < 0 || ++dead_end_count_ > kMostDeadEnds) return End::kFound;
    rrt_.reject(chain[dead_end]);
  }
  return solution_ ? End::kFound : endWithout();
}

PlanSearch::End PlanSearch::endWithout() {
  if (isLate()) return End::kStopped;
  if (isCutOff()) return End::kCutOff;
  return rrt_.tree().size() >= problem_.options.max_nodes ? End::kNodeLimit : End::kExhausted;
}

bool PlanSearch::findFirst() {
  // A search that takes so long may have no end: then it is worth while to look at the whole map,
  // and at what the quick check of approaches turned down.
  constexpr int kQuick = 3000;
  const int quick = rrt_.extensionCount() + kQuick;
  rrt_.search(
      [this, quick] { return rrt_.extensionCount() >= quick || isOver(safety_.deadline_share); });
  if (!rrt_.solutions().empty() || solution_ || isLate() || isCutOff() || mayBeMissing()) {
    return !rrt_.solutions().empty();
  }
  rrt_.search([this] { return isOver(safety_.deadline_share); });
  return !rrt_.solutions().empty();
}

// The quick check may have turned down what there is no way around.
bool PlanSearch::mayBeMissing() const {
  return approaches_how_ == Approaches::kSimple && has_rejected_;
}

bool PlanSearch::isOver(double share) const {
  const auto& solutions = rrt_.solutions();
  clock_.report(rrt_.tree().size(), solutions.empty() ? std::numeric_limits<double>::infinity()
                                                      : rrt_.tree().node(solutions.front()).cost_s);
  return clock_.isOver(share);
}

bool PlanSearch::isCutOff() {
  if (!is_cut_off_) {
    CutOff cut_off = findCutOff(problem_, checker_, rrt_.cases(), clock_);
    is_cut_off_ = cut_off.is_certain;
    narrow_place_ = std::move(cut_off.where);
  }
  return *is_cut_off_;
}

void PlanSearch::improve() {
  if (problem_.options.similarity == Similarity::kPaper || safety_.first_plan_will_do) {
    return;  // Takes the first solution.
  }
  if (improvement_end_ == 0) {
    improvement_end_ =
        std::int64_t{rrt_.extensionCount()} + problem_.options.improvement_extensions;
  }
  const double share = approaches_how_ == Approaches::kSimple ? kSimpleShare : kThoroughShare;
  const std::function<bool()> stop = [this, share] {
    return rrt_.extensionCount() >= improvement_end_ || isOver(share);
  };
  const auto wanted = static_cast<std::size_t>(problem_.options.solutions);
  std::size_t before = 0;
  while (rrt_.solutions().size() < wanted && rrt_.solutions().size() > before) {
    before = rrt_.solutions().size();
    rrt_.search(stop);
  }
}

std::optional<int> PlanSearch::findUnreachable(const std::vector<int>& chain) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (std::find(approachable_.begin(), approachable_.end(), chain[i]) != approachable_.end()) {
      continue;
    }
    if (clock_.isOver()) {
      return std::nullopt;
    }
    if (!canApproach(chain[i])) {
      if (clock_.isOver()) return std::nullopt;
      return chain[i];
    }
    approachable_.push_back(chain[i]);
  }
  return -1;
}

bool PlanSearch::canApproach(int node) {
  const PushNode& pushed = rrt_.tree().node(node);
  const PushNode& start = rrt_.tree().node(pushed.parent);
  const PreparedCase* previous =
      start.parent == PushNode::kRoot ? nullptr : &rrt_.cases()[start.push];
  return approaches_.canApproach(start.map_T_object, previous, rrt_.cases()[pushed.push]);
}

ApproachVerifier::ApproachVerifier(const SearchProblem& problem, const CollisionChecker& checker,
                                   std::function<bool()> stop,
                                   const std::shared_ptr<const void>& owner)
    : problem_(problem),
      stop_(std::move(stop)),
      quick_(problem.approaches, problem.travel, checker, problem.request.obstacles,
             Patience(stop_), owner),
      checker_(checker) {}

bool ApproachVerifier::canApproach(const Pose2& map_T_object, const PreparedCase* previous,
                                   const PreparedCase& next) {
  if (canApproachSimply(map_T_object, previous, next)) {
    return true;
  }
  const Pose2 map_T_robot =
      previous == nullptr ? problem_.request.map_T_robot : map_T_object * previous->outcome_T_robot;
  std::vector<PlacedSolid> standing = problem_.obstacles;
  standing.push_back({problem_.object.solid, map_T_object});
  CollisionChecker checker = checker_;
  checker.setObstacles(std::move(standing));
  const RobotPath path =
      problem_.paths.plan(checker, map_T_robot, map_T_object * next.robot_begin,
                          wrapAngle(map_T_object.yaw() + next.push_direction_rad), stop_);
  if (!path.found) {
    explanation_ = path.explanation;
  }
  return path.found;
}

bool ApproachVerifier::canApproachSimply(const Pose2& map_T_object, const PreparedCase* previous,
                                         const PreparedCase& next) {
  const PlacedObject object{"", problem_.request.object.model, map_T_object};
  return previous == nullptr ? quick_.canReach(object, problem_.request.map_T_robot, next)
                             : quick_.canFollow(object, *previous, next);
}

int PlanSearch::findDeadEnd(const std::vector<int>& chain) {
  if (!dead_ends_) return -1;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (std::find(open_ended_.begin(), open_ended_.end(), chain[i]) != open_ended_.end()) continue;
    const PushNode& pushed = rrt_.tree().node(chain[i]);
    const Pose2& map_T_start = rrt_.tree().node(pushed.parent).map_T_object;
    const PreparedCase& push = rrt_.cases()[pushed.push];
    const bool may_end =
        dead_ends_->mayEndInOne(map_T_start, push, [this] { return clock_.isOver(); });
    if (may_end) return static_cast<int>(i);
    if (clock_.isOver()) return -1;
    open_ended_.push_back(chain[i]);
  }
  return -1;
}

PlanSearch::Solution PlanSearch::solutionOf(const std::vector<int>& chain, int dead_end) const {
  std::vector<int> pushes;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    pushes.push_back(rrt_.tree().node(chain[i]).push);
  }
  return {planOf(problem_.request, rrt_.cases(), pushes, safety_, chance_.risk()),
          rrt_.tree().node(chain.back()).cost_s, std::max(0, dead_end)};
}

}  // namespace casepush
