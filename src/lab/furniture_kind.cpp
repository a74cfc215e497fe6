#include "furniture_kind.h"

#include <array>
#include <cmath>

namespace casepush {
namespace {

struct Range {
  double low_m;
  double high_m;
};

/// Sizes along x, y and z that a kind of furniture has.
struct Kind {
  const char* name;
  Range length;
  Range width;
  Range height;
  bool has_legs;
};

constexpr std::array<Kind, 6> kKinds{{
    {"cabinet", {0.6, 1.4}, {0.4, 0.5}, {0.8, 1.4}, false},
    {"shelf", {0.8, 2.0}, {0.3, 0.4}, {1.2, 1.5}, false},
    {"desk", {1.2, 1.8}, {0.6, 0.8}, {0.72, 0.76}, true},
    {"low_table", {0.6, 1.1}, {0.5, 0.7}, {0.4, 0.5}, true},
    {"pillar", {0.3, 0.5}, {0.3, 0.5}, {1.5, 1.5}, false},
    {"plant", {0.3, 0.4}, {0.3, 0.4}, {0.9, 1.2}, false},
}};
constexpr double kTop_m = 0.03;
constexpr double kLeg_m = 0.06;

/// Whole centimetres look like furniture and are exact in a file.
double draw(Random& random, const Range& range) {
  return std::round(random.uniform(range.low_m, range.high_m) * 100.0) / 100.0;
}

StaticBox makeBox(const std::string& name, const Eigen::Vector3d& size_m,
                  const Eigen::Vector3d& centre_m) {
  StaticBox box;
  box.name = name;
  box.box.size_m = size_m;
  box.map_T_box.translation() = centre_m;
  return box;
}

}  // namespace

FurniturePiece randomFurniture(Random& random) {
  const Kind& kind = kKinds[random.below(kKinds.size())];
  const double length_m = draw(random, kind.length);
  const double width_m = draw(random, kind.width);
  const double height_m = draw(random, kind.height);
  FurniturePiece piece{kind.name, {length_m, width_m}, {}};
  if (!kind.has_legs) {
    piece.boxes.push_back(makeBox("", {length_m, width_m, height_m}, {0.0, 0.0, 0.5 * height_m}));
    return piece;
  }
  piece.boxes.push_back(
      makeBox("_top", {length_m, width_m, kTop_m}, {0.0, 0.0, height_m - 0.5 * kTop_m}));
  const double leg_m = height_m - kTop_m;
  int leg = 0;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      piece.boxes.push_back(
          makeBox("_leg_" + std::to_string(++leg), {kLeg_m, kLeg_m, leg_m},
                  {x * (length_m - kLeg_m), y * (width_m - kLeg_m), 0.5 * leg_m}));
    }
  }
  return piece;
}

}  // namespace casepush
