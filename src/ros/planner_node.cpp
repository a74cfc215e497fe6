#include "casepush/ros/planner_node.h"

#include <utility>

#include "casepush/cases/shortened_case.h"
#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/markers.h"
#include "casepush/ros/names.h"
#include "casepush/ros/push_conversions.h"
#include "casepush/ros/search_choice.h"
#include "casepush/ros/transforms.h"

namespace casepush {
namespace {

constexpr double kFeedbackPeriodS = 0.2;

PlanResult invalid(const std::string& explanation) {
  PlanResult result;
  result.status = PlanStatus::kInvalidRequest;
  result.explanation = explanation;
  return result;
}

}  // namespace

PlannerNode::PlannerNode(PlannerNodeParameters parameters, ros::NodeHandle handle)
    : parameters_(std::move(parameters)),
      handle_(handle),
      listener_(buffer_),
      planner_(parameters_.furnishing, parameters_.planner),
      server_(handle, names::kPlanPushAction,
              [this](const PlanPushGoalConstPtr& goal) { onGoal(goal); }),
      diagnostics_(handle, "planner", [this](auto& status) { reportDiagnostics(status); }) {
  plan_ = handle_.advertise<Plan>(names::kPlan.name, names::kPlan.queue_size, true);
  plan_markers_ = handle_.advertise<MarkerArray>(names::kPlanMarkers.name,
                                                 names::kPlanMarkers.queue_size, true);
  tree_markers_ = handle_.advertise<MarkerArray>(names::kTreeMarkers.name,
                                                 names::kTreeMarkers.queue_size, true);
  cases_subscriber_ =
      handle_.subscribe(names::kCases.name, names::kCases.queue_size, &PlannerNode::onCases, this);
  objects_subscriber_ = handle_.subscribe(names::kObjects.name, 1, &PlannerNode::onObjects, this,
                                          ros::TransportHints().tcpNoDelay());
  maps_ = std::make_unique<MapSource>(
      parameters_.map, parameters_.furnishing, handle_, buffer_,
      [this](std::shared_ptr<const Map> map) { planner_.setMap(std::move(map)); });
  server_.start();
}

std::shared_ptr<const PushPlanner> PlannerNode::plannerFor(const PlanPushGoal& goal) {
  const PushPlannerOptions options = withSearch(parameters_.planner, searchOf(goal));
  const std::shared_ptr<const PushPlanner> planner = planner_.get();
  return planner == nullptr ? nullptr : planner->withOptions(options);
}

void PlannerNode::onCases(const PushCaseArray& message) {
  try {
    auto cases = std::make_shared<const std::vector<Case>>(withShortened(fromMessage(message)));
    const std::lock_guard<std::mutex> lock(mutex_);
    cases_ = std::move(cases);
  } catch (const InputError& error) {
    ROS_ERROR("cases ignored: %s", error.what());
  }
}

void PlannerNode::onObjects(const PushableObjectArray& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  objects_ = message;
}

PlanRequest PlannerNode::request(const PlanPushGoal& goal) {
  PlanPushGoal complete = goal;
  complete.goal.pose = toPoseMessage(poseInMap(buffer_, goal.goal));
  complete.goal.header.frame_id = names::kMapFrame;
  if (!goal.state_given) {
    complete.objects.clear();
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const ObjectState& state : fromMessage(objects_)) {
      complete.objects.push_back(
          toMessage(PlacedObject{state.id, state.model, state.map_T_object}));
    }
    const StampedRobotPose robot = robotPose(buffer_);
    if (isAhead(robot.stamp_s)) {
      throw InputError("start", "TF map -> base_link is stamped ahead of the clock");
    }
    complete.robot = toMessage(robot.map_T_robot);
  }
  return fromMessage(complete);
}

PlanResult PlannerNode::plan(const PlanPushGoal& goal) {
  const std::shared_ptr<const PushPlanner> planner = plannerFor(goal);
  if (planner == nullptr) {
    return invalid("there is no map yet (" + maps_->missing() + ")");
  }
  std::shared_ptr<const std::vector<Case>> cases;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    cases = cases_;
  }
  const PlanRequest complete = request(goal);
  double next_feedback_s = 0.0;
  const auto report = [&](const PlanProgress& progress) {
    if (progress.elapsed_s < next_feedback_s) {
      return;
    }
    next_feedback_s = progress.elapsed_s + kFeedbackPeriodS;
    PlanPushFeedback feedback;
    feedback.elapsed = progress.elapsed_s;
    feedback.nodes = static_cast<std::uint32_t>(progress.nodes);
    feedback.best_cost = progress.best_cost_s;
    server_.publishFeedback(feedback);
  };
  const auto stop = [this] { return server_.isPreemptRequested() || !ros::ok(); };
  PlanResult result = planner->plan(complete, *cases, stop, report);
  show(result, *cases);
  return result;
}

void PlannerNode::onGoal(const PlanPushGoalConstPtr& goal) {
  PlanResult result;
  try {
    result = plan(*goal);
  } catch (const InputError& error) {
    result = invalid(error.what());
  }
  ROS_INFO("plan for %s: %s; %s", goal->object_id.c_str(), toString(result.status),
           result.explanation.c_str());
  const PlanPushResult message = toMessage(result, ros::Time::now().toSec());
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_result_ = std::move(result);
  }
  if (message.status == PlanPushResult::SOLVED) {
    server_.setSucceeded(message, message.explanation);
  } else if (message.status == PlanPushResult::CANCELLED) {
    server_.setPreempted(message, message.explanation);
  } else {
    server_.setAborted(message, message.explanation);
  }
}

void PlannerNode::show(const PlanResult& result, const std::vector<Case>& cases) {
  tree_markers_.publish(treeMarkers(result.tree));
  if (result.status != PlanStatus::kSolved) {
    return;
  }
  Plan message = toMessage(result.plan, ros::Time::now().toSec());
  message.number = ++plan_count_;
  plan_.publish(message);
  plan_markers_.publish(planMarkers(result.plan, cases));
}

void PlannerNode::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string ahead = ahead_.check(buffer_);  // A live map needs transforms, too.
  if (!ahead.empty()) {
    ROS_WARN("%s", ahead.c_str());
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (planner_.get() == nullptr) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "no map yet");
  } else if (cases_->empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "no cases yet");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK,
                   server_.isActive() ? "planning" : "ready");
  }
  status.add("cases", cases_->size());
  status.add("last plan", last_result_.explanation);
  status.add("last planning time [s]", last_result_.planning_s);
  maps_->report(status);
}

}  // namespace casepush
