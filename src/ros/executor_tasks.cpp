// What ExecutorNode gives the tasks that push objects to goals.
#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/background_clearing.h"
#include "casepush/ros/executor_node.h"
#include "casepush/ros/push_conversions.h"
#include "casepush/ros/transforms.h"

namespace casepush {
namespace {

constexpr double kMaxTimeLimitS = 1e6;

/// 0 stands for the default.
double timeLimit(double wanted_s, double default_s, const std::string& where) {
  if (!(wanted_s >= 0.0 && wanted_s <= kMaxTimeLimitS)) {
    throw InputError(where, "is " + std::to_string(wanted_s) + " s, must be in [0, 1e6]");
  }
  return wanted_s > 0.0 ? wanted_s : default_s;
}

/// Fields of the same name in ObjectGoal and PushObjectGoal.
template <typename Message>
PushTaskGoal placeOf(const Message& message, const tf2_ros::Buffer& buffer,
                     const Furnishing& furnishing) {
  if (furnishing.instance(message.object_id) == nullptr) {
    throw InputError("goal: object_id", "unknown object '" + message.object_id + "'");
  }
  PushTaskGoal task;
  task.object_id = message.object_id;
  task.map_T_goal = poseInMap(buffer, message.goal);
  task.tolerance = goalTolerance(message.position_tolerance, message.yaw_tolerance);
  task.time_limit_s = timeLimit(message.time_limit, task.time_limit_s, "goal: time_limit");
  return task;
}

}  // namespace

bool ExecutorNode::hasCasesOf(const std::string& model) const {
  return std::any_of(cases_->begin(), cases_->end(), [&](const Case& each) {
    return isFor(each, model, parameters_.furnishing.robot.name);
  });
}

std::string ExecutorNode::whatIsMissingFor(const std::vector<std::string>& object_ids) const {
  std::string missing = whatIsMissing();
  for (const std::string& id : object_ids) {
    const std::string& model = parameters_.furnishing.instance(id)->model.name;
    if (missing.empty() && !hasCasesOf(model)) {
      missing = "there are no cases of " + model + " (topic cases); learn it first (learn_object)";
    }
  }
  if (missing.empty() && !plans_.isAlive()) {
    missing = "the planner does not answer yet (action plan_push)";
  }
  return missing;
}

PushTaskGoal ExecutorNode::taskGoal(const PushObjectGoal& goal) const {
  PushTaskGoal task = placeOf(goal, buffer_, parameters_.furnishing);
  task.adapt = goal.adapt;
  task.clear_obstacles = goal.clear_obstacles;
  task.seed = goal.seed;
  return task;
}

RearrangeRequest ExecutorNode::rearrangeRequest(const RearrangeGoal& goal) const {
  RearrangeRequest request;
  request.time_limit_s = timeLimit(goal.time_limit, request.time_limit_s, "goal: time_limit");
  for (const ObjectGoal& each : goal.goals) {
    try {
      request.tasks.push_back(placeOf(each, buffer_, parameters_.furnishing));
    } catch (const InputError& error) {
      throw InputError(each.object_id, error.what());
    }
    PushTaskGoal& task = request.tasks.back();
    task.adapt = goal.adapt;
    task.clear_obstacles = goal.clear_obstacles;
    task.seed = goal.seed;
  }
  return request;
}

PushTaskServices::InTheWay ExecutorNode::inTheWay() const {
  return [this](const PushPlan& plan, const std::vector<PlacedObject>& objects) {
    return map_.planner()->inTheWay(plan, *cases_, objects);
  };
}

PushTaskServices ExecutorNode::taskServices(const std::string& object_id) {
  const PlannerSource planner = [this] { return map_.planner(); };
  PushTaskServices services;
  services.plans = &plans_;
  services.cases = [this] { return cases_; };
  services.continue_plan = [planner](const PushPlan& rest, const Pose2& map_T_object,
                                     const std::vector<Case>& cases,
                                     const std::vector<PlacedObject>& obstacles) {
    return planner()->continuePlan(rest, map_T_object, cases, obstacles);
  };
  services.in_the_way = inTheWay();
  services.approach = approachPlanner(planner, object_id);
  services.touches = touchCheck(planner, object_id);
  services.clearing = clearWayServices(planner, parameters_.furnishing.robot.name, services.cases);
  services.clearing->clear = searchInBackground(planner, services.cases);
  return services;
}

RearrangeServices ExecutorNode::rearrangeServices() {
  RearrangeServices services;
  services.plans = &plans_;
  services.in_the_way = inTheWay();
  return services;
}

}  // namespace casepush
