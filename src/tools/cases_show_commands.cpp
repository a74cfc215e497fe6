#include <algorithm>
#include <memory>

#include "casepush/cases/calibration.h"
#include "cases_command.h"

namespace casepush {
namespace {

// With less, the others are too few for the F distribution.
constexpr std::size_t kFewestForCalibration = 6;

struct ShowArguments {
  bool json = false;
  std::string case_base;
  std::string object;
  double alpha = 0.01;
};

nlohmann::ordered_json json(const Pose2& pose) { return {pose.x(), pose.y(), pose.yaw()}; }

nlohmann::ordered_json json(const PoseGaussian& gaussian) {
  nlohmann::ordered_json covariance = nlohmann::ordered_json::array();
  for (int i = 0; i < 9; ++i) {
    covariance.push_back(gaussian.covariance(i / 3, i % 3));
  }
  return {{"mean", json(gaussian.mean)}, {"covariance", covariance}};
}

template <typename Container, typename Get>
nlohmann::ordered_json list(const Container& container, const Get& get) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (const auto& element : container) {
    result.push_back(get(element));
  }
  return result;
}

nlohmann::ordered_json json(const LeftOutTest& test) {
  return {{"t_squared", test.hotelling.t_squared},
          {"p_value", test.hotelling.p_value},
          {"plug_in_p_value", test.plug_in.p_value}};
}

// Adapted outcomes are from changed dynamics: the others say nothing about them.
std::vector<std::size_t> comparable(const std::vector<ObservedOutcome>& history) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (history[i].source != OutcomeSource::kAdapted) {
      numbers.push_back(i);
    }
  }
  return numbers.size() < kFewestForCalibration ? std::vector<std::size_t>() : numbers;
}

std::vector<LeftOutTest> testAll(const std::vector<ObservedOutcome>& history,
                                 const std::vector<std::size_t>& numbers, double alpha) {
  std::vector<Pose2> outcomes;
  for (const std::size_t number : numbers) {
    outcomes.push_back(history[number].start_T_object);
  }
  return numbers.empty() ? std::vector<LeftOutTest>()
                         : leaveOneOut(outcomes, history[numbers.front()].noise, alpha);
}

nlohmann::ordered_json historyJson(const std::vector<ObservedOutcome>& history, double alpha) {
  nlohmann::ordered_json observations = nlohmann::ordered_json::array();
  for (const ObservedOutcome& outcome : history) {
    nlohmann::ordered_json entry{{"source", toString(outcome.source)},
                                 {"start_T_object", json(outcome.start_T_object)},
                                 {"past_weight", outcome.past_weight}};
    if (outcome.stamp_s) entry["stamp_s"] = *outcome.stamp_s;
    addContext(outcome.context, &entry);
    entry["path"] = list(outcome.path, [](const Pose2& pose) { return json(pose); });
    observations.push_back(entry);
  }
  const std::vector<std::size_t> numbers = comparable(history);
  const std::vector<LeftOutTest> tests = testAll(history, numbers, alpha);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    observations[numbers[i]]["left_out"] = json(tests[i]);
  }
  return observations;
}

int dump(const ShowArguments& arguments) {
  const CaseBase base(arguments.case_base, CaseBase::Access::kReadOnly);
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const Case& push_case : base.cases(arguments.object)) {
    nlohmann::ordered_json entry{{"id", push_case.id},
                                 {"object", push_case.object},
                                 {"robot", push_case.robot},
                                 {"origin", toString(push_case.origin)},
                                 {"source_id", push_case.source_id}};
    addContext(push_case.context, &entry);
    entry["period_s"] = push_case.period_s;
    entry["push_steps"] = push_case.push_steps;
    entry["outcome"] = json(push_case.start_outcome);
    entry["effective_count"] = push_case.effective_count;
    entry["observations"] = push_case.observation_count;
    const auto& steps = push_case.steps;
    entry["robot_path"] = list(steps, [](const CaseStep& s) { return json(s.start_T_robot()); });
    entry["object_path"] = list(steps, [](const CaseStep& s) { return json(s.start_T_object); });
    entry["tube"] = list(push_case.tube, [](const PoseGaussian& g) { return json(g); });
    entry["history"] = historyJson(base.history(push_case.id), arguments.alpha);
    cases.push_back(entry);
  }
  printResult({{"success", true}, {"cases", cases}}, true);
  return kExitSuccess;
}

int calibrate(const ShowArguments& arguments) {
  const CaseBase base(arguments.case_base, CaseBase::Access::kReadOnly);
  int tested = 0;
  int hotelling = 0;
  int plug_in = 0;
  int cases = 0;
  for (const Case& push_case : base.cases(arguments.object)) {
    const std::vector<ObservedOutcome> history = base.history(push_case.id);
    const std::vector<LeftOutTest> tests = testAll(history, comparable(history), arguments.alpha);
    cases += tests.empty() ? 0 : 1;
    tested += static_cast<int>(tests.size());
    for (const LeftOutTest& test : tests) {
      hotelling += test.hotelling.rejected ? 1 : 0;
      plug_in += test.plug_in.rejected ? 1 : 0;
    }
  }
  const auto rate = [&](int rejected) -> nlohmann::ordered_json {
    return tested == 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(1.0 * rejected / tested);
  };
  printResult({{"success", true},
               {"cases", cases},
               {"observations", tested},
               {"alpha", arguments.alpha},
               {"rejected_by_hotelling", rate(hotelling)},
               {"rejected_by_plug_in", rate(plug_in)}},
              arguments.json);
  return kExitSuccess;
}

}  // namespace

void addCasesShowCommands(CLI::App& cases, Run& run) {
  const auto arguments = std::make_shared<ShowArguments>();
  const auto add = [&](const std::string& name, const std::string& description,
                       int (*action)(const ShowArguments&)) {
    CLI::App* command = addCasesSubcommand(cases, run, name, description, arguments, action);
    command->add_option("--object", arguments->object, "Only cases of this object");
    command->add_option("--alpha", arguments->alpha, "Level of the prediction test")
        ->check(finiteIn(1e-6, 0.5))
        ->capture_default_str();
  };
  add("calibrate",
      "Predict each observation from the others of its case: how often does the test reject?",
      calibrate);
  add("dump", "Print everything as one JSON object: trajectories, tubes, observations", dump);
}

}  // namespace casepush
