#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "casepush/world/sweep_checker.h"

namespace casepush {

/// Answers of the covering masks for all start poses on one map and many sweeps, made beforehand:
/// one look-up tells which of 64 sweeps may collide.
///
/// Says exactly what SweepChecker::mayCollide() says on the map without obstacles, wherever the
/// start lies within the map, and so never misses a collision with the map. What it calls free
/// still has to be tested against obstacles, what it calls blocked may still be free by the true
/// shapes; a map that changes needs a new table. Takes 128 x cells of the map x (sweeps / 8,
/// rounded up) bytes. Thread safety: const methods are reentrant.
class StaticTable {
 public:
  static constexpr std::size_t kDefaultLimit_bytes = 512000000;

  /// @param sweeps  Made with the height classes of `checker`. They are not kept, and their masks
  ///                neither used nor made.
  /// @throws InputError if the table would take more memory than the limit, or a sweep reaches
  ///         farther than the checker was made for.
  /// @pre There is a sweep, and none is null.
  StaticTable(const SweepChecker& checker, const std::vector<const Sweep*>& sweeps,
              std::size_t limit_bytes = kDefaultLimit_bytes);

  int sweeps() const { return sweeps_; }
  int words() const { return (sweeps_ + 63) / 64; }
  std::size_t bytes() const { return bytes_.size(); }

  /// Bit i is set if sweep 64 * word + i may collide with the map. From a start outside the map or
  /// a pose that is not finite, every sweep may. @pre 0 <= word < words()
  std::uint64_t blocked(const Pose2& map_T_start, int word = 0) const;

  /// Bit i is set if there is a sweep 64 * word + i and it is free.
  std::uint64_t free(const Pose2& map_T_start, int word = 0) const;

 private:
  void fill(const SweepChecker& checker, const std::vector<const Sweep*>& sweeps);
  void write(const std::vector<std::vector<std::uint64_t>>& tiles, int heading, int width,
             int height, std::size_t group);
  std::uint64_t allOf(int word) const;

  int sweeps_;
  std::size_t stride_;  ///< Bytes of a start, one bit a sweep.
  Eigen::Vector2d origin_m_{0.0, 0.0};
  double cells_per_m_ = 0.0;
  int width_ = 0;
  int height_ = 0;
  /// For each heading the starts in the order of the map's image that the heading's mask is for:
  /// row-major, turned by heading / 32 quarters.
  std::vector<std::uint8_t> bytes_;
};

}  // namespace casepush
