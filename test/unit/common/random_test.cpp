#include "casepush/common/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace casepush {
namespace {

constexpr int kSamples = 200000;

TEST(Random, givesTheSameSequenceEverywhere) {
  // mt19937_64 seeded with SplitMix64(1): fixed by the standard and by Steele et al.
  Random random(1);
  std::mt19937_64 engine(0x910a2dec89025cc1ULL);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(random.bits(), engine());
  }
}

TEST(Random, isFixedByItsSeed) {
  Random a(7);
  Random b(7);
  Random c(8);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const double value = a.normal(1.0);
    EXPECT_EQ(value, b.normal(1.0));
    differs = differs || value != c.normal(1.0);
  }
  EXPECT_TRUE(differs);
}

TEST(Random, streamsDependOnSeedAndName) {
  EXPECT_EQ(Random::stream(1, "camera").bits(), Random::stream(1, "camera").bits());
  EXPECT_NE(Random::stream(1, "camera").bits(), Random::stream(1, "casters").bits());
  EXPECT_NE(Random::stream(1, "camera").bits(), Random::stream(2, "camera").bits());
  EXPECT_NE(Random::stream(1, "").bits(), Random::stream(1, "a").bits());
}

TEST(Random, uniformHasItsMomentsAndBounds) {
  Random random(2);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double value = random.uniform(-1.0, 3.0);
    ASSERT_GE(value, -1.0);
    ASSERT_LT(value, 3.0);
    sum += value;
    squares += (value - 1.0) * (value - 1.0);
  }
  const double deviation = 4.0 / std::sqrt(12.0);
  EXPECT_NEAR(sum / kSamples, 1.0, 4.0 * deviation / std::sqrt(kSamples));
  EXPECT_NEAR(squares / kSamples, deviation * deviation, 0.01);
}

TEST(Random, normalHasItsMoments) {
  Random random(3);
  std::array<double, 5> moment{};
  for (int i = 0; i < kSamples; ++i) {
    const double value = random.normal(2.0) / 2.0;
    double power = 1.0;
    for (double& m : moment) {
      m += power / kSamples;
      power *= value;
    }
  }
  EXPECT_NEAR(moment[1], 0.0, 0.01);
  EXPECT_NEAR(moment[2], 1.0, 0.015);
  EXPECT_NEAR(moment[3], 0.0, 0.04);
  EXPECT_NEAR(moment[4], 3.0, 0.12);
}

TEST(Random, chanceMatchesItsProbability) {
  Random random(4);
  int hits = 0;
  for (int i = 0; i < kSamples; ++i) {
    EXPECT_FALSE(random.chance(0.0));
    EXPECT_TRUE(random.chance(1.0));
    hits += random.chance(0.05) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(hits) / kSamples, 0.05, 0.002);
}

TEST(Random, belowIsUniform) {
  Random random(5);
  std::array<int, 7> counts{};
  for (int i = 0; i < kSamples; ++i) {
    ++counts.at(random.below(counts.size()));
  }
  double chi_squared = 0.0;
  const double expected = static_cast<double>(kSamples) / counts.size();
  for (const int count : counts) {
    chi_squared += (count - expected) * (count - expected) / expected;
  }
  EXPECT_LT(chi_squared, 22.5);  // 99.9 % of chi^2 with 6 degrees of freedom
  EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, belowIsUnbiasedForHugeBounds) {
  // With a plain modulo, values below 2^62 would come up twice as often.
  Random random(6);
  constexpr std::uint64_t kBound = 3ULL << 62;
  int low = 0;
  for (int i = 0; i < kSamples; ++i) {
    low += random.below(kBound) < (1ULL << 62) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(low) / kSamples, 1.0 / 3.0, 0.005);
}

TEST(RandomDeathTest, refusesAnEmptyRange) { EXPECT_DEATH(Random(1).below(0), "bound = 0"); }

}  // namespace
}  // namespace casepush
