#include "planning/push_tree.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

PushNode node(double x, double cost_s, int parent, int push = 0) {
  return {Pose2(x, 1.0, 0.0), parent, push, cost_s};
}

PushTree makeTree(int cases) { return PushTree({0, 0}, {10, 10}, 0.3, 0.1, cases); }

TEST(PushTree, keepsOnlyTheCheaperOfTwoNodesAtAPoseGrowing) {
  PushTree tree = makeTree(2);
  const int root = tree.add(node(0.0, 0.0, PushNode::kRoot), true);
  const int first = tree.add(node(1.0, 20.0, root), true);
  EXPECT_EQ(tree.add(node(1.01, 20.0, root), true), -1);
  const int cheaper = tree.add(node(1.01, 10.0, root), true);
  ASSERT_GE(cheaper, 0);
  EXPECT_FALSE(tree.isOpen(first));
  EXPECT_TRUE(tree.isOpen(cheaper));
  EXPECT_EQ(tree.open().size(), 2);
}

TEST(PushTree, closesANodeWhoseCasesWereAllTried) {
  PushTree tree = makeTree(2);
  const int root = tree.add(node(0.0, 0.0, PushNode::kRoot), true);
  tree.markTried(root, 1);
  EXPECT_TRUE(tree.isOpen(root));
  EXPECT_TRUE(tree.isTried(root, 1));
  EXPECT_FALSE(tree.isTried(root, 0));
  tree.markTried(root, 0);
  EXPECT_FALSE(tree.isOpen(root));
  EXPECT_FALSE(tree.hasOpen());
}

TEST(PushTree, removesAWholeSubtree) {
  PushTree tree = makeTree(3);
  const int root = tree.add(node(0.0, 0.0, PushNode::kRoot), true);
  const int a = tree.add(node(1.0, 1.0, root), true);
  const int b = tree.add(node(2.0, 1.0, root), true);
  const int below_a = tree.add(node(3.0, 2.0, a), true);
  const int goal_below_a = tree.add(node(4.0, 3.0, below_a), false);
  tree.removeSubtree(a);
  EXPECT_TRUE(tree.isRemoved(a));
  EXPECT_TRUE(tree.isRemoved(below_a));
  EXPECT_TRUE(tree.isRemoved(goal_below_a));
  EXPECT_TRUE(tree.isOpen(root));
  EXPECT_TRUE(tree.isOpen(b));
  EXPECT_EQ(tree.open().size(), 2);
}

TEST(PushTree, givesWhatWasTurnedDownANewChanceAfterARemoval) {
  PushTree tree = makeTree(2);
  const int root = tree.add(node(0.0, 0.0, PushNode::kRoot), true);
  const int costly = tree.add(node(1.0, 20.0, root), true);
  const int cheap = tree.add(node(1.0, 10.0, root), true);
  tree.markPostponed(root, 0);
  tree.markTried(root, 1);
  EXPECT_FALSE(tree.isOpen(root));
  EXPECT_FALSE(tree.isOpen(costly));
  tree.removeSubtree(cheap);
  EXPECT_TRUE(tree.isOpen(root));
  EXPECT_FALSE(tree.isTried(root, 0));
  EXPECT_TRUE(tree.isTried(root, 1));
  EXPECT_TRUE(tree.isOpen(costly));
}

TEST(PushTree, neverExtendsANodeInTheGoal) {
  PushTree tree = makeTree(1);
  const int root = tree.add(node(0.0, 0.0, PushNode::kRoot), true);
  const int goal = tree.add(node(1.0, 1.0, root), false);
  EXPECT_FALSE(tree.isOpen(goal));
  tree.removeSubtree(tree.add(node(2.0, 1.0, root), true));
  EXPECT_FALSE(tree.isOpen(goal));
}

}  // namespace
}  // namespace casepush
