#pragma once

#include <Eigen/Core>
#include <vector>

#include "planar_mass.h"
#include "planar_model.h"
#include "planar_solver.h"

namespace casepush::sim {

/// z component of the cross product.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A chassis that moves in the plane, and what swivels below it. All vectors along the map's axes.
///
/// A step is: beginStep, add to mass(), enter, rows and impulses, solve, leave.
class PlanarBody {
 public:
  PlanarBody(double chassis_mass_kg, double chassis_inertia_kgm2,
             const std::vector<PlanarSwivel>& swivels);

  void setPose(const Eigen::Vector2d& map_p_com, double yaw_rad);
  void setVelocity(const Eigen::Vector2d& com_mps, double yaw_rate_rps);
  void setSwivel(int swivel, double heading_rad, double rate_rps);  ///< Absolute, not joint.

  const Eigen::Vector2d& position() const { return position_; }  ///< Chassis' centre of mass.
  double yaw() const { return yaw_; }
  double heading(int swivel) const { return heading_[static_cast<std::size_t>(swivel)]; }
  Eigen::Vector2d linearVelocity() const { return {velocity_[0], velocity_[1]}; }
  double yawRate() const { return velocity_[2]; }
  double headingRate(int swivel) const { return velocity_[3 + static_cast<std::size_t>(swivel)]; }
  double speed(const PlanarDirection& direction) const;
  bool isAtRest() const;
  double kineticEnergyJ() const;  ///< Without what others added to the mass.

  /// Sets up geometry and mass matrix for the present pose.
  void beginStep();
  PlanarMass& mass() { return mass_; }
  /// Gives the solver the present velocities, and what centrifugal forces add to them.
  void enter(double step_s, PlanarSolver& solver);
  /// Takes new velocities from the solver and moves with them.
  void leave(double step_s, PlanarSolver& solver);

  PlanarAddress address(int swivel) const;
  /// For the solver's rows.
  Eigen::Vector4d coordinates(const PlanarDirection& direction) const {
    return mass_.toIdentity(direction);
  }
  void applyImpulse(PlanarSolver& solver, const PlanarDirection& direction, double impulse) const;

  /// @name Geometry as of beginStep
  /// @{
  /// Turns a vector of the chassis or, from angle zero, of something that swivels.
  Eigen::Vector2d turned(const Eigen::Vector2d& vector, int swivel) const;
  const Eigen::Vector2d& pivot(int swivel) const;  ///< From the centre of mass.
  Eigen::Vector2d swivelCom(int swivel) const;     ///< From the pivot.
  /// Along `axis` at a point given from the pivot or, if swivel < 0, from the centre of mass.
  PlanarDirection direction(const Eigen::Vector2d& point, const Eigen::Vector2d& axis,
                            int swivel) const;
  /// @}

 private:
  struct Turn {
    double cosine = 1.0;
    double sine = 0.0;
  };
  static Turn turnBy(double angle_rad);

  double chassis_mass_kg_;
  double chassis_inertia_kgm2_;
  const std::vector<PlanarSwivel>& swivels_;
  Eigen::Vector2d position_ = Eigen::Vector2d::Zero();
  double yaw_ = 0.0;
  std::vector<double> heading_;   // Absolute: yaw plus swivel angle.
  std::vector<double> velocity_;  // vx, vy, yaw rate, and the rates of the headings.
  PlanarMass mass_;
  int address_ = 0;
  Turn chassis_turn_;
  std::vector<Turn> swivel_turn_;
  std::vector<Eigen::Vector2d> pivot_;
};

}  // namespace casepush::sim
