#include "casepush/execution/exploration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "../../../src/execution/push_predictor.h"
#include "casepush/common/input_error.h"
#include "execution/fake_world.h"
#include "execution/learnt_cases.h"

namespace casepush {
namespace {

using Verdict = Exploration::Verdict;

ExplorationOptions options(int cases, int practices, std::uint64_t seed = 1) {
  return test::explorationOptions(cases, practices, seed);
}

// The loop of a caller: executes pushes in the fake world and stores in memory.
struct Learner : test::LearntCases {
  explicit Learner(const ExplorationOptions& given)
      : exploration(test::fakeObject(), test::fakeRobot(), given), seed(given.seed) {}

  Verdict once(const Exploration::Trial& trial) {
    test::FakeWorld world(1000 * seed + pushes++);
    world.scatter = scatter;
    world.robot = trial.object_T_robot;
    ExecutePush push = trial.case_id ? makeReplay(cases.at(*trial.case_id)) : makeTrial(trial);
    test::run(push, world);
    return judge(trial, *push.report());
  }

  Verdict judge(const Exploration::Trial& trial, const PushReport& report) {
    return LearntCases::judge(exploration, trial, report);
  }

  void all(int max_pushes) {
    while (const auto trial = exploration.next()) {
      ASSERT_LT(pushes, max_pushes);
      once(*trial);
    }
  }

  ExecutePush makeReplay(const Case& push_case) const {
    return {"chair_1", push_case, test::fakeRobot(), straight, ExecutePushOptions{}};
  }
  ExecutePush makeTrial(const Exploration::Trial& trial) const {
    return {"chair_1", trial.configuration, test::fakeRobot(), straight, ExecutePushOptions{}};
  }
  static RobotPath straight(const Observation& observation, const Pose2& goal, double) {
    return test::pathThrough({observation.map_T_robot, goal});
  }

  Exploration exploration;
  std::uint64_t seed;
  int pushes = 0;
  double scatter = 0.05;
};

PushReport failedReport() {
  PushReport report;
  report.outcome = PushOutcome::kApproachFailed;
  return report;
}

PushReport reportOf(const Pose2& outcome) {
  PushReport report;
  report.outcome = PushOutcome::kDone;
  Case& recorded = report.recorded;
  for (int i = 0; i <= 10; ++i) {
    CaseStep step;
    step.object_T_robot = Pose2(-0.7, 0.0, 0.0);
    step.start_T_object = Pose2(0.05 * i, 0.0, 0.0);
    recorded.steps.push_back(step);
  }
  recorded.push_steps = 11;
  recorded.start_outcome.mean = outcome;
  recorded.start_outcome.covariance = 1e-4 * Eigen::Matrix3d::Identity();
  recorded.effective_count = 1.0;
  recorded.observation_count = 1;
  return report;
}

TEST(Exploration, learnsASetThatSpansDirectionsLengthsAndTurns) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Learner learner(options(14, 6, seed));
    learner.all(400);
    const ExplorationQuality quality = learner.exploration.quality();
    EXPECT_TRUE(learner.exploration.finished());
    EXPECT_FALSE(learner.exploration.gaveUp());
    EXPECT_EQ(learner.cases.size(), 14u);
    EXPECT_EQ(quality.cases, 14);
    EXPECT_EQ(quality.complete_cases, 14);
    EXPECT_EQ(quality.observations, 14 * 6);
    EXPECT_LT(quality.widest_gap_rad, 1.6);
    EXPECT_GE(quality.left_turns, 2);
    EXPECT_GE(quality.right_turns, 2);
    EXPECT_GT(quality.longest_m, 1.5 * quality.shortest_m);
    EXPECT_LE(quality.max_position_sigma_m, 0.2);
    EXPECT_LT(learner.pushes, 14 * 6 + 80);
    for (const auto& [id, push_case] : learner.cases) {
      EXPECT_NO_THROW(validateCase(push_case, "case"));
      EXPECT_EQ(push_case.observation_count, 6);
    }
  }
}

TEST(Exploration, nextIsTheSameUntilJudgedAndDeterministic) {
  const Exploration a(test::fakeObject(), test::fakeRobot(), options(14, 20, 5));
  const Exploration b(test::fakeObject(), test::fakeRobot(), options(14, 20, 5));
  const Exploration c(test::fakeObject(), test::fakeRobot(), options(14, 20, 6));
  const auto first = a.next();
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->case_id);
  EXPECT_EQ(first->case_number, 1);
  EXPECT_EQ(first->practice_number, 1);
  EXPECT_DOUBLE_EQ(a.next()->configuration.speed_mps, first->configuration.speed_mps);
  EXPECT_DOUBLE_EQ(b.next()->configuration.speed_mps, first->configuration.speed_mps);
  EXPECT_NE(c.next()->configuration.speed_mps, first->configuration.speed_mps);
  EXPECT_NEAR(distance(first->object_T_robot, first->configuration.object_T_robot), 0.0, 1e-12);
}

TEST(Exploration, practisesEachCaseBeforeTheNext) {
  Learner learner(options(3, 4));
  int last_number = 0;
  int last_practice = 0;
  while (const auto trial = learner.exploration.next()) {
    if (trial->case_number == last_number && trial->practice_number > 1) {
      EXPECT_TRUE(trial->case_id);
      EXPECT_EQ(trial->practice_number, last_practice + 1);
    } else {
      EXPECT_FALSE(trial->case_id);
      EXPECT_EQ(trial->practice_number, 1);
    }
    last_number = trial->case_number;
    last_practice = trial->practice_number;
    learner.once(*trial);
  }
  EXPECT_EQ(last_number, 3);
  EXPECT_EQ(last_practice, 4);
}

// The report that a trial brings if the object ends up where it is expected to.
PushReport asExpected(const Exploration::Trial& trial) {
  const PushPredictor predictor(test::fakeObject(), test::fakeRobot());
  return reportOf(predictor.predict(trial.configuration));
}

TEST(Exploration, discardsUselessAndFailedTrials) {
  Exploration exploration(test::fakeObject(), test::fakeRobot(), options(14, 1));
  EXPECT_EQ(exploration.judge(*exploration.next(), failedReport()), Verdict::kDiscard);
  EXPECT_EQ(exploration.judge(*exploration.next(), reportOf(Pose2(0.05, 0.0, 0.1))),
            Verdict::kDiscard);
  EXPECT_EQ(exploration.judge(*exploration.next(), asExpected(*exploration.next())),
            Verdict::kStoreCase);
  exploration.stored(1);
  EXPECT_EQ(exploration.discarded(), 2);
}

TEST(Exploration, aKnownOutcomeIsDiscardedUntilNothingElseComes) {
  Exploration exploration(test::fakeObject(), test::fakeRobot(), options(14, 1));
  const Pose2 known(0.5, 0.0, 0.0);
  ASSERT_EQ(exploration.judge(*exploration.next(), reportOf(known)), Verdict::kStoreCase);
  exploration.stored(1);
  EXPECT_EQ(exploration.judge(*exploration.next(), reportOf(Pose2(0.52, 0.02, 0.02))),
            Verdict::kDiscard);
  // What is asked for relaxes with each such trial.
  int tries = 0;
  while (exploration.judge(*exploration.next(), reportOf(Pose2(0.6, 0.1, 0.0))) ==
         Verdict::kDiscard) {
    ASSERT_LT(++tries, 60);
  }
  EXPECT_GT(tries, 0);
}

TEST(Exploration, atRandomKnownOutcomesAreKept) {
  ExplorationOptions random = options(14, 1);
  random.coverage = CoverageStrategy::kRandom;
  Exploration exploration(test::fakeObject(), test::fakeRobot(), random);
  for (int i = 1; i <= 3; ++i) {
    ASSERT_EQ(exploration.judge(*exploration.next(), reportOf(Pose2(0.5, 0.0, 0.0))),
              Verdict::kStoreCase);
    exploration.stored(i);
  }
}

TEST(Exploration, dropsACaseThatIsTooUncertainAndReplacesIt) {
  Learner learner(options(2, 10));
  learner.scatter = 0.0;
  ASSERT_EQ(learner.once(*learner.exploration.next()), Verdict::kStoreCase);
  int practices = 1;
  Verdict verdict = Verdict::kObserve;
  while (verdict == Verdict::kObserve) {
    const auto trial = learner.exploration.next();
    ASSERT_TRUE(trial && trial->case_id);
    const double side = practices % 2 == 0 ? 0.5 : -0.5;
    verdict = learner.judge(*trial, reportOf(Pose2(0.5, side, 0.0)));
    if (learner.cases.empty()) {
      verdict = Verdict::kDropCase;
    }
    ++practices;
  }
  EXPECT_EQ(verdict, Verdict::kDropCase);
  EXPECT_EQ(practices, 5);
  EXPECT_EQ(learner.exploration.dropped(), 1);
  const auto next = learner.exploration.next();
  ASSERT_TRUE(next);
  EXPECT_FALSE(next->case_id);
  EXPECT_EQ(next->case_number, 1);
}

TEST(Exploration, dropsACaseThatCanNotBeRepeated) {
  Learner learner(options(2, 10));
  ASSERT_EQ(learner.once(*learner.exploration.next()), Verdict::kStoreCase);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(learner.exploration.judge(*learner.exploration.next(), failedReport()),
              Verdict::kDiscard);
  }
  EXPECT_EQ(learner.exploration.judge(*learner.exploration.next(), failedReport()),
            Verdict::kDropCase);
}

TEST(Exploration, resumesWhereItStopped) {
  Learner whole(options(4, 5));
  for (int i = 0; i < 8; ++i) {
    whole.once(*whole.exploration.next());
  }
  std::vector<Case> cases;
  for (const auto& [id, push_case] : whole.cases) {
    cases.push_back(push_case);
  }
  ASSERT_FALSE(cases.empty());
  Learner resumed(options(4, 5));
  resumed.cases = whole.cases;
  resumed.last_id = whole.last_id;
  resumed.exploration.resume(cases);
  const auto expected = whole.exploration.next();
  const auto next = resumed.exploration.next();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->case_id, expected->case_id);
  EXPECT_EQ(next->case_number, expected->case_number);
  EXPECT_EQ(next->practice_number, expected->practice_number);
  resumed.all(200);
  EXPECT_EQ(resumed.cases.size(), 4u);

  std::vector<Case> complete;
  for (const auto& [id, push_case] : resumed.cases) {
    complete.push_back(push_case);
  }
  Exploration done(test::fakeObject(), test::fakeRobot(), options(4, 5));
  done.resume(complete);
  EXPECT_TRUE(done.finished());
  EXPECT_FALSE(done.next());
}

PushReport lostReport() {
  PushReport report;
  report.outcome = PushOutcome::kObjectLost;
  return report;
}

TEST(Exploration, aBlindRobotStopsWithoutDroppingAnything) {
  Learner learner(options(2, 3));
  learner.all(100);
  ASSERT_EQ(learner.cases.size(), 2U);
  Exploration later(test::fakeObject(), test::fakeRobot(), options(2, 10));
  std::vector<Case> known;
  for (const auto& [id, push_case] : learner.cases) {
    known.push_back(push_case);
  }
  later.resume(known);
  int pushes = 0;
  while (later.next()) {
    ASSERT_EQ(later.judge(*later.next(), lostReport()), Verdict::kDiscard);
    ASSERT_LT(++pushes, 50);
  }
  EXPECT_TRUE(later.gaveUp());
  EXPECT_EQ(later.dropped(), 0);
  EXPECT_EQ(later.quality().cases, 2);
  EXPECT_NE(later.explanation().find("out of sight"), std::string::npos);
}

TEST(Exploration, losingSightIsNoFaultOfANewCase) {
  Learner learner(options(1, 20));
  learner.once(*learner.exploration.next());
  while (learner.cases.empty()) {
    learner.once(*learner.exploration.next());
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(learner.exploration.judge(*learner.exploration.next(), lostReport()),
              Verdict::kDiscard);
  }
  EXPECT_EQ(learner.exploration.dropped(), 0);
}

TEST(Exploration, casesOfEarlierRunsAreSetAsideInsteadOfDropped) {
  Learner learner(options(1, 3));
  learner.all(100);
  Exploration later(test::fakeObject(), test::fakeRobot(), options(1, 10));
  later.resume({learner.cases.begin()->second});
  for (int i = 0; i < 20 && later.next(); ++i) {
    ASSERT_EQ(later.judge(*later.next(), failedReport()), Verdict::kDiscard);
  }
  EXPECT_TRUE(later.finished());
  EXPECT_EQ(later.dropped(), 0);
}

TEST(Exploration, ignoresCasesOfOtherRobots) {
  Learner learner(options(1, 3));
  learner.all(100);
  Case foreign = learner.cases.begin()->second;
  foreign.robot = "another";
  Exploration later(test::fakeObject(), test::fakeRobot(), options(1, 3));
  later.resume({foreign});
  EXPECT_EQ(later.quality().cases, 0);
}

TEST(Exploration, givesUpAfterTooManyFailures) {
  ExplorationOptions few = options(14, 20);
  few.max_failures = 7;
  Exploration exploration(test::fakeObject(), test::fakeRobot(), few);
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(exploration.next());
    exploration.judge(*exploration.next(), failedReport());
  }
  EXPECT_FALSE(exploration.next());
  EXPECT_TRUE(exploration.gaveUp());
  EXPECT_TRUE(exploration.finished());
}

TEST(Exploration, refusesBadOptions) {
  ExplorationOptions bad;
  bad.cases = 0;
  bad.max_speed_mps = 0.1;
  try {
    bad.validate();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "exploration options: cases is 0, must be in [1, 1000]; max_speed_mps is 0.1, "
                 "must be in [0.15, 5]");
  }
  ExplorationOptions fast;
  fast.min_speed_mps = 0.46;
  fast.max_speed_mps = 0.9;
  EXPECT_THROW(Exploration(test::fakeObject(), test::fakeRobot(), fast), InputError);
}

TEST(Exploration, leavesTheRobotSpeedToCatchUp) {
  ExplorationOptions options;
  options.max_speed_mps = 5.0;
  for (int seed = 1; seed <= 40; ++seed) {
    options.seed = seed;
    const Exploration exploration(test::fakeObject(), test::fakeRobot(), options);
    EXPECT_LE(exploration.next()->configuration.speed_mps, 0.45);
  }
}

}  // namespace
}  // namespace casepush
