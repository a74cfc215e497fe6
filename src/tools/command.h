#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "casepush/execution/exploration.h"
#include "casepush/sim/simulator.h"

namespace casepush {

/// Exit codes of the `casepush` command.
constexpr int kExitSuccess = 0;
constexpr int kExitTaskFailed = 1;
constexpr int kExitBadInput = 2;

/// Options that every subcommand has.
struct CommonOptions {
  std::uint64_t seed = 1;
  bool json = false;
};

/// Each adds its subcommand; `run` is set to what the parsed command line asks for.
/// A command returns its exit code, or throws InputError.
using Run = std::function<int()>;
void addLearnCommand(CLI::App& app, Run& run);
void addPlanCommand(CLI::App& app, Run& run);
void addPushCommand(CLI::App& app, Run& run);
void addRearrangeCommand(CLI::App& app, Run& run);
void addCasesCommand(CLI::App& app, Run& run);
void addWorldCommand(CLI::App& app, Run& run);
void addMapCommand(CLI::App& app, Run& run);
void addBenchCommand(CLI::App& app, Run& run);
void addPlanBench(CLI::App& bench, Run& run);    ///< Of addBenchCommand().
void addMapBench(CLI::App& bench, Run& run);     ///< Of addBenchCommand().
void addGrowthBench(CLI::App& bench, Run& run);  ///< Of addBenchCommand().
void addExperimentCommand(CLI::App& app, Run& run);
void addTaskExperiments(CLI::App& experiment, Run& run);        ///< Of addExperimentCommand().
void addUncertaintyExperiment(CLI::App& experiment, Run& run);  ///< Of addExperimentCommand().

/// A finite number in [low, high]: unlike CLI::Range, no NaN.
CLI::Validator finiteIn(double low, double high);
CLI::Validator notEmpty();

/// --seed and --json.
void addCommonOptions(CLI::App& command, CommonOptions& options);

/// What several commands take, with its default in the help. @pre The value lives until the command
/// line is parsed.
void addObjectOption(CLI::App& command, std::string& object);         ///< --object
void addRobotOption(CLI::App& command, std::string& robot);           ///< --robot
void addJobsOption(CLI::App& command, int& jobs);                     ///< --jobs
void addCaseBaseOption(CLI::App& command, std::string& case_base);    ///< --case-base, required.
void addCasesOption(CLI::App& command, ExplorationOptions& options);  ///< --cases
void addPracticesOption(CLI::App& command, ExplorationOptions& options);  ///< --practices

/// Has `command` do `work` with the arguments that it was given.
template <typename Arguments, typename Work>
void setWork(CLI::App& command, Run& run, const std::shared_ptr<Arguments>& arguments, Work work) {
  command.callback(
      [&run, arguments, work] { run = [arguments, work] { return work(*arguments); }; });
}

/// --caster-model. @pre `model` lives until the command line is parsed.
void addCasterModelOption(CLI::App& command, CasterModel& model);

/// --load KG [X_M Y_M]. @pre `load` lives until the command line is parsed.
void addLoadOption(CLI::App& command, std::optional<Load>& load);

/// Prints one JSON object on stdout if asked to, else its members as lines for a person.
/// What differs between runs of the same seed is under "timing".
void printResult(const nlohmann::ordered_json& result, bool json);

/// Shows one line of progress on stderr, over the previous one on a terminal.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  void show(const std::string& text);  ///< Nothing happens if the text is empty or the same.

 private:
  bool terminal_;
  bool open_ = false;
  std::string last_;
};

/// "1 min 20 s" style duration.
std::string durationText(double seconds);

/// Wall clock seconds since construction.
class Stopwatch {
 public:
  Stopwatch();
  double seconds() const;

 private:
  double start_s_;
};

}  // namespace casepush
