#include <algorithm>
#include <numeric>
#include <vector>

#include "casepush/execution/rearrange.h"

namespace casepush {
namespace {

constexpr int kExact = 8;  // 40 320 orders.

using Wishes = std::vector<std::pair<int, int>>;

int broken(const std::vector<int>& order, const Wishes& wishes) {
  std::vector<int> position(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) position[order[i]] = static_cast<int>(i);
  return static_cast<int>(std::count_if(wishes.begin(), wishes.end(), [&](const auto& wish) {
    return position[wish.first] > position[wish.second];
  }));
}

// Permutations come in lexicographic order, so that the first of the best is nearest to the given.
std::vector<int> bestOfAll(int count, const Wishes& wishes) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::vector<int> best = order;
  int fewest = broken(order, wishes);
  while (fewest > 0 && std::next_permutation(order.begin(), order.end())) {
    const int now = broken(order, wishes);
    if (now < fewest) {
      fewest = now;
      best = order;
    }
  }
  return best;
}

std::vector<int> leastBlockedFirst(int count, const Wishes& wishes) {
  std::vector<int> left(count);
  std::iota(left.begin(), left.end(), 0);
  std::vector<int> order;
  while (!left.empty()) {
    const auto waiting = [&](int which) {
      return std::count_if(wishes.begin(), wishes.end(), [&](const auto& wish) {
        return wish.second == which &&
               std::find(left.begin(), left.end(), wish.first) != left.end();
      });
    };
    const auto next = std::min_element(left.begin(), left.end(),
                                       [&](int a, int b) { return waiting(a) < waiting(b); });
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

}  // namespace

std::vector<int> bestOrder(int count, const Wishes& wishes) {
  return count <= kExact ? bestOfAll(count, wishes) : leastBlockedFirst(count, wishes);
}

}  // namespace casepush
