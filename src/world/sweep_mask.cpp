#include "sweep_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace casepush {
namespace {

constexpr int kBits = 64;
constexpr double kRounding_m = 1e-6;
/// What is covered certainly is so by more than any contact tolerance.
constexpr double kCertain_m = 1e-4;

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Bounds in cells, both inclusive.
struct CellBox {
  int x0, x1, y0, y1;
};

/// A shape turned to a heading, with what rows need of it.
class Outline {
 public:
  Outline(const Shadow& shadow, double cosine, double sine, double radius_m)
      : count_(shadow.count), radius_m_(radius_m) {
    for (int i = 0; i < count_; ++i) {
      const Eigen::Vector2d& p = shadow.points[i];
      points_[i] = {cosine * p.x() - sine * p.y(), sine * p.x() + cosine * p.y()};
      x_.add(points_[i].x());
      y_.add(points_[i].y());
      if (points_[i].x() <= x_.low) leftmost_y_ = points_[i].y();
      if (points_[i].x() >= x_.high) rightmost_y_ = points_[i].y();
    }
    for (int i = 0; i < count_ && count_ > 1; ++i) {
      const Eigen::Vector2d edge = points_[i + 1 == count_ ? 0 : i + 1] - points_[i];
      normals_[i] = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
    }
  }

  double left() const { return x_.low - radius_m_; }
  double right() const { return x_.high + radius_m_; }
  double bottom() const { return y_.low - radius_m_; }
  double top() const { return y_.high + radius_m_; }

  /// The x that the grown outline takes at heights within [low, high]; convex, so that its extremes
  /// lie where the band is nearest to the outline's own.
  Interval within(double low, double high) const {
    const double first = std::max(low, bottom());
    const double last = std::min(high, top());
    const Interval at_left = at(std::clamp(leftmost_y_, first, last));
    const Interval at_right = at(std::clamp(rightmost_y_, first, last));
    return {at_left.low, at_right.high};
  }

  /// The x at height y for which everything within `inset_m` lies inside of the polygon itself.
  Interval inside(double y, double inset_m) const {
    Interval result{-std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
    for (int i = 0; i < count_; ++i) {
      const double room =
          normals_[i].dot(points_[i]) - inset_m - normals_[i].y() * y;  // >= normal.x * x
      if (normals_[i].x() > 0.0) {
        result.high = std::min(result.high, room / normals_[i].x());
      } else if (normals_[i].x() < 0.0) {
        result.low = std::max(result.low, room / normals_[i].x());
      } else if (room < 0.0) {
        return {};
      }
    }
    return result;
  }

 private:
  Interval at(double y) const {
    Interval result;
    for (int i = 0; i < count_; ++i) {
      const double up = y - points_[i].y();
      const double across2 = radius_m_ * radius_m_ - up * up;
      if (across2 >= -kRounding_m * kRounding_m) {
        const double across = std::sqrt(std::max(0.0, across2));
        result.add(points_[i].x() - across);
        result.add(points_[i].x() + across);
      }
      if (count_ == 1) break;
      const Eigen::Vector2d from = points_[i] + radius_m_ * normals_[i];
      const Eigen::Vector2d to = points_[i + 1 == count_ ? 0 : i + 1] + radius_m_ * normals_[i];
      if ((y - from.y()) * (y - to.y()) > 0.0) continue;
      const double rise = to.y() - from.y();
      result.add(rise == 0.0 ? from.x() : from.x() + (y - from.y()) / rise * (to.x() - from.x()));
      if (rise == 0.0) result.add(to.x());
    }
    return result;
  }

  int count_;
  double radius_m_;
  std::array<Eigen::Vector2d, Shadow::kMaxPoints> points_;
  std::array<Eigen::Vector2d, Shadow::kMaxPoints> normals_;
  Interval x_;
  Interval y_;
  double leftmost_y_ = 0.0;
  double rightmost_y_ = 0.0;
};

/// One bit image for each height class while a mask is being drawn.
class Canvas {
 public:
  Canvas(const CellBox& box, int classes)
      : box_(box),
        strips_((box.x1 - box.x0) / kBits + 1),
        rows_(box.y1 - box.y0 + 1),
        words_(static_cast<std::size_t>(classes) * strips_ * rows_, 0) {}

  int strips() const { return strips_; }

  void draw(std::uint32_t classes, int y, int x_low, int x_high) {
    if (y < box_.y0 || y > box_.y1) return;
    const int low = std::max(x_low, box_.x0) - box_.x0;
    const int high = std::min(x_high, box_.x1) - box_.x0;
    for (int s = low / kBits; low <= high && s <= high / kBits; ++s) {
      const int first = std::max(low - s * kBits, 0);
      const int last = std::min(high - s * kBits, kBits - 1);
      const std::uint64_t bits = (~std::uint64_t{0} << first) & (~std::uint64_t{0} >> (63 - last));
      for (int c = 0; classes >> c != 0; ++c) {
        if ((classes >> c & 1) != 0) word(c, s, y - box_.y0) |= bits;
      }
    }
  }

  /// Appends the union of the classes' images, without empty rows at the ends.
  SweepMask::Layer appendTo(std::uint32_t classes, std::vector<std::uint64_t>* words) const {
    SweepMask::Layer layer;
    int first = rows_;
    int last = -1;
    for (int row = 0; row < rows_; ++row) {
      for (int s = 0; s < strips_; ++s) {
        if (united(classes, s, row) == 0) continue;
        first = std::min(first, row);
        last = row;
      }
    }
    if (last < 0) return layer;
    constexpr int kStep = LayeredBitmap::kRowStep;
    layer.first_row = static_cast<std::int16_t>(box_.y0 + first);
    layer.rows = static_cast<std::int16_t>((last - first + kStep) / kStep * kStep);
    layer.offset = static_cast<std::int32_t>(words->size());
    for (int s = 0; s < strips_; ++s) {
      for (int i = 0; i < layer.rows; ++i) {
        words->push_back(first + i <= last ? united(classes, s, first + i) : 0);
      }
    }
    return layer;
  }

 private:
  std::uint64_t& word(int c, int strip, int row) {
    return words_[(static_cast<std::size_t>(c) * strips_ + strip) * rows_ + row];
  }
  std::uint64_t united(std::uint32_t classes, int strip, int row) const {
    std::uint64_t bits = 0;
    for (int c = 0; classes >> c != 0; ++c) {
      if ((classes >> c & 1) == 0) continue;
      bits |= words_[(static_cast<std::size_t>(c) * strips_ + strip) * rows_ + row];
    }
    return bits;
  }

  CellBox box_;
  int strips_;
  int rows_;
  std::vector<std::uint64_t> words_;
};

/// First and last index of the cells, two cells wide, that reach into the open interval.
int firstCell(double low, double resolution_m) {
  return static_cast<int>(std::floor(low / resolution_m - 1.0)) + 1;
}
int lastCell(double high, double resolution_m) {
  return static_cast<int>(std::ceil(high / resolution_m + 1.0)) - 1;
}

void drawCovering(const Outline& outline, std::uint32_t classes, double resolution_m,
                  Canvas* canvas) {
  const int last = lastCell(outline.top(), resolution_m);
  for (int y = firstCell(outline.bottom(), resolution_m); y <= last; ++y) {
    // The origin lies anywhere in its cell, so the cell is seen anywhere in two by two.
    const Interval x = outline.within((y - 1) * resolution_m, (y + 1) * resolution_m);
    canvas->draw(classes, y, firstCell(x.low, resolution_m), lastCell(x.high, resolution_m));
  }
}

/// Cells whose lower left corner, as seen from the start's cell, is covered: wherever the start
/// lies, that point is one of the cell.
void drawCertain(const SweptShape& shape, double cosine, double sine, double erosion_m,
                 double resolution_m, Canvas* canvas) {
  const bool is_disc = shape.shadow.count == 1;
  const double radius_m = std::max(0.0, shape.shadow.radius_m - erosion_m);
  const double inset_m = std::max(0.0, erosion_m - shape.shadow.radius_m);
  if (is_disc && radius_m <= 0.0) return;
  const Outline outline(shape.shadow, cosine, sine, is_disc ? radius_m : 0.0);
  const int last = static_cast<int>(std::floor(outline.top() / resolution_m));
  for (int y = static_cast<int>(std::ceil(outline.bottom() / resolution_m)); y <= last; ++y) {
    const double y_m = y * resolution_m;
    const Interval x = is_disc ? outline.within(y_m, y_m) : outline.inside(y_m, inset_m);
    if (!(x.low <= x.high)) continue;
    canvas->draw(shape.classes, y, static_cast<int>(std::ceil(x.low / resolution_m)),
                 static_cast<int>(std::floor(x.high / resolution_m)));
  }
}

}  // namespace

SweepMask makeSweepMask(const std::vector<SweptShape>& covering,
                        const std::vector<SweptShape>& covered, int classes, double yaw_rad,
                        double half_bin_rad, double resolution_m) {
  const double cosine = std::cos(yaw_rad);
  const double sine = std::sin(yaw_rad);
  // No point of a shape moves further than this while the heading stays in its bin.
  const auto play_m = [&](const SweptShape& shape) {
    return 2.0 * shape.reach_m * std::sin(half_bin_rad / 2.0);
  };
  std::vector<Outline> outlines;
  outlines.reserve(covering.size());
  Interval x;
  Interval y;
  for (const SweptShape& shape : covering) {
    const double radius_m = shape.shadow.radius_m + play_m(shape) + kRounding_m;
    outlines.emplace_back(shape.shadow, cosine, sine, radius_m);
    x.add(outlines.back().left());
    x.add(outlines.back().right());
    y.add(outlines.back().bottom());
    y.add(outlines.back().top());
  }
  const CellBox box{firstCell(x.low, resolution_m), lastCell(x.high, resolution_m),
                    firstCell(y.low, resolution_m), lastCell(y.high, resolution_m)};
  Canvas outer(box, classes);
  for (std::size_t i = 0; i < covering.size(); ++i) {
    drawCovering(outlines[i], covering[i].classes, resolution_m, &outer);
  }
  Canvas certain(box, classes);
  for (const SweptShape& shape : covered) {
    drawCertain(shape, cosine, sine, play_m(shape) + kCertain_m, resolution_m, &certain);
  }
  SweepMask mask;
  mask.first_column = box.x0;
  mask.strips = outer.strips();
  mask.any = outer.appendTo((1U << classes) - 1, &mask.words);
  for (int c = 0; c < classes; ++c) mask.outer[c] = outer.appendTo(1U << c, &mask.words);
  for (int c = 0; c < classes; ++c) mask.certain[c] = certain.appendTo(1U << c, &mask.words);
  mask.words.shrink_to_fit();
  return mask;
}

}  // namespace casepush
