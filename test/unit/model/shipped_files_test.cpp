// Every file in config/ loads, and the shipped worlds make sense.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "casepush/model/catalog.h"

namespace casepush {
namespace {

/// Distance on the floor from a point to a box; 0 inside.
double clearance(const StaticBox& box, const Eigen::Vector2d& map_p) {
  const Eigen::Vector3d box_p =
      box.map_T_box.inverse() * Eigen::Vector3d(map_p.x(), map_p.y(), 0.0);
  const Eigen::Vector2d outside =
      (box_p.head<2>().cwiseAbs() - 0.5 * box.box.size_m.head<2>()).cwiseMax(0.0);
  return outside.norm();
}

/// Distance from a point to the nearest box or to the border of the world.
double clearance(const WorldModel& world, const Pose2& map_T_x) {
  double nearest_m = std::min((map_T_x.position() - world.min_m).minCoeff(),
                              (world.max_m - map_T_x.position()).minCoeff());
  for (const StaticBox& box : world.boxes) {
    nearest_m = std::min(nearest_m, clearance(box, map_T_x.position()));
  }
  return nearest_m;
}

TEST(ShippedFiles, areThere) {
  const Catalog catalog = Catalog::standard();
  const std::vector<std::string> worlds = catalog.worldNames();
  EXPECT_FALSE(catalog.objectNames().empty());
  EXPECT_FALSE(catalog.robotNames().empty());
  EXPECT_EQ(std::count(worlds.begin(), worlds.end(), "office"), 1);
  EXPECT_EQ(std::count(worlds.begin(), worlds.end(), "open_floor"), 1);
  EXPECT_EQ(std::count(worlds.begin(), worlds.end(), "hospital_ward"), 1);
  EXPECT_EQ(std::count(worlds.begin(), worlds.end(), "corridor"), 1);
}

TEST(ShippedFiles, everyUrdfAndYamlLoads) {
  const Catalog catalog = Catalog::standard();
  std::set<std::filesystem::path> loaded;
  const auto load = [&](const std::string& kind, const std::string& name, bool has_urdf) {
    const std::filesystem::path stem = catalog.share() / "config" / kind / name;
    loaded.insert(stem.string() + ".yaml");
    if (has_urdf) {
      loaded.insert(stem.string() + ".urdf");
    }
  };
  for (const std::string& name : catalog.objectNames()) {
    EXPECT_NO_THROW(catalog.object(name)) << name;
    load("objects", name, true);
  }
  for (const std::string& name : catalog.robotNames()) {
    EXPECT_NO_THROW(catalog.robot(name)) << name;
    load("robots", name, true);
  }
  for (const std::string& name : catalog.worldNames()) {
    EXPECT_NO_THROW(catalog.world(name)) << name;
    load("worlds", name, false);
  }
  for (const char* kind : {"objects", "robots", "worlds"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(catalog.share() / "config" / kind)) {
      EXPECT_EQ(loaded.count(entry.path()), 1U) << entry.path() << " is read by nothing";
    }
  }
}

class ShippedWorlds : public testing::TestWithParam<std::string> {
 protected:
  Catalog catalog_ = Catalog::standard();
  WorldModel world_ = catalog_.world(GetParam());
};

TEST_P(ShippedWorlds, startPosesAreFree) {
  EXPECT_GT(clearance(world_, world_.map_T_robot), catalog_.robot(world_.robot).radius_m);
  for (const ObjectPlacement& object : world_.objects) {
    const double radius_m = catalog_.object(object.model).radius_m;
    EXPECT_GT(clearance(world_, object.map_T_object), radius_m) << object.id;
    EXPECT_GT(distance(object.map_T_object, world_.map_T_robot),
              radius_m + catalog_.robot(world_.robot).radius_m)
        << object.id;
    for (const ObjectPlacement& other : world_.objects) {
      if (other.id != object.id) {
        EXPECT_GT(distance(object.map_T_object, other.map_T_object),
                  radius_m + catalog_.object(other.model).radius_m)
            << object.id << ", " << other.id;
      }
    }
  }
  // Goals may lie under furniture: world/shipped_worlds_test.cpp checks them in three dimensions.
}

TEST_P(ShippedWorlds, noTwoObjectsShareATag) {
  std::set<int> ids;
  for (const ObjectPlacement& object : world_.objects) {
    for (const TagMount& tag : catalog_.object(object.model).tags) {
      EXPECT_TRUE(ids.insert(tag.id + object.tag_offset).second)
          << object.id << ", tag " << tag.id + object.tag_offset;
    }
  }
}

TEST_P(ShippedWorlds, standOnTheFloor) {
  for (const StaticBox& box : world_.boxes) {
    EXPECT_GE(box.map_T_box.translation().z() - 0.5 * box.box.size_m.z(), -1e-6) << box.name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedWorlds, testing::ValuesIn(Catalog::standard().worldNames()),
                         [](const auto& world) { return world.param; });

TEST(Office, hasRoomToLearnAndAGoalAroundACorner) {
  const WorldModel office = Catalog::standard().world("office");
  ASSERT_EQ(office.objects.size(), 1U);
  const Pose2 start = office.objects[0].map_T_object;
  EXPECT_GE(clearance(office, start), 3.0);
  ASSERT_TRUE(office.goal);
  EXPECT_GE(clearance(office, *office.goal),
            1.0 + Catalog::standard().object("office_chair").radius_m);
  EXPECT_EQ(office.max_m - office.min_m, Eigen::Vector2d(15.0, 15.0));

  double nearest_m = std::numeric_limits<double>::infinity();
  for (double t = 0.0; t <= 1.0; t += 0.001) {
    const Pose2 between(start.x() + t * (office.goal->x() - start.x()),
                        start.y() + t * (office.goal->y() - start.y()), 0.0);
    nearest_m = std::min(nearest_m, clearance(office, between));
  }
  EXPECT_EQ(nearest_m, 0.0) << "the straight way to the goal must be barred";
}

TEST(OfficeChair, isAnOfficeChair) {
  const ObjectModel chair = Catalog::standard().object("office_chair");
  EXPECT_EQ(chair.class_name, "chair");
  EXPECT_NEAR(chair.mechanism.massKg(), 13.0, 0.5);
  ASSERT_EQ(chair.casters.size(), 5U);
  for (const Caster& caster : chair.casters) {
    EXPECT_GE(caster.swivel_joint, 0);
    EXPECT_NEAR(caster.wheel_radius_m, 0.03, 1e-9);
    EXPECT_NEAR(caster.trail_m, 0.025, 1e-9);
    EXPECT_GT(chair.mechanism.joints[caster.swivel_joint].friction_nm, 0.0);
  }
  EXPECT_NEAR(heightRange(chair.solid).high_m, 0.95, 1e-6);
  EXPECT_LT(chair.radius_m, 0.36);
}

struct ExpectedObject {
  const char* name;
  double mass_kg;
  Eigen::Vector3d size_m;  ///< Along x, y and z.
  int swivels;
  int fixed_wheels;
};

/// Extents of a solid; casters' swept cylinders must not stick out of it.
Eigen::Vector3d sizeOf(const Solid& solid) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9);
  Eigen::Vector3d high = -low;
  for (const PlacedShape& shape : solid) {
    Eigen::Vector3d half;
    if (const auto* box = std::get_if<Box>(&shape.shape)) {
      half = 0.5 * box->size_m;
    } else {
      const auto& cylinder = std::get<Cylinder>(shape.shape);
      half << cylinder.radius_m, cylinder.radius_m, 0.5 * cylinder.length_m;
    }
    half = (shape.frame_T_shape.linear() * half).cwiseAbs();
    low = low.cwiseMin(shape.frame_T_shape.translation() - half);
    high = high.cwiseMax(shape.frame_T_shape.translation() + half);
  }
  return high - low;
}

TEST(Furniture, hasTrueDimensionsMassesAndWheels) {
  const Catalog catalog = Catalog::standard();
  for (const ExpectedObject& expected : {
           ExpectedObject{"overbed_table", 17.0, {0.785, 0.43, 0.825}, 4, 0},
           ExpectedObject{"utility_cart", 20.4, {0.8, 0.45, 0.97}, 4, 0},
           ExpectedObject{"stretcher", 116.0, {1.9, 0.9, 0.93}, 4, 0},
           ExpectedObject{"service_trolley", 40.0, {0.9, 0.55, 1.054}, 2, 2},
           ExpectedObject{"sliding_box", 5.0, {0.5, 0.4, 0.48}, 0, 0},
       }) {
    const ObjectModel object = catalog.object(expected.name);
    EXPECT_NEAR(object.mechanism.massKg(), expected.mass_kg, 1.0) << expected.name;
    EXPECT_LT((sizeOf(object.solid) - expected.size_m).cwiseAbs().maxCoeff(), 0.006)
        << expected.name << ": " << sizeOf(object.solid).transpose();
    const auto swivels =
        std::count_if(object.casters.begin(), object.casters.end(),
                      [](const Caster& caster) { return caster.swivel_joint >= 0; });
    EXPECT_EQ(swivels, expected.swivels) << expected.name;
    EXPECT_EQ(static_cast<int>(object.casters.size()) - swivels, expected.fixed_wheels);
  }
}

TEST(OverbedTable, hasABaseThatGoesUnderABed) {
  const ObjectModel table = Catalog::standard().object("overbed_table");
  Solid base;
  for (const PlacedShape& shape : table.solid) {
    if (heightRange(shape).low_m < 0.09) {
      base.push_back(shape);
    }
  }
  EXPECT_LT(heightRange(base).high_m, 0.1);
  EXPECT_GT(sizeOf(base).x(), 0.65);
}

TEST(Cobot, isWiderAtTheBasketThanAtTheBase) {
  const RobotModel robot = Catalog::standard().robot("cobot");
  EXPECT_NEAR(robot.mechanism.massKg(), 40.0, 1.0);
  std::map<std::string, double> radius_m;
  for (const PlacedShape& shape : robot.solid) {
    radius_m[shape.part] = circumscribedRadius({shape});
  }
  EXPECT_GT(radius_m.at("basket"), radius_m.at("base"));
  EXPECT_GT(radius_m.at("base"), radius_m.at("body"));
}

}  // namespace
}  // namespace casepush
