#include "map_bounds.h"

#include <octomap/OcTree.h>

#include <limits>

namespace casepush {
namespace {

constexpr int kKeyOfZero = 32768;
constexpr unsigned kChildren = 8;

void extend(const octomap::OcTree& tree, const octomap::OcTreeNode* node,
            const Eigen::Vector3i& corner, int size, KnownCells* known) {
  const Eigen::Vector3i end = corner.array() + size;
  if ((corner.array() >= known->low.array()).all() && (end.array() <= known->high.array()).all()) {
    return;
  }
  if (!tree.nodeHasChildren(node)) {
    known->low = known->low.cwiseMin(corner);
    known->high = known->high.cwiseMax(end);
    return;
  }
  const int half = size / 2;
  for (unsigned i = 0; i < kChildren; ++i) {
    if (!tree.nodeChildExists(node, i)) continue;
    const Eigen::Vector3i octant(i & 1U, i >> 1U & 1U, i >> 2U & 1U);
    extend(tree, tree.getNodeChild(node, i), corner + half * octant, half, known);
  }
}

}  // namespace

KnownCells knownCells(const octomap::OcTree& tree) {
  KnownCells known{Eigen::Vector3i::Constant(std::numeric_limits<int>::max()),
                   Eigen::Vector3i::Constant(std::numeric_limits<int>::min())};
  extend(tree, tree.getRoot(), Eigen::Vector3i::Constant(-kKeyOfZero), 2 * kKeyOfZero, &known);
  return known;
}

}  // namespace casepush
