#include "planar_mass.h"

#include <cmath>

namespace casepush::sim {

void PlanarMass::reset(std::size_t swivels) {
  a_.setZero();
  swivels_.assign(swivels, {});
}

void PlanarMass::add(const PlanarDirection& direction, double mass) {
  const Eigen::Vector3d scaled = mass * direction.chassis;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column <= row; ++column) {
      a_(row, column) += scaled[row] * direction.chassis[column];
    }
  }
  if (direction.swivel < 0) return;
  Swivel& swivel = swivels_[static_cast<std::size_t>(direction.swivel)];
  swivel.b += direction.swivel_rate * scaled;
  swivel.k += mass * direction.swivel_rate * direction.swivel_rate;
}

void PlanarMass::addSwivelInertia(int swivel, double inertia_kgm2) {
  swivels_[static_cast<std::size_t>(swivel)].k += inertia_kgm2;
}

void PlanarMass::factor() {
  for (Swivel& swivel : swivels_) {
    const Eigen::Vector3d scaled = swivel.b / swivel.k;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column <= row; ++column)
        a_(row, column) -= scaled[row] * swivel.b[column];
    }
    swivel.root = std::sqrt(swivel.k);
    swivel.b = scaled;  // From here on b / k.
  }
  l00_inverse_ = 1.0 / std::sqrt(a_(0, 0));
  l10_ = a_(1, 0) * l00_inverse_;
  l20_ = a_(2, 0) * l00_inverse_;
  l11_inverse_ = 1.0 / std::sqrt(a_(1, 1) - l10_ * l10_);
  l21_ = (a_(2, 1) - l20_ * l10_) * l11_inverse_;
  l22_inverse_ = 1.0 / std::sqrt(a_(2, 2) - l20_ * l20_ - l21_ * l21_);
}

Eigen::Vector4d PlanarMass::toIdentity(const PlanarDirection& direction) const {
  Eigen::Vector3d j = direction.chassis;
  double zeta = 0.0;
  if (direction.swivel >= 0) {
    const Swivel& swivel = swivels_[static_cast<std::size_t>(direction.swivel)];
    j -= direction.swivel_rate * swivel.b;
    zeta = direction.swivel_rate / swivel.root;
  }
  // inverse(L) j, by forward substitution.
  const double y0 = j[0] * l00_inverse_;
  const double y1 = (j[1] - l10_ * y0) * l11_inverse_;
  const double y2 = (j[2] - l20_ * y0 - l21_ * y1) * l22_inverse_;
  return {y0, y1, y2, zeta};
}

void PlanarMass::toIdentity(const double* velocity, double* identity) const {
  const Eigen::Map<const Eigen::Vector3d> v(velocity);
  for (std::size_t i = 0; i < swivels_.size(); ++i) {
    identity[3 + i] = swivels_[i].root * (velocity[3 + i] + swivels_[i].b.dot(v));
  }
  identity[0] = v[0] / l00_inverse_ + l10_ * v[1] + l20_ * v[2];
  identity[1] = v[1] / l11_inverse_ + l21_ * v[2];
  identity[2] = v[2] / l22_inverse_;
}

void PlanarMass::fromIdentity(const double* identity, double* velocity) const {
  Eigen::Map<Eigen::Vector3d> v(velocity);
  v[2] = identity[2] * l22_inverse_;
  v[1] = (identity[1] - l21_ * v[2]) * l11_inverse_;
  v[0] = (identity[0] - l10_ * v[1] - l20_ * v[2]) * l00_inverse_;
  for (std::size_t i = 0; i < swivels_.size(); ++i) {
    velocity[3 + i] = identity[3 + i] / swivels_[i].root - swivels_[i].b.dot(v);
  }
}

}  // namespace casepush::sim
