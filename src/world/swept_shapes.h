#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "casepush/world/sweep.h"
#include "height_classes.h"

namespace casepush {

/// A convex shape in the frame where a motion starts, grown by the body's margin.
struct SweptShape {
  std::vector<Eigen::Vector2d> points;  ///< Of the polygon, counter-clockwise; one for a disc.
  double radius_m = 0.0;                ///< By which it is grown.
  std::uint32_t classes = 0;            ///< Bits of the height classes that it counts in.
  double reach_m = 0.0;  ///< Largest distance of a point of it from the frame's origin.
  // What it stands for.
  int track = 0;
  int first_pose = 0;
  int last_pose = 0;
  std::vector<int> parts;  ///< Of the track's body.
};

/// Memory that shapes take.
std::size_t bytesOf(const std::vector<SweptShape>& shapes);

/// Shapes that cover all parts at all poses of the tracks. Along a path each of them covers a part
/// at several neighbouring poses.
std::vector<SweptShape> coveringShapes(const std::vector<Track>& tracks,
                                       const HeightClasses& classes);

/// Shapes that are covered by some part at some pose, through all slices of their classes.
std::vector<SweptShape> coveredShapes(const std::vector<Track>& tracks,
                                      const HeightClasses& classes);

}  // namespace casepush
