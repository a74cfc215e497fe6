#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace casepush {

/// The pushes that may be tried from the nodes of a search tree, the most promising first.
///
/// Each node keeps its own pushes side by side, in order. A heap holds the nodes by the best push
/// of each: small enough to stay in the processor's caches. Not thread-safe.
class EdgeQueue {
 public:
  struct Push {
    float key_s;  ///< What it promises, >= 0: the less the sooner. Of equal ones the lower index.
    std::int32_t index : 31;
    /// The key may be too small: who finds it first says the right one.
    bool is_rough : 1;

    Push() = default;
    Push(float key, int push, bool rough = false) : key_s(key), index(push), is_rough(rough) {}
    bool operator<(const Push& other) const {
      return key_s != other.key_s ? key_s < other.key_s : index < other.index;
    }
  };
  struct Edge {
    int node;
    int push;
    bool is_rough;
  };

  static constexpr int kMost = 7;  ///< Pushes of a node.
  /// In the place of a push: from this key on there are others. Whoever finds it takes all of the
  /// node out, and adds it anew.
  static constexpr int kMore = -1;

  bool empty() const { return heap_.empty(); }

  void reserve(std::size_t nodes) {
    heap_.reserve(nodes);
    lists_.reserve(nodes);
  }

  void clear() {
    heap_.clear();
    lists_.clear();
  }

  /// Those of a node of which none is waiting. If there are too many, the best of them and kMore.
  void add(int node, const std::vector<Push>& pushes) {
    if (pushes.empty()) return;
    if (lists_.size() <= static_cast<std::size_t>(node)) lists_.resize(node + 1);
    List& list = lists_[node];
    list.count = 0;
    for (const Push& push : pushes) list.insert(push);
    if (pushes.size() > kMost) list.pushes.front() = {list.pushes.front().key_s, kMore};
    rise(entry(list.pushes[list.count - 1].key_s, node));
  }

  /// The node of the next edge. @pre Not empty.
  int nextNode() const { return static_cast<int>(heap_.front() & 0xffffffff); }

  /// The next edge. @pre Not empty.
  Edge first() const {
    const int node = nextNode();
    const List& list = lists_[node];
    const Push& first = list.pushes[list.count - 1];
    return {node, first.index, first.is_rough};
  }

  /// Puts the next edge, a rough one, where it belongs. @pre Not empty.
  void refineFirst(float key_s) {
    const int node = nextNode();
    List& list = lists_[node];
    int at = list.count - 1;
    const Push refined{key_s, list.pushes[at].index, false};
    for (; at > 0 && list.pushes[at - 1] < refined; --at) list.pushes[at] = list.pushes[at - 1];
    list.pushes[at] = refined;
    sink(entry(list.pushes[list.count - 1].key_s, node));
  }

  /// Takes the next edge out. @pre Not empty.
  void pop() {
    const int node = nextNode();
    List& list = lists_[node];
    if (--list.count > 0) {
      sink(entry(list.pushes[list.count - 1].key_s, node));
    } else {
      dropFirst();
    }
    if (!heap_.empty()) __builtin_prefetch(&lists_[nextNode()]);
  }

  /// Leaves out all of the next node. @pre Not empty.
  void dropFirst() {
    const Entry last = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) sink(last);
  }

 private:
  /// Key and node in one number: what is positive has the order of its bits.
  using Entry = std::uint64_t;

  struct alignas(64) List {
    std::array<Push, kMost> pushes;  ///< The first comes last.
    int count = 0;

    /// In its place; of too many the last one is left out.
    void insert(const Push& push) {
      if (count < kMost) {
        int at = count++;
        for (; at > 0 && pushes[at - 1] < push; --at) pushes[at] = pushes[at - 1];
        pushes[at] = push;
      } else if (push < pushes.front()) {
        int at = 0;
        for (; at + 1 < kMost && push < pushes[at + 1]; ++at) pushes[at] = pushes[at + 1];
        pushes[at] = push;
      }
    }
  };

  static constexpr std::size_t kChildren = 4;  // Fewer levels, and children lie side by side.

  static Entry entry(float key_s, int node) {
    std::uint32_t bits;
    std::memcpy(&bits, &key_s, sizeof(bits));
    return static_cast<Entry>(bits) << 32 | static_cast<std::uint32_t>(node);
  }

  void rise(Entry entry) {
    std::size_t at = heap_.size();
    heap_.push_back(entry);
    while (at > 0) {
      const std::size_t parent = (at - 1) / kChildren;
      if (heap_[parent] <= entry) break;
      heap_[at] = heap_[parent];
      at = parent;
    }
    heap_[at] = entry;
  }

  // In the place of the first one.
  void sink(Entry entry) {
    Entry* const heap = heap_.data();
    const std::size_t count = heap_.size();
    std::size_t at = 0;
    for (std::size_t child = 1; child < count; child = kChildren * at + 1) {
      std::size_t least = child;
      const std::size_t end = std::min(child + kChildren, count);
      for (std::size_t other = child + 1; other < end; ++other) {
        least = heap[other] < heap[least] ? other : least;
      }
      if (heap[least] >= entry) break;
      heap[at] = heap[least];
      at = least;
    }
    heap[at] = entry;
  }

  std::vector<Entry> heap_;
  std::vector<List> lists_;  // of each node
};

}  // namespace casepush
