#include "casepush/ros/collision_counter.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

WorldModel roomWithWall() {
  WorldModel world;
  world.boxes.resize(1);
  world.boxes[0].name = "wall";
  return world;
}

BodyContactArray contact(double stamp_s, const std::string& a, const std::string& b) {
  BodyContactArray message;
  message.header.stamp = ros::Time(stamp_s);
  message.contacts.resize(1);
  message.contacts[0].body_a = a;
  message.contacts[0].part_a = "part_a";
  message.contacts[0].body_b = b;
  message.contacts[0].part_b = "part_b";
  return message;
}

TEST(CollisionCounter, countsTouchesOfWhatNeverMoves) {
  CollisionCounter counter(roomWithWall());
  counter.add(contact(1.0, "chair_1", "robot"));
  EXPECT_TRUE(counter.touches().empty());
  counter.add(contact(1.0, "wall", "chair_1"));
  ASSERT_EQ(counter.touches().size(), 1U);
  EXPECT_EQ(counter.touches()[0], "chair_1/part_b - wall");
}

TEST(CollisionCounter, countsAnUninterruptedTouchOnce) {
  CollisionCounter counter(roomWithWall());
  for (int i = 0; i < 20; ++i) {
    counter.add(contact(1.0 + 0.02 * i, "robot", "wall"));
  }
  EXPECT_EQ(counter.touches().size(), 1U);
  counter.add(contact(2.0, "robot", "wall"));
  EXPECT_EQ(counter.touches().size(), 2U);
}

}  // namespace
}  // namespace casepush
