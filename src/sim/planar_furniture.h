#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <memory>
#include <vector>

#include "furniture.h"
#include "planar_body.h"
#include "planar_supports.h"

namespace casepush::sim {

/// A pushable object that stays flat on the floor; docs/simulator.md has the equations.
///
/// Unlike the reference it neither tips nor slips along the way its wheels roll.
class PlanarFurniture final : public Furniture {
 public:
  /// @throws InputError if the object cannot stand, see makePlanarModel().
  PlanarFurniture(const FurnitureBlueprint& blueprint, const FurnitureState& state,
                  const Floor& floor);

  void addTo(btCollisionWorld& world);

  /// Before each step: gives the solver its velocities, and rows for what it stands on.
  void enter(double step_s, PlanarSolver& solver);
  /// After solving: what a contact gave.
  void noteTouch(const PlanarTouch& touch) { supports_.noteTouch(touch); }
  /// After all contacts: moves.
  void leave(double step_s, PlanarSolver& solver);

  const PlanarBody& body() const { return body_; }
  /// Number of the swivel that a body of the blueprint turns with; -1 for the chassis.
  int swivelOf(int body) const;

  FurnitureState state() const override;
  Eigen::Isometry3d map_T_root() const override;
  Twist2 twist() const override;
  std::vector<Eigen::Isometry3d> map_T_links() const override;
  double mechanicalEnergyJ() const override;
  const std::vector<double>& wheelLoadN() const override { return supports_.loadN(); }

 private:
  struct Collider {
    int body = 0;  // Of the blueprint.
    std::unique_ptr<btCollisionObject> object;
  };

  void setState(const FurnitureState& state);
  void setupColliders(const Floor& floor);
  void placeColliders();
  Pose2 map_T_object() const;
  double jointRad(int joint) const;
  double jointRps(int joint) const;
  // Pose of the object's frame as turned by all joints above a body.
  Eigen::Isometry3d map_T_turned(int body) const;

  const FurnitureBlueprint& blueprint_;
  const PlanarModel model_;
  PlanarBody body_;
  PlanarSupports supports_;
  std::vector<int> swivel_of_joint_;  // -1: a wheel.
  std::vector<int> wheel_of_joint_;   // -1: a swivel.
  std::vector<Collider> colliders_;
};

}  // namespace casepush::sim
