#include "casepush/ros/image_tally.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

void addImages(ImageTally& tally, double period_s, double delay_s) {
  for (double stamp_s = 5.0; stamp_s < 6.0; stamp_s += period_s) {
    tally.add("front", stamp_s, stamp_s + delay_s);
  }
}

TEST(ImageTally, isContentWithImagesThatComeOftenAndSoon) {
  ImageTally tally;
  EXPECT_EQ(tally.complaint(), "");
  addImages(tally, 0.1, 0.05);
  EXPECT_EQ(tally.complaint(), "");
  EXPECT_EQ(tally.complaint(), "");
}

TEST(ImageTally, tellsOfImagesThatComeTooSeldom) {
  ImageTally tally;
  addImages(tally, 0.5, 0.05);
  EXPECT_EQ(tally.complaint(), "front sends 2 images a second, pushing needs 10");
  EXPECT_EQ(tally.complaint(), "") << "told twice";
  tally.add("front", 6.0, 6.05);  // The only one since: the interval before it counts.
  EXPECT_EQ(tally.complaint(), "front sends 2 images a second, pushing needs 10");
}

TEST(ImageTally, tellsOfImagesThatComeTooLate) {
  ImageTally tally;
  addImages(tally, 0.1, 0.05);
  tally.add("rear", 5.9, 6.42);
  EXPECT_EQ(tally.complaint(), "rear's images come 0.52 s late, pushing needs 0.1");
}

TEST(ImageTally, takesAClockThatJumpsBack) {
  ImageTally tally;
  tally.add("front", 100.0, 100.05);
  addImages(tally, 0.1, 0.05);
  EXPECT_EQ(tally.complaint(), "");
}

}  // namespace
}  // namespace casepush
