#pragma once

#include <LinearMath/btTransform.h>

#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/common/random.h"
#include "casepush/model/world_model.h"
#include "furniture_blueprint.h"

namespace casepush::sim {

constexpr double kGravity_mps2 = 9.81;
/// Wheel loads are smoothed over this time: a contact impulse of a single step is noisy.
constexpr double kLoadSmoothing_s = 0.01;

/// All of an object that moves. Vectors are indexed by body - 1 and by caster.
struct FurnitureState {
  btTransform map_T_base = btTransform::getIdentity();  ///< Base: centre of mass of body 0.
  btVector3 base_velocity_mps{0, 0, 0};
  btVector3 base_omega_rps{0, 0, 0};
  std::vector<double> joint_rad;
  std::vector<double> joint_rps;
  std::vector<double> wheel_load_n;
};

/// Standing still with swivels drawn at random.
FurnitureState stateAtRest(const FurnitureBlueprint& blueprint, const Pose2& map_T_object,
                           Random& random);

/// The same motion, as a state of the same object with another load: positions and velocities of
/// all its points stay, so what is put on it moves along with it from the start.
FurnitureState carriedOver(const FurnitureState& state, const FurnitureBlueprint& from,
                           const FurnitureBlueprint& to);

/// Coefficient of a body's surface; coefficients of two bodies in contact are multiplied, and the
/// floor's is 1.
double surfaceFriction(const FurnitureBlueprint& blueprint, const BodyBlueprint& body,
                       const Floor& floor);

/// A pushable object in the simulated world, whatever the model of its casters.
class Furniture {
 public:
  virtual ~Furniture() = default;

  virtual FurnitureState state() const = 0;
  virtual Eigen::Isometry3d map_T_root() const = 0;
  virtual Twist2 twist() const = 0;  ///< Of the object's origin, in the object frame.
  virtual std::vector<Eigen::Isometry3d> map_T_links() const = 0;
  virtual double mechanicalEnergyJ() const = 0;  ///< Kinetic, and potential above the floor.
  virtual const std::vector<double>& wheelLoadN() const = 0;  ///< In the order of the casters.
};

}  // namespace casepush::sim
