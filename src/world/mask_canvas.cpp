#include "mask_canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "layered_bitmap.h"

namespace casepush {
namespace {

constexpr int kBits = LayeredBitmap::kBits;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding_m = 1e-6;
/// What is covered certainly is so by more than any contact tolerance.
constexpr double kCertain_m = 1e-4;

// std::floor() is a call without SSE 4.1, and there is one for every row of every shape.
int floorOf(double value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < truncated ? 1 : 0);
}
int ceilOf(double value) { return -floorOf(-value); }

/// First and last index of the cells, two cells wide, that reach into the open interval.
int firstCell(double low) { return floorOf(low - 1.0) + 1; }
int lastCell(double high) { return ceilOf(high + 1.0) - 1; }

}  // namespace

MaskCanvas::MaskCanvas(const CellBox& box, int classes)
    : box_(box),
      classes_(classes),
      strips_((box.x1 - box.x0) / kBits + 1),
      rows_((box.y1 - box.y0 + LayeredBitmap::kRowStep) / LayeredBitmap::kRowStep *
            LayeredBitmap::kRowStep),
      words_(static_cast<std::size_t>(classes) * strips_ * rows_, 0) {}

void MaskCanvas::draw(std::uint32_t classes, int y, int x_low, int x_high) {
  if (y < box_.y0 || y > box_.y1) return;
  const int low = std::max(x_low, box_.x0) - box_.x0;
  const int high = std::min(x_high, box_.x1) - box_.x0;
  for (int s = low / kBits; low <= high && s <= high / kBits; ++s) {
    const int first = std::max(low - s * kBits, 0);
    const int last = std::min(high - s * kBits, kBits - 1);
    const std::uint64_t bits =
        (~std::uint64_t{0} << first) & (~std::uint64_t{0} >> (kBits - 1 - last));
    std::uint64_t* word = words_.data() + static_cast<std::size_t>(s) * rows_ + (y - box_.y0);
    const std::size_t layer = static_cast<std::size_t>(strips_) * rows_;
    for (std::uint32_t rest = classes; rest != 0; rest &= rest - 1) {
      word[__builtin_ctz(rest) * layer] |= bits;
    }
  }
}

MaskPen::MaskPen(double yaw_rad, double half_bin_rad, double resolution_m)
    : cosine_(std::cos(yaw_rad) / resolution_m),
      sine_(std::sin(yaw_rad) / resolution_m),
      play_(2.0 * std::sin(half_bin_rad / 2.0) / resolution_m),
      cells_per_m_(1.0 / resolution_m) {}

void MaskPen::turn(const Eigen::Vector2d* points, int count) {
  count_ = count;
  bottom_ = kInfinity;
  top_ = -kInfinity;
  for (int i = 0; i < count_; ++i) {
    const Eigen::Vector2d& p = points[i];
    x_[i] = cosine_ * p.x() - sine_ * p.y();
    y_[i] = sine_ * p.x() + cosine_ * p.y();
    bottom_ = std::min(bottom_, y_[i]);
    top_ = std::max(top_, y_[i]);
  }
  x_[count_] = x_[0];
  y_[count_] = y_[0];
}

// No point of the shape moves further than this while the heading stays in its bin.
double MaskPen::play(const SweptShape& shape) const { return shape.reach_m * play_; }

CellBox MaskPen::boxOf(const std::vector<SweptShape>& shapes) const {
  double left = kInfinity;
  double right = -kInfinity;
  double bottom = kInfinity;
  double top = -kInfinity;
  for (const SweptShape& shape : shapes) {
    const double radius = (shape.radius_m + kRounding_m) * cells_per_m_ + play(shape);
    for (const Eigen::Vector2d& p : shape.points) {
      const double x = cosine_ * p.x() - sine_ * p.y();
      const double y = sine_ * p.x() + cosine_ * p.y();
      left = std::min(left, x - radius);
      right = std::max(right, x + radius);
      bottom = std::min(bottom, y - radius);
      top = std::max(top, y + radius);
    }
  }
  return {firstCell(left), lastCell(right), firstCell(bottom), lastCell(top)};
}

void MaskPen::clearRows(int first, int last, double low, double high) {
  first_row_ = first;
  const auto count = static_cast<std::size_t>(std::max(0, last - first + 1));
  low_.assign(count, low);
  high_.assign(count, high);
}

// The cell of row y is seen anywhere within (y - 1, y + 1), as the start lies anywhere in its own.
void MaskPen::addCorners(double radius) {
  for (int i = 0; i < count_; ++i) {
    const int last = lastCell(y_[i] + radius);
    for (int y = firstCell(y_[i] - radius); y <= last; ++y) {
      const double off = std::max({0.0, y - 1 - y_[i], y_[i] - (y + 1)});
      const double across = std::sqrt(std::max(0.0, radius * radius - off * off));
      double& low = low_[y - first_row_];
      double& high = high_[y - first_row_];
      low = std::min(low, x_[i] - across);
      high = std::max(high, x_[i] + across);
    }
  }
}

// The ends of the edges belong to the corners; in between an edge is extreme where rows begin.
void MaskPen::addEdges(double radius) {
  for (int i = 0; i < count_; ++i) {
    const double dx = x_[i + 1] - x_[i];
    const double dy = y_[i + 1] - y_[i];
    const double scale = radius / std::sqrt(dx * dx + dy * dy);
    const double from_x = x_[i] + dy * scale;
    const double from_y = y_[i] - dx * scale;
    const bool is_right = dy > 0.0;
    const int first = ceilOf(is_right ? from_y : from_y + dy);
    const int last = floorOf(is_right ? from_y + dy : from_y);
    if (first > last) continue;
    const double slope = dx / dy;
    double x = from_x + (first - from_y) * slope;
    double* rows = (is_right ? high_.data() : low_.data()) - first_row_;
    for (int y = first; y <= last; ++y, x += slope) {
      for (const int row : {y - 1, y + 1}) {
        rows[row] = is_right ? std::max(rows[row], x) : std::min(rows[row], x);
      }
    }
  }
}

void MaskPen::cover(double radius) {
  const int first = firstCell(bottom_ - radius);
  const int last = lastCell(top_ + radius);
  // One more at each end, for what rounding makes of an edge that just ends there.
  clearRows(first - 1, last + 1, kInfinity, -kInfinity);
  addCorners(radius);
  if (count_ > 1) addEdges(radius);
  cover_.clear();
  for (int y = first; y <= last; ++y) {
    const std::size_t row = y - first_row_;
    cover_.push_back({y, firstCell(low_[row]), lastCell(high_[row])});
  }
}

const std::vector<MaskPen::Row>& MaskPen::cover(const Shadow& shadow, double grown_m) {
  turn(shadow.points.data(), shadow.count);
  cover((shadow.radius_m + grown_m + kRounding_m) * cells_per_m_);
  return cover_;
}

void MaskPen::drawCovering(const SweptShape& shape, MaskCanvas* canvas) {
  turn(shape.points.data(), static_cast<int>(shape.points.size()));
  cover((shape.radius_m + kRounding_m) * cells_per_m_ + play(shape));
  for (const Row& row : cover_) canvas->draw(shape.classes, row.y, row.first, row.last);
}

// The x at each row's lower border around which everything within the inset lies in the polygon.
void MaskPen::cutEdges(double inset) {
  for (int i = 0; i < count_; ++i) {
    const double dx = x_[i + 1] - x_[i];
    const double dy = y_[i + 1] - y_[i];
    const double length = std::sqrt(dx * dx + dy * dy);
    constexpr double kLevel = 1e-9;
    const bool is_level = std::abs(dy) < kLevel * length;
    const double slope = is_level ? 0.0 : dx / dy;
    // On the edge moved inwards.
    const double x0 = x_[i] - inset * dy / length;
    const double y0 = y_[i] + inset * dx / length;
    for (std::size_t row = 0; row < low_.size(); ++row) {
      const double y = first_row_ + static_cast<double>(row);
      const double x = x0 + (y - y0) * slope;
      if (is_level) {
        if ((y - y0) * dx < 0.0) high_[row] = -kInfinity;
      } else if (dy > 0.0) {
        high_[row] = std::min(high_[row], x);
      } else {
        low_[row] = std::max(low_[row], x);
      }
    }
  }
}

void MaskPen::cutDisc(double radius) {
  for (std::size_t row = 0; row < low_.size(); ++row) {
    const double up = first_row_ + static_cast<double>(row) - y_[0];
    const double across = std::sqrt(std::max(0.0, radius * radius - up * up));
    low_[row] = x_[0] - across;
    high_[row] = x_[0] + across;
  }
}

void MaskPen::drawCertain(const SweptShape& shape, MaskCanvas* canvas) {
  const double erosion = kCertain_m * cells_per_m_ + play(shape);
  const double own = shape.radius_m * cells_per_m_;
  const bool is_disc = shape.points.size() == 1;
  const double radius = is_disc ? own - erosion : 0.0;
  if (radius < 0.0 || (is_disc && radius == 0.0)) return;
  turn(shape.points.data(), static_cast<int>(shape.points.size()));
  const int first = ceilOf(bottom_ - radius);
  clearRows(first, floorOf(top_ + radius), -kInfinity, kInfinity);
  if (is_disc) {
    cutDisc(radius);
  } else {
    cutEdges(std::max(0.0, erosion - own));
  }
  for (std::size_t row = 0; row < low_.size(); ++row) {
    if (!(low_[row] <= high_[row])) continue;
    canvas->draw(shape.classes, first + static_cast<int>(row), ceilOf(low_[row]),
                 floorOf(high_[row]));
  }
}

}  // namespace casepush
