#include "casepush/cases/case_base.h"

#include <sqlite3.h>

#include <future>
#include <limits>
#include <optional>

#include "case_fixtures.h"
#include "casepush/common/paper_similarity.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;

class CaseBaseTest : public ::testing::Test {
 protected:
  std::string firstText(const char* sql) const {
    sqlite3* raw = nullptr;
    sqlite3_open_v2(file_.c_str(), &raw, SQLITE_OPEN_READONLY, nullptr);
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(raw, sql, -1, &statement, nullptr);
    const std::string text = sqlite3_step(statement) == SQLITE_ROW
                                 ? reinterpret_cast<const char*>(sqlite3_column_text(statement, 0))
                                 : sqlite3_errmsg(raw);
    sqlite3_finalize(statement);
    sqlite3_close(raw);
    return text;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "cases.db";
};

TEST_F(CaseBaseTest, givesBackWhatWasAdded) {
  Case push_case = recordedCase(1);
  push_case.origin = CaseOrigin::kDemonstrated;
  CaseBase base(file_, Access::kCreate);
  const std::int64_t id = base.add(push_case);
  EXPECT_GT(id, 0);
  const Case read = base.get(id);
  EXPECT_EQ(read.id, id);
  expectSameCase(read, push_case);
  ASSERT_EQ(base.history(id).size(), 1u);
  EXPECT_EQ(base.history(id)[0].source, OutcomeSource::kDemonstrated);
  EXPECT_EQ(base.history(id)[0].past_weight, 0.0);
  expectSamePose(base.observations(id)[0], push_case.start_outcome.mean);
}

TEST_F(CaseBaseTest, keepsExtremeNumbersBitForBit) {
  Case push_case = recordedCase(2, 4);
  push_case.steps[0].object_T_robot = {1e-300, -0.0, M_PI};
  push_case.steps[1].action = {std::numeric_limits<double>::denorm_min(), 0.1 + 0.2, -10.0};
  push_case.robot = "";
  const std::int64_t id = CaseBase(file_, Access::kCreate).add(push_case);
  expectSameCase(CaseBase(file_, Access::kReadOnly).get(id), push_case);
}

TEST_F(CaseBaseTest, listsCasesInAscendingIdAndByObject) {
  CaseBase base(file_, Access::kCreate);
  EXPECT_TRUE(base.cases().empty());
  for (int i = 0; i < 6; ++i) {
    base.add(recordedCase(i, 5, i % 2 == 0 ? "chair" : "it's a \"table\""));
  }
  const std::vector<Case> all = base.cases();
  ASSERT_EQ(all.size(), 6u);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LT(all[i - 1].id, all[i].id);
  }
  EXPECT_EQ(base.cases("chair").size(), 3u);
  EXPECT_EQ(base.cases("it's a \"table\"").size(), 3u);
  EXPECT_TRUE(base.cases("stretcher").empty());
}

TEST_F(CaseBaseTest, observesAndAdaptsAsTheStatisticsDo) {
  Random random(3);
  const CovarianceFloor floor;
  CaseBase base(file_, Access::kCreate);
  const Case first = recordedCase(3);
  const std::int64_t id = base.add(first);
  OutcomeStatistics expected{first.start_outcome, first.effective_count};
  for (int i = 0; i < 30; ++i) {
    const Pose2 outcome = first.start_outcome.mean * randomPose(random, 0.05, 0.1);
    const bool is_adaptation = i % 3 == 2;
    const double p_value = 0.03 * i;
    const Case updated = is_adaptation ? base.adapt(id, restingAt(outcome), p_value, {}, floor)
                                       : base.observe(id, restingAt(outcome), floor);
    const double weight =
        is_adaptation ? adaptationWeight(expected, outcome, p_value, {}) : expected.effective_count;
    expected = adapt(expected, outcome, weight, floor);
    expectSamePose(updated.start_outcome.mean, expected.start_outcome.mean);
    EXPECT_EQ(updated.start_outcome.covariance, expected.start_outcome.covariance);
    EXPECT_EQ(updated.effective_count, expected.effective_count);
    EXPECT_EQ(updated.observation_count, i + 2);
    expectSameCase(base.get(id), updated);
  }
}

TEST_F(CaseBaseTest, historyExplainsTheStatistics) {
  Random random(4);
  CaseBase base(file_, Access::kCreate);
  const std::int64_t id = base.add(recordedCase(4));
  base.add(recordedCase(5));
  for (int i = 0; i < 10; ++i) {
    base.observe(id, restingAt(randomPose(random)), {});
  }
  base.adapt(id, restingAt(randomPose(random)), 0.125, {}, {});
  const std::vector<ObservedOutcome> history = base.history(id);
  ASSERT_EQ(history.size(), 12u);
  EXPECT_EQ(history[0].source, OutcomeSource::kExplored);
  EXPECT_EQ(history[5].source, OutcomeSource::kPractised);
  EXPECT_EQ(history[5].past_weight, 5.0);
  EXPECT_EQ(history[11].source, OutcomeSource::kAdapted);
  EXPECT_EQ(history[11].past_weight, 2.5);

  OutcomeStatistics replayed;
  for (const ObservedOutcome& outcome : history) {
    replayed.effective_count = outcome.past_weight;
    replayed = addObservation(replayed, outcome.start_T_object, {});
  }
  const Case stored = base.get(id);
  expectSamePose(replayed.start_outcome.mean, stored.start_outcome.mean);
  EXPECT_LT((replayed.start_outcome.covariance - stored.start_outcome.covariance).norm(), 1e-14);
}

TEST_F(CaseBaseTest, weightOfThePastIsBounded) {
  CaseBase base(file_, Access::kCreate);
  const std::int64_t id = base.add(recordedCase(6));
  EXPECT_EQ(base.adapt(id, restingAt({0.1, 0.0, 0.0}), 0.85, {}, {}).effective_count, 2.0);
  AdaptationOptions paper;
  paper.weight = PastWeight::kPaper;
  EXPECT_NEAR(base.adapt(id, restingAt({5.0, 0.0, 0.0}), 0.85, paper, {}).effective_count,
              1.0 + 20.0 * paperSimilarity({0.05, 0.0, 0.0}, {5.0, 0.0, 0.0}, 21.2), 30.0);
  for (const double p_value : {1.5, -1.0, std::nan("")}) {
    expectRefusal(inputErrorOf([&] { base.adapt(id, {}, p_value, {}, {}); }), file_, "p-value is");
  }
}

TEST_F(CaseBaseTest, removesACaseWithItsObservationsAndNeverReusesItsId) {
  CaseBase base(file_, Access::kCreate);
  const std::int64_t kept = base.add(recordedCase(7));
  const std::int64_t removed = base.add(recordedCase(8));
  base.observe(removed, {}, {});
  base.remove(removed);
  EXPECT_EQ(base.cases().size(), 1u);
  EXPECT_GT(base.add(recordedCase(9)), removed);
  EXPECT_EQ(base.observations(kept).size(), 1u);
  EXPECT_EQ(firstText("SELECT count(*) FROM outcomes"), "2");
}

TEST_F(CaseBaseTest, isAWriteAheadLoggedFileThatKnowsWhatItIs) {
  CaseBase base(file_, Access::kCreate);
  EXPECT_EQ(firstText("PRAGMA journal_mode"), "wal");
  EXPECT_EQ(firstText("PRAGMA user_version"), "3");
  EXPECT_EQ(firstText("PRAGMA application_id"), std::to_string(0x43507368));
}

TEST_F(CaseBaseTest, unknownCaseIsNamed) {
  CaseBase base(file_, Access::kCreate);
  const std::string reason = "case 42: does not exist";
  expectRefusal(inputErrorOf([&] { base.get(42); }), file_, reason);
  expectRefusal(inputErrorOf([&] { base.observe(42, {}, {}); }), file_, reason);
  expectRefusal(inputErrorOf([&] { base.adapt(42, {}, 1.0, {}, {}); }), file_, reason);
  expectRefusal(inputErrorOf([&] { base.remove(42); }), file_, reason);
  expectRefusal(inputErrorOf([&] { base.observations(42); }), file_, reason);
}

TEST_F(CaseBaseTest, badValuesAreRefusedAndNothingIsStored) {
  CaseBase base(file_, Access::kCreate);
  Case broken = recordedCase(10);
  broken.steps[3].action.vx_mps = std::nan("");
  expectRefusal(inputErrorOf([&] { base.add(broken); }), file_, "new case: steps[3]");
  expectRefusal(inputErrorOf([&] { base.add(recordedCase(10, 5, "two\nlines")); }), file_,
                "new case: object: holds a control character");
  EXPECT_TRUE(base.cases().empty());

  const std::int64_t id = base.add(recordedCase(11));
  const Case before = base.get(id);
  expectRefusal(inputErrorOf([&] {
                  base.observe(id, restingAt({0.0, std::nan(""), 0.0}), {});
                }),
                file_, "case 1: observed outcome is not finite");
  expectRefusal(inputErrorOf([&] {
                  base.observe(id, restingAt({150.0, 0.0, 0.0}), {});
                }),
                file_, "case 1: observed outcome is too far away; x and y must be within 100 m");
  EXPECT_NE(inputErrorOf([&] { base.observe(id, {}, {-1.0, 1.0}); }), "");
  expectSameCase(base.get(id), before);
  EXPECT_EQ(base.observations(id).size(), 1u);
  base.observe(id, {}, {});
}

TEST_F(CaseBaseTest, casesWithoutOwnObservationsStartTheirHistoryLater) {
  Case transferred = recordedCase(12);
  transferred.origin = CaseOrigin::kTransferred;
  transferred.observation_count = 0;
  transferred.effective_count = 3.0;
  CaseBase base(file_, Access::kCreate);
  const std::int64_t id = base.add(transferred);
  EXPECT_TRUE(base.observations(id).empty());
  EXPECT_EQ(base.observe(id, {}, {}).effective_count, 4.0);
  EXPECT_EQ(base.observations(id).size(), 1u);

  Case practised = recordedCase(13);
  practised.observation_count = 20;
  practised.effective_count = 20.0;
  practised.start_outcome.mean = {9.0, 9.0, 0.0};
  expectSamePose(base.observations(base.add(practised))[0], practised.steps.back().start_T_object);
}

TEST_F(CaseBaseTest, readersSeeWhatTheWriterCommitted) {
  CaseBase writer(file_, Access::kCreate);
  CaseBase reader(file_, Access::kReadOnly);
  CaseBase other_reader(file_, Access::kReadOnly);
  const std::int64_t id = writer.add(recordedCase(14));
  EXPECT_EQ(reader.cases().size(), 1u);
  writer.observe(id, {}, {});
  EXPECT_EQ(other_reader.observations(id).size(), 2u);
  expectRefusal(inputErrorOf([&] { reader.add(recordedCase(15)); }), file_, "cannot be written");
}

TEST_F(CaseBaseTest, writersWaitForEachOther) {
  constexpr int kEach = 50;
  CaseBase base(file_, Access::kCreate);
  const std::int64_t id = base.add(recordedCase(16));
  const auto observe = [&] {
    CaseBase own(file_, Access::kReadWrite);
    for (int i = 0; i < kEach; ++i) {
      own.observe(id, {}, {});
    }
  };
  std::future<void> first = std::async(std::launch::async, observe);
  std::future<void> second = std::async(std::launch::async, observe);
  for (int i = 0; i < kEach; ++i) {
    EXPECT_EQ(base.cases().size(), 1u);
  }
  first.get();
  second.get();
  EXPECT_EQ(base.get(id).observation_count, 1 + 2 * kEach);
  EXPECT_EQ(base.observations(id).size(), 1u + 2 * kEach);
}

TEST_F(CaseBaseTest, canBeMoved) {
  std::optional<CaseBase> base;
  base = CaseBase(file_, Access::kCreate);
  CaseBase other = std::move(*base);
  EXPECT_EQ(other.add(recordedCase(17)), 1);
}

TEST_F(CaseBaseTest, theSameCallsGiveTheSameContent) {
  std::string dumps[2];
  for (std::string& dump : dumps) {
    const std::filesystem::path file = folder_ / (&dump == dumps ? "a.db" : "b.db");
    CaseBase base(file, Access::kCreate);
    const std::int64_t id = base.add(recordedCase(18));
    base.observe(id, restingAt({0.1, 0.2, 0.3}), {});
    base.exportYaml(folder_ / "dump.yaml");
    dump = readFile(folder_ / "dump.yaml");
  }
  EXPECT_EQ(dumps[0], dumps[1]);
  EXPECT_FALSE(dumps[0].empty());
}

}  // namespace
}  // namespace casepush
