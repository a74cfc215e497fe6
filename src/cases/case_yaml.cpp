#include "case_yaml.h"

#include <cmath>
#include <limits>

#include "casepush/cases/case_tube.h"
#include "casepush/common/input_error.h"
#include "casepush/common/yaml_reader.h"
#include "number_table.h"

namespace casepush {
namespace {

constexpr char kFormatKey[] = "casepush_cases";
constexpr int kFormatVersion = 2;
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr int kLargestInt = std::numeric_limits<int>::max();

Pose2 readPose(YamlReader& reader, const char* key) {
  const std::vector<double> n = reader.numbers(key, 3);
  return {n[0], n[1], n[2]};
}

PoseGaussian readGaussian(YamlReader& reader) {
  PoseGaussian outcome;
  outcome.mean = readPose(reader, "mean");
  const std::vector<double> c = reader.numbers("covariance", 6);
  outcome.covariance << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  if (!isCovariance(outcome.covariance)) {
    throw InputError(reader.where("covariance"),
                     "has a negative eigenvalue; must be the upper triangle of a covariance");
  }
  return outcome;
}

PoseGaussian readOutcome(YamlReader reader) {
  const PoseGaussian outcome = readGaussian(reader);
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

CovarianceFloor readNoise(YamlReader& reader) {
  const std::vector<double> n = reader.numbers("noise", 2);
  if (n[0] <= 0.0 || n[1] <= 0.0) {
    throw InputError(reader.where("noise"), "must be two numbers above 0");
  }
  return {n[0], n[1]};
}

PushContext readContext(YamlReader& reader) {
  PushContext context;
  if (reader.has("load_kg")) {
    context.load_kg = reader.number("load_kg", 0.0, kLargest);
  }
  context.floor = reader.text("floor", "");
  if (reader.has("noticed")) {
    context.noticed = reader.integer("noticed", 0, kLargestInt);
  }
  validateContext(context, reader.where());
  return context;
}

std::vector<Pose2> readPath(YamlReader& reader) {
  std::vector<Pose2> path;
  for (const std::vector<double>& n :
       parseNumberTable(reader.block("path"), 3, reader.where("path"))) {
    path.emplace_back(n[0], n[1], n[2]);
    validateCasePose(path.back(), reader.where("path") + " line " + std::to_string(path.size()));
  }
  return path;
}

ObservedOutcome readObservation(YamlReader& entry, int version) {
  ObservedOutcome outcome;
  outcome.source = readWord(entry, "source", &outcomeSourceFromString,
                            "explored, demonstrated, transferred, practised, adapted");
  outcome.start_T_object = readPose(entry, "start_T_object");
  if (outcome.start_T_object.position().cwiseAbs().maxCoeff() > kLargestCaseCoordinate_m) {
    throw InputError(entry.where("start_T_object"),
                     "is too far away; x and y must be within 100 m of 0");
  }
  outcome.past_weight = entry.number("past_weight", 0.0, kLargest);
  if (version > 1) {
    outcome.noise = readNoise(entry);
    if (entry.has("stamp_s")) {
      outcome.stamp_s = entry.number("stamp_s", -kLargest, kLargest);
    }
    outcome.context = readContext(entry);
    if (entry.has("path")) {
      outcome.path = readPath(entry);
    }
  }
  entry.finish();
  return outcome;
}

// Counts tell when lines are missing.
void requireCount(YamlReader& reader, const char* key, std::size_t found, const char* what) {
  const int count = reader.integer(key, 0, kLargestInt);
  if (static_cast<std::size_t>(count) != found) {
    throw InputError(reader.where(key), "is " + std::to_string(count) + ", but the file holds " +
                                            std::to_string(found) + " " + what +
                                            "; is the file complete?");
  }
}

std::vector<ObservedOutcome> readHistory(YamlReader& reader, int version) {
  std::vector<ObservedOutcome> history;
  for (YamlReader& entry : reader.children("history")) {
    history.push_back(readObservation(entry, version));
  }
  if (version > 1) {
    requireCount(reader, "history_count", history.size(), "observations");
  }
  return history;
}

std::vector<CaseStep> readStepsOfVersion1(YamlReader& reader) {
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

std::vector<CaseStep> readSteps(YamlReader& reader) {
  std::vector<CaseStep> steps;
  for (const std::vector<double>& n :
       parseNumberTable(reader.block("steps"), 9, reader.where("steps"))) {
    steps.push_back({Pose2(n[0], n[1], n[2]), Twist2{n[3], n[4], n[5]}, Pose2(n[6], n[7], n[8])});
  }
  requireCount(reader, "step_count", steps.size(), "steps");
  return steps;
}

std::vector<PoseGaussian> readTube(YamlReader& reader) {
  std::vector<PoseGaussian> tube;
  for (const std::vector<double>& n :
       parseNumberTable(reader.block("tube"), 9, reader.where("tube"))) {
    PoseGaussian step{Pose2(n[0], n[1], n[2]), {}};
    step.covariance << n[3], n[4], n[5], n[4], n[6], n[7], n[5], n[7], n[8];
    tube.push_back(step);
  }
  return tube;
}

CasePrior readPrior(YamlReader reader, const CaseRecord& record) {
  CasePrior prior;
  prior.after_number = reader.integer("after", 0, static_cast<int>(record.history.size()));
  prior.start_outcome = readGaussian(reader);
  prior.effective_count = reader.number("effective_count", 0.0, kLargest);
  prior.observation_count = reader.integer("observation_count", 0, kLargestInt);
  prior.noise = readNoise(reader);
  if (reader.has("tube")) {
    prior.tube = readTube(reader);
  }
  reader.finish();
  // As a case with these statistics.
  Case then = record.push_case;
  then.start_outcome = prior.start_outcome;
  then.effective_count = prior.effective_count;
  then.tube = prior.tube;
  validateCase(then, reader.where());
  return prior;
}

// Version 1 wrote no counts, but the first observation is where the recorded steps end.
void requireWholeSteps(const CaseRecord& record, const std::string& where) {
  if (record.history.empty() || record.push_case.steps.empty()) {
    return;
  }
  const Pose2& end = record.push_case.steps.back().start_T_object;
  const Pose2& first = record.history.front().start_T_object;
  if (distance(end, first) > 1e-9 || std::abs(yawDifference(end, first)) > 1e-9) {
    throw InputError(where + ": steps",
                     "end elsewhere than the first observation; is the file complete?");
  }
}

void completeVersion1(CaseRecord& record, const std::string& where) {
  requireWholeSteps(record, where);
  Case& push_case = record.push_case;
  push_case.tube = tubeFromOutcome(push_case.steps, push_case.start_outcome, {});
  record.prior = {static_cast<int>(record.history.size()),
                  push_case.start_outcome,
                  push_case.effective_count,
                  push_case.observation_count,
                  {},
                  {}};
}

CaseRecord readCase(YamlReader& reader, int version) {
  CaseRecord record;
  Case& push_case = record.push_case;
  push_case.id = reader.integer("id", 0, kLargestInt);
  push_case.object = reader.text("object");
  push_case.robot = reader.text("robot", "");
  push_case.origin =
      readWord(reader, "origin", &caseOriginFromString, "explored, demonstrated, transferred");
  push_case.period_s = reader.number("period_s", 0.0, kLargest);
  push_case.push_steps = reader.integer("push_steps", 1, kLargestInt);
  push_case.start_outcome = readOutcome(reader.child("outcome"));
  push_case.effective_count = reader.number("effective_count", 0.0, kLargest);
  push_case.observation_count = reader.integer("observation_count", 0, kLargestInt);
  record.history = readHistory(reader, version);
  if (version == 1) {
    push_case.steps = readStepsOfVersion1(reader);
    reader.finish();
    validateCase(push_case, reader.where());
    completeVersion1(record, reader.where());
    return record;
  }
  push_case.source_id = reader.has("source_id") ? reader.integer("source_id", 1, kLargestInt) : 0;
  push_case.context = readContext(reader);
  push_case.steps = readSteps(reader);
  push_case.tube = readTube(reader);
  if (push_case.tube.size() != push_case.steps.size()) {
    throw InputError(reader.where("tube"), "holds " + std::to_string(push_case.tube.size()) +
                                               " lines; must hold one for each step");
  }
  validateCase(push_case, reader.where());
  record.prior = readPrior(reader.child("prior"), record);
  reader.finish();
  return record;
}

}  // namespace

std::vector<CaseRecord> readCases(const std::filesystem::path& file) {
  YamlReader reader = YamlReader::fromFile(file);
  const double version = reader.number(kFormatKey, 1.0, kLargest);
  if (version != 1.0 && version != kFormatVersion) {
    throw InputError(reader.where(kFormatKey), "is newer than this program; update casepush");
  }
  if (!reader.has("cases")) {
    throw InputError(reader.where("cases"), "is missing; must be a list of cases");
  }
  std::vector<CaseRecord> records;
  for (YamlReader& entry : reader.children("cases")) {
    records.push_back(readCase(entry, static_cast<int>(version)));
  }
  if (version > 1.0) {
    requireCount(reader, "case_count", records.size(), "cases");
  }
  reader.finish();
  return records;
}

}  // namespace casepush
