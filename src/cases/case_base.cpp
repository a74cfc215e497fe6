#include "casepush/cases/case_base.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atomic_file.h"
#include "case_file.h"
#include "case_rows.h"
#include "case_yaml.h"
#include "casepush/common/input_error.h"

namespace casepush {
namespace {

namespace fs = std::filesystem;
using Kind = SqliteTransaction::Kind;

std::string whereIs(const SqliteDatabase& database, std::int64_t id) {
  return database.file() + ": case " + std::to_string(id);
}

Case existingCase(SqliteDatabase& database, std::int64_t id) {
  std::optional<Case> push_case = selectCase(database, id);
  if (!push_case) {
    throw InputError(whereIs(database, id), "does not exist");
  }
  return std::move(*push_case);
}

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
std::vector<ObservedOutcome> firstHistory(const Case& push_case) {
  if (push_case.observation_count == 0) {
    return {};
  }
  const Pose2& outcome = push_case.observation_count == 1 ? push_case.start_outcome.mean
                                                          : push_case.steps.back().start_T_object;
  return {{outcome, firstSource(push_case.origin), 0.0}};
}

// Updates the statistics of a case by `blend(statistics)` and keeps the observation.
template <typename Blend>
Case addOutcome(SqliteDatabase& database, std::int64_t id, const Pose2& start_T_object,
                OutcomeSource source, const Blend& blend) {
  SqliteTransaction transaction(database, Kind::kWrite);
  Case push_case = existingCase(database, id);
  if (!start_T_object.isFinite()) {
    throw InputError(whereIs(database, id), "observed outcome is not finite");
  }
  if (start_T_object.position().cwiseAbs().maxCoeff() > kLargestCaseCoordinate_m) {
    throw InputError(whereIs(database, id),
                     "observed outcome is too far away; x and y must be within 100 m of 0");
  }
  const OutcomeStatistics updated = blend({push_case.start_outcome, push_case.effective_count});
  push_case.start_outcome = updated.start_outcome;
  push_case.effective_count = updated.effective_count;
  ++push_case.observation_count;
  validateCase(push_case, whereIs(database, id));  // Else it could not be read again.
  updateStatistics(database, push_case);
  insertOutcome(database, id, {start_T_object, source, updated.effective_count - 1.0});
  transaction.commit();
  return push_case;
}

}  // namespace

struct CaseBase::Database {
  SqliteDatabase sqlite;
};

CaseBase::CaseBase(const fs::path& file, Access access)
    : database_(new Database{openCaseFile(file, access)}) {}
CaseBase::~CaseBase() = default;
CaseBase::CaseBase(CaseBase&&) noexcept = default;
CaseBase& CaseBase::operator=(CaseBase&&) noexcept = default;

std::vector<Case> CaseBase::cases(const std::string& object) const {
  return selectCases(database_->sqlite, object);
}

Case CaseBase::get(std::int64_t id) const { return existingCase(database_->sqlite, id); }

std::int64_t CaseBase::add(const Case& push_case) {
  SqliteDatabase& sqlite = database_->sqlite;
  const std::string where = sqlite.file() + ": new case";
  validateCase(push_case, where);
  requirePrintable(push_case.object, where + ": object");
  requirePrintable(push_case.robot, where + ": robot");
  SqliteTransaction transaction(sqlite, Kind::kWrite);
  const std::int64_t id = insertCase(sqlite, {push_case, firstHistory(push_case)});
  transaction.commit();
  return id;
}

Case CaseBase::observe(std::int64_t id, const Pose2& start_T_object, const CovarianceFloor& floor) {
  return addOutcome(
      database_->sqlite, id, start_T_object, OutcomeSource::kPractised,
      [&](const OutcomeStatistics& past) { return addObservation(past, start_T_object, floor); });
}

Case CaseBase::adapt(std::int64_t id, const Pose2& start_T_object, double weight,
                     const CovarianceFloor& floor) {
  if (!std::isfinite(weight) || weight < 1.0) {
    throw InputError(whereIs(database_->sqlite, id),
                     "weight of the past is " + std::to_string(weight) + "; must be >= 1");
  }
  return addOutcome(database_->sqlite, id, start_T_object, OutcomeSource::kAdapted,
                    [&](const OutcomeStatistics& past) {
                      return weight < past.effective_count
                                 ? casepush::adapt(past, start_T_object, weight, floor)
                                 : addObservation(past, start_T_object, floor);
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
    for (Case& push_case : selectCases(sqlite, "")) {
      const std::int64_t id = push_case.id;
      records.push_back({std::move(push_case), selectHistory(sqlite, id)});
    }
  }
  writeFileAtomically(file, formatCases(records));
}

int CaseBase::importYaml(const fs::path& file) {
  const std::vector<CaseRecord> records = readCases(file);
  SqliteTransaction transaction(database_->sqlite, Kind::kWrite);
  for (const CaseRecord& record : records) {
    insertCase(database_->sqlite, record);
  }
  transaction.commit();
  return static_cast<int>(records.size());
}

}  // namespace casepush
