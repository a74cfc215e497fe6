#include "casepush/cases/adapting_cases.h"

#include "case_fixtures.h"

namespace casepush {
namespace {

/// Cases of a chair that each push it 0.5 m one of several ways, known by 20 practices.
std::vector<Case> knownCases() {
  std::vector<Case> cases;
  for (int i = 0; i < 4; ++i) {
    Case push_case = recordedCase(static_cast<std::uint64_t>(i + 1));
    push_case.id = 10 + i;
    push_case.start_outcome = {Pose2(0.5 * std::cos(i), 0.5 * std::sin(i), 0.1 * i),
                               Eigen::Vector3d(4e-4, 4e-4, 1e-3).asDiagonal()};
    push_case.effective_count = 20.0;
    push_case.observation_count = 20;
    cases.push_back(push_case);
  }
  return cases;
}

class AdaptingCasesTest : public ::testing::Test {
 protected:
  /// Of a push of case `number` (0 to 3) of the present ones that ends at `share` of the way it
  /// used to.
  PushReport reportOf(int number, double share) {
    const Case predicted = present(number);
    const Case original = known_[number];
    const Pose2& mean = original.start_outcome.mean;
    PushReport report;
    report.object_id = "chair_1";
    report.case_id = predicted.id;
    report.outcome = PushOutcome::kDone;
    report.map_T_end = Pose2(share * mean.x(), share * mean.y(), share * mean.yaw()) *
                       randomPose(random_, 0.02, 0.03);
    report.recorded = predicted;
    report.recorded.start_outcome.mean = report.map_T_end;
    report.recorded.steps.back().start_T_object = report.map_T_end;
    report.test = testPrediction({predicted.start_outcome, predicted.effective_count},
                                 observedPush(report).start_T_object, 0.01);
    return report;
  }
  std::string push(int number, double share) {
    return adapting_.learnFrom(reportOf(number, share));
  }
  /// Makes case 0 one that was proposed after another object and never pushed.
  void proposeFirstCase() {
    known_[0].origin = CaseOrigin::kTransferred;
    known_[0].observation_count = 0;
    known_[0].effective_count = 0.5;
    known_[0].start_outcome.covariance = Eigen::Vector3d(1e-2, 1e-2, 4e-2).asDiagonal();
    base_ = CaseBase(known_, {});
  }
  /// The case that is pushed instead of one of those known, in the present circumstances.
  Case present(int number) {
    const std::map<std::int64_t, std::int64_t> family_of = families(base_.cases());
    for (const Case& push_case : adapting_.cases()) {
      if (family_of.at(push_case.id) == known_[number].id) return push_case;
    }
    ADD_FAILURE() << "no case for " << known_[number].id;
    return known_[number];
  }
  /// Pushes one case after the other until a change is noticed.
  std::string pushUntilNoticed(double share, int most) {
    std::string text;
    for (int i = 0; i < most && text.empty(); ++i) text = push(i % 4, share);
    return text;
  }
  void expectOriginals() {
    for (const Case& original : known_) {
      const Case now = base_.get(original.id);
      expectSamePose(now.start_outcome.mean, original.start_outcome.mean);
      EXPECT_EQ(now.effective_count, original.effective_count);
    }
  }

  std::vector<Case> known_ = knownCases();
  CaseBase base_{known_, {}};
  AdaptingCases adapting_{&base_, {}};
  Random random_{3};
};

TEST_F(AdaptingCasesTest, adaptsTheCasesThemselvesWhileNothingChanges) {
  for (int i = 0; i < 40; ++i) EXPECT_EQ(push(i % 4, 1.0), "");
  EXPECT_EQ(base_.count(), 4);
  EXPECT_EQ(base_.get(10).observation_count, 30);
}

TEST_F(AdaptingCasesTest, learnsCopiesAfterAChangeAndKeepsTheOriginals) {
  const std::string text = pushUntilNoticed(0.5, 4);
  EXPECT_NE(text.find("noticed change 1"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(adapting_.context("chair").noticed, 1);
  expectOriginals();
  for (int i = 0; i < 20; ++i) push(i % 4, 0.5);
  expectOriginals();
  EXPECT_EQ(base_.count(), 8);
  for (const Case& push_case : adapting_.cases("chair")) {
    EXPECT_EQ(push_case.context.noticed, 1);
    const Pose2& before = base_.get(push_case.source_id).start_outcome.mean;
    EXPECT_NEAR(push_case.start_outcome.mean.position().norm(), 0.5 * before.position().norm(),
                0.04);
  }
}

TEST_F(AdaptingCasesTest, recognisesCircumstancesMetBefore) {
  pushUntilNoticed(0.5, 4);
  for (int i = 0; i < 12; ++i) push(i % 4, 0.5);
  EXPECT_NE(pushUntilNoticed(1.0, 12), "");
  EXPECT_EQ(adapting_.context("chair").noticed, 0);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(push(i % 4, 1.0), "");
  EXPECT_NE(pushUntilNoticed(0.5, 12), "");
  EXPECT_EQ(adapting_.context("chair").noticed, 1);
  EXPECT_EQ(base_.count(), 8);
}

/// A load that changes nothing for some pushes must not be doubted for that.
TEST_F(AdaptingCasesTest, keepsToWhatWasToldAsLongAsItIsNoWorse) {
  PushContext told;
  told.load_kg = 15.0;
  adapting_.tell("chair", told);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(push(i % 4, 1.0), "");
  EXPECT_EQ(adapting_.context("chair"), told);
}

TEST_F(AdaptingCasesTest, doesNotTakeWhatFitsNowhereForTheNearestThatIsKnown) {
  PushContext told;
  told.load_kg = 15.0;
  adapting_.tell("chair", told);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(push(i % 2, 0.7), "");
  for (int i = 0; i < 3; ++i) {
    push(i % 2, 1.6);  // Farther than ever, and so nearer to what was known without a load.
    EXPECT_FALSE(adapting_.context("chair") == PushContext());
    expectOriginals();
  }
}

/// Somebody may have taken the load off, but the cases of an unknown load are not those of none.
TEST_F(AdaptingCasesTest, believesTheLoadThatWasTold) {
  PushContext told;
  told.load_kg = 15.0;
  adapting_.tell("chair", told);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(push(i % 4, 0.6), "");
  EXPECT_NE(pushUntilNoticed(1.0, 8), "");
  EXPECT_EQ(adapting_.context("chair").load_kg, 15.0);
  EXPECT_EQ(adapting_.context("chair").noticed, 1);
  for (int i = 0; i < 8; ++i) push(i % 4, 1.0);
  expectOriginals();
}

TEST_F(AdaptingCasesTest, numbersFurtherChanges) {
  pushUntilNoticed(0.5, 4);
  for (int i = 0; i < 60; ++i) push(i % 4, 0.5);
  EXPECT_NE(pushUntilNoticed(0.1, 12), "");
  EXPECT_EQ(adapting_.context("chair").noticed, 2);
}

TEST_F(AdaptingCasesTest, forgetsWhatWasNoticedWhenTold) {
  pushUntilNoticed(0.5, 4);
  PushContext told;
  told.load_kg = 15.0;
  adapting_.tell("chair", told);
  EXPECT_EQ(adapting_.context("chair"), told);
  push(0, 0.5);
  EXPECT_EQ(adapting_.cases().size(), 4u);
  EXPECT_EQ(base_.cases().back().context, told);
}

/// What a transferred case says before its first push is a guess.
TEST_F(AdaptingCasesTest, noticesNothingByTheFirstPushOfATransferredCase) {
  proposeFirstCase();
  PushReport report = reportOf(0, 0.3);
  report.test.p_value = 1e-6;
  EXPECT_EQ(adapting_.learnFrom(report), "");
  EXPECT_EQ(base_.get(10).observation_count, 1);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(push(1 + i % 3, 1.0), "");
}

/// Its first push made a transferred case what it is, which can not be taken back.
TEST_F(AdaptingCasesTest, noticesAChangeDuringWhichATransferredCaseWasPushedFirst) {
  proposeFirstCase();
  AdaptingOptions options;
  options.change.alarm = 1000.0;  // So that it takes two pushes at least.
  adapting_ = AdaptingCases(&base_, {}, options);
  EXPECT_EQ(push(1, 0.5), "");
  EXPECT_EQ(push(0, 0.5), "");
  std::string text;
  for (int i = 0; i < 3 && text.empty(); ++i) text = push(2, 0.5);
  EXPECT_NE(text.find("noticed change 1"), std::string::npos) << text;
  EXPECT_EQ(base_.get(10).observation_count, 1);
  EXPECT_EQ(base_.get(11).observation_count, 20);
  EXPECT_EQ(base_.get(12).observation_count, 20);
  EXPECT_EQ(base_.count(), 6);  // Copies of the two that could be taken back.
  EXPECT_EQ(push(0, 0.5), "");
  EXPECT_EQ(base_.count(), 7);
}

TEST_F(AdaptingCasesTest, noticesAChangeAlthoughACasePushedSinceWasRemoved) {
  AdaptingOptions options;
  options.change.alarm = 1000.0;
  adapting_ = AdaptingCases(&base_, {}, options);
  EXPECT_EQ(push(0, 0.5), "");
  base_.remove(10);
  std::string text;
  for (int i = 0; i < 3 && text.empty(); ++i) text = push(1, 0.5);
  EXPECT_NE(text.find("noticed change 1"), std::string::npos) << text;
  EXPECT_EQ(base_.get(11).observation_count, 20);
}

TEST_F(AdaptingCasesTest, doesNotCountPushesThatCouldNotBeStored) {
  pushUntilNoticed(0.5, 4);
  for (int i = 0; i < 12; ++i) push(i % 4, 0.5);
  for (int i = 0; i < 20; ++i) {
    PushReport report = reportOf(i % 4, 1.0);
    report.test.p_value = 2.0;
    EXPECT_NE(inputErrorOf([&] { adapting_.learnFrom(report); }), "");
  }
  EXPECT_EQ(adapting_.context("chair").noticed, 1);
  EXPECT_EQ(push(0, 0.5), "");
  EXPECT_NE(pushUntilNoticed(1.0, 12), "");
  EXPECT_EQ(adapting_.context("chair").noticed, 0);
}

/// A copy that could not learn, because the disk was full, is no more than a guess.
TEST_F(AdaptingCasesTest, asksNoCopyThatNeverLearnt) {
  PushContext told;
  told.load_kg = 15.0;
  adapting_.tell("chair", told);
  PushReport report = reportOf(0, 0.5);
  report.test.p_value = 2.0;
  EXPECT_NE(inputErrorOf([&] { adapting_.learnFrom(report); }), "");
  ASSERT_EQ(base_.count(), 5);
  report = reportOf(0, 0.5);
  report.test.p_value = 1e-6;
  EXPECT_EQ(adapting_.learnFrom(report), "");
  EXPECT_EQ(adapting_.context("chair"), told);
}

TEST_F(AdaptingCasesTest, noticesNothingUnlessWanted) {
  AdaptingOptions options;
  options.notice = false;
  adapting_ = AdaptingCases(&base_, {}, options);
  EXPECT_EQ(pushUntilNoticed(0.5, 12), "");
  EXPECT_EQ(base_.count(), 4);
}

}  // namespace
}  // namespace casepush
