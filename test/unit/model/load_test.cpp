#include "casepush/model/load.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/model/catalog.h"
#include "common/input_error_text.h"

namespace casepush {
namespace {

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// A tray of 0.6 m x 0.4 m, 0.7 to 0.75 m high, on a post, with a ball beside it, and a log that
/// lies along x.
Mechanism makeTable() {
  Mechanism table;
  Link link;
  link.name = "table";
  link.mass_kg = 10.0;
  link.collision.push_back({Box{{0.6, 0.4, 0.05}}, at(0.0, 0.0, 0.725), "table"});
  link.collision.push_back({Cylinder{0.03, 0.7}, at(0.0, 0.0, 0.35), "table"});
  link.collision.push_back({Sphere{0.1}, at(0.6, 0.0, 0.1), "table"});
  Eigen::Isometry3d lying = at(0.0, 0.5, 0.1);
  lying.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()));
  link.collision.push_back({Cylinder{0.1, 0.4}, lying, "table"});
  table.links.push_back(link);
  return table;
}

double heightOf(double x_m, double y_m) {
  Load load{10.0, {x_m, y_m}, std::nullopt, {0.2, 0.2, 0.1}};
  return *placedLoad(load, makeTable(), "here").height_m;
}

std::string errorOf(const Load& load) {
  return inputErrorText([&] { placedLoad(load, makeTable(), "here"); });
}

TEST(Load, standsOnTheHighestSurface) {
  EXPECT_NEAR(heightOf(0.0, 0.0), 0.75 + 0.05, 1e-12);
  EXPECT_NEAR(heightOf(-0.29, 0.19), 0.75 + 0.05, 1e-12);
  EXPECT_NEAR(heightOf(0.6, 0.0), 0.2 + 0.05, 1e-12);
  EXPECT_NEAR(heightOf(0.66, 0.0), 0.1 + 0.08 + 0.05, 1e-12);
  EXPECT_NEAR(heightOf(0.19, 0.5), 0.2 + 0.05, 1e-12);
  EXPECT_NEAR(heightOf(0.0, 0.56), 0.1 + 0.08 + 0.05, 1e-12);
}

TEST(Load, keepsAHeightThatIsGiven) {
  Load load{10.0, {0.1, 0.0}, 0.4, {0.2, 0.2, 0.1}};
  const Load placed = placedLoad(load, makeTable(), "here");
  EXPECT_EQ(placed.height_m, 0.4);
  EXPECT_EQ(placed.mass_kg, 10.0);
}

TEST(Load, ofNoMassIsNone) {
  const Load placed = placedLoad({0.0, {9.0, 9.0}}, makeTable(), "here");
  EXPECT_EQ(placed.mass_kg, 0.0);
}

TEST(Load, hasTheInertiaOfABox) {
  const Load load{12.0, {0.1, 0.0}, 0.4, {0.1, 0.2, 0.3}};
  EXPECT_LT((inertiaOf(load).diagonal() - Eigen::Vector3d(0.13, 0.10, 0.05)).norm(), 1e-12);
}

TEST(Load, refusesWhatCannotBe) {
  const double nan = std::nan("");
  EXPECT_EQ(errorOf({81.0}), "here: the mass is 81 kg; must be in [0, 80] kg");
  EXPECT_EQ(errorOf({-1.0}), "here: the mass is -1 kg; must be in [0, 80] kg");
  EXPECT_EQ(errorOf({nan}), "here: the mass is nan kg; must be in [0, 80] kg");
  EXPECT_EQ(errorOf({10.0, {0.0, 0.0}, std::nullopt, {0.2, 0.0, 0.2}}),
            "here: the size is (0.2   0 0.2) m; each must be in [0.01, 3] m");
  EXPECT_EQ(errorOf({10.0, {0.4, 0.0}}),
            "here: the place (0.4, 0) m in the object's frame is outside of the object's "
            "footprint; must be above or below one of its collision shapes, which span x -0.3 to "
            "0.7, y -0.2 to 0.6");
  EXPECT_NE(errorOf({10.0, {0.31, 0.0}}), "");
  EXPECT_NE(errorOf({10.0, {0.71, 0.0}}), "");
  EXPECT_NE(errorOf({10.0, {0.21, 0.5}}), "");
  EXPECT_NE(errorOf({10.0, {nan, 0.0}}), "");
  EXPECT_EQ(errorOf({10.0, {0.0, 0.0}, 0.05, {0.2, 0.2, 0.2}}),
            "here: the height of the centre is 0.05 m; must be in [0.09, 0.86] m: above the floor, "
            "and standing on the object at the most");
  EXPECT_NE(errorOf({10.0, {0.0, 0.0}, 0.9, {0.2, 0.2, 0.2}}), "");
  EXPECT_NE(errorOf({10.0, {0.0, 0.0}, nan, {0.2, 0.2, 0.2}}), "");
}

TEST(Load, liesOnTheTopOfEveryShippedObject) {
  const Catalog catalog = Catalog::standard();
  for (const std::string& name : catalog.objectNames()) {
    const Load placed = placedLoad({40.0}, catalog.object(name).mechanism, name);
    EXPECT_GT(*placed.height_m, 0.1) << name;
    if (name == "overbed_table") {
      EXPECT_NEAR(*placed.height_m, 0.825 + 0.1, 1e-9);
    }
  }
}

}  // namespace
}  // namespace casepush
