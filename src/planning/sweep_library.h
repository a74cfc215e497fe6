#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "casepush/planning/prepared_cases.h"
#include "casepush/world/sweep_checker.h"
#include "patience.h"

namespace casepush {

/// Keeps the sweeps of cases, so that their masks are made once and not for every plan.
///
/// Cases are told apart by their poses: an adapted outcome or another zeta makes another sweep.
/// There may be any number of cases: those that come up in searches get masks until the memory for
/// them is full, the others are tested pose by pose. Before a search that finds the memory nearly
/// full the masks that were not used for longest are dropped. Thread-safe.
class SweepLibrary {
 public:
  explicit SweepLibrary(std::size_t memory_bytes)
      : memory_(std::make_shared<MaskMemory>(memory_bytes)) {}

  /// Gives each case its sweep; false if `patience` was over before that.
  bool attach(const std::shared_ptr<const HeightClasses>& classes,
              const std::shared_ptr<const Footprint>& object,
              const std::shared_ptr<const Footprint>& robot, std::vector<PreparedCase>* cases,
              const Patience& patience = Patience());

  std::size_t usedBytes() const { return memory_->used(); }

 private:
  struct Entry {
    std::shared_ptr<const HeightClasses> classes;
    std::shared_ptr<const Sweep> sweep;
    std::uint64_t last_use = 0;     ///< Number of the search.
    std::uint64_t last_growth = 0;  ///< Number of the search in which masks were last added.
    std::size_t bytes = 0;          ///< When last looked at.
  };
  using Entries = std::unordered_multimap<std::size_t, Entry>;

  Entry& entryOf(std::vector<Track> tracks, const std::shared_ptr<const HeightClasses>& classes);
  void forgetUnused(const Patience& patience);
  void makeRoom(const Patience& patience);

  std::mutex mutex_;
  std::shared_ptr<MaskMemory> memory_;
  Entries entries_;
  std::uint64_t uses_ = 0;
};

}  // namespace casepush
