#include "casepush/planning/pose_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Both angles are in (-pi, pi], so one turn is all that can be too much.
double yawGap(double a_rad, double b_rad) {
  const double gap = std::abs(a_rad - b_rad);
  return std::min(gap, 2.0 * kPi - gap);
}

int bucketCount(double extent, double bucket) {
  return std::max(1, static_cast<int>(std::ceil(extent / bucket)));
}

// From a value to the indices [first, end) of `count` intervals, of which the outer ones hold all
// that lies beyond them. In intervals, and by rounding not too long.
double gapTo(double value, int first, int end, int count) {
  constexpr double kRounding = 1e-9;
  const double below = first > 0 ? first - value : -kInfinity;
  const double above = end < count ? value - end : -kInfinity;
  return std::max(0.0, std::max(below, above) - kRounding);
}

double squared(double value) { return value * value; }

}  // namespace

double squaredPoseDistance(const Pose2& a, const Pose2& b, double rho_m) {
  return squared(a.x() - b.x()) + squared(a.y() - b.y()) +
         squared(rho_m * yawGap(a.yaw(), b.yaw()));
}

PoseGrid::PoseGrid(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double rho_m,
                   double bucket_m)
    : min_m_(min_m), rho_m_(rho_m), bucket_m_(bucket_m) {
  CASEPUSH_CHECK(rho_m > 0.0 && bucket_m > 0.0, "rho " << rho_m << ", bucket " << bucket_m);
  width_ = bucketCount(max_m.x() - min_m.x(), bucket_m);
  height_ = bucketCount(max_m.y() - min_m.y(), bucket_m);
  turns_ = std::max(1, static_cast<int>(2.0 * kPi * rho_m / bucket_m));
  yaw_bucket_rad_ = 2.0 * kPi / turns_;
  blocks_wide_ = (width_ + kBlock - 1) / kBlock;
  blocks_high_ = (height_ + kBlock - 1) / kBlock;
  clear();
}

void PoseGrid::clear() {
  first_group_.assign(static_cast<std::size_t>(width_) * height_ * turns_, kNone);
  block_size_.assign(static_cast<std::size_t>(blocks_wide_) * blocks_high_, 0);
  groups_.clear();
  free_group_ = kNone;
  size_ = 0;
}

PoseGrid::Index PoseGrid::indexOf(const Pose2& pose) const {
  const auto clamped = [](double value, int count) {
    return static_cast<int>(std::clamp(value, 0.0, count - 1.0));
  };
  return {clamped((pose.x() - min_m_.x()) / bucket_m_, width_),
          clamped((pose.y() - min_m_.y()) / bucket_m_, height_),
          clamped((pose.yaw() + kPi) / yaw_bucket_rad_, turns_)};
}

std::size_t PoseGrid::bucket(const Index& index) const {
  return (static_cast<std::size_t>(index.y) * width_ + index.x) * turns_ + index.yaw;
}

int& PoseGrid::blockSize(const Index& index) {
  return block_size_[static_cast<std::size_t>(index.y / kBlock) * blocks_wide_ + index.x / kBlock];
}

void PoseGrid::insert(int id, const Pose2& pose) {
  const Index index = indexOf(pose);
  int& first = first_group_[bucket(index)];
  if (first == kNone || groups_[first].count == kInOne) {
    int group = free_group_;
    if (group == kNone) {
      group = static_cast<int>(groups_.size());
      groups_.emplace_back();
    } else {
      free_group_ = groups_[group].next;
    }
    groups_[group].count = 0;
    groups_[group].next = first;
    first = group;
  }
  Group& group = groups_[first];
  group.entries[group.count++] = {pose.x(), pose.y(), pose.yaw(), id};
  ++blockSize(index);
  ++size_;
}

void PoseGrid::remove(int id, const Pose2& pose) {
  const Index index = indexOf(pose);
  int& first = first_group_[bucket(index)];
  const auto find = [&]() -> Entry* {
    for (int at = first; at != kNone; at = groups_[at].next) {
      Group& group = groups_[at];
      for (int i = 0; i < group.count; ++i) {
        if (group.entries[i].id == id) return &group.entries[i];
      }
    }
    return nullptr;
  };
  Entry* const found = find();
  CASEPUSH_CHECK(found != nullptr, "no pose " << id);
  Group& group = groups_[first];
  *found = group.entries[--group.count];
  if (group.count == 0) {
    const int emptied = first;
    first = group.next;
    group.next = free_group_;
    free_group_ = emptied;
  }
  --blockSize(index);
  --size_;
}

double PoseGrid::squaredDistance(const Entry& entry, const Pose2& pose) const {
  return squared(entry.x_m - pose.x()) + squared(entry.y_m - pose.y()) +
         squared(rho_m_ * yawGap(entry.yaw_rad, pose.yaw()));
}

// From a pose to the bucket of a yaw, in the metric.
double PoseGrid::turnGap(const Pose2& pose, int yaw) const {
  constexpr double kRounding = 1e-9;
  const double half = 0.5 * yaw_bucket_rad_;
  const double middle = (yaw + 0.5) * yaw_bucket_rad_ - kPi;
  return rho_m_ * std::max(0.0, yawGap(middle, pose.yaw()) - half - kRounding);
}

template <typename Visit>
void PoseGrid::visitBucket(std::size_t bucket, const Visit& visit) const {
  for (int at = first_group_[bucket]; at != kNone; at = groups_[at].next) {
    const Group& group = groups_[at];
    for (int i = 0; i < group.count; ++i) visit(group.entries[i]);
  }
}

template <typename Visit>
void PoseGrid::visitBlock(const Pose2& pose, int block_x, int block_y, const double& bound,
                          const Visit& visit) const {
  if (block_size_[static_cast<std::size_t>(block_y) * blocks_wide_ + block_x] == 0) return;
  const double x = (pose.x() - min_m_.x()) / bucket_m_;
  const double y = (pose.y() - min_m_.y()) / bucket_m_;
  const int x0 = block_x * kBlock;
  const int y0 = block_y * kBlock;
  const int x1 = std::min(width_, x0 + kBlock);
  const int y1 = std::min(height_, y0 + kBlock);
  const double bucket2 = bucket_m_ * bucket_m_;
  const double block_gap2 = squared(gapTo(x, x0, x1, width_)) + squared(gapTo(y, y0, y1, height_));
  if (bucket2 * block_gap2 > bound) return;
  for (int iy = y0; iy < y1; ++iy) {
    const double y_gap2 = squared(gapTo(y, iy, iy + 1, height_));
    for (int ix = x0; ix < x1; ++ix) {
      const double gap2 = bucket2 * (y_gap2 + squared(gapTo(x, ix, ix + 1, width_)));
      if (gap2 > bound) continue;
      const std::size_t first = bucket({ix, iy, 0});
      for (int yaw = 0; yaw < turns_; ++yaw) {
        if (first_group_[first + yaw] == kNone) continue;
        if (gap2 + squared(turnGap(pose, yaw)) > bound) continue;
        visitBucket(first + yaw, visit);
      }
    }
  }
}

// Visits all poses whose squared distance may be no more than `bound`, which `visit` may lower.
template <typename Visit>
void PoseGrid::search(const Pose2& pose, const double& bound, const Visit& visit) const {
  const Index centre = indexOf(pose);
  const int cx = centre.x / kBlock;
  const int cy = centre.y / kBlock;
  const int last = std::max({cx, blocks_wide_ - 1 - cx, cy, blocks_high_ - 1 - cy});
  for (int ring = 0; ring <= last; ++ring) {
    // Anything in this ring is at least ring - 1 whole blocks away.
    if (squared(kBlock * bucket_m_ * std::max(0, ring - 1)) > bound) return;
    for (int by = std::max(0, cy - ring); by <= std::min(blocks_high_ - 1, cy + ring); ++by) {
      const int step = std::abs(by - cy) == ring ? 1 : std::max(1, 2 * ring);
      for (int bx = cx - ring; bx <= cx + ring; bx += step) {
        if (bx >= 0 && bx < blocks_wide_) visitBlock(pose, bx, by, bound, visit);
      }
    }
  }
}

int PoseGrid::nearest(const Pose2& pose) const {
  double best = kInfinity;
  int best_id = -1;
  const auto compare = [&](const Entry& entry) {
    const double d = squaredDistance(entry, pose);
    if (d > best || (d == best && entry.id >= best_id)) return;
    best = d;
    best_id = entry.id;
  };
  visitBucket(bucket(indexOf(pose)), compare);  // Something near leaves few others to look at.
  search(pose, best, compare);
  return best_id;
}

void PoseGrid::within(const Pose2& pose, double radius_m, std::vector<int>* ids) const {
  const double bound = radius_m * radius_m;
  search(pose, bound, [&](const Entry& entry) {
    if (squaredDistance(entry, pose) <= bound) ids->push_back(entry.id);
  });
}

}  // namespace casepush
