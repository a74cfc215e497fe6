// How PushTask deals with other objects that can be pushed: it plans through them, compares with
// the way around, and clears its way push by push (paper section 4).
#include <algorithm>
#include <limits>
#include <utility>

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

// A plan that hits nobody is good as it is. Otherwise the way around is asked for, to compare.
bool PushTask::Data::asksForWayAround(const PlanResult& result, const Observation& observation) {
  if (through || !services.clearing || !goal.clear_obstacles) return false;
  const std::vector<PlacedObject> all = otherObjects(observation, goal.object_id);
  const std::vector<PlacedObject> movable = movableOnes(all, request.obstacles);
  if (movable.empty() || result.status != PlanStatus::kSolved ||
      services.clearing->in_the_way(result.plan, movable).empty()) {
    return false;
  }
  through = result;
  PlanRequest around = request;
  around.obstacles = all;
  services.plans->request(around);
  return true;
}

// By expected time. What stands in the way is cleared from where it stands now, one after another.
PlanResult PushTask::Data::quicker(const PlanResult& around, const Observation& observation) {
  const PlanResult straight = std::move(*through);
  through.reset();
  if (around.status != PlanStatus::kSolved) return straight;
  const std::vector<PlacedObject> all = otherObjects(observation, goal.object_id);
  const std::vector<PlacedObject> movable = movableOnes(all, request.obstacles);
  double clearing_s = 0.0;
  for (const std::string& id : services.clearing->in_the_way(straight.plan, movable)) {
    ClearingRequest clearing;
    for (const PlacedObject& object : all) {
      if (object.id == id) {
        clearing.obstacle = object;
      } else {
        clearing.standing.push_back(object);
      }
    }
    clearing.standing.push_back(request.object);
    clearing.ways = {straight.plan};
    clearing.map_T_robot = observation.map_T_robot;
    const ClearingResult found = services.clearing->clear(clearing);
    clearing_s += found.found ? found.expected_s : std::numeric_limits<double>::infinity();
  }
  return straight.expected_s + clearing_s < around.expected_s ? straight : around;
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
  if (clearing.blockers(*plan, observation).empty()) return false;
  clear.emplace(*plan, robot, std::move(clearing), options.clear);
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
    startPush(observation);
  } else {
    if (!stuck.empty()) immovable.insert(stuck);
    replan(ReplanCause::kObstacleStuck, text, observation);
  }
  return {};
}

}  // namespace casepush
