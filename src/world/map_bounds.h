#pragma once

#include <Eigen/Core>

namespace octomap {
class OcTree;
}

namespace casepush {

/// Cells that hold everything a tree knows: from `low` to below `high`, counted from the origin.
struct KnownCells {
  Eigen::Vector3i low;
  Eigen::Vector3i high;
};

/// Visits only branches that reach farther than all before, so that large trees take no longer.
/// @pre the tree is not empty.
KnownCells knownCells(const octomap::OcTree& tree);

}  // namespace casepush
