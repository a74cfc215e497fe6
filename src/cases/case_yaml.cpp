#include "case_yaml.h"

#include <array>
#include <charconv>
#include <initializer_list>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/common/yaml_reader.h"

namespace casepush {
namespace {

constexpr char kFormatKey[] = "casepush_cases";
constexpr int kFormatVersion = 1;
constexpr double kLargest = std::numeric_limits<double>::max();

// Written by hand: YAML::Emitter takes ten times as long.

void append(std::string& yaml, double value) {
  std::array<char, 32> digits;
  yaml.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

std::string exact(double value) {
  std::string digits;
  append(digits, value);
  return digits;
}

std::string quoted(const std::string& text) {
  std::string yaml = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      yaml += '\\';
    }
    yaml += c;
  }
  return yaml + '"';
}

void appendNumbers(std::string& yaml, std::initializer_list<double> values) {
  char separator = '[';
  for (const double value : values) {
    yaml += separator;
    if (separator == ',') {
      yaml += ' ';
    }
    append(yaml, value);
    separator = ',';
  }
  yaml += ']';
}

void appendPose(std::string& yaml, const Pose2& pose) {
  appendNumbers(yaml, {pose.x(), pose.y(), pose.yaw()});
}

void appendLine(std::string& yaml, const char* key, const std::string& value) {
  yaml.append("    ").append(key).append(": ").append(value).append("\n");
}

void appendOutcome(std::string& yaml, const PoseGaussian& outcome) {
  const Eigen::Matrix3d& c = outcome.covariance;
  yaml += "    outcome:\n      mean: ";
  appendPose(yaml, outcome.mean);
  yaml += "\n      covariance: ";
  appendNumbers(yaml, {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)});
  yaml += '\n';
}

void appendHistory(std::string& yaml, const std::vector<ObservedOutcome>& history) {
  yaml += history.empty() ? "    history: []\n" : "    history:\n";
  for (const ObservedOutcome& outcome : history) {
    yaml.append("      - {source: ").append(toString(outcome.source)).append(", start_T_object: ");
    appendPose(yaml, outcome.start_T_object);
    yaml.append(", past_weight: ").append(exact(outcome.past_weight)).append("}\n");
  }
}

void appendSteps(std::string& yaml, const std::vector<CaseStep>& steps) {
  yaml += "    steps:\n";
  for (const CaseStep& step : steps) {
    yaml += "      - {object_T_robot: ";
    appendPose(yaml, step.object_T_robot);
    yaml += ", action: ";
    appendNumbers(yaml, {step.action.vx_mps, step.action.vy_mps, step.action.wz_rps});
    yaml += ", start_T_object: ";
    appendPose(yaml, step.start_T_object);
    yaml += "}\n";
  }
}

void appendCase(std::string& yaml, const CaseRecord& record) {
  const Case& push_case = record.push_case;
  yaml += "  - id: " + std::to_string(push_case.id) + "\n";
  appendLine(yaml, "object", quoted(push_case.object));
  if (!push_case.robot.empty()) {
    appendLine(yaml, "robot", quoted(push_case.robot));
  }
  appendLine(yaml, "origin", toString(push_case.origin));
  appendLine(yaml, "period_s", exact(push_case.period_s));
  appendLine(yaml, "push_steps", std::to_string(push_case.push_steps));
  appendOutcome(yaml, push_case.start_outcome);
  appendLine(yaml, "effective_count", exact(push_case.effective_count));
  appendLine(yaml, "observation_count", std::to_string(push_case.observation_count));
  appendHistory(yaml, record.history);
  appendSteps(yaml, push_case.steps);
}

Pose2 readPose(YamlReader& reader, const char* key) {
  const std::vector<double> n = reader.numbers(key, 3);
  return {n[0], n[1], n[2]};
}

PoseGaussian readOutcome(YamlReader reader) {
  PoseGaussian outcome;
  outcome.mean = readPose(reader, "mean");
  const std::vector<double> c = reader.numbers("covariance", 6);
  outcome.covariance << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  if (!isCovariance(outcome.covariance)) {
    throw InputError(reader.where("covariance"),
                     "has a negative eigenvalue; must be the upper triangle of a covariance");
  }
  reader.finish();
  return outcome;
}

template <typename Enum>
Enum readWord(YamlReader& reader, const char* key,
              std::optional<Enum> (*from_string)(const std::string&), const char* words) {
  const std::string text = reader.text(key);
  const std::optional<Enum> value = from_string(text);
  if (!value) {
    throw InputError(reader.where(key), "is '" + text + "'; must be one of " + words);
  }
  return *value;
}

std::vector<ObservedOutcome> readHistory(YamlReader& reader) {
  std::vector<ObservedOutcome> history;
  for (YamlReader& entry : reader.children("history")) {
    ObservedOutcome outcome;
    outcome.source = readWord(entry, "source", &outcomeSourceFromString,
                              "explored, demonstrated, transferred, practised, adapted");
    outcome.start_T_object = readPose(entry, "start_T_object");
    if (outcome.start_T_object.position().cwiseAbs().maxCoeff() > kLargestCaseCoordinate_m) {
      throw InputError(entry.where("start_T_object"),
                       "is too far away; x and y must be within 100 m of 0");
    }
    outcome.past_weight = entry.number("past_weight", 0.0, kLargest);
    entry.finish();
    history.push_back(outcome);
  }
  return history;
}

std::vector<CaseStep> readSteps(YamlReader& reader) {
  std::vector<CaseStep> steps;
  for (YamlReader& entry : reader.children("steps")) {
    CaseStep step;
    step.object_T_robot = readPose(entry, "object_T_robot");
    const std::vector<double> a = entry.numbers("action", 3);
    step.action = {a[0], a[1], a[2]};
    step.start_T_object = readPose(entry, "start_T_object");
    entry.finish();
    steps.push_back(step);
  }
  return steps;
}

CaseRecord readCase(YamlReader& reader) {
  constexpr int kMaxInt = std::numeric_limits<int>::max();
  CaseRecord record;
  Case& push_case = record.push_case;
  reader.number("id", 0.0, kLargest, 0.0);
  push_case.object = reader.text("object");
  push_case.robot = reader.text("robot", "");
  push_case.origin =
      readWord(reader, "origin", &caseOriginFromString, "explored, demonstrated, transferred");
  push_case.period_s = reader.number("period_s", 0.0, kLargest);
  push_case.push_steps = reader.integer("push_steps", 1, kMaxInt);
  push_case.start_outcome = readOutcome(reader.child("outcome"));
  push_case.effective_count = reader.number("effective_count", 0.0, kLargest);
  push_case.observation_count = reader.integer("observation_count", 0, kMaxInt);
  record.history = readHistory(reader);
  push_case.steps = readSteps(reader);
  reader.finish();
  validateCase(push_case, reader.where());
  return record;
}

}  // namespace

std::string formatCases(const std::vector<CaseRecord>& records) {
  std::string yaml =
      "# Poses: x [m], y [m], yaw [rad]. Actions: vx [m/s], vy [m/s], wz [rad/s].\n"
      "# Covariances: upper triangle, row by row.\n";
  yaml.append(kFormatKey).append(": ").append(std::to_string(kFormatVersion)).append("\n");
  yaml += records.empty() ? "cases: []\n" : "cases:\n";
  for (const CaseRecord& record : records) {
    appendCase(yaml, record);
  }
  return yaml;
}

std::vector<CaseRecord> readCases(const std::filesystem::path& file) {
  YamlReader reader = YamlReader::fromFile(file);
  const double version = reader.number(kFormatKey, 1.0, kLargest);
  if (version != kFormatVersion) {
    throw InputError(reader.where(kFormatKey), "is newer than this program; update casepush");
  }
  if (!reader.has("cases")) {
    throw InputError(reader.where("cases"), "is missing; must be a list of cases");
  }
  std::vector<CaseRecord> records;
  for (YamlReader& entry : reader.children("cases")) {
    records.push_back(readCase(entry));
  }
  reader.finish();
  return records;
}

}  // namespace casepush
