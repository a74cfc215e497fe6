#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "casepush/common/pose2.h"

namespace casepush {

/// d^2 = dx^2 + dy^2 + (rho dyaw)^2 [m^2], with rho in m/rad and dyaw wrapped.
double squaredPoseDistance(const Pose2& a, const Pose2& b, double rho_m);

/// Set of numbered poses that answers nearest-neighbour queries exactly.
///
/// Buckets of equal size over x, y and yaw, in blocks of 4 x 4 over x and y. Blocks are searched in
/// rings around the query, in them only buckets that may hold something nearer, until no farther
/// ring can. Poses outside of the bounds are kept in the border buckets, so that bounds affect
/// speed only. Not thread-safe.
class PoseGrid {
 public:
  /// @param rho_m  Weight of yaw in the metric, > 0 [m/rad].
  /// @param bucket_m  Edge length of a bucket in the metric, > 0.
  PoseGrid(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double rho_m,
           double bucket_m);

  void insert(int id, const Pose2& pose);
  /// @pre The pair was inserted.
  void remove(int id, const Pose2& pose);
  void clear();

  bool empty() const { return size_ == 0; }
  int size() const { return size_; }

  /// The id of the nearest pose, or -1 if empty. Of equally near ones the one with the lowest id.
  int nearest(const Pose2& pose) const;

  /// Appends the ids of all poses within `radius_m` (inclusive), in no particular order.
  void within(const Pose2& pose, double radius_m, std::vector<int>* ids) const;

 private:
  static constexpr int kBlock = 4;  ///< Buckets of a block along x and along y.
  static constexpr int kInOne = 7;  ///< Poses side by side.
  static constexpr int kNone = -1;

  struct Entry {
    double x_m;
    double y_m;
    double yaw_rad;
    int id;
  };
  /// Some poses of a bucket; all but the first group of a bucket are full.
  struct Group {
    std::array<Entry, kInOne> entries;
    int count;
    int next;  ///< Group of the same bucket, or the next free one; kNone at the end.
  };
  struct Index {
    int x;
    int y;
    int yaw;
  };

  Index indexOf(const Pose2& pose) const;
  std::size_t bucket(const Index& index) const;
  int& blockSize(const Index& index);
  double squaredDistance(const Entry& entry, const Pose2& pose) const;
  double turnGap(const Pose2& pose, int yaw) const;
  template <typename Visit>
  void visitBucket(std::size_t bucket, const Visit& visit) const;
  template <typename Visit>
  void visitBlock(const Pose2& pose, int block_x, int block_y, const double& bound,
                  const Visit& visit) const;
  template <typename Visit>
  void search(const Pose2& pose, const double& bound, const Visit& visit) const;

  Eigen::Vector2d min_m_;
  double rho_m_;
  double bucket_m_;
  int width_;
  int height_;
  int turns_;  ///< Buckets over the full turn.
  int blocks_wide_;
  int blocks_high_;
  double yaw_bucket_rad_;
  std::vector<int> first_group_;  // of each bucket
  std::vector<int> block_size_;   // poses in each block
  std::vector<Group> groups_;
  int free_group_ = kNone;
  int size_ = 0;
};

}  // namespace casepush
