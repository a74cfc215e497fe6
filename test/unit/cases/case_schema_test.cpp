// Files of older versions, written by the SQL of those versions.
#include <sqlite3.h>

#include "case_fixtures.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;
namespace fs = std::filesystem;

constexpr char kVersion1[] = R"sql(
PRAGMA journal_mode = WAL;
CREATE TABLE cases (id INTEGER PRIMARY KEY AUTOINCREMENT, object TEXT NOT NULL,
  robot TEXT NOT NULL, origin TEXT NOT NULL, period_s REAL NOT NULL, push_steps INTEGER NOT NULL,
  mean_x_m REAL NOT NULL, mean_y_m REAL NOT NULL, mean_yaw_rad REAL NOT NULL,
  cov_x_x REAL NOT NULL, cov_x_y REAL NOT NULL, cov_x_yaw REAL NOT NULL, cov_y_y REAL NOT NULL,
  cov_y_yaw REAL NOT NULL, cov_yaw_yaw REAL NOT NULL, effective_count REAL NOT NULL,
  observation_count INTEGER NOT NULL, steps BLOB NOT NULL);
CREATE INDEX cases_by_object ON cases(object);
CREATE TABLE outcomes (case_id INTEGER NOT NULL REFERENCES cases(id) ON DELETE CASCADE,
  number INTEGER NOT NULL, source TEXT NOT NULL, x_m REAL NOT NULL, y_m REAL NOT NULL,
  yaw_rad REAL NOT NULL, past_weight REAL NOT NULL, PRIMARY KEY (case_id, number)) WITHOUT ROWID;
PRAGMA application_id = 1129345896;
PRAGMA user_version = 1;
)sql";

class CaseSchema : public ::testing::Test {
 protected:
  void run(const std::string& sql) {
    sqlite3* raw = nullptr;
    ASSERT_EQ(sqlite3_open(file_.c_str(), &raw), SQLITE_OK);
    char* error = nullptr;
    EXPECT_EQ(sqlite3_exec(raw, sql.c_str(), nullptr, nullptr, &error), SQLITE_OK) << error;
    sqlite3_close(raw);
  }

  // Two cases as version 1 wrote them, the second one practised; `known_` is what they hold.
  void writeVersion1() {
    run(kVersion1);
    for (int i = 0; i < 2; ++i) {
      Case push_case = recordedCase(i, 20);
      push_case.steps[4].object_T_robot = {1.0 / 3.0, 1e-300, M_PI};
      push_case.start_outcome.mean = {0.1 + 0.2, 0.25, -3.0};
      push_case.start_outcome.covariance << 0.04, 0.01, 0.0, 0.01, 0.09, 0.0, 0.0, 0.0, 0.01;
      push_case.effective_count = push_case.observation_count = 1 + i;
      known_.push_back(push_case);
      insert(push_case);
    }
    run("INSERT INTO outcomes VALUES (1, 1, 'explored', 0.5, 0.25, 1, 0),"
        "(2, 1, 'explored', 0.4, 0.2, 1, 0), (2, 2, 'adapted', 0.6, 0.3, 2, 1);");
  }

  void insert(const Case& push_case) {
    std::vector<double> numbers;
    for (const CaseStep& step : push_case.steps) {
      const Pose2& r = step.object_T_robot;
      const Twist2& a = step.action;
      const Pose2& o = step.start_T_object;
      numbers.insert(numbers.end(),
                     {r.x(), r.y(), r.yaw(), a.vx_mps, a.vy_mps, a.wz_rps, o.x(), o.y(), o.yaw()});
    }
    sqlite3* raw = nullptr;
    sqlite3_open(file_.c_str(), &raw);
    sqlite3_stmt* statement = nullptr;
    const std::string n = std::to_string(push_case.observation_count);
    const std::string sql =
        "INSERT INTO cases (object, robot, origin, period_s, push_steps, mean_x_m, mean_y_m, "
        "mean_yaw_rad, cov_x_x, cov_x_y, cov_x_yaw, cov_y_y, cov_y_yaw, cov_yaw_yaw, "
        "effective_count, observation_count, steps) VALUES ('chair', 'cobot', 'explored', 0.1, 11, "
        "?, 0.25, -3.0, 0.04, 0.01, 0, 0.09, 0, 0.01, " +
        n + ", " + n + ", ?)";
    sqlite3_prepare_v2(raw, sql.c_str(), -1, &statement, nullptr);
    sqlite3_bind_double(statement, 1, 0.1 + 0.2);
    sqlite3_bind_blob(statement, 2, numbers.data(),
                      static_cast<int>(numbers.size() * sizeof(double)), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(statement), SQLITE_DONE);
    sqlite3_finalize(statement);
    sqlite3_close(raw);
  }

  void expectKnown(const CaseBase& base) {
    const std::vector<Case> cases = base.cases();
    ASSERT_EQ(cases.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      expectSameCase(cases[i], known_[i]);
      ASSERT_EQ(cases[i].tube.size(), 20u);
      expectSamePose(cases[i].tube.back().mean, known_[i].start_outcome.mean);
    }
    const std::vector<ObservedOutcome> history = base.history(2);
    ASSERT_EQ(history.size(), 2u);
    EXPECT_EQ(history[1].source, OutcomeSource::kAdapted);
    EXPECT_EQ(history[1].past_weight, 1.0);
    EXPECT_FALSE(history[1].stamp_s.has_value());
    expectSamePose(history[1].start_T_object, {0.6, 0.3, 2.0});
  }

  TemporaryFolder folder_;
  fs::path file_ = folder_ / "old.db";
  std::vector<Case> known_;
};

TEST_F(CaseSchema, writersBringAFileOfVersion1UpToDate) {
  writeVersion1();
  for (const Access access : {Access::kReadWrite, Access::kCreate, Access::kReadOnly}) {
    expectKnown(CaseBase(file_, access));
  }
  CaseBase base(file_, Access::kReadWrite);
  base.observe(2, restingAt({0.5, 0.25, 1.5}), {});
  EXPECT_EQ(base.undo(2).observation_count, 2);
  expectKnown(base);
  expectRefusal(inputErrorOf([&] { base.undo(2); }), file_, "no observation that can be taken");
  EXPECT_EQ(base.add(recordedCase(9)), 3);
}

TEST_F(CaseSchema, readersSeeAFileOfVersion1AndLeaveItAsItIs) {
  writeVersion1();
  const std::string before = readFile(file_);
  {
    CaseBase base(file_, Access::kReadOnly);
    expectKnown(base);
    base.exportYaml(folder_ / "cases.yaml");
    EXPECT_NE(inputErrorOf([&] { base.remove(1); }), "");
  }
  EXPECT_EQ(readFile(file_), before);
  CaseBase imported(folder_ / "new.db", Access::kCreate);
  imported.importYaml(folder_ / "cases.yaml");
  expectKnown(imported);
}

TEST_F(CaseSchema, anEmptyFileOfVersion1IsBroughtUpToDate) {
  run(kVersion1);
  CaseBase base(file_, Access::kReadWrite);
  EXPECT_EQ(base.add(recordedCase(1)), 1);
}

TEST_F(CaseSchema, damagedFilesOfVersion1AreRefusedAndLeftAsTheyAre) {
  writeVersion1();
  run("UPDATE cases SET steps = x'0011' WHERE id = 2;");
  const std::string before = readFile(file_);
  for (const Access access : {Access::kReadOnly, Access::kReadWrite}) {
    expectRefusal(inputErrorOf([&] { CaseBase(file_, access); }), file_,
                  "case 2: steps: is damaged");
    EXPECT_EQ(readFile(file_), before);
  }
  run("UPDATE cases SET steps = zeroblob(0) WHERE id = 2;");
  expectRefusal(inputErrorOf([&] { CaseBase(file_, Access::kReadWrite); }), file_,
                "case 2: steps: is empty");
}

TEST_F(CaseSchema, flippedBitsInTrajectoriesAreNoticed) {
  {
    CaseBase base(file_, Access::kCreate);
    base.add(recordedCase(1, 20));
    Random random(1);
    base.observe(1, practice(recordedCase(1, 20), random), {});
  }
  const auto flip = [&](const std::string& table, const std::string& column) {
    run("CREATE TABLE saved AS SELECT * FROM " + table + ";");
    run("UPDATE " + table + " SET " + column + " = CAST(substr(" + column +
        ", 1, 40) || x'41' || "
        "substr(" +
        column + ", 42) AS BLOB);");
  };
  const auto restore = [&](const std::string& table) {
    run("DELETE FROM " + table + "; INSERT INTO " + table +
        " SELECT * FROM saved; "
        "DROP TABLE saved;");
  };
  const auto refusal = [&] {
    return inputErrorOf([&] {
      const CaseBase base(file_, Access::kReadOnly);
      base.get(1);
      base.history(1);
    });
  };
  for (const auto& [table, column, name] :
       {std::make_tuple("steps", "steps", "case 1: steps: is damaged"),
        std::make_tuple("tubes", "tube", "case 1: tube: is damaged"),
        std::make_tuple("outcomes", "path", "case 1: history: is damaged")}) {
    flip(table, column);
    expectRefusal(refusal(), file_, name);
    restore(table);
    EXPECT_EQ(refusal(), "");
  }
}

}  // namespace
}  // namespace casepush
