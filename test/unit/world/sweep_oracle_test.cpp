#include <gtest/gtest.h>

#include "casepush/world/fcl_checker.h"
#include "world/random_motion.h"

namespace casepush {
namespace {

bool fclCollides(const FclChecker& fcl, const FclChecker::Body& object,
                 const FclChecker::Body& robot, const RandomMotion& motion, const Pose2& start) {
  const auto any = [&](const FclChecker::Body& body, const std::vector<Pose2>& poses) {
    for (const Pose2& pose : poses) {
      if (fcl.collides(body, start * pose)) return true;
    }
    return false;
  };
  return any(object, motion.ends) || any(robot, motion.robot) || any(object, motion.object);
}

// The oracle knows nothing of columns, masks or shadows.
TEST(SweepOracleTest, agreesWithFclOverTenThousandMotions) {
  if (!FclChecker::isAvailable()) GTEST_SKIP() << "built without FCL";
  Random random(7);
  const FclChecker::Body object(leaningSolid());
  const FclChecker::Body robot(roundRobot());
  const FclChecker::Body small_object(leaningSolid(), 1e-4);
  const FclChecker::Body small_robot(roundRobot(), 1e-4);
  const FclChecker::Body large_object(leaningSolid(), -1e-4);
  const FclChecker::Body large_robot(roundRobot(), -1e-4);
  int hits = 0;
  int extra = 0;
  int contacts = 0;
  for (int scene = 0; scene < 5; ++scene) {
    const Map map = mapOf(randomRoom(&random, 6.0, 12), 0.05);
    const CollisionChecker checker(map);
    const auto object_print = checker.footprint(leaningSolid());
    const auto robot_print = checker.footprint(roundRobot());
    const auto classes = SweepChecker::heightClasses(checker, {object_print, robot_print});
    const SweepChecker sweeps(checker, classes, 4.0);
    const FclChecker fcl(map);
    for (int m = 0; m < 10; ++m) {
      const RandomMotion motion = randomMotion(&random, 8);
      const Sweep sweep(tracksOf(motion, object_print, robot_print), classes);
      for (int i = 0; i < 200; ++i) {
        const Pose2 start = randomPose(&random, 0.5, 5.5);
        const bool exact = sweeps.collides(sweep, start);
        const bool truth = fclCollides(fcl, object, robot, motion, start);
        const bool may = sweeps.mayCollide(sweep, start);
        hits += truth;
        extra += may && !exact;
        ASSERT_TRUE(may || !exact);
        if (exact == truth) continue;
        // Iterative solvers answer contacts within their tolerance either way.
        ++contacts;
        ASSERT_NE(fclCollides(fcl, small_object, small_robot, motion, start),
                  fclCollides(fcl, large_object, large_robot, motion, start))
            << start.x() << " " << start.y() << " " << start.yaw() << " ours " << exact;
      }
    }
  }
  std::cout << hits << " of 10000 collide, " << contacts << " contacts, masks alone " << extra
            << " more\n";
  EXPECT_GT(hits, 3000);
  EXPECT_LT(hits, 9000);
  EXPECT_LT(contacts, 20);
}

}  // namespace
}  // namespace casepush
