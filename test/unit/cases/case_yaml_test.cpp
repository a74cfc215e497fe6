#include <algorithm>
#include <limits>

#include "case_fixtures.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;
namespace fs = std::filesystem;

class CaseYaml : public ::testing::Test {
 protected:
  // Text of a good file with `from` (which must occur) replaced by `to`.
  std::string altered(const std::string& from, const std::string& to) {
    std::string text = good();
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from << " not in\n" << text;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  }

  // Two cases; the second one is the bad one when `from` is looked for behind it.
  std::string good() {
    if (good_.empty()) {
      CaseBase base(folder_ / "good.db", Access::kCreate);
      for (int i = 0; i < 2; ++i) {
        Case push_case = recordedCase(i, 3);
        push_case.start_outcome = {{0.5, 0.25, 0.125}, 0.25 * Eigen::Matrix3d::Identity()};
        push_case.steps[1].action = {0.375, 0.0, 0.0};
        base.add(push_case);
      }
      base.exportYaml(file_);
      good_ = readFile(file_);
    }
    return good_;
  }

  void expectImportRefused(const std::string& text, const std::string& reason) {
    writeFile(file_, text);
    CaseBase base(folder_ / "base.db", Access::kCreate);
    const int before = base.count();
    expectRefusal(inputErrorOf([&] { base.importYaml(file_); }), file_, reason);
    EXPECT_EQ(base.count(), before);
  }

  // The good file with number `column` in line `line` of the first table `table` replaced.
  std::string alteredTable(const std::string& table, int line, int column, const std::string& to) {
    std::string text = good();
    std::size_t at = text.find("    " + table + ": |\n");
    for (int i = 0; i <= line; ++i) {
      at = text.find('\n', at) + 1;
    }
    at = text.find_first_not_of(' ', at);
    for (int i = 0; i < column; ++i) {
      at = text.find(' ', at) + 1;
    }
    return text.replace(at, text.find_first_of(" \n", at) - at, to);
  }

  TemporaryFolder folder_;
  fs::path file_ = folder_ / "cases.yaml";
  std::string good_;
};

TEST_F(CaseYaml, roundTripIsExact) {
  Random random(1);
  CaseBase base(folder_ / "a.db", Access::kCreate);
  for (int i = 0; i < 8; ++i) {
    Case push_case =
        recordedCase(100 + i, 1 + 7 * i, i % 2 == 0 ? "chair" : "say: \"#1\" {t\\able}");
    push_case.origin = static_cast<CaseOrigin>(i % 3);
    push_case.robot = i == 3 ? "" : "cobot";
    push_case.steps[0].action.vx_mps = std::pow(10.0, random.uniform(-320.0, 1.0));
    const std::int64_t id = base.add(push_case);
    for (int k = 0; k < 2 * i; ++k) {
      base.observe(id, restingAt(randomPose(random)), {});
      base.observe(id, practice(push_case, random), {0.002, 0.003});
    }
    base.adapt(id, practice(push_case, random), 0.05, {}, {});
    if (i % 3 == 0) {
      base.copy(id, {12.5 * i, i == 0 ? "" : "\"vinyl\""});
    }
  }
  base.exportYaml(file_);
  CaseBase copy(folder_ / "b.db", Access::kCreate);
  EXPECT_EQ(copy.importYaml(file_), 11);

  const std::vector<Case> cases = base.cases();
  const std::vector<Case> copies = copy.cases();
  ASSERT_EQ(copies.size(), cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    expectSameCase(copies[i], cases[i]);
    EXPECT_EQ(copies[i].source_id, cases[i].source_id);
    expectSameTube(copies[i], cases[i]);
    expectSameHistory(copy.history(copies[i].id), base.history(cases[i].id));
    // What takes observations back goes along, too.
    EXPECT_EQ(copy.undo(copies[i].id).start_outcome.covariance,
              base.undo(cases[i].id).start_outcome.covariance);
  }
  base.exportYaml(file_);
  copy.exportYaml(folder_ / "again.yaml");
  EXPECT_EQ(readFile(folder_ / "again.yaml"), readFile(file_));
}

TEST_F(CaseYaml, importAddsUnderNewIds) {
  good();
  CaseBase base(folder_ / "base.db", Access::kCreate);
  base.add(recordedCase(5));
  EXPECT_EQ(base.importYaml(file_), 2);
  EXPECT_EQ(base.importYaml(file_), 2);
  ASSERT_EQ(base.cases().size(), 5u);
  EXPECT_EQ(base.cases().back().id, 5);
  expectSameCase(base.get(1), recordedCase(5));
}

TEST_F(CaseYaml, emptyBaseRoundTrips) {
  CaseBase base(folder_ / "base.db", Access::kCreate);
  base.exportYaml(file_);
  EXPECT_EQ(base.importYaml(file_), 0);
}

TEST_F(CaseYaml, badValuesAreNamed) {
  expectImportRefused(altered("mean: [0.5", "mean: [.nan"),
                      "cases[0].outcome.mean: is not a number");
  expectImportRefused(altered("covariance: [0.25", "covariance: [-0.25"),
                      "cases[0].outcome.covariance: has a negative eigenvalue");
  expectImportRefused(altered("covariance: [0.25, ", "covariance: ["),
                      "cases[0].outcome.covariance: must be a list of 6 finite numbers");
  expectImportRefused(altered("period_s: 0.1", "period_s: 0"), "cases[0]: period_s");
  expectImportRefused(altered("push_steps: 2", "push_steps: 4"), "cases[0]: push_steps: is 4");
  expectImportRefused(altered("origin: explored", "origin: dreamt"),
                      "cases[0].origin: is 'dreamt'; must be one of explored");
  expectImportRefused(altered("source: explored", "source: heard"), "cases[0].history[0].source");
  expectImportRefused(altered("object: \"chair\"", "object: \"\""), "cases[0].object");
  expectImportRefused(altered("noise: [0.005", "noise: [0"), "cases[0].prior.noise: must be two");
  expectImportRefused(altered("after: 1", "after: 2"), "cases[0].prior.after: is 2; must be");
  expectImportRefused(altered("    period_s", "    load_kg: -3\n    period_s"), "cases[0].load_kg");
}

TEST_F(CaseYaml, badTrajectoriesAreNamed) {
  expectImportRefused(alteredTable("steps", 1, 3, "inf"),
                      "cases[0].steps: line 2 holds a number that is not finite");
  expectImportRefused(alteredTable("steps", 2, 0, "nan"), "cases[0].steps: line 3 holds a number");
  expectImportRefused(alteredTable("steps", 0, 8, "north"),
                      "cases[0].steps: line 1 holds something else than numbers");
  expectImportRefused(alteredTable("steps", 0, 8, "1 2"),
                      "cases[0].steps: line 1 holds 10 numbers; must be 9 finite numbers");
  expectImportRefused(alteredTable("tube", 1, 3, "-1"), "cases[0]: tube[1].covariance: must be");
  expectImportRefused(alteredTable("tube", 1, 1, "1e5"), "cases[0]: tube[1].mean: is at");
  CaseBase base(folder_ / "practised.db", Access::kCreate);
  Random random(1);
  const Case push_case = recordedCase(1, 3);
  base.observe(base.add(push_case), practice(push_case, random), {});
  base.exportYaml(file_);
  std::string text = readFile(file_);
  const std::size_t path = text.find("path: |");
  ASSERT_NE(path, std::string::npos);
  const std::size_t number = text.find_first_not_of(' ', text.find('\n', path) + 1);
  expectImportRefused(text.replace(number, text.find(' ', number) - number, "1e9"),
                      "cases[0].history[1].path line 1: is at (1e+09, ");
}

TEST_F(CaseYaml, hugeValuesAreNamed) {
  expectImportRefused(alteredTable("steps", 0, 6, "1e7"),
                      "steps[0].start_T_object: is at (1e+07, ");
  expectImportRefused(alteredTable("steps", 1, 3, "1e300"), "steps[1].action: is (1e+300");
  const std::string text = good();
  const std::size_t history = text.find("start_T_object: [", text.find("    history:"));
  std::string far = text;
  far.replace(history, text.find(']', history) + 1 - history, "start_T_object: [0, 1e7, 0]");
  expectImportRefused(far, "cases[0].history[0].start_T_object: is too far away");
  expectImportRefused(altered("mean: [0.5", "mean: [1e300"), "mean: is at (1e+300, 0.25)");
  expectImportRefused(altered("period_s: 0.1", "period_s: 1e300"), "period_s: is 1e+300");
  expectImportRefused(altered("effective_count: 1", "effective_count: 1e10"),
                      "effective_count: is");
  expectImportRefused(altered("covariance: [0.25", "covariance: [1e300"), "covariance: has a");
}

// Wherever a file ends too early, at the end of a line or within one, it is refused.
TEST_F(CaseYaml, truncatedFilesAreRefused) {
  const std::string text = good();
  const std::size_t whole = text.find("case_count: 2") + 13;
  CaseBase base(folder_ / "base.db", Access::kCreate);
  for (std::size_t size = 0; size < whole; size += size + 40 < whole ? 29 : 1) {
    writeFile(file_, text.substr(0, size));
    expectRefusal(inputErrorOf([&] { base.importYaml(file_); }), file_, "");
  }
  for (std::size_t line = text.find('\n'); line < whole; line = text.find('\n', line + 1)) {
    writeFile(file_, text.substr(0, line + 1));
    expectRefusal(inputErrorOf([&] { base.importYaml(file_); }), file_, "");
  }
  EXPECT_EQ(base.count(), 0);
  writeFile(file_, text.substr(0, whole));
  EXPECT_EQ(base.importYaml(file_), 2);
}

TEST_F(CaseYaml, lostLinesAreNamed) {
  const std::string text = good();
  const std::size_t steps = text.find('\n', text.find("    steps: |")) + 1;
  expectImportRefused(
      text.substr(0, steps) + text.substr(text.find('\n', steps) + 1),
      "cases[0].step_count: is 3, but the file holds 2 steps; is the file complete?");
  const std::size_t tube = text.find('\n', text.find("    tube: |")) + 1;
  expectImportRefused(text.substr(0, tube) + text.substr(text.find('\n', tube) + 1),
                      "cases[0].tube: holds 2 lines; must hold one for each step");
  const std::size_t second = text.find("  - id: 2");
  expectImportRefused(text.substr(0, second) + text.substr(text.rfind("case_count")),
                      "case_count: is 2, but the file holds 1 cases");
}

// Format 1, which older exports have.
TEST_F(CaseYaml, olderFilesAreReadUnlessTheyAreCutShort) {
  const std::string text =
      "casepush_cases: 1\ncases:\n  - id: 7\n    object: \"chair\"\n    robot: \"cobot\"\n"
      "    origin: explored\n    period_s: 0.1\n    push_steps: 1\n    outcome:\n"
      "      mean: [0.5, 0.25, 0.125]\n      covariance: [0.01, 0, 0, 0.01, 0, 0.01]\n"
      "    effective_count: 2\n    observation_count: 2\n    history:\n"
      "      - {source: explored, start_T_object: [0.4, 0.2, 0.1], past_weight: 0}\n"
      "      - {source: practised, start_T_object: [0.6, 0.3, 0.15], past_weight: 1}\n    steps:\n"
      "      - {object_T_robot: [-1, 0, 0], action: [0.3, 0, 0], start_T_object: [0, 0, 0]}\n";
  const std::string last =
      "      - {object_T_robot: [-1, 0, 0], action: [0, 0, 0], start_T_object: [0.4, 0.2, 0.1]}\n";
  expectImportRefused(text, "cases[0]: steps: end elsewhere than the first observation");
  writeFile(file_, text + last);
  CaseBase base(folder_ / "base.db", Access::kCreate);
  EXPECT_EQ(base.importYaml(file_), 1);
  const Case read = base.get(1);
  ASSERT_EQ(read.tube.size(), 2u);
  expectSamePose(read.tube[1].mean, {0.5, 0.25, 0.125});
  EXPECT_EQ(base.history(1)[1].past_weight, 1.0);
  EXPECT_NE(inputErrorOf([&] { base.undo(1); }), "") << "the floor of its updates is unknown";
}

TEST_F(CaseYaml, missingAndUnknownKeysAreNamed) {
  expectImportRefused(altered("    period_s: 0.1\n", ""), "cases[0].period_s: is missing");
  expectImportRefused(altered("origin: explored", "origin: explored\n    mood: good"),
                      "cases[0]: unknown key(s): mood");
  expectImportRefused(altered("casepush_cases: 2", "casepush_cases: 3"), "newer than this program");
  expectImportRefused(altered("casepush_cases: 2\n", ""), "casepush_cases: is missing");
  expectImportRefused("casepush_cases: 1\n", "cases: is missing");
  expectImportRefused("casepush_cases: 1\ncases: 7\n", "cases: must be a list");
  std::string text = altered("step_count: 3", "step_count: 0");
  const std::size_t steps = text.find("    steps: |");
  const std::size_t tube = text.find("    tube: |");
  expectImportRefused(text.substr(0, steps) + "    steps: |\n" + text.substr(tube),
                      "cases[0].steps: must be a non-empty block of lines");
}

TEST_F(CaseYaml, aBadLastCaseKeepsTheFirstOut) {
  std::string text = good();
  const std::size_t at = text.rfind("mean: [0.5");
  text.replace(at, 10, "mean: [.nan");
  expectImportRefused(text, "cases[1].prior.mean: is not a number");
}

TEST_F(CaseYaml, unreadableFilesAreNamed) {
  expectImportRefused("cases: [", "is not valid YAML");
  expectImportRefused("", "must hold a YAML map");
  CaseBase base(folder_ / "base.db", Access::kCreate);
  const fs::path missing = folder_ / "missing.yaml";
  expectRefusal(inputErrorOf([&] { base.importYaml(missing); }), missing, "cannot be read");
}

TEST_F(CaseYaml, exportFailsCleanly) {
  CaseBase base(folder_ / "base.db", Access::kCreate);
  base.add(recordedCase(1));
  fs::create_directory(folder_ / "folder");
  expectRefusal(inputErrorOf([&] { base.exportYaml(folder_ / "folder"); }), folder_ / "folder",
                "cannot be written");
  expectRefusal(inputErrorOf([&] { base.exportYaml(folder_ / "no" / "x.yaml"); }),
                folder_ / "no" / "x.yaml", "cannot be written: No such file");
  expectRefusal(inputErrorOf([&] { base.exportYaml(folder_ / "base.db"); }), folder_ / "base.db",
                "is the case base itself");
  EXPECT_EQ(base.cases().size(), 1u);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos);
  }
}

}  // namespace
}  // namespace casepush
