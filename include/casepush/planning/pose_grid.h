#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "casepush/common/pose2.h"

namespace casepush {

/// d^2 = dx^2 + dy^2 + (rho dyaw)^2 [m^2], with rho in m/rad and dyaw wrapped.
double squaredPoseDistance(const Pose2& a, const Pose2& b, double rho_m);

/// Set of numbered poses that answers nearest-neighbour queries exactly.
///
/// Buckets of equal size over x, y and yaw are searched in rings around the query; the search ends
/// when no farther ring can hold anything nearer. Poses outside of the bounds are kept in the
/// border buckets, so that bounds affect speed only. Not thread-safe.
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
  struct Entry {
    double x_m;
    double y_m;
    double yaw_rad;
    int id;
  };
  struct Index {
    int x;
    int y;
    int yaw;
  };

  Index indexOf(const Pose2& pose) const;
  std::vector<Entry>& bucket(const Index& index);
  double squaredDistance(const Entry& entry, const Pose2& pose) const;
  template <typename Visit>
  void visitRing(const Index& centre, int ring, const Visit& visit) const;
  int lastRing(const Index& centre) const;

  Eigen::Vector2d min_m_;
  double rho_m_;
  double bucket_m_;
  int width_;
  int height_;
  int turns_;  ///< Buckets over the full turn.
  double yaw_bucket_rad_;
  std::vector<std::vector<Entry>> buckets_;
  int size_ = 0;
};

}  // namespace casepush
