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
  if (!run.ground) {
    return std::as_const(*run.exploration).next();
  }
  if (run.exploration->finished()) {
    return std::nullopt;
  }
  const std::optional<ObjectState> object = see(run.object_id);
  if (!object) {
    run.fail(LearnObjectResult::FAILED, run.object_id + " is not in sight (topic objects)");
    endIfAsked(run);
    return std::nullopt;
  }
  return run.exploration->next(*run.ground, object->map_T_object);
}

}  // namespace casepush
