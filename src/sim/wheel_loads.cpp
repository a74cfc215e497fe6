#include "wheel_loads.h"

#include <algorithm>

namespace casepush::sim {
namespace {

constexpr double kThin = 1e-4;  // Squared ratio of width to length at which supports are a line.

}  // namespace

bool shareLoad(const std::vector<Eigen::Vector2d>& points, double total,
               const Eigen::Vector2d& moment, std::vector<double>& loads) {
  if (points.size() < 3) return false;
  const double n = static_cast<double>(points.size());
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) centre += p;
  centre /= n;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d d = p - centre;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > kThin * (xx + yy) * (xx + yy))) return false;
  // About the centre the equation for the mean load and those for the slope come apart.
  const Eigen::Vector2d about_centre = moment - total * centre;
  const Eigen::Vector2d slope((yy * about_centre.x() - xy * about_centre.y()) / determinant,
                              (xx * about_centre.y() - xy * about_centre.x()) / determinant);
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    loads[i] = std::max(0.0, total / n + slope.dot(points[i] - centre));
    sum += loads[i];
  }
  if (sum > 0.0) {
    for (double& load : loads) load *= total / sum;
  }
  return true;
}

}  // namespace casepush::sim
