#include "planning/grid_flood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "casepush/common/random.h"

namespace casepush {
namespace {

constexpr int kWidth = 30;
constexpr int kHeight = 20;

/// A random price for each cell; 0 at the rim and at some others, where there is no way.
std::vector<int> prices(std::uint64_t seed) {
  Random random(seed);
  std::vector<int> result(kWidth * kHeight, 0);
  for (int y = 1; y < kHeight - 1; ++y) {
    for (int x = 1; x < kWidth - 1; ++x) {
      if (!random.chance(0.25)) result[y * kWidth + x] = 1 + static_cast<int>(random.below(9));
    }
  }
  return result;
}

int cost(const std::vector<int>& prices, int from, int to, bool is_diagonal) {
  if (prices[from] == 0 || prices[to] == 0) return 0;
  return (prices[from] + prices[to]) * (is_diagonal ? 3 : 2);
}

// Bellman and Ford's algorithm.
std::vector<int> slowly(const std::vector<int>& prices, int begin) {
  std::vector<int> distance(prices.size(), GridFlood::kUnreached);
  distance[begin] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int cell = 0; cell < kWidth * kHeight; ++cell) {
      if (distance[cell] == GridFlood::kUnreached) continue;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int next = cell + dy * kWidth + dx;
          const int step = cost(prices, cell, next, dx != 0 && dy != 0);
          if (step == 0 || distance[cell] + step >= distance[next]) continue;
          distance[next] = distance[cell] + step;
          changed = true;
        }
      }
    }
  }
  return distance;
}

TEST(GridFlood, findsTheShortestWays) {
  for (int seed = 1; seed <= 20; ++seed) {
    const std::vector<int> grid = prices(seed);
    const int begin = 10 * kWidth + 15;
    GridFlood flood(kWidth * kHeight, kWidth, 54);
    flood.begin(begin);
    flood.spread([&](int from, int to, bool diagonal) { return cost(grid, from, to, diagonal); },
                 [](int, int) { return true; });
    EXPECT_EQ(flood.distance(), slowly(grid, begin)) << seed;
  }
}

// Towards a corner first, from call to call as far as somebody asks.
TEST(GridFlood, findsTheSameTowardsAPlaceAndBitByBit) {
  for (int seed = 1; seed <= 20; ++seed) {
    const std::vector<int> grid = prices(seed);
    const int begin = 10 * kWidth + 15;
    const std::vector<int> expected = slowly(grid, begin);
    const auto left = [](int cell) {
      const int across = std::abs(cell % kWidth - 27);
      const int up = std::abs(cell / kWidth - 2);
      return 4 * std::max(across, up) + 2 * std::min(across, up);  // No step costs less.
    };
    GridFlood flood(kWidth * kHeight, kWidth, 54 + 6);
    flood.begin(begin, left(begin));
    Random random(seed);
    for (int asked = 0; asked < 50; ++asked) {
      const int cell = static_cast<int>(random.below(kWidth * kHeight));
      std::vector<int> seen;
      flood.spread([&](int from, int to, bool diagonal) { return cost(grid, from, to, diagonal); },
                   [&](int at, int distance) {
                     EXPECT_EQ(distance, expected[at]);
                     seen.push_back(at);
                     return at != cell;
                   },
                   left);
      const bool is_seen = !seen.empty() && seen.back() == cell;
      if (is_seen) continue;
      EXPECT_EQ(flood.distance()[cell], expected[cell]) << seed;
    }
  }
}

TEST(GridFlood, reachesNothingBeyondALimit) {
  const std::vector<int> grid(kWidth * kHeight, 1);
  GridFlood flood(kWidth * kHeight, kWidth, 54);
  flood.begin(10 * kWidth + 15);
  flood.setLimit(5);
  int asked = 0;
  const auto cost = [](int, int, bool is_diagonal) { return is_diagonal ? 3 : 2; };
  flood.spread(cost, [&asked](int, int distance) {
    ++asked;
    return distance < 5;
  });
  EXPECT_EQ(asked, 1 + 4 + 4 + 4);
}

TEST(GridFlood, endsWhenToldSo) {
  const std::vector<int> grid(kWidth * kHeight, 1);
  GridFlood flood(kWidth * kHeight, kWidth, 54);
  flood.begin(10 * kWidth + 15);
  int asked = 0;
  const auto cost = [](int, int, bool is_diagonal) { return is_diagonal ? 3 : 2; };
  EXPECT_EQ(flood.spread(cost,
                         [&asked](int, int now) {
                           ++asked;
                           return now < 4;
                         }),
            4);
  EXPECT_EQ(asked, 1 + 4 + 4 + 1);
}

}  // namespace
}  // namespace casepush
