#pragma once

#include <Eigen/Core>
#include <vector>

namespace casepush::sim {

/// Where a direction's coordinates are among all velocities: `body` and the two after it, `swivel`.
struct PlanarAddress {
  int body = 0;
  int swivel = 0;
};

/// A constraint on one body: its speed goes to `target` as far as `limit` allows [N s].
struct PlanarBound {
  PlanarAddress at;
  Eigen::Vector4d j;
  double target = 0.0;
  double limit = 0.0;
  double impulse = 0.0;
  double gain = 0.0;  ///< Impulse for one unit of speed.
};

/// Two constraints on one body whose impulses together are limited: Coulomb friction of a point.
struct PlanarSlide {
  PlanarBound x;
  PlanarBound y;
};

/// A contact of two bodies: separates at `target` or more, with friction across.
struct PlanarContact {
  PlanarAddress a;
  PlanarAddress b;
  Eigen::Vector4d normal_a, normal_b, across_a, across_b;
  double target = 0.0;
  double friction = 0.0;
  double normal_gain = 0.0;
  double across_gain = 0.0;
  double normal_impulse = 0.0;
  double across_impulse = 0.0;
};

/// Projected Gauss-Seidel over velocities in which every mass is 1.
///
/// Rows start from the impulses they are given (those of the step before) and end early once no
/// speed changes any more.
class PlanarSolver {
 public:
  /// Forgets all rows and velocities. Address 0 belongs to what never moves.
  void clear();

  /// Reserves velocities for a body; returns the address of the first.
  int addBody(int size);
  double* velocity(int address) { return &velocities_[static_cast<std::size_t>(address)]; }

  void add(const PlanarBound& row);
  void add(const PlanarSlide& slide);
  void add(const PlanarContact& contact);

  void solve(int iterations);

  /// In the order of adding.
  const std::vector<PlanarBound>& bounds() const { return bounds_; }
  const std::vector<PlanarSlide>& slides() const { return slides_; }
  const std::vector<PlanarContact>& contacts() const { return contacts_; }

 private:
  double sweep();

  std::vector<double> velocities_;
  std::vector<PlanarBound> bounds_;
  std::vector<PlanarSlide> slides_;
  std::vector<PlanarContact> contacts_;
};

}  // namespace casepush::sim
