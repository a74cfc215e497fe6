// Where two maps differ.
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/common/check.h"
#include "casepush/world/map.h"

namespace casepush {
namespace {

constexpr int kKeyOfZero = 32768;
constexpr unsigned kChildren = 8;

/// A branch of a tree, or what stands for it where the tree ends further up; null: unknown.
struct Branch {
  const octomap::OcTree& tree;
  const octomap::OcTreeNode* node;

  bool isInner() const { return node != nullptr && tree.nodeHasChildren(node); }
  bool isOccupied() const { return node != nullptr && tree.isNodeOccupied(node); }
  Branch child(unsigned i) const {
    if (!isInner()) return *this;
    return {tree, tree.nodeChildExists(node, i) ? tree.getNodeChild(node, i) : nullptr};
  }
};

class Comparison {
 public:
  explicit Comparison(double resolution_m) : resolution_m_(resolution_m) {}

  void compare(const Branch& before, const Branch& now, const Eigen::Vector3i& corner, int size) {
    if (!before.isInner() && !now.isInner()) {
      if (before.isOccupied() != now.isOccupied()) note(corner, size);
      return;
    }
    const int half = size / 2;
    for (unsigned i = 0; i < kChildren; ++i) {
      const Eigen::Vector3i octant(i & 1U, i >> 1U & 1U, i >> 2U & 1U);
      compare(before.child(i), now.child(i), corner + half * octant, half);
    }
  }

  const MapChange& change() const { return change_; }

 private:
  void note(const Eigen::Vector3i& corner, int size) {
    const double cells = change_.cells + std::pow(size, 3);
    change_.cells = static_cast<int>(std::min(cells, 1.0 * std::numeric_limits<int>::max()));
    const Eigen::Vector3d low = corner.cast<double>() * resolution_m_;
    change_.where_m.extend(
        Eigen::AlignedBox3d(low, low + Eigen::Vector3d::Constant(size * resolution_m_)));
  }

  double resolution_m_;
  MapChange change_;
};

}  // namespace

void MapChange::extend(const MapChange& other) {
  cells += other.cells;
  where_m.extend(other.where_m);
}

MapChange Map::changeSince(const Map& before) const {
  CASEPUSH_CHECK(resolution() == before.resolution(),
                 resolution() << " m, before " << before.resolution() << " m");
  Comparison comparison(resolution());
  comparison.compare({*before.tree_, before.tree_->getRoot()}, {*tree_, tree_->getRoot()},
                     Eigen::Vector3i::Constant(-kKeyOfZero), 2 * kKeyOfZero);
  return comparison.change();
}

}  // namespace casepush
