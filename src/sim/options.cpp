#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "casepush/sim/simulator.h"

namespace casepush {

const char* toString(CasterModel model) {
  return model == CasterModel::kPlanar ? "planar" : "featherstone";
}

CasterModel casterModelFromString(const std::string& name) {
  for (const CasterModel model : {CasterModel::kFeatherstone, CasterModel::kPlanar}) {
    if (name == toString(model)) return model;
  }
  throw InputError("caster model", "there is no \"" + name + "\"; featherstone or planar");
}

void SimulatorOptions::validate() const {
  Violations violations;
  violations.require("step_s", step_s, 1e-5, 0.02);
  violations.require("solver_iterations", solver_iterations, 1, 10000);
  violations.require("command_timeout_s", command_timeout_s, 0.001, 3600.0);
  violations.throwIfAny("simulator options");
}

}  // namespace casepush
