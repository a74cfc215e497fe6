#include "mass_properties.h"

#include <Eigen/Eigenvalues>

#include "casepush/common/check.h"

namespace casepush::sim {
namespace {

struct Part {
  double mass_kg;
  Eigen::Vector3d root_p_com;
  Eigen::Matrix3d inertia_kgm2;  // About its centre of mass, along the root's axes.
};

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

MassProperties composeMass(const Mechanism& mechanism, const std::vector<int>& links,
                           const std::optional<Load>& load) {
  std::vector<Part> parts;
  for (const int i : links) {
    const Link& link = mechanism.links.at(static_cast<std::size_t>(i));
    const Eigen::Isometry3d root_T_inertial = mechanism.root_T_link(i) * link.link_T_inertial;
    const Eigen::Matrix3d r = root_T_inertial.linear();
    parts.push_back(
        {link.mass_kg, root_T_inertial.translation(), r * link.inertia_kgm2 * r.transpose()});
  }
  if (load) {
    const Eigen::Vector2d& place_m = load->object_p_centre_m;
    parts.push_back(
        {load->mass_kg, {place_m.x(), place_m.y(), load->height_m.value()}, inertiaOf(*load)});
  }
  MassProperties result;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const Part& part : parts) {
    result.mass_kg += part.mass_kg;
    moment += part.mass_kg * part.root_p_com;
  }
  CASEPUSH_CHECK(result.mass_kg > 0.0, mechanism.name << ": mass " << result.mass_kg);
  const Eigen::Vector3d com = moment / result.mass_kg;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Part& part : parts) {
    inertia += part.inertia_kgm2 + pointInertia(part.mass_kg, part.root_p_com - com);
  }
  const Eigen::Matrix3d axes = principalAxes(inertia);
  result.root_T_com.linear() = axes;
  result.root_T_com.translation() = com;
  result.inertia_kgm2 = (axes.transpose() * inertia * axes).diagonal();
  return result;
}

}  // namespace casepush::sim
