#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "casepush/common/pose_gaussian.h"

namespace casepush {

/// An instance of an object somewhere.
struct PlacedObject {
  std::string id;
  std::string model;
  Pose2 map_T_object;
};

/// Success region of a push task (paper section 6: 0.2 m and pi/9).
struct GoalTolerance {
  double position_m = 0.2;
  double yaw_rad = 0.34906585039886590;  // pi / 9

  bool isMet(const Pose2& goal, const Pose2& pose) const;
};

/// One push of a plan.
struct PlannedPush {
  std::int64_t case_id = 0;
  Pose2 map_T_start;         ///< Where the object stands before the push (phi_S in phi_G).
  PoseGaussian map_outcome;  ///< Where it is expected to rest if it starts exactly there.
  /// Where it is expected to rest if the pushes before it scatter, too, and nobody plans anew; the
  /// covariance is in the frame of the mean. See compoundPushes().
  PoseGaussian map_compounded{};
  /// Probability that object or robot collides in this push; see PushPlan::collision_probability.
  double collision_probability = 0.0;
};

/// A chain of pushes.
struct PushPlan {
  PlacedObject object;  ///< At the start.
  Pose2 map_T_goal;
  GoalTolerance tolerance;
  std::vector<PlannedPush> pushes;
  double zeta = 3.0;  ///< Spread of the sigma points that every push was checked with.

  /// Of a plan made with chance constraints: what `collision_probability` may be at most. Nothing
  /// if the sigma points of `zeta` were checked instead.
  std::optional<double> max_collision_probability;

  /// Of a plan made with chance constraints: estimated probability that any of its pushes collides,
  /// with the robot looking where the object is after each push.
  double collision_probability = 0.0;

  /// Probability that the last push ends in the goal region if all pushes are executed as planned
  /// and nobody plans anew. See compoundPushes().
  double goal_probability = 0.0;

  double lengthM() const;  ///< Sum of the distances between successive resting poses.
};

struct PlanRequest {
  PlacedObject object;
  Pose2 map_T_goal;
  GoalTolerance tolerance;
  Pose2 map_T_robot;
  std::vector<PlacedObject> obstacles;  ///< Other known objects; they stand still.
  std::uint64_t seed = 1;
  double deadline_s = 10.0;  ///< Wall time; the planner returns by then.
};

enum class PlanStatus {
  kSolved,
  kInvalidRequest,  ///< Not finite, unknown object, bad tolerance.
  kNoCases,         ///< The case base has none for this object.
  kStartInCollision,
  kGoalInCollision,
  kGoalOutsideMap,
  kUnreachable,  ///< The whole tree was grown and no plan found.
  kDeadline,
  kCancelled,
  kPlannerGone,  ///< Whoever should plan does not answer.
};
const char* toString(PlanStatus status);

/// One edge of the search tree, for display.
struct TreeEdge {
  Pose2 from;
  Pose2 to;
};

struct PlanResult {
  PlanStatus status = PlanStatus::kInvalidRequest;
  std::string explanation;  ///< One line for a person, also when solved.
  PushPlan plan;
  int nodes = 0;  ///< Tree size.
  int collision_checks = 0;
  double expected_s = 0.0;  ///< Time that the plan's execution will take, with its risks.
  double bound = 0.0;       ///< The plan costs at most this times the cheapest one; 0: unknown.
  /// Push (from 1) that may leave the object where no case can be applied, though its mean does not,
  /// and no other plan was found. 0: none, or not looked at.
  int dead_end = 0;
  double planning_s = 0.0;  ///< Wall time; the only field that a seed does not fix.
  std::vector<TreeEdge> tree;
};

/// How behaviours ask for plans: directly in the lab, over an action under ROS. Never blocks long.
class PlanClient {
 public:
  virtual ~PlanClient() = default;
  virtual void request(const PlanRequest& request) = 0;  ///< Replaces a pending request.
  virtual std::optional<PlanResult> poll() = 0;          ///< The result, once.
  virtual void cancel() = 0;
  virtual bool isAlive() const = 0;  ///< False as soon as the planner is known to be gone.
};

}  // namespace casepush
