#include "casepush/execution/push_task.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "push_task_data.h"
#include "push_task_rules.h"

namespace casepush {
namespace {

// A plan that came while the object was moved by more than this is for another start.
constexpr double kMovedM = 0.05;
constexpr double kMovedRad = 0.1;
// Less than this is no progress of a plan's length.
constexpr double kProgressM = 0.1;

double yawError(const Pose2& a, const Pose2& b) { return std::abs(yawDifference(a, b)); }

}  // namespace

PushTask::Data::Data(PushTaskGoal push_goal, RobotModel robot_model, PushTaskServices outside,
                     const PushTaskOptions& task_options)
    : goal(std::move(push_goal)),
      robot(std::move(robot_model)),
      services(completeServices(std::move(outside), goal.object_id)),
      options(task_options),
      robot_watch(options.push.stale_robot_s),
      rest(options.push) {
  options.push.tube.on = options.push.tube.on || options.break_off;
}

void PushTask::Data::enter(Stage next, const char* phase, const std::string& what, double now_s) {
  stage = next;
  stage_began_s = now_s;
  progress.phase = phase;
  text = what;
}

void PushTask::Data::cancelPlanning() {
  if (stage == Stage::kPlan || is_repairing) services.plans->cancel();
  is_repairing = false;
}

void PushTask::Data::end(PushTaskStatus final_status, const std::string& why) {
  cancelPlanning();
  estimate.reset();
  clear.reset();
  stage = Stage::kDone;
  status = final_status;
  progress.phase = "done";
  text = why;
}

void PushTask::Data::measure(const Observation& observation) {
  if (const ObjectState* object = usableObject(observation, goal.object_id)) {
    progress.distance_to_goal_m = distance(object->map_T_object, goal.map_T_goal);
    progress.yaw_to_goal_rad = yawError(object->map_T_object, goal.map_T_goal);
    last_seen = *object;
  }
}

Tick PushTask::Data::look(const Observation& observation) {
  const ObjectState* object = usableObject(observation, goal.object_id);
  const bool is_fresh =
      object != nullptr && observation.stamp_s - object->stamp_s <= options.push.lost_object_s;
  if (is_fresh && rest.isAtRest(*object)) {
    if (isSafelyAtGoal(goal, *object, options)) {
      end(PushTaskStatus::kSucceeded, goal.object_id + " is at the goal");
    } else {
      requestPlan(observation, *object);
    }
  } else if (!is_fresh && last_seen && searches < options.max_searches) {
    ++searches;
    search.emplace(*last_seen, robot, services.approach, options.search);
    enter(Stage::kSearch, "search", search->describe(), observation.stamp_s);
  } else if (observation.stamp_s - stage_began_s > options.look_timeout_s) {
    const std::string why = is_fresh ? " does not come to rest" : " is not in sight";
    end(PushTaskStatus::kObjectLost, goal.object_id + why);
  }
  return {};
}

Tick PushTask::Data::searchOn(const Observation& observation) {
  const Tick tick = search->tick(observation);
  text = search->describe();
  if (tick.status == BehaviourStatus::kSucceeded) {
    rest.reset();
    enter(Stage::kLook, "look", text, observation.stamp_s);
  } else if (tick.status == BehaviourStatus::kFailed) {
    end(PushTaskStatus::kObjectLost, text);
  }
  return {tick.command, BehaviourStatus::kRunning};
}

void PushTask::Data::requestPlan(const Observation& observation, const ObjectState& object) {
  request = planRequest(goal, options, observation, object, progress.plans);
  request.obstacles = obstacles(observation);
  known = otherObjects(observation, goal.object_id);
  services.plans->request(request);
  enter(Stage::kPlan, "planning", "planning", observation.stamp_s);
}

Tick PushTask::Data::awaitPlan(const Observation& observation) {
  if (!around) {
    const std::optional<PlanResult> result = services.plans->poll();
    if (!result || asksForWayAround(*result, observation)) return {};
    if (!through) return take(*result, observation);
    around = *result;
    estimateClearing(observation);
  }
  const std::optional<PlanResult> chosen = quicker();
  return chosen ? take(*chosen, observation) : Tick{};
}

Tick PushTask::Data::take(const PlanResult& chosen, const Observation& observation) {
  ++progress.plans;
  if (services.on_plan) {
    services.on_plan(chosen);
  }
  if (chosen.status == PlanStatus::kSolved && !chosen.plan.pushes.empty()) {
    acceptPlan(chosen, observation);
  } else {
    rejectPlan(chosen, observation);
  }
  return {};
}

void PushTask::Data::acceptPlan(const PlanResult& result, const Observation& observation) {
  const ObjectState* object = usableObject(observation, goal.object_id);
  const Pose2& planned = request.object.map_T_object;
  if (object != nullptr && (distance(object->map_T_object, planned) > kMovedM ||
                            yawError(object->map_T_object, planned) > kMovedRad)) {
    progress.beginPlan();
    replan(ReplanCause::kObjectMoved, goal.object_id + " was moved during planning", observation);
    return;
  }
  progress.beginPlan();
  progress.push_index = 0;
  notePlan(result);
  startPush(observation);
}

// Of a plan, or of what follows the present push.
void PushTask::Data::notePlan(const PlanResult& made) {
  plan = made.plan;
  const double length_m = plan->lengthM();
  if (progress.plan_length_m == 0.0) {
    progress.plan_length_m = length_m;
  }
  plans_without_progress = length_m < shortest_plan_m - kProgressM ? 0 : plans_without_progress + 1;
  shortest_plan_m = std::min(shortest_plan_m, length_m);
  progress.push_count = progress.push_index + static_cast<int>(plan->pushes.size());
  accepted_dead_end = made.dead_end > 0 ? progress.push_index + made.dead_end : 0;
}

void PushTask::Data::rejectPlan(const PlanResult& result, const Observation& observation) {
  dropRepair();
  const ObjectState* object = usableObject(observation, goal.object_id);
  if (isInvalidGoal(result.status)) {
    end(PushTaskStatus::kInvalidGoal, result.explanation);
    return;
  }
  if (result.status == PlanStatus::kPlannerGone) {
    end(PushTaskStatus::kPlannerGone, result.explanation);
    return;
  }
  if (object != nullptr && goal.tolerance.isMet(goal.map_T_goal, object->map_T_object)) {
    end(PushTaskStatus::kSucceeded, goal.object_id + " is at the goal, within the tolerance");
  } else if (++failed_plans >= options.max_failed_plans) {
    end(PushTaskStatus::kNoPlan,
        "no plan after " + std::to_string(failed_plans) + " attempts: " + result.explanation);
  } else {
    immovable.clear();  // With less in the way of the plan there may be room after all.
    rest.reset();
    enter(Stage::kLook, "look", "planning failed, trying again", observation.stamp_s);
  }
}

Tick PushTask::Data::step(const Observation& observation) {
  switch (stage) {
    case Stage::kLook:
      return look(observation);
    case Stage::kSearch:
      return searchOn(observation);
    case Stage::kPlan:
      return awaitPlan(observation);
    case Stage::kClear:
      return clearOn(observation);
    case Stage::kPush:
      return pushOn(observation);
    case Stage::kDone:
      break;
  }
  return {};
}

Tick PushTask::Data::run(const Observation& observation) {
  if (cancelled) {
    end(PushTaskStatus::kCancelled, "cancelled");
    return {};
  }
  if (!services.plans->isAlive()) {
    end(PushTaskStatus::kPlannerGone, "the planner does not answer");
    return {};
  }
  const RobotWatch::Status robot_status = robot_watch.check(observation);
  if (!std::isfinite(observation.stamp_s)) {
    return push ? push->tick(observation) : clear ? clear->tick(observation) : Tick{};
  }
  if (!began_s) {
    began_s = observation.stamp_s;
    stage_began_s = observation.stamp_s;
  }
  if (!clock.advance(observation.stamp_s)) {
    end(PushTaskStatus::kTimeout, "time went back");
  } else if (robot_status == RobotWatch::Status::kLost) {
    end(PushTaskStatus::kRobotLost, "the robot's own pose is not up to date");
  } else if (observation.stamp_s - *began_s > goal.time_limit_s) {
    end(PushTaskStatus::kTimeout,
        "time is up: still " + errorText(progress.distance_to_goal_m, progress.yaw_to_goal_rad));
  } else if (robot_status == RobotWatch::Status::kFresh || stage == Stage::kPush ||
             stage == Stage::kClear) {
    // A push has to know that the robot was stopped, so it sees stale poses too.
    measure(observation);
    return step(observation);
  }
  return {};
}

PushTask::PushTask(PushTaskGoal goal, RobotModel robot, PushTaskServices services,
                   PushTaskOptions options) {
  options.validate();
  data_ = std::make_unique<Data>(std::move(goal), std::move(robot), std::move(services), options);
  data_->progress.phase = "look";
  if (!isSensible(data_->goal)) {
    data_->end(PushTaskStatus::kInvalidGoal, kNotSensible);
  }
}

PushTask::~PushTask() { data_->cancelPlanning(); }

Tick PushTask::tick(const Observation& observation) {
  Tick tick;
  if (data_->stage != Data::Stage::kDone) {
    tick = data_->run(observation);
  }
  if (data_->stage == Data::Stage::kDone) {
    const bool is_done = data_->status == PushTaskStatus::kSucceeded;
    tick.command = Command{};
    tick.status = is_done ? BehaviourStatus::kSucceeded : BehaviourStatus::kFailed;
  }
  return tick;
}

std::string PushTask::describe() const { return data_->text; }

void PushTask::cancel() { data_->cancelled = true; }

PushTaskStatus PushTask::status() const { return data_->status; }

const std::optional<PushPlan>& PushTask::plan() const { return data_->plan; }

const PushTaskProgress& PushTask::progress() const { return data_->progress; }

}  // namespace casepush
