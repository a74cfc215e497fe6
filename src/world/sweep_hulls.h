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

  explicit SweepHulls(const std::vector<SweptShape>& covering);

  const std::vector<Hull>& all() const { return hulls_; }

  /// False only if the hull does not overlap the square around `centre_m` with the half axes
  /// +-u_m, +-v_m.
  bool mayTouch(const Hull& hull, const Eigen::Vector2d& centre_m, const Eigen::Vector2d& u_m,
                const Eigen::Vector2d& v_m) const;

 private:
  /// The polygon lies where normal . p <= offset_m.
  struct Edge {
    Eigen::Vector2d normal;
    double offset_m;
  };

  std::vector<Hull> hulls_;
  std::vector<Edge> edges_;
};

}  // namespace casepush
