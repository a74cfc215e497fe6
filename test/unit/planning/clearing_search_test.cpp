#include "planning/clearing_search.h"

#include <gtest/gtest.h>

#include "planning/furnished_room.h"
#include "planning/synthetic_pushes.h"
#include "planning/way.h"

namespace casepush {
namespace {

/// A chair in the middle of a straight way from west to east through a room.
class ClearingSearch : public ::testing::Test {
 protected:
  void furnish(const WorldModel& world) {
    checker_.emplace(*mapOf(world));
    push_checker_.emplace(*checker_,
                          PushChecker::Body{checker_->footprint(chair_.solid), chair_.radius_m},
                          PushChecker::Body{checker_->footprint(robot_.solid), robot_.radius_m});
    cases_ = prepareCases(syntheticPushes(14, 3), 3.0, 0.025, chair_.radius_m, robot_.radius_m);
    time_.emplace(cases_, PushTimeOptions());
    for (double x = 3.0; x <= 12.0; x += 0.2) way_.add(outline_, Pose2(x, 7.5, 0.0));
  }

  ClearingProblem problem() {
    return {cases_,
            *time_,
            *push_checker_,
            Pose2(7.5, 7.5, 0.4),
            Pose2(2.0, 7.5, 0.0),
            0.1,
            chair_.gyration_radius_m,
            3000,
            0.6,
            0.05,
            [this](const Pose2& pose) { return way_.distance(outline_, pose, 2.0); },
            [](const Pose2&) { return 2.0; },
            [](const Pose2&, int, int) { return true; }};
  }

  double worstDistance(const Pose2& from, const PreparedCase& push_case) const {
    double worst_m = way_.distance(outline_, from * push_case.start_outcome.mean, 2.0);
    for (const Pose2& sigma : push_case.start_T_sigma) {
      worst_m = std::min(worst_m, way_.distance(outline_, from * sigma, 2.0));
    }
    return worst_m;
  }

  const ObjectModel chair_ = testChair();
  const RobotModel robot_ = testRobot();
  const Shadow outline_ = outlineOf(chair_.solid);
  std::optional<CollisionChecker> checker_;
  std::optional<PushChecker> push_checker_;
  std::vector<PreparedCase> cases_;
  std::optional<PushTime> time_;
  Way way_;
  const std::function<bool()> never_ = [] { return false; };
};

TEST_F(ClearingSearch, EndsOutOfTheWayAtEverySigmaPoint) {
  furnish(emptyRoom());
  const ClearingChain chain = searchClearing(problem(), never_);
  ASSERT_TRUE(chain.found);
  ASSERT_FALSE(chain.pushes.empty());
  Pose2 pose = problem().map_T_start;
  for (std::size_t i = 0; i + 1 < chain.pushes.size(); ++i) {
    ASSERT_TRUE(push_checker_->isSafe(cases_[chain.pushes[i]], pose));
    pose = pose * cases_[chain.pushes[i]].start_outcome.mean;
  }
  ASSERT_TRUE(push_checker_->isSafe(cases_[chain.pushes.back()], pose));
  EXPECT_GE(worstDistance(pose, cases_[chain.pushes.back()]), problem().needed_m);
}

TEST_F(ClearingSearch, NoShorterChainEndsOutOfTheWay) {
  furnish(emptyRoom());
  const ClearingChain chain = searchClearing(problem(), never_);
  ASSERT_TRUE(chain.found);
  ASSERT_LE(chain.pushes.size(), 2U) << "the oracle looks at single pushes only";
  double best_m = -1.0;
  for (const PreparedCase& push_case : cases_) {
    if (push_checker_->isSafe(push_case, problem().map_T_start)) {
      best_m = std::max(best_m, worstDistance(problem().map_T_start, push_case));
    }
  }
  if (best_m >= problem().needed_m) {
    EXPECT_EQ(chain.pushes.size(), 1U);
    EXPECT_NEAR(chain.distance_m, std::min(best_m, problem().wanted_m), 1e-9);
  } else {
    EXPECT_GT(chain.pushes.size(), 1U);
  }
}

TEST_F(ClearingSearch, LeavesOutWhatTheRobotCannotGetTo) {
  furnish(emptyRoom());
  const ClearingChain free = searchClearing(problem(), never_);
  ASSERT_TRUE(free.found);
  ClearingProblem restricted = problem();
  restricted.can_approach = [&free](const Pose2&, int previous, int next) {
    return previous >= 0 || next != free.pushes.front();
  };
  const ClearingChain other = searchClearing(restricted, never_);
  ASSERT_TRUE(other.found);
  EXPECT_NE(other.pushes.front(), free.pushes.front());
  restricted.can_approach = [](const Pose2&, int, int) { return false; };
  EXPECT_FALSE(searchClearing(restricted, never_).found);
}

TEST_F(ClearingSearch, KeepsAwayFromOtherObstaclesIfItCan) {
  furnish(emptyRoom());
  ClearingProblem beside = problem();
  const Pose2 other(7.5, 9.0, 0.0);  // North of the way.
  beside.others_distance_m = [&other](const Pose2& pose) { return distance(pose, other) - 0.7; };
  const ClearingChain chain = searchClearing(beside, never_);
  ASSERT_TRUE(chain.found);
  Pose2 pose = beside.map_T_start;
  for (const int push : chain.pushes) pose = pose * cases_[push].start_outcome.mean;
  EXPECT_LT(pose.y(), 7.5);
}

TEST_F(ClearingSearch, InACorridorOnlyItsEndIsOutOfTheWay) {
  WorldModel corridor = emptyRoom();
  corridor.boxes.push_back(standing("left", 7.5, 8.65, 15.0, 0.3, 1.5));
  corridor.boxes.push_back(standing("right", 7.5, 6.35, 15.0, 0.3, 1.5));
  furnish(corridor);
  const ClearingChain chain = searchClearing(problem(), never_);
  if (chain.found) {
    EXPECT_GT(chain.pushes.size(), 3U);
  } else {
    EXPECT_TRUE(chain.exhausted || chain.nodes >= problem().max_nodes);
  }
}

TEST_F(ClearingSearch, StopsWhenAsked) {
  furnish(emptyRoom());
  const ClearingChain chain = searchClearing(problem(), [] { return true; });
  EXPECT_FALSE(chain.found);
  EXPECT_FALSE(chain.exhausted);
}

}  // namespace
}  // namespace casepush
