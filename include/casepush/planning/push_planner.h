#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/object_model.h"
#include "casepush/model/push_plan.h"
#include "casepush/model/robot_model.h"
#include "casepush/planning/clearing.h"
#include "casepush/planning/planner_kind.h"
#include "casepush/planning/push_time.h"
#include "casepush/planning/risk_options.h"
#include "casepush/planning/robot_path_planner.h"
#include "casepush/planning/similarity.h"
#include "casepush/world/map.h"

namespace casepush {

struct PushPlannerOptions {
  PlannerKind planner = PlannerKind::kExpRrt;  ///< kExpRrtPaper: see forPlanner().
  Similarity similarity = Similarity::kMetric;
  double goal_bias = 0.8;              ///< Probability that the sample is the goal (paper: 0.95).
  int max_nodes = 50625;               ///< Paper section 6.
  double zeta = 3.0;                   ///< Spread of the sigma points (paper: 3).
  bool relax = true;                   ///< Try smaller zeta, or larger risks, if there is no plan.
  double object_margin_m = 0.0;        ///< Grows the object in every check.
  double robot_margin_m = 0.03;        ///< Grows the robot along its recorded trajectories.
  int solutions = 16;                  ///< Solutions to compare before the cheapest is returned.
  int improvement_extensions = 20000;  ///< Search for cheaper plans after the first one.
  double spacing_m = 0.1;  ///< Of tree nodes nearer than this only the cheaper one grows.
  RiskOptions risk;        ///< Chance constraints in the place of sigma points.
  /// For masks that make collision checks fast; what finds no room is checked more slowly. A case
  /// takes 0.2 MB. Those that were not used for longest make room.
  int mask_memory_mb = 256;
  PushTimeOptions time;  ///< What the robot's way between pushes costs.
  RobotPathOptions robot_path;

  /// Options of a planner: those of the paper for kExpRrtPaper, else the defaults.
  static PushPlannerOptions forPlanner(PlannerKind kind);
  /// Looks for cheaper plans as long as the request allows.
  void improveUntilDeadline();
  void validate() const;  ///< @throws InputError listing every violation.
};

/// How far a search has come.
struct PlanProgress {
  double elapsed_s = 0.0;  ///< Wall time since the call.
  int nodes = 0;           ///< Poses of the object reached so far, in all searches of the call.
  double best_cost_s = std::numeric_limits<double>::infinity();  ///< Expected time of the best
                                                                 ///< plan; infinite before one.
};

/// Plans chains of cases that bring an object to a goal, achievable for object and robot.
///
/// Exp-RRT (paper algorithm 1) with the choices of docs/method.md. Each push is checked with the
/// object's mean trajectory, its sigma points and the robot's trajectory; a plan whose next start
/// pose the robot cannot reach is not returned.
/// Where no plan exists that is safe at the sigma points of `zeta`, e.g. because the object stands
/// in a tight spot, the largest smaller whole value down to 0 (the mean only) is taken for which
/// there is one; the plan holds it, and the explanation says so. Where few poses are reached and no
/// plan is found, nodes are tried that are nearer to one another, and then cases with negative ids.
/// Exp-RRT keeps out of dead ends: poses that a push may end in, and that no cases lead on from.
/// With chance constraints the mean motions must be safe and the whole plan must keep the collision
/// probability; larger ones are tried where there is no such plan, and expected recoveries count as
/// time. Deterministic for a given request and seed unless the deadline cuts it off: all budgets
/// count nodes and extensions. Thread safety: const methods are reentrant.
class PushPlanner {
 public:
  /// @throws InputError if the map is empty or an option is out of bounds.
  PushPlanner(std::shared_ptr<const Map> map, RobotModel robot,
              std::map<std::string, ObjectModel> objects, PushPlannerOptions options);
  ~PushPlanner();

  /// For a newer map; plans as one made anew. Footprints, masks and all else that does not depend
  /// on the map are shared; of what does, only the part around the change is worked out again, if
  /// the map's extent and resolution are the same.
  /// @param changed  Where the maps differ at most; nothing: that is found out by comparing them.
  /// @throws InputError as the constructor.
  std::unique_ptr<PushPlanner> updated(
      std::shared_ptr<const Map> map,
      const std::optional<CollisionChecker::Area>& changed = std::nullopt) const;

  /// One with other options on the same map. Shares everything, so that it takes no time.
  /// @throws InputError if an option is out of bounds.
  /// @pre Margins, mask memory, time and robot path are as in options().
  std::unique_ptr<PushPlanner> withOptions(const PushPlannerOptions& options) const;

  const PushPlannerOptions& options() const;
  const std::shared_ptr<const Map>& map() const;

  /// @param cases  Those of the request's object and this robot count; others are ignored.
  /// @param stop   Asked often; planning ends within 20 ms once it says true.
  /// @param report Called about every 20 ms while planning and when a better plan is found, from
  ///               the caller's thread; it should return at once.
  PlanResult plan(const PlanRequest& request, const std::vector<Case>& cases,
                  const std::function<bool()>& stop = {},
                  const std::function<void(const PlanProgress&)>& report = {}) const;

  /// Does the rest of a plan still work if its first push starts from `map_T_object`? Re-anchors
  /// the chain at the observed pose and checks collisions (at the plan's zeta) and goal. Empty
  /// explanation: yes.
  struct Continuation {
    bool valid = false;    ///< Every push can be applied, and the last one ends in the goal.
    bool chained = false;  ///< All cases are known, so that `plan` tells where the rest leads.
    int applicable = 0;    ///< Pushes from the first one on that can be applied: at most all.
    /// The first push can be applied, and may leave the object where no case can be.
    bool may_get_stuck = false;
    std::string explanation;
    PushPlan plan;  ///< The re-anchored rest.
  };
  Continuation continuePlan(const PushPlan& rest, const Pose2& map_T_object,
                            const std::vector<Case>& cases,
                            const std::vector<PlacedObject>& obstacles) const;

  /// Ids of the obstacles that the plan's next pushes would hit (its object on its way or at the
  /// sigma points of its outcome, or the robot pushing it), the nearest to the object first.
  /// @param count  How many pushes; negative: all.
  std::vector<std::string> inTheWay(const PushPlan& plan, const std::vector<Case>& cases,
                                    const std::vector<PlacedObject>& obstacles,
                                    int count = -1) const;

  /// Ids of those of the movable objects that stand where the robot would drive to `map_T_goal`
  /// without them. Empty if it gets there anyway, or not even then.
  /// @param standing  Others that stand still.
  std::vector<std::string> inTheRobotsWay(const PlacedObject& object,
                                          const std::vector<PlacedObject>& movable,
                                          const std::vector<PlacedObject>& standing,
                                          const Pose2& map_T_robot, const Pose2& map_T_goal,
                                          double dock_direction_rad) const;

  /// Pushes that bring an obstacle out of the ways of plans (paper section 4).
  /// @param cases  Of all objects concerned.
  ClearingResult clear(const ClearingRequest& request, const std::vector<Case>& cases,
                       const std::function<bool()>& stop = {}) const;

  /// What an object, by its true shape, would overlap by more than `deeper_than_m` at the first of
  /// some poses at which it does: "chair_2 (seat)", "the map near (1.20, 3.45)". Empty: nothing.
  std::string touched(const std::string& model, const std::vector<Pose2>& map_T_object,
                      const std::vector<PlacedObject>& obstacles, double deeper_than_m = 0.0) const;

  /// Path of the robot to a push's start pose among map, obstacles and the object itself.
  RobotPath approachPath(const PlacedObject& object, const std::vector<PlacedObject>& obstacles,
                         const Pose2& map_T_robot, const Pose2& map_T_goal,
                         double dock_direction_rad) const;

 private:
  struct Data;
  explicit PushPlanner(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
