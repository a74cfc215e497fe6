#include "casepush/cases/shortened_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr std::array<double, 2> kShares = {0.0, 0.45};
constexpr double kFullSpeed = 0.95;  // Of the fastest step.
constexpr double kSlid_m = 0.04;
constexpr double kSlid_rad = 0.15;

/// The steps at full speed: [first, last].
std::pair<int, int> fullSpeedSteps(const Case& push_case) {
  double fastest_mps = 0.0;
  for (int i = 0; i < push_case.push_steps; ++i) {
    fastest_mps = std::max(fastest_mps, push_case.steps[i].action.speed());
  }
  int first = push_case.push_steps;
  int last = 0;
  for (int i = 0; i < push_case.push_steps; ++i) {
    if (push_case.steps[i].action.speed() < kFullSpeed * fastest_mps) continue;
    first = std::min(first, i);
    last = i;
  }
  return {first, last};
}

Pose2 meanAt(const Case& push_case, int step) {
  return push_case.tube.empty() ? push_case.steps[step].start_T_object : push_case.tube[step].mean;
}

}  // namespace

std::optional<Case> shortenedCase(const Case& push_case, double share) {
  CASEPUSH_CHECK(share >= 0.0 && share < 1.0, "share " << share);
  CASEPUSH_CHECK(push_case.id > 0, "case " << push_case.id);
  const auto [first, last] = fullSpeedSteps(push_case);
  const int from = first + static_cast<int>(std::lround(share * (last - first)));
  if (from >= last) return std::nullopt;
  const Pose2& robot_before = push_case.steps[from].object_T_robot;
  const Pose2& robot_after = push_case.steps[last].object_T_robot;
  if (distance(robot_before, robot_after) > kSlid_m ||
      std::abs(yawDifference(robot_before, robot_after)) > kSlid_rad) {
    return std::nullopt;
  }
  Case shorter = push_case;
  shorter.source_id = push_case.id;
  const Pose2 recorded =
      push_case.steps[from].start_T_object * push_case.steps[last].start_T_object.inverse();
  const Pose2 mean = meanAt(push_case, from) * meanAt(push_case, last).inverse();
  for (std::size_t i = last; i < shorter.steps.size(); ++i) {
    shorter.steps[i].start_T_object = recorded * shorter.steps[i].start_T_object;
    if (!shorter.tube.empty()) shorter.tube[i].mean = mean * shorter.tube[i].mean;
  }
  shorter.steps.erase(shorter.steps.begin() + from, shorter.steps.begin() + last);
  if (!shorter.tube.empty()) {
    shorter.tube.erase(shorter.tube.begin() + from, shorter.tube.begin() + last);
  }
  shorter.push_steps -= last - from;
  shorter.start_outcome.mean = mean * shorter.start_outcome.mean;
  return shorter;
}

std::vector<Case> withShortened(std::vector<Case> cases) {
  constexpr std::size_t kMostCases = 500;
  const std::size_t count = cases.size();
  if (count > kMostCases || std::any_of(cases.begin(), cases.end(), isShortened)) return cases;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < kShares.size(); ++k) {
      std::optional<Case> shorter = shortenedCase(cases[i], kShares[k]);
      if (!shorter) continue;
      shorter->id =
          -(static_cast<std::int64_t>(kShares.size()) * cases[i].id + static_cast<std::int64_t>(k));
      cases.push_back(std::move(*shorter));
    }
  }
  return cases;
}

}  // namespace casepush
