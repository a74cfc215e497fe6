#pragma once

#include <Eigen/Core>
#include <vector>

#include "casepush/model/world_model.h"
#include "planar_body.h"

namespace casepush::sim {

/// Something that touched an object from the side, somewhere between two heights.
struct PlanarTouch {
  Eigen::Vector2d map_point = Eigen::Vector2d::Zero();
  double low_m = 0.0;
  double high_m = 0.0;
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();  ///< On the object.
};

/// What an object stands on: wheels, or skids if it has none. Their friction, spin and loads.
class PlanarSupports {
 public:
  PlanarSupports(const PlanarModel& model, const Floor& floor);

  void setLoads(const std::vector<double>& load_n);  ///< By wheel; skids share evenly.
  const std::vector<double>& loadN() const { return load_n_; }
  void setSpin(int wheel, double angle_rad, double rate_rps);
  double spinRad(int wheel) const { return spin_rad_[static_cast<std::size_t>(wheel)]; }
  double spinRps(int wheel) const;
  double spinEnergyJ() const;

  /// After PlanarBody::beginStep(): a rolling wheel spins, which adds to the mass.
  void addMass(PlanarBody& body);
  /// After PlanarBody::enter(): rows, from the impulses of the step before.
  void enter(double step_s, const PlanarBody& body, PlanarSolver& solver);
  /// The loads of an object that stands. @pre addMass() was called.
  void settle(const PlanarBody& body);
  /// After solving: what a contact gave.
  void noteTouch(const PlanarTouch& touch) { touches_.push_back(touch); }
  /// After PlanarBody::leave(): spins and loads. @param gained_mps  Change of the body's velocity.
  void leave(double step_s, const PlanarBody& body, const Eigen::Vector2d& gained_mps,
             const PlanarSolver& solver);

 private:
  struct Wheel {
    PlanarDirection forward;
    PlanarDirection sideways;
  };

  void addCasters(double step_s, const PlanarBody& body, PlanarSolver& solver);
  void addSkids(double step_s, const PlanarBody& body, PlanarSolver& solver);
  void rememberImpulses(const PlanarSolver& solver);
  bool balance(const PlanarBody& body, double lift_n, const Eigen::Vector2d& moment_nm);
  Eigen::Vector2d comMoment(const PlanarBody& body) const;
  Eigen::Vector2d touchMoment(const PlanarBody& body, const Eigen::Vector2d& momentum_ns) const;

  const PlanarModel& model_;
  double friction_;
  double rolling_lever_arm_m_;
  std::vector<Wheel> wheels_;            // In this step.
  std::vector<Eigen::Vector2d> points_;  // From the chassis' centre of mass.
  std::vector<double> spin_mps_;         // Speed of each wheel's rim.
  std::vector<double> spin_rad_;
  std::vector<double> load_n_;
  std::vector<double> equilibrium_n_;
  std::vector<double> impulse_ns_;  // Three for each wheel or skid, in the step before.
  std::size_t first_caster_ = 0;
  std::size_t first_slide_ = 0;
  std::vector<PlanarTouch> touches_;
};

}  // namespace casepush::sim
