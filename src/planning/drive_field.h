#pragma once

#include <Eigen/Core>
#include <vector>

#include "clearance_grid.h"

namespace casepush {

/// How far the robot has to drive between one place and any other, around all that stands.
class DriveField {
 public:
  /// @param grid   With all that stands.
  /// @param place  Where the ways begin [m]. Beside an object they lead through the nearest cells
  ///   where the robot can travel.
  DriveField(ClearanceGrid grid, double min_clearance_m, const Eigen::Vector2d& place);

  /// Length of the shortest way over the grid's cells [m]; infinity if there is none.
  double lengthTo(const Eigen::Vector2d& place) const;

 private:
  /// A cell near a place, and how far that is.
  struct End {
    int cell;
    double length_m;
  };

  bool isFree(int cell) const;
  std::vector<End> endsAt(const Eigen::Vector2d& place) const;

  ClearanceGrid grid_;
  float min_clearance_m_;
  std::vector<int> distance_;
};

}  // namespace casepush
