#include "planning/case_set.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

std::shared_ptr<const CaseSet> setOf(const std::vector<Case>& cases) {
  return std::make_shared<const CaseSet>(prepareCases(cases, 0.0, 0.05, 0.3, 0.3),
                                         PushTimeOptions{});
}

TEST(CaseChains, findsJustTheChainsThatEndInTheRegion) {
  const auto set = setOf(syntheticPushes(14, 3));
  const Pose2 goal(0.6, -0.4, -0.9);
  const GoalTolerance tolerance{0.4, 0.6};
  std::vector<const CaseChain*> found;
  set->chains.into(goal, tolerance, &found);
  int expected = 0;
  for (const PreparedCase& a : set->cases) {
    const Pose2 one = a.start_outcome.mean;
    expected += tolerance.isMet(goal, one);
    for (const PreparedCase& b : set->cases) {
      const Pose2 two = one * b.start_outcome.mean;
      expected += tolerance.isMet(goal, two);
      for (const PreparedCase& c : set->cases) {
        expected += tolerance.isMet(goal, two * c.start_outcome.mean);
      }
    }
  }
  ASSERT_GT(expected, 0);
  ASSERT_EQ(static_cast<int>(found.size()), expected);
  for (const CaseChain* chain : found) {
    Pose2 pose;
    double later_s = 0.0;
    for (int i = 0; i < chain->count; ++i) {
      pose = pose * set->cases[chain->pushes[i]].start_outcome.mean;
      if (i > 0) later_s += set->time.after(chain->pushes[i - 1], chain->pushes[i]);
    }
    EXPECT_TRUE(tolerance.isMet(goal, pose));
    EXPECT_NEAR(chain->later_s, later_s, 1e-9);
  }
}

TEST(CaseChains, manyCasesMakeShortChainsOnly) {
  EXPECT_EQ(setOf(syntheticPushes(14, 3))->chains.size(), 14U + 14U * 14U + 14U * 14U * 14U);
  EXPECT_EQ(setOf(syntheticPushes(100, 3))->chains.size(), 100U + 100U * 100U);
  EXPECT_EQ(setOf(syntheticPushes(2000, 3))->chains.size(), 2000U);
}

TEST(CaseSetLibrary, makesASetOnceAndAgainWhenACaseHasChanged) {
  CaseSetLibrary library;
  std::vector<Case> cases = syntheticPushes(4, 5);
  int made = 0;
  const auto get = [&](double zeta) {
    CaseSetLibrary::Cases pointers;
    for (const Case& push_case : cases) pointers.push_back(&push_case);
    return library.get(pointers, zeta, [&] {
      ++made;
      return setOf(cases);
    });
  };
  const auto first = get(3.0);
  EXPECT_EQ(get(3.0), first);
  EXPECT_EQ(made, 1);
  get(2.0);
  EXPECT_EQ(made, 2);
  cases[2].start_outcome.mean = Pose2(0.1, 0.2, 0.3);
  EXPECT_NE(get(3.0), first);
  EXPECT_EQ(made, 3);
}

}  // namespace
}  // namespace casepush
