#include "planar_solver.h"

#include <algorithm>
#include <cmath>

namespace casepush::sim {
namespace {

using Eigen::Vector4d;

// Greatest change of any row's speed at which the solution counts as found [m/s, rad/s].
constexpr double kConverged = 1e-7;

// The four velocities that a row of one body acts on, in registers for as long as they are needed.
struct Local {
  double y0, y1, y2, zeta;

  Local(const double* v, PlanarAddress at)
      : y0(v[at.body]), y1(v[at.body + 1]), y2(v[at.body + 2]), zeta(v[at.swivel]) {}

  void store(double* v, PlanarAddress at) const {
    v[at.swivel] = zeta;
    v[at.body] = y0;  // Last: without a swivel both addresses are the same.
    v[at.body + 1] = y1;
    v[at.body + 2] = y2;
  }
  double speed(const Vector4d& j) const {
    return (j[0] * y0 + j[1] * y1) + (j[2] * y2 + j[3] * zeta);
  }
  void push(const Vector4d& j, double impulse) {
    y0 += j[0] * impulse;
    y1 += j[1] * impulse;
    y2 += j[2] * impulse;
    zeta += j[3] * impulse;
  }
};

double clampTo(double value, double limit) { return std::min(std::max(value, -limit), limit); }

void setGain(PlanarBound& row) {
  row.squared = row.j.squaredNorm();
  row.gain = row.squared > 0.0 ? 1.0 / row.squared : 0.0;
}

// These return the change of speed in the row's direction.
inline double solveRow(Local& v, PlanarBound& row) {
  const double wanted = row.impulse + (row.target - v.speed(row.j)) * row.gain;
  const double change = clampTo(wanted, row.limit) - row.impulse;
  row.impulse += change;
  v.push(row.j, change);
  return std::abs(change) * row.squared;
}

// Minimises a convex quadratic in two bounded impulses, as LCP: a row inside of its bounds has no
// residual speed, one at a bound has one that would push it further out.
inline double solvePair(Local& v, PlanarCaster& caster) {
  PlanarBound& a = caster.sideways;
  PlanarBound& b = caster.bearing;
  const double residual_a = a.target - v.speed(a.j);
  const double residual_b = b.target - v.speed(b.j);
  const double aa = a.squared;
  const double bb = b.squared;
  const double ab = caster.coupling;
  double change_a = (bb * residual_a - ab * residual_b) * caster.inverse_determinant;
  double change_b = (aa * residual_b - ab * residual_a) * caster.inverse_determinant;
  if (std::abs(a.impulse + change_a) > a.limit || std::abs(b.impulse + change_b) > b.limit) {
    // The bearing slips: that is the rule for a wheel that has not found its way yet.
    const auto fixBearing = [&](double impulse) {
      change_b = impulse - b.impulse;
      change_a = clampTo(a.impulse + (residual_a - ab * change_b) * a.gain, a.limit) - a.impulse;
      return residual_b - ab * change_a - bb * change_b;  // Left over.
    };
    const bool slips = fixBearing(b.limit) >= 0.0 || fixBearing(-b.limit) <= 0.0;
    if (!slips) {
      // The bearing holds, so the wheel slips sideways.
      const auto fixWheel = [&](double impulse) {
        change_a = impulse - a.impulse;
        change_b = clampTo(b.impulse + (residual_b - ab * change_a) * b.gain, b.limit) - b.impulse;
        return residual_a - ab * change_b - aa * change_a;
      };
      if (fixWheel(a.limit) < 0.0) fixWheel(-a.limit);
    }
  }
  a.impulse += change_a;
  b.impulse += change_b;
  v.push(a.j, change_a);
  v.push(b.j, change_b);
  return std::max(std::abs(aa * change_a + ab * change_b), std::abs(ab * change_a + bb * change_b));
}

double solveCaster(double* velocities, PlanarCaster& caster) {
  Local v(velocities, caster.at);
  double change = solveRow(v, caster.forward);
  change = std::max(change, caster.inverse_determinant > 0.0 ? solvePair(v, caster)
                                                             : solveRow(v, caster.sideways));
  v.store(velocities, caster.at);
  return change;
}

double solveDrive(double* velocities, PlanarDrive& drive) {
  Local v(velocities, drive.at);
  const double change = solveRow(v, drive.row);
  v.store(velocities, drive.at);
  return change;
}

double solveSlide(double* velocities, PlanarSlide& slide) {
  Local v(velocities, slide.at);
  double x = slide.x.impulse + (slide.x.target - v.speed(slide.x.j)) * slide.x.gain;
  double y = slide.y.impulse + (slide.y.target - v.speed(slide.y.j)) * slide.y.gain;
  const double size = std::sqrt(x * x + y * y);
  if (size > slide.x.limit) {
    x *= slide.x.limit / size;
    y *= slide.x.limit / size;
  }
  const double change_x = x - slide.x.impulse;
  const double change_y = y - slide.y.impulse;
  slide.x.impulse = x;
  slide.y.impulse = y;
  v.push(slide.x.j, change_x);
  v.push(slide.y.j, change_y);
  v.store(velocities, slide.at);
  return std::max(std::abs(change_x) * slide.x.squared, std::abs(change_y) * slide.y.squared);
}

void push(double* velocities, PlanarAddress at, const Vector4d& j, double impulse) {
  Local v(velocities, at);
  v.push(j, impulse);
  v.store(velocities, at);
}

double solveContact(double* velocities, PlanarContact& c) {
  Local a(velocities, c.a);
  Local b(velocities, c.b);
  const double approach = a.speed(c.normal_a) + b.speed(c.normal_b);
  const double normal = std::max(0.0, c.normal_impulse + (c.target - approach) * c.normal_gain);
  const double normal_change = normal - c.normal_impulse;
  c.normal_impulse = normal;
  a.push(c.normal_a, normal_change);
  b.push(c.normal_b, normal_change);

  const double slip = a.speed(c.across_a) + b.speed(c.across_b);
  const double across_change =
      clampTo(c.across_impulse - slip * c.across_gain, c.friction * normal) - c.across_impulse;
  c.across_impulse += across_change;
  a.push(c.across_a, across_change);
  b.push(c.across_b, across_change);
  a.store(velocities, c.a);
  b.store(velocities, c.b);
  return std::max(std::abs(normal_change) * c.normal_squared,
                  std::abs(across_change) * c.across_squared);
}

}  // namespace

void PlanarSolver::clear() {
  velocities_.assign(3, 0.0);
  drives_.clear();
  casters_.clear();
  slides_.clear();
  contacts_.clear();
  first_caster_.clear();
}

int PlanarSolver::addBody(int size) {
  const int address = static_cast<int>(velocities_.size());
  velocities_.resize(velocities_.size() + static_cast<std::size_t>(size), 0.0);
  first_caster_.push_back(casters_.size());
  return address;
}

void PlanarSolver::add(const PlanarDrive& drive) {
  drives_.push_back(drive);
  setGain(drives_.back().row);
}

void PlanarSolver::add(const PlanarCaster& caster) {
  casters_.push_back(caster);
  PlanarCaster& c = casters_.back();
  for (PlanarBound* row : {&c.forward, &c.sideways, &c.bearing}) {
    setGain(*row);
    row->impulse = clampTo(row->impulse, row->limit);
  }
  if (c.bearing.gain <= 0.0) return;
  c.coupling = c.sideways.j.dot(c.bearing.j);
  c.inverse_determinant = 1.0 / (c.sideways.squared * c.bearing.squared - c.coupling * c.coupling);
}

void PlanarSolver::add(const PlanarSlide& slide) {
  slides_.push_back(slide);
  setGain(slides_.back().x);
  setGain(slides_.back().y);
}

void PlanarSolver::add(const PlanarContact& contact) {
  contacts_.push_back(contact);
  PlanarContact& c = contacts_.back();
  c.normal_squared = c.normal_a.squaredNorm() + c.normal_b.squaredNorm();
  c.normal_gain = 1.0 / c.normal_squared;
  c.across_squared = c.across_a.squaredNorm() + c.across_b.squaredNorm();
  c.across_gain = 1.0 / c.across_squared;
}

void PlanarSolver::solve(int iterations) {
  orderCasters();
  applyStart();
  for (int i = 0; i < iterations; ++i) {
    if (sweep() < kConverged) return;
  }
}

// Rows of one body wait for each other, those of different bodies do not: taking turns lets the
// processor work on several at a time.
void PlanarSolver::orderCasters() {
  order_.clear();
  for (std::size_t turn = 0; order_.size() < casters_.size(); ++turn) {
    for (std::size_t body = 0; body < first_caster_.size(); ++body) {
      const std::size_t end =
          body + 1 < first_caster_.size() ? first_caster_[body + 1] : casters_.size();
      if (first_caster_[body] + turn < end) order_.push_back(first_caster_[body] + turn);
    }
  }
}

void PlanarSolver::applyStart() {
  double* v = velocities_.data();
  for (const PlanarDrive& drive : drives_) push(v, drive.at, drive.row.j, drive.row.impulse);
  for (const PlanarCaster& caster : casters_) {
    for (const PlanarBound* row : {&caster.forward, &caster.sideways, &caster.bearing}) {
      push(v, caster.at, row->j, row->impulse);
    }
  }
  for (const PlanarSlide& slide : slides_) {
    push(v, slide.at, slide.x.j, slide.x.impulse);
    push(v, slide.at, slide.y.j, slide.y.impulse);
  }
  for (const PlanarContact& c : contacts_) {
    push(v, c.a, c.normal_a, c.normal_impulse);
    push(v, c.b, c.normal_b, c.normal_impulse);
    push(v, c.a, c.across_a, c.across_impulse);
    push(v, c.b, c.across_b, c.across_impulse);
  }
}

double PlanarSolver::sweep() {
  double* v = velocities_.data();
  double change = 0.0;
  for (PlanarDrive& drive : drives_) change = std::max(change, solveDrive(v, drive));
  for (const std::size_t i : order_) change = std::max(change, solveCaster(v, casters_[i]));
  for (PlanarSlide& slide : slides_) change = std::max(change, solveSlide(v, slide));
  for (PlanarContact& contact : contacts_) change = std::max(change, solveContact(v, contact));
  return change;
}

}  // namespace casepush::sim
