#pragma once

#include <Eigen/Core>
#include <vector>

namespace casepush::sim {

/// Where a direction's coordinates are among all velocities: `body` and the two after it, `swivel`.
struct PlanarAddress {
  int body = 0;
  int swivel = 0;
};

/// A constraint of one body: its speed goes to `target` as far as `limit` allows [N s].
struct PlanarBound {
  Eigen::Vector4d j = Eigen::Vector4d::Zero();
  double target = 0.0;
  double limit = 0.0;
  double impulse = 0.0;
  double squared = 0.0;  ///< Speed for one unit of impulse, and its inverse; set by the solver.
  double gain = 0.0;
};

/// A drive of the robot.
struct PlanarDrive {
  PlanarAddress at;
  PlanarBound row;
};

/// A wheel and the bearing of its swivel, if it has one that no other wheel has taken.
///
/// Where the bearing holds, the swivel passes the sideways impulse on to the chassis. The two rows
/// share the swivel's small inertia and are almost parallel, so they are solved together.
struct PlanarCaster {
  PlanarAddress at;
  PlanarBound forward;
  PlanarBound sideways;
  PlanarBound bearing;
  double coupling = 0.0;             ///< Of sideways and bearing; set by the solver, as are these:
  double inverse_determinant = 0.0;  ///< 0: no bearing.
};

/// Two constraints of one body whose impulses together are limited: Coulomb friction of a point.
struct PlanarSlide {
  PlanarAddress at;
  PlanarBound x;
  PlanarBound y;  ///< Its limit is that of x.
};

/// A contact of two bodies: separates at `target` or more, with friction across.
struct PlanarContact {
  PlanarAddress a;
  PlanarAddress b;
  Eigen::Vector4d normal_a, normal_b, across_a, across_b;
  double target = 0.0;
  double friction = 0.0;
  double normal_squared = 0.0;  ///< As in PlanarBound.
  double normal_gain = 0.0;
  double across_squared = 0.0;
  double across_gain = 0.0;
  double normal_impulse = 0.0;
  double across_impulse = 0.0;
};

/// Projected Gauss-Seidel over velocities in which every mass is 1.
///
/// Rows start from the impulses they are given (those of the step before); the solver ends early
/// once no speed changes any more.
class PlanarSolver {
 public:
  /// Forgets all rows and velocities. Address 0 belongs to what never moves.
  void clear();

  /// Reserves velocities for a body; returns the address of the first.
  int addBody(int size);
  double* velocity(int address) { return &velocities_[static_cast<std::size_t>(address)]; }

  void add(const PlanarDrive& drive);
  void add(const PlanarCaster& caster);
  void add(const PlanarSlide& slide);
  void add(const PlanarContact& contact);

  void solve(int iterations);

  /// In the order of adding.
  const std::vector<PlanarDrive>& drives() const { return drives_; }
  const std::vector<PlanarCaster>& casters() const { return casters_; }
  const std::vector<PlanarSlide>& slides() const { return slides_; }
  const std::vector<PlanarContact>& contacts() const { return contacts_; }

 private:
  void orderCasters();
  void applyStart();
  double sweep();

  std::vector<double> velocities_;
  std::vector<PlanarDrive> drives_;
  std::vector<PlanarCaster> casters_;
  std::vector<PlanarSlide> slides_;
  std::vector<PlanarContact> contacts_;
  std::vector<std::size_t> first_caster_;  // Of each body.
  std::vector<std::size_t> order_;         // Of casters: one of each body in turn.
};

}  // namespace casepush::sim
