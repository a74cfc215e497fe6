#include "planar_supports.h"

#include <algorithm>
#include <cmath>

#include "furniture.h"
#include "wheel_loads.h"

namespace casepush::sim {
namespace {

using Eigen::Vector2d;

Vector2d leftOf(const Vector2d& v) { return {-v.y(), v.x()}; }

}  // namespace

PlanarSupports::PlanarSupports(const PlanarModel& model, const Floor& floor)
    : model_(model),
      friction_(floor.friction),
      rolling_lever_arm_m_(floor.rolling_lever_arm_m),
      wheels_(model.wheels.size()),
      points_(model.wheels.size() + model.skids.size()),
      spin_mps_(model.wheels.size(), 0.0),
      spin_rad_(model.wheels.size(), 0.0),
      equilibrium_n_(points_.size()),
      impulse_ns_(3 * points_.size(), 0.0) {}

void PlanarSupports::setLoads(const std::vector<double>& load_n) {
  load_n_ = load_n;
  load_n_.resize(points_.size(),
                 model_.mass_kg * kGravity_mps2 / static_cast<double>(points_.size()));
}

void PlanarSupports::setSpin(int wheel, double angle_rad, double rate_rps) {
  const auto i = static_cast<std::size_t>(wheel);
  spin_rad_[i] = angle_rad;
  spin_mps_[i] = rate_rps * model_.wheels[i].radius_m;
}

double PlanarSupports::spinRps(int wheel) const {
  const auto i = static_cast<std::size_t>(wheel);
  return spin_mps_[i] / model_.wheels[i].radius_m;
}

double PlanarSupports::spinEnergyJ() const {
  double energy_j = 0.0;
  for (std::size_t i = 0; i < spin_mps_.size(); ++i) {
    energy_j += 0.5 * model_.wheels[i].spin_mass_kg * spin_mps_[i] * spin_mps_[i];
  }
  return energy_j;
}

void PlanarSupports::addMass(PlanarBody& body) {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const PlanarWheel& wheel = model_.wheels[i];
    const Vector2d contact = body.turned(wheel.contact_m, wheel.swivel);
    const Vector2d forward = body.turned(wheel.rolling, wheel.swivel);
    wheels_[i].forward = body.direction(contact, forward, wheel.swivel);
    wheels_[i].sideways = body.direction(contact, leftOf(forward), wheel.swivel);
    points_[i] = wheel.swivel < 0 ? contact : Vector2d(contact + body.pivot(wheel.swivel));
    body.mass().add(wheels_[i].forward, wheel.spin_mass_kg);
  }
  for (std::size_t i = 0; i < model_.skids.size(); ++i) {
    points_[i] = body.turned(model_.skids[i], -1);
  }
}

void PlanarSupports::enter(double step_s, const PlanarBody& body, PlanarSolver& solver) {
  touches_.clear();
  first_caster_ = solver.casters().size();
  first_slide_ = solver.slides().size();
  // The mass holds wheels that spin as their contact rolls. A wheel whose contact has turned since
  // spins differently: the difference is an impulse along its new way.
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const double lag_mps = spin_mps_[i] - body.speed(wheels_[i].forward);
    body.applyImpulse(solver, wheels_[i].forward, model_.wheels[i].spin_mass_kg * lag_mps);
  }
  addCasters(step_s, body, solver);
  addSkids(step_s, body, solver);
}

void PlanarSupports::addCasters(double step_s, const PlanarBody& body, PlanarSolver& solver) {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const PlanarWheel& wheel = model_.wheels[i];
    const double torque_nm = rolling_lever_arm_m_ * load_n_[i] + wheel.friction_nm;
    PlanarCaster caster;
    caster.at = body.address(wheel.swivel);
    caster.forward.j = body.coordinates(wheels_[i].forward);
    caster.forward.limit = torque_nm / wheel.radius_m * step_s;
    caster.sideways.j = body.coordinates(wheels_[i].sideways);
    caster.sideways.limit = friction_ * load_n_[i] * step_s;
    if (wheel.holds_bearing) {
      PlanarDirection turning;  // Relative to the chassis.
      turning.chassis << 0.0, 0.0, -1.0;
      turning.swivel = wheel.swivel;
      turning.swivel_rate = 1.0;
      caster.bearing.j = body.coordinates(turning);
      caster.bearing.limit =
          model_.swivels[static_cast<std::size_t>(wheel.swivel)].friction_nm * step_s;
    }
    caster.forward.impulse = impulse_ns_[3 * i];
    caster.sideways.impulse = impulse_ns_[3 * i + 1];
    caster.bearing.impulse = impulse_ns_[3 * i + 2];
    solver.add(caster);
  }
}

void PlanarSupports::addSkids(double step_s, const PlanarBody& body, PlanarSolver& solver) {
  for (std::size_t i = 0; i < model_.skids.size(); ++i) {
    PlanarSlide slide;
    slide.at = body.address(-1);
    slide.x.j = body.coordinates(body.direction(points_[i], Vector2d::UnitX(), -1));
    slide.y.j = body.coordinates(body.direction(points_[i], Vector2d::UnitY(), -1));
    slide.x.limit = slide.y.limit = friction_ * load_n_[i] * step_s;
    slide.x.impulse = impulse_ns_[3 * i];
    slide.y.impulse = impulse_ns_[3 * i + 1];
    solver.add(slide);
  }
}

// Faces bear on each other where the object does not tilt away from the other one: at the height
// that leaves the loads as they are or, if that is out of reach, at the nearer edge. What is pushed
// steadily tilts away above, so that the lowest points bear.
Vector2d PlanarSupports::touchMoment(const PlanarBody& body, const Vector2d& momentum_ns) const {
  Vector2d sum_ns = Vector2d::Zero();
  for (const PlanarTouch& touch : touches_) sum_ns += touch.impulse_ns.head<2>();
  const double squared = sum_ns.squaredNorm();
  const double level_m =
      squared > 0.0 ? model_.com_height_m * momentum_ns.dot(sum_ns) / squared : 0.0;
  Vector2d moment = Vector2d::Zero();
  for (const PlanarTouch& touch : touches_) {
    const double height_m = std::clamp(level_m, touch.low_m, touch.high_m);
    moment += height_m * touch.impulse_ns.head<2>() -
              touch.impulse_ns.z() * (touch.map_point - body.position());
  }
  return moment;
}

Vector2d PlanarSupports::comMoment(const PlanarBody& body) const {
  Vector2d moment = Vector2d::Zero();
  for (std::size_t i = 0; i < model_.swivels.size(); ++i) {
    const int swivel = static_cast<int>(i);
    moment += model_.swivels[i].mass_kg * (body.pivot(swivel) + body.swivelCom(swivel));
  }
  return moment;
}

void PlanarSupports::leave(double step_s, const PlanarBody& body, const Vector2d& gained_mps,
                           const PlanarSolver& solver) {
  rememberImpulses(solver);
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    spin_mps_[i] = body.speed(wheels_[i].forward);
    spin_rad_[i] += step_s * spin_mps_[i] / model_.wheels[i].radius_m;
  }
  const Vector2d momentum_ns = model_.mass_kg * gained_mps;
  const Vector2d moment_nm =
      (touchMoment(body, momentum_ns) - model_.com_height_m * momentum_ns) / step_s;
  double lift_ns = 0.0;
  for (const PlanarTouch& touch : touches_) lift_ns += touch.impulse_ns.z();
  if (!balance(body, lift_ns / step_s, moment_nm)) return;
  const double gain = body.isAtRest() ? 1.0 : -std::expm1(-step_s / kLoadSmoothing_s);
  for (std::size_t i = 0; i < load_n_.size(); ++i) {
    load_n_[i] += gain * (equilibrium_n_[i] - load_n_[i]);
  }
}

void PlanarSupports::settle(const PlanarBody& body) {
  if (balance(body, 0.0, Vector2d::Zero())) load_n_ = equilibrium_n_;
}

// Balance of moments about the floor: weight, and what contacts and inertia add to it.
bool PlanarSupports::balance(const PlanarBody& body, double lift_n, const Vector2d& moment_nm) {
  const double load_n = std::max(0.0, model_.mass_kg * kGravity_mps2 - lift_n);
  return shareLoad(points_, load_n, kGravity_mps2 * comMoment(body) + moment_nm, equilibrium_n_);
}

void PlanarSupports::rememberImpulses(const PlanarSolver& solver) {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const PlanarCaster& caster = solver.casters()[first_caster_ + i];
    impulse_ns_[3 * i] = caster.forward.impulse;
    impulse_ns_[3 * i + 1] = caster.sideways.impulse;
    impulse_ns_[3 * i + 2] = caster.bearing.impulse;
  }
  for (std::size_t i = 0; i < model_.skids.size(); ++i) {
    impulse_ns_[3 * i] = solver.slides()[first_slide_ + i].x.impulse;
    impulse_ns_[3 * i + 1] = solver.slides()[first_slide_ + i].y.impulse;
  }
}

}  // namespace casepush::sim
