#include "clearing_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_set>

#include "pose_cell.h"

namespace casepush {
namespace {

struct Node {
  Pose2 map_T_obstacle;
  int parent;
  int push;
  double cost_s;
};

/// A node where the obstacle is out of the way.
struct Candidate {
  double distance_m;
  double cost_s;
  int node;

  bool operator<(const Candidate& other) const {
    return std::tuple(-distance_m, cost_s, node) <
           std::tuple(-other.distance_m, other.cost_s, other.node);
  }
};

class Expansion {
 public:
  Expansion(const ClearingProblem& problem, const std::function<bool()>& stop)
      : problem_(problem), stop_(stop) {
    nodes_.push_back({problem.map_T_start, -1, -1, 0.0});
    cells_.insert(cell(problem.map_T_start));
  }

  ClearingChain run() {
    ClearingChain chain;
    std::size_t begin = 0;
    while (begin < nodes_.size() && !isFull() && !stop_()) {
      const std::size_t end = nodes_.size();
      for (std::size_t id = begin; id < end && !isFull() && !stop_(); ++id) {
        expand(static_cast<int>(id));
      }
      begin = end;
      if (takeBest(&chain)) break;
    }
    chain.nodes = static_cast<int>(nodes_.size());
    chain.exhausted = !chain.found && !isFull() && !stop_();
    return chain;
  }

 private:
  bool isFull() const { return static_cast<int>(nodes_.size()) >= problem_.max_nodes; }

  std::uint64_t cell(const Pose2& pose) const {
    return poseCell(pose, problem_.spacing_m, problem_.gyration_radius_m);
  }

  void expand(int id) {
    const Node from = nodes_[id];
    const Pose2 object_T_robot = from.map_T_obstacle.inverse() * problem_.map_T_robot;
    for (int push = 0; push < static_cast<int>(problem_.cases.size()); ++push) {
      const PreparedCase& push_case = problem_.cases[push];
      const Pose2 to = from.map_T_obstacle * push_case.start_outcome.mean;
      if (cells_.count(cell(to)) > 0 || !problem_.checker.isSafe(push_case, from.map_T_obstacle) ||
          !problem_.can_approach(from.map_T_obstacle, from.push, push)) {
        continue;
      }
      cells_.insert(cell(to));
      const double step_s = from.push < 0 ? problem_.time.first(object_T_robot, push)
                                          : problem_.time.after(from.push, push);
      nodes_.push_back({to, id, push, from.cost_s + step_s});
      const double way_m = worst(problem_.way_distance_m, from.map_T_obstacle, push_case);
      if (way_m < problem_.needed_m) continue;
      const double others_m = worst(problem_.others_distance_m, from.map_T_obstacle, push_case);
      candidates_.push_back({std::min({way_m, others_m, problem_.wanted_m}), nodes_.back().cost_s,
                             static_cast<int>(nodes_.size()) - 1});
    }
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

  bool takeBest(ClearingChain* chain) {
    if (candidates_.empty()) return false;
    const Candidate best = *std::min_element(candidates_.begin(), candidates_.end());
    chain->found = true;
    chain->cost_s = best.cost_s;
    chain->distance_m = best.distance_m;
    for (int id = best.node; nodes_[id].parent >= 0; id = nodes_[id].parent) {
      chain->pushes.push_back(nodes_[id].push);
    }
    std::reverse(chain->pushes.begin(), chain->pushes.end());
    return true;
  }

  const ClearingProblem& problem_;
  const std::function<bool()>& stop_;
  std::vector<Node> nodes_;
  std::unordered_set<std::uint64_t> cells_;
  std::vector<Candidate> candidates_;
};

}  // namespace

ClearingChain searchClearing(const ClearingProblem& problem, const std::function<bool()>& stop) {
  return Expansion(problem, stop).run();
}

}  // namespace casepush
