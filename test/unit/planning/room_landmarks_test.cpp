#include "planning/room_landmarks.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "casepush/common/random.h"
#include "planning/grid_flood.h"

namespace casepush {
namespace {

constexpr int kStride = 32;
constexpr int kRows = 24;
constexpr int kLongestStep = 102;

/// Cells with and without a way, within a rim without.
std::vector<HalfSteps> randomRoom(Random* random, double blocked) {
  std::vector<HalfSteps> steps(kStride * kRows);
  for (int y = 1; y + 1 < kRows; ++y) {
    for (int x = 1; x + 1 < kStride; ++x) {
      if (random->chance(blocked)) continue;
      const double factor = random->uniform(1.0, 3.0);
      steps[y * kStride + x] = {static_cast<std::uint8_t>(12.0 * factor),
                                static_cast<std::uint8_t>(17.0 * factor)};
    }
  }
  return steps;
}

std::vector<int> waysFrom(const std::vector<HalfSteps>& steps, int cell) {
  GridFlood flood(kStride * kRows, kStride, kLongestStep);
  flood.begin(cell);
  flood.spread(
      [&](int from, int to, bool is_diagonal) {
        return HalfSteps::step(steps[from], steps[to], is_diagonal);
      },
      [](int, int) { return true; });
  return flood.takeDistance();
}

TEST(RoomLandmarks, boundWaysFromBelow) {
  Random random(3);
  for (const double blocked : {0.0, 0.2, 0.45}) {
    const std::vector<HalfSteps> steps = randomRoom(&random, blocked);
    const RoomLandmarks landmarks(steps, kStride, kLongestStep, Patience());
    for (int i = 0; i < 20; ++i) {
      const int from = static_cast<int>(random.below(steps.size()));
      if (steps[from].straight == 0) continue;
      const std::vector<int> ways = waysFrom(steps, from);
      for (int to = 0; to < kStride * kRows; ++to) {
        EXPECT_LE(landmarks.between(from, to), ways[to]);
      }
    }
  }
}

TEST(RoomLandmarks, changeByNoMoreThanAStep) {
  Random random(4);
  const std::vector<HalfSteps> steps = randomRoom(&random, 0.3);
  const RoomLandmarks landmarks(steps, kStride, kLongestStep, Patience());
  const int from = kRows / 2 * kStride + kStride / 2;
  for (int cell = kStride; cell < kStride * (kRows - 1); ++cell) {
    if (steps[cell].straight == 0) continue;
    for (const int next : {cell + 1, cell + kStride, cell + kStride + 1}) {
      const bool is_diagonal = next == cell + kStride + 1;
      const int step = HalfSteps::step(steps[cell], steps[next], is_diagonal);
      if (step == 0) continue;
      EXPECT_LE(std::abs(landmarks.between(from, next) - landmarks.between(from, cell)), step);
    }
  }
}

// In the open they are far from one another, so that they say nearly all.
TEST(RoomLandmarks, sayNearlyAllInTheOpen) {
  std::vector<HalfSteps> steps(kStride * kRows);
  for (int y = 1; y + 1 < kRows; ++y) {
    for (int x = 1; x + 1 < kStride; ++x) steps[y * kStride + x] = {12, 17};
  }
  const RoomLandmarks landmarks(steps, kStride, kLongestStep, Patience());
  const int from = 12 * kStride + 4;
  const int to = 11 * kStride + 28;
  EXPECT_GT(landmarks.between(from, to), 0.8 * waysFrom(steps, from)[to]);
}

TEST(RoomLandmarks, canDoWithoutAnyWay) {
  const std::vector<HalfSteps> steps(kStride * kRows);
  const RoomLandmarks landmarks(steps, kStride, kLongestStep, Patience());
  EXPECT_EQ(landmarks.between(40, 50), 0);
}

}  // namespace
}  // namespace casepush
