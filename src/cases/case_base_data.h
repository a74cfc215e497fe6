#pragma once

#include "case_rows.h"
#include "casepush/cases/case_base.h"

namespace casepush {

struct CaseBase::Database {
  SqliteDatabase sqlite;
};

/// @throws InputError if there is no such case.
Case existingCase(SqliteDatabase& database, std::int64_t id);

/// Inserts cases of one file, whose copies name their sources by the ids there.
void insertWithSources(SqliteDatabase& database, const std::vector<CaseRecord>& records);

/// The case as it was after its prior: statistics and tube of then.
Case atPrior(const CaseRecord& record);

/// Adds an observation that was made before, the past counting `weight`.
Case withOutcome(Case push_case, const ObservedOutcome& outcome, double weight);

}  // namespace casepush
