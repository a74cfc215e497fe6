#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "casepush/planning/prepared_cases.h"
#include "casepush/planning/robot_path_planner.h"
#include "clearance_grid.h"
#include "plan_request.h"

namespace casepush {

/// A lower bound of the robot's clearance around a standing object, looked up in its frame.
class ObjectClearance {
 public:
  ObjectClearance(const Solid& object, const std::vector<TravelDisc>& discs);

  /// Where the object limits the clearance at all [m].
  double reach() const { return reach_m_; }
  /// Where the robot is beside the object whichever way that is turned [m].
  double beside() const { return beside_m_; }
  /// Falls by no more from one point to another than they are apart and kRounding_m.
  float at(const Eigen::Vector2d& object_point_m) const {
    // What is positive is rounded down by conversion.
    const double x = object_point_m.x() / kNode_m + 0.5 + side_ / 2;
    const double y = object_point_m.y() / kNode_m + 0.5 + side_ / 2;
    if (!(x >= 0.0 && y >= 0.0 && x < side_ && y < side_)) return static_cast<float>(kRange_m);
    return clearance_m_[static_cast<std::size_t>(y) * side_ + static_cast<std::size_t>(x)];
  }
  static constexpr double kRounding_m = 0.03;

 private:
  static constexpr double kNode_m = 0.02;  // Spacing of the table's nodes.
  static constexpr double kRange_m = 0.3;  // Clearance is exact up to this.

  double reach_m_;
  double beside_m_;
  int side_;
  std::vector<float> clearance_m_;
};

/// What approach checks need of robot, objects and cases, worked out once, whatever the map.
/// Thread-safe.
class ApproachLibrary {
 public:
  /// @param checker  Of any map with the resolution of those to come.
  ApproachLibrary(const CollisionChecker& checker, const RobotModel& robot,
                  const ObjectModels& objects, const RobotPathOptions& options);

  /// Straight ways of a robot that leaves the object after a push, and that docks for one, past
  /// nothing but the object: their ends in the object's frame, the nearest first.
  struct Ways {
    std::vector<Pose2> object_T_undocked;
    std::vector<Pose2> object_T_predock;
  };
  std::shared_ptr<const Ways> ways(const std::string& model, const PreparedCase& push_case);
  const ObjectClearance& clearance(const std::string& model);

  /// Does the robot get straight from where `previous` left it to the start of `next`?
  bool isDirect(const std::string& model, const PreparedCase& previous, const PreparedCase& next);

  /// Visits ends of straight ways away from `start`, among the checker's map and obstacles, the
  /// nearest first, until `visit` says false.
  void waysOut(const CollisionChecker& checker, const Pose2& start,
               const std::function<bool(const Pose2&)>& visit) const;

  /// Cells that a flood has visited, and in which round.
  struct Flood {
    std::vector<std::uint32_t> visited;
    std::uint32_t round = 0;
    std::vector<std::pair<double, int>> ahead;  // cells to go on from, the nearest to the end first
    std::vector<std::pair<double, int>> back;
  };
  std::unique_ptr<Flood> borrowFlood(int cells);
  void giveBack(std::unique_ptr<Flood> flood);

  /// What this said of some cases: to find them by their content takes longer.
  struct Known {
    std::weak_ptr<const void> owner;  ///< Of the cases.
    std::unordered_map<const PreparedCase*, std::shared_ptr<const Ways>> ways;
    std::unordered_map<const PreparedCase*, std::unordered_map<const PreparedCase*, bool>> direct;
  };
  /// As it was given back for the same owner, or empty.
  std::unique_ptr<Known> borrowKnown(const std::shared_ptr<const void>& owner);
  void giveBack(std::unique_ptr<Known> known);

  const Solid& solid(const std::string& model) const { return objects_.at(model).solid; }
  /// The robot where it travels: what the grid for ApproachCheck is made with.
  const std::vector<TravelDisc>& discs() const { return discs_; }
  const Footprint& docking() const { return *docking_; }
  double minClearance() const { return min_clearance_m_; }

 private:
  Ways findWays(const std::string& model, const PreparedCase& push_case);

  const ObjectModels objects_;
  const std::vector<TravelDisc> discs_;
  std::shared_ptr<const Footprint> docking_;
  std::shared_ptr<const Footprint> plain_;
  CollisionChecker open_;
  double min_clearance_m_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<ObjectClearance>> clearances_;
  std::unordered_map<std::string, std::shared_ptr<const Ways>> ways_;  // by model and poses
  std::unordered_map<std::string, bool> direct_;
  std::vector<std::unique_ptr<Flood>> floods_;
  std::vector<std::unique_ptr<Known>> known_;
};

}  // namespace casepush
