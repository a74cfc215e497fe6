#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
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
  std::unique_ptr<Flood> borrowFlood();
  void giveBack(std::unique_ptr<Flood> flood);

  const Solid& solid(const std::string& model) const { return objects_.at(model).solid; }
  const ClearanceGrid& grid() const { return grid_; }
  const Footprint& docking() const { return *docking_; }
  double minClearance() const { return min_clearance_m_; }

 private:
  Ways findWays(const std::string& model, const PreparedCase& push_case);

  const ObjectModels& objects_;
  std::vector<TravelDisc> discs_;
  ClearanceGrid grid_;
  std::shared_ptr<const Footprint> docking_;
  std::shared_ptr<const Footprint> plain_;
  CollisionChecker open_;
  double min_clearance_m_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<ObjectClearance>> clearances_;
  std::unordered_map<std::string, std::shared_ptr<const Ways>> ways_;  // by model and poses
  std::unordered_map<std::string, bool> direct_;
  std::vector<std::unique_ptr<Flood>> floods_;
};

/// A quick check whether the robot can get to a push: sufficient, not necessary. What it cannot
/// decide is left to RobotPathPlanner, which then finds the very way or knows that there is none.
class ApproachCheck {
 public:
  /// @param checker  With the obstacles, without the object to be pushed. Both outlive this.
  ApproachCheck(ApproachLibrary* library, const CollisionChecker& checker,
                const std::vector<PlacedObject>& obstacles);
  ~ApproachCheck();

  /// From where `previous` left the robot to the start of `next`, with the object in between.
  bool canFollow(const PlacedObject& object, const PreparedCase& previous,
                 const PreparedCase& next);

  /// From anywhere.
  bool canReach(const PlacedObject& object, const Pose2& map_T_robot, const PreparedCase& next);

 private:
  struct Standing {
    const ObjectClearance* clearance;
    Pose2 map_T_object;
    double cosine;
    double sine;

    float at(const Eigen::Vector2d& point_m) const;
  };

  using Ends = std::vector<Eigen::Vector2d>;

  /// Cells reached from one side.
  struct Front {
    std::uint32_t round;
    std::uint32_t other_round;
    Eigen::Vector2d towards;
    std::vector<std::pair<double, int>>& open;
  };

  static Standing standing(const ObjectClearance& clearance, const Pose2& map_T_object);
  float clearanceAround(int cell) const;  ///< Among map and obstacles.
  float clearanceAt(int cell) const;      ///< And beside the object that is pushed.
  bool isFreeLine(const Pose2& from, const Pose2& to) const;
  bool canTravelAt(const Eigen::Vector2d& point) const;
  bool connects(const Ends& from, const Ends& to, int most_cells);
  bool begin(const Ends& ends, Front& front);
  bool advance(Front& front);
  bool visit(int cell, Front& front);
  Ends freeEnds(const Pose2& map_T_object, const Pose2& docked,
                const std::vector<Pose2>& ends) const;
  const Ends& waysFrom(const PlacedObject& object, const Pose2& map_T_robot);

  ApproachLibrary& library_;
  const CollisionChecker& checker_;
  std::vector<Standing> obstacles_;
  std::optional<Standing> object_;  // the one that is pushed, where it now stands
  std::unique_ptr<ApproachLibrary::Flood> flood_;
  // Of the last robot pose that canReach() was asked for.
  std::optional<std::pair<Pose2, Pose2>> begun_;
  Ends begun_ends_;
};

}  // namespace casepush
