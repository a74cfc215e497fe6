#include "cut_off.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "casepush/world/shadow.h"
#include "narrow_place.h"
#include "origin_distance.h"
#include "outline_flood.h"
#include "plan_request.h"

namespace casepush {
namespace {

// Of a push between poses that have to be free, in cells. Whoever takes longer ones gets through
// anything, and what he reaches takes long to look at.
constexpr double kLongestStep = 4.0;
constexpr double kMouth_m = 0.3;   // Of a gap: so far it was come in already.
constexpr double kBeyond_m = 1.0;  // Ahead of there the narrowest place is looked for.

/// The longest step between poses that have to be free, over all cases: `step_m` and `step_rad`.
void noteSteps(const std::vector<PreparedCase>& cases, OutlineProblem* problem) {
  const auto note = [problem](const Pose2& from, const Pose2& to) {
    problem->step_m = std::max(problem->step_m, distance(from, to));
    problem->step_rad = std::max(problem->step_rad, std::abs(yawDifference(from, to)));
  };
  for (const PreparedCase& each : cases) {
    Pose2 last;
    for (const Pose2& pose : each.object_path) {
      note(last, pose);
      last = pose;
    }
    note(last, each.start_outcome.mean);  // Was learnt after the motion was recorded.
  }
}

/// The shortest way of the object's origin, cell by cell.
std::vector<Eigen::Vector2d> shortestWay(const OriginDistance& ways,
                                         const CollisionChecker::Columns& columns,
                                         const Eigen::Vector2d& start_m) {
  const double cell_m = columns.resolution_m;
  const Eigen::Array2d index = ((start_m - columns.origin_m) / cell_m).array().floor();
  std::vector<Eigen::Vector2d> way = {columns.origin_m + cell_m * (index + 0.5).matrix()};
  for (double left_m = ways.at(start_m); left_m > 0.0;) {
    Eigen::Vector2d best = way.back();
    for (int i = 0; i < 8; ++i) {
      const double angle_rad = i * M_PI / 4.0;
      const Eigen::Vector2d next =
          way.back() + (i % 2 == 0 ? 1.0 : M_SQRT2) * cell_m *
                           Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
      if (ways.at(next) < left_m) {
        left_m = ways.at(next);
        best = next;
      }
    }
    if (best == way.back()) break;
    way.push_back(best);
  }
  return way;
}

/// The part of the way where the object gets stuck first, seen from the end that is shut in.
std::vector<Eigen::Vector2d> stuckPart(const OutlineFlood& flood, double cell_m,
                                       std::vector<Eigen::Vector2d> way) {
  if (!flood.isStartShutIn()) std::reverse(way.begin(), way.end());
  const auto stuck = std::find_if(way.begin() + 1, way.end(),
                                  [&flood](const auto& point) { return !flood.hasReached(point); });
  const auto cells = [cell_m](double metres) {
    return static_cast<std::ptrdiff_t>(metres / cell_m);
  };
  const auto begin = stuck - std::min(cells(kMouth_m), stuck - way.begin());
  return {begin, stuck + std::min(cells(kBeyond_m), way.end() - stuck)};
}

std::string describe(const NarrowPlace& place) {
  return "at (" + rounded(place.where_m.x(), 2) + ", " + rounded(place.where_m.y(), 2) +
         ") the shortest way is about " + rounded(place.width_m, 2) +
         " m wide, and the object needs more than " + rounded(place.needed_m, 2) + " m";
}

}  // namespace

std::string placeTooNarrow(const SearchProblem& problem, const CollisionChecker& checker,
                           const SearchClock& clock) {
  const CollisionChecker::Columns& columns = checker.columns();
  const PlanRequest& request = problem.request;
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = 0.0;
  for (const ConvexPart& part : convexParts(problem.object.solid)) {
    low_m = std::min(low_m, part.heights().low_m);
    high_m = std::max(high_m, part.heights().high_m);
  }
  PlacedShape thin;  // It touches no more than its own cell.
  thin.shape = Cylinder{0.75 * columns.resolution_m, high_m - low_m};
  thin.frame_T_shape = Eigen::Translation3d(0.0, 0.0, 0.5 * (low_m + high_m));
  const OriginDistance ways(columns, {thin}, request.map_T_goal.position(),
                            request.tolerance.position_m, clock.patience());
  const Eigen::Vector2d start_m = request.object.map_T_object.position();
  if (!std::isfinite(ways.at(start_m))) return {};
  const std::optional<NarrowPlace> narrow = narrowestPlace(
      columns, problem.object.solid, shortestWay(ways, columns, start_m), clock.patience());
  return narrow ? describe(*narrow) : std::string();
}

CutOff findCutOff(const SearchProblem& problem, PushChecker* checker,
                  const std::vector<PreparedCase>& cases, const SearchClock& clock) {
  const PlanRequest& request = problem.request;
  // Obstacles fill cells that they only touch, so that an object beside one would seem shut in.
  const auto map_columns = checker->collisions().mapColumns();
  const CollisionChecker::Columns& columns = *map_columns;
  const Patience patience = clock.patience();
  const Eigen::Vector2d start_m = request.object.map_T_object.position();
  const OriginDistance ways(columns, problem.object.solid, request.map_T_goal.position(),
                            request.tolerance.position_m, patience);
  CutOff result;
  if (!std::isfinite(ways.at(start_m))) {
    return {true, placeTooNarrow(problem, checker->collisions(), clock)};
  }
  if (patience.isOver() || checker->sweeps() == nullptr) return result;
  OutlineProblem outline{*checker->sweeps(),
                         checker->object().footprint,
                         checker->object().radius_m,
                         request.object.map_T_object,
                         request.map_T_goal,
                         request.tolerance,
                         checker->lenientRange(),
                         0.0,
                         0.0};
  noteSteps(cases, &outline);
  if (outline.step_m > kLongestStep * columns.resolution_m) return result;
  const OutlineFlood flood(outline, checker->clearance(), patience);
  result.is_certain = flood.isShutOut();
  if (!result.is_certain) return result;
  const std::vector<Eigen::Vector2d> way = shortestWay(ways, columns, start_m);
  const std::optional<NarrowPlace> narrow = narrowestPlace(
      columns, problem.object.solid, stuckPart(flood, columns.resolution_m, way), patience);
  if (narrow) result.where = describe(*narrow);
  return result;
}

}  // namespace casepush
