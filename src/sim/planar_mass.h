#pragma once

#include <Eigen/Core>
#include <vector>

namespace casepush::sim {

/// Row of a constraint or direction of an impulse: speed = chassis . (vx, vy, omega) + swivel_rate
/// * (rate of swivel number `swivel`).
struct PlanarDirection {
  Eigen::Vector3d chassis = Eigen::Vector3d::Zero();
  int swivel = -1;
  double swivel_rate = 0.0;
};

/// Mass matrix of a body in the plane with swivels, and coordinates in which it is the identity.
///
/// The velocities are V = (vx, vy, omega) of the chassis along the map's axes and the absolute rate
/// psi' of each swivel. Swivels couple to the chassis but not to each other:
///   2 T = V' A V + sum (2 psi_i' b_i' V + k_i psi_i'^2).
/// With zeta_i = sqrt(k_i) (psi_i' + b_i' V / k_i) and y = L' V, where L L' = A - sum b_i b_i' /
/// k_i (Cholesky), 2 T = |y|^2 + |zeta|^2. So an impulse along one direction touches three y and at
/// most one zeta, and needs no mass matrix any more.
class PlanarMass {
 public:
  void reset(std::size_t swivels);

  /// Adds the energy mass/2 (speed along the direction)^2.
  void add(const PlanarDirection& direction, double mass);
  void addSwivelInertia(int swivel, double inertia_kgm2);

  /// After all is added. @pre every swivel has inertia.
  void factor();

  /// The direction in the coordinates (y, zeta of its swivel).
  Eigen::Vector4d toIdentity(const PlanarDirection& direction) const;

  /// (V, psi') to (y, zeta) and back; arrays of 3 + swivels.
  void toIdentity(const double* velocity, double* identity) const;
  void fromIdentity(const double* identity, double* velocity) const;

 private:
  struct Swivel {
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double k = 0.0;
    double root = 0.0;  // Of k.
  };

  Eigen::Matrix3d a_ = Eigen::Matrix3d::Zero();  // Lower triangle.
  std::vector<Swivel> swivels_;
  // L, row by row, with the inverse of its diagonal.
  double l00_inverse_ = 0.0, l10_ = 0.0, l11_inverse_ = 0.0, l20_ = 0.0, l21_ = 0.0,
         l22_inverse_ = 0.0;
};

}  // namespace casepush::sim
