#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "casepush/common/pose2.h"

namespace casepush {

class Footprint;
class HeightClasses;
class SweepHulls;
class SweepMask;

/// A body and the poses that it takes during a motion, in the frame where the motion starts.
struct Track {
  enum class Kind {
    kPath,      ///< Poses in the order of the motion, near each other.
    kSeparate,  ///< Poses that have nothing to do with each other, e.g. sigma points.
  };
  std::shared_ptr<const Footprint> body;
  std::vector<Pose2> start_T_body;
  Kind kind = Kind::kPath;
};

/// Memory that the masks of all sweeps that share it may take. Thread-safe.
class MaskMemory {
 public:
  explicit MaskMemory(std::size_t limit_bytes) : limit_bytes_(limit_bytes) {}
  std::size_t limit() const { return limit_bytes_; }
  std::size_t used() const { return used_bytes_; }
  bool isFull() const { return used_bytes_ >= limit_bytes_; }
  void take(std::size_t bytes) { used_bytes_ += bytes; }
  void give(std::size_t bytes) { used_bytes_ -= bytes; }

 private:
  std::size_t limit_bytes_;
  std::atomic<std::size_t> used_bytes_{0};
};

/// Everything that some bodies cover during one motion, ready to be tested at any start pose.
///
/// For each of 128 headings of the start there is a mask of the cells that may be covered, for each
/// class of heights, and one of the cells that certainly are. Headings a quarter turn apart share
/// them. A heading's masks are made when they are first asked for (some 50 us) and kept. Thread
/// safety: const methods are reentrant.
class Sweep {
 public:
  /// @param classes  Height classes of all bodies involved.
  /// @param memory  No more masks are made while it is full; null: there is no limit.
  /// @pre There is a track, every track has a pose, and every body the same resolution.
  Sweep(std::vector<Track> tracks, std::shared_ptr<const HeightClasses> classes,
        std::shared_ptr<MaskMemory> memory = nullptr);
  ~Sweep();
  Sweep(const Sweep&) = delete;
  Sweep& operator=(const Sweep&) = delete;

  const std::vector<Track>& tracks() const;
  static constexpr int kHeadings = 128;
  /// Which of the kHeadings bins a heading lies in; bin 0 is the one around 0. @pre It is finite.
  static int heading(double yaw_rad);

  double reach() const;  ///< No covered point is farther from the start [m].

  /// A pose of a track, ready to take points to the body's frame.
  struct Stop {
    Eigen::Vector2d position_m;
    double cosine;
    double sine;
  };
  const std::vector<Stop>& stops(std::size_t track) const;

  /// Masks of the heading's bin, for the map turned clockwise by some quarters.
  struct Turned {
    const SweepMask* mask;  ///< Null if there is none and no memory for one.
    int quarters;
  };
  Turned mask(double yaw_rad) const;
  /// The shapes from which masks are drawn. @pre mask() has given one before.
  const SweepHulls& hulls() const;

  /// Memory that the masks made so far take, with what they are made from.
  std::size_t bytes() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
