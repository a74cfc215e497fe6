#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "casepush/cases/case_base.h"
#include "sqlite.h"

namespace casepush {

/// What the statistics of a case were when outcome `after_number` had been added; later outcomes
/// can be taken back and added again from here.
struct CasePrior {
  int after_number = 0;
  PoseGaussian start_outcome;
  double effective_count = 0.0;
  int observation_count = 0;
  CovarianceFloor noise;           ///< For a tube that follows from steps and outcome.
  std::vector<PoseGaussian> tube;  ///< Empty if it follows.
};

/// A case with all that was observed of it.
struct CaseRecord {
  Case push_case;
  CasePrior prior;
  std::vector<ObservedOutcome> history;
};

std::optional<CaseOrigin> caseOriginFromString(const std::string& text);
std::optional<OutcomeSource> outcomeSourceFromString(const std::string& text);

/// "<file>: case <id>"
std::string whereIs(const SqliteDatabase& database, std::int64_t id);

/// Mean and upper triangle of the covariance, from nine columns.
PoseGaussian readGaussian(const SqliteStatement& row, int first_column);

/// Cases ascending by id; of all objects if `object` is empty.
/// @throws InputError naming file and case if a row makes no sense.
std::vector<Case> selectCases(SqliteDatabase& database, const std::string& object);
std::optional<Case> selectCase(SqliteDatabase& database, std::int64_t id);
CasePrior selectPrior(SqliteDatabase& database, std::int64_t id);
std::vector<ObservedOutcome> selectHistory(SqliteDatabase& database, std::int64_t id);
CaseRecord selectRecord(SqliteDatabase& database, const Case& push_case);

/// Inserts under the wanted id, which must be free, or else under a new one. Returns the id.
std::int64_t insertCase(SqliteDatabase& database, const CaseRecord& record,
                        const std::optional<std::int64_t>& wanted_id = std::nullopt);
void insertTrajectories(SqliteDatabase& database, std::int64_t id,
                        const std::vector<CaseStep>& steps, const std::vector<PoseGaussian>& tube);
void insertOutcome(SqliteDatabase& database, std::int64_t id, const ObservedOutcome& outcome);
void deleteLastOutcome(SqliteDatabase& database, std::int64_t id);
void updateStatistics(SqliteDatabase& database, const Case& push_case);  ///< And the tube.
void updateSteps(SqliteDatabase& database, const Case& push_case);
void replacePrior(SqliteDatabase& database, std::int64_t id, const CasePrior& prior);
void deleteCase(SqliteDatabase& database, std::int64_t id);

}  // namespace casepush
