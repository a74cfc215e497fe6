#include "casepush/cases/transfer.h"

#include <Eigen/LU>

#include "case_fixtures.h"
#include "casepush/cases/observed_push.h"

namespace casepush {
namespace {

ObjectModel boxObject(const std::string& name, double length_m, double width_m, double mass_kg) {
  ObjectModel object;
  object.name = name;
  object.class_name = "cart";
  Link link;
  link.mass_kg = mass_kg;
  object.mechanism.links.push_back(link);
  PlacedShape shape;
  shape.shape = Box{{length_m, width_m, 1.0}};
  object.solid.push_back(shape);
  object.radius_m = circumscribedRadius(object.solid);
  return object;
}

// A push along x from behind, 0.1 m beside the middle.
Case knownCase(double outcome_sigma_m = 0.02, double outcome_sigma_rad = 0.04) {
  Case push_case = recordedCase(1, 11, "small");
  push_case.id = 7;
  for (int i = 0; i <= 10; ++i) {
    push_case.steps[i].object_T_robot = Pose2(-0.7, 0.1, 0.0);
    push_case.steps[i].start_T_object = Pose2(0.06 * i, 0.0, 0.0);
  }
  push_case.start_outcome.mean = {0.6, 0.0, 0.0};
  push_case.start_outcome.covariance =
      Eigen::Vector3d(outcome_sigma_m, outcome_sigma_m, outcome_sigma_rad).cwiseAbs2().asDiagonal();
  push_case.effective_count = 20.0;
  push_case.observation_count = 20;
  push_case.context.load_kg = 3.0;
  return push_case;
}

const ObjectModel kSmall = boxObject("small", 0.6, 0.4, 20.0);
const ObjectModel kLarge = boxObject("large", 0.9, 0.6, 30.0);

TEST(ObjectDissimilarity, isSymmetricAndZeroForEquals) {
  EXPECT_EQ(objectDissimilarity(kSmall, kSmall), 0.0);
  EXPECT_NEAR(objectDissimilarity(kSmall, kLarge), 2.0 * std::log(1.5), 1e-12);
  EXPECT_NEAR(objectDissimilarity(kLarge, kSmall), 2.0 * std::log(1.5), 1e-12);
  ObjectModel other = kSmall;
  other.class_name = "chair";
  EXPECT_EQ(objectDissimilarity(kSmall, other), 0.5);
}

TEST(ProposeCases, startUncertainLightAndWithTheirOrigin) {
  const Case known = knownCase();
  const std::vector<Case> proposed = proposeCases({known}, kSmall, kLarge, {});
  ASSERT_EQ(proposed.size(), 1u);
  const Case& push_case = proposed[0];
  EXPECT_EQ(push_case.object, "large");
  EXPECT_EQ(push_case.origin, CaseOrigin::kTransferred);
  EXPECT_EQ(push_case.source_id, 7);
  EXPECT_EQ(push_case.observation_count, 0);
  EXPECT_EQ(push_case.context, known.context);
  EXPECT_LT(push_case.effective_count, 0.2);
  EXPECT_GT(push_case.start_outcome.covariance(0, 0), 0.1 * 0.1);
  EXPECT_GT(push_case.start_outcome.covariance.determinant(),
            known.start_outcome.covariance.determinant());
  EXPECT_NO_THROW(validateCase(push_case, ""));
}

TEST(ProposeCases, putTheRobotJustBehindTheNewObject) {
  const Case push_case = proposeCases({knownCase()}, kSmall, kLarge, {})[0];
  const Pose2& start = push_case.steps.front().object_T_robot;
  EXPECT_NEAR(start.x(), -0.7 - 0.15, 1e-12) << "half of the difference in length";
  EXPECT_NEAR(start.y(), 0.1 * 1.5, 1e-12) << "as far beside the middle, in proportion";
  EXPECT_EQ(start.yaw(), 0.0);
}

TEST(ProposeCases, onlyForSimilarObjectsAndFromPractisedCases) {
  const ObjectModel heavy = boxObject("heavy", 0.6, 0.4, 200.0);
  EXPECT_TRUE(proposeCases({knownCase()}, kSmall, heavy, {}).empty());
  TransferOptions any;
  any.largest_dissimilarity = 10.0;
  EXPECT_EQ(proposeCases({knownCase()}, kSmall, heavy, any).size(), 1u);
  Case guess = knownCase();
  guess.origin = CaseOrigin::kTransferred;
  guess.observation_count = 0;
  Case foreign = knownCase();
  foreign.object = "chair";
  EXPECT_TRUE(proposeCases({guess, foreign}, kSmall, kLarge, {}).empty());
  any.base_m = 0.0;
  EXPECT_NE(inputErrorOf([&] { proposeCases({}, kSmall, kLarge, any); }), "");
}

// Less similar objects give wider and lighter priors.
TEST(ProposeCases, trustLessWhatIsLessSimilar) {
  const ObjectModel larger = boxObject("larger", 1.1, 0.8, 40.0);
  const Case near = proposeCases({knownCase()}, kSmall, kLarge, {})[0];
  const Case far = proposeCases({knownCase()}, kSmall, larger, {})[0];
  EXPECT_GT(far.start_outcome.covariance(0, 0), near.start_outcome.covariance(0, 0));
  EXPECT_LT(far.effective_count, near.effective_count);
}

// -log of the predicted density of what is observed next, up to a constant.
double surprise(const Case& push_case, const Pose2& next) {
  const Eigen::Vector3d e = logSe2(push_case.start_outcome.mean.inverse() * next);
  const Eigen::Matrix3d& s = push_case.start_outcome.covariance;
  return 0.5 * (std::log(s.determinant()) + e.dot(s.inverse() * e));
}

// The new object's true mean is off by what the proposal expects; it scatters as the known one.
TEST(ProposeCases, practisingSharpensThemFastAndFasterThanFromScratch) {
  Random random(1);
  constexpr int kRuns = 400;
  constexpr int kPractices = 5;
  double transferred[kPractices + 1] = {};
  double scratch[kPractices + 1] = {};
  double log_ratio[kPractices + 1] = {};
  for (int run = 0; run < kRuns; ++run) {
    Case push_case = proposeCases({knownCase()}, kSmall, kLarge, {})[0];
    const Eigen::Matrix3d true_scatter = knownCase().start_outcome.covariance;
    const Pose2 true_mean = push_case.start_outcome.mean * randomPose(random, 0.2, 0.15);
    const auto outcome = [&] { return true_mean * randomPose(random, 0.02, 0.04); };
    Case fresh = push_case;
    for (int k = 0; k <= kPractices; ++k) {
      const Pose2 next = outcome();
      transferred[k] += surprise(push_case, next) / kRuns;
      log_ratio[k] +=
          std::log(push_case.start_outcome.covariance.determinant() / true_scatter.determinant()) /
          6.0 / kRuns;
      if (k > 0) {
        scratch[k] += surprise(fresh, next) / kRuns;
      }
      const Pose2 observed = outcome();
      push_case = withObservation(push_case, observed, {}, push_case.effective_count, {});
      fresh = withObservation(fresh, observed, {}, k == 0 ? 0.0 : fresh.effective_count, {});
    }
  }
  EXPECT_GT(std::exp(log_ratio[0]), 4.0) << "unpractised: standard deviations much too large";
  for (int k = 1; k <= kPractices; ++k) {
    EXPECT_GT(std::exp(log_ratio[k]), 0.8) << k << ": standard deviations about right";
    EXPECT_LT(std::exp(log_ratio[k]), 2.0) << k << ": standard deviations about right";
    EXPECT_LT(transferred[k], transferred[k - 1] + 0.2) << k;
    EXPECT_LT(transferred[k], scratch[k]) << k;
  }
}

TEST(TransferredCase, takesOverTheTrajectoriesOfItsFirstPush) {
  TemporaryFolder folder;
  CaseBase base(folder / "cases.db", CaseBase::Access::kCreate);
  Random random(2);
  const Case proposed = proposeCases({knownCase()}, kSmall, kLarge, {})[0];
  const std::int64_t id = base.add(proposed);
  EXPECT_TRUE(base.history(id).empty());
  const ObservedPush push = practice(recordedCase(9, 25), random);
  const Case practised = base.observe(id, push, {});
  EXPECT_EQ(practised.steps.size(), push.steps.size());
  EXPECT_EQ(practised.push_steps, push.push_steps);
  expectSamePose(practised.steps[3].object_T_robot, push.steps[3].object_T_robot);
  EXPECT_EQ(practised.observation_count, 1);
  expectSameCase(base.get(id), practised);
  expectSameTube(base.get(id), practised);
  expectRefusal(inputErrorOf([&] { base.undo(id); }), folder / "cases.db",
                "no observation that can");
  const Case before = base.get(id);
  base.observe(id, practice(recordedCase(9, 25), random), {});
  const Case undone = base.undo(id);
  expectSameCase(undone, before);
  expectSameTube(undone, before);
  EXPECT_EQ(base.history(id)[0].source, OutcomeSource::kPractised);
}

}  // namespace
}  // namespace casepush
