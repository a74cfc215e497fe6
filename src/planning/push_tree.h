#pragma once

#include <cstdint>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/planning/pose_grid.h"
#include "cell_table.h"
#include "pose_cell.h"

namespace casepush {

/// A resting pose of the object in the search tree, and how it came there.
struct PushNode {
  static constexpr int kRoot = -1;

  Pose2 map_T_object;
  int parent = kRoot;   ///< Node that it was pushed from; kRoot for the start.
  int push = -1;        ///< Index of the case that brought it here.
  double cost_s = 0.0;  ///< Expected time since the start.
  double risk = 0.0;    ///< With chance constraints: of the pushes so far, see riskOf().
};

/// The tree of Exp-RRT: nodes, which (node, case) pairs were tried, and which nodes may grow.
///
/// A node is *open* while it has an untried case and no cheaper node stands at (nearly) the same
/// pose; only open nodes are found by queries. Not thread-safe.
class PushTree {
 public:
  /// @param spacing_m  Of two nodes nearer than about this (in the metric) only the cheaper grows.
  PushTree(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double rho_m,
           double spacing_m, int case_count);

  void clear();

  int size() const { return static_cast<int>(nodes_.size()); }
  const PushNode& node(int id) const { return nodes_[id].node; }
  bool isOpen(int id) const { return nodes_[id].state == State::kOpen; }
  bool isRemoved(int id) const { return nodes_[id].state == State::kRemoved; }

  /// Adds a node unless another one that costs no more stands at the same pose; -1 if so.
  /// @param grows  False for a node that is never to be extended, e.g. in the goal: always added.
  int add(const PushNode& node, bool grows);

  /// Of all poses in a cell only the cheapest node grows. Yaw in (-pi, pi].
  std::uint64_t cell(const Eigen::Vector2d& position_m, double yaw_rad) const {
    return cellNumber(position_m.x() * cells_per_m_, position_m.y() * cells_per_m_,
                      yaw_rad * cells_per_rad_);
  }
  /// Would a node that grows be turned down by add()?
  bool isCovered(std::uint64_t cell, double cost_s) const {
    const CellTable::Entry* const entry = cheapest_.find(cell);
    return entry != nullptr && entry->cost_s <= static_cast<float>(cost_s);
  }

  /// Tells the processor that a node will soon be looked at.
  void fetch(int id) const {
    __builtin_prefetch(&nodes_[id]);
    __builtin_prefetch(&cases_[wordOf(id, 0)]);
  }
  /// Tells the processor that isCovered() will soon be asked.
  void fetchCoverage(std::uint64_t cell) const { cheapest_.fetch(cell); }

  bool isTried(int id, int push) const {
    return (cases_[wordOf(id, push)].untried >> (push % kBits) & 1) == 0;
  }
  /// Visits the cases that have not been tried from a node, in order.
  template <typename Visit>
  void visitUntried(int id, const Visit& visit) const {
    for (int first = 0; first < case_count_; first += kBits) {
      for (std::uint64_t left = cases_[wordOf(id, first)].untried; left != 0; left &= left - 1) {
        visit(first + __builtin_ctzll(left));
      }
    }
  }
  /// Notes that a case has been tried from a node; the last one closes the node.
  void markTried(int id, int push);
  /// As markTried, but forgotten by removeSubtree: what was turned down for its cost.
  void markPostponed(int id, int push);

  /// Takes a node out of the search until the next removeSubtree.
  void close(int id);

  /// Removes a node from which nothing was pushed, at once; what was turned down stays so.
  void removeLeaf(int id);

  /// Removes a node and all below it. What was turned down in favour of them gets a new chance.
  void removeSubtree(int id);

  /// The nearest open node, or -1; of equally near ones the one with the lowest id.
  int nearestOpen(const Pose2& pose) const;

  const PoseGrid& open() const { return open_; }
  bool hasOpen() const { return !open_.empty(); }

 private:
  enum class State : std::uint8_t { kOpen, kClosed, kRemoved };

  /// All that is asked for together lies together, in one line of the processor's cache.
  struct alignas(64) Entry {
    PushNode node;
    int untried = 0;
    State state = State::kClosed;
    bool grows = false;
  };

  static constexpr int kBits = 64;

  /// Of kBits cases.
  struct Word {
    std::uint64_t untried = ~std::uint64_t{0};
    std::uint64_t postponed = 0;
  };

  std::uint64_t cell(const Pose2& pose) const { return cell(pose.position(), pose.yaw()); }
  std::size_t wordOf(int id, int push) const {
    return static_cast<std::size_t>(id) * words_ + push / kBits;
  }
  void openNode(int id);
  void reopenAll();

  double rho_m_;
  double cells_per_m_;
  double cells_per_rad_;
  int case_count_;
  int words_;  // for the bits of all cases
  std::vector<Entry> nodes_;
  std::vector<Word> cases_;  // words_ for each node
  CellTable cheapest_;
  PoseGrid open_;
};

}  // namespace casepush
