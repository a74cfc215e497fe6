#include "casepush/execution/exploration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "casepush/planning/prepared_cases.h"
#include "coverage.h"
#include "exploration_data.h"

namespace casepush {
namespace {

constexpr double kMostSpeedShare = 0.9;  // Of what the robot can do.
// A first trial is kept if it adds this share of the coverage that was expected of it; what is left
// of the share after each one that does not.
constexpr double kAcceptedShare = 0.5;
constexpr double kRelaxation = 0.8;
// Pushes from which the scatter of a case can be told.
constexpr int kEnoughToJudge = 5;
constexpr int kMaxFailuresInRow = 5;

}  // namespace

const char* toString(CoverageStrategy strategy) {
  return strategy == CoverageStrategy::kRandom ? "random" : "spread";
}

CoverageStrategy coverageStrategyFromString(const std::string& name) {
  for (const CoverageStrategy strategy : {CoverageStrategy::kRandom, CoverageStrategy::kSpread}) {
    if (name == toString(strategy)) {
      return strategy;
    }
  }
  throw InputError("coverage", "is '" + name + "', must be random or spread");
}

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

Exploration::Data::Data(const ObjectModel& object_model, const RobotModel& robot_model,
                        const ExplorationOptions& given)
    : options(given),
      object(object_model),
      robot(robot_model),
      candidates(object_model, robot_model, given),
      accepted_share(kAcceptedShare) {}

std::vector<Pose2> Exploration::Data::outcomes() const {
  std::vector<Pose2> means;
  for (const KnownCase& known : cases) {
    means.push_back(known.push_case.start_outcome.mean);
  }
  return means;
}

KnownCase* Exploration::Data::find(std::int64_t id) {
  const auto found = std::find_if(cases.begin(), cases.end(), [id](const KnownCase& known) {
    return known.push_case.id == id;
  });
  return found == cases.end() ? nullptr : &*found;
}

bool Exploration::Data::isDone() const {
  const auto pending = [this](const KnownCase& known) { return isPending(known); };
  return !to_store && !wantsCases() && std::none_of(cases.begin(), cases.end(), pending);
}

bool Exploration::Data::gaveUp() const {
  return !isDone() && (!stuck.empty() || failures.isBlind() ||
                       failures.total() + pushes_of_dropped >= options.max_failures);
}

Exploration::Trial Exploration::Data::practice(const KnownCase& known) const {
  Trial trial;
  trial.kind = Trial::Kind::kPractise;
  trial.case_id = known.push_case.id;
  trial.object_T_robot = known.push_case.steps.front().object_T_robot;
  trial.object_T_reset = candidates.runUp(trial.object_T_robot, pushDirection(known.push_case));
  trial.case_number = static_cast<int>(&known - cases.data()) + 1;
  trial.practice_number = known.push_case.observation_count + 1;
  trial.serial = known.serial;
  trial.repetition = known.repetitions + 1;
  return trial;
}

Exploration::Trial Exploration::Data::exploring(const PushConfiguration& push) const {
  Trial trial;
  trial.configuration = push;
  trial.object_T_robot = push.object_T_robot;
  trial.object_T_reset =
      candidates.runUp(push.object_T_robot, push.object_T_robot.yaw() + push.direction_rad);
  trial.case_number = static_cast<int>(cases.size()) + 1;
  trial.practice_number = 1;
  trial.serial = attempt;
  return trial;
}

bool Exploration::Data::isUseful(const Trial& trial, const PushReport& report) {
  if (report.outcome != PushOutcome::kDone || hasLostContact(report.recorded)) {
    return false;
  }
  const Pose2& outcome = report.recorded.start_outcome.mean;
  if (outcome.position().norm() < options.min_displacement_m &&
      std::abs(outcome.yaw()) < options.min_rotation_rad) {
    return false;
  }
  if (options.coverage == CoverageStrategy::kRandom) {
    return true;
  }
  DisplacementCoverage coverage(coverageRegion(options));
  for (const Pose2& covered : outcomes()) {
    coverage.add(covered);
  }
  const double expected = coverage.gain(candidates.predict(trial.configuration));
  if (coverage.gain(outcome) < accepted_share * expected) {
    accepted_share *= kRelaxation;
    return false;
  }
  accepted_share = kAcceptedShare;
  return true;
}

Exploration::Verdict Exploration::Data::judgeTrial(const Trial& trial, const PushReport& report,
                                                   bool was_free) {
  ++attempt;
  const bool is_useful = was_free && isUseful(trial, report);
  if (was_free && isObservation(report)) {
    candidates.learn(trial.configuration, report.recorded.start_outcome.mean);
  }
  if (is_useful) {
    to_store = report.recorded;
    failures.addUseful();
    return Verdict::kStoreCase;
  }
  failures.add(report.outcome);
  return Verdict::kDiscard;
}

bool Exploration::Data::isTooUncertain(const KnownCase& known) const {
  const OutcomeSigma sigma =
      outcomeSigma(known.push_case.start_outcome, known.push_case.effective_count);
  return known.push_case.observation_count >= kEnoughToJudge &&
         (sigma.position_m > options.max_position_sigma_m ||
          sigma.yaw_rad > options.max_yaw_sigma_rad);
}

Exploration::Verdict Exploration::Data::reject(KnownCase& known) {
  if (!known.is_new) {
    known.set_aside = true;
    return Verdict::kDiscard;
  }
  ++dropped;
  pushes_of_dropped += known.push_case.observation_count;
  cases.erase(cases.begin() + (&known - cases.data()));
  return Verdict::kDropCase;
}

Exploration::Verdict Exploration::Data::judgeRepetition(const Trial& trial,
                                                        const PushReport& report, bool was_free,
                                                        bool has_driven) {
  KnownCase* known = find(*trial.case_id);
  CASEPUSH_CHECK(known != nullptr, "case " << *trial.case_id << " is not known");
  ++known->repetitions;
  if (isObservation(report) && was_free) {
    return Verdict::kObserve;
  }
  failures.add(report.outcome);
  const bool is_fault_of_the_place =
      has_driven && (!was_free || report.outcome == PushOutcome::kApproachFailed);
  if (is_fault_of_the_place || FailureTally::isNoFaultOfThePush(report.outcome)) {
    return Verdict::kDiscard;
  }
  return ++known->failed_in_row >= kMaxFailuresInRow ? reject(*known) : Verdict::kDiscard;
}

Exploration::Exploration(ObjectModel object, RobotModel robot, ExplorationOptions options) {
  options.validate();
  options.max_speed_mps =
      std::min(options.max_speed_mps, kMostSpeedShare * robot.limits.max_speed_mps);
  if (options.min_speed_mps > options.max_speed_mps) {
    throw InputError("exploration options",
                     "min_speed_mps is " + std::to_string(options.min_speed_mps) +
                         ", above nine tenths of what robot " + robot.name +
                         " can do: " + std::to_string(options.max_speed_mps));
  }
  data_ = std::make_unique<Data>(object, robot, options);
}

Exploration::~Exploration() = default;

void Exploration::resume(const std::vector<Case>& cases) {
  for (const Case& push_case : cases) {
    if (isFor(push_case, data_->object.name, data_->robot.name)) {
      KnownCase known;
      known.push_case = push_case;
      known.serial = data_->attempt++;
      known.repetitions = push_case.observation_count - 1;
      data_->cases.push_back(std::move(known));
    }
  }
}

std::optional<Exploration::Trial> Exploration::next() const {
  CASEPUSH_CHECK(!data_->to_store, "stored() must follow a verdict kStoreCase");
  if (finished()) {
    return std::nullopt;
  }
  for (const KnownCase& known : data_->cases) {
    if (data_->isPending(known)) {
      return data_->practice(known);
    }
  }
  const auto push = data_->candidates.draw(data_->attempt, data_->outcomes(), {});
  CASEPUSH_CHECK(push.has_value(), "the robot can not touch " << data_->object.name);
  return data_->exploring(*push);
}

Exploration::Verdict Exploration::judge(const Trial& trial, const PushReport& report,
                                        const PushGround* ground) {
  CASEPUSH_CHECK(!data_->to_store, "stored() must follow a verdict kStoreCase");
  const bool was_free = ground == nullptr || !isObservation(report) ||
                        ground->wasFree(report.map_T_start, courseOf(report.recorded));
  if (ground != nullptr && !isObservation(report)) {
    data_->noteBlocked(trial);
  }
  if (trial.kind == Trial::Kind::kExplore) {
    return data_->judgeTrial(trial, report, was_free);
  }
  if (trial.case_id) {
    return data_->judgeRepetition(trial, report, was_free, ground != nullptr);
  }
  if (!isObservation(report)) {
    data_->failures.add(report.outcome);
  } else if (was_free) {
    data_->candidates.learn(trial.configuration, report.recorded.start_outcome.mean);
  }
  return Verdict::kDiscard;
}

void Exploration::stored(std::int64_t case_id) {
  CASEPUSH_CHECK(data_->to_store.has_value(), "nothing was to be stored");
  KnownCase known;
  known.push_case = *data_->to_store;
  known.push_case.id = case_id;
  known.serial = data_->attempt - 1;
  known.is_new = true;
  data_->cases.push_back(std::move(known));
  data_->to_store.reset();
}

bool Exploration::observed(const Case& updated) {
  KnownCase* known = data_->find(updated.id);
  CASEPUSH_CHECK(known != nullptr, "case " << updated.id << " is not known");
  data_->failures.addUseful();
  known->failed_in_row = 0;
  known->push_case = updated;
  if (!known->is_new || !data_->isTooUncertain(*known)) {
    return true;
  }
  data_->reject(*known);
  return false;
}

bool Exploration::finished() const { return data_->isDone() || data_->gaveUp(); }

bool Exploration::gaveUp() const { return data_->gaveUp(); }

int Exploration::discarded() const { return data_->failures.total(); }

int Exploration::broughtBack() const { return data_->brought_back; }

std::string Exploration::explanation() const {
  return data_->stuck.empty() ? data_->failures.describe() : data_->stuck;
}

int Exploration::dropped() const { return data_->dropped; }

int Exploration::pushesDone() const {
  int done = 0;
  const std::size_t count =
      std::min(data_->cases.size(), static_cast<std::size_t>(data_->options.cases));
  for (std::size_t i = 0; i < count; ++i) {
    done += std::min(data_->cases[i].push_case.observation_count, data_->options.practices);
  }
  return done;
}

ExplorationQuality Exploration::quality() const {
  ExplorationQuality quality;
  quality.cases = static_cast<int>(data_->cases.size());
  quality.widest_gap_rad = directionGaps(data_->outcomes()).front().width_rad;
  for (const KnownCase& known : data_->cases) {
    const Case& push_case = known.push_case;
    const OutcomeSigma sigma = outcomeSigma(push_case.start_outcome, push_case.effective_count);
    const double length_m = push_case.start_outcome.mean.position().norm();
    const Turn turn = turnOf(push_case.start_outcome.mean);
    const bool is_first = quality.observations == 0;
    quality.complete_cases += push_case.observation_count >= data_->options.practices ? 1 : 0;
    quality.observations += push_case.observation_count;
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

bool keep(Exploration& exploration, const Exploration::Trial& trial, const PushReport& report,
          CaseBase& case_base, const KeepOptions& options, const PushGround* ground) {
  switch (exploration.judge(trial, report, ground)) {
    case Exploration::Verdict::kStoreCase: {
      Case recorded = report.recorded;
      recorded.context = options.context;
      exploration.stored(case_base.add(recorded, report.end_stamp_s, options.floor));
      return true;
    }
    case Exploration::Verdict::kObserve: {
      const ObservedPush push = observedPush(report, options.context);
      if (!exploration.observed(case_base.observe(*trial.case_id, push, options.floor))) {
        case_base.remove(*trial.case_id);
      }
      return true;
    }
    case Exploration::Verdict::kDropCase:
      case_base.remove(*trial.case_id);
      return true;
    case Exploration::Verdict::kDiscard:
      break;
  }
  return false;
}

}  // namespace casepush
