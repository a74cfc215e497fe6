#include "planning/sweep_library.h"

#include <gtest/gtest.h>

#include "casepush/planning/push_checker.h"
#include "world/random_motion.h"

namespace casepush {
namespace {

class SweepLibraryTest : public testing::Test {
 protected:
  SweepLibraryTest()
      : random_(3),
        checker_(mapOf(randomRoom(&random_, 5.0, 6), 0.05)),
        object_(checker_.footprint(overbedTable())),
        robot_(checker_.footprint(roundRobot())),
        classes_(SweepChecker::heightClasses(checker_, {object_, robot_})),
        sweeps_(checker_, classes_, 4.0) {}

  std::vector<PreparedCase> randomCases(int count) {
    std::vector<PreparedCase> cases(count);
    for (PreparedCase& push_case : cases) {
      const RandomMotion motion = randomMotion(&random_, 12);
      push_case.object_path = motion.object;
      push_case.robot_path = motion.robot;
      push_case.start_T_sigma = motion.ends;
      push_case.start_outcome.mean = motion.object.back();
    }
    return cases;
  }

  void attach(SweepLibrary* library, std::vector<PreparedCase>* cases) {
    library->attach(classes_, object_, robot_, cases);
  }

  /// Tests every case at a few places.
  void use(const std::vector<PreparedCase>& cases, int places) {
    for (const PreparedCase& push_case : cases) {
      for (int i = 0; i < places; ++i) {
        const Pose2 start = randomPose(&random_, 0.5, 4.5);
        ASSERT_EQ(sweeps_.collides(*push_case.sweep, start),
                  sweeps_.collidesPoseByPose(*push_case.sweep, start));
      }
    }
  }

  Random random_;
  CollisionChecker checker_;
  std::shared_ptr<const Footprint> object_;
  std::shared_ptr<const Footprint> robot_;
  std::shared_ptr<const HeightClasses> classes_;
  SweepChecker sweeps_;
};

constexpr std::size_t kPlenty = 1000000000;

TEST_F(SweepLibraryTest, keepsTheSweepOfTheSameCaseAndMakesAnotherForAnotherOutcome) {
  SweepLibrary library(kPlenty);
  std::vector<PreparedCase> cases = randomCases(2);
  attach(&library, &cases);
  const auto before = cases[0].sweep;
  cases[1].start_outcome.mean = Pose2(0.3, 0.0, 0.1);
  attach(&library, &cases);
  EXPECT_EQ(cases[0].sweep, before);
  EXPECT_NE(cases[1].sweep, before);
}

TEST_F(SweepLibraryTest, letsACheckerSayQuicklyWhatIsCertainlyFree) {
  SweepLibrary library(kPlenty);
  std::vector<PreparedCase> cases = randomCases(4);
  attach(&library, &cases);
  PushChecker checker(sweeps_, {object_, 1.0}, {robot_, 1.0});
  int free = 0;
  int doubtful = 0;
  for (int i = 0; i < 2000; ++i) {
    const PreparedCase& push_case = cases[i % cases.size()];
    const Pose2 start = randomPose(&random_, 0.5, 4.5);
    const bool is_safe = checker.isSafe(push_case, start);
    const bool may_collide = checker.mayCollide(push_case, start);
    EXPECT_TRUE(is_safe || may_collide) << i;
    free += is_safe ? 1 : 0;
    doubtful += is_safe && may_collide ? 1 : 0;
  }
  EXPECT_GT(free, 100);
  EXPECT_LT(doubtful, 150);
}

TEST_F(SweepLibraryTest, masksOfManyCasesStayWithinTheMemory) {
  constexpr std::size_t kLimit = 2000000;
  constexpr std::size_t kOneMore = 200000;
  SweepLibrary library(kLimit);
  std::vector<PreparedCase> cases = randomCases(60);
  attach(&library, &cases);
  use(cases, 20);
  EXPECT_GT(library.usedBytes(), kLimit * 3 / 4);
  EXPECT_LT(library.usedBytes(), kLimit + kOneMore);
}

TEST_F(SweepLibraryTest, whatWasNotUsedForLongestMakesRoom) {
  SweepLibrary library(2000000);
  std::vector<PreparedCase> old = randomCases(60);
  attach(&library, &old);
  use(old, 20);
  std::vector<PreparedCase> fresh = randomCases(2);
  attach(&library, &fresh);
  old.clear();
  use(fresh, 20);
  for (const PreparedCase& push_case : fresh) EXPECT_GT(push_case.sweep->bytes(), 0U);
  const auto kept = fresh[0].sweep;
  old = randomCases(1);
  attach(&library, &old);
  attach(&library, &fresh);
  EXPECT_EQ(fresh[0].sweep, kept);
}

TEST_F(SweepLibraryTest, withoutMemoryEverythingIsTestedPoseByPose) {
  SweepLibrary library(0);
  std::vector<PreparedCase> cases = randomCases(2);
  attach(&library, &cases);
  use(cases, 20);
  EXPECT_EQ(library.usedBytes(), 0U);
}

}  // namespace
}  // namespace casepush
