#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace casepush {

/// Dijkstra's algorithm in whole numbers over the eight neighbours of a grid's cells, with a ring
/// of buckets for a queue (Dial 1969). With an estimate of the way that is left it is A*: cells
/// towards some place come first. It can be ended and gone on with.
class GridFlood {
 public:
  static constexpr int kUnreached = std::numeric_limits<int>::max();

  /// @param stride  Cells from row to row; no way may lead over the grid's rim.
  /// @param longest_step  No step costs more, the growth of the estimate included.
  GridFlood(int cells, int stride, int longest_step)
      : steps_{1, -1, stride, -stride, stride + 1, stride - 1, -stride + 1, -stride - 1},
        distance_(cells, kUnreached) {
    int size = 1;
    while (size <= longest_step) size *= 2;
    first_.assign(size, kNone);
  }

  /// As new, with the room for its queue kept.
  void clear() {
    std::fill(distance_.begin(), distance_.end(), kUnreached);
    std::fill(first_.begin(), first_.end(), kNone);
    waiting_.clear();
    free_ = kNone;
    left_ = 0;
    now_ = 0;
    limit_ = kUnreached;
  }

  /// @param estimate  Of the cell; all cells that are begun with have the same.
  void begin(int cell, int estimate = 0) {
    if (distance_[cell] == 0) return;
    now_ = estimate;
    reach(cell, 0, estimate);
  }

  /// Nothing is reached from now on that lies as far or farther.
  void setLimit(int distance) { limit_ = distance; }

  /// @param cost  Of a step to a cell from its neighbour, straight or diagonal, > 0; 0 if there is
  ///   no way.
  /// @param goes_on  Asked for each cell with its distance once that is final; where it says no,
  ///   another call goes on.
  /// @param estimate  Of a cell, >= 0; no step makes it smaller by more than the step costs. Always
  ///   the same.
  /// @return  The distance where it ended; without an estimate, what is as far or farther may not
  ///   be final.
  template <typename Cost, typename GoesOn, typename Estimate>
  int spread(const Cost& cost, const GoesOn& goes_on, const Estimate& estimate) {
    const std::size_t mask = first_.size() - 1;
    while (left_ > 0) {
      int& first = first_[now_ & mask];
      if (first == kNone) {
        ++now_;
        continue;
      }
      const int at = first;
      const Waiting waiting = waiting_[at];
      const int distance = waiting.distance;
      const bool is_final = distance_[waiting.cell] == distance;  // Or it was reached sooner.
      if (is_final && !goes_on(waiting.cell, distance)) return distance;
      first = waiting.next;
      waiting_[at].next = free_;
      free_ = at;
      --left_;
      if (!is_final) continue;
      for (std::size_t i = 0; i < steps_.size(); ++i) {
        const int next = waiting.cell + steps_[i];
        if (distance_[next] <= distance) continue;  // Half of them, mostly: no step is for nothing.
        const int step = cost(waiting.cell, next, i >= steps_.size() / 2);
        if (step <= 0) continue;
        const int reached = distance + step;
        if (reached < distance_[next] && reached < limit_) reach(next, reached, estimate(next));
      }
    }
    return now_;
  }
  template <typename Cost, typename GoesOn>
  int spread(const Cost& cost, const GoesOn& goes_on) {
    return spread(cost, goes_on, [](int) { return 0; });
  }

  /// Of each cell, where it is final; larger or kUnreached elsewhere.
  const std::vector<int>& distance() const { return distance_; }
  std::vector<int> takeDistance() { return std::move(distance_); }

 private:
  static constexpr int kNone = -1;

  struct Waiting {
    int cell;
    int distance;
    int next;  // in the same bucket
  };

  void reach(int cell, int distance, int estimate) {
    int& first = first_[(distance + estimate) & (first_.size() - 1)];
    distance_[cell] = distance;
    int at = free_;
    if (at == kNone) {
      at = static_cast<int>(waiting_.size());
      waiting_.emplace_back();
    } else {
      free_ = waiting_[at].next;
    }
    waiting_[at] = {cell, distance, first};
    first = at;
    ++left_;
  }

  std::array<int, 8> steps_;  // the straight ones first
  std::vector<int> distance_;
  std::vector<Waiting> waiting_;  // and places for others
  int free_ = kNone;              // the first of those
  std::vector<int> first_;        // of each bucket, in waiting_
  int left_ = 0;
  int now_ = 0;  // distance and estimate of the cells whose turn it is
  int limit_ = kUnreached;
};

}  // namespace casepush
