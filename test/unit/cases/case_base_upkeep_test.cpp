#include <algorithm>

#include "case_fixtures.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;

class CaseBaseUpkeep : public ::testing::Test {
 protected:
  // Everything that is stored of a case.
  struct Everything {
    Case push_case;
    std::vector<ObservedOutcome> history;
  };
  static Everything everything(const CaseBase& base, std::int64_t id) {
    return {base.get(id), base.history(id)};
  }
  static void expectSame(const Everything& a, const Everything& b) {
    expectSameCase(a.push_case, b.push_case);
    expectSameTube(a.push_case, b.push_case);
    expectSameHistory(a.history, b.history);
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "cases.db";
  CaseBase base_{file_, Access::kCreate};
  Random random_{1};
};

TEST_F(CaseBaseUpkeep, keepsWhatIsKnownOfEachObservation) {
  Case push_case = recordedCase(1);
  push_case.context = {7.5, "carpet"};
  const std::int64_t id = base_.add(push_case, 12.25);
  ObservedPush push = practice(push_case, random_);
  push.context = {80.0, "vinyl"};
  base_.observe(id, push, {0.003, 0.02});
  const std::vector<ObservedOutcome> history = base_.history(id);
  EXPECT_EQ(history[0].stamp_s, 12.25);
  EXPECT_EQ(history[0].context, push_case.context);
  EXPECT_TRUE(history[0].path.empty()) << "the first trial is in the steps";
  EXPECT_EQ(history[1].stamp_s, push.stamp_s);
  EXPECT_EQ(history[1].context, push.context);
  EXPECT_EQ(history[1].noise.yaw_rad, 0.02);
  EXPECT_EQ(history[1].path.size(), push.steps.size());
  EXPECT_EQ(base_.get(id).context, push_case.context);
}

TEST_F(CaseBaseUpkeep, badPushesAreRefusedAndNothingIsStored) {
  const std::int64_t id = base_.add(recordedCase(2));
  const Everything before = everything(base_, id);
  const auto refusal = [&](void (*spoil)(ObservedPush&)) {
    ObservedPush push = practice(before.push_case, random_);
    spoil(push);
    return inputErrorOf([&] { base_.observe(id, push, {}); });
  };
  expectRefusal(refusal([](ObservedPush& p) {
                  p.steps[2].start_T_object = {1e3, 0, 0};
                }),
                file_, "case 1: observed steps[2].start_T_object: is at (1000, 0)");
  expectRefusal(refusal([](ObservedPush& p) { p.stamp_s = std::nan(""); }), file_,
                "observed stamp is not finite");
  expectRefusal(refusal([](ObservedPush& p) { p.context.load_kg = -1.0; }), file_,
                "observed: load_kg: is -1; must be in [0, 10000] kg");
  expectRefusal(refusal([](ObservedPush& p) { p.context.floor = "a\nb"; }), file_,
                "observed: floor: holds a control character");
  expectSame(everything(base_, id), before);
}

TEST_F(CaseBaseUpkeep, undoTakesObservationsBackOneByOne) {
  const Case push_case = recordedCase(3);
  const std::int64_t id = base_.add(push_case);
  std::vector<Everything> states{everything(base_, id)};
  for (int i = 0; i < 12; ++i) {
    if (i % 4 == 3) {
      base_.adapt(id, practice(push_case, random_, 0.5), 0.1, {}, {});
    } else if (i % 4 == 2) {
      base_.observe(id, restingAt(randomPose(random_)), {0.01, 0.02});
    } else {
      base_.observe(id, practice(push_case, random_), {});
    }
    states.push_back(everything(base_, id));
  }
  for (std::size_t i = states.size() - 1; i > 0; --i) {
    const Case undone = base_.undo(id);
    expectSameTube(undone, states[i - 1].push_case);
    expectSame(everything(base_, id), states[i - 1]);
  }
  expectRefusal(inputErrorOf([&] { base_.undo(id); }), file_,
                "case 1: has no observation that can be taken back; remove the case instead");
  expectRefusal(inputErrorOf([&] { base_.undo(99); }), file_, "case 99: does not exist");
}

TEST_F(CaseBaseUpkeep, aCopyIsAdaptedAndTheOriginalKept) {
  const std::int64_t id = base_.add(recordedCase(4));
  base_.observe(id, practice(recordedCase(4), random_), {});
  const Everything original = everything(base_, id);
  const std::int64_t loaded = base_.copy(id, {20.0, ""});
  ASSERT_NE(loaded, id);
  EXPECT_EQ(base_.get(loaded).source_id, id);
  EXPECT_EQ(base_.get(loaded).context.load_kg, 20.0);
  expectSameHistory(base_.history(loaded), original.history);
  base_.adapt(loaded, practice(recordedCase(4), random_, 0.4), 0.0, {}, {});
  expectSame(everything(base_, id), original);
  EXPECT_EQ(base_.count(), 2);
  base_.undo(loaded);
  expectSameTube(base_.get(loaded), original.push_case);
}

TEST_F(CaseBaseUpkeep, theNearestContextOfEachFamilyIsUsed) {
  const std::int64_t a = base_.add(recordedCase(5));
  const std::int64_t b = base_.add(recordedCase(6));
  const std::int64_t a10 = base_.copy(a, {10.0, ""});
  const std::int64_t a30 = base_.copy(a10, {30.0, "carpet"});
  const auto used = [&](const PushContext& context) {
    std::vector<std::int64_t> ids;
    for (const Case& push_case : inContext(base_.cases(), context)) {
      ids.push_back(push_case.id);
    }
    return ids;
  };
  using Ids = std::vector<std::int64_t>;
  EXPECT_EQ(used({}), (Ids{a, b}));
  EXPECT_EQ(used({4.0, ""}), (Ids{a, b}));
  EXPECT_EQ(used({6.0, ""}), (Ids{b, a10}));
  EXPECT_EQ(used({60.0, ""}), (Ids{b, a30}));
  EXPECT_EQ(used({60.0, "vinyl"}), (Ids{b, a10})) << "another floor is farther than any load";
  base_.remove(a);
  EXPECT_EQ(used({}), (Ids{b, a10})) << "a family may lose its first member";
}

TEST_F(CaseBaseUpkeep, learningGoesOnWithCasesOfItsOwnContextOnly) {
  const std::int64_t a = base_.add(recordedCase(5));
  const std::int64_t a10 = base_.copy(a, {10.0, ""});
  const auto learnt = [&](const PushContext& context) {
    std::vector<std::int64_t> ids;
    for (const Case& push_case : learntIn(base_.cases(), context)) {
      ids.push_back(push_case.id);
    }
    return ids;
  };
  using Ids = std::vector<std::int64_t>;
  EXPECT_EQ(learnt({}), Ids{a});
  EXPECT_EQ(learnt({0.0, "vinyl"}), Ids{a}) << "an unknown floor counts as any";
  EXPECT_EQ(learnt({10.0, ""}), Ids{a10});
  EXPECT_EQ(learnt({9.0, ""}), Ids{});
}

TEST_F(CaseBaseUpkeep, pruneRemovesWhatTheRuleNames) {
  const auto store = [&](std::uint64_t seed, const Pose2& outcome, double sigma_m, int count) {
    Case push_case = recordedCase(seed);
    push_case.steps.front().object_T_robot = {-0.5, 0.01 * static_cast<double>(seed), 0.0};
    push_case.start_outcome.mean = outcome;
    push_case.start_outcome.covariance =
        Eigen::Vector3d(sigma_m, sigma_m, 0.05).cwiseAbs2().asDiagonal();
    push_case.observation_count = count;
    push_case.effective_count = count;
    return base_.add(push_case);
  };
  const std::int64_t good = store(1, {0.5, 0.0, 0.1}, 0.05, 20);
  const std::int64_t still = store(2, {0.01, 0.01, 0.02}, 0.05, 20);
  const std::int64_t wild = store(3, {0.5, 0.3, 0.0}, 0.6, 20);
  const std::int64_t new_and_wild = store(4, {0.5, -0.3, 0.0}, 0.6, 2);
  const std::int64_t same = store(5, {0.51, 0.01, 0.12}, 0.05, 10);
  const std::int64_t turning = store(6, {0.01, 0.0, 0.5}, 0.05, 20);
  const std::int64_t other_start = store(60, {0.5, 0.0, 0.1}, 0.05, 20);
  const std::int64_t loaded = base_.copy(good, {5.0, ""});
  const std::vector<UselessCase> pruned = base_.prune("", {});
  ASSERT_EQ(pruned.size(), 3u);
  EXPECT_EQ(pruned[0].id, still);
  EXPECT_NE(pruned[0].reason.find("hardly moves the object: 0.0141 m"), std::string::npos);
  EXPECT_EQ(pruned[1].id, wild);
  EXPECT_EQ(pruned[1].reason, "is too uncertain: 0.6 m and 0.05 rad after 20 observations");
  EXPECT_EQ(pruned[2].id, same);
  EXPECT_EQ(pruned[2].reason, "does the same as case " + std::to_string(good));
  std::vector<std::int64_t> left;
  for (const Case& push_case : base_.cases()) {
    left.push_back(push_case.id);
  }
  EXPECT_EQ(left, (std::vector<std::int64_t>{good, new_and_wild, turning, other_start, loaded}));
  EXPECT_TRUE(base_.prune("", {}).empty());
  PruneOptions bad;
  bad.least_motion_m = -1.0;
  EXPECT_NE(inputErrorOf([&] { base_.prune("", bad); }).find("prune: least_motion_m: is -1"),
            std::string::npos);
}

class CaseBaseMerge : public CaseBaseUpkeep {
 protected:
  CaseBase other_{folder_ / "other.db", Access::kCreate};
};

TEST_F(CaseBaseMerge, takesNewCasesWithAllThatIsKnown) {
  base_.add(recordedCase(1));
  const std::int64_t id = other_.add(recordedCase(2, 20, "table"), 4.5);
  other_.observe(id, practice(recordedCase(2, 20), random_), {});
  const std::int64_t copy = other_.copy(id, {5.0, "vinyl"});
  const MergeResult result = base_.merge(other_);
  EXPECT_EQ(result.added, 2);
  EXPECT_EQ(result.extended + result.unchanged, 0);
  expectSame(everything(base_, 2), everything(other_, id));
  expectSame(everything(base_, 3), everything(other_, copy));
  EXPECT_EQ(base_.get(3).source_id, 2) << "also under new ids";
  const MergeResult again = base_.merge(other_);
  EXPECT_EQ(again.added + again.extended, 0);
  EXPECT_EQ(again.unchanged, 2);
}

TEST_F(CaseBaseMerge, poolsWhatTwoBasesLearntOfTheSameCase) {
  const Case push_case = recordedCase(3);
  const std::int64_t id = base_.add(push_case);
  base_.observe(id, practice(push_case, random_), {});
  base_.exportYaml(folder_ / "shared.yaml");
  other_.importYaml(folder_ / "shared.yaml");
  std::vector<ObservedPush> pushes;
  for (int i = 0; i < 6; ++i) {
    pushes.push_back(practice(push_case, random_));
    (i < 3 ? base_ : other_).observe(1, pushes.back(), {});
  }
  const MergeResult result = base_.merge(other_);
  EXPECT_EQ(result.extended, 1);
  EXPECT_EQ(result.observations, 3);
  const Case merged = base_.get(id);
  EXPECT_EQ(merged.observation_count, 8);
  EXPECT_EQ(merged.effective_count, 8.0);

  CaseBase direct(folder_ / "direct.db", Access::kCreate);
  direct.importYaml(folder_ / "shared.yaml");
  for (const ObservedPush& push : pushes) {
    direct.observe(1, push, {});
  }
  expectSame(everything(direct, 1), everything(base_, id));
  EXPECT_EQ(base_.merge(other_).unchanged, 1) << "nothing is counted twice";
  EXPECT_EQ(base_.undo(id).observation_count, 7);
}

}  // namespace
}  // namespace casepush
