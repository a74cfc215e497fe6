#include "casepush/model/load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSmallestSize_m = 0.01;
constexpr double kLargestSize_m = 3.0;
constexpr double kTolerance_m = 0.01;  // Of heights: nobody measures a table to the millimetre.
constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// Where a line through a convex shape enters and leaves; empty if low > high.
struct Span {
  double low = -kNowhere;
  double high = kNowhere;

  void cut(double from, double to) {
    low = std::max(low, std::min(from, to));
    high = std::min(high, std::max(from, to));
  }
};

const Span kMissed{kNowhere, -kNowhere};

/// Cuts with |start + t slope| <= half.
void cutSlab(double start, double slope, double half, Span& span) {
  if (std::abs(slope) > 1e-12) {
    span.cut((-half - start) / slope, (half - start) / slope);
  } else if (std::abs(start) > half) {
    span = kMissed;
  }
}

/// Cuts with |start + t slope| <= radius.
template <typename Vector>
void cutRound(const Vector& start, const Vector& slope, double radius, Span& span) {
  const double a = slope.squaredNorm();
  const double b = start.dot(slope);
  const double c = start.squaredNorm() - radius * radius;
  const double discriminant = b * b - a * c;
  if (a < 1e-12 ? c > 0.0 : discriminant < 0.0) {
    span = kMissed;
  } else if (a >= 1e-12) {
    const double root = std::sqrt(discriminant);
    span.cut((-b - root) / a, (-b + root) / a);
  }
}

/// Heights between which the upright line through a place is inside of the shape.
Span heightsAt(const PlacedShape& placed, const Eigen::Isometry3d& root_T_frame,
               const Vector2d& place) {
  const Eigen::Isometry3d shape_T_root = (root_T_frame * placed.frame_T_shape).inverse();
  const Vector3d start = shape_T_root * Vector3d(place.x(), place.y(), 0.0);
  const Vector3d slope = shape_T_root.linear().col(2);
  Span span;
  if (const auto* box = std::get_if<Box>(&placed.shape)) {
    for (int i = 0; i < 3; ++i) cutSlab(start(i), slope(i), 0.5 * box->size_m(i), span);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
    cutSlab(start.z(), slope.z(), 0.5 * cylinder->length_m, span);
    cutRound<Vector2d>(start.head<2>(), slope.head<2>(), cylinder->radius_m, span);
  } else {
    cutRound<Vector3d>(start, slope, std::get<Sphere>(placed.shape).radius_m, span);
  }
  return span;
}

/// The highest surface of the carrier at a place; negative infinity beside it.
double surfaceAt(const Mechanism& carrier, const Vector2d& place) {
  double surface_m = -kNowhere;
  for (std::size_t i = 0; i < carrier.links.size(); ++i) {
    const Eigen::Isometry3d root_T_link = carrier.root_T_link(static_cast<int>(i));
    for (const PlacedShape& placed : carrier.links[i].collision) {
      const Span span = heightsAt(placed, root_T_link, place);
      if (span.low <= span.high) surface_m = std::max(surface_m, span.high);
    }
  }
  return surface_m;
}

Solid solidOf(const Mechanism& carrier) {
  Solid solid;
  for (std::size_t i = 0; i < carrier.links.size(); ++i) {
    for (PlacedShape placed : carrier.links[i].collision) {
      placed.frame_T_shape = carrier.root_T_link(static_cast<int>(i)) * placed.frame_T_shape;
      solid.push_back(std::move(placed));
    }
  }
  return solid;
}

void checkMass(const Load& load, const std::string& where) {
  if (load.mass_kg >= 0.0 && load.mass_kg <= kLargestLoad_kg) return;
  std::ostringstream text;
  text << "the mass is " << load.mass_kg << " kg; must be in [0, " << kLargestLoad_kg << "] kg";
  throw InputError(where, text.str());
}

void checkSize(const Load& load, const std::string& where) {
  const bool fits = load.size_m.allFinite() && load.size_m.minCoeff() >= kSmallestSize_m &&
                    load.size_m.maxCoeff() <= kLargestSize_m;
  if (fits) return;
  std::ostringstream text;
  text << "the size is (" << load.size_m.transpose() << ") m; each must be in [" << kSmallestSize_m
       << ", " << kLargestSize_m << "] m";
  throw InputError(where, text.str());
}

HeightRange rangeAlong(const Vector3d& axis, Solid solid) {
  const Eigen::Isometry3d up(Eigen::Quaterniond::FromTwoVectors(axis, Vector3d::UnitZ()));
  for (PlacedShape& placed : solid) placed.frame_T_shape = up * placed.frame_T_shape;
  return heightRange(solid);
}

std::string footprintText(const Solid& solid) {
  const HeightRange x = rangeAlong(Vector3d::UnitX(), solid);
  const HeightRange y = rangeAlong(Vector3d::UnitY(), solid);
  std::ostringstream text;
  text << "must be above or below one of its collision shapes, which span x " << x.low_m << " to "
       << x.high_m << ", y " << y.low_m << " to " << y.high_m;
  return text.str();
}

double checkedHeight(const Load& load, double surface_m, double top_m, const std::string& where) {
  const double half_m = 0.5 * load.size_m.z();
  if (!load.height_m) return surface_m + half_m;
  const double low_m = half_m - kTolerance_m;
  const double high_m = top_m + half_m + kTolerance_m;
  if (*load.height_m >= low_m && *load.height_m <= high_m) return *load.height_m;
  std::ostringstream text;
  text << "the height of the centre is " << *load.height_m << " m; must be in [" << low_m << ", "
       << high_m << "] m: above the floor, and standing on the object at the most";
  throw InputError(where, text.str());
}

}  // namespace

Load placedLoad(const Load& load, const Mechanism& carrier, const std::string& where) {
  checkMass(load, where);
  if (load.mass_kg == 0.0) return {};
  checkSize(load, where);
  const Solid solid = solidOf(carrier);
  if (solid.empty()) throw InputError(where, "the object has no collision shapes to carry a load");
  const double surface_m =
      load.object_p_centre_m.allFinite() ? surfaceAt(carrier, load.object_p_centre_m) : -kNowhere;
  if (surface_m == -kNowhere) {
    std::ostringstream text;
    text << "the place (" << load.object_p_centre_m.x() << ", " << load.object_p_centre_m.y()
         << ") m in the object's frame is outside of the object's footprint; "
         << footprintText(solid);
    throw InputError(where, text.str());
  }
  Load placed = load;
  placed.height_m = checkedHeight(load, surface_m, heightRange(solid).high_m, where);
  return placed;
}

Eigen::Matrix3d inertiaOf(const Load& load) {
  const Vector3d squares = load.size_m.cwiseAbs2();
  return load.mass_kg / 12.0 *
         Vector3d(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y())
             .asDiagonal()
             .toDenseMatrix();
}

}  // namespace casepush
