#include "planning/scene_library.h"

#include <gtest/gtest.h>

#include "planning/furnished_room.h"

namespace casepush {
namespace {

class SceneLibraryTest : public testing::Test {
 protected:
  const Scene* get(const SceneLibrary::Obstacles& obstacles) {
    return library_
        .get("chair", obstacles,
             [this] {
               ++made_;
               return Scene{SweepChecker(checker_, classes_, 2.0), {}};
             })
        .get();
  }

  CollisionChecker checker_{*mapOf(emptyRoom())};
  std::shared_ptr<const HeightClasses> classes_ =
      SweepChecker::heightClasses(checker_, {checker_.footprint(testChair().solid)});
  SceneLibrary library_;
  int made_ = 0;
};

TEST_F(SceneLibraryTest, keepsASceneAsLongAsNothingMoves) {
  const Scene* const first = get({{"a", "chair", Pose2(1, 2, 0)}});
  EXPECT_EQ(get({{"a", "chair", Pose2(1, 2, 0)}}), first);
  EXPECT_EQ(made_, 1);
  get({{"a", "chair", Pose2(1, 2, 1e-9)}});
  get({{"b", "chair", Pose2(1, 2, 0)}});
  get({{"a", "table", Pose2(1, 2, 0)}});
  EXPECT_EQ(made_, 4);
  EXPECT_EQ(get({{"a", "chair", Pose2(1, 2, 0)}}), first);
  EXPECT_EQ(made_, 4);
}

TEST_F(SceneLibraryTest, forgetsTheOneThatWasNotUsedForLongest) {
  get({});
  for (int i = 1; i < 5; ++i) get({{"a", "chair", Pose2(i, 2, 0)}});
  EXPECT_EQ(made_, 5);
  get({{"a", "chair", Pose2(4, 2, 0)}});
  EXPECT_EQ(made_, 5);
  get({});
  EXPECT_EQ(made_, 6);
}

}  // namespace
}  // namespace casepush
