#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "casepush/cases/case_base.h"
#include "sqlite.h"

namespace casepush {

/// A case with all that was observed of it.
struct CaseRecord {
  Case push_case;
  std::vector<ObservedOutcome> history;
};

std::optional<CaseOrigin> caseOriginFromString(const std::string& text);
const char* toString(OutcomeSource source);
std::optional<OutcomeSource> outcomeSourceFromString(const std::string& text);

/// Cases ascending by id; of all objects if `object` is empty.
/// @throws InputError naming file and case if a row makes no sense.
std::vector<Case> selectCases(SqliteDatabase& database, const std::string& object);
std::optional<Case> selectCase(SqliteDatabase& database, std::int64_t id);
std::vector<ObservedOutcome> selectHistory(SqliteDatabase& database, std::int64_t id);

/// Inserts under a new id, which is returned.
std::int64_t insertCase(SqliteDatabase& database, const CaseRecord& record);
void insertOutcome(SqliteDatabase& database, std::int64_t id, const ObservedOutcome& outcome);
void updateStatistics(SqliteDatabase& database, const Case& push_case);
void deleteCase(SqliteDatabase& database, std::int64_t id);

}  // namespace casepush
