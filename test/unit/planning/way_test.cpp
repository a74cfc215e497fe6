#include "planning/way.h"

#include <gtest/gtest.h>

#include "casepush/common/random.h"
#include "planning/furnished_room.h"

namespace casepush {
namespace {

TEST(Outline, HoldsEveryPart) {
  const ObjectModel chair = testChair();
  const Shadow outline = outlineOf(chair.solid);
  for (const ConvexPart& part : convexParts(chair.solid)) {
    const BoundingDisc disc = part.disc();
    EXPECT_LE(separation(outline, disc.centre_m), 0.0) << part.name();
  }
  double farthest_m = 0.0;
  for (int i = 0; i < outline.count; ++i) {
    farthest_m = std::max(farthest_m, outline.points[i].norm());
  }
  EXPECT_GE(farthest_m, chair.radius_m - 1e-5);
  EXPECT_LE(farthest_m, 1.04 * chair.radius_m);
}

TEST(Way, AnEmptyOneIsAsFarAsAsked) {
  EXPECT_DOUBLE_EQ(Way().distance(outlineOf(testChair().solid), Pose2(), 1.5), 1.5);
}

TEST(Way, DistanceOfSquaresIsTheGapBetweenThem) {
  const Shadow square = rectangle({-0.5, -0.5}, {0.5, 0.5});
  Way way;
  way.add(square, Pose2(2.0, 0.0, 0.0));
  way.add(square, Pose2(4.0, 1.0, 0.0));
  EXPECT_NEAR(way.distance(square, Pose2(0.5, 0.0, 0.0), 3.0), 0.5, 1e-12);
  EXPECT_NEAR(way.distance(square, Pose2(1.5, 0.1, 0.0), 3.0), -0.5, 1e-12);
  EXPECT_NEAR(way.distance(square, Pose2(-5.0, 0.0, 0.0), 3.0), 3.0, 1e-12);
}

TEST(Way, IsTheNearestOfAllStations) {
  Random random(7);
  const Shadow body = outlineOf(testChair().solid);
  const auto pose = [&random] {
    const double x = random.uniform(-3.0, 3.0);
    const double y = random.uniform(-3.0, 3.0);
    return Pose2(x, y, random.uniform(-3.0, 3.0));
  };
  for (int round = 0; round < 50; ++round) {
    Way way;
    double nearest_m = 2.0;
    const Pose2 here = pose();
    for (int i = 0; i < 20; ++i) {
      const Pose2 station = pose();
      way.add(body, station);
      nearest_m =
          std::min(nearest_m, separation(transformed(station, body), transformed(here, body)));
    }
    EXPECT_NEAR(way.distance(body, here, 2.0), nearest_m, 1e-12);
  }
}

}  // namespace
}  // namespace casepush
