#pragma once

#include <cstdint>
#include <vector>

#include "clearance_grid.h"
#include "patience.h"

namespace casepush {

/// Travel of the robot's discs over a clearance grid: cells with enough clearance are free, and it
/// steps to any of the eight neighbours.
class GridSearch {
 public:
  /// @param patience  Once it is over, no more is found. Both outlive this.
  GridSearch(const ClearanceGrid& grid, double min_clearance_m, const Patience& patience)
      : grid_(grid), min_clearance_m_(static_cast<float>(min_clearance_m)), patience_(patience) {}

  bool isFree(int cell) const { return cell >= 0 && grid_.clearance(cell) >= min_clearance_m_; }

  /// Marks all cells that can be reached from a free cell.
  std::vector<std::uint8_t> reachable(int from) const;

  /// Cheapest sequence of cells between two free ones, both included; length counts more where the
  /// clearance is small. Empty if there is none.
  std::vector<int> path(int from, int to) const;

  /// Way points from `start` to `goal` (anywhere in their free cells): the path's corners after
  /// shortcuts that hardly come closer to anything than the path did. Empty if there is no path.
  std::vector<Eigen::Vector2d> travel(const Eigen::Vector2d& start,
                                      const Eigen::Vector2d& goal) const;

 private:
  /// Neighbours of a cell and the lengths of the steps, in cells.
  template <typename Visit>
  void visitNeighbours(int cell, Visit visit) const;
  double costFactor(int cell) const;
  double shortcutClearance(double path_clearance_m) const;
  double octileDistance(int a, int b) const;
  std::vector<Eigen::Vector2d> shortcut(const std::vector<Eigen::Vector2d>& points) const;

  const ClearanceGrid& grid_;
  float min_clearance_m_;
  const Patience& patience_;
};

}  // namespace casepush
