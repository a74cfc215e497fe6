// How LearnerNode explores with a robot that has to drive.
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "learner_run.h"

namespace casepush {
namespace {

constexpr std::chrono::seconds kMapPatience(20);  // Wall time.

}  // namespace

bool LearnerNode::findGround(Run& run) {
  const std::shared_ptr<const Map> map = waitForMap();
  if (map == nullptr) {
    return run.fail(LearnObjectResult::FAILED,
                    "there is no map to drive by (topic map/octomap): is planner_node up?");
  }
  std::vector<PlacedSolid> others;
  for (const TrackedObject& each : parameters_.furnishing.instances) {
    const std::optional<ObjectState> seen = objects_.find(each.id);
    if (each.id != run.object_id && seen) {
      others.push_back({each.model.solid, seen->map_T_object, each.id});
    }
  }
  CollisionChecker checker(*map);
  checker.setObstacles(std::move(others));
  run.ground.emplace(checker, run.instance->model, parameters_.furnishing.robot,
                     run.map_T_home.position());
  return true;
}

std::shared_ptr<const Map> LearnerNode::waitForMap() {
  const std::chrono::steady_clock::time_point end = std::chrono::steady_clock::now() + kMapPatience;
  while (std::chrono::steady_clock::now() < end && !shouldEnd() &&
         !waitForChange([this] { return map_ != nullptr; })) {
  }
  const std::lock_guard<std::mutex> lock(state_mutex_);
  return map_;
}

void LearnerNode::onOctomap(const Octomap& message) {
  try {
    auto map = std::make_shared<const Map>(fromMessage(message));
    const std::lock_guard<std::mutex> lock(state_mutex_);
    map_ = std::move(map);
    state_changed_.notify_all();
  } catch (const InputError& error) {
    ROS_ERROR("map ignored: %s", error.what());
  }
}

std::optional<Exploration::Trial> LearnerNode::nextTrial(Run& run) {
  return run.ground ? run.exploration->next(*run.ground, objects_.find(run.object_id)->map_T_object)
                    : std::as_const(*run.exploration).next();
}

}  // namespace casepush
