// What ExecutorNode makes of the goals that it is sent.
#include <std_msgs/Empty.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/executor_node.h"
#include "casepush/ros/push_conversions.h"

namespace casepush {
namespace {

/// A trivial path if the robot all but stands at the goal, which a planner would call blocked.
std::optional<RobotPath> pathIfThere(const Pose2& map_T_robot, const Pose2& goal) {
  constexpr double kThereM = 0.05;
  constexpr double kThereRad = 0.1;
  if (distance(map_T_robot, goal) > kThereM ||
      std::abs(yawDifference(map_T_robot, goal)) > kThereRad) {
    return std::nullopt;
  }
  RobotPath path;
  path.found = true;
  path.waypoints = {map_T_robot, goal};
  path.length_m = distance(map_T_robot, goal);
  return path;
}

template <typename Result, typename GoalHandle>
void reject(GoalHandle& goal, std::uint8_t status, const std::string& explanation) {
  Result result;
  result.status = status;
  result.explanation = explanation;
  goal.setRejected(result, explanation);
  ROS_WARN("goal rejected: %s", explanation.c_str());
}

/// Begins a goal, or rejects it.
/// @param busy   What is going on; "" if nothing.
/// @param begin  Begins it, or returns what is missing; throws if the goal makes no sense.
template <typename Result, typename GoalHandle, typename Begin>
void beginOrReject(GoalHandle& goal, const std::string& busy, const Begin& begin) {
  if (!busy.empty()) {
    return reject<Result>(goal, Result::BUSY, "busy: " + busy);
  }
  try {
    const std::string missing = begin();
    if (!missing.empty()) {
      reject<Result>(goal, Result::NOT_READY, missing);
    }
  } catch (const InputError& error) {
    reject<Result>(goal, Result::INVALID_GOAL, error.what());
  }
}

}  // namespace

void ExecutorNode::onPushObject(PushObjectServer::GoalHandle goal) {
  beginOrReject<PushObjectResult>(goal, whoIsBusy(), [&] {
    const PushTaskGoal task = taskGoal(*goal.getGoal());
    const SearchChoice search = searchOf(*goal.getGoal());
    withSearch(parameters_.planner, search);
    const std::string missing = whatIsMissingFor({task.object_id});
    if (!missing.empty()) return missing;
    plans_.setSearch(search);
    auto activity = std::make_unique<PushObjectActivity>(goal, task, parameters_.furnishing.robot,
                                                         taskServices(task.object_id),
                                                         parameters_.task, reportSink());
    goal.setAccepted();
    begin(std::move(activity));
    return missing;
  });
}

void ExecutorNode::onRearrange(RearrangeServer::GoalHandle goal) {
  beginOrReject<RearrangeResult>(goal, whoIsBusy(), [&] {
    const RearrangeRequest request = rearrangeRequest(*goal.getGoal());
    const SearchChoice search = searchOf(*goal.getGoal());
    withSearch(parameters_.planner, search);
    std::vector<std::string> ids;
    for (const PushTaskGoal& task : request.tasks) ids.push_back(task.object_id);
    const std::string missing = whatIsMissingFor(ids);
    if (!missing.empty()) return missing;
    plans_.setSearch(search);
    const auto make_task = [this](const PushTaskGoal& task, auto on_report) {
      PushTaskServices services = taskServices(task.object_id);
      services.on_report = std::move(on_report);
      return std::make_unique<PushTask>(task, parameters_.furnishing.robot, std::move(services),
                                        parameters_.task);
    };
    auto activity = std::make_unique<RearrangeActivity>(goal, request, rearrangeServices(),
                                                        make_task, reportSink(), summarySink());
    goal.setAccepted();
    begin(std::move(activity));
    return missing;
  });
}

ApproachPlanner ExecutorNode::approach(const std::string& object_id) const {
  // The planner is kept alive by the lambda, should a new map come while it drives.
  const std::shared_ptr<const PushPlanner> planner = map_.planner();
  const auto plan = approachPlanner(*planner, object_id);
  return [plan, planner](const Observation& observation, const Pose2& goal,
                         double dock_direction_rad) {
    const std::optional<RobotPath> there = pathIfThere(observation.map_T_robot, goal);
    return there ? *there : plan(observation, goal, dock_direction_rad);
  };
}

ExecutePush ExecutorNode::makePush(const ExecutePushGoal& goal) const {
  const RobotModel& robot = parameters_.furnishing.robot;
  if (goal.case_id == 0) {
    return ExecutePush(goal.object_id, fromMessage(goal.configuration), robot,
                       approach(goal.object_id), parameters_.task.push);
  }
  const auto found = std::find_if(cases_->begin(), cases_->end(),
                                  [&goal](const Case& each) { return each.id == goal.case_id; });
  if (found == cases_->end()) {
    throw InputError("goal: case_id",
                     "there is no case " + std::to_string(goal.case_id) + " (topic cases)");
  }
  const std::string& model = parameters_.furnishing.instance(goal.object_id)->model.name;
  if (!isFor(*found, model, robot.name)) {
    throw InputError("goal: case_id", "case " + std::to_string(goal.case_id) + " is of " +
                                          found->object + " pushed by " + found->robot + ", but " +
                                          goal.object_id + " is a " + model + " and the robot is " +
                                          robot.name);
  }
  return ExecutePush(goal.object_id, *found, robot, approach(goal.object_id),
                     parameters_.task.push);
}

void ExecutorNode::onExecutePush(ExecutePushServer::GoalHandle goal) {
  const ExecutePushGoal& wanted = *goal.getGoal();
  if (!whoIsBusy().empty()) {
    return reject<ExecutePushResult>(goal, ExecutePushResult::BUSY, "busy: " + whoIsBusy());
  }
  if (parameters_.furnishing.instance(wanted.object_id) == nullptr) {
    return reject<ExecutePushResult>(goal, ExecutePushResult::INVALID_GOAL,
                                     "unknown object '" + wanted.object_id + "'");
  }
  std::string missing = whatIsMissing();
  const bool seen = std::any_of(objects_.begin(), objects_.end(), [&wanted](const auto& each) {
    return each.id == wanted.object_id;
  });
  if (missing.empty() && !seen) {
    missing = wanted.object_id + " has not been seen (topic objects)";
  }
  if (!missing.empty()) {
    return reject<ExecutePushResult>(goal, ExecutePushResult::NOT_READY, missing);
  }
  try {
    auto activity = std::make_unique<ExecutePushActivity>(goal, makePush(wanted), reportSink());
    goal.setAccepted();
    begin(std::move(activity));
  } catch (const InputError& error) {
    reject<ExecutePushResult>(goal, ExecutePushResult::INVALID_GOAL, error.what());
  }
}

bool ExecutorNode::onStop(std_srvs::Trigger::Request& /*request*/,
                          std_srvs::Trigger::Response& response) {
  response.success = true;
  response.message = activity_ == nullptr ? "nothing was going on" : "stopped";
  if (activity_ != nullptr) {
    end(ActivityEnd::kStopped, "stopped by the service stop");
  }
  command_.publish(geometry_msgs::Twist());
  // Whoever sends goal after goal may be between two of them.
  stops_.publish(std_msgs::Empty());
  return true;
}

}  // namespace casepush
