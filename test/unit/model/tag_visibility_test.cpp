// The robot must never lose sight of what it pushes.

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/model/catalog.h"
#include "model/tag_view.h"

namespace casepush {
namespace {

constexpr double kStep_rad = M_PI / 24;
// A push turns the robot by no more than this away from the direction in which it began.
constexpr double kMostTurn_rad = 1.2;

class TagVisibility : public testing::TestWithParam<std::string> {
 protected:
  /// Checks that a tag is seen at contact, from the given side and offset.
  void expectSeenAtContact(double side_rad, double offset_m, double heading_rad) const {
    const std::optional<double> contact_m = contactDistance(robot_, object_, side_rad, offset_m);
    if (!contact_m) return;
    const Pose2 object_T_robot =
        Pose2(0.0, 0.0, side_rad) * Pose2(*contact_m, offset_m, heading_rad - side_rad);
    EXPECT_GE(visibleTags(robot_, object_, object_T_robot), 1)
        << "side " << side_rad << ", offset " << offset_m << ", heading " << heading_rad
        << ": robot at (" << object_T_robot.x() << ", " << object_T_robot.y() << ")";
  }

  const Catalog catalog_ = Catalog::standard();
  const RobotModel robot_ = catalog_.robot("cobot");
  const ObjectModel object_ = catalog_.object(GetParam());
};

TEST_P(TagVisibility, someTagIsSeenAtContactFromEverySideAtEveryHeading) {
  for (double side_rad = 0.0; side_rad < 2.0 * M_PI; side_rad += kStep_rad) {
    const std::optional<double> contact_m = contactDistance(robot_, object_, side_rad);
    ASSERT_TRUE(contact_m);
    EXPECT_GT(*contact_m, 0.4);
    for (double heading_rad = 0.0; heading_rad < 2.0 * M_PI; heading_rad += kStep_rad) {
      expectSeenAtContact(side_rad, 0.0, heading_rad);
    }
  }
}

TEST_P(TagVisibility, someTagIsSeenDuringPushesThatPassTheMiddle) {
  for (double side_rad = 0.0; side_rad < 2.0 * M_PI; side_rad += kStep_rad) {
    for (const double lever : {-0.7, -0.45, -0.2, 0.2, 0.45, 0.7}) {
      for (double turn_rad = -kMostTurn_rad; turn_rad <= kMostTurn_rad; turn_rad += 0.2) {
        expectSeenAtContact(side_rad, lever * object_.radius_m, side_rad + M_PI + turn_rad);
      }
    }
  }
}

TEST_P(TagVisibility, someTagIsSeenFromAfar) {
  for (const double gap_m : {0.05, 0.3, 0.6, 1.5, 3.0, 4.2}) {
    for (double side_rad = 0.0; side_rad < 2.0 * M_PI; side_rad += kStep_rad) {
      const double distance_m = gap_m + contactDistance(robot_, object_, side_rad).value();
      for (double heading_rad = 0.0; heading_rad < M_PI / 2; heading_rad += kStep_rad) {
        const Pose2 object_T_robot(distance_m * std::cos(side_rad), distance_m * std::sin(side_rad),
                                   heading_rad);
        EXPECT_GE(visibleTags(robot_, object_, object_T_robot), 1)
            << "side " << side_rad << ", heading " << heading_rad << ", distance " << distance_m;
      }
    }
  }
}

TEST_P(TagVisibility, everyTagIsOutsideOfTheObjectAndFacesOutwards) {
  for (const TagMount& tag : object_.tags) {
    for (const double u : {-0.5, 0.0, 0.5}) {
      for (const double v : {-0.5, 0.0, 0.5}) {
        const Eigen::Vector3d near =
            tag.object_T_tag * Eigen::Vector3d(u * tag.size_m, v * tag.size_m, 0.0);
        const Eigen::Vector3d far =
            tag.object_T_tag * Eigen::Vector3d(u * tag.size_m, v * tag.size_m, -0.05);
        EXPECT_FALSE(isBlocked(object_.solid, far, near)) << "tag " << tag.id;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, TagVisibility, testing::ValuesIn(Catalog::standard().objectNames()),
                         [](const auto& object) { return object.param; });

}  // namespace
}  // namespace casepush
