// How CaseBase takes back, copies, prunes and merges.
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "case_base_data.h"
#include "case_blobs.h"
#include "casepush/cases/case_tube.h"
#include "casepush/common/input_error.h"
#include "casepush/common/same_pose.h"

namespace casepush {
namespace {

using Kind = SqliteTransaction::Kind;

// The same push. The stamp may be unknown on one side.
bool isSame(const ObservedOutcome& a, const ObservedOutcome& b) {
  const bool same_time = !a.stamp_s || !b.stamp_s || a.stamp_s == b.stamp_s;
  return same_time && isSame(a.start_T_object, b.start_T_object);
}

// What makes two cases of different bases the same case.
using Identity = std::tuple<std::string, std::string, double, std::string, int, std::string>;

Identity identityOf(const Case& push_case) {
  return {
      push_case.object,        push_case.robot,           push_case.context.load_kg.value_or(-1.0),
      push_case.context.floor, push_case.context.noticed, encodeSteps(push_case.steps)};
}

// Adds to a known case what only the other record holds. Returns the number of observations.
int extend(SqliteDatabase& database, Case& push_case, const CaseRecord& other) {
  const std::vector<ObservedOutcome> known = selectHistory(database, push_case.id);
  int added = 0;
  for (const ObservedOutcome& outcome : other.history) {
    const auto is_it = [&](const ObservedOutcome& o) { return isSame(o, outcome); };
    if (std::any_of(known.begin(), known.end(), is_it)) {
      continue;
    }
    ObservedOutcome again = outcome;
    again.past_weight = outcome.source == OutcomeSource::kAdapted
                            ? std::min(outcome.past_weight, push_case.effective_count)
                            : push_case.effective_count;
    push_case = withOutcome(std::move(push_case), again, again.past_weight);
    insertOutcome(database, push_case.id, again);
    ++added;
  }
  if (added > 0) {
    validateCase(push_case, whereIs(database, push_case.id));
    updateStatistics(database, push_case);
  }
  return added;
}

}  // namespace

void insertWithSources(SqliteDatabase& database, const std::vector<CaseRecord>& records) {
  std::map<std::int64_t, std::int64_t> new_ids;
  for (const CaseRecord& record : records) {
    CaseRecord inserted = record;
    const auto source = new_ids.find(record.push_case.source_id);
    inserted.push_case.source_id = source == new_ids.end() ? 0 : source->second;
    new_ids[record.push_case.id] = insertCase(database, inserted);
  }
}

Case atPrior(const CaseRecord& record) {
  Case push_case = record.push_case;
  const CasePrior& prior = record.prior;
  push_case.start_outcome = prior.start_outcome;
  push_case.effective_count = prior.effective_count;
  push_case.observation_count = prior.observation_count;
  push_case.tube = prior.tube.empty()
                       ? tubeFromOutcome(push_case.steps, prior.start_outcome, prior.noise)
                       : prior.tube;
  return push_case;
}

Case withOutcome(Case push_case, const ObservedOutcome& outcome, double weight) {
  return withObservation(std::move(push_case), outcome.start_T_object, outcome.path, weight,
                         outcome.noise);
}

Case CaseBase::undo(std::int64_t id) {
  SqliteDatabase& sqlite = database_->sqlite;
  SqliteTransaction transaction(sqlite, Kind::kWrite);
  const CaseRecord record = selectRecord(sqlite, existingCase(sqlite, id));
  const auto first = static_cast<std::size_t>(record.prior.after_number);
  if (record.history.size() <= first) {
    throw InputError(whereIs(sqlite, id),
                     "has no observation that can be taken back; remove the case instead");
  }
  Case push_case = atPrior(record);
  for (std::size_t i = first; i + 1 < record.history.size(); ++i) {
    const ObservedOutcome& outcome = record.history[i];
    push_case = withOutcome(std::move(push_case), outcome, outcome.past_weight);
  }
  validateCase(push_case, whereIs(sqlite, id));
  deleteLastOutcome(sqlite, id);
  updateStatistics(sqlite, push_case);
  transaction.commit();
  return push_case;
}

std::int64_t CaseBase::copy(std::int64_t id, const PushContext& context) {
  SqliteDatabase& sqlite = database_->sqlite;
  validateContext(context, whereIs(sqlite, id));
  SqliteTransaction transaction(sqlite, Kind::kWrite);
  CaseRecord record = selectRecord(sqlite, existingCase(sqlite, id));
  record.push_case.source_id = id;
  record.push_case.context = context;
  const std::int64_t copy_id = insertCase(sqlite, record);
  transaction.commit();
  return copy_id;
}

std::vector<UselessCase> CaseBase::prune(const std::string& object, const PruneOptions& options) {
  SqliteDatabase& sqlite = database_->sqlite;
  SqliteTransaction transaction(sqlite, Kind::kWrite);
  const std::vector<UselessCase> useless = uselessCases(selectCases(sqlite, object), options);
  for (const UselessCase& push_case : useless) {
    deleteCase(sqlite, push_case.id);
  }
  transaction.commit();
  return useless;
}

MergeResult CaseBase::merge(const CaseBase& other) {
  SqliteDatabase& sqlite = database_->sqlite;
  SqliteDatabase& source = other.database_->sqlite;
  SqliteTransaction transaction(sqlite, Kind::kWrite);
  std::map<Identity, Case> known;
  for (Case& push_case : selectCases(sqlite, "")) {
    const Identity identity = identityOf(push_case);
    known.emplace(identity, std::move(push_case));
  }
  MergeResult result;
  std::map<std::int64_t, std::int64_t> new_ids;
  SqliteTransaction reading(source, Kind::kRead);
  for (const Case& push_case : selectCases(source, "")) {
    CaseRecord record = selectRecord(source, push_case);
    const auto same = known.find(identityOf(push_case));
    if (same != known.end()) {
      new_ids[push_case.id] = same->second.id;
      const int observations = extend(sqlite, same->second, record);
      result.observations += observations;
      ++(observations > 0 ? result.extended : result.unchanged);
      continue;
    }
    const auto its_source = new_ids.find(push_case.source_id);
    record.push_case.source_id = its_source == new_ids.end() ? 0 : its_source->second;
    new_ids[push_case.id] = insertCase(sqlite, record);
    ++result.added;
  }
  transaction.commit();
  return result;
}

}  // namespace casepush
