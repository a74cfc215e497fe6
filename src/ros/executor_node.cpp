#include "casepush/ros/executor_node.h"

#include <geometry_msgs/Twist.h>
#include <std_msgs/Empty.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/cases/shortened_case.h"
#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"
#include "casepush/ros/push_conversions.h"
#include "casepush/ros/transforms.h"

namespace casepush {
namespace {

constexpr double kTickCheckS = 0.02;    // Wall time.
constexpr double kTickMissingS = 0.06;  // Wall time without odometry after which a timer ticks.
constexpr double kStatePeriodS = 0.2;
constexpr double kJumpBackS = 0.5;
constexpr double kForeignS = 5.0;  // Diagnostics tell of it for so long.
constexpr double kBlindS = 2.0;    // Without any observation, after which a goal ends.

}  // namespace

template <typename GoalHandle>
void ExecutorNode::onCancel(GoalHandle goal) {
  if (activity_ != nullptr && activity_->goalId() == goal.getGoalID().id) {
    end(ActivityEnd::kCancelled, "");
  }
}

ExecutorNode::ExecutorNode(ExecutorNodeParameters parameters, ros::NodeHandle handle)
    : parameters_(std::move(parameters)),
      handle_(handle),
      listener_(buffer_, handle, false, ros::TransportHints().tcpNoDelay()),
      map_(parameters_.furnishing, parameters_.planner, handle),
      guard_(parameters_.furnishing.robot.limits, parameters_.task.push.stale_robot_s,
             parameters_.stale_objects_s),
      plans_(handle),
      push_object_(
          handle, names::kPushObjectAction,
          [this](PushObjectServer::GoalHandle goal) { onPushObject(std::move(goal)); },
          [this](PushObjectServer::GoalHandle goal) { onCancel(std::move(goal)); }, false),
      execute_push_(
          handle, names::kExecutePushAction,
          [this](ExecutePushServer::GoalHandle goal) { onExecutePush(std::move(goal)); },
          [this](ExecutePushServer::GoalHandle goal) { onCancel(std::move(goal)); }, false),
      rearrange_(
          handle, names::kRearrangeAction,
          [this](RearrangeServer::GoalHandle goal) { onRearrange(std::move(goal)); },
          [this](RearrangeServer::GoalHandle goal) { onCancel(std::move(goal)); }, false),
      diagnostics_(handle, "executor", [this](auto& status) { reportDiagnostics(status); }),
      watchdog_(parameters_.watchdog_s, [this] { command_.publish(geometry_msgs::Twist()); }) {
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  command_ = handle_.advertise<geometry_msgs::Twist>(names::kCommandVelocity.name,
                                                     names::kCommandVelocity.queue_size);
  reports_ =
      handle_.advertise<ExecutedPush>(names::kPushReports.name, names::kPushReports.queue_size);
  summaries_ =
      handle_.advertise<TaskSummary>(names::kTaskSummaries.name, names::kTaskSummaries.queue_size);
  state_ = handle_.advertise<ExecutorState>(names::kExecutorState.name,
                                            names::kExecutorState.queue_size, true);
  stops_ = handle_.advertise<std_msgs::Empty>(names::kStops.name, names::kStops.queue_size);
  cases_subscriber_ =
      handle_.subscribe(names::kCases.name, names::kCases.queue_size, &ExecutorNode::onCases, this);
  objects_subscriber_ =
      handle_.subscribe(names::kObjects.name, 1, &ExecutorNode::onObjects, this, no_delay);
  odometry_subscriber_ =
      handle_.subscribe(names::kOdometry.name, 1, &ExecutorNode::onOdometry, this, no_delay);
  teleop_subscriber_ =
      handle_.subscribe(names::kTeleopVelocity.name, names::kTeleopVelocity.queue_size,
                        &ExecutorNode::onTeleop, this, no_delay);
  command_subscriber_ =
      handle_.subscribe(names::kCommandVelocity.name, names::kCommandVelocity.queue_size,
                        &ExecutorNode::onCommand, this);
  stop_ = handle_.advertiseService(names::kStopService, &ExecutorNode::onStop, this);
  tick_check_ = handle_.createWallTimer(ros::WallDuration(kTickCheckS),
                                        [this](const ros::WallTimerEvent&) { checkTicks(); });
  publishState(ros::Time::now().toSec());
  push_object_.start();
  execute_push_.start();
  rearrange_.start();
}

void ExecutorNode::onCases(const PushCaseArray& message) {
  try {
    cases_ = std::make_shared<const std::vector<Case>>(withShortened(fromMessage(message)));
  } catch (const InputError& error) {
    ROS_ERROR("cases ignored: %s", error.what());
  }
}

void ExecutorNode::onObjects(const PushableObjectArray& message) {
  try {
    if (isAhead(message.header.stamp.toSec())) {
      throw InputError("topic objects", "is stamped ahead of the clock");
    }
    objects_ = fromMessage(message);
    objects_stamp_s_ = message.header.stamp.toSec();
  } catch (const InputError& error) {
    ROS_ERROR_THROTTLE(1.0, "objects ignored: %s", error.what());
  }
}

void ExecutorNode::onOdometry(const nav_msgs::Odometry& message) {
  const double now_s = message.header.stamp.toSec();
  if (isAhead(now_s)) {
    ROS_WARN_THROTTLE(1.0, "odom: ignored, as it is stamped ahead of the clock by %.1f s",
                      now_s - ros::Time::now().toSec());
    return;
  }
  // Against odometry alone: ticks without it go by the clock, which may be ahead of what is late.
  const bool jumped_back = now_s < odometry_.header.stamp.toSec() - kJumpBackS;
  if (jumped_back) {
    buffer_.clear();
    objects_.clear();
    objects_stamp_s_ = -1e9;
    last_state_s_ = -1e9;
    if (activity_ != nullptr) {
      end(ActivityEnd::kStopped, "time jumped back");
    }
  }
  odometry_ = message;
  // By the clock, stamps show how late they come; a simulator's clock runs ahead of a busy machine.
  const double clock_s = ros::Time::isSimTime() ? now_s : ros::Time::now().toSec();
  tick(jumped_back ? now_s : std::max({now_s, clock_s, last_stamp_s_}));
}

void ExecutorNode::checkTicks() {
  checkTeleop();
  if (activity_ == nullptr) {
    return;
  }
  const double silent_s = std::chrono::duration<double>(SteadyClock::now() - last_tick_).count();
  const double now_s = ros::Time::now().toSec();
  if (silent_s > kTickMissingS && now_s > last_stamp_s_) {
    tick(now_s);
  } else if (silent_s > parameters_.dead_clock_s) {
    end(ActivityEnd::kStopped, "time has stood still for " +
                                   std::to_string(static_cast<int>(silent_s)) +
                                   " s: is the simulator or the robot gone?");
  }
}

std::string ExecutorNode::whatIsMissing() const {
  if (map_.planner() == nullptr) {
    return "there is no map yet (topic map/octomap)";
  }
  if (odometry_.header.stamp.isZero()) {
    return "there is no odometry with a time stamp yet (topic odom)";
  }
  const double now_s = ros::Time::now().toSec();
  if (now_s - odometry_.header.stamp.toSec() > parameters_.lost_objects_s) {
    return "odometry ceased (topic odom)";
  }
  try {
    if (now_s - robotPose(buffer_).stamp_s > parameters_.lost_objects_s) {
      return "the robot's pose is out of date (TF map -> base_link): has localisation stopped?";
    }
  } catch (const InputError& error) {
    return error.what();
  }
  if (now_s - objects_stamp_s_ > parameters_.lost_objects_s) {
    return "there are no tracked poses (topic objects): is perception gone?";
  }
  return "";
}

void ExecutorNode::begin(std::unique_ptr<Activity> activity) {
  activity_ = std::move(activity);
  end_ = ActivityEnd::kFinished;
  end_explanation_.clear();
  last_tick_ = SteadyClock::now();
  last_state_s_ = -1e9;
  objects_silence_.reset();
  observation_silence_.reset();
  watchdog_.arm();
}

void ExecutorNode::end(ActivityEnd how, const std::string& explanation) {
  end_ = how;
  end_explanation_ = explanation;
  command_.publish(geometry_msgs::Twist());
  activity_->cancel();
  tick(last_stamp_s_);
  // A tick without an observation ends nothing; nobody should wait for one after a stop.
  finish();
}

std::optional<Observation> ExecutorNode::observe(double now_s) {
  const std::string ahead = ahead_.check(buffer_);
  Observation observation;
  observation.stamp_s = now_s;
  try {
    if (!ahead.empty()) throw InputError("time stamps", ahead);
    const StampedRobotPose robot = robotPose(buffer_);
    observation.map_T_robot = robot.map_T_robot;
    // Where the robot is and how it moves: what is older counts.
    observation.robot_stamp_s = std::min(robot.stamp_s, odometry_.header.stamp.toSec());
    observation.robot_twist = fromMessage(odometry_.twist.twist);
  } catch (const std::exception& error) {
    blind_reason_ = error.what();
    ROS_WARN_THROTTLE(1.0, "no observation: %s", blind_reason_.c_str());
    return std::nullopt;
  }
  observation.objects = objects_;
  return observation;
}

void ExecutorNode::tick(double now_s) {
  last_stamp_s_ = now_s;
  if (activity_ == nullptr) {
    return;
  }
  last_tick_ = SteadyClock::now();
  watchdog_.feed();
  const std::optional<Observation> observation = observe(now_s);
  const double blind_s = observation_silence_.update(now_s, !observation);
  if (!observation) {
    command_.publish(geometry_msgs::Twist());
    if (blind_s > kBlindS && end_ == ActivityEnd::kFinished) {
      end(ActivityEnd::kStopped, "neither pose nor speed of the robot are known: " + blind_reason_);
    }
    return;
  }
  const bool is_stale = now_s - objects_stamp_s_ > parameters_.stale_objects_s;
  const double silent_s = objects_silence_.update(now_s, is_stale);
  if (silent_s > parameters_.lost_objects_s && end_ == ActivityEnd::kFinished) {
    end(ActivityEnd::kStopped, "tracked poses (topic objects) ceased: is perception gone?");
    return;
  }
  if (is_stale && end_ == ActivityEnd::kFinished) {
    // A behaviour whose commands are overridden would take the robot for held by something.
    command_.publish(toMessage(safeCommand(*observation, Twist2{})));
    return;
  }
  const Tick result = activity_->tick(*observation);
  command_.publish(toMessage(safeCommand(*observation, result.command.twist)));
  if (result.status != BehaviourStatus::kRunning) {
    finish();
  } else if (activity_->state().phase != last_phase_ || now_s - last_state_s_ >= kStatePeriodS) {
    publishState(now_s);
    activity_->publishFeedback();
  }
}

Twist2 ExecutorNode::safeCommand(const Observation& observation, const Twist2& wanted) {
  if (end_ != ActivityEnd::kFinished) {
    return Twist2{};
  }
  const CommandGuard::Verdict verdict =
      guard_.judge(wanted, observation.stamp_s - observation.robot_stamp_s,
                   observation.stamp_s - objects_stamp_s_);
  overridden_commands_ += verdict.reason.empty() ? 0 : 1;
  const std::string line =
      stands_.add(observation.stamp_s, ros::SteadyTime::now().toSec(), verdict.reason);
  if (!line.empty()) {
    ROS_WARN("%s", line.c_str());
  }
  return verdict.twist;
}

void ExecutorNode::finish() {
  if (activity_ == nullptr) {
    return;
  }
  watchdog_.disarm();
  command_.publish(geometry_msgs::Twist());
  // Nothing is active any more once the result is out, so that its receiver may send a new goal.
  const std::unique_ptr<Activity> ended = std::move(activity_);
  last_end_ = end_explanation_.empty() ? ended->describe() : end_explanation_;
  publishState(last_stamp_s_);
  if (std::optional<TaskSummary> summary = ended->summary()) {
    summarySink()(*summary);
  }
  ended->finish(end_, end_explanation_, last_stamp_s_);
}

SummarySink ExecutorNode::summarySink() {
  return [this](TaskSummary summary) {
    // Its behaviour does not know of a stop, nor, without an observation, of being cancelled.
    if (end_ == ActivityEnd::kStopped) {
      summary.status = "stopped";
      summary.explanation = end_explanation_;
    } else if (end_ == ActivityEnd::kCancelled) {
      summary.status = statusName(PushTaskStatus::kCancelled);
    }
    summary.header.stamp = toRosTime(last_stamp_s_);
    summary.header.frame_id = names::kMapFrame;
    summaries_.publish(summary);
  };
}

ReportSink ExecutorNode::reportSink() {
  return [this](const PushReport& report, const ReportContext& context) {
    publishReport(report, context);
  };
}

void ExecutorNode::publishReport(const PushReport& report, const ReportContext& context) {
  ExecutedPush message = toMessage(report);
  message.header.stamp = toRosTime(last_stamp_s_);
  message.header.frame_id = names::kMapFrame;
  message.sequence = ++report_count_;
  message.plan_number = static_cast<std::uint32_t>(context.plan_number);
  message.push_index = static_cast<std::uint32_t>(context.push_index);
  message.adapted = context.adapted;
  message.replan_cause = context.replan_cause;
  reports_.publish(message);
}

void ExecutorNode::publishState(double now_s) {
  ExecutorState state;
  if (activity_ != nullptr) {
    state = activity_->state();
  } else {
    state.phase = teleop_ ? "teleop" : "idle";
    state.description = teleop_ ? "driven by hand" : last_end_;
  }
  state.header.stamp = toRosTime(now_s);
  state.header.frame_id = names::kMapFrame;
  last_phase_ = state.phase;
  last_state_s_ = now_s;
  state_.publish(state);
}

void ExecutorNode::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string missing = whatIsMissing();
  if (!missing.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, missing);
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK,
                   whoIsBusy().empty() ? "idle" : whoIsBusy());
  }
  if (ros::SteadyTime::now().toSec() - foreign_command_s_ < kForeignS) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR,
                        "cmd_vel: " + foreign_commander_ + " commands the base, too");
  }
  status.add("planner is alive", plans_.isAlive());
  status.add("cases", cases_->size());
  status.add("pushes", report_count_);
  status.add("commands overridden with zero", overridden_commands_);
}

}  // namespace casepush
