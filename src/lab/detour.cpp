#include "casepush/lab/detour.h"

#include <cmath>
#include <limits>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Below the first one there is hardly any detour: the obstacles leave room beside them.
constexpr double kEdges[] = {0.0, 1.25, 2.0, 3.0, 4.0, kInfinity};

DetourBin binOf(const std::vector<ObstaclePair>& pairs, double from, double to,
                std::uint64_t seed) {
  DetourBin bin;
  bin.from = from;
  bin.to = to;
  std::vector<double> stationary_s, movable_s;
  for (const ObstaclePair& pair : pairs) {
    const double detour = pair.detour();
    if (detour < from || (detour >= to && !std::isinf(to))) continue;
    if (!pair.succeeded || std::isinf(detour)) {
      ++bin.failed;
      continue;
    }
    ++bin.pairs;
    bin.detour += detour;
    bin.around_m += pair.around_m;
    bin.through_m += pair.through_m;
    bin.stationary_s += pair.stationary_s;
    bin.movable_s += pair.movable_s;
    stationary_s.push_back(pair.stationary_s);
    movable_s.push_back(pair.movable_s);
  }
  if (bin.pairs == 0) return bin;
  for (double DetourBin::*sum : {&DetourBin::detour, &DetourBin::around_m, &DetourBin::through_m,
                                 &DetourBin::stationary_s, &DetourBin::movable_s}) {
    bin.*sum /= bin.pairs;
  }
  bin.ratio = bootstrapRatio(stationary_s, movable_s, seed);
  return bin;
}

}  // namespace

double ObstaclePair::detour() const {
  return std::isinf(around_m + through_m) ? kInfinity : around_m / through_m;
}

std::vector<ObstaclePair> obstaclePairs(const std::vector<TaskRun>& stationary,
                                        const std::vector<TaskRun>& movable) {
  CASEPUSH_CHECK(stationary.size() == movable.size(), stationary.size()
                                                          << " and " << movable.size() << " tasks");
  std::vector<ObstaclePair> pairs;
  for (std::size_t i = 0; i < stationary.size(); ++i) {
    pairs.push_back({stationary[i].seed, shortestM(stationary[i].plans),
                     shortestM(movable[i].plans), stationary[i].result.sim_time_s,
                     movable[i].result.sim_time_s,
                     stationary[i].result.success && movable[i].result.success});
  }
  return pairs;
}

std::vector<DetourBin> binByDetour(const std::vector<ObstaclePair>& pairs, std::uint64_t seed) {
  std::vector<DetourBin> bins = {binOf(pairs, 0.0, kInfinity, seed)};
  for (std::size_t k = 0; k + 1 < std::size(kEdges); ++k) {
    bins.push_back(binOf(pairs, kEdges[k], kEdges[k + 1], seed));
  }
  return bins;
}

}  // namespace casepush
