#include "casepush/execution/execute_push.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "approach_motion.h"
#include "blocked_watch.h"
#include "casepush/cases/outcome_statistics.h"
#include "casepush/common/check.h"
#include "casepush/common/violations.h"
#include "collision_watch.h"
#include "push_recorder.h"
#include "tube_watch.h"

namespace casepush {
namespace {

// An object that stays within this has not been pushed: the scatter of its estimate.
constexpr double kNotMovedM = 0.02;
constexpr double kNotMovedRad = 0.05;
// Without a command for so long the base has braked.
constexpr double kPauseS = 0.2;

std::string positionText(const Pose2& pose) {
  char text[48];
  std::snprintf(text, sizeof(text), "(%.1f m, %.1f m)", pose.x(), pose.y());
  return text;
}

}  // namespace

void ExecutePushOptions::validate() const {
  Violations violations;
  violations.require("sample_period_s", sample_period_s, 0.02, 1.0);
  violations.require("approach_speed_mps", approach_speed_mps, 0.02, 5.0);
  violations.require("dock_speed_mps", dock_speed_mps, 0.02, 5.0);
  violations.require("position_gain", position_gain, 0.0, 20.0);
  violations.require("yaw_gain", yaw_gain, 0.0, 20.0);
  violations.require("dock_tolerance_m", dock_tolerance_m, 0.001, 0.2);
  violations.require("dock_tolerance_rad", dock_tolerance_rad, 0.001, 0.5);
  violations.require("rest_speed_mps", rest_speed_mps, 0.001, 0.2);
  violations.require("rest_yaw_rate_rps", rest_yaw_rate_rps, 0.001, 0.5);
  violations.require("rest_time_s", rest_time_s, 0.0, 10.0);
  violations.require("rest_timeout_s", rest_timeout_s, 0.1, 600.0);
  violations.require("approach_timeout_s", approach_timeout_s, 0.1, 3600.0);
  violations.require("stale_robot_s", stale_robot_s, 0.01, 2.0);
  violations.require("blind_push_s", blind_push_s, 0.05, 60.0);
  violations.require("lost_object_s", lost_object_s, 0.1, 60.0);
  violations.require("alpha", alpha, 1e-9, 0.5);
  violations.require("tube.alpha", tube.alpha, 1e-12, 0.5);
  violations.require("tube.least_m", tube.least_m, 0.0, 10.0);
  violations.require("tube.least_rad", tube.least_rad, 0.0, 3.2);
  violations.require("tube.slack_s", tube.slack_s, 0.0, 10.0);
  violations.require("tube.hold_s", tube.hold_s, 0.0, 10.0);
  violations.require("blocked_m", blocked_m, 0.02, 10.0);
  violations.require("blocked_s", blocked_s, 0.0, 10.0);
  violations.throwIfAny("push options");
}

const char* toString(OutcomeTest test) {
  return test == OutcomeTest::kHotelling ? "hotelling" : "plug_in";
}

bool isObservation(const PushReport& report) {
  return report.outcome == PushOutcome::kDone || report.outcome == PushOutcome::kNotMoved ||
         report.outcome == PushOutcome::kBrokenOff;
}

bool wasMade(const PushReport& report) {
  return isObservation(report) || report.outcome == PushOutcome::kStoppedShort;
}

struct ExecutePush::Data {
  Data(std::string id, std::optional<Case> replayed, PushTrajectory push_trajectory,
       RobotModel robot_model, ApproachPlanner approach_planner,
       const ExecutePushOptions& push_options)
      : object_id(std::move(id)),
        push_case(std::move(replayed)),
        trajectory(std::move(push_trajectory)),
        robot(std::move(robot_model)),
        options(push_options),
        approach(object_id, trajectory, robot.limits, std::move(approach_planner), options),
        limiter(robot.limits),
        robot_watch(options.stale_robot_s),
        rest(options),
        held(options.blocked_m, options.blocked_s) {
    if (push_case && options.tube.on) {
      tube.emplace(*push_case, options.tube);
    }
  }

  std::string object_id;
  std::optional<Case> push_case;
  PushTrajectory trajectory;
  RobotModel robot;
  ExecutePushOptions options;

  ApproachMotion approach;
  CommandLimiter limiter;
  RobotWatch robot_watch;
  BlockedWatch blocked;
  Twist2 commanded;  ///< At the last tick.
  RestWatch rest;
  HoldWatch held;
  TickClock clock;
  std::optional<TubeWatch> tube;
  std::optional<CollisionWatch> ahead;
  std::optional<PushRecorder> recorder;

  Phase phase = Phase::kApproach;
  bool cancelled = false;
  std::optional<double> began_s;
  double now_s = 0.0;
  double push_time_s = 0.0;  ///< Since the push began, without interruptions.
  double moved_at_s = 0.0;   ///< When the last command was given that the base may follow.
  double push_end_s = 0.0;   ///< In push time: when the robot stopped.
  bool broken_off = false;
  std::string ahead_of;  ///< What the object was about to touch when the push was stopped.
  std::optional<ObjectState> object;  ///< Last usable state.
  PushReport draft;
  std::optional<PushReport> report;

  Tick run(const Observation& observation);
  void resume();
  Twist2 move(const Observation& observation, double dt_s);
  Twist2 approachTick(const Observation& observation, double dt_s);
  void beginPush(const Observation& observation);
  Twist2 pushTick(const Observation& observation);
  Twist2 followPush(const Observation& observation);
  bool hasLeftTube();
  Twist2 restTick(const Observation& observation);
  void conclude();
  void finish(PushOutcome outcome, const std::string& explanation);
};

// Commands after a pause begin at a standstill. A push that paused is not the one of the case.
void ExecutePush::Data::resume() {
  const double paused_s = now_s - moved_at_s;
  if (paused_s > kPauseS) limiter.stop();
  if (phase == Phase::kPush && paused_s > options.blind_push_s) {
    finish(PushOutcome::kTimeout, "the push of " + object_id + " was interrupted");
  }
  moved_at_s = now_s;
}

// Also rounds off the report of a push that failed: what was recorded so far stays in it.
void ExecutePush::Data::finish(PushOutcome outcome, const std::string& explanation) {
  phase = Phase::kFinished;
  draft.outcome = outcome;
  draft.explanation = explanation;
  draft.object_id = object_id;
  draft.case_id = push_case ? push_case->id : 0;
  draft.end_stamp_s = now_s;
  if (object) {
    draft.map_T_end = object->map_T_object;
  }
  if (recorder) {
    const double rest_from_s = rest.sinceS() - draft.start_stamp_s;
    draft.recorded = recorder->finish(rest_from_s, draft.map_T_end);
    draft.recorded.object = push_case ? push_case->object : object->model;
    draft.recorded.robot = robot.name;
  }
  report = draft;
}

void ExecutePush::Data::conclude() {
  const Pose2 start_T_end = draft.map_T_start.inverse() * object->map_T_object;
  if (push_case) {
    draft.map_expected = transform(draft.map_T_start, push_case->start_outcome);
    const OutcomeStatistics past{push_case->start_outcome, push_case->effective_count};
    draft.test = options.test == OutcomeTest::kHotelling
                     ? testPrediction(past, start_T_end, options.alpha)
                     : testPlugIn(past, start_T_end, options.alpha);
  }
  const std::string stopped =
      ahead_of.empty() ? "" : "stopped before " + object_id + " touched " + ahead_of;
  if (broken_off) {
    draft.test.rejected = true;
    draft.test.p_value = std::min(draft.test.p_value, tube->pValue());
    finish(PushOutcome::kBrokenOff, (stopped.empty() ? "broken off" : stopped) + ": " + object_id +
                                        " was " + tube->describe());
    return;
  }
  if (!stopped.empty()) {
    draft.test = {};
    finish(PushOutcome::kStoppedShort, stopped);
    return;
  }
  if (start_T_end.position().norm() < kNotMovedM && std::abs(start_T_end.yaw()) < kNotMovedRad) {
    finish(PushOutcome::kNotMoved, object_id + " did not move");
    return;
  }
  finish(PushOutcome::kDone, draft.test.rejected ? object_id + " rests elsewhere than predicted"
                                                 : object_id + " is at rest");
}

Twist2 ExecutePush::Data::approachTick(const Observation& observation, double dt_s) {
  if (now_s - *began_s > options.approach_timeout_s) {
    finish(PushOutcome::kTimeout, "the approach took too long: " + approach.describe());
    return Twist2{};
  }
  if (blocked.isBlocked(observation, commanded, BlockedWatch::Drive::kFree)) {
    finish(PushOutcome::kApproachFailed,
           "something unknown holds the robot at " + positionText(observation.map_T_robot));
    return Twist2{};
  }
  const ApproachMotion::Step step = approach.step(observation, object ? &*object : nullptr, dt_s);
  if (step.failure) {
    finish(step.failure->outcome, step.failure->explanation);
    return Twist2{};
  }
  if (step.arrived) {
    beginPush(observation);
    return pushTick(observation);
  }
  phase = approach.docking() ? Phase::kDock : Phase::kApproach;
  return step.wanted;
}

void ExecutePush::Data::beginPush(const Observation& observation) {
  phase = Phase::kPush;
  push_time_s = 0.0;
  draft.start_stamp_s = observation.stamp_s;
  draft.map_T_start = object->map_T_object;
  recorder.emplace(options.sample_period_s, draft.map_T_start);
  if (ahead) ahead->begin(observation, draft.map_T_start);
}

Twist2 ExecutePush::Data::followPush(const Observation& observation) {
  const Reference reference{draft.map_T_start * trajectory.poseAt(push_time_s),
                            trajectory.actionAt(push_time_s)};
  if (blocked.isBlocked(observation, commanded, BlockedWatch::Drive::kPushing) ||
      held.isHeld(push_time_s, distance(observation.map_T_robot, reference.map_T_reference))) {
    finish(PushOutcome::kBlocked, "something holds the robot while it pushes " + object_id);
    return Twist2{};
  }
  return track(observation.map_T_robot, reference, {options.position_gain, options.yaw_gain});
}

bool ExecutePush::Data::hasLeftTube() {
  return tube && tube->hasLeft(push_time_s, object->stamp_s,
                               draft.map_T_start.inverse() * object->map_T_object);
}

Twist2 ExecutePush::Data::pushTick(const Observation& observation) {
  if (now_s - object->stamp_s > options.blind_push_s) {
    finish(PushOutcome::kObjectLost, object_id + " was lost from sight during the push");
    return Twist2{};
  }
  broken_off = hasLeftTube();
  bool is_over = broken_off || push_time_s >= trajectory.durationS() - 1e-6;
  if (!is_over && ahead) {
    ahead_of = ahead->aheadOf(observation, push_time_s, *object);
    is_over = !ahead_of.empty();
    // Off its course, it also tells that the case is wrong.
    broken_off = is_over && tube && tube->isOutside();
  }
  const Twist2 wanted = is_over ? Twist2{} : followPush(observation);
  recorder->add(push_time_s, observation.map_T_robot, object->map_T_object, wanted);
  if (is_over) {
    recorder->endPush();
    push_end_s = push_time_s;
    phase = Phase::kRest;
    rest.reset();
  }
  return wanted;
}

Twist2 ExecutePush::Data::restTick(const Observation& observation) {
  recorder->add(push_time_s, observation.map_T_robot, object->map_T_object, Twist2{});
  if (rest.isAtRest(*object)) {
    conclude();
  } else if (now_s - object->stamp_s > options.lost_object_s) {
    finish(PushOutcome::kObjectLost, object_id + " was lost from sight while it coasted");
  } else if (push_time_s - push_end_s > options.rest_timeout_s) {
    finish(PushOutcome::kTimeout, object_id + " does not come to rest");
  }
  return Twist2{};
}

Twist2 ExecutePush::Data::move(const Observation& observation, double dt_s) {
  switch (phase) {
    case Phase::kApproach:
    case Phase::kDock:
      return approachTick(observation, dt_s);
    case Phase::kPush:
      push_time_s += dt_s;
      return pushTick(observation);
    case Phase::kRest:
      push_time_s += dt_s;
      return restTick(observation);
    case Phase::kFinished:
      break;
  }
  return Twist2{};
}

Tick ExecutePush::Data::run(const Observation& observation) {
  if (cancelled) {
    finish(PushOutcome::kCancelled, "cancelled");
    return {};
  }
  const RobotWatch::Status robot_status = robot_watch.check(observation);
  if (!std::isfinite(observation.stamp_s)) {
    limiter.stop();
    return {};
  }
  now_s = observation.stamp_s;
  began_s = began_s.value_or(now_s);
  const std::optional<double> dt_s = clock.advance(now_s);
  const ObjectState* seen = observation.object(object_id);
  if (seen != nullptr && isUsable(*seen)) {
    object = *seen;
  }
  if (!dt_s) {
    finish(PushOutcome::kTimeout, "time went back");
  } else if (robot_status == RobotWatch::Status::kLost) {
    finish(PushOutcome::kRobotLost, "the robot's own pose is not up to date");
  } else if (robot_status == RobotWatch::Status::kFresh && (seen == nullptr || isUsable(*seen))) {
    resume();
    const Twist2 wanted = move(observation, *dt_s);
    const bool must_stand = phase == Phase::kRest || phase == Phase::kFinished;
    if (!must_stand) {
      commanded = limiter.limit(wanted, *dt_s);
      return {{commanded}, BehaviourStatus::kRunning};
    }
  } else if (object && now_s - object->stamp_s > options.lost_object_s &&
             phase != Phase::kApproach) {
    finish(PushOutcome::kObjectLost, object_id + " was lost from sight");
  }
  limiter.stop();
  commanded = Twist2{};
  return {};
}

ExecutePush::ExecutePush(std::string object_id, PushConfiguration configuration, RobotModel robot,
                         ApproachPlanner approach, ExecutePushOptions options) {
  options.validate();
  PushTrajectory trajectory = pushTrajectory(configuration, robot.limits, options.sample_period_s);
  data_ = std::make_unique<Data>(std::move(object_id), std::nullopt, std::move(trajectory),
                                 std::move(robot), std::move(approach), options);
}

ExecutePush::ExecutePush(std::string object_id, Case push_case, RobotModel robot,
                         ApproachPlanner approach, ExecutePushOptions options) {
  options.validate();
  PushTrajectory trajectory = pushTrajectory(push_case);
  data_ = std::make_unique<Data>(std::move(object_id), std::move(push_case), std::move(trajectory),
                                 std::move(robot), std::move(approach), options);
}

ExecutePush::~ExecutePush() = default;
ExecutePush::ExecutePush(ExecutePush&&) noexcept = default;
ExecutePush& ExecutePush::operator=(ExecutePush&&) noexcept = default;

Tick ExecutePush::tick(const Observation& observation) {
  Tick tick;
  if (data_->phase != Phase::kFinished) {
    tick = data_->run(observation);
  }
  if (data_->phase == Phase::kFinished) {
    const bool is_done = data_->report->outcome == PushOutcome::kDone;
    tick.status = is_done ? BehaviourStatus::kSucceeded : BehaviourStatus::kFailed;
    tick.command = Command{};
  }
  return tick;
}

std::string ExecutePush::describe() const {
  switch (data_->phase) {
    case Phase::kApproach:
    case Phase::kDock:
      return data_->approach.describe();
    case Phase::kPush:
      return "pushing " + data_->object_id;
    case Phase::kRest:
      return "waiting for " + data_->object_id + " to come to rest";
    case Phase::kFinished:
      break;
  }
  return data_->report->explanation;
}

void ExecutePush::cancel() { data_->cancelled = true; }

void ExecutePush::watchAhead(TouchCheck check) {
  if (data_->options.watch_ahead && data_->push_case && check) {
    data_->ahead.emplace(*data_->push_case, std::move(check));
  }
}

ExecutePush::Phase ExecutePush::phase() const { return data_->phase; }

const std::optional<PushReport>& ExecutePush::report() const { return data_->report; }

}  // namespace casepush
