#include "case_rows.h"

#include "case_blobs.h"
#include "casepush/cases/case_tube.h"
#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr char kSelectCases[] =
    "SELECT id, object, robot, origin, source_id, load_kg, floor, noticed, period_s, push_steps, "
    "effective_count, observation_count, mean_x_m, mean_y_m, mean_yaw_rad, cov_x_x, cov_x_y, "
    "cov_x_yaw, cov_y_y, cov_y_yaw, cov_yaw_yaw, steps, tube "
    "FROM cases LEFT JOIN steps ON steps.case_id = id LEFT JOIN tubes ON tubes.case_id = id ";

template <typename Enum>
Enum orDamaged(const std::optional<Enum>& value, const std::string& where) {
  if (!value) {
    throw InputError(where, "is damaged: unknown word");
  }
  return *value;
}

std::optional<double> optionalReal(const SqliteStatement& row, int column) {
  return row.isNull(column) ? std::nullopt : std::optional<double>(row.real(column));
}

/// Load, floor and number of the noticed change, from three columns.
PushContext readContext(const SqliteStatement& row, int first_column) {
  return {optionalReal(row, first_column), row.text(first_column + 1),
          static_cast<int>(row.integer(first_column + 2))};
}

void bindContext(SqliteStatement& statement, const PushContext& context) {
  statement.bind(context.load_kg).bind(context.floor).bind(std::int64_t{context.noticed});
}

Case readCase(const SqliteDatabase& database, const SqliteStatement& row) {
  Case push_case;
  push_case.id = row.integer(0);
  const std::string where = whereIs(database, push_case.id);
  push_case.object = row.text(1);
  push_case.robot = row.text(2);
  push_case.origin = orDamaged(caseOriginFromString(row.text(3)), where + ": origin");
  push_case.source_id = row.integer(4);
  push_case.context = readContext(row, 5);
  push_case.period_s = row.real(8);
  push_case.push_steps = static_cast<int>(row.integer(9));
  push_case.effective_count = row.real(10);
  push_case.observation_count = static_cast<int>(row.integer(11));
  push_case.start_outcome = readGaussian(row, 12);
  push_case.steps = decodeSteps(row.blob(21), where + ": steps");
  push_case.tube = decodeTube(row.blob(22), where + ": tube");
  validateCase(push_case, where);
  return push_case;
}

void bindGaussian(SqliteStatement& statement, const PoseGaussian& gaussian) {
  const Pose2& mean = gaussian.mean;
  statement.bind(mean.x()).bind(mean.y()).bind(mean.yaw());
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      statement.bind(gaussian.covariance(row, column));
    }
  }
}

}  // namespace

std::string whereIs(const SqliteDatabase& database, std::int64_t id) {
  return database.file() + ": case " + std::to_string(id);
}

PoseGaussian readGaussian(const SqliteStatement& row, int first_column) {
  const auto real = [&](int offset) { return row.real(first_column + offset); };
  PoseGaussian gaussian{Pose2(real(0), real(1), real(2)), {}};
  gaussian.covariance << real(3), real(4), real(5),  //
      real(4), real(6), real(7),                     //
      real(5), real(7), real(8);
  return gaussian;
}

std::optional<CaseOrigin> caseOriginFromString(const std::string& text) {
  for (const CaseOrigin origin :
       {CaseOrigin::kExplored, CaseOrigin::kDemonstrated, CaseOrigin::kTransferred}) {
    if (text == toString(origin)) {
      return origin;
    }
  }
  return std::nullopt;
}

const char* toString(OutcomeSource source) {
  switch (source) {
    case OutcomeSource::kExplored:
      return "explored";
    case OutcomeSource::kDemonstrated:
      return "demonstrated";
    case OutcomeSource::kTransferred:
      return "transferred";
    case OutcomeSource::kPractised:
      return "practised";
    case OutcomeSource::kAdapted:
      break;
  }
  return "adapted";
}

std::optional<OutcomeSource> outcomeSourceFromString(const std::string& text) {
  for (const OutcomeSource source :
       {OutcomeSource::kExplored, OutcomeSource::kDemonstrated, OutcomeSource::kTransferred,
        OutcomeSource::kPractised, OutcomeSource::kAdapted}) {
    if (text == toString(source)) {
      return source;
    }
  }
  return std::nullopt;
}

std::vector<Case> selectCases(SqliteDatabase& database, const std::string& object) {
  SqliteStatement rows(database, std::string(kSelectCases) +
                                     (object.empty() ? "" : "WHERE object = ? ") + "ORDER BY id");
  if (!object.empty()) {
    rows.bind(object);
  }
  std::vector<Case> cases;
  while (rows.step()) {
    cases.push_back(readCase(database, rows));
  }
  return cases;
}

std::optional<Case> selectCase(SqliteDatabase& database, std::int64_t id) {
  SqliteStatement row(database, std::string(kSelectCases) + "WHERE id = ?");
  if (!row.bind(id).step()) {
    return std::nullopt;
  }
  return readCase(database, row);
}

CasePrior selectPrior(SqliteDatabase& database, std::int64_t id) {
  SqliteStatement row(database,
                      "SELECT after_number, effective_count, observation_count, noise_m, "
                      "noise_rad, mean_x_m, mean_y_m, mean_yaw_rad, cov_x_x, cov_x_y, cov_x_yaw, "
                      "cov_y_y, cov_y_yaw, cov_yaw_yaw, tube FROM priors WHERE case_id = ?");
  const std::string where = whereIs(database, id) + ": prior";
  if (!row.bind(id).step()) {
    throw InputError(where, "is damaged: it is missing; restore a copy of the file");
  }
  CasePrior prior;
  prior.after_number = static_cast<int>(row.integer(0));
  prior.effective_count = row.real(1);
  prior.observation_count = static_cast<int>(row.integer(2));
  prior.noise = {row.real(3), row.real(4)};
  prior.start_outcome = readGaussian(row, 5);
  if (!row.isNull(14)) {
    prior.tube = decodeTube(row.blob(14), where);
  }
  return prior;
}

std::vector<ObservedOutcome> selectHistory(SqliteDatabase& database, std::int64_t id) {
  SqliteStatement rows(database,
                       "SELECT source, x_m, y_m, yaw_rad, past_weight, noise_m, noise_rad, "
                       "stamp_s, load_kg, floor, noticed, path FROM outcomes WHERE case_id = ? "
                       "ORDER BY number");
  rows.bind(id);
  const std::string where = whereIs(database, id) + ": history";
  std::vector<ObservedOutcome> history;
  while (rows.step()) {
    ObservedOutcome outcome;
    outcome.source = orDamaged(outcomeSourceFromString(rows.text(0)), where);
    outcome.start_T_object = Pose2(rows.real(1), rows.real(2), rows.real(3));
    outcome.past_weight = rows.real(4);
    outcome.noise = {rows.real(5), rows.real(6)};
    outcome.stamp_s = optionalReal(rows, 7);
    outcome.context = readContext(rows, 8);
    if (!rows.isNull(11)) {
      outcome.path = decodePath(rows.blob(11), where);
    }
    history.push_back(std::move(outcome));
  }
  return history;
}

CaseRecord selectRecord(SqliteDatabase& database, const Case& push_case) {
  return {push_case, selectPrior(database, push_case.id), selectHistory(database, push_case.id)};
}

std::int64_t insertCase(SqliteDatabase& database, const CaseRecord& record,
                        const std::optional<std::int64_t>& wanted_id) {
  const Case& push_case = record.push_case;
  SqliteStatement statement(
      database,
      "INSERT INTO cases (id, object, robot, origin, source_id, load_kg, floor, noticed, period_s, "
      "push_steps, mean_x_m, mean_y_m, mean_yaw_rad, cov_x_x, cov_x_y, cov_x_yaw, cov_y_y, "
      "cov_y_yaw, "
      "cov_yaw_yaw, effective_count, observation_count) "
      "VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  statement.bind(wanted_id)
      .bind(push_case.object)
      .bind(push_case.robot)
      .bind(toString(push_case.origin));
  statement.bind(push_case.source_id);
  bindContext(statement, push_case.context);
  statement.bind(push_case.period_s).bind(std::int64_t{push_case.push_steps});
  bindGaussian(statement, push_case.start_outcome);
  statement.bind(push_case.effective_count).bind(std::int64_t{push_case.observation_count});
  statement.run();
  const std::int64_t id = database.lastInsertId();
  insertTrajectories(database, id, push_case.steps, push_case.tube);
  replacePrior(database, id, record.prior);
  for (const ObservedOutcome& outcome : record.history) {
    insertOutcome(database, id, outcome);
  }
  return id;
}

void insertTrajectories(SqliteDatabase& database, std::int64_t id,
                        const std::vector<CaseStep>& steps, const std::vector<PoseGaussian>& tube) {
  SqliteStatement(database, "INSERT INTO steps VALUES (?, ?)")
      .bind(id)
      .bindBlob(encodeSteps(steps))
      .run();
  SqliteStatement(database, "INSERT INTO tubes VALUES (?, ?)")
      .bind(id)
      .bindBlob(encodeTube(tube))
      .run();
}

void insertOutcome(SqliteDatabase& database, std::int64_t id, const ObservedOutcome& outcome) {
  SqliteStatement statement(
      database,
      "INSERT INTO outcomes (case_id, number, source, x_m, y_m, yaw_rad, past_weight, noise_m, "
      "noise_rad, stamp_s, load_kg, floor, noticed, path) "
      "VALUES (?1, (SELECT ifnull(max(number), 0) + 1 FROM outcomes WHERE case_id = ?1), "
      "?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13)");
  const Pose2& pose = outcome.start_T_object;
  statement.bind(id).bind(toString(outcome.source));
  statement.bind(pose.x()).bind(pose.y()).bind(pose.yaw()).bind(outcome.past_weight);
  statement.bind(outcome.noise.position_m).bind(outcome.noise.yaw_rad).bind(outcome.stamp_s);
  bindContext(statement, outcome.context);
  if (!outcome.path.empty()) {
    statement.bindBlob(encodePath(outcome.path));
  }
  statement.run();
}

void deleteLastOutcome(SqliteDatabase& database, std::int64_t id) {
  SqliteStatement(database,
                  "DELETE FROM outcomes WHERE case_id = ?1 AND number = "
                  "(SELECT max(number) FROM outcomes WHERE case_id = ?1)")
      .bind(id)
      .run();
}

void updateStatistics(SqliteDatabase& database, const Case& push_case) {
  SqliteStatement statement(
      database,
      "UPDATE cases SET mean_x_m = ?, mean_y_m = ?, mean_yaw_rad = ?, cov_x_x = ?, cov_x_y = ?, "
      "cov_x_yaw = ?, cov_y_y = ?, cov_y_yaw = ?, cov_yaw_yaw = ?, effective_count = ?, "
      "observation_count = ? WHERE id = ?");
  bindGaussian(statement, push_case.start_outcome);
  statement.bind(push_case.effective_count).bind(std::int64_t{push_case.observation_count});
  statement.bind(push_case.id).run();
  SqliteStatement(database, "UPDATE tubes SET tube = ? WHERE case_id = ?")
      .bindBlob(encodeTube(push_case.tube))
      .bind(push_case.id)
      .run();
}

void updateSteps(SqliteDatabase& database, const Case& push_case) {
  SqliteStatement(database, "UPDATE cases SET period_s = ?, push_steps = ? WHERE id = ?")
      .bind(push_case.period_s)
      .bind(std::int64_t{push_case.push_steps})
      .bind(push_case.id)
      .run();
  SqliteStatement(database, "UPDATE steps SET steps = ? WHERE case_id = ?")
      .bindBlob(encodeSteps(push_case.steps))
      .bind(push_case.id)
      .run();
}

void replacePrior(SqliteDatabase& database, std::int64_t id, const CasePrior& prior) {
  SqliteStatement statement(
      database,
      "INSERT OR REPLACE INTO priors (case_id, after_number, mean_x_m, mean_y_m, mean_yaw_rad, "
      "cov_x_x, cov_x_y, cov_x_yaw, cov_y_y, cov_y_yaw, cov_yaw_yaw, effective_count, "
      "observation_count, noise_m, noise_rad, tube) VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  statement.bind(id).bind(std::int64_t{prior.after_number});
  bindGaussian(statement, prior.start_outcome);
  statement.bind(prior.effective_count).bind(std::int64_t{prior.observation_count});
  statement.bind(prior.noise.position_m).bind(prior.noise.yaw_rad);
  if (!prior.tube.empty()) {
    statement.bindBlob(encodeTube(prior.tube));
  }
  statement.run();
}

void deleteCase(SqliteDatabase& database, std::int64_t id) {
  SqliteStatement(database, "DELETE FROM cases WHERE id = ?").bind(id).run();
}

}  // namespace casepush
