#include "exp_rrt.h"

#include <ompl/base/PlannerData.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/PathGeometric.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/common/check.h"

namespace casepush {
namespace {

namespace ob = ompl::base;
using Se2 = ob::SE2StateSpace;

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Pose2 poseOf(const ob::State* state) {
  const auto* se2 = state->as<Se2::StateType>();
  return {se2->getX(), se2->getY(), se2->getYaw()};
}

void setState(const Pose2& pose, ob::State* state) {
  auto* se2 = state->as<Se2::StateType>();
  se2->setXY(pose.x(), pose.y());
  se2->setYaw(pose.yaw());
}

Eigen::Vector2d bound(const ob::SpaceInformationPtr& space, bool low) {
  const ob::RealVectorBounds& bounds = space->getStateSpace()->as<Se2>()->getBounds();
  const std::vector<double>& values = low ? bounds.low : bounds.high;
  return {values[0], values[1]};
}

}  // namespace

PushGoal::PushGoal(const ob::SpaceInformationPtr& space, const Pose2& map_T_goal,
                   const GoalTolerance& tolerance)
    : GoalSampleableRegion(space), map_T_goal_(map_T_goal), tolerance_(tolerance) {
  setThreshold(1.0);
}

double PushGoal::distanceGoal(const ob::State* state) const {
  const Pose2 pose = poseOf(state);
  return std::max(distance(pose, map_T_goal_) / tolerance_.position_m,
                  std::abs(yawDifference(pose, map_T_goal_)) / tolerance_.yaw_rad);
}

void PushGoal::sampleGoal(ob::State* state) const { setState(map_T_goal_, state); }

ExpRrt::ExpRrt(const ob::SpaceInformationPtr& space, PushChecker* checker,
               std::vector<PreparedCase> cases, const PushTime& time, const Pose2& object_T_robot,
               const ExpRrtOptions& options)
    : Planner(space, "ExpRrt"),
      checker_(checker),
      cases_(std::move(cases)),
      time_(time),
      object_T_robot_(object_T_robot),
      options_(options),
      min_m_(bound(space, true)),
      max_m_(bound(space, false)),
      tree_(min_m_, max_m_, options.gyration_radius_m, options.spacing_m,
            static_cast<int>(cases_.size())),
      random_(Random::stream(options.seed, "exp_rrt")),
      best_cost_s_(kInfinity) {
  specs_.approximateSolutions = false;
  specs_.directed = true;
}

ExpRrt::~ExpRrt() { freeDataStates(); }

void ExpRrt::setProblemDefinition(const ob::ProblemDefinitionPtr& problem) {
  Planner::setProblemDefinition(problem);
  goal_ = dynamic_cast<const PushGoal*>(problem->getGoal().get());
}

void ExpRrt::clear() {
  Planner::clear();
  tree_.clear();
  random_ = Random::stream(options_.seed, "exp_rrt");
  solutions_.clear();
  promising_ = {};
  best_cost_s_ = kInfinity;
  extension_count_ = 0;
  freeDataStates();
}

ob::PlannerStatus ExpRrt::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  if (goal_ == nullptr) {
    return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  }
  if (!start()) {
    return ob::PlannerStatus::INVALID_START;
  }
  Growth growth = Growth::kNothing;
  while (growth == Growth::kNothing && !stop) {
    growth = grow();
  }
  if (solutions_.empty()) {
    return ob::PlannerStatus::TIMEOUT;
  }
  addSolutionPath(solutions_.front());
  return ob::PlannerStatus::EXACT_SOLUTION;
}

bool ExpRrt::start() {
  while (const ob::State* state = pis_.nextStart()) {
    PushNode root;
    root.map_T_object = poseOf(state);
    const bool is_goal = goal_->isSatisfied(state);
    const int id = tree_.add(root, !is_goal);
    if (is_goal) {
      solutions_.push_back(id);
      best_cost_s_ = 0.0;
    } else if (id >= 0) {
      notePromise(id);
    }
  }
  return tree_.size() > 0;
}

ExpRrt::Growth ExpRrt::grow() {
  if (tree_.size() >= options_.max_nodes) {
    return Growth::kExhausted;
  }
  const Target target = sample();
  const int node = select(target);
  if (node < 0) {
    return Growth::kExhausted;
  }
  ++extension_count_;
  const int push = options_.similarity == Similarity::kPaper ? chooseCaseChecked(node, target.pose)
                                                             : chooseCase(node, target);
  return push < 0 ? Growth::kNothing : extend(node, push);
}

// Alg. 1, line 5. Once a solution is known, only where a cheaper one may pass (informed sampling).
ExpRrt::Target ExpRrt::sample() {
  const bool improves = options_.similarity == Similarity::kMetric && !solutions_.empty();
  if (random_.chance(improves ? options_.improving_goal_bias : options_.goal_bias)) {
    return {goal_->pose(), true};
  }
  constexpr int kAttempts = 20;
  Pose2 pose;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const double x = random_.uniform(min_m_.x(), max_m_.x());
    const double y = random_.uniform(min_m_.y(), max_m_.y());
    pose = Pose2(x, y, random_.uniform(-kPi, kPi));
    const double from_start = distance(tree_.node(0).map_T_object, pose);
    if (time_.lowerBound(from_start) + remaining(pose) < best_cost_s_) {
      break;
    }
  }
  return {pose, false};
}

double ExpRrt::remaining(const Pose2& pose) const {
  return time_.lowerBound(distance(pose, goal_->pose()) - goal_->tolerance().position_m);
}

// Alg. 1, line 6: MOSTSIMILAR, cost-aware in the default mode.
int ExpRrt::select(const Target& target) {
  if (options_.similarity == Similarity::kPaper) {
    return selectMostSimilar(target.pose);
  }
  if (solutions_.empty()) {
    return tree_.nearestOpen(target.pose);
  }
  while (!tree_.openIds().empty()) {
    const int chosen =
        isImproving(target) ? selectMostPromising() : selectCheapestNear(target.pose);
    const PushNode& node = tree_.node(chosen);
    if (node.cost_s + remaining(node.map_T_object) < best_cost_s_) {
      return chosen;
    }
    tree_.close(chosen);
  }
  return -1;
}

// A random radius keeps the tree exploring: a fixed large one never leaves the cheapest nodes.
int ExpRrt::selectCheapestNear(const Pose2& target) {
  nearby_.clear();
  tree_.open().within(target, random_.uniform(0.0, options_.improving_radius_m), &nearby_);
  const auto cheaper = [this](int a, int b) {
    return std::make_pair(tree_.node(a).cost_s, a) < std::make_pair(tree_.node(b).cost_s, b);
  };
  const auto cheapest = std::min_element(nearby_.begin(), nearby_.end(), cheaper);
  return cheapest == nearby_.end() ? tree_.open().nearest(target) : *cheapest;
}

// @pre There is an open node.
int ExpRrt::selectMostPromising() {
  while (!tree_.isOpen(promising_.top().second)) {
    promising_.pop();
  }
  return promising_.top().second;
}

void ExpRrt::notePromise(int node) {
  const PushNode& added = tree_.node(node);
  promising_.emplace(added.cost_s + options_.greed * remaining(added.map_T_object), node);
}

int ExpRrt::selectMostSimilar(const Pose2& target) const {
  const double reach_m = (max_m_ - min_m_).norm();
  int best = -1;
  double best_similarity = -1.0;
  double best_distance = kInfinity;
  for (const int id : tree_.openIds()) {
    const Pose2& pose = tree_.node(id).map_T_object;
    const double similarity = paperSimilarity(pose, target, reach_m);
    const double d = distance(pose, target);
    if (similarity > best_similarity || (similarity == best_similarity && d < best_distance)) {
      best = id;
      best_similarity = similarity;
      best_distance = d;
    }
  }
  return best;
}

// Alg. 1, EXTEND: the same answer as checking all cases first, with a fraction of the checks.
int ExpRrt::chooseCase(int node, const Target& target) {
  const Pose2& pose = tree_.node(node).map_T_object;
  order_.clear();
  for (int push = 0; push < static_cast<int>(cases_.size()); ++push) {
    if (tree_.isTried(node, push)) {
      continue;
    }
    const Pose2 outcome = pose * cases_[push].start_outcome.mean;
    const double d2 = squaredPoseDistance(outcome, target.pose, options_.gyration_radius_m);
    order_.emplace_back(isImproving(target) ? pushCost(node, push) +
                                                  options_.greed * time_.lowerBound(std::sqrt(d2))
                                            : d2,
                        push);
  }
  std::sort(order_.begin(), order_.end());
  for (const auto& [key, push] : order_) {
    if (checker_->isSafe(cases_[push], pose)) {
      return push;
    }
    tree_.markTried(node, push);
  }
  return -1;
}

int ExpRrt::chooseCaseChecked(int node, const Pose2& target) {
  const double reach_m = (max_m_ - min_m_).norm();
  const Pose2& pose = tree_.node(node).map_T_object;
  int best = -1;
  std::pair<double, double> best_key{-1.0, 0.0};
  for (int push = 0; push < static_cast<int>(cases_.size()); ++push) {
    if (tree_.isTried(node, push)) {
      continue;
    }
    if (!checker_->isSafe(cases_[push], pose)) {
      tree_.markTried(node, push);
      continue;
    }
    const Pose2 outcome = pose * cases_[push].start_outcome.mean;
    const std::pair<double, double> key{paperSimilarity(outcome, target, reach_m),
                                        -distance(outcome, target)};
    if (best < 0 || key > best_key) {
      best = push;
      best_key = key;
    }
  }
  return best;
}

double ExpRrt::pushCost(int node, int push) const {
  const int previous = tree_.node(node).push;
  return previous < 0 ? time_.first(object_T_robot_, push) : time_.after(previous, push);
}

ExpRrt::Growth ExpRrt::extend(int node, int push) {
  PushNode child;
  child.map_T_object = tree_.node(node).map_T_object * cases_[push].start_outcome.mean;
  child.parent = node;
  child.push = push;
  child.cost_s = tree_.node(node).cost_s + pushCost(node, push);
  const bool is_goal = goal_->tolerance().isMet(goal_->pose(), child.map_T_object);
  const bool is_hopeless = child.cost_s + remaining(child.map_T_object) >= best_cost_s_;
  const int id = is_hopeless ? -1 : tree_.add(child, !is_goal);
  if (id < 0) {
    tree_.markPostponed(node, push);
    return Growth::kNothing;
  }
  tree_.markTried(node, push);
  if (!is_goal) {
    notePromise(id);
    return Growth::kNothing;
  }
  const auto cheaper = [this](int a, int b) { return tree_.node(a).cost_s < tree_.node(b).cost_s; };
  solutions_.insert(std::upper_bound(solutions_.begin(), solutions_.end(), id, cheaper), id);
  best_cost_s_ = tree_.node(solutions_.front()).cost_s;
  return Growth::kSolution;
}

std::vector<int> ExpRrt::chain(int node) const {
  std::vector<int> nodes;
  for (int id = node; id != PushNode::kRoot; id = tree_.node(id).parent) {
    nodes.push_back(id);
  }
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

void ExpRrt::reject(int node) {
  tree_.removeSubtree(node);
  const auto gone = [this](int id) { return tree_.isRemoved(id); };
  solutions_.erase(std::remove_if(solutions_.begin(), solutions_.end(), gone), solutions_.end());
  best_cost_s_ = solutions_.empty() ? kInfinity : tree_.node(solutions_.front()).cost_s;
  promising_ = {};
  for (const int id : tree_.openIds()) {
    notePromise(id);
  }
}

void ExpRrt::addSolutionPath(int node) {
  auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
  ob::State* state = si_->allocState();
  for (const int id : chain(node)) {
    setState(tree_.node(id).map_T_object, state);
    path->append(state);
  }
  si_->freeState(state);
  pdef_->addSolutionPath(path, false, 0.0, getName());
}

void ExpRrt::freeDataStates() const {
  for (ob::State* state : data_states_) {
    si_->freeState(state);
  }
  data_states_.clear();
}

void ExpRrt::getPlannerData(ob::PlannerData& data) const {
  Planner::getPlannerData(data);
  freeDataStates();
  for (int id = 0; id < tree_.size(); ++id) {
    data_states_.push_back(si_->allocState());
    const PushNode& node = tree_.node(id);
    setState(node.map_T_object, data_states_.back());
    if (tree_.isRemoved(id)) {
      continue;
    }
    const ob::PlannerDataVertex vertex(data_states_.back(), id);
    if (node.parent == PushNode::kRoot) {
      data.addStartVertex(vertex);
    } else if (goal_->isSatisfied(data_states_.back())) {
      data.addGoalVertex(vertex);
    } else {
      data.addVertex(vertex);
    }
    if (node.parent != PushNode::kRoot) {
      data.addEdge(ob::PlannerDataVertex(data_states_[node.parent]), vertex);
    }
  }
}

}  // namespace casepush
