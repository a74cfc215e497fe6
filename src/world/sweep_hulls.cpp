#include "sweep_hulls.h"

#include <cmath>

namespace casepush {

SweepHulls::SweepHulls(const std::vector<SweptShape>& covering) {
  hulls_.reserve(covering.size());
  for (const SweptShape& shape : covering) {
    const Shadow& shadow = shape.shadow;
    const BoundingDisc disc = boundingDisc(shadow);
    const auto first_edge = static_cast<std::uint32_t>(edges_.size());
    for (int i = 0; i < shadow.count && shadow.count > 1; ++i) {
      const Eigen::Vector2d& from = shadow.points[i];
      const Eigen::Vector2d along = shadow.points[i + 1 == shadow.count ? 0 : i + 1] - from;
      const Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()).normalized();
      edges_.push_back({normal, normal.dot(from)});
    }
    hulls_.push_back({disc.centre_m, disc.radius_m, shape.classes, shape.track, shape.first_pose,
                      shape.last_pose, first_edge, static_cast<std::uint32_t>(edges_.size()),
                      shadow.radius_m, shape.parts});
  }
}

bool SweepHulls::mayTouch(const Hull& hull, const Eigen::Vector2d& centre_m,
                          const Eigen::Vector2d& u_m, const Eigen::Vector2d& v_m) const {
  const double discs_m = hull.radius_m + (u_m + v_m).norm();
  if ((hull.centre_m - centre_m).squaredNorm() > discs_m * discs_m) return false;
  for (std::uint32_t i = hull.first_edge; i < hull.end_edge; ++i) {
    const Edge& edge = edges_[i];
    const double reach_m = std::abs(edge.normal.dot(u_m)) + std::abs(edge.normal.dot(v_m));
    if (edge.normal.dot(centre_m) - edge.offset_m > hull.grown_m + reach_m) return false;
  }
  return true;
}

}  // namespace casepush
