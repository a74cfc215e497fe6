#include "casepush/world/shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double t = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - t * along).norm();
}

/// Largest gap between the polygons along the outward normals of the edges of `a`.
double largestGap(const Shadow& a, const Shadow& b) {
  double largest = -kInfinity;
  if (a.count < 2) return largest;
  for (int i = 0; i < a.count; ++i) {
    const Eigen::Vector2d& from = a.points[i];
    const Eigen::Vector2d edge = a.points[i + 1 == a.count ? 0 : i + 1] - from;
    const Eigen::Vector2d normal = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
    double gap = kInfinity;
    for (int j = 0; j < b.count; ++j) gap = std::min(gap, normal.dot(b.points[j] - from));
    largest = std::max(largest, gap);
  }
  return largest;
}

double pointsToEdges(const Shadow& points, const Shadow& edges) {
  double smallest = kInfinity;
  for (int i = 0; i < points.count; ++i) {
    for (int j = 0; j < edges.count; ++j) {
      const Eigen::Vector2d& to = edges.points[j + 1 == edges.count ? 0 : j + 1];
      smallest = std::min(smallest, distanceToSegment(points.points[i], edges.points[j], to));
    }
  }
  return smallest;
}

/// Separation of the polygons without their radii; gives up at once when it is at least `limit`.
double polygonSeparation(const Shadow& a, const Shadow& b, double limit) {
  if (a.count == 1 && b.count == 1) return (a.points[0] - b.points[0]).norm();
  double gap = largestGap(a, b);
  if (gap >= limit) return gap;
  gap = std::max(gap, largestGap(b, a));
  if (gap <= 0.0 || gap >= limit) return gap;
  double distance = kInfinity;
  if (b.count > 1) distance = pointsToEdges(a, b);
  if (a.count > 1) distance = std::min(distance, pointsToEdges(b, a));
  return distance;
}

double turn(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

}  // namespace

// Andrew's monotone chain.
Shadow convexHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2d> chain;
  constexpr double kSameArea_m2 = 1e-14;
  const auto extend = [&](const Eigen::Vector2d& point, std::size_t fixed) {
    if (!chain.empty() && (chain.back() - point).squaredNorm() < kSameArea_m2) return;
    while (chain.size() > fixed + 1 &&
           turn(chain[chain.size() - 2], chain.back(), point) <= kSameArea_m2) {
      chain.pop_back();
    }
    chain.push_back(point);
  };
  for (const auto& point : points) extend(point, 0);
  const std::size_t lower = chain.empty() ? 0 : chain.size() - 1;
  for (auto point = points.rbegin(); point != points.rend(); ++point) extend(*point, lower);
  if (chain.size() > 1 && (chain.back() - chain.front()).squaredNorm() < kSameArea_m2) {
    chain.pop_back();
  }
  CASEPUSH_CHECK(chain.size() <= Shadow::kMaxPoints, chain.size() << " points");
  Shadow result;
  result.count = static_cast<int>(chain.size());
  std::copy(chain.begin(), chain.end(), result.points.begin());
  return result;
}

Shadow transformed(const Pose2& a_T_b, const Shadow& b_shadow) {
  Shadow result;
  result.count = b_shadow.count;
  result.radius_m = b_shadow.radius_m;
  const double c = std::cos(a_T_b.yaw());
  const double s = std::sin(a_T_b.yaw());
  for (int i = 0; i < b_shadow.count; ++i) {
    const Eigen::Vector2d& p = b_shadow.points[i];
    result.points[i] = {a_T_b.x() + c * p.x() - s * p.y(), a_T_b.y() + s * p.x() + c * p.y()};
  }
  return result;
}

BoundingDisc boundingDisc(const Shadow& shadow) {
  BoundingDisc disc;
  for (int i = 0; i < shadow.count; ++i) disc.centre_m += shadow.points[i] / shadow.count;
  for (int i = 0; i < shadow.count; ++i) {
    disc.radius_m = std::max(disc.radius_m, (shadow.points[i] - disc.centre_m).norm());
  }
  disc.radius_m += shadow.radius_m;
  return disc;
}

Shadow rectangle(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m) {
  Shadow result;
  result.count = 4;
  result.points[0] = min_m;
  result.points[1] = {max_m.x(), min_m.y()};
  result.points[2] = max_m;
  result.points[3] = {min_m.x(), max_m.y()};
  return result;
}

double separation(const Shadow& a, const Shadow& b) {
  return polygonSeparation(a, b, kInfinity) - a.radius_m - b.radius_m;
}

double separation(const Shadow& shadow, const Eigen::Vector2d& point) {
  if (shadow.count == 1) return (shadow.points[0] - point).norm() - shadow.radius_m;
  double inside = -kInfinity;
  double distance = kInfinity;
  for (int i = 0; i < shadow.count; ++i) {
    const Eigen::Vector2d& from = shadow.points[i];
    const Eigen::Vector2d edge = shadow.points[i + 1 == shadow.count ? 0 : i + 1] - from;
    inside = std::max(inside, cross(point - from, edge) / edge.norm());
    distance = std::min(distance, distanceToSegment(point, from, from + edge));
  }
  return (inside <= 0.0 ? inside : distance) - shadow.radius_m;
}

bool closerThan(const Shadow& a, const Shadow& b, double limit_m) {
  const double limit = limit_m + a.radius_m + b.radius_m;
  return polygonSeparation(a, b, limit) < limit;
}

double overlapDepth(const ConvexPart& a, const Pose2& map_T_a, const ConvexPart& b,
                    const Pose2& map_T_b, double margin_m) {
  const double low = std::max(a.heights().low_m, b.heights().low_m);
  const double high = std::min(a.heights().high_m, b.heights().high_m);
  if (high - low <= kContactTolerance_m) return 0.0;
  const double discs_m = a.disc().radius_m + b.disc().radius_m + margin_m;
  const Eigen::Vector2d apart = map_T_a * a.disc().centre_m - map_T_b * b.disc().centre_m;
  if (apart.squaredNorm() > discs_m * discs_m) return 0.0;
  const auto depthBetween = [&](double from, double to) {
    const Shadow shadow_a = a.shadow(from, to);
    const Shadow shadow_b = b.shadow(from, to);
    if (shadow_a.empty() || shadow_b.empty()) return 0.0;
    return margin_m - separation(transformed(map_T_a, shadow_a), transformed(map_T_b, shadow_b));
  };
  double depth = 0.0;
  if (a.isPrism() || b.isPrism()) {
    depth = depthBetween(low, high);
  } else if (a.isSphere() && b.isSphere()) {
    const double height_difference =
        (a.heights().low_m + a.heights().high_m - b.heights().low_m - b.heights().high_m) / 2.0;
    const double radii = a.shadow().radius_m + b.shadow().radius_m;
    const double reach = std::sqrt(std::max(0.0, radii * radii - std::pow(height_difference, 2)));
    depth =
        reach + margin_m - (map_T_a * a.shadow().points[0] - map_T_b * b.shadow().points[0]).norm();
    if (std::abs(height_difference) >= radii) depth = 0.0;
  } else {
    constexpr int kSlabs = 16;
    const double step = (high - low) / kSlabs;
    for (int i = 0; i < kSlabs; ++i) {
      depth = std::max(depth, depthBetween(low + i * step, low + (i + 1) * step));
    }
  }
  return depth > kContactTolerance_m ? depth : 0.0;
}

}  // namespace casepush
