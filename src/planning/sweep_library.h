#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "casepush/planning/prepared_cases.h"
#include "casepush/world/sweep_checker.h"

namespace casepush {

/// Keeps the sweeps of cases, so that their masks are made once and not for every plan.
///
/// Cases are told apart by their poses: an adapted outcome or another zeta makes another sweep.
/// Thread-safe.
class SweepLibrary {
 public:
  /// Gives each case its sweep. With more than kMost cases none gets one: their masks would fill
  /// the memory before they pay.
  void attach(const std::shared_ptr<const HeightClasses>& classes,
              const std::shared_ptr<const Footprint>& object,
              const std::shared_ptr<const Footprint>& robot, std::vector<PreparedCase>* cases);

  static constexpr std::size_t kMost = 256;

 private:
  struct Entry {
    std::shared_ptr<const HeightClasses> classes;
    std::shared_ptr<const Sweep> sweep;
    std::uint64_t last_use = 0;
  };

  std::mutex mutex_;
  std::unordered_multimap<std::size_t, Entry> entries_;
  std::uint64_t uses_ = 0;
};

}  // namespace casepush
