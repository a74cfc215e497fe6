#pragma once

#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace casepush {

/// Dijkstra's algorithm in whole numbers over the eight neighbours of a grid's cells, with a ring
/// of buckets for a queue (Dial 1969).
class GridFlood {
 public:
  static constexpr int kUnreached = std::numeric_limits<int>::max();

  /// @param stride  Cells from row to row; no way may lead over the grid's rim.
  /// @param longest_step  No step costs more.
  GridFlood(int cells, int stride, int longest_step)
      : steps_{1, -1, stride, -stride, stride + 1, stride - 1, -stride + 1, -stride - 1},
        distance_(cells, kUnreached) {
    int size = 1;
    while (size <= longest_step) size *= 2;
    first_.assign(size, kNone);
  }

  void begin(int cell) {
    if (distance_[cell] == 0) return;
    reach(cell, 0);
  }

  /// @param cost  Of a step to a cell from its neighbour, straight or diagonal, > 0; 0 if there is
  ///   no way.
  /// @param goes_on  Asked for each cell with its distance once that is final.
  /// @return  The distance where it ended; what is as far or farther may not be final.
  template <typename Cost, typename GoesOn>
  int spread(const Cost& cost, const GoesOn& goes_on) {
    const std::size_t mask = first_.size() - 1;
    int now = 0;
    for (; left_ > 0; ++now) {
      for (int at = std::exchange(first_[now & mask], kNone); at != kNone; at = waiting_[at].next) {
        const int cell = waiting_[at].cell;
        --left_;
        if (distance_[cell] != now) continue;
        if (!goes_on(cell, now)) return now;
        for (std::size_t i = 0; i < steps_.size(); ++i) {
          const int next = cell + steps_[i];
          const int step = cost(cell, next, i >= steps_.size() / 2);
          if (step > 0 && now + step < distance_[next]) reach(next, now + step);
        }
      }
    }
    return now;
  }

  /// Of each cell, where it is final; larger or kUnreached elsewhere.
  const std::vector<int>& distance() const { return distance_; }
  std::vector<int> takeDistance() { return std::move(distance_); }

 private:
  static constexpr int kNone = -1;

  struct Waiting {
    int cell;
    int next;  // in the same bucket
  };

  void reach(int cell, int distance) {
    int& first = first_[distance & (first_.size() - 1)];
    distance_[cell] = distance;
    waiting_.push_back({cell, first});
    first = static_cast<int>(waiting_.size()) - 1;
    ++left_;
  }

  std::array<int, 8> steps_;  // the straight ones first
  std::vector<int> distance_;
  std::vector<Waiting> waiting_;  // and those that are done
  std::vector<int> first_;        // of each bucket, in waiting_
  int left_ = 0;
};

}  // namespace casepush
