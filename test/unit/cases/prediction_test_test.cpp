#include <Eigen/Core>

#include "case_fixtures.h"
#include "casepush/cases/outcome_statistics.h"

namespace casepush {
namespace {

constexpr double kAlpha = 0.05;

struct Rates {
  double hotelling = 0.0;
  double plug_in = 0.0;
};

// False alarms over cases learnt from n perfectly normal outcomes and tested with one more.
Rates falseAlarmRates(int n, int runs, double sigma_m, double sigma_rad,
                      const CovarianceFloor& floor, std::uint64_t seed) {
  Random random(seed);
  const auto outcome = [&] {
    return Pose2(0.6, 0.1, 0.3) * randomPose(random, sigma_m, sigma_rad);
  };
  int hotelling = 0;
  int plug_in = 0;
  for (int run = 0; run < runs; ++run) {
    OutcomeStatistics statistics;
    for (int i = 0; i < n; ++i) {
      statistics = addObservation(statistics, outcome(), floor);
    }
    const Pose2 next = outcome();
    hotelling += testPrediction(statistics, next, kAlpha).rejected ? 1 : 0;
    plug_in += testPlugIn(statistics, next, kAlpha).rejected ? 1 : 0;
  }
  return {static_cast<double>(hotelling) / runs, static_cast<double>(plug_in) / runs};
}

struct Expectation {
  int n;
  double plug_in;
};

class FalseAlarms : public ::testing::TestWithParam<Expectation> {};

TEST_P(FalseAlarms, hotellingKeepsAlphaAndPlugInDoesNot) {
  constexpr int kRuns = 20000;
  // Small scatter makes SE(2) flat, which is what the F distribution assumes.
  const Rates rates =
      falseAlarmRates(GetParam().n, kRuns, 0.02, 0.02, {1e-7, 1e-7}, 100 + GetParam().n);
  const double error = std::sqrt(kAlpha * (1.0 - kAlpha) / kRuns);
  EXPECT_NEAR(rates.hotelling, kAlpha, 3.5 * error);
  EXPECT_NEAR(rates.plug_in, GetParam().plug_in, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Counts, FalseAlarms,
                         ::testing::Values(Expectation{5, 0.57}, Expectation{10, 0.26},
                                           Expectation{15, 0.18}, Expectation{20, 0.14}));

TEST(TestPrediction, theFloorOnlyMakesItMoreCautious) {
  const CovarianceFloor floor;
  for (const int n : {5, 10, 20}) {
    const Rates near_floor =
        falseAlarmRates(n, 4000, 2.0 * floor.position_m, 2.0 * floor.yaw_rad, floor, 7);
    EXPECT_LT(near_floor.hotelling, kAlpha + 0.01) << n;
  }
  const Rates realistic =
      falseAlarmRates(20, 10000, 10.0 * floor.position_m, 10.0 * floor.yaw_rad, floor, 8);
  EXPECT_NEAR(realistic.hotelling, kAlpha, 0.008);
}

class WhileAdapting : public ::testing::Test {
 protected:
  Pose2 outcome() { return Pose2(0.6, 0.1, 0.3) * randomPose(random_, 0.05, 0.1); }

  OutcomeStatistics practised() {
    OutcomeStatistics statistics;
    for (int i = 0; i < 20; ++i) {
      statistics = addObservation(statistics, outcome(), {});
    }
    return statistics;
  }

  // Tests a push, then adapts by it. Returns whether it was rejected.
  static bool push(OutcomeStatistics& statistics, const Pose2& x, PastWeight weight) {
    AdaptationOptions options;
    options.weight = weight;
    const PredictionTest test = testPrediction(statistics, x, kAlpha);
    statistics = adapt(statistics, x, adaptationWeight(statistics, x, test.p_value, options), {});
    return test.rejected;
  }

  double falseAlarmRate(PastWeight weight) {
    constexpr int kCases = 200;
    constexpr int kPushes = 100;
    int rejected = 0;
    for (int i = 0; i < kCases; ++i) {
      OutcomeStatistics statistics = practised();
      for (int k = 0; k < kPushes; ++k) {
        rejected += push(statistics, outcome(), weight) ? 1 : 0;
      }
    }
    return static_cast<double>(rejected) / kCases / kPushes;
  }

  double rejectionsAfterAChange(PastWeight weight) {
    constexpr int kCases = 200;
    constexpr int kMost = 50;
    int rejected = 0;
    for (int i = 0; i < kCases; ++i) {
      OutcomeStatistics statistics = practised();
      for (int k = 0; k < kMost && push(statistics, outcome() * Pose2(0.3, 0.2, 0.4), weight);
           ++k) {
        ++rejected;
      }
    }
    return static_cast<double>(rejected) / kCases;
  }

  Random random_{11};
};

// Counts between 1 and 20 make the test cautious. With the paper's literal weight the count runs
// away, and what is tested is the plug-in.
TEST_F(WhileAdapting, keepsAlphaWithTheBoundedWeightOnly) {
  const double bounded = falseAlarmRate(PastWeight::kBounded);
  const double paper = falseAlarmRate(PastWeight::kPaper);
  RecordProperty("bounded", std::to_string(bounded));
  RecordProperty("paper", std::to_string(paper));
  EXPECT_LT(bounded, kAlpha);
  EXPECT_GT(paper, 2.0 * kAlpha);
}

// Paper, section 6.3: "after 2 iterations on average".
TEST_F(WhileAdapting, explainsNewDynamicsSoonWithTheBoundedWeightOnly) {
  const double bounded = rejectionsAfterAChange(PastWeight::kBounded);
  const double paper = rejectionsAfterAChange(PastWeight::kPaper);
  RecordProperty("bounded", std::to_string(bounded));
  RecordProperty("paper", std::to_string(paper));
  EXPECT_LT(bounded, 2.0);
  EXPECT_GT(paper, 20.0);
}

TEST(TestPrediction, fallbackRaisesAtMostAlphaFalseAlarms) {
  for (const int n : {1, 2, 3, 4}) {
    EXPECT_LT(falseAlarmRates(n, 4000, 0.05, 0.1, {}, 9).hotelling, kAlpha) << n;
    EXPECT_LT(falseAlarmRates(n, 4000, 0.15, 0.3, {}, 10).hotelling, kAlpha + 0.01) << n;
  }
}

TEST(TestPrediction, fallbackStillRejectsTheAbsurd) {
  const OutcomeStatistics once = addObservation({}, {0.5, 0.0, 0.0}, {});
  EXPECT_FALSE(testPrediction(once, {0.55, 0.05, 0.1}, 0.01).rejected);
  EXPECT_TRUE(testPrediction(once, {2.0, 0.0, 0.0}, 0.01).rejected);
  EXPECT_TRUE(testPrediction(once, {0.5, 0.0, 2.5}, 0.01).rejected);
}

TEST(TestPrediction, matchesTheClosedForm) {
  // S = diag(0.01, 0.04, 0.09) unbiased, n = 10; e = (0.1, 0.2, 0.3) gives e' S^-1 e = 3.
  OutcomeStatistics past;
  past.effective_count = 10.0;
  past.start_outcome.covariance =
      0.9 * Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal().toDenseMatrix();
  const Pose2 x = expSe2({0.1, 0.2, 0.3});
  const PredictionTest test = testPrediction(past, x, 0.01);
  EXPECT_NEAR(test.t_squared, 30.0 / 11.0, 1e-12);
  // 1 - F(70/99; 3, 7), by numerical integration of the density.
  EXPECT_NEAR(test.p_value, 0.5775, 2e-4);
  // chi-square with 3 degrees of freedom at d^2 = 3 / 0.9.
  const PredictionTest plug_in = testPlugIn(past, x, 0.01);
  EXPECT_NEAR(plug_in.t_squared, 3.0 / 0.9, 1e-12);
  const double d2 = 3.0 / 0.9;
  const double tail =
      std::erfc(std::sqrt(d2 / 2.0)) + std::sqrt(2.0 * d2 / M_PI) * std::exp(-d2 / 2.0);
  EXPECT_NEAR(plug_in.p_value, tail, 1e-12);
}

TEST(TestPrediction, isOneAtTheMeanAndZeroFarAway) {
  OutcomeStatistics past;
  past.effective_count = 20.0;
  past.start_outcome.mean = {0.5, 0.1, 3.1};
  past.start_outcome.covariance = 0.01 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(testPrediction(past, past.start_outcome.mean, 0.01).p_value, 1.0, 1e-12);
  const PredictionTest far = testPrediction(past, {9.0, 9.0, 0.0}, 0.01);
  EXPECT_LT(far.p_value, 1e-9);
  EXPECT_TRUE(far.rejected);
  // 0.08 rad away across +/-pi, not 6.2.
  EXPECT_FALSE(testPrediction(past, {0.5, 0.1, -3.1}, 0.01).rejected);
}

TEST(TestPrediction, copesWithFractionalCountsAndSingularCovariances) {
  OutcomeStatistics past;
  for (const double n : {1.0, 1.5, 4.0, 4.001, 4.5, 20.7}) {
    past.effective_count = n;
    const PredictionTest test = testPrediction(past, {0.3, 0.1, 0.1}, 0.01);
    EXPECT_TRUE(std::isfinite(test.t_squared)) << n;
    EXPECT_GE(test.p_value, 0.0) << n;
    EXPECT_LE(test.p_value, 1.0) << n;
  }
  EXPECT_TRUE(std::isfinite(testPlugIn(past, {0.3, 0.1, 0.1}, 0.01).t_squared));
}

TEST(TestPrediction, hasNoOpinionWithoutObservations) {
  EXPECT_EQ(testPrediction({}, {5.0, 0.0, 0.0}, 0.01).p_value, 1.0);
  EXPECT_FALSE(testPlugIn({}, {5.0, 0.0, 0.0}, 0.01).rejected);
}

}  // namespace
}  // namespace casepush
