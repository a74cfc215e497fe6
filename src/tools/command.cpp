#include "command.h"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <iostream>
#include <sstream>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

CLI::Validator finiteIn(double low, double high) {
  std::ostringstream range;
  range << "[" << low << " - " << high << "]";
  return CLI::Validator(
      [low, high, bounds = range.str()](const std::string& text) {
        double value = 0.0;
        const bool fits = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return fits ? std::string() : text + " is not a number in " + bounds;
      },
      "FLOAT in " + range.str());
}

CLI::Validator notEmpty() {
  return CLI::Validator(
      [](const std::string& text) { return std::string(text.empty() ? "is empty" : ""); }, "");
}

void addCommonOptions(CLI::App& command, CommonOptions& options) {
  const auto read = [&options](const std::string& text) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), options.seed);
    if (error != std::errc() || end != text.data() + text.size()) {
      throw CLI::ValidationError("--seed", text + " is not a whole number in [0, 2^64 - 1]");
    }
  };
  command.add_option_function<std::string>("--seed", read, "Fixes everything random")
      ->type_name("UINT")
      ->default_str("1");
  command.add_flag("--json", options.json, "Print one JSON object on stdout; logs go to stderr");
}

void addObjectOption(CLI::App& command, std::string& object) {
  command.add_option("--object", object, "Object by name or URDF file")->capture_default_str();
}

void addRobotOption(CLI::App& command, std::string& robot) {
  command.add_option("--robot", robot, "Robot by name or URDF file")->capture_default_str();
}

void addJobsOption(CLI::App& command, int& jobs) {
  command.add_option("--jobs", jobs, "Threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
}

void addCaseBaseOption(CLI::App& command, std::string& case_base) {
  command.add_option("--case-base", case_base, "SQLite file with the objects' cases")
      ->required()
      ->check(notEmpty());
}

void addCasesOption(CLI::App& command, ExplorationOptions& options) {
  command.add_option("--cases", options.cases, "Cases to learn")->capture_default_str();
}

void addPracticesOption(CLI::App& command, ExplorationOptions& options) {
  command.add_option("--practices", options.practices, "Pushes per case")->capture_default_str();
}

void addCasterModelOption(CLI::App& command, CasterModel& model) {
  command
      .add_option_function<std::string>(
          "--caster-model",
          [&model](const std::string& name) { model = casterModelFromString(name); },
          "How the simulator moves casters: featherstone (reference) or planar (fast)")
      ->default_str(toString(model));
}

void addLoadOption(CLI::App& command, std::optional<Load>& load) {
  command
      .add_option_function<std::vector<double>>(
          "--load",
          [&load](const std::vector<double>& numbers) {
            if (numbers.size() == 2) {
              throw InputError("--load", "must be KG or KG X_M Y_M");
            }
            load.emplace();
            load->mass_kg = numbers[0];
            if (numbers.size() == 3) {
              load->object_p_centre_m << numbers[1], numbers[2];
            }
          },
          "What lies on top of the object: 0 to 80 kg and where in the object's frame; default: "
          "its origin")
      ->expected(1, 3)
      ->type_name("KG [X_M Y_M]");
}

void printResult(const nlohmann::ordered_json& result, bool json) {
  if (json) {
    std::cout << result.dump() << std::endl;
    return;
  }
  for (const auto& [key, value] : result.items()) {
    std::cout << key << ": " << (value.is_string() ? value.get<std::string>() : value.dump())
              << '\n';
  }
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (open_) {
    std::cerr << std::endl;
  }
}

void ProgressLine::show(const std::string& text) {
  if (text.empty() || text == last_) {
    return;
  }
  last_ = text;
  if (terminal_) {
    std::cerr << "\r\033[K" << text << std::flush;
    open_ = true;
  } else {
    std::cerr << text << '\n';
  }
}

std::string durationText(double seconds) {
  const int whole = static_cast<int>(std::lround(seconds));
  if (whole < 60) {
    return std::to_string(whole) + " s";
  }
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

Stopwatch::Stopwatch() : start_s_(steadySeconds()) {}

double Stopwatch::seconds() const { return steadySeconds() - start_s_; }

}  // namespace casepush
