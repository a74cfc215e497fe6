#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace casepush {

/// The cheapest node of each cell of SE(2), by poseCell(): an open hash table.
class CellTable {
 public:
  struct Entry {
    std::uint64_t cell = 0;
    float cost_s = 0.0F;  // A tree's costs differ by more than is lost here, or not at all.
    int node = kNone;
  };
  static constexpr int kNone = -1;

  CellTable() : entries_(kLeast) {}

  /// Tells the processor that find() will soon be asked.
  void fetch(std::uint64_t cell) const {
    __builtin_prefetch(&entries_[firstSlotOf(cell) & (entries_.size() - 1)]);
  }

  /// nullptr if the cell has no node. Valid until an entry is added.
  Entry* find(std::uint64_t cell) {
    Entry& entry = entries_[slotOf(cell)];
    return entry.node >= 0 ? &entry : nullptr;
  }
  const Entry* find(std::uint64_t cell) const {
    const Entry& entry = entries_[slotOf(cell)];
    return entry.node >= 0 ? &entry : nullptr;
  }

  /// @pre The cell has no node.
  void add(const Entry& entry) {
    if (2 * (used_ + 1) > entries_.size()) grow();
    Entry& slot = entries_[slotOf(entry.cell)];
    used_ += slot.node == kNone ? 1 : 0;
    slot = entry;
  }

  void erase(std::uint64_t cell) {
    if (Entry* const entry = find(cell)) entry->node = kErased;
  }

  void clear() {
    entries_.assign(kLeast, Entry());
    used_ = 0;
  }

 private:
  static constexpr std::size_t kLeast = 512;  // A power of two, as every size.
  static constexpr int kErased = -2;          // Searches go on behind it.

  // In a table of any size, but for its mask.
  static std::size_t firstSlotOf(std::uint64_t cell) {
    // Cells of a block of 4 x 4 x 8 lie together: a search asks for what is near again and again.
    constexpr std::uint64_t kBlock = ~(std::uint64_t{3} << 42 | std::uint64_t{3} << 21 | 7);
    const std::uint64_t mixed = (cell & kBlock) * 0x9e3779b97f4a7c15ULL;
    const std::uint64_t within = (cell >> 42 & 3) << 5 | (cell >> 21 & 3) << 3 | (cell & 7);
    return static_cast<std::size_t>(mixed >> 40 << 7 | within);
  }

  // Where the cell is, or where it would be added.
  std::size_t slotOf(std::uint64_t cell) const {
    const std::size_t mask = entries_.size() - 1;
    std::size_t slot = firstSlotOf(cell) & mask;
    while (entries_[slot].node != kNone && entries_[slot].cell != cell) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    std::vector<Entry> before(2 * entries_.size());
    before.swap(entries_);
    used_ = 0;
    for (const Entry& entry : before) {
      if (entry.node < 0) continue;
      entries_[slotOf(entry.cell)] = entry;
      ++used_;
    }
  }

  std::vector<Entry> entries_;
  std::size_t used_ = 0;  // and erased
};

}  // namespace casepush
