// EXTEND of paper algorithm 1: which pair of node and case is tried next, and what comes of it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exp_rrt.h"

namespace casepush {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostTests = 6;       // Of a node's cases for one random sample.
constexpr std::size_t kCheck = 64;  // A push takes so many times as long to check as to look at,
constexpr std::size_t kMask = 256;  // and to check for the first time.

/// Visits the items in ascending order until `visit` says that it is enough; false if it never
/// does. Spoils them.
template <typename Visit>
bool visitAscending(std::vector<std::pair<double, int>>* items, const Visit& visit) {
  constexpr std::size_t kFew = 32;  // So few are looked through faster than a heap is made.
  const bool is_heap = items->size() > kFew;
  if (is_heap) std::make_heap(items->begin(), items->end(), std::greater<>());
  while (!items->empty()) {
    const auto least = is_heap ? items->begin() : std::min_element(items->begin(), items->end());
    if (visit(least->first, least->second)) return true;
    if (is_heap) {
      std::pop_heap(items->begin(), items->end(), std::greater<>());
    } else {
      *least = items->back();
    }
    items->pop_back();
  }
  return false;
}

}  // namespace

// Even a single extension takes long if there are thousands of cases.
bool ExpRrt::mustStop(std::size_t work) {
  constexpr std::size_t kUnasked = 4096;
  work_ += work;
  if (work_ < kUnasked) {
    return false;
  }
  work_ = 0;
  return (*stop_)();
}

// No chain needs less time from there.
double ExpRrt::remaining(const Eigen::Vector2d& position_m) const {
  const double straight_m = (position_m - goal_->pose().position()).norm();
  return set_->time.lowerBound(straight_m - goal_->tolerance().position_m);
}

bool ExpRrt::isHopeless(double cost_s, const Eigen::Vector2d& position_m) const {
  return isImproving() && cost_s + remaining(position_m) >= best_cost_s_;
}

bool ExpRrt::isInGoal(const Eigen::Vector2d& position_m, double yaw_rad) const {
  const double reach_m = 1.001 * goal_->tolerance().position_m;
  return (position_m - goal_->pose().position()).squaredNorm() <= reach_m * reach_m &&
         goal_->tolerance().isMet(goal_->pose(), {position_m.x(), position_m.y(), yaw_rad});
}

GoalGuide::Way ExpRrt::wayToGoal(const Eigen::Vector2d& position_m, bool exactly) const {
  if (guide_ == nullptr) return {(position_m - goal_->pose().position()).norm(), true};
  if (exactly) return {guide_->at(position_m), true};
  return guide_->atLeast(position_m);
}

// What a push promises. What is left is the way by the guide, in the metric of the tree.
EdgeQueue::Push ExpRrt::weigh(const Outlook& outlook, bool exactly) const {
  const GoalGuide::Way way = wayToGoal(outlook.end_m, exactly);
  const double turn_m =
      options_.gyration_radius_m * wrapTurn(outlook.end_yaw_rad - goal_->pose().yaw());
  const double left_s = set_->time.lowerBound(
      std::sqrt(way.length_m * way.length_m + turn_m * turn_m) - goal_->tolerance().position_m);
  const double greed = isImproving() ? options_.improving_greed : options_.greed;
  return {static_cast<float>(outlook.cost_s + greed * left_s), outlook.push, !way.is_exact};
}

ExpRrt::Outlook ExpRrt::outlook(int node, int push, const PushStart& start) const {
  const Pose2& moved = set_->outcomes[push];
  Outlook outlook{start.positionOf(moved), start.yawOf(moved), 0.0, 0, push};
  outlook.cost_s = tree_.node(node).cost_s + pushCost(node, push);
  outlook.cell = tree_.cell(outlook.end_m, outlook.end_yaw_rad);
  return outlook;
}

// All that may be worth while is queued at once: no node is weighed again and again.
void ExpRrt::noteEdges(int node) {
  if (mustStop(set_->cases.size())) {
    must_note_all_ = true;
    return;
  }
  const PushStart start(tree_.node(node).map_T_object);
  outlooks_.clear();
  tree_.visitUntried(node, [&](int push) {
    outlooks_.push_back(outlook(node, push, start));
    tree_.fetchCoverage(outlooks_.back().cell);
  });
  noted_.clear();
  for (const Outlook& each : outlooks_) {
    if (!isPointless(node, each)) noted_.push_back(weigh(each, false));
  }
  edges_.add(node, noted_);
}

// A push to where the object gets in less time, or that cannot be part of a quicker plan, counts as
// tried. That is found out much faster than collisions.
bool ExpRrt::isPointless(int node, const Outlook& outlook) {
  const bool is_pointless =
      isHopeless(outlook.cost_s, outlook.end_m) || (tree_.isCovered(outlook.cell, outlook.cost_s) &&
                                                    !isInGoal(outlook.end_m, outlook.end_yaw_rad));
  if (is_pointless) tree_.markPostponed(node, outlook.push);
  return is_pointless;
}

// The most promising pair of node and case that is safe.
std::optional<EdgeQueue::Edge> ExpRrt::chooseEdge() {
  while (!edges_.empty() && !mustStop(kCheck)) {
    if (!tree_.isOpen(edges_.nextNode())) {
      edges_.dropFirst();
      continue;
    }
    const EdgeQueue::Edge edge = edges_.first();
    if (edge.push == EdgeQueue::kMore) {
      edges_.dropFirst();
      noteEdges(edge.node);
      continue;
    }
    const std::optional<Outlook> looked = lookAgain(edge);
    if (looked && edge.is_rough) {
      edges_.refineFirst(weigh(*looked, true).key_s);
      continue;
    }
    edges_.pop();
    if (!edges_.empty()) tree_.fetch(edges_.nextNode());
    if (looked && isReachable(edge.node) && isSafe(edge.node, edge.push)) return edge;
  }
  return std::nullopt;
}

// Nothing if the edge is no longer worth trying.
std::optional<ExpRrt::Outlook> ExpRrt::lookAgain(const EdgeQueue::Edge& edge) {
  if (tree_.isTried(edge.node, edge.push)) return std::nullopt;
  const PushStart start(tree_.node(edge.node).map_T_object);
  const Outlook looked = outlook(edge.node, edge.push, start);
  return isPointless(edge.node, looked) ? std::nullopt : std::make_optional(looked);
}

// Asked before anything is pushed on from a node: most nodes of a tree never come so far.
bool ExpRrt::isReachable(int node) {
  if (is_approached_[node]) {
    return true;
  }
  const PushNode& pushed = tree_.node(node);
  const PushNode& from = tree_.node(pushed.parent);
  const PreparedCase* previous = from.parent == PushNode::kRoot ? nullptr : &set_->cases[from.push];
  if (can_approach_ && !can_approach_(from.map_T_object, previous, set_->cases[pushed.push])) {
    tree_.removeLeaf(node);
    return false;
  }
  is_approached_[node] = true;
  return true;
}

bool ExpRrt::isSafeByChance(int node, int push) {
  const Pose2 end = tree_.node(node).map_T_object * set_->outcomes[push];
  const auto node_at = [this](int id) -> const PushNode& { return tree_.node(id); };
  const std::optional<PushChance> chance = options_.chance->judge(node_at, node, push, end);
  if (!chance) {
    tree_.markTried(node, push);
    return false;
  }
  last_chance_ = *chance;
  return true;
}

// Alg. 1, COLLIDING. A push that is not safe counts as tried.
bool ExpRrt::isSafe(int node, int push) {
  if (options_.chance != nullptr) {
    return isSafeByChance(node, push);
  }
  const bool is_safe = checker_->isSafe(set_->cases[push], tree_.node(node).map_T_object);
  if (!is_safe) {
    tree_.markTried(node, push);
  }
  return is_safe;
}

// Alg. 1, EXTEND: the same answer as checking all cases first, with a fraction of the checks.
int ExpRrt::chooseCase(int node, const Pose2& target) {
  const PushStart start(tree_.node(node).map_T_object);
  order_.clear();
  tree_.visitUntried(node, [&](int push) {
    const Pose2 outcome = start * set_->outcomes[push];
    const double d2 = squaredPoseDistance(outcome, target, options_.gyration_radius_m);
    order_.emplace_back(d2, push);
  });
  // Mostly one of the first few is safe. Where none is, another sample goes on.
  int tests = 0;
  int chosen = -1;
  visitAscending(&order_, [&](double, int push) {
    if (tests >= kMostTests || mustStop(kCheck)) return true;
    if (isPointless(node, outlook(node, push, start))) return false;
    if (isSafe(node, push)) chosen = push;
    ++tests;
    return chosen >= 0;
  });
  return chosen;
}

int ExpRrt::chooseCaseChecked(int node, const Pose2& target) {
  const double reach_m = (max_m_ - min_m_).norm();
  const Pose2& pose = tree_.node(node).map_T_object;
  int best = -1;
  std::pair<double, double> best_key{-1.0, 0.0};
  for (int push = 0; push < static_cast<int>(set_->cases.size()); ++push) {
    if (mustStop(kMask)) {
      return -1;
    }
    if (tree_.isTried(node, push) || !isSafe(node, push)) {
      continue;
    }
    const Pose2 outcome = pose * set_->outcomes[push];
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
  const double time_s =
      previous < 0 ? set_->time.first(object_T_robot_, push) : set_->time.after(previous, push);
  return options_.chance != nullptr ? time_s + options_.chance->driftS(push) : time_s;
}

double ExpRrt::chainCost(int node, const CaseChain& chain) const {
  double cost_s = pushCost(node, chain.pushes.front());
  for (int i = 1; options_.chance != nullptr && i < chain.count; ++i) {
    cost_s += options_.chance->driftS(chain.pushes[i]);
  }
  return cost_s;
}

// @pre The push is the last one that isSafe() was asked for and found safe, and the robot can get
// to those before it.
ExpRrt::Growth ExpRrt::extend(int node, int push, int* added) {
  PushNode child;
  child.map_T_object = tree_.node(node).map_T_object * set_->outcomes[push];
  child.parent = node;
  child.push = push;
  child.cost_s = tree_.node(node).cost_s + pushCost(node, push);
  if (options_.chance != nullptr) {
    child.cost_s += last_chance_.recovery_s;
    child.risk = tree_.node(node).risk + last_chance_.risk;
  }
  const Eigen::Vector2d end_m = child.map_T_object.position();
  const bool is_goal = isInGoal(end_m, child.map_T_object.yaw());
  const int id = isHopeless(child.cost_s, end_m) ? -1 : tree_.add(child, !is_goal);
  if (id < 0) {
    tree_.markPostponed(node, push);
    return Growth::kNothing;
  }
  is_approached_.resize(tree_.size(), false);
  tree_.markTried(node, push);
  if (!is_goal) {
    if (options_.similarity == Similarity::kMetric) {
      noteEdges(id);
    }
    if (added != nullptr) {
      *added = id;
    }
    return Growth::kNothing;
  }
  return isReachable(id) ? addSolution(id) : Growth::kNothing;
}

ExpRrt::Growth ExpRrt::addSolution(int node) {
  // Improving weighs edges differently: all are noted again if it comes to that.
  must_note_all_ = must_note_all_ || solutions_.empty();
  const auto cheaper = [this](int a, int b) { return tree_.node(a).cost_s < tree_.node(b).cost_s; };
  solutions_.insert(std::upper_bound(solutions_.begin(), solutions_.end(), node, cheaper), node);
  best_cost_s_ = tree_.node(solutions_.front()).cost_s;
  return Growth::kSolution;
}

void ExpRrt::noteAllEdges() {
  must_note_all_ = false;
  edges_.clear();
  for (int id = 0; id < tree_.size() && !must_note_all_; ++id) {
    if (tree_.isOpen(id)) noteEdges(id);
  }
}

// Tries the chains that end in the goal region from here, the quickest first.
ExpRrt::Growth ExpRrt::connect(int node) {
  constexpr std::size_t kMostTries = 32;
  if (options_.similarity == Similarity::kPaper) {
    return Growth::kNothing;
  }
  const Pose2 start_T_goal = tree_.node(node).map_T_object.inverse() * goal_->pose();
  const double reach_m = set_->chains.reach() + goal_->tolerance().position_m;
  if (start_T_goal.position().squaredNorm() > reach_m * reach_m) {
    return Growth::kNothing;
  }
  endings_.clear();
  set_->chains.into(start_T_goal, goal_->tolerance(), &endings_);
  order_.clear();
  for (std::size_t i = 0; i < endings_.size(); ++i) {
    const int first = endings_[i]->pushes.front();
    const double cost_s =
        tree_.node(node).cost_s + chainCost(node, *endings_[i]) + endings_[i]->later_s;
    if (cost_s < best_cost_s_ && !tree_.isTried(node, first)) {
      order_.emplace_back(cost_s, static_cast<int>(i));
    }
  }
  const std::size_t tries = std::min(order_.size(), kMostTries);
  std::partial_sort(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(tries),
                    order_.end());
  for (std::size_t i = 0; i < tries; ++i) {
    if (!isReachable(node)) {
      break;
    }
    if (follow(node, *endings_[order_[i].second]) == Growth::kSolution) {
      return Growth::kSolution;
    }
  }
  return Growth::kNothing;
}

ExpRrt::Growth ExpRrt::follow(int node, const CaseChain& chain) {
  int at = node;
  for (int i = 0; i < chain.count; ++i) {
    const int push = chain.pushes[i];
    const PushStart start(tree_.node(at).map_T_object);
    if (tree_.isTried(at, push) || isPointless(at, outlook(at, push, start)) || !isSafe(at, push)) {
      break;
    }
    ++extension_count_;
    int added = -1;
    if (extend(at, push, &added) == Growth::kSolution) {
      return Growth::kSolution;
    }
    if (added < 0 || !isReachable(added)) {
      break;
    }
    at = added;
  }
  return Growth::kNothing;
}

}  // namespace casepush
