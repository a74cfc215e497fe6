#include "casepush/common/normal_samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace casepush {
namespace {

TEST(NormalSamples, haveTheMomentsOfAStandardNormal) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto samples = normalSamples(256, seed);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& sample : samples) {
      mean += sample / 256.0;
      spread += sample * sample.transpose() / 256.0;
    }
    // A third of what random points would leave: 1/16 and 1/11.
    EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.03) << "seed " << seed;
    EXPECT_LT((spread - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.12)
        << "seed " << seed;
  }
}

TEST(NormalSamples, fillTheEllipsoidsInProportion) {
  // chi-squared with three degrees of freedom: 0.1987 within one sigma, 0.7385 within two.
  int within_one = 0;
  int within_two = 0;
  constexpr int kCount = 4096;
  for (const Eigen::Vector3d& sample : normalSamples(kCount, 3)) {
    within_one += sample.norm() <= 1.0 ? 1 : 0;
    within_two += sample.norm() <= 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(within_one / double{kCount}, 0.1987, 0.005);
  EXPECT_NEAR(within_two / double{kCount}, 0.7385, 0.005);
}

TEST(NormalSamples, areFixedByTheSeed) {
  EXPECT_EQ(normalSamples(32, 5), normalSamples(32, 5));
  EXPECT_NE(normalSamples(32, 5), normalSamples(32, 6));
  for (const Eigen::Vector3d& sample : normalSamples(10000, 5)) {
    ASSERT_TRUE(sample.allFinite());
  }
}

TEST(NormalSamplesDeathTest, refuseNoSamples) { EXPECT_DEATH(normalSamples(0, 1), "0 samples"); }

}  // namespace
}  // namespace casepush
