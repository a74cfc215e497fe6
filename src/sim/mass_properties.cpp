#include "mass_properties.h"

#include <Eigen/Eigenvalues>

#include "casepush/common/check.h"

namespace casepush::sim {
namespace {

// Inertia of a point mass at `offset` (parallel axis theorem).
Eigen::Matrix3d pointInertia(double mass_kg, const Eigen::Vector3d& offset_m) {
  return mass_kg *
         (offset_m.squaredNorm() * Eigen::Matrix3d::Identity() - offset_m * offset_m.transpose());
}

// Axes that are principal already stay as they are: rotated ones would be as right, but harder to
// follow in a debugger.
Eigen::Matrix3d principalAxes(const Eigen::Matrix3d& inertia) {
  const Eigen::Matrix3d diagonal = inertia.diagonal().asDiagonal();
  if ((inertia - diagonal).norm() <= 1e-9 * inertia.norm()) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
  return axes;
}

}  // namespace

Eigen::Matrix3d MassProperties::rootInertia() const {
  const Eigen::Matrix3d axes = root_T_com.linear();
  return axes * inertia_kgm2.asDiagonal() * axes.transpose();
}

MassProperties composeMass(const Mechanism& mechanism, const std::vector<int>& links) {
  MassProperties result;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const int i : links) {
    const Link& link = mechanism.links.at(static_cast<std::size_t>(i));
    const Eigen::Isometry3d root_T_inertial = mechanism.root_T_link(i) * link.link_T_inertial;
    result.mass_kg += link.mass_kg;
    moment += link.mass_kg * root_T_inertial.translation();
  }
  CASEPUSH_CHECK(result.mass_kg > 0.0, mechanism.name << ": mass " << result.mass_kg);
  const Eigen::Vector3d com = moment / result.mass_kg;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const int i : links) {
    const Link& link = mechanism.links.at(static_cast<std::size_t>(i));
    const Eigen::Isometry3d root_T_inertial = mechanism.root_T_link(i) * link.link_T_inertial;
    const Eigen::Matrix3d r = root_T_inertial.linear();
    inertia += r * link.inertia_kgm2 * r.transpose() +
               pointInertia(link.mass_kg, root_T_inertial.translation() - com);
  }
  const Eigen::Matrix3d axes = principalAxes(inertia);
  result.root_T_com.linear() = axes;
  result.root_T_com.translation() = com;
  result.inertia_kgm2 = (axes.transpose() * inertia * axes).diagonal();
  return result;
}

}  // namespace casepush::sim
