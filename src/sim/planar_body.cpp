#include "planar_body.h"

#include <algorithm>
#include <cmath>

namespace casepush::sim {
namespace {

using Eigen::Vector2d;

// Coulomb friction ends any motion this slow within a small part of a step; what the solver leaves
// over is no motion.
constexpr double kAtRest = 1e-7;

}  // namespace

PlanarBody::PlanarBody(double chassis_mass_kg, double chassis_inertia_kgm2,
                       const std::vector<PlanarSwivel>& swivels)
    : chassis_mass_kg_(chassis_mass_kg),
      chassis_inertia_kgm2_(chassis_inertia_kgm2),
      swivels_(swivels),
      heading_(swivels.size(), 0.0),
      velocity_(3 + swivels.size(), 0.0),
      swivel_turn_(swivels.size()),
      pivot_(swivels.size(), Vector2d::Zero()) {
  beginStep();
}

void PlanarBody::setPose(const Vector2d& map_p_com, double yaw_rad) {
  position_ = map_p_com;
  yaw_ = yaw_rad;
}

void PlanarBody::setVelocity(const Vector2d& com_mps, double yaw_rate_rps) {
  velocity_[0] = com_mps.x();
  velocity_[1] = com_mps.y();
  velocity_[2] = yaw_rate_rps;
}

void PlanarBody::setSwivel(int swivel, double heading_rad, double rate_rps) {
  heading_[static_cast<std::size_t>(swivel)] = heading_rad;
  velocity_[3 + static_cast<std::size_t>(swivel)] = rate_rps;
}

double PlanarBody::speed(const PlanarDirection& direction) const {
  double result = 0.0;
  for (int i = 0; i < 3; ++i)
    result += direction.chassis[i] * velocity_[static_cast<std::size_t>(i)];
  if (direction.swivel >= 0) result += direction.swivel_rate * headingRate(direction.swivel);
  return result;
}

bool PlanarBody::isAtRest() const {
  return std::all_of(velocity_.begin(), velocity_.end(),
                     [](double v) { return std::abs(v) < kAtRest; });
}

PlanarBody::Turn PlanarBody::turnBy(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

Vector2d PlanarBody::turned(const Vector2d& vector, int swivel) const {
  const Turn& turn = swivel < 0 ? chassis_turn_ : swivel_turn_[static_cast<std::size_t>(swivel)];
  return {turn.cosine * vector.x() - turn.sine * vector.y(),
          turn.sine * vector.x() + turn.cosine * vector.y()};
}

const Vector2d& PlanarBody::pivot(int swivel) const {
  return pivot_[static_cast<std::size_t>(swivel)];
}

Vector2d PlanarBody::swivelCom(int swivel) const {
  return turned(swivels_[static_cast<std::size_t>(swivel)].pivot_p_com, swivel);
}

PlanarDirection PlanarBody::direction(const Vector2d& point, const Vector2d& axis,
                                      int swivel) const {
  const Vector2d& arm = swivel < 0 ? point : pivot(swivel);
  PlanarDirection result;
  result.chassis << axis.x(), axis.y(), cross(arm, axis);
  if (swivel >= 0) {
    result.swivel = swivel;
    result.swivel_rate = cross(point, axis);
  }
  return result;
}

void PlanarBody::beginStep() {
  chassis_turn_ = turnBy(yaw_);
  mass_.reset(swivels_.size());
  mass_.add({{1.0, 0.0, 0.0}}, chassis_mass_kg_);
  mass_.add({{0.0, 1.0, 0.0}}, chassis_mass_kg_);
  mass_.add({{0.0, 0.0, 1.0}}, chassis_inertia_kgm2_);
  for (std::size_t i = 0; i < swivels_.size(); ++i) {
    const int swivel = static_cast<int>(i);
    swivel_turn_[i] = turnBy(heading_[i]);
    pivot_[i] = turned(swivels_[i].chassis_p_pivot, -1);
    const Vector2d com = swivelCom(swivel);
    mass_.add(direction(com, Vector2d::UnitX(), swivel), swivels_[i].mass_kg);
    mass_.add(direction(com, Vector2d::UnitY(), swivel), swivels_[i].mass_kg);
    mass_.addSwivelInertia(swivel, swivels_[i].inertia_kgm2);
  }
}

void PlanarBody::enter(double step_s, PlanarSolver& solver) {
  mass_.factor();
  address_ = solver.addBody(static_cast<int>(velocity_.size()));
  mass_.toIdentity(velocity_.data(), solver.velocity(address_));
  for (std::size_t i = 0; i < swivels_.size(); ++i) {
    const int swivel = static_cast<int>(i);
    const double rate = headingRate(swivel);
    const Vector2d com = swivelCom(swivel);
    const Vector2d impulse =
        step_s * swivels_[i].mass_kg * (yawRate() * yawRate() * pivot_[i] + rate * rate * com);
    applyImpulse(solver, direction(com, Vector2d::UnitX(), swivel), impulse.x());
    applyImpulse(solver, direction(com, Vector2d::UnitY(), swivel), impulse.y());
  }
}

void PlanarBody::leave(double step_s, PlanarSolver& solver) {
  mass_.fromIdentity(solver.velocity(address_), velocity_.data());
  if (isAtRest()) std::fill(velocity_.begin(), velocity_.end(), 0.0);
  position_ += step_s * linearVelocity();
  yaw_ += step_s * yawRate();
  for (std::size_t i = 0; i < heading_.size(); ++i) heading_[i] += step_s * velocity_[3 + i];
}

PlanarAddress PlanarBody::address(int swivel) const {
  return {address_, address_ + (swivel < 0 ? 0 : 3 + swivel)};
}

void PlanarBody::applyImpulse(PlanarSolver& solver, const PlanarDirection& direction,
                              double impulse) const {
  const Eigen::Vector4d j = mass_.toIdentity(direction);
  double* v = solver.velocity(address_);
  for (int i = 0; i < 3; ++i) v[i] += j[i] * impulse;
  if (direction.swivel >= 0) v[3 + direction.swivel] += j[3] * impulse;
}

double PlanarBody::kineticEnergyJ() const {
  double energy_j = 0.5 * chassis_mass_kg_ * linearVelocity().squaredNorm() +
                    0.5 * chassis_inertia_kgm2_ * yawRate() * yawRate();
  for (std::size_t i = 0; i < swivels_.size(); ++i) {
    const int swivel = static_cast<int>(i);
    const double angle = heading_[i];
    const Eigen::Rotation2Dd turn(angle);
    const Vector2d pivot_now = Eigen::Rotation2Dd(yaw_) * swivels_[i].chassis_p_pivot;
    const Vector2d com = turn * swivels_[i].pivot_p_com;
    const double rate = headingRate(swivel);
    const Vector2d velocity = linearVelocity() +
                              yawRate() * Vector2d(-pivot_now.y(), pivot_now.x()) +
                              rate * Vector2d(-com.y(), com.x());
    energy_j += 0.5 * swivels_[i].mass_kg * velocity.squaredNorm() +
                0.5 * swivels_[i].inertia_kgm2 * rate * rate;
  }
  return energy_j;
}

}  // namespace casepush::sim
