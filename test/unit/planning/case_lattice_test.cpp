#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "planning/chain_search.h"
#include "planning/disposal.h"
#include "planning/furnished_room.h"
#include "planning/origin_distance.h"
#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

constexpr double kQuarter_rad = M_PI / 2.0;
constexpr double kStride_m = 0.5;

/// Every push leads from one point of a square grid to another, in one of four headings, and the
/// robot's ways cost nothing: so the cells hold the graph exactly, and it is small.
class GridWorld {
 public:
  explicit GridWorld(std::uint64_t seed) : map_(mapOf(roomFor(seed))), checker_(*map_) {
    const double speed_mps = SyntheticPushOptions{}.speed_mps;
    Random random = Random::stream(seed, "grid world");
    for (int i = 0; i < 4; ++i) {
      const int strides = 1 + static_cast<int>(random.below(2));
      pushes_.push_back(
          syntheticPush(i + 1, kQuarter_rad * i, strides * kStride_m / speed_mps, 0.0, {}));
    }
    for (const double turn_rad : {kQuarter_rad, -kQuarter_rad}) {
      pushes_.push_back(syntheticPush(static_cast<int>(pushes_.size()) + 1, -0.5 * turn_rad,
                                      kStride_m / speed_mps, turn_rad, {}));
    }
    cases_ = prepareCases(pushes_, 0.0, 0.025, chair_.radius_m, robot_.radius_m);
    options_.drive_speed_mps = 1e9;
    options_.turn_rate_rps = 1e9;
    ways_ = std::make_unique<OriginDistance>(checker_.columns(), chair_.solid, goal_.position(),
                                             tolerance_.position_m);
  }

  ChainResult search(const std::vector<double>& weights, const std::function<bool()>& stop = {}) {
    const PushTime time(cases_, options_);
    PushChecker checker(checker_, {checker_.footprint(chair_.solid), chair_.radius_m},
                        {checker_.footprint(robot_.solid), robot_.radius_m});
    const ChainProblem problem{cases_,
                               time,
                               checker,
                               start_,
                               goal_,
                               tolerance_,
                               robot_at_,
                               0.2,
                               1000000,
                               1,
                               options_.handling_s};
    LatticeOptions lattice;
    lattice.weights = weights;
    const ChainResult result = searchLattice(
        problem, lattice, *ways_, [](const Pose2&, int, int) { return false; },
        stop ? stop : [] { return false; }, &disposal_);
    checks_ = checker.checkCount();
    return result;
  }

  /// Of the last search.
  int checks() const { return checks_; }

  /// Dijkstra's algorithm over the whole graph; infinite if there is no chain.
  double cheapest() {
    PushChecker checker(checker_, {checker_.footprint(chair_.solid), chair_.radius_m},
                        {checker_.footprint(robot_.solid), robot_.radius_m});
    std::set<std::tuple<double, int, int, int>> open = {{0.0, 0, 0, 0}};
    std::map<std::tuple<int, int, int>, double> costs = {{{0, 0, 0}, 0.0}};
    while (!open.empty()) {
      const auto [cost, x, y, quarters] = *open.begin();
      open.erase(open.begin());
      const Pose2 pose(start_.x() + kStride_m * x, start_.y() + kStride_m * y,
                       kQuarter_rad * quarters);
      if (tolerance_.isMet(goal_, pose)) return cost;
      for (const PreparedCase& push : cases_) {
        if (!checker.isSafe(push, pose)) continue;
        const Pose2 to = pose * push.start_outcome.mean;
        const std::tuple<int, int, int> key{std::lround((to.x() - start_.x()) / kStride_m),
                                            std::lround((to.y() - start_.y()) / kStride_m),
                                            (std::lround(to.yaw() / kQuarter_rad) + 4) % 4};
        const double to_cost = cost + options_.handling_s + push.duration_s;
        const auto [entry, is_new] = costs.try_emplace(key, to_cost);
        if (!is_new && entry->second <= to_cost) continue;
        entry->second = to_cost;
        open.insert({to_cost, std::get<0>(key), std::get<1>(key), std::get<2>(key)});
      }
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  static WorldModel roomFor(std::uint64_t seed) {
    WorldModel world = emptyRoom();
    Random random = Random::stream(seed, "boxes");
    for (int i = 0; i < 14; ++i) {
      const double x = random.uniform(4.0, 11.0);
      world.boxes.push_back(
          standing("box_" + std::to_string(i), x, random.uniform(1.0, 14.0), 0.4, 0.9, 1.0));
    }
    return world;
  }

  std::shared_ptr<const Map> map_;
  CollisionChecker checker_;
  ObjectModel chair_ = testChair();
  RobotModel robot_ = testRobot();
  std::vector<Case> pushes_;
  std::vector<PreparedCase> cases_;
  PushTimeOptions options_;
  Pose2 start_{2.0, 7.0, 0.0};
  Pose2 goal_{12.0, 8.0, kQuarter_rad};
  Pose2 robot_at_{1.0, 7.0, 0.0};
  GoalTolerance tolerance_;
  std::unique_ptr<OriginDistance> ways_;
  int checks_ = 0;
  Disposal disposal_;
};

class CaseLatticeTest : public testing::TestWithParam<int> {};

TEST_P(CaseLatticeTest, isAsCheapAsDijkstrasChainWithWeightOne) {
  GridWorld world(GetParam());
  const double cheapest_s = world.cheapest();
  ASSERT_TRUE(std::isfinite(cheapest_s));
  for (const auto& weights : {std::vector<double>{1.0}, std::vector<double>{5.0, 2.5, 1.5, 1.0}}) {
    const ChainResult result = world.search(weights);
    ASSERT_TRUE(result.found);
    EXPECT_NEAR(result.cost_s, cheapest_s, 1e-6);
    EXPECT_NEAR(result.bound, 1.0, 1e-9);
  }
}

TEST_P(CaseLatticeTest, keepsTheBoundThatItReports) {
  GridWorld world(GetParam());
  const double cheapest_s = world.cheapest();
  for (const double weight : {10.0, 5.0, 2.0, 1.2}) {
    const ChainResult result = world.search({weight});
    ASSERT_TRUE(result.found);
    EXPECT_LE(result.cost_s, result.bound * cheapest_s + 1e-6) << "weight " << weight;
    EXPECT_LE(result.cost_s, weight * cheapest_s + 1e-6);
    EXPECT_GE(result.bound, 1.0);
  }
}

TEST(CaseLattice, reusesWhatLargerWeightsReached) {
  int together = 0;
  int apart = 0;
  for (int seed = 1; seed < 6; ++seed) {
    GridWorld world(seed);
    for (const double weight : {5.0, 2.5, 1.5, 1.0}) {
      world.search({weight});
      apart += world.checks();
    }
    world.search({5.0, 2.5, 1.5, 1.0});
    together += world.checks();
  }
  EXPECT_LT(together, apart);
}

TEST_P(CaseLatticeTest, returnsTheBestSoFarWhenStopped) {
  GridWorld world(GetParam());
  const ChainResult first = world.search({5.0});
  int asked = 0;
  int asked_first = 0;
  world.search({5.0}, [&asked_first] { return ++asked_first < 0; });
  const ChainResult stopped = world.search({5.0, 1.0}, [&] { return ++asked > asked_first + 3; });
  ASSERT_TRUE(stopped.found);
  EXPECT_LE(stopped.cost_s, first.cost_s);
  EXPECT_EQ(asked, asked_first + 4) << "asks before each step and ends at once";
  EXPECT_LE(stopped.cost_s, stopped.bound * world.cheapest() + 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CaseLatticeTest, testing::Range(1, 6));

}  // namespace
}  // namespace casepush
