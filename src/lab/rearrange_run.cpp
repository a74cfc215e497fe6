#include "casepush/lab/rearrange_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/input_error.h"
#include "task_lab.h"

namespace casepush {
namespace {

constexpr double kSettleS = 1.0;

void checkObjects(const WorldModel& world, const RearrangeRequest& request) {
  for (const PushTaskGoal& task : request.tasks) {
    const bool is_there =
        std::any_of(world.objects.begin(), world.objects.end(),
                    [&task](const ObjectPlacement& each) { return each.id == task.object_id; });
    if (is_there) continue;
    std::string known;
    for (const ObjectPlacement& each : world.objects) {
      known += (known.empty() ? "" : ", ") + each.id;
    }
    throw InputError("rearrange", "world " + world.name + " has no object '" + task.object_id +
                                      "'; it has " + (known.empty() ? "none" : known));
  }
}

RearrangeServices servicesOf(TaskLab* lab, const PushTaskOptions& options) {
  RearrangeServices services;
  services.plans = &lab->plans();
  services.make_task = [lab, options](const PushTaskGoal& task) {
    return std::make_unique<PushTask>(task, lab->loop().simulator().robot(), lab->services(),
                                      options);
  };
  services.in_the_way = [lab](const PushPlan& plan, const std::vector<PlacedObject>& objects) {
    return lab->planner().inTheWay(plan, *lab->cases(), objects);
  };
  return services;
}

}  // namespace

RearrangeRunResult runRearrange(const Catalog& catalog, const WorldModel& world,
                                const RearrangeRequest& request, const std::vector<Case>& cases,
                                std::shared_ptr<const Map> map, const PushRunOptions& options,
                                const std::function<void(const Rearrange&)>& watch) {
  checkObjects(world, request);
  TaskLab lab(catalog, world, "", cases, std::move(map), options);
  ClosedLoop& loop = lab.loop();
  RearrangeOptions rearrange_options;
  rearrange_options.plan_deadline_s = options.task.plan_deadline_s;
  Rearrange rearrange(request, servicesOf(&lab, options.task), rearrange_options);
  loop.run(rearrange, request.time_limit_s + kSettleS, [&] {
    if (watch) watch(rearrange);
  });
  RearrangeRunResult result;
  result.sim_time_s = loop.simulator().time();
  loop.idle(kSettleS);
  result.status = rearrange.status();
  result.explanation = rearrange.describe();
  for (std::size_t i = 0; i < request.tasks.size(); ++i) {
    const PushTaskGoal& task = request.tasks[i];
    const Pose2 end = loop.simulator().trueObjectPose(task.object_id);
    result.objects.push_back({rearrange.items()[i], task.tolerance.isMet(task.map_T_goal, end),
                              distance(end, task.map_T_goal),
                              std::abs(yawDifference(task.map_T_goal, end))});
  }
  for (const int index : rearrange.order()) {
    result.order.push_back(rearrange.items()[index].object_id);
  }
  result.success = result.status == PushTaskStatus::kSucceeded &&
                   std::all_of(result.objects.begin(), result.objects.end(),
                               [](const RearrangeRunResult::Object& each) { return each.at_goal; });
  result.planning_s = lab.planningS();
  result.collisions = loop.collisions();
  result.collision_names = loop.collisionNames();
  result.reports = lab.reports();
  return result;
}

}  // namespace casepush
