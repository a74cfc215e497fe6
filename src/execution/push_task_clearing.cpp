// How PushTask deals with other objects that can be pushed: it plans through them, compares with
// the way around, and clears its way push by push (paper section 4).
#include <algorithm>
#include <utility>

#include "bystanders.h"
#include "push_task_data.h"

namespace casepush {

bool PushTask::Data::isMovable(const PlacedObject& object) const {
  return services.clearing && goal.clear_obstacles && immovable.count(object.id) == 0 &&
         services.clearing->is_movable(object);
}

// What the plan has to leave alone.
std::vector<PlacedObject> PushTask::Data::obstacles(const Observation& observation) const {
  std::vector<PlacedObject> standing = otherObjects(observation, goal.object_id);
  standing.erase(std::remove_if(standing.begin(), standing.end(),
                                [this](const PlacedObject& object) { return isMovable(object); }),
                 standing.end());
  return standing;
}

namespace {

std::vector<PlacedObject> movableOnes(const std::vector<PlacedObject>& all,
                                      const std::vector<PlacedObject>& standing) {
  std::vector<PlacedObject> movable;
  for (const PlacedObject& object : all) {
    const bool stands = std::any_of(standing.begin(), standing.end(),
                                    [&object](const auto& each) { return each.id == object.id; });
    if (!stands) movable.push_back(object);
  }
  return movable;
}

}  // namespace

// An object that was first seen after the plan was made, or has moved since, and that any push of
// the plan's rest would hit: to find that out only in front of it may be too late to turn round.
std::string PushTask::Data::newcomerInTheWay(const PushPlan& rest_of_plan,
                                             const Observation& observation) {
  const std::vector<PlacedObject> before =
      std::exchange(known, otherObjects(observation, goal.object_id));
  std::vector<PlacedObject> newcomers;
  for (const PlacedObject& other : known) {
    if (!isAmong(before, other)) newcomers.push_back(other);
  }
  if (newcomers.empty()) return {};
  const std::vector<std::string> ids = services.in_the_way(rest_of_plan, newcomers);
  return ids.empty() ? std::string() : ids.front();
}

// A plan that hits nobody is good as it is. Otherwise the way around is asked for, to compare.
bool PushTask::Data::asksForWayAround(const PlanResult& result, const Observation& observation) {
  if (through || !services.clearing || !goal.clear_obstacles) return false;
  const std::vector<PlacedObject> all = otherObjects(observation, goal.object_id);
  const std::vector<PlacedObject> movable = movableOnes(all, request.obstacles);
  if (movable.empty() || result.status != PlanStatus::kSolved ||
      services.in_the_way(result.plan, movable).empty()) {
    return false;
  }
  through = result;
  PlanRequest with_all = request;
  with_all.obstacles = all;
  services.plans->request(with_all);
  return true;
}

void PushTask::Data::estimateClearing(const Observation& observation) {
  std::vector<PlacedObject> all = otherObjects(observation, goal.object_id);
  std::vector<std::string> blockers =
      services.in_the_way(through->plan, movableOnes(all, request.obstacles));
  estimate.emplace(through->plan, std::move(blockers), std::move(all), observation.map_T_robot,
                   *services.clearing, options.clear);
}

// By expected time, as soon as that is known.
std::optional<PlanResult> PushTask::Data::quicker() {
  double through_s = 0.0;
  if (around->status == PlanStatus::kSolved) {
    const std::optional<double> clearing_s = estimate->poll();
    if (!clearing_s) return std::nullopt;
    through_s = through->expected_s + *clearing_s;
  }
  const bool goes_around = around->status == PlanStatus::kSolved && around->expected_s <= through_s;
  PlanResult chosen = goes_around ? *around : *through;
  estimate.reset();
  around.reset();
  through.reset();
  return chosen;
}

// False if nobody is in the way of the next push.
bool PushTask::Data::beginClearing(const Observation& observation) {
  if (!services.clearing || !goal.clear_obstacles) return false;
  ClearWayServices clearing = *services.clearing;
  clearing.is_movable = [this](const PlacedObject& object) { return isMovable(object); };
  clearing.on_report = [this](const PushReport& report) {
    ++progress.clearing_pushes;
    if (services.on_report) services.on_report(report);
  };
  clear.emplace(*plan, robot, std::move(clearing), options.clear);
  if (!clear->isNeeded(observation)) {
    clear.reset();
    return false;
  }
  enter(Stage::kClear, "clear", clear->describe(), observation.stamp_s);
  return true;
}

Tick PushTask::Data::clearOn(const Observation& observation) {
  const Tick tick = clear->tick(observation);
  text = clear->describe();
  if (tick.status == BehaviourStatus::kRunning) return tick;
  const std::string stuck = clear->stuckObstacle();
  clear.reset();
  if (tick.status == BehaviourStatus::kSucceeded) {
    known = otherObjects(observation, goal.object_id);
    startPush(observation);
  } else {
    if (!stuck.empty()) immovable.insert(stuck);
    replan(ReplanCause::kObstacleStuck, text, observation);
  }
  return {};
}

}  // namespace casepush
