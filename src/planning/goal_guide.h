#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "casepush/model/object_model.h"
#include "casepush/world/collision_checker.h"
#include "clearance_grid.h"
#include "grid_flood.h"
#include "room_landmarks.h"

namespace casepush {

/// How much room a map leaves an object, in cells of about 20 cm. Made once for map and object.
class ObjectRoom {
 public:
  /// @param patience  Once it is over, the room is unfinished.
  ObjectRoom(const CollisionChecker::Columns& columns, const Solid& object,
             const Patience& patience = Patience());

  /// For columns of the same extent that differ only within an area: as if made anew, but for the
  /// landmarks, which somebody may want to set.
  ObjectRoom updated(const CollisionChecker::Columns& columns,
                     const CollisionChecker::Area& changed) const;

  int width() const { return width_; }
  int height() const { return height_; }
  double cell() const { return cell_m_; }
  Eigen::Vector2d centre(int cell) const {
    return origin_m_ + cell_m_ * Eigen::Vector2d(cell % width_ + 0.5, cell / width_ + 0.5);
  }
  Eigen::Vector2d index(const Eigen::Vector2d& point_m) const {
    return (point_m - origin_m_) / cell_m_;
  }

  /// Row by row, with a rim of one cell around the room. A metre counts up to kTight where only
  /// some headings fit; nothing leads where the object's origin certainly cannot be.
  std::vector<HalfSteps> halfSteps(const std::vector<PlacedSolid>& obstacles) const;

  /// Of the room without obstacles; empty if nobody has set them since an update.
  const RoomLandmarks& landmarks() const { return landmarks_; }
  /// @param patience  Once it is over, there are none.
  void setLandmarks(const Patience& patience);

  static constexpr double kTight = 3.0;

 private:
  std::vector<float> factors(const std::vector<PlacedSolid>& obstacles) const;
  float factor(double clearance_m) const;
  void look(const CollisionChecker::Columns& columns, const CellBox& box, const Patience& patience);

  Eigen::Vector2d origin_m_;
  int side_;  ///< Cells of the map in one of these.
  double cell_m_;
  int width_;
  int height_;
  std::vector<TravelDisc> inner_;
  std::vector<TravelDisc> outer_;
  double reach_m_;  ///< Of the object around its origin.
  std::vector<float> factors_;
  RoomLandmarks landmarks_;
};

/// The rooms of all objects on one map, each made when it is first asked for. Thread-safe.
class RoomLibrary {
 public:
  RoomLibrary(const CollisionChecker& map, const std::map<std::string, ObjectModel>& objects);

  /// For `checker.updated(map, changed)`, if this is for `checker`; what it does not change is
  /// taken over.
  std::shared_ptr<RoomLibrary> updated(const CollisionChecker& map,
                                       const CollisionChecker::Area& changed);

  /// nullptr if `patience` was over before it was made.
  const ObjectRoom* get(const std::string& model, const Patience& patience);

 private:
  std::shared_ptr<const CollisionChecker::Columns> columns_;
  std::map<std::string, ObjectModel> objects_;
  std::mutex mutex_;
  std::map<std::string, ObjectRoom> rooms_;
};

/// Roughly how far an object has to go to its goal from anywhere, around walls and obstacles and
/// rather through wide places than narrow ones. It guides the search and bounds nothing.
///
/// It is a search from the goal, towards the start first, that goes on only as far as somebody asks
/// (RRA*, Silver 2005): the answers do not depend on what was asked before.
class GoalGuide {
 public:
  /// Looks a little farther than from goal to start, not over the whole of a large map.
  /// @param half_steps  Of the room with all obstacles. Both outlive this.
  GoalGuide(const ObjectRoom& room, const std::vector<HalfSteps>& half_steps,
            const Eigen::Vector2d& start_m, const Eigen::Vector2d& goal_m, double tolerance_m);
  GoalGuide(const GoalGuide&) = delete;
  GoalGuide& operator=(const GoalGuide&) = delete;

  /// False only if there is certainly no way of the object's origin from start to the
  /// goal region.
  bool reachesStart() const { return reaches_start_; }

  double at(const Eigen::Vector2d& point_m) { return look<true>(point_m).length_m; }  ///< [m]

  struct Way {
    double length_m;
    bool is_exact;  ///< Or at() says more.
  };
  /// At least so far, without going on.
  Way atLeast(const Eigen::Vector2d& point_m) { return look<false>(point_m); }

 private:
  static constexpr int kReciprocal = 40;  // Bits: exact for any map, at most 4096 x 4096 cells.

  // Bilinear between the centres of cells.
  template <bool goes_on>
  Way look(const Eigen::Vector2d& point_m) {
    const double fx = std::clamp((point_m.x() - low_m_.x()) * cells_per_m_, 0.0, last_.x());
    const double fy = std::clamp((point_m.y() - low_m_.y()) * cells_per_m_, 0.0, last_.y());
    const int x = static_cast<int>(fx);
    const int y = static_cast<int>(fy);
    const int cell = (y + 1) * stride_ + x + 1;
    const float* const below = &way_m_[cell];
    const float* const above = below + stride_;
    const auto isExact = [below, above] {
      return std::min(std::min(below[0], below[1]), std::min(above[0], above[1])) >= 0.0F;
    };
    bool is_exact = isExact();
    if (!is_exact) {
      for (const int corner : {cell, cell + 1, cell + stride_, cell + stride_ + 1}) {
        goes_on ? settle(corner) : bound(corner);
      }
      is_exact = isExact();
    }
    const double tx = fx - x;
    const double ty = fy - y;
    const double way_m = (1.0 - ty) * ((1.0 - tx) * std::abs(below[0]) + tx * std::abs(below[1])) +
                         ty * ((1.0 - tx) * std::abs(above[0]) + tx * std::abs(above[1]));
    return {std::max(way_m, (point_m - goal_m_).norm()), is_exact};
  }

  int cell(const Eigen::Vector2d& point_m) const;
  int rowOf(int cell) const {
    return static_cast<int>(static_cast<std::uint64_t>(cell) * per_row_ >> kReciprocal);
  }
  int estimate(int cell) const;
  std::vector<int> region(double tolerance_m) const;
  bool reach(int start, const std::vector<int>& goals);
  void settle(int cell);
  void bound(int cell);
  template <typename Estimate>
  void spread(int cell, const Estimate& estimate);

  Eigen::Vector2d goal_m_;
  const ObjectRoom& room_;
  int stride_;             // There is a rim of one cell around the room.
  std::uint64_t per_row_;  // its reciprocal, see rowOf()
  Eigen::Vector2d low_m_;  // centre of the first cell
  Eigen::Vector2d last_;   // of the last cell, from there and in cells
  double cells_per_m_;
  std::vector<HalfSteps> freed_;  // where start or goal is not free
  const HalfSteps* half_steps_;   // those, or the room's
  GridFlood flood_;
  int start_x_ = 0;  // Where the estimate leads.
  int start_y_ = 0;
  int start_ = 0;
  int goal_ = 0;
  bool has_landmarks_ = false;
  bool is_estimated_ = false;
  bool reaches_start_ = false;
  float far_m_ = 0.0F;  // What lies farther away is not told apart.
  // From each cell to the goal; negative: at least so long, or unknown.
  std::vector<float> way_m_;
};

}  // namespace casepush
