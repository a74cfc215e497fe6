#pragma once

#include <functional>
#include <string>
#include <vector>

#include "casepush/model/catalog.h"
#include "casepush/sim/simulator.h"

namespace casepush {

/// Which simulators to compare on the same pushes, and how many pushes.
struct OutcomeComparisonOptions {
  std::string object = "office_chair";
  std::string robot = "cobot";
  int pushes = 200;
  int swivels = 20;  ///< Draws of the casters' angles for each push; the same for all simulators.
  std::uint64_t seed = 1;
  int jobs = 1;  ///< Threads; the result does not depend on it.
  SimulatorOptions reference;
  std::vector<SimulatorOptions> others;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// Where an object came to rest after one push: x, y [m] and yaw [rad, with whole turns] in its
/// start frame, for each draw of swivel angles.
using Outcomes = std::vector<Eigen::Vector3d>;

struct PushOutcomes {
  Outcomes reference;
  double tilt_rad = 0.0;  ///< Most that the object leant over in any run of the reference.
  std::vector<Outcomes> others;  ///< By simulator.
};

struct OutcomeMoments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double position_sigma_m = 0.0;  ///< Root of the covariance's trace.
  double yaw_sigma_rad = 0.0;
};

/// @pre at least two outcomes.
OutcomeMoments momentsOf(const Outcomes& outcomes);

/// Random straight and curved pushes of 1 to 3 s from contact distance, each with random swivels.
///
/// Single outcomes may differ widely where a caster flips to one side or the other, so that only
/// distributions can be compared.
/// @param progress  Called with the number of finished pushes.
/// @throws InputError from the catalog and the simulator.
std::vector<PushOutcomes> compareOutcomes(const Catalog& catalog,
                                          const OutcomeComparisonOptions& options,
                                          const std::function<void(int)>& progress = {});

/// How fast a simulator is on one core, by the thread's CPU time.
struct SimSpeed {
  double pushing_all = 0.0;   ///< Simulated seconds per second: the robot pushes four objects.
  double pushing_one = 0.0;   ///< It pushes one, three stand.
  double driving = 0.0;       ///< The robot drives, the objects stand.
  double recreation_s = 0.0;  ///< Time to build the world anew with a body put elsewhere.
};

/// Robot, four objects, four walls and six boxes.
SimSpeed measureSimSpeed(const Catalog& catalog, const std::string& object,
                         const std::string& robot, const SimulatorOptions& options,
                         double simulated_s);

/// What the sensors of a world's robot cost, by the thread's CPU time.
struct SensorCost {
  double ray_s = 0.0;           ///< One ray of a range sensor.
  double image_s = 0.0;         ///< One image of a tag camera.
  double scanning_share = 0.0;  ///< CPU time of all range sensors per simulated second.
};

SensorCost measureSensorCost(const Catalog& catalog, const std::string& world_name,
                             double simulated_s);

}  // namespace casepush
