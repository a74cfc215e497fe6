#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

#include "chain_search.h"
#include "origin_distance.h"

namespace casepush {
namespace {

/// A pose that was reached and whose pushes are all safe.
struct Node {
  Pose2 map_T_object;
  int parent;
  int push;
  double cost_s;
};

/// An edge that was not looked at yet.
struct Edge {
  double priority_s;
  double cost_s;
  int parent;
  int push;

  bool operator>(const Edge& other) const {
    return std::tie(priority_s, cost_s, parent, push) >
           std::tie(other.priority_s, other.cost_s, other.parent, other.push);
  }
};

/// One weighted A* search, its edges checked when their turn comes (lazy weighted A*, Cohen et al.
/// 2014): most never come up.
class Lattice {
 public:
  using Ban = std::function<bool(const Pose2&, int, int)>;

  Lattice(const ChainProblem& problem, const LatticeOptions& options, const OriginDistance& map,
          double weight, const Ban& is_banned)
      : problem_(problem), options_(options), map_(map), weight_(weight), is_banned_(is_banned) {}

  ChainResult search(const std::function<bool()>& stop) {
    ChainResult result;
    const int start = settle({problem_.map_T_start, -1, -1, 0.0});
    int goal = problem_.tolerance.isMet(problem_.map_T_goal, problem_.map_T_start) ? start : -1;
    if (goal < 0) expand(start);
    while (goal < 0 && !open_.empty() && static_cast<int>(nodes_.size()) < problem_.max_nodes &&
           !stop()) {
      const Edge edge = open_.top();
      open_.pop();
      const int added = follow(edge);
      if (added < 0) continue;
      if (problem_.tolerance.isMet(problem_.map_T_goal, nodes_[added].map_T_object)) {
        goal = added;
      } else {
        expand(added);
      }
    }
    result.nodes = static_cast<int>(nodes_.size());
    result.exhausted = goal < 0 && open_.empty();
    if (goal < 0) return result;
    result.found = true;
    result.cost_s = nodes_[goal].cost_s;
    result.bound = weight_;
    for (int id = goal; nodes_[id].parent >= 0; id = nodes_[id].parent) {
      result.pushes.push_back(nodes_[id].push);
    }
    std::reverse(result.pushes.begin(), result.pushes.end());
    return result;
  }

 private:
  std::uint64_t cell(const Pose2& pose) const {
    constexpr std::int64_t kOffset = 1 << 20;  // Maps indices of either sign into 21 bits.
    const auto index = [](double value) {
      return static_cast<std::uint64_t>(std::llround(value) + kOffset) & 0x1fffff;
    };
    return index(pose.x() / options_.cell_m) << 42 | index(pose.y() / options_.cell_m) << 21 |
           index(pose.yaw() * problem_.gyration_radius_m / options_.cell_m);
  }

  double remaining(const Pose2& pose) const {
    const double straight_m = distance(pose, problem_.map_T_goal) - problem_.tolerance.position_m;
    return problem_.time.lowerBound(std::max(straight_m, map_.at(pose.position())));
  }

  // -1 if something as cheap stands in the cell already.
  int settle(const Node& node) {
    const auto [entry, is_new] = settled_.try_emplace(cell(node.map_T_object), node.cost_s);
    if (!is_new && entry->second <= node.cost_s) return -1;
    entry->second = node.cost_s;
    nodes_.push_back(node);
    return static_cast<int>(nodes_.size()) - 1;
  }

  int follow(const Edge& edge) {
    const Pose2 from = nodes_[edge.parent].map_T_object;
    const PreparedCase& push_case = problem_.cases[edge.push];
    const Pose2 to = from * push_case.start_outcome.mean;
    const auto settled = settled_.find(cell(to));
    if (settled != settled_.end() && settled->second <= edge.cost_s) return -1;
    if (is_banned_(from, nodes_[edge.parent].push, edge.push) ||
        !problem_.checker.isSafe(push_case, from)) {
      return -1;
    }
    return settle({to, edge.parent, edge.push, edge.cost_s});
  }

  void expand(int id) {
    const Node node = nodes_[id];
    const Pose2 object_T_robot = node.map_T_object.inverse() * problem_.map_T_robot;
    for (int push = 0; push < static_cast<int>(problem_.cases.size()); ++push) {
      const double step_s = node.push < 0 ? problem_.time.first(object_T_robot, push)
                                          : problem_.time.after(node.push, push);
      const Pose2 to = node.map_T_object * problem_.cases[push].start_outcome.mean;
      const double remaining_s = remaining(to);
      if (!std::isfinite(remaining_s)) continue;
      const double cost_s = node.cost_s + step_s;
      open_.push({cost_s + weight_ * remaining_s, cost_s, id, push});
    }
  }

  const ChainProblem& problem_;
  const LatticeOptions& options_;
  const OriginDistance& map_;
  double weight_;
  const Ban& is_banned_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, double> settled_;  // cost of the cheapest in each cell
  std::priority_queue<Edge, std::vector<Edge>, std::greater<>> open_;
};

}  // namespace

ChainResult searchLattice(const ChainProblem& problem, const LatticeOptions& options,
                          const OriginDistance& map,
                          const std::function<bool(const Pose2&, int, int)>& is_banned,
                          const std::function<bool()>& stop) {
  ChainResult best;
  int nodes = 0;
  for (const double weight : options.weights) {
    Lattice lattice(problem, options, map, weight, is_banned);
    const ChainResult result = lattice.search(stop);
    nodes += result.nodes;
    const bool is_better = result.found && (!best.found || result.cost_s <= best.cost_s);
    if (is_better || !best.found) best = result;
    if (best.found && result.found) best.bound = std::min(best.bound, weight);
    if (!result.found || stop()) break;
  }
  best.nodes = nodes;
  return best;
}

}  // namespace casepush
