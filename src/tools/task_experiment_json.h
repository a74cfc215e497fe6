#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "casepush/lab/task_experiment.h"

namespace casepush {

/// {"rejected_prediction": 3, ...}: causes that occurred.
nlohmann::ordered_json replanCausesJson(const ReplanCounts& causes);

/// What a set of tasks came to: successes with their interval, how the others ended, pushes,
/// re-plans and their causes, times, contacts with walls and furniture. Wall times are left out.
nlohmann::ordered_json taskRunsJson(const std::vector<TaskRun>& runs);

}  // namespace casepush
