#include "planning/clearing_search.h"

#include <gtest/gtest.h>

#include <limits>

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
            robot_stands_,
            0.1,
            chair_.gyration_radius_m,
            3000,
            0.6,
            0.05,
            [this](const Pose2& pose) { return way_.distance(outline_, pose, 2.0); },
            [](const Pose2&) { return 2.0; },
            [this](const Pose2& obstacle, int previous, int next) {
              return previous < 0 ? time_->first(obstacle.inverse() * robot_stands_, next)
                                  : time_->after(previous, next);
            },
            [](const Pose2&) { return 0.0; }};
  }

  double worstDistance(const Pose2& from, const PreparedCase& push_case) const {
    double worst_m = way_.distance(outline_, from * push_case.start_outcome.mean, 2.0);
    for (const Pose2& sigma : push_case.start_T_sigma) {
      worst_m = std::min(worst_m, way_.distance(outline_, from * sigma, 2.0));
    }
    return worst_m;
  }

  const Pose2 robot_stands_{2.0, 7.5, 0.0};
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

TEST_F(ClearingSearch, TakesLittleLongerThanTheQuickestOfAllPairs) {
  furnish(emptyRoom());
  const ClearingProblem whole = problem();
  const ClearingChain chain = searchClearing(whole, never_);
  ASSERT_TRUE(chain.found);
  const Pose2& start = whole.map_T_start;
  double quickest_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(cases_.size()); ++i) {
    if (!push_checker_->isSafe(cases_[i], start)) continue;
    const Pose2 pose = start * cases_[i].start_outcome.mean;
    for (int k = 0; k < static_cast<int>(cases_.size()); ++k) {
      const bool is_away = push_checker_->isSafe(cases_[k], pose) &&
                           worstDistance(pose, cases_[k]) >= whole.needed_m;
      if (!is_away) continue;
      quickest_s = std::min(quickest_s, whole.push_s(start, -1, i) + whole.push_s(pose, i, k));
    }
  }
  ASSERT_TRUE(std::isfinite(quickest_s));
  EXPECT_LE(chain.cost_s, 1.3 * quickest_s);
}

TEST_F(ClearingSearch, CountsTheRobotsWaysThereAndBack) {
  furnish(emptyRoom());
  const ClearingChain free = searchClearing(problem(), never_);
  ASSERT_TRUE(free.found);
  const auto end_y_m = [this](const ClearingProblem& solved) {
    Pose2 pose = solved.map_T_start;
    for (const int push : searchClearing(solved, never_).pushes) {
      pose = pose * cases_[push].start_outcome.mean;
    }
    return pose.y();
  };
  // Whatever brings the obstacle to one side is far off, or the way back from there is long.
  for (const double side : {-1.0, 1.0}) {
    const auto is_there = [side](double y_m) { return side * (y_m - 7.5) > 0.0; };
    ClearingProblem far = problem();
    const auto plain_s = far.push_s;
    far.push_s = [&](const Pose2& obstacle, int previous, int next) {
      const Pose2 end = obstacle * cases_[next].start_outcome.mean;
      return plain_s(obstacle, previous, next) + (is_there(end.y()) ? 100.0 : 0.0);
    };
    EXPECT_FALSE(is_there(end_y_m(far)));
    ClearingProblem long_back = problem();
    long_back.back_s = [&](const Pose2& robot) { return is_there(robot.y()) ? 100.0 : 0.0; };
    const ClearingChain chain = searchClearing(long_back, never_);
    ASSERT_TRUE(chain.found);
    EXPECT_EQ(chain.back_s, 0.0);
  }
}

TEST_F(ClearingSearch, LeavesOutWhatTheRobotCannotGetTo) {
  furnish(emptyRoom());
  const ClearingChain free = searchClearing(problem(), never_);
  ASSERT_TRUE(free.found);
  ClearingProblem restricted = problem();
  const auto plain_s = restricted.push_s;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  restricted.push_s = [&](const Pose2& obstacle, int previous, int next) {
    const bool can = previous >= 0 || next != free.pushes.front();
    return can ? plain_s(obstacle, previous, next) : kNever;
  };
  const ClearingChain other = searchClearing(restricted, never_);
  ASSERT_TRUE(other.found);
  EXPECT_NE(other.pushes.front(), free.pushes.front());
  restricted.push_s = [&](const Pose2&, int, int) { return kNever; };
  EXPECT_FALSE(searchClearing(restricted, never_).found);
}

TEST_F(ClearingSearch, KeepsAwayFromOtherObstaclesIfItCan) {
  furnish(emptyRoom());
  ClearingProblem beside = problem();
  const Pose2 other(7.5, 9.0, 0.0);  // North of the way.
  beside.others_distance_m = [&other](const Pose2& pose) { return distance(pose, other) - 0.7; };
  beside.push_s = [](const Pose2&, int, int) { return 10.0; };
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
