#include "planar_solver.h"

#include <algorithm>
#include <cmath>

namespace casepush::sim {
namespace {

// Greatest change of any row's speed at which the solution counts as found.
constexpr double kConverged_mps = 1e-8;

double speed(const double* v, PlanarAddress at, const Eigen::Vector4d& j) {
  return j[0] * v[at.body] + j[1] * v[at.body + 1] + j[2] * v[at.body + 2] + j[3] * v[at.swivel];
}

void push(double* v, PlanarAddress at, const Eigen::Vector4d& j, double impulse) {
  v[at.body] += j[0] * impulse;
  v[at.body + 1] += j[1] * impulse;
  v[at.body + 2] += j[2] * impulse;
  v[at.swivel] += j[3] * impulse;
}

double gainOf(double squared_norm) { return squared_norm > 0.0 ? 1.0 / squared_norm : 0.0; }

// Each returns the greatest change of speed.
double solveRow(double* v, PlanarBound& row) {
  const double wanted = row.impulse + (row.target - speed(v, row.at, row.j)) * row.gain;
  const double change = std::min(std::max(wanted, -row.limit), row.limit) - row.impulse;
  row.impulse += change;
  push(v, row.at, row.j, change);
  return std::abs(change) / row.gain;
}

double solveSlide(double* v, PlanarSlide& slide) {
  double x = slide.x.impulse + (slide.x.target - speed(v, slide.x.at, slide.x.j)) * slide.x.gain;
  double y = slide.y.impulse + (slide.y.target - speed(v, slide.y.at, slide.y.j)) * slide.y.gain;
  const double size = std::sqrt(x * x + y * y);
  if (size > slide.x.limit) {
    x *= slide.x.limit / size;
    y *= slide.x.limit / size;
  }
  const double change_x = x - slide.x.impulse;
  const double change_y = y - slide.y.impulse;
  slide.x.impulse = x;
  slide.y.impulse = y;
  push(v, slide.x.at, slide.x.j, change_x);
  push(v, slide.y.at, slide.y.j, change_y);
  return std::max(std::abs(change_x) / slide.x.gain, std::abs(change_y) / slide.y.gain);
}

double solveContact(double* v, PlanarContact& c) {
  const double approach = speed(v, c.a, c.normal_a) + speed(v, c.b, c.normal_b);
  const double normal = std::max(0.0, c.normal_impulse + (c.target - approach) * c.normal_gain);
  const double normal_change = normal - c.normal_impulse;
  c.normal_impulse = normal;
  push(v, c.a, c.normal_a, normal_change);
  push(v, c.b, c.normal_b, normal_change);

  const double limit = c.friction * normal;
  const double slip = speed(v, c.a, c.across_a) + speed(v, c.b, c.across_b);
  const double wanted = c.across_impulse - slip * c.across_gain;
  const double across_change = std::min(std::max(wanted, -limit), limit) - c.across_impulse;
  c.across_impulse += across_change;
  push(v, c.a, c.across_a, across_change);
  push(v, c.b, c.across_b, across_change);
  return std::max(std::abs(normal_change) / c.normal_gain, std::abs(across_change) / c.across_gain);
}

}  // namespace

void PlanarSolver::clear() {
  velocities_.assign(3, 0.0);
  bounds_.clear();
  slides_.clear();
  contacts_.clear();
}

int PlanarSolver::addBody(int size) {
  const int address = static_cast<int>(velocities_.size());
  velocities_.resize(velocities_.size() + static_cast<std::size_t>(size), 0.0);
  return address;
}

void PlanarSolver::add(const PlanarBound& row) {
  bounds_.push_back(row);
  bounds_.back().gain = gainOf(row.j.squaredNorm());
}

void PlanarSolver::add(const PlanarSlide& slide) {
  slides_.push_back(slide);
  slides_.back().x.gain = gainOf(slide.x.j.squaredNorm());
  slides_.back().y.gain = gainOf(slide.y.j.squaredNorm());
}

void PlanarSolver::add(const PlanarContact& contact) {
  contacts_.push_back(contact);
  PlanarContact& c = contacts_.back();
  c.normal_gain = gainOf(c.normal_a.squaredNorm() + c.normal_b.squaredNorm());
  c.across_gain = gainOf(c.across_a.squaredNorm() + c.across_b.squaredNorm());
}

void PlanarSolver::solve(int iterations) {
  double* v = velocities_.data();
  for (PlanarBound& row : bounds_) {
    row.impulse = std::clamp(row.impulse, -row.limit, row.limit);
    push(v, row.at, row.j, row.impulse);
  }
  for (const PlanarSlide& slide : slides_) {
    push(v, slide.x.at, slide.x.j, slide.x.impulse);
    push(v, slide.y.at, slide.y.j, slide.y.impulse);
  }
  for (const PlanarContact& c : contacts_) {
    push(v, c.a, c.normal_a, c.normal_impulse);
    push(v, c.b, c.normal_b, c.normal_impulse);
    push(v, c.a, c.across_a, c.across_impulse);
    push(v, c.b, c.across_b, c.across_impulse);
  }
  for (int i = 0; i < iterations; ++i) {
    if (sweep() < kConverged_mps) return;
  }
}

double PlanarSolver::sweep() {
  double* v = velocities_.data();
  double change = 0.0;
  for (PlanarBound& row : bounds_) change = std::max(change, solveRow(v, row));
  for (PlanarSlide& slide : slides_) change = std::max(change, solveSlide(v, slide));
  for (PlanarContact& contact : contacts_) change = std::max(change, solveContact(v, contact));
  return change;
}

}  // namespace casepush::sim
