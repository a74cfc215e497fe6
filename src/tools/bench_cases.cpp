#include "bench_cases.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <vector>

#include "casepush/cases/case_base.h"
#include "casepush/common/input_error.h"
#include "casepush/common/random.h"

namespace casepush {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  CommonOptions common;
  std::string folder = ".";
  int cases = 10000;
  int practices = 5;
  int steps = 30;
  int updates = 1000;
};

/// The folder's benchmark files, gone with the object.
class Workplace {
 public:
  explicit Workplace(const std::string& folder)
      : path_(fs::path(folder) / ("casepush_bench_" + std::to_string(::getpid()))) {
    std::error_code failure;
    fs::create_directory(path_, failure);
    if (failure) {
      throw InputError(path_.string(), "cannot be made: " + failure.message());
    }
  }
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// An arc, with noise: a push like those that are recorded.
std::vector<CaseStep> randomSteps(Random& random, int count, double reach_m) {
  std::vector<CaseStep> steps;
  const Twist2 action{0.3, 0.0, 0.1};
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / std::max(1, count - 1);
    const Pose2 noise(random.normal(0.005), random.normal(0.005), random.normal(0.01));
    steps.push_back({Pose2(-0.6, 0.1, 0.0) * noise, action,
                     expSe2({reach_m * share, 0.1 * share, 0.5 * share}) * noise});
  }
  return steps;
}

Case randomCase(Random& random, const Arguments& arguments) {
  Case push_case;
  push_case.object = "object_" + std::to_string(random.below(20));
  push_case.robot = "cobot";
  push_case.push_steps = std::max(1, arguments.steps / 2);
  push_case.steps = randomSteps(random, arguments.steps, random.uniform(0.2, 1.0));
  const OutcomeStatistics first = addObservation({}, push_case.steps.back().start_T_object, {});
  push_case.start_outcome = first.start_outcome;
  push_case.effective_count = first.effective_count;
  push_case.observation_count = 1;
  return push_case;
}

ObservedPush randomPush(Random& random, const Case& push_case, const Arguments& arguments) {
  ObservedPush push;
  push.steps = randomSteps(random, arguments.steps, push_case.start_outcome.mean.x());
  push.push_steps = push_case.push_steps;
  push.start_T_object = push.steps.back().start_T_object;
  push.stamp_s = random.uniform(0.0, 1e6);
  return push;
}

nlohmann::ordered_json spreadMs(std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return 1e3 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  return {{"median_ms", at(0.5)}, {"p90_ms", at(0.9)}, {"p99_ms", at(0.99)}};
}

/// What the disk takes to make one page durable, for comparison.
std::vector<double> measureSync(const fs::path& file, int count) {
  const std::vector<char> page(4096, 'x');
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  std::vector<double> seconds;
  for (int i = 0; i < count; ++i) {
    const Stopwatch watch;
    if (::write(descriptor, page.data(), page.size()) < 0 || ::fdatasync(descriptor) != 0) {
      throw InputError(file.string(), "cannot be written");
    }
    seconds.push_back(watch.seconds());
  }
  ::close(descriptor);
  return seconds;
}

/// A base of 14 cases, as an object has.
nlohmann::ordered_json measureUpdates(const Workplace& work, const Arguments& arguments,
                                      Random& random) {
  CaseBase base(work / "updates.db", CaseBase::Access::kCreate);
  std::vector<Case> cases;
  for (int i = 0; i < 14; ++i) {
    cases.push_back(base.get(base.add(randomCase(random, arguments))));
  }
  std::vector<double> persistent;
  std::vector<double> in_memory;
  std::vector<double> statistics;
  for (int i = 0; i < arguments.updates; ++i) {
    Case& push_case = cases[static_cast<std::size_t>(i) % cases.size()];
    const ObservedPush push = randomPush(random, push_case, arguments);
    const Stopwatch updating;
    const OutcomeStatistics now = addObservation(
        {push_case.start_outcome, push_case.effective_count}, push.start_T_object, {});
    statistics.push_back(updating.seconds());
    push_case = withPush(push_case, push, now.effective_count - 1.0, {});
    in_memory.push_back(updating.seconds());
    const Stopwatch storing;
    base.observe(push_case.id, push, {});
    persistent.push_back(storing.seconds());
  }
  return {{"persistent", spreadMs(persistent)},
          {"in_memory_with_tube", spreadMs(in_memory)},
          {"in_memory_outcome_only", spreadMs(statistics)},
          {"disk_sync_of_one_page", spreadMs(measureSync(work / "page", arguments.updates))}};
}

/// Median of some repetitions: whoever opens a base has mostly read it before.
template <typename Action>
nlohmann::ordered_json medianOf(const Action& action) {
  std::vector<double> wall_s;
  std::vector<double> cpu_s;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t cpu = std::clock();
    const Stopwatch watch;
    action();
    wall_s.push_back(watch.seconds());
    cpu_s.push_back(static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
  }
  std::sort(wall_s.begin(), wall_s.end());
  std::sort(cpu_s.begin(), cpu_s.end());
  return {{"wall_s", wall_s[2]}, {"cpu_s", cpu_s[2]}};
}

/// Many cases at once come by YAML: a commit for each observation is what pushes need.
nlohmann::ordered_json measureLargeBase(const Workplace& work, const Arguments& arguments,
                                        Random& random, ProgressLine& line) {
  using Access = CaseBase::Access;
  const int few = std::min(arguments.cases, 200);
  const fs::path seed_file = work / "seed.db";
  const fs::path file = work / "large.db";
  {
    CaseBase seed(seed_file, Access::kCreate);
    for (int i = 0; i < few; ++i) {
      const Case push_case = randomCase(random, arguments);
      const std::int64_t id = seed.add(push_case);
      for (int k = 1; k < arguments.practices; ++k) {
        seed.observe(id, randomPush(random, push_case, arguments), {});
      }
    }
    seed.exportYaml(work / "seed.yaml");
    CaseBase large(file, Access::kCreate);
    line.show("filling");
    for (int i = 0; i < (arguments.cases + few - 1) / few; ++i) {
      large.importYaml(work / "seed.yaml");
    }
  }
  nlohmann::ordered_json result;
  result["cases"] = CaseBase(file, Access::kReadOnly).count();
  result["file_mb"] = static_cast<double>(fs::file_size(file)) / 1e6;
  line.show("opening");
  result["open"] = medianOf([&] { CaseBase(file, Access::kReadOnly).count(); });
  result["open_for_writing"] = medianOf([&] { CaseBase(file, Access::kReadWrite).count(); });
  result["open_and_read_all"] = medianOf([&] { CaseBase(file, Access::kReadOnly).cases(); });
  result["open_and_read_one_object"] =
      medianOf([&] { CaseBase(file, Access::kReadOnly).cases("object_1"); });
  line.show("exporting");
  const Stopwatch exporting;
  CaseBase(file, Access::kReadOnly).exportYaml(work / "large.yaml");
  result["yaml_export_s"] = exporting.seconds();
  result["yaml_mb"] = static_cast<double>(fs::file_size(work / "large.yaml")) / 1e6;
  line.show("importing");
  const Stopwatch importing;
  CaseBase(work / "import.db", Access::kCreate).importYaml(work / "large.yaml");
  result["yaml_import_s"] = importing.seconds();
  return result;
}

int benchCases(const Arguments& arguments) {
  const Stopwatch watch;
  ProgressLine line;
  Random random(arguments.common.seed);
  const Workplace work(arguments.folder);
  nlohmann::ordered_json result{{"success", true},
                                {"steps", arguments.steps},
                                {"practices", arguments.practices},
                                {"updates", arguments.updates},
                                {"seed", arguments.common.seed}};
  nlohmann::ordered_json timing;
  line.show("updating");
  timing["update"] = measureUpdates(work, arguments, random);
  timing["large_base"] = measureLargeBase(work, arguments, random, line);
  timing["wall_s"] = watch.seconds();
  result["timing"] = timing;
  printResult(result, arguments.common.json);
  return kExitSuccess;
}

}  // namespace

void addBenchCasesCommand(CLI::App& bench, Run& run) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      bench.add_subcommand("cases", "Measure the case base: updates, opening a large one, YAML");
  addCommonOptions(*command, arguments->common);
  command->add_option("--folder", arguments->folder, "Where to write: on the disk to measure")
      ->capture_default_str();
  const auto count = [&](const char* name, int& value, const char* text, int high) {
    command->add_option(name, value, text)->check(CLI::Range(1, high))->capture_default_str();
  };
  count("--cases", arguments->cases, "Cases of the large base", 1000000);
  count("--practices", arguments->practices, "Observations of each of them", 1000);
  count("--steps", arguments->steps, "Steps of each trajectory", 10000);
  count("--updates", arguments->updates, "Updates to time", 1000000);
  setWork(*command, run, arguments, benchCases);
}

}  // namespace casepush
