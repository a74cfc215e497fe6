#include "case_schema.h"

#include "case_blobs.h"
#include "case_rows.h"
#include "casepush/cases/case_tube.h"
#include "casepush/common/input_error.h"

namespace casepush {
namespace {

// Ids are never reused (AUTOINCREMENT): a late report about a removed case must not hit another.
// outcomes.past_weight: how many observations the past counted when this one was added.
constexpr char kVersion1[] = R"sql(
CREATE TABLE cases (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  object TEXT NOT NULL,
  robot TEXT NOT NULL,
  origin TEXT NOT NULL,
  period_s REAL NOT NULL,
  push_steps INTEGER NOT NULL,
  mean_x_m REAL NOT NULL,
  mean_y_m REAL NOT NULL,
  mean_yaw_rad REAL NOT NULL,
  cov_x_x REAL NOT NULL,
  cov_x_y REAL NOT NULL,
  cov_x_yaw REAL NOT NULL,
  cov_y_y REAL NOT NULL,
  cov_y_yaw REAL NOT NULL,
  cov_yaw_yaw REAL NOT NULL,
  effective_count REAL NOT NULL,
  observation_count INTEGER NOT NULL,
  steps BLOB NOT NULL
);
CREATE INDEX cases_by_object ON cases(object);
CREATE TABLE outcomes (
  case_id INTEGER NOT NULL REFERENCES cases(id) ON DELETE CASCADE,
  number INTEGER NOT NULL,
  source TEXT NOT NULL,
  x_m REAL NOT NULL,
  y_m REAL NOT NULL,
  yaw_rad REAL NOT NULL,
  past_weight REAL NOT NULL,
  PRIMARY KEY (case_id, number)
) WITHOUT ROWID;
)sql";

// Trajectories get tables of their own, so that an update of the statistics does not rewrite them.
// priors: what the statistics were after outcome `after_number`, from which later ones can be
// added again; without a tube, it follows from steps and outcome.
// noise_m, noise_rad: the covariance floor of the update; path: the object's trajectory.
constexpr char kVersion2[] = R"sql(
ALTER TABLE cases ADD COLUMN source_id INTEGER NOT NULL DEFAULT 0;
ALTER TABLE cases ADD COLUMN load_kg REAL;
ALTER TABLE cases ADD COLUMN floor TEXT NOT NULL DEFAULT '';
CREATE TABLE steps (
  case_id INTEGER PRIMARY KEY REFERENCES cases(id) ON DELETE CASCADE,
  steps BLOB NOT NULL
);
CREATE TABLE tubes (
  case_id INTEGER PRIMARY KEY REFERENCES cases(id) ON DELETE CASCADE,
  tube BLOB NOT NULL
);
CREATE TABLE priors (
  case_id INTEGER PRIMARY KEY REFERENCES cases(id) ON DELETE CASCADE,
  after_number INTEGER NOT NULL,
  mean_x_m REAL NOT NULL,
  mean_y_m REAL NOT NULL,
  mean_yaw_rad REAL NOT NULL,
  cov_x_x REAL NOT NULL,
  cov_x_y REAL NOT NULL,
  cov_x_yaw REAL NOT NULL,
  cov_y_y REAL NOT NULL,
  cov_y_yaw REAL NOT NULL,
  cov_yaw_yaw REAL NOT NULL,
  effective_count REAL NOT NULL,
  observation_count INTEGER NOT NULL,
  noise_m REAL NOT NULL,
  noise_rad REAL NOT NULL,
  tube BLOB
);
ALTER TABLE outcomes RENAME TO old_outcomes;
CREATE TABLE outcomes (
  case_id INTEGER NOT NULL REFERENCES cases(id) ON DELETE CASCADE,
  number INTEGER NOT NULL,
  source TEXT NOT NULL,
  x_m REAL NOT NULL,
  y_m REAL NOT NULL,
  yaw_rad REAL NOT NULL,
  past_weight REAL NOT NULL,
  noise_m REAL NOT NULL,
  noise_rad REAL NOT NULL,
  stamp_s REAL,
  load_kg REAL,
  floor TEXT NOT NULL DEFAULT '',
  path BLOB
);
CREATE UNIQUE INDEX outcomes_by_case ON outcomes(case_id, number);
INSERT INTO outcomes (case_id, number, source, x_m, y_m, yaw_rad, past_weight, noise_m, noise_rad)
  SELECT case_id, number, source, x_m, y_m, yaw_rad, past_weight, 0.005, 0.01 FROM old_outcomes
  ORDER BY case_id, number;
DROP TABLE old_outcomes;
)sql";

// What was observed in version 1 has no floor on record, so that it cannot be added again exactly:
// the present state becomes the prior.
constexpr char kPriorsOfVersion1[] = R"sql(
INSERT INTO priors SELECT id, (SELECT ifnull(max(number), 0) FROM outcomes WHERE case_id = id),
  mean_x_m, mean_y_m, mean_yaw_rad, cov_x_x, cov_x_y, cov_x_yaw, cov_y_y, cov_y_yaw, cov_yaw_yaw,
  effective_count, observation_count, 0.005, 0.01, NULL FROM cases;
ALTER TABLE cases DROP COLUMN steps;
)sql";

// Which of the changes that pushes gave away an observation belongs to.
constexpr char kVersion3[] = R"sql(
ALTER TABLE cases ADD COLUMN noticed INTEGER NOT NULL DEFAULT 0;
ALTER TABLE outcomes ADD COLUMN noticed INTEGER NOT NULL DEFAULT 0;
)sql";

void moveTrajectories(SqliteDatabase& database) {
  SqliteStatement rows(database,
                       "SELECT id, steps, mean_x_m, mean_y_m, mean_yaw_rad, cov_x_x, cov_x_y, "
                       "cov_x_yaw, cov_y_y, cov_y_yaw, cov_yaw_yaw FROM cases");
  while (rows.step()) {
    const std::int64_t id = rows.integer(0);
    const std::string where = database.file() + ": case " + std::to_string(id) + ": steps";
    const std::vector<CaseStep> steps = decodeUncheckedSteps(rows.blob(1), where);
    if (steps.empty()) {
      throw InputError(where, "is empty; restore a copy of the file");
    }
    const PoseGaussian outcome = readGaussian(rows, 2);
    if (!outcome.mean.isFinite() || !isCovariance(outcome.covariance)) {
      throw InputError(where, "go with an outcome that is damaged; restore a copy of the file");
    }
    insertTrajectories(database, id, steps, tubeFromOutcome(steps, outcome, {}));
  }
}

void toVersion2(SqliteDatabase& database) {
  database.execute(kVersion2);
  moveTrajectories(database);
  database.execute(kPriorsOfVersion1);
}

}  // namespace

std::int64_t schemaVersion(SqliteDatabase& database) {
  return database.integer("PRAGMA user_version");
}

void migrate(SqliteDatabase& database) {
  SqliteTransaction transaction(database, SqliteTransaction::Kind::kWrite);
  const std::int64_t version = schemaVersion(database);
  if (version < 1) {
    database.execute(kVersion1);
    database.execute("PRAGMA application_id = " + std::to_string(kCaseFileId));
  }
  if (version < 2) {
    toVersion2(database);
  }
  if (version < 3) {
    database.execute(kVersion3);
  }
  database.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  transaction.commit();
}

}  // namespace casepush
