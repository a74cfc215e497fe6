#pragma once

#include <vector>

#include "casepush/model/catalog.h"
#include "casepush/sim/simulator.h"

namespace casepush {

/// A loaded utility cart: what experiments with closed forms are made with.
struct LawCart {
  double mass_kg = 40.0;  ///< With its casters; the load is spread as the cart's own mass.
  double wheel_radius_m = 0.05;
  double rolling_lever_arm_m = 0.0024;  ///< Of the floor.
  double weightN() const;
  /// Of the law F = f W / r [N].
  double rollingResistanceN() const;
};

/// Force that a flat-faced robot exerts on the cart, once its casters trail: the sum of contact
/// impulses over one second [N].
double measureSteadyForce(const Catalog& catalog, const LawCart& cart,
                          const SimulatorOptions& options);

struct ForceSample {
  double moved_m = 0.0;  ///< By the cart, since its start.
  double force_n = 0.0;  ///< Mean over a tenth of a second.
};

/// Force while the cart is started gently along its length, after it was rolled there (casters
/// trail) or rolled sideways (they stand across).
std::vector<ForceSample> measureStart(const Catalog& catalog, const LawCart& cart, bool across,
                                      const SimulatorOptions& options);

struct CoastSample {
  double time_s = 0.0;
  double moved_m = 0.0;
  double speed_mps = 0.0;
};

/// The cart after the robot has let go of it, with trailing casters, until it stands.
std::vector<CoastSample> measureCoast(const Catalog& catalog, const LawCart& cart,
                                      const SimulatorOptions& options);
/// v0^2 / (2 a), where f W / r slows down the cart's mass and its wheels' spin [m].
double coastDistance(const Catalog& catalog, const LawCart& cart, double speed_mps);

struct TrailSample {
  double moved_m = 0.0;
  std::vector<double> swivel_rad;  ///< By caster: of the wheel's way against the cart's length.
};

/// Casters that start at random while the robot pushes the cart straight on for 0.8 m or more.
std::vector<TrailSample> measureTrailing(const Catalog& catalog, const LawCart& cart,
                                         const SimulatorOptions& options);

}  // namespace casepush
