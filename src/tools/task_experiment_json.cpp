#include "task_experiment_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "casepush/lab/binomial_interval.h"
#include "casepush/lab/quantile.h"

namespace casepush {
namespace {

constexpr double kDegree = M_PI / 180.0;

template <typename Value>
nlohmann::ordered_json spreadJson(const std::vector<TaskRun>& runs, const Value& value) {
  std::vector<double> values;
  double sum = 0.0;
  for (const TaskRun& run : runs) {
    values.push_back(value(run.result));
    sum += values.back();
  }
  return {{"mean", sum / static_cast<double>(values.size())},
          {"median", quantile(values, 0.5)},
          {"p90", quantile(values, 0.9)}};
}

nlohmann::ordered_json shareJson(int part, int whole) {
  const BinomialInterval interval = wilsonInterval(part, std::max(whole, 1));
  return {{"count", part},
          {"of", whole},
          {"share", interval.share},
          {"ci95", {interval.low, interval.high}}};
}

/// Pushes in a row with one plan, task by task.
struct Rows {
  std::vector<double> before_replan;  ///< Those that ended in a re-plan.
  std::vector<double> all;            ///< And those that ended at the goal.
  std::vector<double> before_change;  ///< Those that ended in a re-plan or a repair.
};

Rows rowsOf(const std::vector<TaskRun>& runs) {
  Rows rows;
  for (const TaskRun& run : runs) {
    const PushTaskProgress& progress = run.result.progress;
    const auto given_up = static_cast<std::size_t>(progress.replans);
    for (std::size_t i = 0; i < progress.pushes_per_plan.size(); ++i) {
      rows.all.push_back(progress.pushes_per_plan[i]);
      if (i < given_up) {
        rows.before_replan.push_back(progress.pushes_per_plan[i]);
      }
    }
    const auto changed = static_cast<std::size_t>(progress.replans + progress.repairs);
    for (std::size_t i = 0; i < std::min(changed, progress.pushes_unchanged.size()); ++i) {
      rows.before_change.push_back(progress.pushes_unchanged[i]);
    }
  }
  return rows;
}

nlohmann::ordered_json failuresJson(const std::vector<TaskRun>& runs) {
  nlohmann::ordered_json failures = nlohmann::ordered_json::array();
  for (const TaskRun& run : runs) {
    const PushRunResult& result = run.result;
    if (!result.success || result.collisions > 0) {
      failures.push_back({{"seed", run.seed},
                          {"case_base", run.case_base},
                          {"success", result.success},
                          {"status", toString(result.status)},
                          {"explanation", result.explanation},
                          {"position_error_m", result.position_error_m},
                          {"yaw_error_deg", result.yaw_error_rad / kDegree},
                          {"collisions", result.collision_names}});
    }
  }
  return failures;
}

}  // namespace

nlohmann::ordered_json replanCausesJson(const ReplanCounts& causes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const ReplanCause cause : kReplanCauses) {
    const auto found = causes.find(cause);
    if (found != causes.end()) {
      json[toString(cause)] = found->second;
    }
  }
  return json;
}

nlohmann::ordered_json taskRunsJson(const std::vector<TaskRun>& runs) {
  int successes = 0, pushes = 0, replans = 0, rejected = 0, collisions = 0, noticed = 0;
  ReplanCounts causes;
  std::map<std::string, int> statuses;
  for (const TaskRun& run : runs) {
    const PushTaskProgress& progress = run.result.progress;
    successes += run.result.success ? 1 : 0;
    pushes += progress.pushes;
    replans += progress.replans;
    rejected += progress.rejected_predictions;
    collisions += run.result.collisions;
    noticed += run.result.noticed.empty() ? 0 : 1;
    ++statuses[toString(run.result.status)];
    for (const auto& [cause, count] : progress.replan_causes) {
      causes[cause] += count;
    }
  }
  const Rows rows = rowsOf(runs);
  return {{"tasks", runs.size()},
          {"success", shareJson(successes, static_cast<int>(runs.size()))},
          {"statuses", statuses},
          {"pushes", spreadJson(runs, [](const auto& r) { return r.progress.pushes; })},
          {"replans", spreadJson(runs, [](const auto& r) { return r.progress.replans; })},
          {"repairs", spreadJson(runs, [](const auto& r) { return r.progress.repairs; })},
          {"replan_causes", replanCausesJson(causes)},
          {"pushes_per_plan", pushes / static_cast<double>(replans + runs.size())},
          {"median_pushes_before_replan", quantile(rows.before_replan, 0.5)},
          {"median_pushes_before_replan_or_repair", quantile(rows.before_change, 0.5)},
          {"median_pushes_with_a_plan", quantile(rows.all, 0.5)},
          {"rejected_predictions", shareJson(rejected, pushes)},
          {"tasks_with_noticed_changes", noticed},
          {"sim_time_s", spreadJson(runs, [](const auto& r) { return r.sim_time_s; })},
          {"position_error_m", spreadJson(runs, [](const auto& r) { return r.position_error_m; })},
          {"collisions", collisions},
          {"failures", failuresJson(runs)}};
}

}  // namespace casepush
