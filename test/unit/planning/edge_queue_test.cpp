#include "planning/edge_queue.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "casepush/common/random.h"

namespace casepush {
namespace {

using Push = EdgeQueue::Push;

void add(EdgeQueue* queue, int node, const std::vector<Push>& pushes) { queue->add(node, pushes); }

void expectNext(EdgeQueue* queue, int node, int push) {
  ASSERT_FALSE(queue->empty());
  EXPECT_EQ(queue->nextNode(), node);
  const EdgeQueue::Edge edge = queue->first();
  EXPECT_EQ(edge.node, node);
  EXPECT_EQ(edge.push, push);
  queue->pop();
}

TEST(EdgeQueue, givesTheMostPromisingFirst) {
  EdgeQueue queue;
  EXPECT_TRUE(queue.empty());
  add(&queue, 4, {{3.0F, 0}, {1.0F, 7}});
  add(&queue, 2, {{2.0F, 5}});
  add(&queue, 9, {});
  expectNext(&queue, 4, 7);
  expectNext(&queue, 2, 5);
  expectNext(&queue, 4, 0);
  EXPECT_TRUE(queue.empty());
}

TEST(EdgeQueue, prefersLowerNumbersWhereAllElseIsEqual) {
  EdgeQueue queue;
  add(&queue, 3, {{1.0F, 2}, {1.0F, 1}});
  add(&queue, 1, {{1.0F, 8}});
  expectNext(&queue, 1, 8);
  expectNext(&queue, 3, 1);
  expectNext(&queue, 3, 2);
}

TEST(EdgeQueue, keepsTheBestOfManyAndSaysThatThereAreMore) {
  EdgeQueue queue;
  std::vector<Push> many;
  for (int i = 0; i < 20; ++i) many.push_back({static_cast<float>(20 - i), i});
  add(&queue, 0, many);
  add(&queue, 1, {{6.5F, 3}, {7.5F, 4}});
  for (int i = 19; i > 13; --i) expectNext(&queue, 0, i);
  expectNext(&queue, 1, 3);
  expectNext(&queue, 0, EdgeQueue::kMore);
  expectNext(&queue, 1, 4);
  EXPECT_TRUE(queue.empty());
}

TEST(EdgeQueue, putsRoughOnesWhereTheyBelong) {
  EdgeQueue queue;
  add(&queue, 0, {{1.0F, 0, true}, {2.0F, 1, false}, {5.0F, 2, true}});
  add(&queue, 1, {{3.0F, 4, false}});
  EXPECT_TRUE(queue.first().is_rough);
  queue.refineFirst(4.0F);
  EXPECT_FALSE(queue.first().is_rough);
  expectNext(&queue, 0, 1);
  expectNext(&queue, 1, 4);
  EXPECT_FALSE(queue.first().is_rough);
  expectNext(&queue, 0, 0);
  EXPECT_TRUE(queue.first().is_rough);
  queue.refineFirst(5.0F);
  expectNext(&queue, 0, 2);
  EXPECT_TRUE(queue.empty());
}

TEST(EdgeQueue, leavesOutANode) {
  EdgeQueue queue;
  add(&queue, 0, {{1.0F, 0}, {4.0F, 1}});
  add(&queue, 1, {{2.0F, 0}, {3.0F, 1}});
  queue.dropFirst();
  expectNext(&queue, 1, 0);
  queue.clear();
  EXPECT_TRUE(queue.empty());
}

// Against a sorted map, with as many nodes as make several levels.
TEST(EdgeQueue, ordersWhatComesAtAnyTime) {
  Random random = Random::stream(7, "edge queue");
  EdgeQueue queue;
  std::multimap<std::pair<float, int>, int> expected;
  for (int node = 0; node < 3000; ++node) {
    std::vector<Push> pushes;
    for (int i = 0; i < node % 6; ++i) {
      pushes.push_back({static_cast<float>(random.uniform(0.0, 1e4)), i});
      expected.insert({{pushes.back().key_s, node}, i});
    }
    add(&queue, node, pushes);
    for (int i = 0; i < node % 4 && !expected.empty(); ++i) {
      expectNext(&queue, expected.begin()->first.second, expected.begin()->second);
      expected.erase(expected.begin());
    }
  }
  while (!expected.empty()) {
    expectNext(&queue, expected.begin()->first.second, expected.begin()->second);
    expected.erase(expected.begin());
  }
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace casepush
