#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
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
  float at(const Eigen::Vector2d& object_point_m) const;

 private:
  double reach_m_;
  int side_;
  std::vector<float> clearance_m_;
};

/// What approach checks need of map, robot, objects and cases, worked out once. Thread-safe.
class ApproachLibrary {
 public:
  ApproachLibrary(const CollisionChecker& map, const RobotModel& robot, const ObjectModels& objects,
                  const RobotPathOptions& options);

  /// The straight ways of a robot that leaves the object after a push, and that docks for one, if
  /// nothing but the object stands around.
  struct Ways {
    bool known = false;  ///< False if there is no such way.
    Pose2 object_T_undocked;
    Pose2 object_T_predock;
  };
  Ways ways(const std::string& model, const PreparedCase& push_case);
  const ObjectClearance& clearance(const std::string& model);

  const ClearanceGrid& grid() const { return grid_; }
  const Footprint& docking() const { return *docking_; }
  double minClearance() const { return min_clearance_m_; }

 private:
  Pose2 farther(const CollisionChecker& checker, const Pose2& docked, const Pose2& apart) const;
  Ways findWays(const std::string& model, const PreparedCase& push_case) const;

  const ObjectModels& objects_;
  std::vector<TravelDisc> discs_;
  ClearanceGrid grid_;
  std::shared_ptr<const Footprint> docking_;
  RobotPathPlanner paths_;
  CollisionChecker open_;
  double min_clearance_m_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<ObjectClearance>> clearances_;
  std::unordered_map<std::string, Ways> ways_;  // by model and the poses that matter
};

/// A quick check whether the robot can get to a push: sufficient, not necessary. What it cannot
/// decide is left to RobotPathPlanner, which then finds the very way or knows that there is none.
class ApproachCheck {
 public:
  /// @param checker  With the obstacles, without the object to be pushed.
  ApproachCheck(ApproachLibrary* library, const CollisionChecker& checker,
                const std::vector<PlacedObject>& obstacles);

  /// From where `previous` left the robot to the start of `next`, with the object in between.
  bool canFollow(const PlacedObject& object, const PreparedCase& previous,
                 const PreparedCase& next);

  /// From anywhere.
  bool canReach(const PlacedObject& object, const Pose2& map_T_robot, const PreparedCase& next);

 private:
  struct Window {
    int x0, y0, x1, y1;  // cells, all inclusive
  };

  Window stamp(const ObjectClearance& clearance, const Pose2& map_T_object);
  void restore(const Window& window);
  bool isFreeLine(const Pose2& from, const Pose2& to) const;
  bool canTravelAt(const Eigen::Vector2d& point) const;
  bool connects(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

  ApproachLibrary& library_;
  const CollisionChecker& checker_;
  std::vector<float> standing_;  // clearance among map and obstacles
  std::vector<float> current_;   // with the object, too, while a push is checked
  std::vector<std::uint32_t> visited_;
  std::uint32_t round_ = 0;
  std::vector<int> front_;
};

}  // namespace casepush
