#include "sweep_hulls.h"

#include <algorithm>
#include <cmath>

namespace casepush {
SweepHulls::SweepHulls(const std::vector<SweptShape>& covering, double resolution_m) {
  hulls_.reserve(covering.size());
  for (const SweptShape& shape : covering) {
    Shadow outline;
    outline.count = static_cast<int>(shape.points.size());
    outline.radius_m = shape.radius_m;
    std::copy(shape.points.begin(), shape.points.end(), outline.points.begin());
    const BoundingDisc disc = boundingDisc(outline);
    const auto first_edge = static_cast<std::uint32_t>(edges_.size());
    for (std::size_t i = 0; i < shape.points.size() && shape.points.size() > 1; ++i) {
      const Eigen::Vector2d& from = shape.points[i];
      const Eigen::Vector2d along = shape.points[(i + 1) % shape.points.size()] - from;
      const Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()).normalized();
      edges_.push_back({normal, normal.dot(from)});
    }
    hulls_.push_back({disc.centre_m, disc.radius_m, shape.classes, shape.track, shape.first_pose,
                      shape.last_pose, first_edge, static_cast<std::uint32_t>(edges_.size()),
                      shape.radius_m, shape.parts});
  }
  makeGrid(resolution_m);
}

void SweepHulls::makeGrid(double resolution_m) {
  place_m_ = 2.0 * resolution_m;
  // Whichever way a cell around a point of the place is turned, it lies in a square so large.
  const double half_m = place_m_ / 2.0 + resolution_m * M_SQRT1_2;
  low_m_ = hulls_.front().centre_m;
  Eigen::Vector2d high_m = low_m_;
  for (const Hull& hull : hulls_) {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(hull.radius_m + half_m);
    low_m_ = low_m_.cwiseMin(hull.centre_m - reach);
    high_m = high_m.cwiseMax(hull.centre_m + reach);
  }
  columns_ = static_cast<int>((high_m.x() - low_m_.x()) / place_m_) + 1;
  rows_ = static_cast<int>((high_m.y() - low_m_.y()) / place_m_) + 1;
  std::vector<std::vector<std::uint32_t>> places(static_cast<std::size_t>(columns_) * rows_);
  Square square{{0.0, 0.0}, {half_m, 0.0}, {0.0, half_m}};
  for (std::size_t i = 0; i < hulls_.size(); ++i) {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(hulls_[i].radius_m + half_m);
    const Eigen::Vector2d from = (hulls_[i].centre_m - reach - low_m_) / place_m_;
    const Eigen::Vector2d to = (hulls_[i].centre_m + reach - low_m_) / place_m_;
    for (int y = static_cast<int>(from.y()); y <= std::min(rows_ - 1.0, to.y()); ++y) {
      for (int x = static_cast<int>(from.x()); x <= std::min(columns_ - 1.0, to.x()); ++x) {
        square.centre_m = low_m_ + place_m_ * Eigen::Vector2d(x + 0.5, y + 0.5);
        if (!mayTouch(hulls_[i], square)) continue;
        places[static_cast<std::size_t>(y) * columns_ + x].push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
  begins_.assign(1, 0);
  for (const std::vector<std::uint32_t>& place : places) {
    near_.insert(near_.end(), place.begin(), place.end());
    begins_.push_back(static_cast<std::uint32_t>(near_.size()));
  }
}

std::size_t SweepHulls::bytes() const {
  return hulls_.size() * sizeof(Hull) + edges_.size() * sizeof(Edge) +
         (begins_.size() + near_.size()) * sizeof(std::uint32_t);
}

bool SweepHulls::mayTouch(const Hull& hull, const Square& square) const {
  const Eigen::Vector2d off = hull.centre_m - square.centre_m;
  const double half2_m2 = square.u_m.squaredNorm() + square.v_m.squaredNorm();
  // (a + b)^2 <= 2 (a^2 + b^2), without a root.
  if (off.squaredNorm() > 2.0 * (hull.radius_m * hull.radius_m + half2_m2)) return false;
  for (std::uint32_t i = hull.first_edge; i < hull.end_edge; ++i) {
    const Edge& edge = edges_[i];
    const double reach_m =
        std::abs(edge.normal.dot(square.u_m)) + std::abs(edge.normal.dot(square.v_m));
    if (edge.normal.dot(square.centre_m) - edge.offset_m > hull.grown_m + reach_m) return false;
  }
  return hull.first_edge < hull.end_edge ||
         off.squaredNorm() <= std::pow(hull.radius_m + std::sqrt(half2_m2), 2);
}

}  // namespace casepush
