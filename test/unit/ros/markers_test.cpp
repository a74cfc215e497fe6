#include "casepush/ros/markers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "casepush/model/catalog.h"

namespace casepush {
namespace {

using visualization_msgs::Marker;

const Marker* find(const MarkerArray& array, const std::string& marker_namespace) {
  for (const Marker& marker : array.markers) {
    if (marker.ns == marker_namespace) {
      return &marker;
    }
  }
  return nullptr;
}

Case forwardCase() {
  Case push_case;
  push_case.id = 12;
  push_case.push_steps = 2;
  for (int i = 0; i < 4; ++i) {
    push_case.steps.push_back({Pose2(-0.7, 0, 0), {0.3, 0, 0}, Pose2(0.1 * i, 0, 0)});
  }
  push_case.start_outcome.mean = Pose2(0.4, 0, 0);
  push_case.start_outcome.covariance = Eigen::Vector3d(0.04, 0.01, 0.1).asDiagonal();
  return push_case;
}

TEST(Markers, eachArrayClearsItsTopicAndHasUniqueIds) {
  const MarkerArray array = caseMarkers({forwardCase(), forwardCase()}, Pose2());
  ASSERT_FALSE(array.markers.empty());
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  std::set<std::pair<std::string, int>> ids;
  for (const Marker& marker : array.markers) {
    EXPECT_TRUE(ids.emplace(marker.ns, marker.id).second);
    EXPECT_NEAR(std::hypot(std::hypot(marker.pose.orientation.x, marker.pose.orientation.y),
                           std::hypot(marker.pose.orientation.z, marker.pose.orientation.w)),
                1.0, 1e-9);
  }
}

TEST(Markers, caseShowsTrajectoriesInTheMap) {
  const MarkerArray array = caseMarkers({forwardCase()}, Pose2(1, 2, M_PI / 2));
  const Marker* object = find(array, "object trajectory");
  const Marker* robot = find(array, "robot trajectory");
  ASSERT_NE(object, nullptr);
  ASSERT_NE(robot, nullptr);
  ASSERT_EQ(object->points.size(), 4U);
  EXPECT_NEAR(object->points[3].x, 1.0, 1e-9);
  EXPECT_NEAR(object->points[3].y, 2.3, 1e-9);
  EXPECT_GT(object->color.r, object->color.g);
  ASSERT_EQ(robot->points.size(), 2U);  // While it pushes.
  EXPECT_NEAR(robot->points[0].y, 1.3, 1e-9);
  EXPECT_GT(robot->color.g, robot->color.r);
  EXPECT_EQ(find(array, "case ids")->text, "12");
}

TEST(Markers, ellipseFollowsTheFrameOfTheMean) {
  PoseGaussian gaussian;
  gaussian.mean = Pose2(1, 2, M_PI / 2);
  gaussian.covariance = Eigen::Vector3d(0.09, 0.01, 0.5).asDiagonal();
  double most_x = 0;
  double most_y = 0;
  for (const Eigen::Vector2d& point : ellipse(gaussian, 2.0, 64)) {
    most_x = std::max(most_x, std::abs(point.x() - 1.0));
    most_y = std::max(most_y, std::abs(point.y() - 2.0));
  }
  EXPECT_NEAR(most_x, 0.2, 1e-3);
  EXPECT_NEAR(most_y, 0.6, 1e-3);
}

TEST(Markers, planShowsGoalAndSevenSigmaPointsForEachPush) {
  PushPlan plan;
  plan.map_T_goal = Pose2(3, 0, 0);
  PlannedPush push;
  push.case_id = 12;
  push.map_outcome = forwardCase().start_outcome;
  plan.pushes = {push, push};
  const MarkerArray array = planMarkers(plan, {forwardCase()});
  ASSERT_NE(find(array, "goal"), nullptr);
  EXPECT_NEAR(find(array, "goal")->scale.x, 0.4, 1e-9);
  EXPECT_EQ(find(array, "sigma points")->points.size(), 14U);
  EXPECT_NE(find(array, "robot trajectory"), nullptr);
  EXPECT_EQ(find(planMarkers(plan, {}), "robot trajectory"), nullptr);
}

TEST(Markers, mechanismsShowEveryShape) {
  const Catalog catalog = Catalog::standard();
  const RobotModel robot = catalog.robot("cobot");
  std::size_t shapes = 0;
  for (const Link& link : robot.mechanism.links) {
    shapes += link.collision.size();
  }
  const MarkerArray array = robotMarkers(robot.mechanism);
  EXPECT_EQ(array.markers.size(), shapes + 1);
  EXPECT_EQ(array.markers.back().header.frame_id, "base_link");
}

TEST(Markers, objectsFadeWhenNotSeen) {
  const ObjectModel chair = Catalog::standard().object("office_chair");
  ObjectState state;
  state.id = "chair_1";
  state.stamp_s = 10.0;
  const MarkerArray seen = objectMarkers({{state, &chair.mechanism}}, 10.0, 1.0);
  const MarkerArray unseen = objectMarkers({{state, &chair.mechanism}}, 20.0, 1.0);
  EXPECT_LT(find(unseen, "chair_1")->color.a, find(seen, "chair_1")->color.a);
}

TEST(Markers, treeIsOneListOfLines) {
  const MarkerArray array = treeMarkers({{Pose2(0, 0, 0), Pose2(1, 0, 0)}, {Pose2(), Pose2()}});
  EXPECT_EQ(find(array, "tree")->points.size(), 4U);
}

TEST(Markers, voxelsAreColouredByHeight) {
  Map map(0.1);
  map.addSurvey({{0.05F, 0.05F, 0.05F}, {1.05F, 0.05F, 1.95F}});
  const MarkerArray array = mapMarkers(map);
  const Marker* voxels = find(array, "voxels");
  ASSERT_NE(voxels, nullptr);
  ASSERT_EQ(voxels->points.size(), 2U);
  ASSERT_EQ(voxels->colors.size(), 2U);
  const bool first_low = voxels->points[0].z < voxels->points[1].z;
  const auto& low = voxels->colors[first_low ? 0 : 1];
  const auto& high = voxels->colors[first_low ? 1 : 0];
  EXPECT_GT(low.b, low.r);
  EXPECT_GT(high.r, high.b);
  EXPECT_EQ(mapMarkers(Map(0.1)).markers.size(), 1U);
}

}  // namespace
}  // namespace casepush
