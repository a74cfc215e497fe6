#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "approach_library.h"
#include "patience.h"
#include "push_start.h"

namespace casepush {

/// A quick check whether the robot can get to a push: sufficient, not necessary. What it cannot
/// decide is left to RobotPathPlanner, which then finds the very way or knows that there is none.
/// All cases and names of models that it is asked for outlive it.
class ApproachCheck {
 public:
  /// @param grid     Of the map, for the library's discs.
  /// @param checker  With the obstacles, without the object to be pushed. All three outlive this.
  /// @param patience  Once it is over, the robot gets nowhere from afar.
  /// @param owner  Of all cases that it is asked for: what is known of them is kept as long as it
  ///   lives. May be nullptr.
  ApproachCheck(ApproachLibrary* library, const ClearanceGrid& grid,
                const CollisionChecker& checker, const std::vector<PlacedObject>& obstacles,
                Patience patience = Patience(), const std::shared_ptr<const void>& owner = nullptr);
  ~ApproachCheck();

  /// From where `previous` left the robot to the start of `next`, with the object in between.
  bool canFollow(const PlacedObject& object, const PreparedCase& previous,
                 const PreparedCase& next);

  /// From anywhere.
  bool canReach(const PlacedObject& object, const Pose2& map_T_robot, const PreparedCase& next);

 private:
  struct Standing {
    const ObjectClearance* clearance;
    PushStart map_T_object;
    Eigen::Vector2d position_m;

    float at(const Eigen::Vector2d& point_m) const {
      if (!isWithin(clearance->reach(), point_m)) return std::numeric_limits<float>::infinity();
      return clearance->at(map_T_object.turnedBack(point_m - position_m));
    }
    bool isWithin(double range_m, const Eigen::Vector2d& point_m) const {
      return std::abs(point_m.x() - position_m.x()) <= range_m &&
             std::abs(point_m.y() - position_m.y()) <= range_m;
    }
  };

  using Ways = ApproachLibrary::Ways;

  /// Where straight ways from a docked robot end: looked for only as far as somebody asks.
  struct Ends {
    Pose2 docked;  ///< In the object's frame, as `ways`.
    const std::vector<Pose2>* ways = nullptr;
    std::size_t looked = 0;
    int lines = 0;
    std::vector<Eigen::Vector2d> found;
  };

  /// Cells reached from one side.
  struct Front {
    std::uint32_t round;
    std::uint32_t other_round;
    std::uint32_t blocked;  ///< The mark of cells that neither can pass.
    Eigen::Vector2d towards;
    std::vector<std::pair<double, int>>& open;
  };

  void standAt(const PlacedObject& object);
  static Standing standing(const ObjectClearance& clearance, const Pose2& map_T_object);
  const Ways& waysOf(const std::string& model, const PreparedCase& push_case);
  bool isDirect(const std::string& model, const PreparedCase& previous, const PreparedCase& next);
  /// Among map and obstacles, at least where it is less than `enough_m`.
  float clearanceAround(int cell, const Eigen::Vector2d& centre_m, float enough_m) const;
  /// Also beside the object that is pushed.
  bool canPass(int cell, const Eigen::Vector2d& centre_m) const;
  bool isFreeLine(const Pose2& from, const Pose2& to) const;
  bool canTravelAt(const Eigen::Vector2d& point) const;
  bool canGoStraight(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  bool isClearLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                   const Standing* object) const;
  bool canGoAround(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double turn_rad) const;
  bool canGoPlainly(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  /// Nothing: that takes a longer search.
  std::optional<bool> canGo(Ends* from, Ends* to);
  std::optional<bool> connects(const Ends& from, const Ends& to);
  bool connectsFromAfar(const Ends& to);
  bool begin(const Ends& ends, Front& front);
  bool advance(Front& front);
  bool visit(const ClearanceGrid::Place& place, Front& front);
  void find(std::size_t wanted, Ends* ends) const;
  Ends& waysFrom(const PlacedObject& object, const Pose2& map_T_robot);
  Ends& waysOut(const PlacedObject& object, const PreparedCase& previous);

  ApproachLibrary& library_;
  const ClearanceGrid& grid_;
  const CollisionChecker& checker_;
  Patience patience_;
  std::vector<Standing> obstacles_;
  std::optional<Standing> object_;     // the one that is pushed, where it now stands
  std::vector<const Standing*> near_;  // obstacles that matter within kBeside_m of it
  std::unique_ptr<ApproachLibrary::Flood> flood_;
  // Of the last robot pose that canReach() was asked for.
  std::optional<std::pair<Pose2, Pose2>> begun_;
  Ends begun_ends_;
  /// Cells that the robot gets to from there, and those to go on from; empty until asked for.
  std::vector<std::uint8_t> reached_;
  std::vector<int> reached_cells_;
  std::size_t reached_done_ = 0;
  // Of the last end of a push that canFollow() was asked for.
  std::optional<std::pair<Pose2, const PreparedCase*>> left_;
  Ends left_ends_;
  std::unique_ptr<ApproachLibrary::Known> known_;
};

}  // namespace casepush
