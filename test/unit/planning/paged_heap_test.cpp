#include "planning/paged_heap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "casepush/common/random.h"

namespace casepush {
namespace {

std::vector<int> drained(PagedHeap<int>* heap) {
  std::vector<int> items;
  while (!heap->empty()) {
    const int least = heap->top();
    items.push_back(heap->pop());
    EXPECT_EQ(items.back(), least);
  }
  return items;
}

TEST(PagedHeap, givesTheLeastFirstOverManyPages) {
  Random random(3);
  PagedHeap<int> heap;
  std::vector<int> items;
  for (int i = 0; i < 20000; ++i) {
    items.push_back(static_cast<int>(random.below(5000)));
    heap.push(items.back());
    if (i % 3 == 0) {
      const auto least = std::min_element(items.begin(), items.end());
      ASSERT_EQ(heap.pop(), *least);
      items.erase(least);
    }
  }
  EXPECT_EQ(heap.size(), items.size());
  std::sort(items.begin(), items.end());
  EXPECT_EQ(drained(&heap), items);
}

TEST(PagedHeap, isPutInOrderAgainAfterChanges) {
  Random random(4);
  PagedHeap<int> heap;
  std::vector<int> items;
  for (int i = 0; i < 10000; ++i) heap.push(static_cast<int>(random.below(1000)));
  for (int i = 0; i < 500; ++i) heap.append(static_cast<int>(random.below(1000)));
  for (std::size_t i = 0; i < heap.size(); ++i) {
    heap[i] = 7 * heap[i] % 1000;
    items.push_back(heap[i]);
    heap.settle(i);
  }
  std::sort(items.begin(), items.end());
  EXPECT_EQ(drained(&heap), items);
}

}  // namespace
}  // namespace casepush
