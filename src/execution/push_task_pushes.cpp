// How PushTask executes a plan: one push after the other, and what each outcome means for the rest.
#include <algorithm>
#include <cmath>
#include <vector>

#include "push_task_data.h"
#include "push_task_rules.h"
#include "rest_of_plan.h"

namespace casepush {
namespace {

// A push that moves the object less than this did not move it: the scatter of its estimate.
constexpr double kIdleM = 0.02;
constexpr double kIdleRad = 0.05;

bool hasMoved(const PushReport& report) {
  return distance(report.map_T_start, report.map_T_end) > kIdleM ||
         std::abs(yawDifference(report.map_T_start, report.map_T_end)) > kIdleRad;
}

/// What a rejected prediction counts as.
ReplanCause causeOf(const PushReport& report) {
  return report.outcome == PushOutcome::kBrokenOff ? ReplanCause::kLeftTube
                                                   : ReplanCause::kPredictionRejected;
}

}  // namespace

void PushTask::Data::startPush(const Observation& observation) {
  const PlannedPush& planned = plan->pushes.front();
  const auto cases = services.cases();
  const Case* found = findCase(*cases, planned.case_id);
  if (found == nullptr) {
    PlanResult unknown;
    unknown.status = PlanStatus::kUnreachable;
    unknown.explanation =
        "the plan uses case " + std::to_string(planned.case_id) + ", which is not known here";
    rejectPlan(unknown, observation);
    return;
  }
  if (isLimitReached()) {
    return;
  }
  if (beginClearing(observation)) {
    return;
  }
  failed_plans = 0;
  ++progress.push_index;
  push.emplace(goal.object_id, *found, robot, services.approach, options.push);
  push->watchAhead(services.touches);
  enter(Stage::kPush, "approach", "approaching", observation.stamp_s);
}

bool PushTask::Data::isLimitReached() {
  const std::string why = limitReached(goal.object_id, progress, options, plans_without_progress);
  if (!why.empty()) {
    end(PushTaskStatus::kNoProgress, why);
  }
  return stage == Stage::kDone;
}

Tick PushTask::Data::pushOn(const Observation& observation) {
  static const char* const kPhases[] = {"approach", "dock", "push", "rest", "rest"};
  const Tick tick = push->tick(observation);
  progress.phase = kPhases[static_cast<int>(push->phase())];
  text = push->describe();
  if (!push->report()) {
    return tick;
  }
  const PushReport report = *push->report();
  push.reset();
  if (wasMade(report)) {
    ++progress.pushes;
    ++progress.pushes_per_plan.back();
    ++progress.pushes_unchanged.back();
    progress.idle_pushes = hasMoved(report) ? 0 : progress.idle_pushes + 1;
  }
  if (report.test.rejected) {
    ++progress.rejected_predictions;
  }
  if (services.on_report) {
    services.on_report(report);
  }
  concludePush(report, observation);
  return {};
}

void PushTask::Data::concludePush(const PushReport& report, const Observation& observation) {
  switch (report.outcome) {
    case PushOutcome::kDone:
    case PushOutcome::kNotMoved:
    case PushOutcome::kBrokenOff:
      failed_approaches = 0;
      judgeOutcome(report, observation);
      return;
    case PushOutcome::kApproachFailed:
    case PushOutcome::kBlocked:
      if (++failed_approaches >= options.max_failed_plans) {
        end(PushTaskStatus::kNoProgress,
            "the robot can not get to the next push: " + report.explanation);
      } else {
        replan(report.outcome == PushOutcome::kBlocked ? ReplanCause::kPushFailed
                                                       : ReplanCause::kApproachFailed,
               report.explanation, observation);
      }
      return;
    case PushOutcome::kRobotLost:
      end(PushTaskStatus::kRobotLost, report.explanation);
      return;
    case PushOutcome::kStoppedShort:
      failed_approaches = 0;
      if (!endAtGoal(observation)) {
        replan(ReplanCause::kStoppedShort, report.explanation, observation);
      }
      return;
    case PushOutcome::kObjectLost:
    case PushOutcome::kTimeout:
    case PushOutcome::kCancelled:
      replan(ReplanCause::kPushFailed, report.explanation, observation);
      return;
  }
}

bool PushTask::Data::endAtGoal(const Observation& observation) {
  const ObjectState* object = usableObject(observation, goal.object_id);
  if (object == nullptr || !isSafelyAtGoal(goal, *object, options)) {
    return false;
  }
  end(PushTaskStatus::kSucceeded, goal.object_id + " is at the goal");
  return true;
}

void PushTask::Data::judgeOutcome(const PushReport& report, const Observation& observation) {
  const ObjectState* object = usableObject(observation, goal.object_id);
  if (object == nullptr) {
    replan(ReplanCause::kPushFailed, goal.object_id + " is not in sight", observation);
    return;
  }
  if (endAtGoal(observation)) {
    return;
  }
  plan->pushes.erase(plan->pushes.begin());
  endRepair();
  if (report.test.rejected && options.rest.replan_when_rejected) {
    replan(causeOf(report), report.explanation, observation);
  } else if (plan->pushes.empty()) {
    replan(ReplanCause::kEndedBesideGoal, "the plan ended beside the goal", observation);
  } else {
    goOn(report, *object, observation);
  }
}

void PushTask::Data::goOn(const PushReport& report, const ObjectState& object,
                          const Observation& observation) {
  PushPlanner::Continuation rest_of_plan =
      services.continue_plan(*plan, object.map_T_object, *services.cases(), obstacles(observation));
  // The planner knows of no way without it.
  if (accepted_dead_end == progress.push_index + 1) rest_of_plan.may_get_stuck = false;
  const RestVerdict verdict = judgeRest(rest_of_plan, options.rest);
  const std::string newcomer = newcomerInTheWay(rest_of_plan.plan, observation);
  if (!newcomer.empty()) {
    replan(ReplanCause::kRestCollides, newcomer + " came in sight in the way", observation);
  } else if (!verdict.goes_on && report.test.rejected) {
    replan(causeOf(report), report.explanation, observation);
  } else if (verdict.goes_on || beginRepair(verdict, rest_of_plan.plan, observation)) {
    plan = rest_of_plan.plan;
    startPush(observation);
  } else {
    replan(verdict.cause, verdict.why, observation);
  }
}

void PushTask::Data::replan(ReplanCause cause, const std::string& why,
                            const Observation& observation) {
  ++progress.replans;
  ++progress.replan_causes[cause];
  progress.replan_history.push_back(cause);
  progress.replan_reasons.push_back(why);
  if (!isLimitReached()) {
    dropRepair();
    rest.reset();
    enter(Stage::kLook, "look", "planning anew: " + why, observation.stamp_s);
  }
}

}  // namespace casepush
