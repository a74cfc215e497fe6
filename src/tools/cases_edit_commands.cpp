#include <filesystem>
#include <memory>

#include "casepush/cases/transfer.h"
#include "casepush/common/input_error.h"
#include "casepush/model/catalog.h"
#include "cases_command.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;

struct EditArguments {
  bool json = false;
  std::string case_base;
  std::int64_t id = 0;
  double load_kg = -1.0;
  std::string floor;
  std::string object;
  std::string from;
  std::string other;
  bool dry_run = false;
  PruneOptions prune;
  TransferOptions transfer;
};

nlohmann::ordered_json statisticsJson(const Case& push_case) {
  const Pose2& mean = push_case.start_outcome.mean;
  const Eigen::Vector3d sigma = push_case.start_outcome.covariance.diagonal().cwiseSqrt();
  return {{"id", push_case.id},
          {"outcome", {mean.x(), mean.y(), mean.yaw()}},
          {"sigma", {sigma.x(), sigma.y(), sigma.z()}},
          {"effective_count", push_case.effective_count},
          {"observations", push_case.observation_count}};
}

int undo(const EditArguments& arguments) {
  const Case now = CaseBase(arguments.case_base, Access::kReadWrite).undo(arguments.id);
  printResult({{"success", true}, {"case", statisticsJson(now)}}, arguments.json);
  return kExitSuccess;
}

int copy(const EditArguments& arguments) {
  PushContext context;
  if (arguments.load_kg >= 0.0) {
    context.load_kg = arguments.load_kg;
  }
  context.floor = arguments.floor;
  CaseBase base(arguments.case_base, Access::kReadWrite);
  const std::int64_t id = base.copy(arguments.id, context);
  printResult({{"success", true}, {"copied", arguments.id}, {"id", id}}, arguments.json);
  return kExitSuccess;
}

int remove(const EditArguments& arguments) {
  CaseBase(arguments.case_base, Access::kReadWrite).remove(arguments.id);
  printResult({{"success", true}, {"removed", arguments.id}}, arguments.json);
  return kExitSuccess;
}

int prune(const EditArguments& arguments) {
  const std::vector<UselessCase> useless =
      arguments.dry_run
          ? uselessCases(CaseBase(arguments.case_base, Access::kReadOnly).cases(arguments.object),
                         arguments.prune)
          : CaseBase(arguments.case_base, Access::kReadWrite)
                .prune(arguments.object, arguments.prune);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const UselessCase& push_case : useless) {
    list.push_back({{"id", push_case.id}, {"reason", push_case.reason}});
  }
  printResult({{"success", true}, {"dry_run", arguments.dry_run}, {"pruned", list}},
              arguments.json);
  return kExitSuccess;
}

int merge(const EditArguments& arguments) {
  const CaseBase other(arguments.other, Access::kReadOnly);
  const MergeResult result = CaseBase(arguments.case_base, Access::kReadWrite).merge(other);
  printResult({{"success", true},
               {"added", result.added},
               {"extended", result.extended},
               {"unchanged", result.unchanged},
               {"observations", result.observations}},
              arguments.json);
  return kExitSuccess;
}

// The known object, of those in the base, whose cases are worth most for `target`.
std::string nearestObject(const Catalog& catalog, const std::vector<Case>& cases,
                          const ObjectModel& target) {
  std::string nearest;
  double least = 0.0;
  for (const Case& push_case : cases) {
    if (push_case.object == target.name || push_case.object == nearest) {
      continue;
    }
    const double distance = objectDissimilarity(catalog.object(push_case.object), target);
    if (nearest.empty() || distance < least) {
      nearest = push_case.object;
      least = distance;
    }
  }
  return nearest;
}

int transfer(const EditArguments& arguments) {
  const Catalog catalog = Catalog::standard();
  const ObjectModel target = catalog.object(arguments.object);
  CaseBase base(arguments.case_base, arguments.dry_run ? Access::kReadOnly : Access::kReadWrite);
  const std::vector<Case> all = base.cases();
  const std::string from =
      arguments.from.empty() ? nearestObject(catalog, all, target) : arguments.from;
  if (from.empty()) {
    throw InputError(arguments.case_base, "holds no case of another object than " + target.name);
  }
  const ObjectModel source = catalog.object(from);
  const double dissimilarity = objectDissimilarity(source, target);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (Case& push_case : proposeCases(all, source, target, arguments.transfer)) {
    push_case.id = arguments.dry_run ? 0 : base.add(push_case);
    list.push_back(statisticsJson(push_case));
    list.back()["source_id"] = push_case.source_id;
  }
  const bool success = !list.empty();
  std::string explanation = "proposed " + std::to_string(list.size()) + " cases";
  if (!success) {
    explanation = dissimilarity > arguments.transfer.largest_dissimilarity
                      ? source.name + " and " + target.name + " are too different"
                      : "the case base holds no practised case of " + source.name;
  }
  printResult({{"success", success},
               {"explanation", explanation},
               {"from", source.name},
               {"to", target.name},
               {"dissimilarity", dissimilarity},
               {"dry_run", arguments.dry_run},
               {"cases", list}},
              arguments.json);
  return success ? kExitSuccess : kExitTaskFailed;
}

void addPruneOptions(CLI::App& command, PruneOptions& options) {
  const auto add = [&](const char* name, double& value, const char* text) {
    command.add_option(name, value, text)->check(finiteIn(0.0, 1e6))->capture_default_str();
  };
  add("--least-motion", options.least_motion_m, "Useless below this and --least-turn [m]");
  add("--least-turn", options.least_turn_rad, "[rad]");
  add("--largest-sigma", options.largest_sigma_m, "Useless above this [m]");
  add("--largest-sigma-yaw", options.largest_sigma_rad, "Useless above this [rad]");
  add("--outcome-distance", options.outcome_distance_m, "Duplicates: outcomes this near [m]");
  add("--outcome-turn", options.outcome_turn_rad, "[rad]");
  add("--start-distance", options.start_distance_m, "Duplicates: starts this near [m]");
  add("--start-turn", options.start_turn_rad, "[rad]");
}

}  // namespace

void addCasesEditCommands(CLI::App& cases, Run& run) {
  const auto arguments = std::make_shared<EditArguments>();
  const auto add = [&](const std::string& name, const std::string& description,
                       int (*action)(const EditArguments&)) {
    return addCasesSubcommand(cases, run, name, description, arguments, action);
  };
  const auto add_id = [&](CLI::App* command) {
    command->add_option("--id", arguments->id, "Id of the case")->required();
    return command;
  };
  add_id(add("undo", "Take the last observation of a case back", undo));
  add_id(add("remove", "Remove a case with its observations", remove));
  CLI::App* command =
      add_id(add("copy", "Copy a case for another load or floor, to adapt the copy", copy));
  command->add_option("--load", arguments->load_kg, "Load on top of the object [kg]")
      ->check(finiteIn(0.0, 10000.0));
  command->add_option("--floor", arguments->floor, "Name of the floor");

  command = add("prune", "Remove cases that move nothing, scatter too much or do the same", prune);
  command->add_option("--object", arguments->object, "Only cases of this object");
  command->add_flag("--dry-run", arguments->dry_run, "Only say what would be removed");
  addPruneOptions(*command, arguments->prune);

  command = add("merge", "Take over the cases and observations of another case base", merge);
  command->add_option("other", arguments->other, "SQLite file to take from; it is only read")
      ->required();

  command = add("transfer", "Propose the cases of a known object for a new one", transfer);
  command->add_option("--to", arguments->object, "New object by name or URDF file")->required();
  command->add_option("--from", arguments->from, "Known object; default: the most similar one");
  command->add_flag("--dry-run", arguments->dry_run, "Store nothing");
  command
      ->add_option("--largest-dissimilarity", arguments->transfer.largest_dissimilarity,
                   "Propose nothing beyond")
      ->check(finiteIn(0.0, 1e6))
      ->capture_default_str();
}

}  // namespace casepush
