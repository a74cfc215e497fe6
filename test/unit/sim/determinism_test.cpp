// The same seed and the same commands, step by step, give the same world bit by bit: again, after a
// reset, and however many steps are taken at once.

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/driving.h"

namespace casepush {
namespace {

constexpr int kStepsPerSecond = 240;

INSTANTIATE_TEST_SUITE_P(Models, SimulatorModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

/// A room so small that the robot, which wanders about, keeps on pushing things.
WorldModel smallRoom() {
  WorldModel world = test::makeWorld();
  world.map_T_robot = Pose2(-1.5, 0.0, 0.0);
  world.objects.push_back({"cart_1", "cart", Pose2(-0.5, 0.1, 0.4), 0});
  world.objects.push_back({"cart_2", "cart", Pose2(0.6, 0.5, -1.0), 10});
  world.objects.push_back({"crate_1", "crate", Pose2(0.3, -0.6, 0.2), 20});
  world.objects[1].load = Load{15.0, {0.1, 0.0}};
  for (int side = -1; side <= 1; side += 2) {
    const std::string name = side < 0 ? "low" : "high";
    world.boxes.push_back(test::makeBox(name + "_x", {0.1, 4.2, 1.0}, side * 2.1, 0.0));
    world.boxes.push_back(test::makeBox(name + "_y", {4.2, 0.1, 1.0}, 0.0, side * 1.6));
  }
  return world;
}

/// Commands are due at every twelfth step, but for half a second now and then.
bool isDue(const Simulator& simulator) {
  const std::int64_t step = simulator.stepCount();
  const bool silent = step / (kStepsPerSecond / 2) % 15 == 7;
  return step % 12 == 0 && !silent;
}

/// Runs after one object for three seconds, turning, and then after the next. Beyond limits where
/// it is far away.
Twist2 chase(const Simulator& simulator) {
  const auto& objects = simulator.world().objects;
  const auto seconds = static_cast<std::size_t>(simulator.stepCount() / kStepsPerSecond);
  const std::string& id = objects[seconds / 3 % objects.size()].id;
  const Eigen::Vector2d way =
      (simulator.trueRobotPose().inverse() * simulator.trueObjectPose(id)).position();
  return {0.8 * way.x(), 0.8 * way.y(), seconds % 2 == 0 ? 0.4 : -0.3};
}

/// Hash over the whole way, looked at once a second.
/// @param batch  Steps at a time, where no command comes in between.
std::uint64_t wander(Simulator& simulator, int seconds, int batch) {
  std::uint64_t hash = kHashStart;
  simulator.setScanning(true);
  const std::int64_t end = std::int64_t{kStepsPerSecond} * seconds;
  while (simulator.stepCount() < end) {
    const std::int64_t step = simulator.stepCount();
    if (isDue(simulator)) simulator.setCommand(chase(simulator));
    if (step == end / 3) simulator.setLoad("crate_1", {40.0, {0.05, -0.1}});
    if (step == end / 2) simulator.setLoad("cart_2", {});
    const std::int64_t to_command = 12 - step % 12;
    simulator.step(static_cast<int>(std::min<std::int64_t>(batch, to_command)));
    if (simulator.stepCount() % kStepsPerSecond == 0) hash = hashOf(simulator, hash);
  }
  return hash;
}

int contactPairs(Simulator& simulator, int seconds) {
  for (int step = 0; step < kStepsPerSecond * seconds; step += 12) {
    if (isDue(simulator)) simulator.setCommand(chase(simulator));
    simulator.step(12);
  }
  return static_cast<int>(simulator.takeContacts().size());
}

TEST_P(SimulatorModels, repeatAMinuteBitByBitAlsoAfterAReset) {
  constexpr int kSeconds = 60;
  Simulator first = makeSimulator(smallRoom(), 7, options());
  const std::uint64_t hash = wander(first, kSeconds, 12);
  Simulator second = makeSimulator(smallRoom(), 8, options());
  EXPECT_GT(contactPairs(second, 20), 4);  // Of the room it is busy in.
  second.setLoad("cart_1", {30.0});
  second.reset(7);
  EXPECT_EQ(second.stepCount(), 0);
  EXPECT_EQ(wander(second, kSeconds, 12), hash);
}

TEST_P(SimulatorModels, areTheSameHoweverManyStepsAreTakenAtOnce) {
  constexpr int kSeconds = 6;
  Simulator simulator = makeSimulator(smallRoom(), 3, options());
  const std::uint64_t hash = wander(simulator, kSeconds, 12);
  for (const int batch : {1, 5}) {
    simulator.reset(3);
    EXPECT_EQ(wander(simulator, kSeconds, batch), hash) << batch;
  }
  simulator.reset(4);
  EXPECT_NE(wander(simulator, kSeconds, 12), hash);
}

TEST_P(SimulatorModels, areTheSameWhetherAnybodyLooks) {
  Simulator watched = makeSimulator(smallRoom(), 3, options());
  Simulator unwatched = makeSimulator(smallRoom(), 3, options());
  for (int i = 0; i < 100; ++i) {
    watched.setCommand({0.4, 0.0, 0.3});
    unwatched.setCommand({0.4, 0.0, 0.3});
    watched.step(5);
    unwatched.step(5);
    hashOf(watched);
    watched.commandFault({9.0, 0.0, 0.0});
  }
  unwatched.takeTagFrames();
  unwatched.takeContacts();
  EXPECT_EQ(hashOf(watched), hashOf(unwatched));
}

}  // namespace
}  // namespace casepush
