#include "cases_command.h"

#include <filesystem>
#include <memory>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

struct CasesArguments {
  bool json = false;
  std::string case_base;
  std::string object;
  std::string file;
};

int list(const CasesArguments& arguments) {
  const CaseBase case_base(arguments.case_base, CaseBase::Access::kReadOnly);
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const Case& push_case : case_base.cases(arguments.object)) {
    const PoseGaussian& outcome = push_case.start_outcome;
    const Eigen::Vector3d sigma = outcome.covariance.diagonal().cwiseSqrt();
    cases.push_back({{"id", push_case.id},
                     {"object", push_case.object},
                     {"robot", push_case.robot},
                     {"origin", toString(push_case.origin)},
                     {"push_duration_s", push_case.pushDurationS()},
                     {"outcome", {outcome.mean.x(), outcome.mean.y(), outcome.mean.yaw()}},
                     {"sigma", {sigma.x(), sigma.y(), sigma.z()}},
                     {"effective_count", push_case.effective_count},
                     {"observations", push_case.observation_count}});
    if (push_case.source_id != 0) cases.back()["source_id"] = push_case.source_id;
    addContext(push_case.context, &cases.back());
  }
  if (arguments.json) {
    printResult({{"cases", cases}}, true);
    return kExitSuccess;
  }
  std::printf("%4s %-16s %-12s %6s  %24s  %24s %5s\n", "id", "object", "origin", "push s",
              "outcome x m, y m, yaw deg", "sigma x m, y m, yaw deg", "n");
  constexpr double kDegrees = 180.0 / M_PI;
  for (const auto& entry : cases) {
    const auto& mean = entry["outcome"];
    const auto& sigma = entry["sigma"];
    std::printf("%4d %-16s %-12s %6.1f  %8.3f %7.3f %7.1f  %8.3f %7.3f %7.1f %5.1f\n",
                entry["id"].get<int>(), entry["object"].get<std::string>().c_str(),
                entry["origin"].get<std::string>().c_str(), entry["push_duration_s"].get<double>(),
                mean[0].get<double>(), mean[1].get<double>(), mean[2].get<double>() * kDegrees,
                sigma[0].get<double>(), sigma[1].get<double>(), sigma[2].get<double>() * kDegrees,
                entry["effective_count"].get<double>());
  }
  return kExitSuccess;
}

int exportCases(const CasesArguments& arguments) {
  const CaseBase case_base(arguments.case_base, CaseBase::Access::kReadOnly);
  case_base.exportYaml(arguments.file);
  printResult({{"success", true}, {"exported", case_base.count()}, {"file", arguments.file}},
              arguments.json);
  return kExitSuccess;
}

int importCases(const CasesArguments& arguments) {
  const bool existed = std::filesystem::exists(arguments.case_base);
  int added = 0;
  try {
    added = CaseBase(arguments.case_base, CaseBase::Access::kCreate).importYaml(arguments.file);
  } catch (const InputError&) {
    if (!existed) {
      std::filesystem::remove(arguments.case_base);  // Nothing half-made is left behind.
    }
    throw;
  }
  printResult({{"success", true}, {"imported", added}, {"case_base", arguments.case_base}},
              arguments.json);
  return kExitSuccess;
}

}  // namespace

void addContext(const PushContext& context, nlohmann::ordered_json* json) {
  if (context.load_kg) (*json)["load_kg"] = *context.load_kg;
  if (!context.floor.empty()) (*json)["floor"] = context.floor;
  if (context.noticed > 0) (*json)["noticed"] = context.noticed;
}

void addCasesCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<CasesArguments>();
  CLI::App* cases = app.add_subcommand("cases", "Look after a case base");
  cases->require_subcommand(1);
  const auto add = [&](const std::string& name, const std::string& description,
                       int (*action)(const CasesArguments&)) {
    return addCasesSubcommand(*cases, run, name, description, arguments, action);
  };
  add("list", "Show the cases with their outcomes", list)
      ->add_option("--object", arguments->object, "Only cases of this object");
  add("export", "Write all cases to a YAML file", exportCases)
      ->add_option("file", arguments->file, "YAML file to write")
      ->required();
  add("import", "Add all cases of a YAML file, or none", importCases)
      ->add_option("file", arguments->file, "YAML file to read")
      ->required();
  addCasesEditCommands(*cases, run);
  addCasesShowCommands(*cases, run);
}

}  // namespace casepush
