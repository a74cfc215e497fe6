#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "casepush/lab/detour.h"

namespace casepush {

/// How plans for the same rooms spread (Fig. 11 of the paper): nodes, length and pushes, each with
/// its mean, standard deviation, and that within a room.
nlohmann::ordered_json planTrialsJson(const std::vector<TaskRun>& runs);

/// The same of their CPU time [s].
nlohmann::ordered_json planTimesJson(const std::vector<TaskRun>& runs);

/// One object for each pair.
nlohmann::ordered_json pairsJson(const std::vector<ObstaclePair>& pairs);

/// One object for each bin.
nlohmann::ordered_json detourJson(const std::vector<DetourBin>& bins);

/// @param rows  With planTrialsJson() as "plans". @param times  planTimesJson() of each.
void printPlanTrials(const nlohmann::ordered_json& rows, const nlohmann::ordered_json& times);

void printDetours(const std::vector<DetourBin>& bins);

}  // namespace casepush
