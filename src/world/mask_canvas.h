#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "casepush/world/cell_box.h"
#include "swept_shapes.h"

namespace casepush {

/// One bit image for each height class while a mask is being drawn, relative to the start's cell.
class MaskCanvas {
 public:
  MaskCanvas(const CellBox& box, int classes);

  const CellBox& box() const { return box_; }
  int classes() const { return classes_; }
  int strips() const { return strips_; }
  int rows() const { return rows_; }  ///< A multiple of LayeredBitmap::kRowStep.

  /// Words of one class and strip, rows() of them.
  const std::uint64_t* column(int height_class, int strip) const {
    return words_.data() + (static_cast<std::size_t>(height_class) * strips_ + strip) * rows_;
  }

  /// Sets the cells x_low, ..., x_high of a row, as far as they lie in the box.
  void draw(std::uint32_t classes, int y, int x_low, int x_high);

 private:
  CellBox box_;
  int classes_;
  int strips_;
  int rows_;
  std::vector<std::uint64_t> words_;
};

/// Draws shapes turned to one heading.
class MaskPen {
 public:
  /// @param half_bin_rad  Masks are to be valid for headings within +- this of `yaw_rad`.
  MaskPen(double yaw_rad, double half_bin_rad, double resolution_m);

  /// Cells first, ..., last of a row.
  struct Row {
    int y;
    int first;
    int last;
  };

  /// Cells that a grown shadow may reach into at the heading itself, wherever in its cell the start
  /// lies. Valid until the next call.
  const std::vector<Row>& cover(const Shadow& shadow, double grown_m);

  /// The same for all headings of the bin. A canvas for it must hold boxOf().
  void drawCovering(const SweptShape& shape, MaskCanvas* canvas);
  CellBox boxOf(const std::vector<SweptShape>& shapes) const;

  /// Cells that the shape certainly reaches into: those of which the lower left corner, as seen
  /// from the start's cell, is covered; that point is one of the cell wherever the start lies.
  void drawCertain(const SweptShape& shape, MaskCanvas* canvas);

 private:
  void turn(const Eigen::Vector2d* points, int count);
  void cover(double radius);
  double play(const SweptShape& shape) const;
  void clearRows(int first, int last, double low, double high);
  void addCorners(double radius);
  void addEdges(double radius);
  void cutEdges(double inset);
  void cutDisc(double radius);

  double cosine_;  ///< Both over the resolution: from metres to cells.
  double sine_;
  double play_;
  double cells_per_m_;
  // The shape at hand, in cells.
  int count_ = 0;
  std::array<double, Shadow::kMaxPoints + 1> x_;
  std::array<double, Shadow::kMaxPoints + 1> y_;
  double bottom_ = 0.0;
  double top_ = 0.0;
  int first_row_ = 0;
  std::vector<double> low_;  ///< Of each row from first_row_ on.
  std::vector<double> high_;
  std::vector<Row> cover_;
};

}  // namespace casepush
