#include "casepush/cases/case_base.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "case_base_data.h"
#include "case_file.h"
#include "case_yaml.h"
#include "casepush/cases/case_tube.h"
#include "casepush/common/atomic_file.h"
#include "casepush/common/input_error.h"

namespace casepush {
namespace {

namespace fs = std::filesystem;
using Kind = SqliteTransaction::Kind;

OutcomeSource firstSource(CaseOrigin origin) {
  switch (origin) {
    case CaseOrigin::kExplored:
      return OutcomeSource::kExplored;
    case CaseOrigin::kDemonstrated:
      return OutcomeSource::kDemonstrated;
    case CaseOrigin::kTransferred:
      break;
  }
  return OutcomeSource::kTransferred;
}

// Names go into one-line messages and into YAML, which takes no control characters.
void requirePrintable(const std::string& name, const std::string& where) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (std::any_of(name.begin(), name.end(), is_control)) {
    throw InputError(where, "holds a control character; must be a text on one line");
  }
}

// What is known of the observations behind a case that comes without its history: the only one, or
// the one that its steps recorded.
std::vector<ObservedOutcome> firstHistory(const Case& push_case,
                                          const std::optional<double>& stamp_s,
                                          const CovarianceFloor& floor) {
  if (push_case.observation_count == 0) {
    return {};
  }
  const Pose2& outcome = push_case.observation_count == 1 ? push_case.start_outcome.mean
                                                          : push_case.steps.back().start_T_object;
  return {{outcome, firstSource(push_case.origin), 0.0, floor, stamp_s, push_case.context, {}}};
}

// What is stored of a case that comes without its history.
// @throws InputError naming `where` if the case or its names can not be stored.
CaseRecord firstRecord(const Case& push_case, const std::optional<double>& stamp_s,
                       const CovarianceFloor& floor, const std::string& where) {
  validateCase(push_case, where);
  floor.validate();
  requirePrintable(push_case.object, where + ": object");
  requirePrintable(push_case.robot, where + ": robot");
  CaseRecord record{push_case, {}, firstHistory(push_case, stamp_s, floor)};
  record.prior = {static_cast<int>(record.history.size()),
                  push_case.start_outcome,
                  push_case.effective_count,
                  push_case.observation_count,
                  floor,
                  push_case.tube};
  if (push_case.tube.empty()) {
    record.push_case.tube = tubeFromOutcome(push_case.steps, push_case.start_outcome, floor);
  }
  return record;
}

void validatePush(const ObservedPush& push, const std::string& where) {
  if (!push.start_T_object.isFinite()) {
    throw InputError(where, "observed outcome is not finite");
  }
  if (push.start_T_object.position().cwiseAbs().maxCoeff() > kLargestCaseCoordinate_m) {
    throw InputError(where, "observed outcome is too far away; x and y must be within 100 m of 0");
  }
  for (std::size_t i = 0; i < push.steps.size(); ++i) {
    validateCasePose(push.steps[i].start_T_object,
                     where + ": observed steps[" + std::to_string(i) + "].start_T_object");
  }
  if (push.stamp_s && !std::isfinite(*push.stamp_s)) {
    throw InputError(where, "observed stamp is not finite");
  }
  validateContext(push.context, where + ": observed");
}

// Adds a push with the past counting `weigh(statistics)`, and keeps it.
template <typename Weigh>
Case addPush(SqliteDatabase& database, std::int64_t id, const ObservedPush& push,
             OutcomeSource source, const CovarianceFloor& floor, const Weigh& weigh) {
  SqliteTransaction transaction(database, Kind::kWrite);
  const Case known = existingCase(database, id);
  const std::string where = whereIs(database, id);
  validatePush(push, where);
  const double weight = weigh(OutcomeStatistics{known.start_outcome, known.effective_count});
  const Case updated = withPush(known, push, weight, floor);
  validateCase(updated, where);  // Else it could not be read again.
  updateStatistics(database, updated);
  const bool takes_over = takesOverTrajectories(known, push);
  insertOutcome(database, id,
                {push.start_T_object, source, weight, floor, push.stamp_s, push.context,
                 takes_over ? std::vector<Pose2>() : objectPath(push.steps)});
  if (takes_over) {
    updateSteps(database, updated);
    // The tube follows from the new steps and the outcome.
    replacePrior(
        database, id,
        {1, updated.start_outcome, updated.effective_count, updated.observation_count, floor, {}});
  }
  transaction.commit();
  return updated;
}

}  // namespace

Case existingCase(SqliteDatabase& database, std::int64_t id) {
  std::optional<Case> push_case = selectCase(database, id);
  if (!push_case) {
    throw InputError(whereIs(database, id), "does not exist");
  }
  return std::move(*push_case);
}

CaseBase::CaseBase(const fs::path& file, Access access)
    : database_(new Database{openCaseFile(file, access)}) {}
CaseBase::CaseBase(const std::vector<Case>& cases, const CovarianceFloor& floor)
    : database_(new Database{openCaseMemory()}) {
  SqliteDatabase& sqlite = database_->sqlite;
  SqliteTransaction transaction(sqlite, Kind::kWrite);
  for (const Case& push_case : cases) {
    insertCase(sqlite, firstRecord(push_case, std::nullopt, floor, whereIs(sqlite, push_case.id)),
               push_case.id);
  }
  transaction.commit();
}
CaseBase::~CaseBase() = default;
CaseBase::CaseBase(CaseBase&&) noexcept = default;
CaseBase& CaseBase::operator=(CaseBase&&) noexcept = default;

std::vector<Case> CaseBase::cases(const std::string& object) const {
  return selectCases(database_->sqlite, object);
}

Case CaseBase::get(std::int64_t id) const { return existingCase(database_->sqlite, id); }

int CaseBase::count() const {
  return static_cast<int>(database_->sqlite.integer("SELECT count(*) FROM cases"));
}

std::int64_t CaseBase::add(const Case& push_case, const std::optional<double>& stamp_s,
                           const CovarianceFloor& floor) {
  SqliteDatabase& sqlite = database_->sqlite;
  const CaseRecord record = firstRecord(push_case, stamp_s, floor, sqlite.file() + ": new case");
  SqliteTransaction transaction(sqlite, Kind::kWrite);
  const std::int64_t id = insertCase(sqlite, record);
  transaction.commit();
  return id;
}

Case CaseBase::observe(std::int64_t id, const ObservedPush& push, const CovarianceFloor& floor) {
  return addPush(database_->sqlite, id, push, OutcomeSource::kPractised, floor,
                 [](const OutcomeStatistics& past) { return past.effective_count; });
}

Case CaseBase::adapt(std::int64_t id, const ObservedPush& push, double p_value,
                     const AdaptationOptions& options, const CovarianceFloor& floor) {
  if (!(p_value >= 0.0 && p_value <= 1.0)) {
    throw InputError(whereIs(database_->sqlite, id),
                     "p-value is " + std::to_string(p_value) + "; must be in [0, 1]");
  }
  options.validate();
  return addPush(database_->sqlite, id, push, OutcomeSource::kAdapted, floor,
                 [&](const OutcomeStatistics& past) {
                   return adaptationWeight(past, push.start_T_object, p_value, options);
                 });
}

void CaseBase::remove(std::int64_t id) {
  SqliteTransaction transaction(database_->sqlite, Kind::kWrite);
  existingCase(database_->sqlite, id);
  deleteCase(database_->sqlite, id);
  transaction.commit();
}

std::vector<ObservedOutcome> CaseBase::history(std::int64_t id) const {
  SqliteTransaction transaction(database_->sqlite, Kind::kRead);
  existingCase(database_->sqlite, id);
  return selectHistory(database_->sqlite, id);
}

std::vector<Pose2> CaseBase::observations(std::int64_t id) const {
  std::vector<Pose2> poses;
  for (const ObservedOutcome& outcome : history(id)) {
    poses.push_back(outcome.start_T_object);
  }
  return poses;
}

void CaseBase::exportYaml(const fs::path& file) const {
  SqliteDatabase& sqlite = database_->sqlite;
  std::error_code missing;
  if (fs::equivalent(file, sqlite.file(), missing)) {
    throw InputError(file.string(), "is the case base itself; export to another file");
  }
  std::vector<CaseRecord> records;
  {
    SqliteTransaction transaction(sqlite, Kind::kRead);
    for (const Case& push_case : selectCases(sqlite, "")) {
      records.push_back(selectRecord(sqlite, push_case));
    }
  }
  writeFileAtomically(file, formatCases(records));
}

int CaseBase::importYaml(const fs::path& file) {
  std::vector<CaseRecord> records = readCases(file);
  SqliteTransaction transaction(database_->sqlite, Kind::kWrite);
  insertWithSources(database_->sqlite, records);
  transaction.commit();
  return static_cast<int>(records.size());
}

}  // namespace casepush
