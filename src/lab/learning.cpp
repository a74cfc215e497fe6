#include "casepush/lab/learning.h"

#include <algorithm>
#include <optional>

namespace casepush {
namespace {

constexpr char kObjectId[] = "object";
constexpr double kArenaHalfM = 8.0;
constexpr double kPushLimitS = 60.0;

WorldModel arena(const std::string& object, const std::string& robot) {
  WorldModel world;
  world.name = "arena";
  world.min_m = {-kArenaHalfM, -kArenaHalfM};
  world.max_m = {kArenaHalfM, kArenaHalfM};
  world.robot = robot;
  world.map_T_robot = Pose2(-2.0, 0.0, 0.0);
  world.objects.push_back({kObjectId, object, Pose2(), 0});
  return world;
}

/// The robot is put right behind where a push starts, so its approach is a straight line.
RobotPath straightPath(const Observation& observation, const Pose2& goal,
                       double /*dock_direction_rad*/) {
  RobotPath path;
  path.found = true;
  path.waypoints = {observation.map_T_robot, goal};
  path.length_m = distance(observation.map_T_robot, goal);
  return path;
}

ExecutePush makePush(const Exploration::Trial& trial, const CaseBase& case_base,
                     const RobotModel& robot, const ExecutePushOptions& options) {
  if (trial.case_id) {
    return ExecutePush(kObjectId, case_base.get(*trial.case_id), robot, straightPath, options);
  }
  return ExecutePush(kObjectId, trial.configuration, robot, straightPath, options);
}

// Those that were learnt with the same load.
std::vector<Case> casesOf(const CaseBase& case_base, const std::string& object,
                          const PushContext& context) {
  std::vector<Case> cases = case_base.cases(object);
  const auto is_other = [&](const Case& push_case) {
    return contextDistance(push_case.context, context) > 0.0;
  };
  cases.erase(std::remove_if(cases.begin(), cases.end(), is_other), cases.end());
  return cases;
}

Case withContext(Case push_case, const PushContext& context) {
  push_case.context = context;
  return push_case;
}

}  // namespace

LearningResult learnInLab(const Catalog& catalog, const std::string& object,
                          const std::string& robot, CaseBase& case_base,
                          const LearningOptions& options,
                          const std::function<bool(const LearningProgress&)>& progress) {
  LabOptions lab = options.lab;
  if (options.load) {
    lab.simulator.loads[kObjectId] = *options.load;
  }
  ClosedLoop loop(catalog, arena(object, robot), lab);
  const ObjectModel& object_model = loop.simulator().object(kObjectId);
  const RobotModel& robot_model = loop.simulator().robot();
  Exploration exploration(object_model, robot_model, options.exploration);
  PushContext context;
  context.load_kg = options.load ? options.load->mass_kg : 0.0;
  exploration.resume(casesOf(case_base, object_model.name, context));

  LearningResult result;
  while (const std::optional<Exploration::Trial> trial = exploration.next()) {
    const LearningProgress now{trial->case_number,     options.exploration.cases,
                               trial->practice_number, options.exploration.practices,
                               result.pushes,          exploration.discarded()};
    if (progress && !progress(now)) {
      result.explanation = "stopped on request; finished pushes are kept";
      break;
    }
    loop.place({{kObjectId, Pose2()}, {"robot", trial->object_T_reset}});
    ExecutePush push = makePush(*trial, case_base, robot_model, options.push);
    loop.run(push, kPushLimitS);
    if (!push.report()) {
      push.cancel();
      push.tick(loop.observe());
    }
    ++result.pushes;
    const PushReport& report = *push.report();
    std::optional<Case> updated;
    if (trial->case_id && isObservation(report)) {
      updated = case_base.observe(*trial->case_id, observedPush(report, context), options.floor);
    }
    switch (exploration.judge(report, updated)) {
      case Exploration::Verdict::kStoreCase:
        exploration.stored(
            case_base.add(withContext(report.recorded, context), report.end_stamp_s));
        break;
      case Exploration::Verdict::kDropCase:
        case_base.remove(*trial->case_id);
        break;
      case Exploration::Verdict::kObserve:
      case Exploration::Verdict::kDiscard:
        break;
    }
  }
  result.discarded = exploration.discarded();
  result.dropped = exploration.dropped();
  result.sim_time_s = loop.simulator().time();
  result.success = exploration.finished() && !exploration.gaveUp();
  if (exploration.gaveUp()) {
    result.explanation = exploration.explanation();
  } else if (result.success) {
    result.explanation = "learnt " + std::to_string(options.exploration.cases) + " cases";
  }
  return result;
}

}  // namespace casepush
