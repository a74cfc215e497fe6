#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/world/map.h"
#include "casepush/world/shadow.h"
#include "cell_cover.h"
#include "map_stream.h"

namespace casepush {
namespace {

constexpr double kMostCells = 4096.0;          // along each axis
constexpr double kLargestCellIndex = 32767.0;  // of an octree
constexpr double kMostPoints = 5e7;
constexpr double kMostCellsVisited = 1e9;

[[noreturn]] void refuse(const WorldModel& world, double resolution_m, const std::string& what) {
  std::ostringstream text;
  text << "is too large to be surveyed at " << resolution_m << " m: " << what;
  throw InputError("world '" + world.name + "'", text.str());
}

std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

Eigen::AlignedBox3d boundsOf(const StaticBox& box) {
  const Eigen::Vector3d half_m = box.map_T_box.linear().cwiseAbs() * box.box.size_m / 2.0;
  const Eigen::Vector3d& centre = box.map_T_box.translation();
  return {centre - half_m, centre + half_m};
}

void checkExtent(const WorldModel& world, double resolution_m) {
  Eigen::AlignedBox3d all(Eigen::Vector3d(world.min_m.x(), world.min_m.y(), 0.0),
                          Eigen::Vector3d(world.max_m.x(), world.max_m.y(), 0.0));
  for (const StaticBox& box : world.boxes) all.extend(boundsOf(box));
  const double cells = all.sizes().maxCoeff() / resolution_m;
  if (!(cells <= kMostCells)) {
    refuse(world, resolution_m,
           "it spans " + text(cells) + " cells; must be at most " + text(kMostCells));
  }
  const double farthest =
      std::max(all.min().cwiseAbs().maxCoeff(), all.max().cwiseAbs().maxCoeff());
  if (!(farthest <= kLargestCellIndex * resolution_m)) {
    refuse(world, resolution_m,
           "it reaches " + text(farthest) + " m away from the origin; must be at most " +
               text(kLargestCellIndex * resolution_m) + " m");
  }
}

/// At most so many cells touch a box: those within a cell's diagonal of it (Steiner's formula).
double mostPoints(const Box& box, double resolution_m) {
  const Eigen::Vector3d s = box.size_m / resolution_m;
  const double d = std::sqrt(3.0);
  const double surface = 2.0 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  return s.prod() + surface * d + M_PI * s.sum() * d * d + 4.0 / 3.0 * M_PI * d * d * d;
}

/// Refuses what would take more time or memory than a survey is worth.
void checkCost(const WorldModel& world, double resolution_m) {
  checkExtent(world, resolution_m);
  double points = 0.0;
  double visited = 0.0;
  for (const StaticBox& box : world.boxes) {
    const Eigen::Array3d cells = boundsOf(box).sizes().array() / resolution_m + 2.0;
    visited += cells.prod();
    points += std::min(cells.prod(), mostPoints(box.box, resolution_m));
  }
  if (!(points <= kMostPoints)) {
    refuse(world, resolution_m,
           "its boxes fill up to " + text(points) + " cells; must be at most " + text(kMostPoints));
  }
  if (!(visited <= kMostCellsVisited)) {
    refuse(world, resolution_m,
           "around its boxes lie " + text(visited) + " cells; must be at most " +
               text(kMostCellsVisited));
  }
}

PlacedShape shrunk(const StaticBox& box) {
  const Eigen::Vector3d skin = (box.box.size_m / 4.0).cwiseMin(kSkin_m);
  return {Box{box.box.size_m - 2.0 * skin}, box.map_T_box, box.name};
}

void addBox(const StaticBox& box, double resolution_m, std::vector<Eigen::Vector3f>* points) {
  const ConvexPart part(shrunk(box));
  const HeightRange heights = part.heights();
  const int first = std::max(0, cellBelow(heights.low_m, resolution_m));
  for (int layer = first; layer * resolution_m < heights.high_m; ++layer) {
    const Shadow shadow = part.shadow(layer * resolution_m, (layer + 1) * resolution_m);
    visitCoveredCells(shadow, resolution_m, [&](int ix, int iy) {
      points->push_back(cellCentre(ix, iy, layer, resolution_m));
    });
  }
}

}  // namespace

std::vector<Eigen::Vector3f> surveyPoints(const WorldModel& world, double resolution_m) {
  checkResolution(resolution_m, "map survey");
  CASEPUSH_CHECK(!world.hasUnreadMap(), "world " << world.name << " lacks its static map");
  checkCost(world, resolution_m);
  std::vector<Eigen::Vector3f> points;
  addFloorRim(world.min_m, world.max_m, resolution_m, &points);
  for (const StaticBox& box : world.boxes) addBox(box, resolution_m, &points);
  return points;
}

}  // namespace casepush
