#include "planning/exp_rrt.h"

#include <gtest/gtest.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/RandomNumbers.h>

#include "planning/furnished_room.h"
#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

namespace ob = ompl::base;
using Se2 = ob::SE2StateSpace;

const Pose2 kStart(3.0, 3.5, 0.3);
const Pose2 kGoal(11.5, 7.0, 1.0);

/// A planner for the furnished room, from south-west to the east side of the crossing.
class ExpRrtTest : public testing::TestWithParam<Similarity> {
 protected:
  ExpRrtTest()
      : map_(mapOf(furnishedRoom())),
        collisions_(*map_),
        checker_(collisions_, {collisions_.footprint(chair_.solid), chair_.radius_m},
                 {collisions_.footprint(robot_.solid, 0.03), robot_.radius_m + 0.03}),
        space_(makeSpace()) {}

  ob::SpaceInformationPtr makeSpace() {
    const auto se2 = std::make_shared<Se2>();
    ob::RealVectorBounds bounds(2);
    bounds.setLow(0.0);
    bounds.setHigh(15.0);
    se2->setBounds(bounds);
    const auto space = std::make_shared<ob::SpaceInformation>(se2);
    space->setStateValidityChecker([this](const ob::State* state) {
      const auto* pose = state->as<Se2::StateType>();
      return checker_.isFree(Pose2(pose->getX(), pose->getY(), pose->getYaw()));
    });
    space->setup();
    return space;
  }

  ob::ProblemDefinitionPtr problem(const Pose2& start, const Pose2& goal) const {
    const auto definition = std::make_shared<ob::ProblemDefinition>(space_);
    ob::ScopedState<Se2> state(space_);
    state->setXY(start.x(), start.y());
    state->setYaw(start.yaw());
    definition->addStartState(state);
    definition->setGoal(std::make_shared<PushGoal>(space_, goal, GoalTolerance{}));
    return definition;
  }

  std::unique_ptr<ExpRrt> planner(std::uint64_t seed, int max_nodes = 50000) {
    auto cases = std::make_shared<const CaseSet>(
        prepareCases(syntheticPushes(14, 7), 3.0, 0.025, chair_.radius_m, robot_.radius_m),
        PushTimeOptions{});
    ExpRrtOptions options;
    options.similarity = GetParam();
    options.gyration_radius_m = chair_.gyration_radius_m;
    options.seed = seed;
    options.max_nodes = max_nodes;
    auto made = std::make_unique<ExpRrt>(space_, &checker_, std::move(cases), nullptr,
                                         Pose2(-1.5, 0.0, 0.0), CanApproach(), options);
    made->setup();
    return made;
  }

  static ob::PlannerTerminationCondition afterCalls(int calls) {
    auto left = std::make_shared<int>(calls);
    return ob::PlannerTerminationCondition([left] { return (*left)-- <= 0; });
  }

  std::shared_ptr<const Map> map_;
  ObjectModel chair_ = testChair();
  RobotModel robot_ = testRobot();
  CollisionChecker collisions_;
  PushChecker checker_;
  ob::SpaceInformationPtr space_;
};

std::vector<Pose2> posesOf(const ExpRrt& planner) {
  std::vector<Pose2> poses;
  for (int id = 0; id < planner.tree().size(); ++id) {
    poses.push_back(planner.tree().node(id).map_T_object);
  }
  return poses;
}

void expectSame(const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].x(), b[i].x()) << i;
    ASSERT_EQ(a[i].yaw(), b[i].yaw()) << i;
  }
}

TEST_P(ExpRrtTest, findsAChainOfCasesToTheGoal) {
  const auto rrt = planner(1);
  const auto definition = problem(kStart, kGoal);
  rrt->setProblemDefinition(definition);
  ASSERT_EQ(rrt->solve(ob::plannerNonTerminatingCondition()), ob::PlannerStatus::EXACT_SOLUTION);
  const std::vector<int> chain = rrt->chain(rrt->solutions().front());
  ASSERT_GE(chain.size(), 8U);
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const PushNode& node = rrt->tree().node(chain[i]);
    ASSERT_EQ(node.parent, chain[i - 1]);
    const PreparedCase& push = rrt->cases()[node.push];
    const Pose2& from = rrt->tree().node(node.parent).map_T_object;
    EXPECT_NEAR(distance(node.map_T_object, from * push.start_outcome.mean), 0.0, 1e-9);
    EXPECT_EQ(checker_.conflict(push, from), PushConflict::kNone);
  }
  EXPECT_TRUE(GoalTolerance{}.isMet(kGoal, rrt->tree().node(chain.back()).map_T_object));
  const auto* path = definition->getSolutionPath()->as<ompl::geometric::PathGeometric>();
  EXPECT_EQ(path->getStateCount(), chain.size());
}

TEST_P(ExpRrtTest, stopsWhenToldAndGoesOnFromThere) {
  const auto definition = problem(kStart, kGoal);
  const auto in_one = planner(2);
  in_one->setProblemDefinition(definition);
  in_one->solve(afterCalls(12));
  const auto in_pieces = planner(2);
  in_pieces->setProblemDefinition(problem(kStart, kGoal));
  EXPECT_EQ(in_pieces->solve(ob::plannerAlwaysTerminatingCondition()), ob::PlannerStatus::TIMEOUT);
  EXPECT_EQ(in_pieces->tree().size(), 1);
  for (int i = 0; i < 4; ++i) {
    in_pieces->solve(afterCalls(3));
  }
  expectSame(posesOf(*in_one), posesOf(*in_pieces));
  EXPECT_GT(in_one->tree().size(), 5);
}

TEST_P(ExpRrtTest, clearStartsAfresh) {
  const auto rrt = planner(3);
  rrt->setProblemDefinition(problem(kStart, kGoal));
  rrt->solve(afterCalls(100));
  const std::vector<Pose2> first = posesOf(*rrt);
  rrt->clear();
  EXPECT_EQ(rrt->tree().size(), 0);
  EXPECT_TRUE(rrt->solutions().empty());
  rrt->solve(afterCalls(100));
  expectSame(first, posesOf(*rrt));
}

TEST_P(ExpRrtTest, itsSeedFixesEverything) {
  const auto a = planner(4);
  const auto b = planner(4);
  const auto other = planner(5);
  for (ExpRrt* rrt : {a.get(), b.get(), other.get()}) {
    rrt->setProblemDefinition(problem(kStart, kGoal));
    rrt->solve(afterCalls(150));
  }
  expectSame(posesOf(*a), posesOf(*b));
  bool differs = a->tree().size() != other->tree().size();
  for (int i = 0; !differs && i < a->tree().size(); ++i) {
    differs = distance(a->tree().node(i).map_T_object, other->tree().node(i).map_T_object) > 1e-6;
  }
  EXPECT_TRUE(differs);
}

TEST_P(ExpRrtTest, doesNotDependOnOmplsRandomNumbers) {
  const auto before = planner(4);
  before->setProblemDefinition(problem(kStart, kGoal));
  before->solve(afterCalls(100));
  ompl::RNG others;
  for (int i = 0; i < 1000; ++i) others.uniform01();
  const auto after = planner(4);
  after->setProblemDefinition(problem(kStart, kGoal));
  after->solve(afterCalls(100));
  expectSame(posesOf(*before), posesOf(*after));
}

TEST_P(ExpRrtTest, startsFromEveryStartStateThatIsFree) {
  const auto definition = problem(kStart, kGoal);
  for (const Pose2& start : {Pose2(7.5, 2.0, 0.0), Pose2(3.0, 10.0, 0.0)}) {
    ob::ScopedState<Se2> state(space_);
    state->setXY(start.x(), start.y());
    state->setYaw(start.yaw());
    definition->addStartState(state);
  }
  const auto rrt = planner(10);
  rrt->setProblemDefinition(definition);
  rrt->solve(ob::plannerAlwaysTerminatingCondition());
  int roots = 0;
  for (int id = 0; id < rrt->tree().size(); ++id) {
    roots += rrt->tree().node(id).parent == PushNode::kRoot ? 1 : 0;
  }
  EXPECT_EQ(roots, 2);  // The one in the wall is left out.
}

TEST_P(ExpRrtTest, plannerDataHoldsTheTree) {
  const auto rrt = planner(6);
  rrt->setProblemDefinition(problem(kStart, kGoal));
  rrt->solve(ob::plannerNonTerminatingCondition());
  ob::PlannerData data(space_);
  rrt->getPlannerData(data);
  EXPECT_EQ(data.numVertices(), static_cast<unsigned>(rrt->tree().size()));
  EXPECT_EQ(data.numEdges(), data.numVertices() - 1);
  EXPECT_EQ(data.numStartVertices(), 1U);
  EXPECT_GE(data.numGoalVertices(), 1U);
}

TEST_P(ExpRrtTest, aRejectedPushIsNotPartOfAnotherSolution) {
  const auto rrt = planner(7);
  rrt->setProblemDefinition(problem(kStart, kGoal));
  rrt->solve(ob::plannerNonTerminatingCondition());
  for (int i = 0; i < 3; ++i) {
    const int rejected = rrt->chain(rrt->solutions().front())[1];
    rrt->reject(rejected);
    if (rrt->solutions().empty()) {
      rrt->solve(ob::plannerNonTerminatingCondition());
    }
    ASSERT_FALSE(rrt->solutions().empty());
    EXPECT_NE(rrt->chain(rrt->solutions().front())[1], rejected);
  }
}

TEST_P(ExpRrtTest, endsByItselfWhenTheTreeIsFull) {
  const auto rrt = planner(8, 10);
  rrt->setProblemDefinition(problem(kStart, kGoal));
  EXPECT_EQ(rrt->solve(ob::plannerNonTerminatingCondition()), ob::PlannerStatus::TIMEOUT);
  EXPECT_EQ(rrt->tree().size(), 10);
}

TEST_P(ExpRrtTest, refusesAGoalItDoesNotKnowAndAStartInAWall) {
  const auto unknown = problem(kStart, kGoal);
  unknown->setGoal(std::make_shared<ob::GoalState>(space_));
  const auto rrt = planner(9);
  rrt->setProblemDefinition(unknown);
  EXPECT_EQ(rrt->solve(afterCalls(10)), ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE);
  rrt->clear();
  rrt->setProblemDefinition(problem(Pose2(7.5, 2.0, 0.0), kGoal));
  EXPECT_EQ(rrt->solve(afterCalls(10)), ob::PlannerStatus::INVALID_START);
}

INSTANTIATE_TEST_SUITE_P(Modes, ExpRrtTest,
                         testing::Values(Similarity::kMetric, Similarity::kPaper),
                         [](const auto& instance) {
                           return instance.param == Similarity::kMetric ? "metric" : "paper";
                         });

}  // namespace
}  // namespace casepush
