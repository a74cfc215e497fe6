#include "swept_shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace casepush {
namespace {

constexpr int kMaxOutline = 12;         // Points of a part; more are replaced by their rectangle.
constexpr double kChordError_m = 2e-3;  // A path's bend that is smoothed over.
constexpr std::size_t kMaxChord = 16;   // Poses that one shape covers.

/// A part of a body, its outline simple and grown.
struct Outline {
  Shadow shadow;
  std::uint32_t classes;
  std::vector<int> parts;  // It and those that lie within it.
};

Shadow simplified(const Shadow& shadow) {
  if (shadow.count <= kMaxOutline) return shadow;
  Eigen::Vector2d low = shadow.points[0];
  Eigen::Vector2d high = low;
  for (int i = 1; i < shadow.count; ++i) {
    low = low.cwiseMin(shadow.points[i]);
    high = high.cwiseMax(shadow.points[i]);
  }
  Shadow box = rectangle(low, high);
  box.radius_m = shadow.radius_m;
  return box;
}

bool isWithin(const Outline& inner, const Outline& outer) {
  if ((inner.classes & ~outer.classes) != 0) return false;
  for (int i = 0; i < inner.shadow.count; ++i) {
    if (separation(outer.shadow, inner.shadow.points[i]) > -inner.shadow.radius_m) return false;
  }
  return true;
}

/// Those that lie within another one are joined with it.
std::vector<Outline> outlines(const Footprint& body, const HeightClasses& classes) {
  std::vector<Outline> kept;
  for (std::size_t i = 0; i < body.parts().size(); ++i) {
    const ConvexPart& part = body.parts()[i];
    Outline outline{simplified(part.shadow()), classes.touchedBy(part), {static_cast<int>(i)}};
    outline.shadow.radius_m += body.margin();
    const auto around = std::find_if(
        kept.begin(), kept.end(), [&](const Outline& other) { return isWithin(outline, other); });
    if (around != kept.end()) {
      around->parts.push_back(static_cast<int>(i));
      continue;
    }
    for (auto other = kept.begin(); other != kept.end();) {
      if (!isWithin(*other, outline)) {
        ++other;
        continue;
      }
      outline.parts.insert(outline.parts.end(), other->parts.begin(), other->parts.end());
      other = kept.erase(other);
    }
    kept.push_back(std::move(outline));
  }
  return kept;
}

double distanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - from - t * along).norm();
}

/// Do the points move so straight that their hull at both ends covers them in between?
bool isChord(const std::vector<Shadow>& shadows, std::size_t from, std::size_t to) {
  for (std::size_t k = from + 1; k < to; ++k) {
    for (int i = 0; i < shadows[k].count; ++i) {
      if (distanceToSegment(shadows[k].points[i], shadows[from].points[i], shadows[to].points[i]) >
          kChordError_m) {
        return false;
      }
    }
  }
  return true;
}

SweptShape shape(const Shadow& shadow, std::uint32_t classes) {
  SweptShape result;
  result.points.assign(shadow.points.begin(), shadow.points.begin() + shadow.count);
  result.radius_m = shadow.radius_m;
  result.classes = classes;
  for (int i = 0; i < shadow.count; ++i) {
    result.reach_m = std::max(result.reach_m, shadow.points[i].norm() + shadow.radius_m);
  }
  return result;
}

Shadow hullOf(const Shadow& a, const Shadow& b) {
  std::vector<Eigen::Vector2d> points(a.points.begin(), a.points.begin() + a.count);
  points.insert(points.end(), b.points.begin(), b.points.begin() + b.count);
  Shadow result = convexHull(std::move(points));
  result.radius_m = std::max(a.radius_m, b.radius_m) + kChordError_m;
  return result;
}

/// Adds what covers an outline at the poses from, ..., to.
void addShape(const Shadow& shadow, const Outline& outline, int track, std::size_t from,
              std::size_t to, std::vector<SweptShape>* shapes) {
  shapes->push_back(shape(shadow, outline.classes));
  SweptShape& added = shapes->back();
  added.track = track;
  added.first_pose = static_cast<int>(from);
  added.last_pose = static_cast<int>(to);
  added.parts = outline.parts;
}

void addPath(const std::vector<Shadow>& shadows, const Outline& outline, int track,
             std::vector<SweptShape>* shapes) {
  std::size_t from = 0;
  if (shadows.size() == 1) addShape(shadows[0], outline, track, 0, 0, shapes);
  while (from + 1 < shadows.size()) {
    std::size_t to = from + 1;
    while (to + 1 < shadows.size() && to - from < kMaxChord && isChord(shadows, from, to + 1)) ++to;
    addShape(hullOf(shadows[from], shadows[to]), outline, track, from, to, shapes);
    from = to;
  }
}

}  // namespace

std::size_t bytesOf(const std::vector<SweptShape>& shapes) {
  std::size_t bytes = shapes.capacity() * sizeof(SweptShape);
  for (const SweptShape& swept : shapes) {
    bytes +=
        swept.points.capacity() * sizeof(Eigen::Vector2d) + swept.parts.capacity() * sizeof(int);
  }
  return bytes;
}

std::vector<SweptShape> coveringShapes(const std::vector<Track>& tracks,
                                       const HeightClasses& classes) {
  std::vector<SweptShape> shapes;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const Track& track = tracks[t];
    const int index = static_cast<int>(t);
    for (const Outline& outline : outlines(*track.body, classes)) {
      std::vector<Shadow> shadows;
      shadows.reserve(track.start_T_body.size());
      for (const Pose2& pose : track.start_T_body) {
        shadows.push_back(transformed(pose, outline.shadow));
      }
      if (track.kind == Track::Kind::kPath) {
        addPath(shadows, outline, index, &shapes);
        continue;
      }
      for (std::size_t i = 0; i < shadows.size(); ++i) {
        addShape(shadows[i], outline, index, i, i, &shapes);
      }
    }
  }
  return shapes;
}

std::vector<SweptShape> coveredShapes(const std::vector<Track>& tracks,
                                      const HeightClasses& classes) {
  std::vector<SweptShape> shapes;
  for (const Track& track : tracks) {
    // Every other pose of a path: what lies between hardly adds anything.
    const std::size_t stride = track.kind == Track::Kind::kPath ? 2 : 1;
    for (const ConvexPart& part : track.body->parts()) {
      const std::uint32_t filled = classes.filledBy(part);
      if (filled == 0 || part.shadow().count > kMaxOutline) continue;
      Shadow grown = part.shadow();
      grown.radius_m += track.body->margin();
      for (std::size_t i = 0; i < track.start_T_body.size(); i += stride) {
        shapes.push_back(shape(transformed(track.start_T_body[i], grown), filled));
      }
    }
  }
  return shapes;
}

}  // namespace casepush
