#include "task_lab.h"

#include <utility>

#include "casepush/cases/shortened_case.h"

namespace casepush {

TaskLab::TaskLab(const Catalog& catalog, const WorldModel& world, const std::string& object_id,
                 const std::vector<Case>& cases, std::shared_ptr<const Map> map,
                 const PushRunOptions& options)
    : adapt_(options.adapt),
      loop_(catalog, world, options.lab),
      planner_(std::move(map), loop_.simulator().robot(), catalog.objectsIn(world),
               options.planner),
      base_(cases, options.adapting.floor),
      adapting_(&base_, {}, options.adapting),
      plans_(planner_, [this] { return cases_; }) {
  if (!object_id.empty()) {
    adapting_.tell(loop_.simulator().object(object_id).name, options.context);
  }
  renewCases();
}

void TaskLab::renewCases() {
  cases_ = std::make_shared<const std::vector<Case>>(withShortened(adapting_.cases()));
}

PushTaskServices TaskLab::services() {
  PushTaskServices services;
  services.plans = &plans_;
  services.checker = &planner_;
  services.cases = [this] { return cases_; };
  services.clearing = clearWayServices(
      [this] { return std::shared_ptr<const PushPlanner>(std::shared_ptr<void>(), &planner_); },
      loop_.simulator().robot().name, services.cases);
  services.on_report = [this](const PushReport& report) { note(report); };
  services.on_plan = [this](const PlanResult& plan) { planning_s_ += plan.planning_s; };
  return services;
}

void TaskLab::note(const PushReport& report) {
  reports_.push_back(report);
  if (report.case_id < 0) return;  // What a shortened case does teaches nothing.
  // It may be of a copy made since.
  reports_.back().case_id = families(base_.cases()).at(report.case_id);
  if (!adapt_ || !isObservation(report)) return;
  const std::string notice = adapting_.learnFrom(report);
  if (!notice.empty()) noticed_.push_back(notice);
  renewCases();
}

}  // namespace casepush
