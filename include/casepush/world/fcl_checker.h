#pragma once

#include <memory>
#include <vector>

#include "casepush/world/collision_checker.h"

namespace casepush {

/// An independent collision checker for verification: FCL's own shapes, octree and algorithms on
/// the OctoMap itself, slow and without anything derived.
///
/// Margins are not known to it: it tests the true shapes. Not thread-safe.
class FclChecker {
 public:
  /// False if casepush was built without FCL; every constructor then throws.
  static bool isAvailable();

  /// Cells whose top is not above `floor_m` are left out, as for CollisionChecker.
  /// @throws InputError if casepush was built without FCL.
  explicit FclChecker(const Map& map, double floor_m = 0.05);
  ~FclChecker();

  void setObstacles(const std::vector<PlacedSolid>& obstacles);

  /// A solid as FCL sees it.
  class Body {
   public:
    /// @param shrink_m  Taken off all around each shape, to tell contacts from collisions.
    explicit Body(const Solid& solid, double shrink_m = 0.0);
    ~Body();
    Body(Body&&) noexcept;

   private:
    friend class FclChecker;
    struct Data;
    std::unique_ptr<Data> data_;
  };

  /// Does the body overlap the map, an obstacle or (by its bounding boxes) the outside of the map?
  bool collides(const Body& body, const Pose2& map_T_body) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
