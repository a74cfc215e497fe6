#pragma once

#include <memory>
#include <optional>

#include "casepush/planning/clearance_field.h"
#include "casepush/planning/prepared_cases.h"
#include "casepush/world/sweep_checker.h"

namespace casepush {

/// Why a case cannot be applied somewhere.
enum class PushConflict {
  kNone,
  kOutcome,       ///< The object at the mean outcome or a sigma point of it.
  kObjectMotion,  ///< The object on its way.
  kRobotMotion,   ///< The robot on its way.
};
const char* toString(PushConflict conflict);

/// Tests whether pushes are safe among a map and obstacles (paper Alg. 1, COLLIDING).
///
/// The object is tested at the seven sigma points of its outcome and along its mean trajectory, the
/// robot along its recorded trajectory, all with their true 3-D shapes.
/// Not thread-safe: it counts its tests.
class PushChecker {
 public:
  /// A solid that moves, and the radius of a circle around its origin that holds it.
  struct Body {
    std::shared_ptr<const Footprint> footprint;
    double radius_m = 0.0;
  };

  /// @param object, robot  With whatever margin they should be tested with.
  PushChecker(CollisionChecker checker, Body object, Body robot);

  /// For cases with sweeps of these very bodies, which are tested in one go.
  PushChecker(SweepChecker sweeps, Body object, Body robot);

  /// Lets the object's motion overlap the surroundings near its start as deep as it does there,
  /// e.g. when it stands at a wall whose cells are coarse. Outcomes must be free all the same.
  void tolerateStart(const Pose2& map_T_start);

  /// `conflict(...) == kNone`, fast for a case with a sweep.
  bool isSafe(const PreparedCase& push_case, const Pose2& map_T_object);

  /// False only if isSafe(), and faster for a case with a sweep, as cells that a body only might
  /// touch count.
  bool mayCollide(const PreparedCase& push_case, const Pose2& map_T_object);

  /// The first conflict found if the object is pushed from rest at `map_T_object`.
  PushConflict conflict(const PreparedCase& push_case, const Pose2& map_T_object);

  /// Does the object itself fit there? The tolerated start does.
  bool isFree(const Pose2& map_T_object);

  /// Can nothing touch the object, or the robot, if its origin is within `deviation_m` of there?
  /// Says no where it does not know.
  bool isObjectFarFromAll(const Eigen::Vector2d& position_m, double deviation_m);
  bool isRobotFarFromAll(const Eigen::Vector2d& position_m, double deviation_m);

  const CollisionChecker& collisions() const { return checker_; }
  /// nullptr if it was made without.
  const SweepChecker* sweeps() const { return sweeps_ ? &*sweeps_ : nullptr; }
  const Body& object() const { return object_; }
  /// Of everything around, made when it is first asked for.
  const ClearanceField& clearance();
  /// So near to its start the object may overlap its surroundings; 0: nowhere [m].
  double lenientRange() const;
  int checkCount() const { return check_count_; }  ///< Poses and sweeps tested so far.

 private:
  bool isTolerated(const Pose2& map_T_object) const;
  bool mayBeTolerated(const Sweep& sweep, const Pose2& map_T_object) const;
  bool objectCollidesOnItsWay(const PreparedCase& push_case, const Pose2& map_T_start);
  bool collides(const Body& body, const Pose2& map_T_x);
  bool anyCollides(const Body& body, const Pose2& map_T_start, const std::vector<Pose2>& start_T_x);

  CollisionChecker checker_;
  std::optional<SweepChecker> sweeps_;
  std::optional<ClearanceField> clearance_;  // made when a pose is tested first
  Body object_;
  Body robot_;
  Pose2 tolerated_start_;
  double tolerated_depth_m_ = 0.0;
  int check_count_ = 0;
};

}  // namespace casepush
