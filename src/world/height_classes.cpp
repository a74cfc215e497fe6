#include "height_classes.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "slab.h"

namespace casepush {
namespace {

using Bodies = std::vector<std::shared_ptr<const Footprint>>;

std::uint64_t slicesOf(const ConvexPart& part, double slice_m) {
  return sliceMask(part.heights().low_m, part.heights().high_m, slice_m);
}

/// Cells that the bodies cover within the slices, over all bodies.
int area(const Bodies& bodies, std::uint64_t slices) {
  int cells = 0;
  for (const auto& body : bodies) {
    for (const Footprint::Entry& entry : body->entries(0.0)) cells += (entry.slices & slices) != 0;
  }
  return cells;
}

}  // namespace

HeightClasses::HeightClasses(const Bodies& bodies, const CollisionChecker::Columns& columns)
    : slice_m_(columns.slice_m) {
  std::map<std::vector<bool>, std::uint64_t> by_parts;
  for (int slice = 0; slice < kSlices; ++slice) {
    const std::uint64_t bit = std::uint64_t{1} << slice;
    std::vector<bool> present;
    bool any = false;
    for (const auto& body : bodies) {
      for (const ConvexPart& part : body->parts()) {
        present.push_back((slicesOf(part, slice_m_) & bit) != 0);
        any = any || present.back();
      }
    }
    if (any) by_parts[present] |= bit;
  }
  for (const auto& [present, slices] : by_parts) slices_.push_back(slices);
  while (count() > kMost) mergeMostSimilar(bodies);
  sortByHits(bodies, columns);
}

// What covers most where most is occupied collides most often.
void HeightClasses::sortByHits(const Bodies& bodies, const CollisionChecker::Columns& columns) {
  std::vector<std::pair<double, std::uint64_t>> ranked;
  for (const std::uint64_t slices : slices_) {
    const auto occupied = std::count_if(columns.bits.begin(), columns.bits.end(),
                                        [slices](std::uint64_t bits) { return bits & slices; });
    ranked.emplace_back((1.0 + static_cast<double>(occupied)) * area(bodies, slices), slices);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::transform(ranked.begin(), ranked.end(), slices_.begin(),
                 [](const auto& entry) { return entry.second; });
}

void HeightClasses::mergeMostSimilar(const Bodies& bodies) {
  int best_i = 0;
  int best_j = 1;
  int least = std::numeric_limits<int>::max();
  for (int i = 0; i < count(); ++i) {
    for (int j = i + 1; j < count(); ++j) {
      const int added = 2 * area(bodies, slices_[i] | slices_[j]) - area(bodies, slices_[i]) -
                        area(bodies, slices_[j]);
      if (added >= least) continue;
      least = added;
      best_i = i;
      best_j = j;
    }
  }
  slices_[best_i] |= slices_[best_j];
  slices_.erase(slices_.begin() + best_j);
}

std::uint64_t HeightClasses::allSlices() const {
  std::uint64_t all = 0;
  for (const std::uint64_t slices : slices_) all |= slices;
  return all;
}

std::uint32_t HeightClasses::touchedBy(const ConvexPart& part) const {
  const std::uint64_t own = slicesOf(part, slice_m_);
  std::uint32_t bits = 0;
  for (int i = 0; i < count(); ++i) bits |= (own & slices_[i]) != 0 ? 1U << i : 0U;
  return bits;
}

std::uint32_t HeightClasses::filledBy(const ConvexPart& part) const {
  if (!part.isPrism()) return 0;
  const std::uint64_t own = slicesOf(part, slice_m_);
  std::uint32_t bits = 0;
  for (int i = 0; i < count(); ++i) bits |= (slices_[i] & ~own) == 0 ? 1U << i : 0U;
  return bits;
}

}  // namespace casepush
