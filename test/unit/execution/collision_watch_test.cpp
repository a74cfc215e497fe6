#include "../../../src/execution/collision_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "casepush/common/random.h"

namespace casepush {
namespace {

constexpr double kTick_s = 0.05;

// Two seconds at 0.25 m/s along x.
Case straightCase() {
  Case straight;
  straight.period_s = 0.1;
  for (int i = 0; i <= 20; ++i) {
    straight.steps.push_back(
        {Pose2(-0.6, 0.0, 0.0), Twist2{0.25, 0.0, 0.0}, Pose2(0.025 * i, 0.0, 0.0)});
  }
  return straight;
}

/// A wall along y = `wall_m`, of which the object's origin must keep clear. Counts how often it is
/// asked.
struct Wall {
  double y_m;
  int asked = 0;

  TouchCheck check() {
    return [this](const Observation&, const std::vector<Pose2>& map_T_object) -> std::string {
      ++asked;
      for (const Pose2& pose : map_T_object) {
        if (pose.y() > y_m) return "the wall";
      }
      return "";
    };
  }
};

// When the watch speaks up, in push time, for an object on `course` in the start frame.
template <typename Course>
std::optional<double> warnedAt(Wall* wall, const Course& course,
                               const Pose2& map_T_start = Pose2()) {
  CollisionWatch watch(straightCase(), wall->check());
  watch.begin(Observation{}, map_T_start);
  for (int i = 0; i <= 40; ++i) {
    ObjectState object;
    object.stamp_s = 100.0 + kTick_s * i;
    object.map_T_object = map_T_start * course(kTick_s * i);
    if (!watch.aheadOf(Observation{}, kTick_s * i, object).empty()) return kTick_s * i;
  }
  return std::nullopt;
}

// Turns away to the left at the case's speed from `from_s` on.
Pose2 turning(double t_s, double from_s) {
  const double rate_rps = 0.5;
  const double yaw = rate_rps * std::max(0.0, t_s - from_s);
  const double radius_m = 0.25 / rate_rps;
  return {0.25 * std::min(t_s, from_s) + radius_m * std::sin(yaw), radius_m * (1.0 - std::cos(yaw)),
          yaw};
}

TEST(CollisionWatch, warnsBeforeTheObjectTouches) {
  const auto course = [](double t_s) { return turning(t_s, 0.5); };
  Wall wall{0.08};
  const auto warned = warnedAt(&wall, course);
  ASSERT_TRUE(warned);
  EXPECT_GT(*warned, 0.5);
  // It touches after 1.65 s; a third of a second is enough to brake.
  EXPECT_LT(*warned, 1.3);
  EXPECT_LT(course(*warned).y(), 0.045);
}

TEST(CollisionWatch, saysNothingWhereTheCourseOnlyScattersBesideAWall) {
  Random random(1);
  Wall wall{0.02};
  for (int i = 0; i < 200; ++i) {
    const double late_s = random.uniform(-0.2, 0.2);
    const auto course = [&](double t_s) {
      const double along = 0.25 * std::clamp(t_s - late_s, 0.0, 2.0);
      return Pose2(along + random.normal(0.004), random.normal(0.004), random.normal(0.01));
    };
    EXPECT_FALSE(warnedAt(&wall, course)) << "push " << i;
  }
}

TEST(CollisionWatch, warnsOfWhatComesIntoTheWayOfAnObjectOnItsCourse) {
  Wall wall{0.5};
  const auto course = [&](double t_s) {
    if (t_s > 0.99) wall.y_m = -0.1;
    return Pose2(0.25 * t_s, 0.0, 0.0);
  };
  const auto warned = warnedAt(&wall, course);
  ASSERT_TRUE(warned);
  EXPECT_NEAR(*warned, 1.05, 1e-9);  // Seen twice.
}

TEST(CollisionWatch, isSilentAboutWhatTheCourseTouchesFromTheBeginning) {
  const auto straight = [](double t_s) { return Pose2(0.25 * t_s, 0.0, 0.0); };
  const auto warnedBefore = [&](double touched_m, const auto& course) {
    bool is_there = false;
    CollisionWatch watch(straightCase(), [&](const Observation&, const std::vector<Pose2>& poses) {
      const bool touches = std::any_of(poses.begin(), poses.end(), [&](const Pose2& pose) {
        return pose.x() < touched_m || (is_there && pose.x() > 0.4);
      });
      return std::string(touches ? "the wall" : "");
    });
    watch.begin(Observation{}, Pose2());
    for (int i = 0; i <= 40; ++i) {
      ObjectState object;
      object.stamp_s = 100.0 + kTick_s * i;
      object.map_T_object = course(kTick_s * i);
      if (!watch.aheadOf(Observation{}, kTick_s * i, object).empty()) return kTick_s * i;
      is_there = i >= 10;
    }
    return -1.0;
  };
  // It stands at a wall and leaves it; then somebody comes into its way.
  EXPECT_NEAR(warnedBefore(0.03, straight), 0.7, 0.16);
  // All of the course touches.
  EXPECT_EQ(warnedBefore(10.0, straight), -1.0);
}

TEST(CollisionWatch, warnsAtOnceOfWhatCameIntoTheWayBeforeThePushBegan) {
  const TouchCheck check = [](const Observation&, const std::vector<Pose2>& poses) {
    const bool touches =
        std::any_of(poses.begin(), poses.end(), [](const Pose2& pose) { return pose.x() > 0.1; });
    return std::string(touches ? "chair_2" : "");
  };
  CollisionWatch watch(straightCase(), check);
  watch.begin(Observation{}, Pose2());
  ObjectState object;
  for (const double stamp_s : {100.0, 100.05}) {
    object.stamp_s = stamp_s;
    watch.aheadOf(Observation{}, 0.0, object);
  }
  EXPECT_EQ(watch.aheadOf(Observation{}, 0.0, object), "chair_2");
}

TEST(CollisionWatch, looksOncePerSight) {
  Wall wall{0.5};
  CollisionWatch watch(straightCase(), wall.check());
  watch.begin(Observation{}, Pose2());
  wall.y_m = -1.0;
  ObjectState object;
  object.stamp_s = 100.0;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(watch.aheadOf(Observation{}, 0.1 * i, object), "");
  }
  object.stamp_s = 100.1;
  const int asked = wall.asked;
  EXPECT_EQ(watch.aheadOf(Observation{}, 1.0, object), "the wall");
  EXPECT_EQ(wall.asked, asked + 1);
  watch.aheadOf(Observation{}, 1.0, object);
  EXPECT_EQ(wall.asked, asked + 1);
}

TEST(CollisionWatch, isTheSameWhereverThePushBegins) {
  const auto course = [](double t_s) { return turning(t_s, 0.5); };
  const Pose2 map_T_start(3.0, -2.0, 0.0);
  Wall here{0.08};
  Wall there{0.08 - 2.0};
  EXPECT_EQ(warnedAt(&here, course), warnedAt(&there, course, map_T_start));
}

}  // namespace
}  // namespace casepush
