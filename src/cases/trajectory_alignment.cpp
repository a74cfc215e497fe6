#include "casepush/cases/trajectory_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "casepush/common/check.h"

namespace casepush {
namespace {

enum Step : std::uint8_t { kBoth, kReference, kOther };

double squaredDistance(const Pose2& a, const Pose2& b, double yaw_scale_m) {
  const double yaw_m = yaw_scale_m * yawDifference(a, b);
  return (a.position() - b.position()).squaredNorm() + yaw_m * yaw_m;
}

// Last steps of the best matchings of all beginnings, row by row; the least cost goes to `cost`.
std::vector<Step> bestSteps(const std::vector<Pose2>& reference, const std::vector<Pose2>& other,
                            double yaw_scale_m, double& cost) {
  const std::size_t width = other.size();
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::vector<Step> steps(reference.size() * width, kBoth);
  std::vector<double> above(width, kNever);
  std::vector<double> row(width, kNever);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      const double both = k > 0 ? above[k - 1] : kNever;
      const double left = k > 0 ? row[k - 1] : kNever;
      double best = i == 0 && k == 0 ? 0.0 : both;
      Step& step = steps[i * width + k];
      if (above[k] < best) {
        best = above[k];
        step = kReference;
      }
      if (left < best) {
        best = left;
        step = kOther;
      }
      row[k] = best + squaredDistance(reference[i], other[k], yaw_scale_m);
    }
    std::swap(above, row);
    std::fill(row.begin(), row.end(), kNever);
  }
  cost = above.back();
  return steps;
}

}  // namespace

TrajectoryAlignment alignTrajectories(const std::vector<Pose2>& reference,
                                      const std::vector<Pose2>& other, double yaw_scale_m) {
  CASEPUSH_CHECK(!reference.empty() && !other.empty(), reference.size()
                                                           << " and " << other.size() << " poses");
  TrajectoryAlignment alignment;
  const std::vector<Step> steps = bestSteps(reference, other, yaw_scale_m, alignment.cost);
  alignment.places.assign(reference.size(), 0.0);
  std::size_t i = reference.size() - 1;
  std::size_t k = other.size() - 1;
  std::size_t last = k;
  // Backwards; `last` is the end of the run that reference pose i is matched with.
  while (true) {
    const Step step = steps[i * other.size() + k];
    const bool is_begin = i == 0 && k == 0;
    if (is_begin || step != kOther) {
      alignment.places[i] = 0.5 * static_cast<double>(k + last);
    }
    if (is_begin) {
      break;
    }
    i -= step != kOther ? 1 : 0;
    k -= step != kReference ? 1 : 0;
    last = step != kOther ? k : last;
  }
  alignment.places.back() = static_cast<double>(other.size() - 1);
  alignment.places.front() = reference.size() > 1 ? 0.0 : alignment.places.back();
  return alignment;
}

std::vector<Pose2> posesAt(const std::vector<Pose2>& trajectory,
                           const std::vector<double>& places) {
  std::vector<Pose2> poses;
  poses.reserve(places.size());
  for (const double place : places) {
    CASEPUSH_CHECK(place >= 0.0 && place <= static_cast<double>(trajectory.size() - 1),
                   place << " of " << trajectory.size());
    const auto before = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(before);
    poses.push_back(share > 0.0 ? interpolate(trajectory[before], trajectory[before + 1], share)
                                : trajectory[before]);
  }
  return poses;
}

std::vector<double> travelledShares(const std::vector<Pose2>& trajectory, double yaw_scale_m) {
  std::vector<double> shares(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    shares[i] =
        shares[i - 1] + std::sqrt(squaredDistance(trajectory[i - 1], trajectory[i], yaw_scale_m));
  }
  const double way_m = shares.empty() ? 0.0 : shares.back();
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    shares[i] = way_m > 0.0 ? shares[i] / way_m
                            : static_cast<double>(i) / static_cast<double>(trajectory.size() - 1);
  }
  return shares;
}

}  // namespace casepush
