#include "clearing_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "pose_cell.h"

namespace casepush {
namespace {

// So many times as long as the quickest chain takes, others may take that end farther off.
constexpr double kWorthIt = 1.25;

struct Node {
  Pose2 map_T_obstacle;
  int parent;
  int push;
  double cost_s;
};

/// A push that was not looked at yet, or only its time.
struct Open {
  double cost_s;
  bool is_estimate;
  int parent;
  int push;

  bool operator>(const Open& other) const {
    return std::tie(cost_s, parent, push) > std::tie(other.cost_s, other.parent, other.push);
  }
};

/// A node where the obstacle is out of the way.
struct Candidate {
  double distance_m;
  double back_s;
  double whole_s;
  int node;

  bool operator<(const Candidate& other) const {
    return std::tuple(-distance_m, whole_s, node) <
           std::tuple(-other.distance_m, other.whole_s, other.node);
  }
};

class Expansion {
 public:
  Expansion(const ClearingProblem& problem, const std::function<bool()>& stop)
      : problem_(problem), stop_(stop) {
    nodes_.push_back({problem.map_T_start, -1, -1, 0.0});
    cells_.insert(cell(problem.map_T_start));
    open(0);
  }

  ClearingChain run() {
    while (!open_.empty() && !isFull() && !stop_()) {
      const Open next = open_.top();
      if (next.cost_s > kWorthIt * quickest_s_) break;
      open_.pop();
      push(next);
    }
    ClearingChain chain;
    takeBest(&chain);
    chain.nodes = static_cast<int>(nodes_.size());
    chain.exhausted = !chain.found && open_.empty();
    return chain;
  }

 private:
  bool isFull() const { return static_cast<int>(nodes_.size()) >= problem_.max_nodes; }

  std::uint64_t cell(const Pose2& pose) const {
    return poseCell(pose, problem_.spacing_m, problem_.gyration_radius_m);
  }

  void open(int id) {
    const Node& from = nodes_[id];
    const Pose2 object_T_robot = from.map_T_obstacle.inverse() * problem_.map_T_robot;
    for (int next = 0; next < static_cast<int>(problem_.cases.size()); ++next) {
      const double step_s = from.push < 0 ? problem_.time.first(object_T_robot, next)
                                          : problem_.time.after(from.push, next);
      open_.push({from.cost_s + step_s, true, id, next});
    }
  }

  void push(Open next) {
    const Node from = nodes_[next.parent];
    const PreparedCase& push_case = problem_.cases[next.push];
    const Pose2 to = from.map_T_obstacle * push_case.start_outcome.mean;
    if (cells_.count(cell(to)) > 0) return;
    if (next.is_estimate) {
      if (!problem_.checker.isSafe(push_case, from.map_T_obstacle)) return;
      const double cost_s =
          from.cost_s + problem_.push_s(from.map_T_obstacle, from.push, next.push);
      if (std::isinf(cost_s)) return;
      if (cost_s > next.cost_s) {
        open_.push({cost_s, false, next.parent, next.push});
        return;
      }
    }
    cells_.insert(cell(to));
    const int id = static_cast<int>(nodes_.size());
    nodes_.push_back({to, next.parent, next.push, next.cost_s});
    judge(id, from.map_T_obstacle, push_case);
    open(id);
  }

  void judge(int id, const Pose2& from, const PreparedCase& push_case) {
    const double way_m = worst(problem_.way_distance_m, from, push_case);
    if (way_m < problem_.needed_m) return;
    const double others_m = worst(problem_.others_distance_m, from, push_case);
    const double back_s = problem_.back_s(nodes_[id].map_T_obstacle * push_case.outcome_T_robot);
    const double whole_s = nodes_[id].cost_s + back_s;
    quickest_s_ = std::min(quickest_s_, whole_s);
    candidates_.push_back({std::min({way_m, others_m, problem_.wanted_m}), back_s, whole_s, id});
  }

  /// At the mean outcome and its sigma points; exact only as far as it is needed at all.
  double worst(const std::function<double(const Pose2&)>& distance, const Pose2& from,
               const PreparedCase& push_case) const {
    double worst_m = distance(from * push_case.start_outcome.mean);
    for (const Pose2& sigma : push_case.start_T_sigma) {
      if (worst_m < problem_.needed_m) break;
      worst_m = std::min(worst_m, distance(from * sigma));
    }
    return worst_m;
  }

  void takeBest(ClearingChain* chain) {
    const Candidate* best = nullptr;
    for (const Candidate& each : candidates_) {
      if (each.whole_s <= kWorthIt * quickest_s_ && (best == nullptr || each < *best)) best = &each;
    }
    if (best == nullptr) return;
    chain->found = true;
    chain->cost_s = nodes_[best->node].cost_s;
    chain->back_s = best->back_s;
    chain->distance_m = best->distance_m;
    for (int id = best->node; nodes_[id].parent >= 0; id = nodes_[id].parent) {
      chain->pushes.push_back(nodes_[id].push);
    }
    std::reverse(chain->pushes.begin(), chain->pushes.end());
  }

  const ClearingProblem& problem_;
  const std::function<bool()>& stop_;
  std::vector<Node> nodes_;
  std::unordered_set<std::uint64_t> cells_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  std::vector<Candidate> candidates_;
  double quickest_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace

ClearingChain searchClearing(const ClearingProblem& problem, const std::function<bool()>& stop) {
  return Expansion(problem, stop).run();
}

}  // namespace casepush
