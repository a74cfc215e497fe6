#include "casepush/planning/push_planner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>
#include <utility>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/model/plan_scatter.h"
#include "chain_plan.h"
#include "cut_off.h"
#include "plan_request.h"
#include "plan_search.h"
#include "planner_data.h"

namespace casepush {
namespace {

constexpr std::size_t kShownEdges = 4000;  // More than can be told apart on a screen.

void addTree(const ExpRrt& rrt, PlanResult* result) {
  const PushTree& tree = rrt.tree();
  result->nodes += tree.size();
  result->tree.clear();
  result->tree.reserve(std::min<std::size_t>(tree.size(), kShownEdges));
  for (int id = 0; id < tree.size() && result->tree.size() < kShownEdges; ++id) {
    const PushNode& node = tree.node(id);
    if (!tree.isRemoved(id) && node.parent != PushNode::kRoot) {
      result->tree.push_back({tree.node(node.parent).map_T_object, node.map_T_object});
    }
  }
}

std::string solvedText(const PlanResult& result, const PushPlannerOptions& options) {
  const PushPlan& plan = result.plan;
  std::string text = std::to_string(plan.pushes.size()) + " pushes over " +
                     rounded(plan.lengthM(), 1) + " m, about " + rounded(result.expected_s, 0) +
                     " s";
  if (plan.max_collision_probability) {
    text += ", collision probability " + rounded(plan.collision_probability, 3);
    if (*plan.max_collision_probability > options.risk.max_collision_probability) {
      text += "; no plan keeps " + rounded(options.risk.max_collision_probability, 3);
    }
  } else if (plan.zeta < options.zeta) {
    text +=
        "; safe only for zeta " + rounded(plan.zeta, 1) + " instead of " + rounded(options.zeta, 1);
  }
  if (result.dead_end > 0) {
    text += "; push " + std::to_string(result.dead_end) +
            " may leave the object where no case can be applied";
  }
  return text;
}

/// How one search ended, whichever planner made it.
struct Outcome {
  PlanSearch::End end = PlanSearch::End::kExhausted;
  PlanSearch::Solution solution;
  int nodes = 0;
  std::string approach_problem;
  std::string narrow_place;
};

std::string unreachableText(const Outcome& outcome, int max_nodes) {
  if (outcome.end == PlanSearch::End::kCutOff && !outcome.narrow_place.empty()) {
    return "the goal region cannot be reached: " + outcome.narrow_place +
           "; clear some space or move the goal";
  }
  if (outcome.end == PlanSearch::End::kCutOff) {
    return "the goal region cannot be reached: walls or furniture block every way of the object to "
           "it; clear some space or move the goal";
  }
  std::string text;
  if (outcome.end == PlanSearch::End::kNodeLimit) {
    text = "no plan within " + std::to_string(max_nodes) +
           " poses; raise max_nodes, learn more cases or move the goal";
  } else if (outcome.nodes <= 1) {
    text = "no case can be applied where the object stands; clear some space around it";
  } else {
    text = "no case leads any farther after " + std::to_string(outcome.nodes) +
           " poses; clear some space, learn more cases or move the goal";
  }
  if (!outcome.approach_problem.empty()) {
    text += " (the robot could not get to a push: " + outcome.approach_problem + ")";
  }
  return text;
}

Outcome searchOnce(const SearchProblem& problem, PushChecker* checker, const SafetyLevel& safety,
                   GoalGuide* guide, const SearchClock& clock, PlanResult* result) {
  Outcome outcome;
  if (problem.options.planner == PlannerKind::kLattice || isOmpl(problem.options.planner)) {
    ChainPlan made = planChain(problem, checker, safety, clock);
    result->nodes += made.nodes;
    result->bound = made.bound;
    return {made.end,
            {std::move(made.plan), made.expected_s, 0},
            made.nodes,
            std::move(made.approach_problem),
            std::move(made.narrow_place)};
  }
  outcome.end = PlanSearch::End::kStopped;
  std::shared_ptr<const CaseSet> cases = caseSetFor(problem, *checker, safety.zeta, clock);
  if (cases == nullptr) {
    return outcome;
  }
  for (const Approaches approaches : {Approaches::kSimple, Approaches::kThorough}) {
    PlanSearch search(problem, checker, safety, cases, guide, approaches, clock);
    outcome.end = search.run();
    addTree(search.rrt(), result);
    outcome.nodes = search.rrt().tree().size();
    outcome.approach_problem = search.approachProblem();
    outcome.narrow_place = search.narrowPlace();
    if (outcome.end == PlanSearch::End::kFound) {
      outcome.solution = search.takeSolution();
    }
    const bool is_over = outcome.end != PlanSearch::End::kExhausted || !search.hasRejected();
    if (is_over) {
      break;
    }
    clock.addNodes(outcome.nodes);
  }
  problem.disposal->take(std::move(cases));  // There may be thousands of them.
  return outcome;
}

/// Until the deadline. Other seeds lead elsewhere; other planners would only find the same again.
bool searchesAgain(const PushPlannerOptions& options) {
  PushPlannerOptions patient = options;
  patient.improveUntilDeadline();
  return options.solutions == patient.solutions &&
         options.improvement_extensions == patient.improvement_extensions &&
         isMetricExpRrt(options);
}

/// Is it as safe, and quicker?
bool isBetter(const PlanResult& a, const PlanResult& b) {
  return a.status == PlanStatus::kSolved && a.expected_s < b.expected_s &&
         a.plan.zeta >= b.plan.zeta && (a.dead_end == 0 || b.dead_end > 0) &&
         a.plan.max_collision_probability.value_or(1.0) <=
             b.plan.max_collision_probability.value_or(1.0);
}

PlanResult failed(PlanStatus status, std::string explanation) {
  PlanResult result;
  result.status = status;
  result.explanation = std::move(explanation);
  return result;
}

PlanResult stopped(const PlanRequest& request, const SearchClock& clock) {
  if (clock.isCancelled()) return failed(PlanStatus::kCancelled, "cancelled while planning");
  return failed(PlanStatus::kDeadline,
                "no plan within " + rounded(request.deadline_s, request.deadline_s < 0.1 ? 3 : 1) +
                    " s; allow more time or move the goal");
}

}  // namespace

PlanResult PushPlanner::plan(const PlanRequest& request, const std::vector<Case>& cases,
                             const std::function<bool()>& stop,
                             const std::function<void(const PlanProgress&)>& report) const {
  const SearchClock clock(request.deadline_s, stop, report);
  if (const auto problem = checkRequest(request, data_->objects)) {
    return failed(problem->status, problem->explanation);
  }
  std::vector<const Case*> own;
  for (const Case& push_case : cases) {
    if (isFor(push_case, request.object.model, data_->robot.name)) {
      own.push_back(&push_case);
    }
  }
  PlanResult result;
  if (own.empty()) {
    result = failed(PlanStatus::kNoCases, "there are no cases of \"" + request.object.model +
                                              "\" pushed by robot \"" + data_->robot.name +
                                              "\"; learn some first");
  } else {
    try {
      result = data_->searchFinestLast(request, own, clock);
      if (searchesAgain(data_->options)) data_->searchAgain(request, own, clock, &result);
    } catch (const InputError& error) {
      result = failed(PlanStatus::kInvalidRequest, error.what());
    }
  }
  result.planning_s = clock.elapsedS();
  return result;
}

PushPlanner::Data::Attempt PushPlanner::Data::search(const PlanRequest& request,
                                                     const std::vector<const Case*>& cases,
                                                     const SearchClock& clock) const {
  const ObjectRoom* room = rooms->get(request.object.model, clock.patience());
  if (room == nullptr) return {stopped(request, clock)};
  const Footprints& own = footprints.at(request.object.model);
  const auto scene = scenes->get(request.object.model, request.obstacles, [&] {
    const std::vector<PlacedSolid> obstacles = placeObstacles(request.obstacles, objects);
    return Scene{own.sweeps->withObstaclesOf(checkerWith(obstacles)), room->halfSteps(obstacles)};
  });
  PushChecker push_checker = pushChecker(request.object.model, scene->sweeps);
  if (const auto problem = checkStartAndGoal(request, push_checker.collisions(), *own.exact)) {
    return {failed(problem->status, problem->explanation)};
  }
  push_checker.tolerateStart(request.object.map_T_object);
  const SearchProblem problem =
      this->problem(request, cases, scene->sweeps.collisions().obstacles());
  GoalGuide guide(*room, scene->room, request.object.map_T_object.position(),
                  request.map_T_goal.position(), request.tolerance.position_m);
  if (!guide.reachesStart()) {
    Outcome cut_off;
    cut_off.end = PlanSearch::End::kCutOff;
    cut_off.narrow_place = placeTooNarrow(problem, push_checker.collisions(), clock);
    return {failed(PlanStatus::kUnreachable, unreachableText(cut_off, options.max_nodes))};
  }
  return searchLevels(problem, &push_checker, &guide, clock);
}

// What is not found with the least safety is not found with more. So that is looked for second:
// where there is no plan, two searches tell.
PushPlanner::Data::Attempt PushPlanner::Data::searchLevels(const SearchProblem& problem,
                                                           PushChecker* push_checker,
                                                           GoalGuide* guide,
                                                           const SearchClock& clock) const {
  const std::vector<SafetyLevel> levels = safetyLevels(options.risk, options.zeta);
  int nodes = 0;
  const auto search = [&](const SafetyLevel& safety) {
    Attempt attempt = searchLevel(problem, push_checker, safety, guide, clock);
    nodes += attempt.result.nodes;
    attempt.result.nodes = nodes;
    return attempt;
  };
  Attempt attempt = search(levels.front());
  std::optional<Attempt> probe;
  if (attempt.is_worth_relaxing && levels.size() > 2 && options.planner != PlannerKind::kLattice &&
      !isOmpl(options.planner)) {
    SafetyLevel least = levels.back();
    least.first_plan_will_do = true;
    probe = search(least);
    if (probe->result.status != PlanStatus::kSolved) return *probe;
  }
  for (std::size_t i = 1; i < levels.size() && attempt.is_worth_relaxing; ++i) {
    attempt = search(levels[i]);
  }
  const bool says_more = attempt.result.status == PlanStatus::kSolved ||
                         attempt.result.status == PlanStatus::kCancelled;
  return probe && !says_more ? std::move(*probe) : std::move(attempt);
}

PushPlanner::Data::Attempt PushPlanner::Data::searchLevel(const SearchProblem& problem,
                                                          PushChecker* push_checker,
                                                          const SafetyLevel& safety,
                                                          GoalGuide* guide,
                                                          const SearchClock& clock) const {
  Attempt attempt;
  PlanResult& result = attempt.result;
  Outcome outcome = searchOnce(problem, push_checker, safety, guide, clock, &result);
  result.collision_checks = push_checker->checkCount();
  clock.addNodes(outcome.nodes);
  if (outcome.end == PlanSearch::End::kFound) {
    result.status = PlanStatus::kSolved;
    result.plan = std::move(outcome.solution.plan);
    compoundPushes(&result.plan);
    result.expected_s = outcome.solution.expected_s;
    result.dead_end = outcome.solution.dead_end;
    result.explanation = solvedText(result, options);
    return attempt;
  }
  if (outcome.end == PlanSearch::End::kStopped && clock.isOver()) {
    const PlanResult why = stopped(problem.request, clock);
    result.status = why.status;
    result.explanation = why.explanation;
    return attempt;
  }
  result.status = PlanStatus::kUnreachable;
  result.explanation = unreachableText(outcome, options.max_nodes);
  // Where it is cut off, it is so with no spread of outcomes either.
  attempt.is_worth_relaxing = options.relax && outcome.end != PlanSearch::End::kCutOff;
  return attempt;
}

// Poses near to one another, and shortened cases (negative ids), multiply what a search has to look
// at. So they wait until the others lead nowhere: in a tight spot a few centimetres decide.
PlanResult PushPlanner::Data::searchFinestLast(const PlanRequest& request,
                                               const std::vector<const Case*>& cases,
                                               const SearchClock& clock) const {
  constexpr double kFiner = 0.25;
  std::vector<const Case*> whole;
  std::copy_if(cases.begin(), cases.end(), std::back_inserter(whole),
               [](const Case* push_case) { return push_case->id >= 0; });
  if (whole.empty()) whole = cases;
  Attempt attempt = search(request, whole, clock);
  PlanResult& result = attempt.result;
  const bool is_unreachable =
      result.status == PlanStatus::kUnreachable && options.relax && !clock.isOver();
  if (!is_unreachable) return std::move(result);
  Data finer = *this;
  PlanResult other = result;
  if (attempt.is_worth_relaxing && isMetricExpRrt(options) && result.nodes < options.max_nodes) {
    finer.options.spacing_m *= kFiner;
    other = finer.search(request, whole, clock).result;
  }
  // Where the others are cut off, these may still have larger steps.
  if (other.status == PlanStatus::kUnreachable && whole.size() < cases.size() && !clock.isOver()) {
    other = finer.search(request, cases, clock).result;
  }
  const bool says_more =
      other.status == PlanStatus::kSolved || other.status == PlanStatus::kCancelled;
  return says_more ? std::move(other) : std::move(result);
}

// Until the time is up.
void PushPlanner::Data::searchAgain(const PlanRequest& request,
                                    const std::vector<const Case*>& cases, const SearchClock& clock,
                                    PlanResult* result) const {
  PlanRequest again = request;
  while (result->status == PlanStatus::kSolved && !result->plan.pushes.empty() && !clock.isOver()) {
    ++again.seed;
    improve(again, cases, clock, result);
  }
}

// Searches once more and takes what is better.
void PushPlanner::Data::improve(const PlanRequest& request, const std::vector<const Case*>& cases,
                                const SearchClock& clock, PlanResult* result) const {
  PlanResult other = searchFinestLast(request, cases, clock);
  const int nodes = result->nodes + other.nodes;
  const int collision_checks = result->collision_checks + other.collision_checks;
  if (isBetter(other, *result)) *result = std::move(other);
  result->nodes = nodes;
  result->collision_checks = collision_checks;
}

std::string PushPlanner::touched(const std::string& model, const std::vector<Pose2>& map_T_object,
                                 const std::vector<PlacedObject>& obstacles,
                                 double deeper_than_m) const {
  const auto found = data_->footprints.find(model);
  if (found == data_->footprints.end()) return "";
  std::vector<PlacedObject> known;
  std::copy_if(
      obstacles.begin(), obstacles.end(), std::back_inserter(known),
      [this](const PlacedObject& each) { return checkObstacles({each}, data_->objects).empty(); });
  const std::vector<PlacedSolid> placed = placeObstacles(known, data_->objects);
  const CollisionChecker checker = data_->checkerWith(placed);
  const Footprint& exact = *found->second.exact;
  for (const Pose2& pose : map_T_object) {
    if (!checker.collides(exact, pose)) continue;
    for (const Contact& contact : checker.contacts(exact, pose)) {
      if (contact.depth_m > deeper_than_m) return describe(contact, placed);
    }
  }
  return "";
}

RobotPath PushPlanner::approachPath(const PlacedObject& object,
                                    const std::vector<PlacedObject>& obstacles,
                                    const Pose2& map_T_robot, const Pose2& map_T_goal,
                                    double dock_direction_rad) const {
  std::vector<PlacedObject> standing = obstacles;
  standing.push_back(object);
  RobotPath path;
  path.explanation = checkObstacles(standing, data_->objects);
  if (!path.explanation.empty()) {
    return path;
  }
  if (!map_T_robot.isFinite() || !map_T_goal.isFinite() || !std::isfinite(dock_direction_rad)) {
    path.explanation = "the robot's pose or goal is not finite";
    return path;
  }
  const CollisionChecker checker = data_->checkerWith(placeObstacles(standing, data_->objects));
  return data_->paths.plan(checker, map_T_robot, map_T_goal, dock_direction_rad);
}

}  // namespace casepush
