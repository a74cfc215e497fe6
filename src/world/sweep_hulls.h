#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "swept_shapes.h"

namespace casepush {

/// Covering shapes of a sweep, ready to tell which poses may touch a cell.
class SweepHulls {
 public:
  /// Some parts of a track's body at some neighbouring poses, all within one convex outline.
  struct Hull {
    Eigen::Vector2d centre_m;  ///< Of a disc around the outline.
    double radius_m;
    std::uint32_t classes;
    int track;
    int first_pose;
    int last_pose;
    std::uint32_t first_edge;
    std::uint32_t end_edge;
    double grown_m;          ///< Around the edges.
    std::vector<int> parts;  ///< Of the track's body.
  };

  /// @param resolution_m  Side of the cells.
  SweepHulls(const std::vector<SweptShape>& covering, double resolution_m);

  /// A square in the frame where the motion starts, its half axes being +-u_m and +-v_m.
  struct Square {
    Eigen::Vector2d centre_m;
    Eigen::Vector2d u_m;
    Eigen::Vector2d v_m;
  };

  /// Indices of the hulls that may touch the cell around a point, whichever way it is turned.
  struct Range {
    const std::uint32_t* first = nullptr;
    const std::uint32_t* last = nullptr;
    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
  };
  Range near(const Eigen::Vector2d& centre_m) const {
    const Eigen::Vector2d at = (centre_m - low_m_) / place_m_;
    if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < columns_ && at.y() < rows_)) return {};
    const int place = static_cast<int>(at.y()) * columns_ + static_cast<int>(at.x());
    return {near_.data() + begins_[place], near_.data() + begins_[place + 1]};
  }

  const Hull& hull(std::uint32_t index) const { return hulls_[index]; }

  /// False only if the hull's outline does not overlap the square.
  bool mayTouch(const Hull& hull, const Square& square) const;

  std::size_t bytes() const;

 private:
  /// The polygon lies where normal . p <= offset_m.
  struct Edge {
    Eigen::Vector2d normal;
    double offset_m;
  };

  void makeGrid(double resolution_m);

  std::vector<Hull> hulls_;
  std::vector<Edge> edges_;
  // Hulls by the places of cells that they may touch.
  double place_m_ = 0.0;  ///< Side of a place.
  Eigen::Vector2d low_m_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> begins_;  ///< Of each place in `near_`; one more at the end.
  std::vector<std::uint32_t> near_;
};

}  // namespace casepush
