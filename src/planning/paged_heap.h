#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace casepush {

/// A binary heap, the least item first, that grows page by page: one that holds millions of items
/// takes no pause to move them. Items need operator>.
template <typename T>
class PagedHeap {
 public:
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const T& top() const { return (*this)[0]; }
  const T& operator[](std::size_t i) const { return pages_[i / kPage][i % kPage]; }
  /// Whoever changes items calls settle() for all, from the first one on, before push() or pop().
  T& operator[](std::size_t i) { return pages_[i / kPage][i % kPage]; }

  void push(const T& item) {
    append(item);
    settle(size_ - 1);
  }

  /// At the end, in no order.
  void append(const T& item) {
    if (size_ == kPage * pages_.size()) pages_.push_back(std::make_unique<T[]>(kPage));
    (*this)[size_++] = item;
  }

  /// Brings item i to its place, @pre all items before it are in order.
  void settle(std::size_t i) {
    const T item = (*this)[i];
    while (i > 0 && (*this)[(i - 1) / 2] > item) {
      (*this)[i] = (*this)[(i - 1) / 2];
      i = (i - 1) / 2;
    }
    (*this)[i] = item;
  }

  /// @pre It is not empty.
  T pop() {
    const T least = top();
    const T last = (*this)[--size_];
    std::size_t hole = 0;
    for (std::size_t child = 1; child < size_; child = 2 * hole + 1) {
      if (child + 1 < size_ && (*this)[child] > (*this)[child + 1]) ++child;
      if (!(last > (*this)[child])) break;
      (*this)[hole] = (*this)[child];
      hole = child;
    }
    if (size_ > 0) (*this)[hole] = last;
    return least;
  }

 private:
  static constexpr std::size_t kPage = 1 << 12;

  std::vector<std::unique_ptr<T[]>> pages_;
  std::size_t size_ = 0;
};

}  // namespace casepush
