#include "casepush/planning/pose_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Both angles are in (-pi, pi], so one turn is all that can be too much.
double yawGap(double a_rad, double b_rad) {
  const double gap = std::abs(a_rad - b_rad);
  return gap > kPi ? 2.0 * kPi - gap : gap;
}

int bucketCount(double extent, double bucket) {
  return std::max(1, static_cast<int>(std::ceil(extent / bucket)));
}

}  // namespace

double squaredPoseDistance(const Pose2& a, const Pose2& b, double rho_m) {
  const double dx = a.x() - b.x();
  const double dy = a.y() - b.y();
  const double turn = rho_m * yawGap(a.yaw(), b.yaw());
  return dx * dx + dy * dy + turn * turn;
}

PoseGrid::PoseGrid(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double rho_m,
                   double bucket_m)
    : min_m_(min_m), rho_m_(rho_m), bucket_m_(bucket_m) {
  CASEPUSH_CHECK(rho_m > 0.0 && bucket_m > 0.0, "rho " << rho_m << ", bucket " << bucket_m);
  width_ = bucketCount(max_m.x() - min_m.x(), bucket_m);
  height_ = bucketCount(max_m.y() - min_m.y(), bucket_m);
  // Rounded down, so that a bucket is never shorter than bucket_m and the ring bound holds.
  turns_ = std::max(1, static_cast<int>(2.0 * kPi * rho_m / bucket_m));
  yaw_bucket_rad_ = 2.0 * kPi / turns_;
  buckets_.resize(static_cast<std::size_t>(width_) * height_ * turns_);
}

PoseGrid::Index PoseGrid::indexOf(const Pose2& pose) const {
  const auto clamped = [](double value, int count) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, count - 1.0));
  };
  return {clamped((pose.x() - min_m_.x()) / bucket_m_, width_),
          clamped((pose.y() - min_m_.y()) / bucket_m_, height_),
          clamped((pose.yaw() + kPi) / yaw_bucket_rad_, turns_)};
}

std::vector<PoseGrid::Entry>& PoseGrid::bucket(const Index& index) {
  return buckets_[(static_cast<std::size_t>(index.y) * width_ + index.x) * turns_ + index.yaw];
}

void PoseGrid::insert(int id, const Pose2& pose) {
  bucket(indexOf(pose)).push_back({pose.x(), pose.y(), pose.yaw(), id});
  ++size_;
}

void PoseGrid::remove(int id, const Pose2& pose) {
  std::vector<Entry>& entries = bucket(indexOf(pose));
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [id](const Entry& entry) { return entry.id == id; });
  CASEPUSH_CHECK(found != entries.end(), "no pose " << id);
  *found = entries.back();
  entries.pop_back();
  --size_;
}

void PoseGrid::clear() {
  for (std::vector<Entry>& entries : buckets_) {
    entries.clear();
  }
  size_ = 0;
}

double PoseGrid::squaredDistance(const Entry& entry, const Pose2& pose) const {
  const double dx = entry.x_m - pose.x();
  const double dy = entry.y_m - pose.y();
  const double turn = rho_m_ * yawGap(entry.yaw_rad, pose.yaw());
  return dx * dx + dy * dy + turn * turn;
}

// Visits the buckets whose largest index difference from the centre is `ring`. Yaw wraps: its
// offsets run over one turn only, so that no bucket is met twice.
template <typename Visit>
void PoseGrid::visitRing(const Index& centre, int ring, const Visit& visit) const {
  const int yaw_low = -std::min(ring, (turns_ - 1) / 2);
  const int yaw_high = std::min(ring, turns_ / 2);
  for (int dt = yaw_low; dt <= yaw_high; ++dt) {
    const int turn = (centre.yaw + dt + turns_) % turns_;
    const bool whole_layer = std::abs(dt) == ring;
    for (int iy = std::max(0, centre.y - ring); iy <= std::min(height_ - 1, centre.y + ring);
         ++iy) {
      const bool whole_row = whole_layer || std::abs(iy - centre.y) == ring;
      const int step = whole_row ? 1 : std::max(1, 2 * ring);
      for (int ix = centre.x - ring; ix <= centre.x + ring; ix += step) {
        if (ix >= 0 && ix < width_) {
          visit(buckets_[(static_cast<std::size_t>(iy) * width_ + ix) * turns_ + turn]);
        }
      }
    }
  }
}

int PoseGrid::lastRing(const Index& centre) const {
  return std::max({centre.x, width_ - 1 - centre.x, centre.y, height_ - 1 - centre.y, turns_ / 2});
}

int PoseGrid::nearest(const Pose2& pose) const {
  if (empty()) {
    return -1;
  }
  const Index centre = indexOf(pose);
  double best = std::numeric_limits<double>::infinity();
  int best_id = -1;
  const int last = lastRing(centre);
  for (int ring = 0; ring <= last; ++ring) {
    // Anything in this ring is at least ring - 1 whole buckets away.
    const double bound = bucket_m_ * std::max(0, ring - 1);
    if (bound * bound > best) {
      break;
    }
    visitRing(centre, ring, [&](const std::vector<Entry>& entries) {
      for (const Entry& entry : entries) {
        const double d = squaredDistance(entry, pose);
        if (d < best || (d == best && entry.id < best_id)) {
          best = d;
          best_id = entry.id;
        }
      }
    });
  }
  return best_id;
}

void PoseGrid::within(const Pose2& pose, double radius_m, std::vector<int>* ids) const {
  const Index centre = indexOf(pose);
  const int last = std::min(lastRing(centre), static_cast<int>(radius_m / bucket_m_) + 1);
  for (int ring = 0; ring <= last; ++ring) {
    visitRing(centre, ring, [&](const std::vector<Entry>& entries) {
      for (const Entry& entry : entries) {
        if (squaredDistance(entry, pose) <= radius_m * radius_m) {
          ids->push_back(entry.id);
        }
      }
    });
  }
}

}  // namespace casepush
