// Exploration for a robot that drives: the object must stay where the robot gets around it.
#include <gtest/gtest.h>

#include <cmath>

#include "casepush/execution/exploration.h"
#include "casepush/execution/push_ground.h"
#include "execution/fake_world.h"
#include "execution/learnt_cases.h"

namespace casepush {
namespace {

using Kind = Exploration::Trial::Kind;

constexpr double kHalfM = 3.0;

/// A square room.
CollisionChecker room() {
  std::vector<Eigen::Vector3f> points;
  for (double s = -kHalfM; s <= kHalfM; s += 0.05) {
    for (const double side : {-kHalfM, kHalfM}) {
      points.emplace_back(s, side, 0.5);
      points.emplace_back(side, s, 0.5);
    }
  }
  Map map(0.05);
  map.addSurvey(points);
  return CollisionChecker(map);
}

PushGround ground() {
  return {room(), test::fakeObject(), test::fakeRobot(), Eigen::Vector2d(0.0, 0.0)};
}

PushCourse straightCourse(double length_m) {
  PushCourse course;
  for (int i = 0; i <= 10; ++i) {
    course.start_T_object.emplace_back(0.1 * i * length_m, 0.0, 0.0);
    course.start_T_robot.emplace_back(0.1 * i * length_m - 0.68, 0.0, 0.0);
  }
  course.start_outcome.mean = Pose2(length_m, 0.0, 0.0);
  return course;
}

TEST(PushGround, knowsTheRoomAroundAnObject) {
  const PushGround open = ground();
  EXPECT_NEAR(open.objectRoom(Pose2()), kHalfM - test::kObjectRadiusM, 0.1);
  EXPECT_NEAR(open.objectRoom(Pose2(2.0, 0.0, 1.0)), 1.0 - test::kObjectRadiusM, 0.1);
  EXPECT_GT(open.neededRoomM(), 2.0 * test::kRobotRadiusM);
  EXPECT_LT(open.middle().norm(), 1.0);
}

TEST(PushGround, theMiddleIsFoundFromAWall) {
  const PushGround open(room(), test::fakeObject(), test::fakeRobot(), {2.4, -2.4});
  EXPECT_LT(open.middle().cwiseAbs().maxCoeff(), 1.0);
}

TEST(PushGround, pushesIntoWallsOrFromWhereTheRobotDoesNotFitAreRefused) {
  const PushGround open = ground();
  EXPECT_NEAR(*open.roomAfter(Pose2(), straightCourse(0.5)), 2.5 - test::kObjectRadiusM, 0.1);
  EXPECT_FALSE(open.roomAfter(Pose2(2.4, 0.0, 0.0), straightCourse(0.5)));
  // Away from the wall the robot has no room behind the object.
  EXPECT_FALSE(open.roomAfter(Pose2(2.4, 0.0, M_PI), straightCourse(0.5)));
  EXPECT_TRUE(open.roomAfter(Pose2(2.4, 0.0, M_PI / 2), straightCourse(0.5)));
}

TEST(PushGround, uncertaintyTakesRoom) {
  const PushGround open = ground();
  PushCourse course = straightCourse(0.5);
  const double sure_m = *open.roomAfter(Pose2(), course);
  course.start_outcome.covariance = 0.01 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(*open.roomAfter(Pose2(), course), sure_m - 0.2, 1e-6);
}

TEST(PushGround, tellsWhetherWallsHadAPart) {
  const PushGround open = ground();
  EXPECT_TRUE(open.wasFree(Pose2(), straightCourse(0.5)));
  EXPECT_FALSE(open.wasFree(Pose2(2.5, 0.0, 0.0), straightCourse(0.4)));
}

/// Learns in the fake world without ever putting anything anywhere.
struct DrivingLearner : test::LearntCases {
  DrivingLearner(std::uint64_t seed, int case_count, int practices)
      : exploration(test::fakeObject(), test::fakeRobot(),
                    test::explorationOptions(case_count, practices, seed)),
        world(seed) {
    world.scatter = 0.05;
  }

  void once(const Exploration::Trial& trial) {
    ExecutePush push =
        trial.case_id
            ? ExecutePush("chair_1", cases.at(*trial.case_id), test::fakeRobot(), test::detour, {})
            : ExecutePush("chair_1", trial.configuration, test::fakeRobot(), test::detour, {});
    test::run(push, world);
    judge(exploration, trial, *push.report(), &floor);
    ++pushes;
  }

  PushGround floor = ground();
  Exploration exploration;
  test::FakeWorld world;
  int pushes = 0;
};

TEST(ExplorationDrive, learnsEverythingAndKeepsTheObjectOffTheWalls) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    DrivingLearner learner(seed, 6, 5);
    double least_room_m = 10.0;
    while (const auto trial = learner.exploration.next(learner.floor, learner.world.object)) {
      ASSERT_LT(learner.pushes, 120);
      learner.once(*trial);
      least_room_m = std::min(least_room_m, learner.floor.objectRoom(learner.world.object));
    }
    EXPECT_FALSE(learner.exploration.gaveUp()) << learner.exploration.explanation();
    EXPECT_EQ(learner.exploration.quality().complete_cases, 6);
    EXPECT_GT(least_room_m, 2.0 * test::kRobotRadiusM) << "seed " << seed;
  }
}

TEST(ExplorationDrive, bringsTheObjectBackFromAWall) {
  DrivingLearner learner(1, 1, 20);
  learner.world.object = Pose2(2.4, 0.0, 0.3);
  learner.world.robot = Pose2(0.0, 0.0, 0.0);
  int brought_back = 0;
  while (const auto trial = learner.exploration.next(learner.floor, learner.world.object)) {
    const double before_m = learner.floor.objectRoom(learner.world.object);
    if (before_m > learner.floor.neededRoomM() + 0.3) {
      break;
    }
    brought_back += trial->kind == Kind::kBringBack ? 1 : 0;
    ASSERT_LT(learner.pushes, 20);
    learner.once(*trial);
  }
  EXPECT_EQ(learner.exploration.broughtBack(), brought_back);
  EXPECT_GT(learner.floor.objectRoom(learner.world.object), learner.floor.neededRoomM());
}

TEST(ExplorationDrive, triesSomethingElseAfterAPushThatCanNotBeReached) {
  DrivingLearner learner(2, 2, 5);
  while (learner.cases.empty()) {
    learner.once(*learner.exploration.next(learner.floor, learner.world.object));
  }
  learner.world.object = Pose2();
  const auto practice = learner.exploration.next(learner.floor, learner.world.object);
  ASSERT_EQ(practice->kind, Kind::kPractise);
  PushReport blocked;
  blocked.outcome = PushOutcome::kApproachFailed;
  for (int i = 0; i < 8; ++i) {
    learner.exploration.judge(*practice, blocked, &learner.floor);
  }
  EXPECT_EQ(learner.exploration.dropped(), 0);
  const auto other = learner.exploration.next(learner.floor, learner.world.object);
  EXPECT_NE(other->kind, Kind::kPractise);
  // Elsewhere it is tried again.
  const auto later = learner.exploration.next(learner.floor, Pose2(0.2, 0.0, 0.0));
  EXPECT_EQ(later->kind, Kind::kPractise);
}

TEST(ExplorationDrive, saysSoWhenNothingCanBePushed) {
  const PushGround none(room(), test::fakeObject(), test::fakeRobot(), {2.9, 2.9});
  Exploration exploration(test::fakeObject(), test::fakeRobot(), ExplorationOptions{});
  EXPECT_FALSE(exploration.next(none, Pose2(2.9, 2.9, 0.0)));
  EXPECT_TRUE(exploration.gaveUp());
  EXPECT_NE(exploration.explanation().find("no push is possible where disc stands"),
            std::string::npos);
}

}  // namespace
}  // namespace casepush
