#include "case_rows.h"

#include <array>
#include <cstring>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

// Column `steps`: for each step nine IEEE 754 doubles, little-endian: x, y, yaw of object_T_robot,
// vx, vy, wz of the action, x, y, yaw of start_T_object [m, rad, m/s, rad/s].
constexpr std::size_t kNumbersPerStep = 9;
constexpr std::size_t kBytesPerStep = kNumbersPerStep * sizeof(double);
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "stored doubles are little-endian");

constexpr char kSelectCases[] =
    "SELECT id, object, robot, origin, period_s, push_steps, mean_x_m, mean_y_m, mean_yaw_rad, "
    "cov_x_x, cov_x_y, cov_x_yaw, cov_y_y, cov_y_yaw, cov_yaw_yaw, effective_count, "
    "observation_count, steps FROM cases ";

std::string encodeSteps(const std::vector<CaseStep>& steps) {
  std::string bytes(steps.size() * kBytesPerStep, '\0');
  char* out = bytes.data();
  for (const CaseStep& step : steps) {
    const Pose2& r = step.object_T_robot;
    const Twist2& a = step.action;
    const Pose2& o = step.start_T_object;
    const std::array<double, kNumbersPerStep> numbers{r.x(),    r.y(), r.yaw(), a.vx_mps, a.vy_mps,
                                                      a.wz_rps, o.x(), o.y(),   o.yaw()};
    std::memcpy(out, numbers.data(), kBytesPerStep);
    out += kBytesPerStep;
  }
  return bytes;
}

std::vector<CaseStep> decodeSteps(const std::string& bytes, const std::string& where) {
  if (bytes.size() % kBytesPerStep != 0) {
    throw InputError(where + ": steps", "is damaged: " + std::to_string(bytes.size()) +
                                            " bytes are not a whole number of steps");
  }
  std::vector<CaseStep> steps;
  steps.reserve(bytes.size() / kBytesPerStep);
  for (std::size_t at = 0; at < bytes.size(); at += kBytesPerStep) {
    std::array<double, kNumbersPerStep> n;
    std::memcpy(n.data(), bytes.data() + at, kBytesPerStep);
    steps.push_back({Pose2(n[0], n[1], n[2]), Twist2{n[3], n[4], n[5]}, Pose2(n[6], n[7], n[8])});
  }
  return steps;
}

template <typename Enum>
Enum orDamaged(const std::optional<Enum>& value, const std::string& where) {
  if (!value) {
    throw InputError(where, "is damaged: unknown word");
  }
  return *value;
}

std::string whereIs(const SqliteDatabase& database, std::int64_t id) {
  return database.file() + ": case " + std::to_string(id);
}

Case readCase(const SqliteDatabase& database, const SqliteStatement& row) {
  Case push_case;
  push_case.id = row.integer(0);
  const std::string where = whereIs(database, push_case.id);
  push_case.object = row.text(1);
  push_case.robot = row.text(2);
  push_case.origin = orDamaged(caseOriginFromString(row.text(3)), where + ": origin");
  push_case.period_s = row.real(4);
  push_case.push_steps = static_cast<int>(row.integer(5));
  push_case.start_outcome.mean = Pose2(row.real(6), row.real(7), row.real(8));
  push_case.start_outcome.covariance << row.real(9), row.real(10), row.real(11),  //
      row.real(10), row.real(12), row.real(13),                                   //
      row.real(11), row.real(13), row.real(14);
  push_case.effective_count = row.real(15);
  push_case.observation_count = static_cast<int>(row.integer(16));
  push_case.steps = decodeSteps(row.blob(17), where);
  validateCase(push_case, where);
  return push_case;
}

// Mean, upper triangle of the covariance, counts.
void bindStatistics(SqliteStatement& statement, const Case& push_case) {
  const Pose2& mean = push_case.start_outcome.mean;
  statement.bind(mean.x()).bind(mean.y()).bind(mean.yaw());
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      statement.bind(push_case.start_outcome.covariance(row, column));
    }
  }
  statement.bind(push_case.effective_count).bind(std::int64_t{push_case.observation_count});
}

}  // namespace

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

std::vector<ObservedOutcome> selectHistory(SqliteDatabase& database, std::int64_t id) {
  SqliteStatement rows(database,
                       "SELECT source, x_m, y_m, yaw_rad, past_weight FROM outcomes "
                       "WHERE case_id = ? ORDER BY number");
  rows.bind(id);
  std::vector<ObservedOutcome> history;
  while (rows.step()) {
    const auto source = orDamaged(outcomeSourceFromString(rows.text(0)), whereIs(database, id));
    history.push_back({Pose2(rows.real(1), rows.real(2), rows.real(3)), source, rows.real(4)});
  }
  return history;
}

std::int64_t insertCase(SqliteDatabase& database, const CaseRecord& record) {
  const Case& push_case = record.push_case;
  SqliteStatement statement(
      database,
      "INSERT INTO cases (object, robot, origin, period_s, push_steps, steps, mean_x_m, mean_y_m, "
      "mean_yaw_rad, cov_x_x, cov_x_y, cov_x_yaw, cov_y_y, cov_y_yaw, cov_yaw_yaw, "
      "effective_count, observation_count) VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  statement.bind(push_case.object).bind(push_case.robot).bind(toString(push_case.origin));
  statement.bind(push_case.period_s).bind(std::int64_t{push_case.push_steps});
  statement.bindBlob(encodeSteps(push_case.steps));
  bindStatistics(statement, push_case);
  statement.run();
  const std::int64_t id = database.lastInsertId();
  for (const ObservedOutcome& outcome : record.history) {
    insertOutcome(database, id, outcome);
  }
  return id;
}

void insertOutcome(SqliteDatabase& database, std::int64_t id, const ObservedOutcome& outcome) {
  SqliteStatement statement(
      database,
      "INSERT INTO outcomes (case_id, number, source, x_m, y_m, yaw_rad, past_weight) "
      "VALUES (?1, (SELECT ifnull(max(number), 0) + 1 FROM outcomes WHERE case_id = ?1), "
      "?2, ?3, ?4, ?5, ?6)");
  const Pose2& pose = outcome.start_T_object;
  statement.bind(id).bind(toString(outcome.source));
  statement.bind(pose.x()).bind(pose.y()).bind(pose.yaw()).bind(outcome.past_weight).run();
}

void updateStatistics(SqliteDatabase& database, const Case& push_case) {
  SqliteStatement statement(
      database,
      "UPDATE cases SET mean_x_m = ?, mean_y_m = ?, mean_yaw_rad = ?, cov_x_x = ?, cov_x_y = ?, "
      "cov_x_yaw = ?, cov_y_y = ?, cov_y_yaw = ?, cov_yaw_yaw = ?, effective_count = ?, "
      "observation_count = ? WHERE id = ?");
  bindStatistics(statement, push_case);
  statement.bind(push_case.id).run();
}

void deleteCase(SqliteDatabase& database, std::int64_t id) {
  SqliteStatement(database, "DELETE FROM cases WHERE id = ?").bind(id).run();
}

}  // namespace casepush
