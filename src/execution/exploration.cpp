#include "casepush/execution/exploration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "casepush/planning/prepared_cases.h"
#include "coverage.h"
#include "failure_tally.h"
#include "push_candidates.h"

namespace casepush {
namespace {

// Distance of a new outcome from those known, at first; the share that is left after each trial
// that came too near.
constexpr double kFirstSpacingM = 0.4;
constexpr double kRelaxation = 0.9;
// Pushes from which the scatter of a case can be told.
constexpr int kEnoughToJudge = 5;
constexpr int kMaxFailuresInRow = 5;

struct KnownCase {
  std::int64_t id;
  Pose2 object_T_robot;
  double push_direction_rad;
  PoseGaussian outcome;
  double effective_count;
  int observations;
  bool is_new = false;     ///< Found by this run: it may be removed again.
  bool set_aside = false;  ///< Of an earlier run, and failing now: kept, but not practised.
};

KnownCase known(const Case& push_case, std::int64_t id) {
  return {id,
          push_case.steps.front().object_T_robot,
          pushDirection(push_case),
          push_case.start_outcome,
          push_case.effective_count,
          push_case.observation_count,
          false,
          false};
}

}  // namespace

void ExplorationOptions::validate() const {
  Violations violations;
  violations.require("cases", cases, 1, 1000);
  violations.require("practices", practices, 1, 10000);
  violations.require("min_speed_mps", min_speed_mps, 0.01, 5.0);
  violations.require("max_speed_mps", max_speed_mps, min_speed_mps, 5.0);
  violations.require("min_duration_s", min_duration_s, 0.1, 60.0);
  violations.require("max_duration_s", max_duration_s, min_duration_s, 60.0);
  violations.require("start_gap_m", start_gap_m, 0.0, 1.0);
  violations.require("min_displacement_m", min_displacement_m, 0.0, 10.0);
  violations.require("min_rotation_rad", min_rotation_rad, 0.0, M_PI);
  violations.require("max_position_sigma_m", max_position_sigma_m, 0.001, 100.0);
  violations.require("max_yaw_sigma_rad", max_yaw_sigma_rad, 0.001, 100.0);
  violations.require("max_failures", max_failures, 1, 1000000);
  violations.throwIfAny("exploration options");
}

struct Exploration::Data {
  Data(const ObjectModel& object, const RobotModel& robot, const ExplorationOptions& given)
      : options(given),
        object_name(object.name),
        robot_name(robot.name),
        gyration_radius_m(object.gyration_radius_m),
        candidates(object, robot, given) {}

  ExplorationOptions options;
  std::string object_name;
  std::string robot_name;
  double gyration_radius_m;
  PushCandidates candidates;

  std::vector<KnownCase> cases;
  std::optional<Case> to_store;
  PushConfiguration candidate;
  int attempt = 0;
  int useless_in_row = 0;  ///< First trials since the last case.
  int failed_in_row = 0;   ///< Practices of the present case.
  double spacing_m = kFirstSpacingM;
  FailureTally failures;
  int dropped = 0;
  int pushes_of_dropped = 0;

  std::vector<Pose2> outcomes() const;
  KnownCase* toPractise();
  void drawCandidate() { candidate = candidates.draw(attempt, useless_in_row, outcomes()); }
  bool isUseful(const PushReport& report);
  Verdict judgeTrial(const PushReport& report);
  Verdict judgePractice(KnownCase& practised, const PushReport& report,
                        const std::optional<Case>& updated);
  Verdict reject(KnownCase& practised);
  bool isTooUncertain(const KnownCase& practised) const;
  bool gaveUp() const {
    return failures.isBlind() || failures.total() + pushes_of_dropped >= options.max_failures;
  }
  bool finished();
};

std::vector<Pose2> Exploration::Data::outcomes() const {
  std::vector<Pose2> means;
  for (const KnownCase& push_case : cases) {
    means.push_back(push_case.outcome.mean);
  }
  return means;
}

KnownCase* Exploration::Data::toPractise() {
  for (KnownCase& push_case : cases) {
    if (push_case.observations < options.practices && !push_case.set_aside) {
      return &push_case;
    }
  }
  return nullptr;
}

bool Exploration::Data::finished() {
  return !to_store && toPractise() == nullptr && static_cast<int>(cases.size()) >= options.cases;
}

bool Exploration::Data::isUseful(const PushReport& report) {
  if (report.outcome != PushOutcome::kDone || hasLostContact(report.recorded)) {
    return false;
  }
  const Pose2& outcome = report.recorded.start_outcome.mean;
  if (outcome.position().norm() < options.min_displacement_m &&
      std::abs(outcome.yaw()) < options.min_rotation_rad) {
    return false;
  }
  for (const Pose2& covered : outcomes()) {
    if (outcomeDistance(covered, outcome, gyration_radius_m) < spacing_m) {
      spacing_m *= kRelaxation;
      return false;
    }
  }
  return true;
}

Exploration::Verdict Exploration::Data::judgeTrial(const PushReport& report) {
  ++attempt;
  if (isUseful(report)) {
    to_store = report.recorded;
    useless_in_row = 0;
    failures.addUseful();
    return Verdict::kStoreCase;
  }
  failures.add(report.outcome);
  ++useless_in_row;
  drawCandidate();
  return Verdict::kDiscard;
}

bool Exploration::Data::isTooUncertain(const KnownCase& practised) const {
  const OutcomeSigma sigma = outcomeSigma(practised.outcome, practised.effective_count);
  return practised.observations >= kEnoughToJudge &&
         (sigma.position_m > options.max_position_sigma_m ||
          sigma.yaw_rad > options.max_yaw_sigma_rad);
}

Exploration::Verdict Exploration::Data::reject(KnownCase& practised) {
  failed_in_row = 0;
  if (!practised.is_new) {
    practised.set_aside = true;
    return Verdict::kDiscard;
  }
  ++dropped;
  pushes_of_dropped += practised.observations;
  cases.erase(cases.begin() + (&practised - cases.data()));
  drawCandidate();
  return Verdict::kDropCase;
}

Exploration::Verdict Exploration::Data::judgePractice(KnownCase& practised,
                                                      const PushReport& report,
                                                      const std::optional<Case>& updated) {
  if (!isObservation(report) || !updated) {
    failures.add(report.outcome);
    if (FailureTally::isNoFaultOfThePush(report.outcome)) {
      return Verdict::kDiscard;
    }
    return ++failed_in_row >= kMaxFailuresInRow ? reject(practised) : Verdict::kDiscard;
  }
  CASEPUSH_CHECK(updated->id == practised.id,
                 "practised case " << practised.id << ", was given " << updated->id);
  failed_in_row = 0;
  failures.addUseful();
  const bool is_new = practised.is_new;
  practised = known(*updated, practised.id);
  practised.is_new = is_new;
  if (!isTooUncertain(practised)) {
    return Verdict::kObserve;
  }
  return is_new ? reject(practised) : Verdict::kObserve;
}

Exploration::Exploration(ObjectModel object, RobotModel robot, ExplorationOptions options) {
  options.validate();
  if (options.max_speed_mps > robot.limits.max_speed_mps) {
    throw InputError("exploration options",
                     "max_speed_mps is " + std::to_string(options.max_speed_mps) +
                         ", above what robot " + robot.name +
                         " can do: " + std::to_string(robot.limits.max_speed_mps));
  }
  data_ = std::make_unique<Data>(object, robot, options);
  data_->drawCandidate();
}

Exploration::~Exploration() = default;

void Exploration::resume(const std::vector<Case>& cases) {
  for (const Case& push_case : cases) {
    if (isFor(push_case, data_->object_name, data_->robot_name)) {
      data_->cases.push_back(known(push_case, push_case.id));
    }
  }
  data_->attempt += static_cast<int>(data_->cases.size());
  data_->drawCandidate();
}

std::optional<Exploration::Trial> Exploration::next() const {
  CASEPUSH_CHECK(!data_->to_store, "stored() must follow a verdict kStoreCase");
  if (data_->finished() || data_->gaveUp()) {
    return std::nullopt;
  }
  Trial trial;
  if (const KnownCase* practised = data_->toPractise()) {
    trial.case_id = practised->id;
    trial.object_T_robot = practised->object_T_robot;
    trial.object_T_reset =
        data_->candidates.runUp(trial.object_T_robot, practised->push_direction_rad);
    trial.case_number = static_cast<int>(practised - data_->cases.data()) + 1;
    trial.practice_number = practised->observations + 1;
    return trial;
  }
  trial.configuration = data_->candidate;
  trial.object_T_robot = trial.configuration.object_T_robot;
  trial.object_T_reset = data_->candidates.runUp(
      trial.object_T_robot, trial.object_T_robot.yaw() + trial.configuration.direction_rad);
  trial.case_number = static_cast<int>(data_->cases.size()) + 1;
  trial.practice_number = 1;
  return trial;
}

Exploration::Verdict Exploration::judge(const PushReport& report,
                                        const std::optional<Case>& updated) {
  CASEPUSH_CHECK(!data_->to_store, "stored() must follow a verdict kStoreCase");
  if (KnownCase* practised = data_->toPractise()) {
    return data_->judgePractice(*practised, report, updated);
  }
  return data_->judgeTrial(report);
}

void Exploration::stored(std::int64_t case_id) {
  CASEPUSH_CHECK(data_->to_store.has_value(), "nothing was to be stored");
  data_->cases.push_back(known(*data_->to_store, case_id));
  data_->cases.back().is_new = true;
  data_->to_store.reset();
  data_->drawCandidate();
}

bool Exploration::finished() const { return data_->finished() || data_->gaveUp(); }

bool Exploration::gaveUp() const { return !data_->finished() && data_->gaveUp(); }

int Exploration::discarded() const { return data_->failures.total(); }

std::string Exploration::explanation() const { return data_->failures.describe(); }

int Exploration::dropped() const { return data_->dropped; }

ExplorationQuality Exploration::quality() const {
  ExplorationQuality quality;
  quality.cases = static_cast<int>(data_->cases.size());
  quality.widest_gap_rad = directionGaps(data_->outcomes()).front().width_rad;
  for (const KnownCase& push_case : data_->cases) {
    const OutcomeSigma sigma = outcomeSigma(push_case.outcome, push_case.effective_count);
    const double length_m = push_case.outcome.mean.position().norm();
    const Turn turn = turnOf(push_case.outcome.mean);
    const bool is_first = quality.observations == 0;
    quality.complete_cases += push_case.observations >= data_->options.practices ? 1 : 0;
    quality.observations += push_case.observations;
    quality.mean_position_sigma_m += sigma.position_m / quality.cases;
    quality.mean_yaw_sigma_rad += sigma.yaw_rad / quality.cases;
    quality.max_position_sigma_m = std::max(quality.max_position_sigma_m, sigma.position_m);
    quality.max_yaw_sigma_rad = std::max(quality.max_yaw_sigma_rad, sigma.yaw_rad);
    quality.shortest_m = is_first ? length_m : std::min(quality.shortest_m, length_m);
    quality.longest_m = std::max(quality.longest_m, length_m);
    quality.left_turns += turn == Turn::kLeft ? 1 : 0;
    quality.right_turns += turn == Turn::kRight ? 1 : 0;
  }
  return quality;
}

}  // namespace casepush
