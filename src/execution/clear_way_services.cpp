#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "casepush/execution/clear_way.h"
#include "watches.h"

namespace casepush {
namespace {

/// Of the other objects of an observation, those that can be pushed and those that cannot.
struct Others {
  std::vector<PlacedObject> movable;
  std::vector<PlacedObject> standing;
};

Others othersOf(const Observation& observation, const std::string& but_id,
                const std::function<bool(const PlacedObject&)>& is_movable) {
  Others others;
  for (const PlacedObject& object : otherObjects(observation, but_id)) {
    (is_movable(object) ? others.movable : others.standing).push_back(object);
  }
  return others;
}

/// Who stands where the robot would drive to the plan's next push.
std::vector<std::string> inTheRobotsWay(const PushPlanner& planner, const PushPlan& plan,
                                        const std::vector<Case>& cases, const Others& others,
                                        const Pose2& map_T_robot) {
  const PlannedPush& next = plan.pushes.front();
  const Case* found = findCase(cases, next.case_id);
  if (found == nullptr) return {};
  const Pose2 map_T_begin = next.map_T_start * found->steps.front().start_T_robot();
  const double direction_rad = wrapAngle(next.map_T_start.yaw() + pushDirection(*found));
  const PlacedObject object{plan.object.id, plan.object.model, next.map_T_start};
  return planner.inTheRobotsWay(object, others.movable, others.standing, map_T_robot, map_T_begin,
                                direction_rad);
}

}  // namespace

BeginClearing searchAtOnce(std::function<ClearingResult(const ClearingRequest&)> search) {
  return [search = std::move(search)](const ClearingRequest& request) -> PendingClearing {
    return [result = search(request)] { return std::optional<ClearingResult>(result); };
  };
}

ClearWayServices clearWayServices(const PlannerSource& planner, const std::string& robot,
                                  const CaseSource& cases) {
  ClearWayServices services;
  services.cases = [cases, robot](const std::string& model) {
    const auto all = cases();
    std::vector<Case> own;
    std::copy_if(all->begin(), all->end(), std::back_inserter(own),
                 [&](const Case& each) { return isFor(each, model, robot); });
    return own;
  };
  services.is_movable = [cases, robot](const PlacedObject& object) {
    const auto all = cases();
    return std::any_of(all->begin(), all->end(),
                       [&](const Case& each) { return isFor(each, object.model, robot); });
  };
  const auto is_movable = services.is_movable;
  services.blockers = [planner, cases, is_movable](const PushPlan& plan,
                                                   const Observation& observation, int pushes) {
    if (plan.pushes.empty()) return std::vector<std::string>{};
    const auto all = cases();
    const auto current = planner();
    const Others others = othersOf(observation, plan.object.id, is_movable);
    std::vector<std::string> ids = current->inTheWay(plan, *all, others.movable, pushes);
    if (!ids.empty()) return ids;
    return inTheRobotsWay(*current, plan, *all, others, observation.map_T_robot);
  };
  services.clear = searchAtOnce([planner, cases](const ClearingRequest& request) {
    return planner()->clear(request, *cases());
  });
  services.go_on = [planner, cases](const PushPlan& rest, const Observation& observation) {
    std::optional<PushPlan> plan;
    const ObjectState* object = usableObject(observation, rest.object.id);
    if (object == nullptr || rest.pushes.empty()) return plan;
    const PushPlanner::Continuation found = planner()->continuePlan(
        rest, object->map_T_object, *cases(), otherObjects(observation, rest.object.id));
    if (found.applicable > 0) plan = found.plan;
    return plan;
  };
  services.approach = [planner](const std::string& id) { return approachPlanner(planner, id); };
  services.touches = [planner](const std::string& id) { return touchCheck(planner, id); };
  return services;
}

}  // namespace casepush
