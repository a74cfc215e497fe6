#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "chain_search.h"
#include "disposal.h"
#include "origin_distance.h"
#include "paged_heap.h"
#include "patience.h"
#include "pose_cell.h"

namespace casepush {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// For Patience.
constexpr std::size_t kHeapSteps = 4;   // Of an entry that is put in order.
constexpr std::size_t kEdgeSteps = 10;  // Of an edge that is weighed.

/// A pose that was reached and whose pushes are all safe.
struct Node {
  Pose2 map_T_object;
  int parent;
  int push;
  double cost_s;
  double risk;  ///< Of the pushes so far, see riskOf().
};

/// A node to be expanded, or an edge that was not looked at yet.
struct Entry {
  double priority_s;
  double cost_s;       ///< Of an edge without its risk: a lower bound.
  double remaining_s;  ///< From its end, at least.
  int node;            ///< -1: an edge.
  int parent;
  int push;

  bool operator>(const Entry& other) const {
    return std::tie(priority_s, cost_s, node, parent, push) >
           std::tie(other.priority_s, other.cost_s, other.node, other.parent, other.push);
  }
};

class Lattice {
 public:
  using Ban = std::function<bool(const Pose2&, int, int)>;

  Lattice(const ChainProblem& problem, const LatticeOptions& options, const OriginDistance& map,
          const Ban& is_banned)
      : problem_(problem), options_(options), map_(map), is_banned_(is_banned) {
    for (const PreparedCase& push_case : problem.cases) {
      const double turn_rad = std::abs(push_case.start_outcome.mean.yaw());
      const double least_s = problem.handling_s + push_case.duration_s;
      best_turn_rate_rps_ = std::max(best_turn_rate_rps_, turn_rad / least_s);
    }
    add({problem.map_T_start, -1, -1, 0.0, 0.0});
  }

  /// Searches on with a smaller weight. False once `stop` says so or the nodes are used up.
  bool improve(double weight, const std::function<bool()>& stop) {
    if (!startRound(weight, stop)) return false;
    while (!open_.empty() && open_.top().priority_s < bestCost()) {
      if (static_cast<int>(nodes_.size()) >= problem_.max_nodes || stop()) return false;
      const Entry entry = open_.pop();
      if (entry.cost_s + entry.remaining_s >= bestCost()) continue;
      if (entry.node >= 0) {
        expand(entry, stop);
      } else {
        follow(entry);
      }
    }
    return true;
  }

  ChainResult result() const {
    ChainResult result;
    result.nodes = static_cast<int>(nodes_.size());
    result.found = goal_ >= 0;
    result.exhausted = !result.found && open_.empty() && postponed_.empty();
    if (!result.found) return result;
    result.cost_s = bestCost();
    result.bound = provenBound();
    for (int id = goal_; nodes_[id].parent >= 0; id = nodes_[id].parent) {
      result.pushes.push_back(nodes_[id].push);
    }
    std::reverse(result.pushes.begin(), result.pushes.end());
    return result;
  }

 private:
  struct Cell {
    int node = -1;         ///< The cheapest that reached it.
    int expanded_in = -1;  ///< Round in which one of its nodes was expanded last.
  };

  std::uint64_t cellOf(const Pose2& pose) const {
    return poseCell(pose, options_.cell_m, problem_.gyration_radius_m);
  }

  double bestCost() const { return goal_ >= 0 ? nodes_[goal_].cost_s : kInfinity; }

  static double leastOf(const Entry& entry) { return entry.cost_s + entry.remaining_s; }

  // Whatever is cheaper than the best chain passes through something that still waits, and through
  // something that waited when the round began.
  double provenBound() const {
    constexpr std::size_t kMost = 500000;  // To be looked at once the time is over.
    double least_s = std::min(bestCost(), least_s_);
    if (open_.size() <= kMost) {
      least_s = bestCost();
      for (std::size_t i = 0; i < open_.size(); ++i) least_s = std::min(least_s, leastOf(open_[i]));
      for (const Entry& entry : postponed_) least_s = std::min(least_s, leastOf(entry));
    }
    return least_s > 0.0 ? bestCost() / least_s : 1.0;
  }

  // Never more than it takes: over the shortest way by the fastest case, and for what is left to
  // turn by the one that turns fastest.
  double remaining(const Pose2& pose) const {
    const double straight_m = distance(pose, problem_.map_T_goal) - problem_.tolerance.position_m;
    const double way_s = problem_.time.lowerBound(std::max(straight_m, map_.at(pose.position())));
    const double turn_rad =
        std::abs(yawDifference(pose, problem_.map_T_goal)) - problem_.tolerance.yaw_rad;
    if (turn_rad <= 0.0) return way_s;
    return std::max(way_s, best_turn_rate_rps_ > 0.0 ? turn_rad / best_turn_rate_rps_ : kInfinity);
  }

  // False if it was stopped: then what waits is in no order.
  bool startRound(double weight, const std::function<bool()>& stop) {
    const Patience patience(stop);
    ++round_;
    weight_ = weight;
    for (const Entry& entry : postponed_) open_.append(entry);
    postponed_.clear();
    least_s_ = kInfinity;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      Entry& entry = open_[i];
      least_s_ = std::min(least_s_, leastOf(entry));
      entry.priority_s = entry.cost_s + weight * entry.remaining_s;
      open_.settle(i);
      if (patience.isOverAfter(kHeapSteps)) return false;
    }
    return true;
  }

  void wait(Entry entry) {
    if (!std::isfinite(entry.remaining_s)) return;
    entry.priority_s = entry.cost_s + weight_ * entry.remaining_s;
    open_.push(entry);
  }

  bool isGoal(const Pose2& pose) const {
    return problem_.tolerance.isMet(problem_.map_T_goal, pose);
  }

  void add(const Node& node) {
    const int id = static_cast<int>(nodes_.size());
    if (isGoal(node.map_T_object)) {
      if (node.cost_s >= bestCost()) return;
      nodes_.push_back(node);
      goal_ = id;
      return;
    }
    Cell& cell = cells_[cellOf(node.map_T_object)];
    if (cell.node >= 0 && nodes_[cell.node].cost_s <= node.cost_s) return;
    cell.node = id;
    nodes_.push_back(node);
    const Entry entry{0.0, node.cost_s, remaining(node.map_T_object), id, node.parent, node.push};
    // No cell is expanded twice in a round (INCONS in the paper of ARA*).
    if (cell.expanded_in == round_) {
      postponed_.push_back(entry);
    } else {
      wait(entry);
    }
  }

  // Adds to `node` what its last push risks; false if that is too much.
  bool addRisk(Node* node) {
    const auto node_at = [this](int id) -> const Node& { return nodes_[id]; };
    const std::optional<PushChance> chance =
        problem_.chance->judge(node_at, node->parent, node->push, node->map_T_object);
    if (!chance) return false;
    node->risk += chance->risk;
    node->cost_s += chance->recovery_s;
    return true;
  }

  void follow(const Entry& edge) {
    const Node& parent = nodes_[edge.parent];
    const Pose2 from = parent.map_T_object;
    const PreparedCase& push_case = problem_.cases[edge.push];
    Node node{from * push_case.start_outcome.mean, edge.parent, edge.push, edge.cost_s,
              parent.risk};
    const auto cell = cells_.find(cellOf(node.map_T_object));
    const bool is_late = cell != cells_.end() && cell->second.node >= 0 &&
                         nodes_[cell->second.node].cost_s <= node.cost_s;
    if ((is_late && !isGoal(node.map_T_object)) || is_banned_(from, parent.push, edge.push)) return;
    const bool is_safe =
        problem_.chance != nullptr ? addRisk(&node) : problem_.checker.isSafe(push_case, from);
    if (is_safe) add(node);
  }

  void expand(const Entry& entry, const std::function<bool()>& stop) {
    const Patience patience(stop);
    const int id = entry.node;
    const Node node = nodes_[id];
    Cell& cell = cells_.at(cellOf(node.map_T_object));
    if (cell.node != id) return;  // A cheaper one came.
    cell.expanded_in = round_;
    const Pose2 object_T_robot = node.map_T_object.inverse() * problem_.map_T_robot;
    for (int push = 0; push < static_cast<int>(problem_.cases.size()); ++push) {
      if (patience.isOverAfter(kEdgeSteps)) {
        open_.append(entry);  // The search ends; what is proven must not forget this one.
        return;
      }
      const double step_s = node.push < 0 ? problem_.time.first(object_T_robot, push)
                                          : problem_.time.after(node.push, push);
      const Pose2 to = node.map_T_object * problem_.cases[push].start_outcome.mean;
      const double drift_s = problem_.chance != nullptr ? problem_.chance->driftS(push) : 0.0;
      const double cost_s = node.cost_s + step_s + drift_s;
      const double remaining_s = remaining(to);
      if (cost_s + remaining_s < bestCost()) wait({0.0, cost_s, remaining_s, -1, id, push});
    }
  }

  const ChainProblem& problem_;
  const LatticeOptions& options_;
  const OriginDistance& map_;
  const Ban& is_banned_;
  double best_turn_rate_rps_ = 0.0;
  int round_ = 0;
  double weight_ = 1.0;
  double least_s_ = 0.0;  ///< No chain costs less than this and than the best one.
  int goal_ = -1;         ///< The cheapest node in the goal region.
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, Cell> cells_;
  PagedHeap<Entry> open_;         ///< The least priority first.
  std::vector<Entry> postponed_;  ///< For the next round.
};

}  // namespace

ChainResult searchLattice(const ChainProblem& problem, const LatticeOptions& options,
                          const OriginDistance& map,
                          const std::function<bool(const Pose2&, int, int)>& is_banned,
                          const std::function<bool()>& stop, Disposal* disposal) {
  auto lattice = std::make_shared<Lattice>(problem, options, map, is_banned);
  for (const double weight : options.weights) {
    if (!lattice->improve(weight, stop)) break;
  }
  ChainResult result = lattice->result();
  disposal->take(std::move(lattice));
  return result;
}

}  // namespace casepush
