#include "casepush/lab/chain_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/common/random.h"

namespace casepush {
namespace {

constexpr double kSigma_m = 0.02;
constexpr double kSigma_rad = 0.04;

/// Tasks of pushes forward whose outcomes scatter `scale` times as much as expected.
std::vector<std::vector<PushReport>> drawnTasks(int count, int pushes, double scale) {
  Random random(7);
  const Pose2 start_T_mean(0.5, 0.1, 0.2);
  std::vector<std::vector<PushReport>> tasks(count);
  for (std::vector<PushReport>& reports : tasks) {
    Pose2 pose(1.0, 2.0, 0.5);
    for (int i = 0; i < pushes; ++i) {
      PushReport report;
      report.case_id = 1;
      report.outcome = PushOutcome::kDone;
      report.map_T_start = pose;
      report.map_expected.mean = pose * start_T_mean;
      report.map_expected.covariance =
          Eigen::Vector3d(kSigma_m, kSigma_m, kSigma_rad).array().square().matrix().asDiagonal();
      const Eigen::Vector3d deviation(random.normal(scale * kSigma_m),
                                      random.normal(scale * kSigma_m),
                                      random.normal(scale * kSigma_rad));
      pose = report.map_expected.mean * expSe2(deviation);
      report.map_T_end = pose;
      reports.push_back(report);
    }
  }
  return tasks;
}

TEST(CalibrateChains, findsSharesAsTheyShouldBeIfTheScatterIsAsExpected) {
  const auto rows = calibrateChains(drawnTasks(1500, 4, 1.0), 9);
  ASSERT_EQ(rows.size(), 4U) << "no longer chains occur";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int length = static_cast<int>(i) + 1;
    EXPECT_EQ(rows[i].pushes, length);
    EXPECT_EQ(rows[i].chains, 1500 * (5 - length));
    EXPECT_NEAR(rows[i].inside_50, 0.5, 0.05) << length;
    EXPECT_NEAR(rows[i].inside_90, 0.9, 0.03) << length;
    EXPECT_NEAR(rows[i].inside_95, 0.95, 0.02) << length;
  }
  EXPECT_NEAR(rows[0].position_rms_m, std::sqrt(2.0) * kSigma_m, 0.001);
  EXPECT_NEAR(rows[0].yaw_rms_rad, kSigma_rad, 0.002);
  EXPECT_NEAR(rows[3].yaw_rms_rad, 2.0 * kSigma_rad, 0.004) << "that of four adds up";
}

TEST(CalibrateChains, noticesMoreScatterThanExpected) {
  const auto rows = calibrateChains(drawnTasks(300, 3, 2.0), 3);
  for (const ChainCalibration& row : rows) EXPECT_LT(row.inside_90, 0.7) << row.pushes;
}

TEST(CalibrateChains, endsAtPushesThatWereNotMadeAsPlanned) {
  auto tasks = drawnTasks(1, 5, 1.0);
  tasks[0][2].outcome = PushOutcome::kBrokenOff;
  const auto rows = calibrateChains(tasks, 5);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].chains, 4);
  EXPECT_EQ(rows[1].chains, 2);
  tasks[0][0].case_id = 0;
  EXPECT_EQ(calibrateChains(tasks, 5)[0].chains, 3);
  EXPECT_TRUE(calibrateChains({}, 5).empty());
}

}  // namespace
}  // namespace casepush
