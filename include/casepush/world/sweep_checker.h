#pragma once

#include <memory>
#include <vector>

#include "casepush/world/collision_checker.h"
#include "casepush/world/shadow.h"
#include "casepush/world/sweep.h"

namespace casepush {

struct CellBox;
struct MapColumns;
class TurnedBitmaps;

/// Tests whole motions at once against a map and obstacles.
///
/// Three stages: the mask of what a sweep may cover accepts it where nothing lies; the mask of what
/// it certainly covers rejects it where something does; what is left is decided by the true shapes
/// at the few cells in question. The exact answer is the one CollisionChecker::collides() gives for
/// all bodies at all poses of the sweep, and the conservative one never misses a collision. Thread
/// safety: const methods are reentrant. Copies share the map's images.
class SweepChecker {
 public:
  using Bodies = std::vector<std::shared_ptr<const Footprint>>;

  /// Classes of heights for motions of these bodies (never of others) on maps with the checker's
  /// resolution.
  static std::shared_ptr<const HeightClasses> heightClasses(const CollisionChecker& checker,
                                                            const Bodies& bodies);

  /// Takes map and obstacles from `checker`. Takes about a millisecond for the map.
  /// @param reach_m  Sweeps that reach farther are tested pose by pose.
  SweepChecker(CollisionChecker checker, std::shared_ptr<const HeightClasses> classes,
               double reach_m);

  /// The same map with other obstacles, faster than from the start.
  /// @pre `checker` is a copy of the one that this was made from, but for its obstacles.
  SweepChecker withObstaclesOf(CollisionChecker checker) const;

  /// For `checker.updated(map, changed)`, as if made anew, faster if the map's extent is the same.
  SweepChecker updated(CollisionChecker checker, const CollisionChecker::Area& changed) const;

  /// Bits of all images, to compare two checkers.
  std::uint64_t fingerprint() const;

  /// False only if the motion is free.
  bool mayCollide(const Sweep& sweep, const Pose2& map_T_start) const;

  /// Exactly. A pose that is not finite collides.
  bool collides(const Sweep& sweep, const Pose2& map_T_start) const;

  /// True only if the motion collides with the map, and so do all that begin in the same of its
  /// cells with a heading in the same bin (Sweep::heading()). Says no where it does not know.
  bool certainlyCollides(const Sweep& sweep, const Pose2& map_T_start) const;

  /// The same as collides(), by testing one pose after the other.
  bool collidesPoseByPose(const Sweep& sweep, const Pose2& map_T_start) const;

  const CollisionChecker& collisions() const { return checker_; }
  const std::shared_ptr<const HeightClasses>& classes() const { return classes_; }
  double reach() const;  ///< Sweeps that reach farther are tested pose by pose [m].
  /// What the map occupies in each class of heights, without obstacles.
  const TurnedBitmaps& mapImages() const;

 private:
  struct Images;
  struct Place;
  struct StartFrame;

  void draw(const MapColumns& map, const CellBox& box, Images* images) const;
  bool place(const Sweep& sweep, const Pose2& map_T_start, Place* place) const;
  std::uint64_t hitsOf(const Place& place, int tile, int row) const;
  bool touchesHitCells(const Sweep& sweep, const Pose2& map_T_start, const Place& place) const;
  bool touchesCell(const Sweep& sweep, const StartFrame& start, std::size_t column) const;
  bool touchesCellWithin(const Sweep& sweep, int track, int first_pose, int last_pose,
                         const std::vector<int>& parts, const Shadow& start_square,
                         std::size_t column) const;
  bool touchesRest(const Sweep& sweep, const Pose2& map_T_start, bool outside, bool solids) const;

  CollisionChecker checker_;
  std::shared_ptr<const HeightClasses> classes_;
  std::shared_ptr<const Images> map_;     ///< Of the map alone.
  std::shared_ptr<const Images> around_;  ///< With obstacles.
};

}  // namespace casepush
