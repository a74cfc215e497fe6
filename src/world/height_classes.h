#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "casepush/world/collision_checker.h"
#include "footprint.h"

namespace casepush {

/// Groups of height slices: within a group the same parts of all bodies are to be tested.
///
/// As many as the bodies' parts demand; beyond kMost the groups that differ least are joined, which
/// makes masks more conservative and nothing else.
class HeightClasses {
 public:
  static constexpr int kMost = 6;

  /// @param columns  Of the map: the class that is most likely to hit something there is the first.
  HeightClasses(const std::vector<std::shared_ptr<const Footprint>>& bodies,
                const CollisionChecker::Columns& columns);

  int count() const { return static_cast<int>(slices_.size()); }
  std::uint64_t slices(int index) const { return slices_[index]; }
  std::uint64_t allSlices() const;

  /// Bits of the classes that a part reaches into.
  std::uint32_t touchedBy(const ConvexPart& part) const;
  /// Bits of the classes in all slices of which the part has its whole shadow.
  std::uint32_t filledBy(const ConvexPart& part) const;

 private:
  void mergeMostSimilar(const std::vector<std::shared_ptr<const Footprint>>& bodies);
  void sortByHits(const std::vector<std::shared_ptr<const Footprint>>& bodies,
                  const CollisionChecker::Columns& columns);

  double slice_m_;
  std::vector<std::uint64_t> slices_;
};

}  // namespace casepush
