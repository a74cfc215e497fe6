// The robot must never lose sight of what it pushes.

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/model/catalog.h"
#include "model/tag_view.h"

namespace casepush {
namespace {

constexpr double kStep_rad = M_PI / 24;

class TagVisibility : public testing::Test {
 protected:
  const Catalog catalog_ = Catalog::standard();
  const RobotModel robot_ = catalog_.robot("cobot");
  const ObjectModel chair_ = catalog_.object("office_chair");
};

TEST_F(TagVisibility, someTagIsSeenAtContactFromEverySideAtEveryHeading) {
  for (double side_rad = 0.0; side_rad < 2.0 * M_PI; side_rad += kStep_rad) {
    const double contact_m = contactDistance(robot_, chair_, side_rad);
    EXPECT_GT(contact_m, 0.4);
    for (double heading_rad = 0.0; heading_rad < 2.0 * M_PI; heading_rad += kStep_rad) {
      const Pose2 chair_T_robot(contact_m * std::cos(side_rad), contact_m * std::sin(side_rad),
                                heading_rad);
      EXPECT_GE(visibleTags(robot_, chair_, chair_T_robot), 1)
          << "side " << side_rad << ", heading " << chair_T_robot.yaw() << ", distance "
          << contact_m;
    }
  }
}

TEST_F(TagVisibility, someTagIsSeenFromAfar) {
  for (const double distance_m : {0.7, 0.9, 1.2, 2.0, 3.5, 5.0}) {
    for (double side_rad = 0.0; side_rad < 2.0 * M_PI; side_rad += kStep_rad) {
      for (double heading_rad = 0.0; heading_rad < M_PI / 2; heading_rad += kStep_rad) {
        const Pose2 chair_T_robot(distance_m * std::cos(side_rad), distance_m * std::sin(side_rad),
                                  heading_rad);
        EXPECT_GE(visibleTags(robot_, chair_, chair_T_robot), 1)
            << "side " << side_rad << ", heading " << heading_rad << ", distance " << distance_m;
      }
    }
  }
}

TEST_F(TagVisibility, everyTagIsOutsideOfTheObjectAndFacesOutwards) {
  for (const TagMount& tag : chair_.tags) {
    for (const double u : {-0.5, 0.0, 0.5}) {
      for (const double v : {-0.5, 0.0, 0.5}) {
        const Eigen::Vector3d near =
            tag.object_T_tag * Eigen::Vector3d(u * tag.size_m, v * tag.size_m, 0.0);
        const Eigen::Vector3d far =
            tag.object_T_tag * Eigen::Vector3d(u * tag.size_m, v * tag.size_m, -0.05);
        EXPECT_FALSE(isBlocked(chair_.solid, far, near)) << "tag " << tag.id;
      }
    }
  }
}

}  // namespace
}  // namespace casepush
