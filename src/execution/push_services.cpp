// What ExecutePush needs from outside, by a push planner.
#include "casepush/execution/execute_push.h"
#include "watches.h"

namespace casepush {
namespace {

// By less than this poses may be off, and a cell be larger than what is in it: in a narrow gap no
// push must be stopped for that.
constexpr double kCertain_m = 0.02;

}  // namespace

std::vector<PlacedObject> otherObjects(const Observation& observation, const std::string& but_id) {
  std::vector<PlacedObject> others;
  for (const ObjectState& object : observation.objects) {
    if (object.id != but_id && isUsable(object)) {
      others.push_back({object.id, object.model, object.map_T_object});
    }
  }
  return others;
}

ApproachPlanner approachPlanner(const PushPlanner& planner, const std::string& object_id) {
  return [&planner, object_id](const Observation& observation, const Pose2& goal,
                               double dock_direction_rad) {
    const ObjectState* object = usableObject(observation, object_id);
    if (object == nullptr) {
      RobotPath none;
      none.explanation = object_id + " is not in sight";
      return none;
    }
    return planner.approachPath({object->id, object->model, object->map_T_object},
                                otherObjects(observation, object_id), observation.map_T_robot, goal,
                                dock_direction_rad);
  };
}

ApproachPlanner approachPlanner(const PlannerSource& planner, const std::string& object_id) {
  return [planner, object_id](const Observation& observation, const Pose2& goal,
                              double dock_direction_rad) {
    const auto current = planner();
    return approachPlanner(*current, object_id)(observation, goal, dock_direction_rad);
  };
}

TouchCheck touchCheck(const PlannerSource& planner, const std::string& object_id) {
  return [planner, object_id](const Observation& observation,
                              const std::vector<Pose2>& map_T_object) {
    const ObjectState* object = usableObject(observation, object_id);
    return object == nullptr ? std::string()
                             : planner()->touched(object->model, map_T_object,
                                                  otherObjects(observation, object_id), kCertain_m);
  };
}

}  // namespace casepush
