#include "casepush/lab/learning.h"

#include <algorithm>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/lab/push_run.h"
#include "push_pool.h"

namespace casepush {
namespace {

constexpr int kMaxJobs = 256;

PushContext contextOf(const LearningOptions& options) {
  PushContext context;
  context.load_kg = options.load ? options.load->mass_kg : 0.0;
  return context;
}

/// The loop that both ways of learning have in common.
class Learning {
 public:
  Learning(Exploration& exploration, CaseBase& case_base, const LearningOptions& options,
           const std::function<bool(const LearningProgress&)>& progress)
      : exploration_(exploration), case_base_(case_base), options_(options), progress_(progress) {}

  std::optional<Case> caseOf(const Exploration::Trial& trial) const {
    return trial.case_id ? std::optional<Case>(case_base_.get(*trial.case_id)) : std::nullopt;
  }

  /// False if learning should stop here.
  bool report(const Exploration::Trial& trial) {
    const LearningProgress now{trial.case_number,
                               options_.exploration.cases,
                               trial.practice_number,
                               options_.exploration.practices,
                               result.pushes,
                               exploration_.discarded(),
                               exploration_.pushesDone()};
    if (progress_ && !progress_(now)) {
      result.explanation = "stopped on request; finished pushes are kept";
      return false;
    }
    return true;
  }

  void keepPush(const Exploration::Trial& trial, const PushReport& report,
                const PushGround* ground = nullptr) {
    ++result.pushes;
    keep(exploration_, trial, report, case_base_, {options_.floor, contextOf(options_)}, ground);
  }

  LearningResult finish() {
    result.discarded = exploration_.discarded();
    result.brought_back = exploration_.broughtBack();
    result.dropped = exploration_.dropped();
    result.success = exploration_.finished() && !exploration_.gaveUp();
    if (exploration_.gaveUp()) {
      result.explanation = exploration_.explanation();
    } else if (result.success) {
      result.explanation = "learnt " + std::to_string(options_.exploration.cases) + " cases";
    }
    return result;
  }

  LearningResult result;

 private:
  Exploration& exploration_;
  CaseBase& case_base_;
  const LearningOptions& options_;
  const std::function<bool(const LearningProgress&)>& progress_;
};

LearningResult learnByPlacing(const Catalog& catalog, const std::string& object,
                              const std::string& robot, CaseBase& case_base,
                              const LearningOptions& options,
                              const std::function<bool(const LearningProgress&)>& progress) {
  PushPool pool(catalog, object, robot, options);
  Exploration exploration(pool.object(), pool.robot(), options.exploration);
  exploration.resume(learntIn(case_base.cases(pool.object().name), contextOf(options)));
  Learning learning(exploration, case_base, options, progress);
  while (const auto trial = exploration.next()) {
    if (!learning.report(*trial)) {
      break;
    }
    const PushPool::Result done = pool.run(*trial, learning.caseOf(*trial));
    learning.result.sim_time_s += done.sim_time_s;
    learning.keepPush(*trial, done.report);
  }
  return learning.finish();
}

LearningResult learnByDriving(const Catalog& catalog, const WorldModel& room, CaseBase& case_base,
                              const LearningOptions& options,
                              const std::function<bool(const LearningProgress&)>& progress) {
  const std::string id = room.objects.front().id;
  ClosedLoop loop(catalog, room, loadedLab(options, id));
  const ObjectModel& object = loop.simulator().object(id);
  const RobotModel& robot = loop.simulator().robot();
  const std::shared_ptr<const Map> map = surveyMap(room);
  const PushPlanner planner(map, robot, catalog.objectsIn(room), PushPlannerOptions{});
  const PushGround ground(CollisionChecker(*map), object, robot,
                          room.objects.front().map_T_object.position());
  Exploration exploration(object, robot, options.exploration);
  exploration.resume(learntIn(case_base.cases(object.name), contextOf(options)));
  Learning learning(exploration, case_base, options, progress);
  Pose2 map_T_object = room.objects.front().map_T_object;
  while (const auto trial = exploration.next(ground, map_T_object)) {
    if (!learning.report(*trial)) {
      break;
    }
    const PushReport report = runPush(loop, makePush(id, *trial, learning.caseOf(*trial), robot,
                                                     approachPlanner(planner, id), options.push));
    learning.keepPush(*trial, report, &ground);
    const Observation now = loop.observe();
    if (const ObjectState* seen = now.object(id)) {
      map_T_object = seen->map_T_object;
    }
  }
  learning.result.collisions = loop.collisions();
  learning.result.sim_time_s = loop.simulator().time();
  return learning.finish();
}

}  // namespace

LearningResult learnInLab(const Catalog& catalog, const std::string& object,
                          const std::string& robot, CaseBase& case_base,
                          const LearningOptions& options,
                          const std::function<bool(const LearningProgress&)>& progress) {
  if (options.jobs < 1 || options.jobs > kMaxJobs) {
    throw InputError("jobs", "is " + std::to_string(options.jobs) + ", must be in [1, 256]");
  }
  if (options.reset == LabReset::kDrive) {
    const WorldModel room = options.room.value_or(learningArena(object, robot, true));
    return learnByDriving(catalog, room, case_base, options, progress);
  }
  return learnByPlacing(catalog, object, robot, case_base, options, progress);
}

}  // namespace casepush
