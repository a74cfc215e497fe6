// Writes what case_yaml.cpp reads. By hand: YAML::Emitter takes ten times as long.
#include <initializer_list>

#include "case_yaml.h"
#include "number_table.h"

namespace casepush {
namespace {

std::string exact(double value) {
  std::string digits;
  appendNumber(digits, value);
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
  const char* separator = "[";
  for (const double value : values) {
    yaml += separator;
    appendNumber(yaml, value);
    separator = ", ";
  }
  yaml += ']';
}

void appendRow(std::string& yaml, const std::string& indent, std::initializer_list<double> values) {
  yaml += indent;
  for (const double value : values) {
    appendNumber(yaml, value);
    yaml += ' ';
  }
  yaml.back() = '\n';
}

void appendPose(std::string& yaml, const Pose2& pose) {
  appendNumbers(yaml, {pose.x(), pose.y(), pose.yaw()});
}

void appendLine(std::string& yaml, const char* key, const std::string& value) {
  yaml.append("    ").append(key).append(": ").append(value).append("\n");
}

void appendGaussian(std::string& yaml, const PoseGaussian& gaussian) {
  const Eigen::Matrix3d& c = gaussian.covariance;
  yaml += "      mean: ";
  appendPose(yaml, gaussian.mean);
  yaml += "\n      covariance: ";
  appendNumbers(yaml, {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)});
  yaml += '\n';
}

void appendTube(std::string& yaml, const std::string& indent,
                const std::vector<PoseGaussian>& tube) {
  yaml += indent + "tube: |\n";
  for (const PoseGaussian& step : tube) {
    const Pose2& m = step.mean;
    const Eigen::Matrix3d& c = step.covariance;
    appendRow(yaml, indent + "  ",
              {m.x(), m.y(), m.yaw(), c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)});
  }
}

void appendNoise(std::string& yaml, const CovarianceFloor& noise) {
  yaml += "noise: ";
  appendNumbers(yaml, {noise.position_m, noise.yaw_rad});
  yaml += '\n';
}

void appendContext(std::string& yaml, const std::string& indent, const PushContext& context) {
  if (context.load_kg) {
    yaml += indent + "load_kg: " + exact(*context.load_kg) + '\n';
  }
  if (!context.floor.empty()) {
    yaml += indent + "floor: " + quoted(context.floor) + '\n';
  }
  if (context.noticed > 0) {
    yaml += indent + "noticed: " + std::to_string(context.noticed) + '\n';
  }
}

void appendOutcome(std::string& yaml, const ObservedOutcome& outcome) {
  const std::string indent = "        ";
  yaml.append("      - source: ").append(toString(outcome.source)).append("\n");
  yaml += indent + "start_T_object: ";
  appendPose(yaml, outcome.start_T_object);
  yaml += '\n' + indent + "past_weight: " + exact(outcome.past_weight) + '\n' + indent;
  appendNoise(yaml, outcome.noise);
  if (outcome.stamp_s) {
    yaml += indent + "stamp_s: " + exact(*outcome.stamp_s) + '\n';
  }
  appendContext(yaml, indent, outcome.context);
  if (!outcome.path.empty()) {
    yaml += indent + "path: |\n";
    for (const Pose2& pose : outcome.path) {
      appendRow(yaml, indent + "  ", {pose.x(), pose.y(), pose.yaw()});
    }
  }
}

void appendHistory(std::string& yaml, const std::vector<ObservedOutcome>& history) {
  appendLine(yaml, "history_count", std::to_string(history.size()));
  yaml += history.empty() ? "    history: []\n" : "    history:\n";
  for (const ObservedOutcome& outcome : history) {
    appendOutcome(yaml, outcome);
  }
}

void appendPrior(std::string& yaml, const CasePrior& prior) {
  yaml += "    prior:\n      after: " + std::to_string(prior.after_number) + '\n';
  appendGaussian(yaml, prior.start_outcome);
  yaml += "      effective_count: " + exact(prior.effective_count) + '\n';
  yaml += "      observation_count: " + std::to_string(prior.observation_count) + "\n      ";
  appendNoise(yaml, prior.noise);
  if (!prior.tube.empty()) {
    appendTube(yaml, "      ", prior.tube);
  }
}

void appendSteps(std::string& yaml, const std::vector<CaseStep>& steps) {
  appendLine(yaml, "step_count", std::to_string(steps.size()));
  yaml += "    steps: |\n";
  for (const CaseStep& step : steps) {
    const Pose2& r = step.object_T_robot;
    const Twist2& a = step.action;
    const Pose2& o = step.start_T_object;
    appendRow(yaml, "      ",
              {r.x(), r.y(), r.yaw(), a.vx_mps, a.vy_mps, a.wz_rps, o.x(), o.y(), o.yaw()});
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
  if (push_case.source_id != 0) {
    appendLine(yaml, "source_id", std::to_string(push_case.source_id));
  }
  appendContext(yaml, "    ", push_case.context);
  appendLine(yaml, "period_s", exact(push_case.period_s));
  appendLine(yaml, "push_steps", std::to_string(push_case.push_steps));
  yaml += "    outcome:\n";
  appendGaussian(yaml, push_case.start_outcome);
  appendLine(yaml, "effective_count", exact(push_case.effective_count));
  appendLine(yaml, "observation_count", std::to_string(push_case.observation_count));
  appendPrior(yaml, record.prior);
  appendHistory(yaml, record.history);
  appendSteps(yaml, push_case.steps);
  appendTube(yaml, "    ", push_case.tube);
}

}  // namespace

std::string formatCases(const std::vector<CaseRecord>& records) {
  std::string yaml =
      "# Poses: x [m], y [m], yaw [rad]. Covariances: upper triangle, row by row.\n"
      "# steps: object_T_robot; action vx [m/s], vy [m/s], wz [rad/s]; start_T_object.\n"
      "# tube: mean and covariance of start_T_object at each step. path: start_T_object.\n"
      "casepush_cases: 2\n";
  yaml += records.empty() ? "cases: []\n" : "cases:\n";
  for (const CaseRecord& record : records) {
    appendCase(yaml, record);
  }
  yaml += "case_count: " + std::to_string(records.size()) + "  # The last line: nothing is lost.\n";
  return yaml;
}

}  // namespace casepush
