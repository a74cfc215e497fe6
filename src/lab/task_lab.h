#pragma once

#include <memory>
#include <string>
#include <vector>

#include "casepush/lab/push_run.h"

namespace casepush {

/// Simulator, planner and cases for push tasks. Cases adapt in memory only. What it gives refers to
/// it.
class TaskLab {
 public:
  /// @param object_id  The one that the options' context is of; "" if it is of none.
  /// @throws InputError from the catalog, the simulator and the planner.
  TaskLab(const Catalog& catalog, const WorldModel& world, const std::string& object_id,
          const std::vector<Case>& cases, std::shared_ptr<const Map> map,
          const PushRunOptions& options);

  ClosedLoop& loop() { return loop_; }
  const PushPlanner& planner() const { return planner_; }
  PlanClient& plans() { return plans_; }
  const std::shared_ptr<const std::vector<Case>>& cases() const { return cases_; }

  /// With reports that are kept, and that adapt the cases if the options say so.
  PushTaskServices services();

  /// Of the cases as given, also if copies were pushed.
  const std::vector<PushReport>& reports() const { return reports_; }
  /// Changes of load or floor, in words; see AdaptingCases.
  const std::vector<std::string>& noticed() const { return noticed_; }
  double planningS() const { return planning_s_; }  ///< Wall time.

 private:
  void note(const PushReport& report);
  void renewCases();

  bool adapt_;
  ClosedLoop loop_;
  PushPlanner planner_;
  CaseBase base_;
  AdaptingCases adapting_;
  std::shared_ptr<const std::vector<Case>> cases_;
  DirectPlanClient plans_;
  std::vector<PushReport> reports_;
  std::vector<std::string> noticed_;
  double planning_s_ = 0.0;
};

}  // namespace casepush
