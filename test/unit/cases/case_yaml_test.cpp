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
    const std::size_t before = base.cases().size();
    expectRefusal(inputErrorOf([&] { base.importYaml(file_); }), file_, reason);
    EXPECT_EQ(base.cases().size(), before);
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
    for (int k = 0; k < 3 * i; ++k) {
      base.observe(id, randomPose(random), {});
    }
    base.adapt(id, randomPose(random), 1.0, {});
  }
  base.exportYaml(file_);
  CaseBase copy(folder_ / "b.db", Access::kCreate);
  EXPECT_EQ(copy.importYaml(file_), 8);

  const std::vector<Case> cases = base.cases();
  const std::vector<Case> copies = copy.cases();
  ASSERT_EQ(copies.size(), cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    expectSameCase(copies[i], cases[i]);
    const std::vector<ObservedOutcome> a = base.history(cases[i].id);
    const std::vector<ObservedOutcome> b = copy.history(copies[i].id);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      expectSamePose(a[k].start_T_object, b[k].start_T_object);
      EXPECT_EQ(a[k].source, b[k].source);
      EXPECT_EQ(a[k].past_weight, b[k].past_weight);
    }
  }
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
  expectImportRefused(altered("mean: [0.5", "mean: [.nan"), "cases[0].outcome.mean: is not");
  expectImportRefused(altered("action: [0.375", "action: [.inf"),
                      "cases[0].steps[1].action: is not");
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
}

TEST_F(CaseYaml, hugeValuesAreNamed) {
  const std::string text = good();
  const auto first_of = [&text](const std::string& section, const std::string& key) {
    const std::size_t at = text.find(key + ": [", text.find(section));
    return text.substr(at, text.find(']', at) + 1 - at);
  };
  const std::string steps = "    steps:";
  const std::string pose = first_of(steps, "start_T_object");
  std::string far = text;
  far.replace(text.find(pose, text.find(steps)), pose.size(), "start_T_object: [1e7, 0, 0]");
  expectImportRefused(far, "steps[0].start_T_object: is at (1e+07, 0); x and y must be within 100");
  far = text;
  const std::string past = first_of("    history:", "start_T_object");
  far.replace(text.find(past), past.size(), "start_T_object: [0, 1e7, 0]");
  expectImportRefused(far, "cases[0].history[0].start_T_object: is too far away");
  expectImportRefused(altered("mean: [0.5", "mean: [1e300"), "mean: is at (1e+300, 0.25)");
  expectImportRefused(altered("action: [0.375", "action: [1e300"), "steps[1].action: is (1e+300");
  expectImportRefused(altered("period_s: 0.1", "period_s: 1e300"), "period_s: is 1e+300");
  expectImportRefused(altered("effective_count: 1", "effective_count: 1e10"),
                      "effective_count: is");
  expectImportRefused(altered("covariance: [0.25", "covariance: [1e300"), "covariance: has a");
}

TEST_F(CaseYaml, missingAndUnknownKeysAreNamed) {
  expectImportRefused(altered("    period_s: 0.1\n", ""), "cases[0].period_s: is missing");
  expectImportRefused(altered("origin: explored", "origin: explored\n    mood: good"),
                      "cases[0]: unknown key(s): mood");
  expectImportRefused(altered("casepush_cases: 1", "casepush_cases: 2"), "newer than this program");
  expectImportRefused(altered("casepush_cases: 1\n", ""), "casepush_cases: is missing");
  expectImportRefused("casepush_cases: 1\n", "cases: is missing");
  expectImportRefused("casepush_cases: 1\ncases: 7\n", "cases: must be a list");
  const std::string text = good();
  const std::size_t steps = text.find("    steps:");
  const std::size_t next = text.find("  - id: 2");
  expectImportRefused(text.substr(0, steps) + "    steps: []\n" + text.substr(next),
                      "cases[0]: steps: is empty");
}

TEST_F(CaseYaml, aBadLastCaseKeepsTheFirstOut) {
  std::string text = good();
  const std::size_t at = text.rfind("mean: [0.5");
  text.replace(at, 10, "mean: [.nan");
  expectImportRefused(text, "cases[1].outcome.mean: is not");
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
