// The shipped worlds, in three dimensions: what stands on what, and what fits where.

#include <gtest/gtest.h>

#include "casepush/model/catalog.h"
#include "casepush/world/collision_checker.h"
#include "casepush/world/shadow.h"
#include "casepush/world/static_map.h"

namespace casepush {
namespace {

constexpr double kMargin_m = 0.02;

Map surveyOf(const WorldModel& world) {
  Map map(0.05);
  map.addSurvey(surveyPoints(world, 0.05));
  return map;
}

class ShippedWorlds : public testing::TestWithParam<std::string> {
 protected:
  std::string contactsOf(const Solid& solid, const Pose2& pose) const {
    std::string text;
    for (const Contact& contact : checker_.contacts(*checker_.footprint(solid, kMargin_m), pose)) {
      text += describe(contact, checker_.obstacles()) + "; ";
    }
    return text;
  }

  const Catalog catalog_ = Catalog::standard();
  const WorldModel world_ = loadWorld(catalog_, GetParam());
  CollisionChecker checker_{surveyOf(world_)};
};

TEST_P(ShippedWorlds, nothingOverlapsAtTheStart) {
  for (const ObjectPlacement& object : world_.objects) {
    std::vector<PlacedSolid> others{
        {catalog_.robot(world_.robot).solid, world_.map_T_robot, "robot"}};
    for (const ObjectPlacement& other : world_.objects) {
      if (other.id == object.id) continue;
      others.push_back({catalog_.object(other.model).solid, other.map_T_object, other.id});
    }
    checker_.setObstacles(others);
    EXPECT_EQ(contactsOf(catalog_.object(object.model).solid, object.map_T_object), "")
        << object.id;
  }
  checker_.setObstacles({});
  EXPECT_EQ(contactsOf(catalog_.robot(world_.robot).solid, world_.map_T_robot), "");
}

TEST_P(ShippedWorlds, theGoalIsFree) {
  if (!world_.goal) return;
  ASSERT_FALSE(world_.objects.empty());
  std::vector<PlacedSolid> others;
  for (std::size_t i = 1; i < world_.objects.size(); ++i) {
    const ObjectPlacement& other = world_.objects[i];
    others.push_back({catalog_.object(other.model).solid, other.map_T_object, other.id});
  }
  checker_.setObstacles(others);
  EXPECT_EQ(contactsOf(catalog_.object(world_.objects[0].model).solid, *world_.goal), "");
}

INSTANTIATE_TEST_SUITE_P(All, ShippedWorlds, testing::ValuesIn(Catalog::standard().worldNames()),
                         [](const auto& world) { return world.param; });

TEST(HospitalWard, onlyTheOverbedTableGoesUnderABed) {
  const Catalog catalog = Catalog::standard();
  const WorldModel ward = loadWorld(catalog, "hospital_ward");
  const CollisionChecker checker{surveyOf(ward)};
  const auto fits = [&](const std::string& object, double under_m) {
    // From the east side of the second bed, whose edge is at x = 5.075 m, front ahead.
    const ObjectModel model = catalog.object(object);
    double front_m = 0.0;
    for (const PlacedShape& shape : model.solid) {
      if (heightRange(shape).low_m > 0.3) continue;
      const ConvexPart part(shape);
      for (int i = 0; i < part.shadow().count; ++i) {
        front_m = std::max(front_m, part.shadow().points[i].x() + part.shadow().radius_m);
      }
    }
    return !checker.collides(*checker.footprint(model.solid),
                             Pose2(5.075 - under_m + front_m, 7.4, M_PI));
  };
  EXPECT_TRUE(fits("overbed_table", 0.4));
  EXPECT_FALSE(fits("overbed_table", 0.6)) << "its cover must stay outside";
  for (const char* other : {"office_chair", "utility_cart", "service_trolley", "sliding_box"}) {
    EXPECT_TRUE(fits(other, -0.1)) << other;
    EXPECT_FALSE(fits(other, 0.4)) << other;
  }
}

}  // namespace
}  // namespace casepush
