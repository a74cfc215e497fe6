#include "casepush/model/observation.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(Observation, findsObjectsById) {
  Observation observation;
  observation.objects.resize(2);
  observation.objects[0].id = "chair_1";
  observation.objects[1].id = "chair_2";
  EXPECT_EQ(observation.object("chair_2"), &observation.objects[1]);
  EXPECT_EQ(observation.object("chair_3"), nullptr);
}

}  // namespace
}  // namespace casepush
