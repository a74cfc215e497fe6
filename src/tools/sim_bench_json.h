#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "casepush/lab/sim_benchmark.h"
#include "casepush/lab/sim_laws.h"

namespace casepush {

/// Two simulators as distributions, over pushes: `other` is an index into PushOutcomes::others.
nlohmann::ordered_json distributionsJson(const std::vector<PushOutcomes>& pushes,
                                         std::size_t other);

/// Pushes during which the reference leant the object over: the planar model cannot follow there.
bool isTipped(const PushOutcomes& push);

/// Two simulators push by push: differences of outcomes with equal swivels.
nlohmann::ordered_json differencesJson(const std::vector<PushOutcomes>& pushes, std::size_t other);

/// All outcomes of one push.
nlohmann::ordered_json outcomesJson(const Outcomes& outcomes);

/// The experiments of sim_laws.h with one model of casters, for plots.
nlohmann::ordered_json lawsJson(const Catalog& catalog, const SimulatorOptions& options);

}  // namespace casepush
