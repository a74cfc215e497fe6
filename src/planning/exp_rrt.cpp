#include "exp_rrt.h"

#include <ompl/base/PlannerData.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/PathGeometric.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/common/check.h"
#include "se2_state.h"

namespace casepush {
namespace {

namespace ob = ompl::base;
using Se2 = ob::SE2StateSpace;

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

void PushGoal::sampleGoal(ob::State* state) const { setPose(map_T_goal_, state); }

ExpRrt::ExpRrt(const ob::SpaceInformationPtr& space, PushChecker* checker,
               std::shared_ptr<const CaseSet> cases, GoalGuide* guide, const Pose2& object_T_robot,
               CanApproach can_approach, const ExpRrtOptions& options)
    : Planner(space, "ExpRrt"),
      checker_(checker),
      set_(std::move(cases)),
      guide_(guide),
      object_T_robot_(object_T_robot),
      can_approach_(std::move(can_approach)),
      options_(options),
      min_m_(bound(space, true)),
      max_m_(bound(space, false)),
      tree_(min_m_, max_m_, options.gyration_radius_m, options.spacing_m,
            static_cast<int>(set_->cases.size())),
      random_(Random::stream(options.seed, "exp_rrt")),
      best_cost_s_(kInfinity) {
  CASEPUSH_CHECK(options.chance == nullptr || options.similarity == Similarity::kMetric,
                 "chance constraints with the paper's similarity");
  constexpr std::size_t kMostly = 64;  // Nodes of a search that soon finds its goal.
  edges_.reserve(kMostly);
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
  edges_.clear();
  must_note_all_ = false;
  is_approached_.clear();
  best_cost_s_ = kInfinity;
  extension_count_ = 0;
  freeDataStates();
}

ob::PlannerStatus ExpRrt::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  if (goal_ == nullptr) {
    return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  }
  if (!search([&stop] { return stop(); })) {
    return ob::PlannerStatus::INVALID_START;
  }
  if (solutions_.empty()) {
    return ob::PlannerStatus::TIMEOUT;
  }
  addSolutionPath(solutions_.front());
  return ob::PlannerStatus::EXACT_SOLUTION;
}

bool ExpRrt::search(const std::function<bool()>& stop) {
  stop_ = &stop;
  const std::size_t known = solutions_.size();
  if (!start()) return false;
  Growth growth = solutions_.size() > known ? Growth::kSolution : Growth::kNothing;
  while (growth == Growth::kNothing && !stop()) {
    growth = grow();
  }
  return true;
}

bool ExpRrt::start() {
  while (const ob::State* state = pis_.nextStart()) {
    PushNode root;
    root.map_T_object = poseOf(state);
    const bool is_goal = goal_->isSatisfied(state);
    const int id = tree_.add(root, !is_goal);
    is_approached_.resize(tree_.size(), true);
    if (is_goal) {
      solutions_.push_back(id);
      best_cost_s_ = 0.0;
    } else if (id >= 0 && options_.similarity == Similarity::kMetric) {
      noteEdges(id);
      connect(id);
    }
  }
  return tree_.size() > 0;
}

ExpRrt::Growth ExpRrt::grow() {
  if (tree_.size() >= options_.max_nodes) {
    return Growth::kExhausted;
  }
  ++extension_count_;
  work_ = 0;
  if (must_note_all_ && options_.similarity == Similarity::kMetric) {
    noteAllEdges();
  }
  const Target target = sample();
  if (options_.similarity == Similarity::kMetric) {
    return target.is_goal ? growToGoal() : growToSample(target.pose);
  }
  const int node = selectMostSimilar(target.pose);
  if (node < 0) {
    return Growth::kExhausted;
  }
  const int push = isReachable(node) ? chooseCaseChecked(node, target.pose) : -1;
  return push < 0 ? Growth::kNothing : extend(node, push);
}

ExpRrt::Growth ExpRrt::growToGoal() {
  if (edges_.empty()) {
    noteAllEdges();  // Somebody may have stopped before all were noted.
  }
  const std::optional<EdgeQueue::Edge> edge = chooseEdge();
  if (!edge) {
    return tree_.hasOpen() ? Growth::kNothing : Growth::kExhausted;
  }
  return growAndConnect(edge->node, edge->push);
}

ExpRrt::Growth ExpRrt::growToSample(const Pose2& pose) {
  const int node = selectOpen(pose);
  if (node < 0) {
    return Growth::kExhausted;
  }
  const int push = isReachable(node) ? chooseCase(node, pose) : -1;
  return push < 0 ? Growth::kNothing : growAndConnect(node, push);
}

ExpRrt::Growth ExpRrt::growAndConnect(int node, int push) {
  int added = -1;
  const Growth growth = extend(node, push, &added);
  return growth == Growth::kNothing && added >= 0 ? connect(added) : growth;
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
    if (!isHopeless(set_->time.lowerBound(from_start), pose.position())) {
      break;
    }
  }
  return {pose, false};
}

// Alg. 1, line 6: MOSTSIMILAR; with a solution cost-aware.
int ExpRrt::selectOpen(const Pose2& target) {
  while (tree_.hasOpen()) {
    const int chosen = isImproving() ? selectCheapestNear(target) : tree_.nearestOpen(target);
    const PushNode& node = tree_.node(chosen);
    if (!isHopeless(node.cost_s, node.map_T_object.position())) {
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

int ExpRrt::selectMostSimilar(const Pose2& target) const {
  const double reach_m = (max_m_ - min_m_).norm();
  int best = -1;
  double best_similarity = -1.0;
  double best_distance = kInfinity;
  for (int id = 0; id < tree_.size(); ++id) {
    if (!tree_.isOpen(id)) continue;
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
  must_note_all_ = true;
}

void ExpRrt::addSolutionPath(int node) {
  auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
  ob::State* state = si_->allocState();
  for (const int id : chain(node)) {
    setPose(tree_.node(id).map_T_object, state);
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
    setPose(node.map_T_object, data_states_.back());
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
