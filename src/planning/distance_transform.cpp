#include "distance_transform.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr float kFar = 1e6F;  // Cells; its square is still far from the end of float's range.

/// Vertical distance to the nearest occupied square of the same column.
std::vector<float> columnDistances(const std::vector<std::uint8_t>& occupied, int width, int height,
                                   const Patience& patience) {
  std::vector<float> gap(occupied.size(), kFar);
  // Row by row, as they lie in memory: from the centre above or below each occupied square.
  std::vector<float> since(width);
  const auto sweep = [&](int first, int end, int step) {
    std::fill(since.begin(), since.end(), kFar);
    for (int y = first; y != end && !patience.isOverAfter(width); y += step) {
      const std::size_t row = static_cast<std::size_t>(y) * width;
      for (int x = 0; x < width; ++x) {
        since[x] = occupied[row + x] != 0 ? 0.0F : std::min(kFar, since[x] + 1.0F);
        gap[row + x] = std::min(gap[row + x], std::max(0.0F, since[x] - 0.5F));
      }
    }
  };
  sweep(0, height, 1);
  sweep(height - 1, -1, -1);
  return gap;
}

/// Lower envelope of the parabolas f[i] + (x - i)^2.
class Envelope {
 public:
  explicit Envelope(int count) : sites_(count), starts_(count + 1) {}

  void build(const std::vector<float>& f) {
    last_ = 0;
    sites_[0] = 0;
    starts_[0] = -kFar;
    for (int i = 1; i < static_cast<int>(f.size()); ++i) {
      double start = crossing(f, sites_[last_], i);
      while (last_ > 0 && start <= starts_[last_]) start = crossing(f, sites_[--last_], i);
      if (start <= starts_[last_]) {
        sites_[last_] = i;
        continue;
      }
      ++last_;
      sites_[last_] = i;
      starts_[last_] = start;
    }
  }

  /// Site of the lowest parabola at x; x must not decrease from call to call after build().
  int lowest(double x, int* cursor) const {
    while (*cursor < last_ && starts_[*cursor + 1] <= x) ++*cursor;
    return sites_[*cursor];
  }

 private:
  static double crossing(const std::vector<float>& f, int left, int right) {
    return 0.5 * (left + right) + 0.5 * (double{f[right]} - f[left]) / (right - left);
  }

  std::vector<int> sites_;
  std::vector<double> starts_;
  int last_ = 0;
};

}  // namespace

std::vector<float> distanceToSquares(const std::vector<std::uint8_t>& occupied, int width,
                                     int height, const Patience& patience) {
  std::vector<float> result = columnDistances(occupied, width, height, patience);
  if (width == 0) return result;
  // Edge i lies between the cells i - 1 and i of a row, at x = i; centres are at x + 0.5.
  std::vector<float> edges(width + 1);
  Envelope envelope(width + 1);
  for (int y = 0; y < height && !patience.isOverAfter(2 * width); ++y) {
    float* row = result.data() + static_cast<std::size_t>(y) * width;
    for (int i = 0; i <= width; ++i) {
      const float left = i > 0 ? row[i - 1] : kFar;
      const float right = i < width ? row[i] : kFar;
      edges[i] = std::min(left, right) * std::min(left, right);
    }
    envelope.build(edges);
    int cursor = 0;
    for (int x = 0; x < width; ++x) {
      const int edge = envelope.lowest(x + 0.5, &cursor);
      const float across = static_cast<float>(x) + 0.5F - static_cast<float>(edge);
      row[x] = std::min(row[x], std::sqrt(edges[edge] + across * across));
    }
  }
  return result;
}

}  // namespace casepush
