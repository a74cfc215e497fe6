#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/world_model.h"

namespace casepush {

/// A piece of furniture that never moves: what it covers, and its boxes in its own frame.
struct FurniturePiece {
  std::string kind;  ///< For names, e.g. "desk".
  Eigen::Vector2d size_m;
  std::vector<StaticBox> boxes;  ///< Named after their part, e.g. "top"; empty for a single box.

  double areaM2() const { return size_m.prod(); }
};

/// A cabinet, shelf, desk, low table, pillar or plant of random size, to the centimetre.
FurniturePiece randomFurniture(Random& random);

}  // namespace casepush
