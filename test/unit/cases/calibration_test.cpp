#include "casepush/cases/calibration.h"

#include "case_fixtures.h"

namespace casepush {
namespace {

TEST(LeaveOneOut, predictsEachFromAllOthers) {
  Random random(1);
  std::vector<Pose2> outcomes;
  for (int i = 0; i < 12; ++i) {
    outcomes.push_back(randomPose(random));
  }
  const std::vector<LeftOutTest> tests = leaveOneOut(outcomes, {}, 0.01);
  ASSERT_EQ(tests.size(), 12u);
  OutcomeStatistics others;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (i != 4) {
      others = addObservation(others, outcomes[i], {});
    }
  }
  EXPECT_EQ(tests[4].hotelling.p_value, testPrediction(others, outcomes[4], 0.01).p_value);
  EXPECT_EQ(tests[4].plug_in.p_value, testPlugIn(others, outcomes[4], 0.01).p_value);
  EXPECT_TRUE(leaveOneOut({}, {}, 0.01).empty());
  EXPECT_EQ(leaveOneOut({Pose2()}, {}, 0.01)[0].hotelling.p_value, 1.0);
}

TEST(LeaveOneOut, isCalibratedForNormalScatterUnlikeThePlugIn) {
  Random random(2);
  constexpr int kCases = 300;
  constexpr int kObservations = 10;
  int hotelling = 0;
  int plug_in = 0;
  for (int i = 0; i < kCases; ++i) {
    std::vector<Pose2> outcomes;
    for (int k = 0; k < kObservations; ++k) {
      outcomes.push_back(Pose2(0.5, 0.1, 3.1) * randomPose(random, 0.05, 0.1));
    }
    for (const LeftOutTest& test : leaveOneOut(outcomes, {1e-6, 1e-6}, 0.05)) {
      hotelling += test.hotelling.rejected ? 1 : 0;
      plug_in += test.plug_in.rejected ? 1 : 0;
    }
  }
  const double total = kCases * kObservations;
  EXPECT_NEAR(hotelling / total, 0.05, 0.015);
  EXPECT_GT(plug_in / total, 0.2);
}

}  // namespace
}  // namespace casepush
