#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/cases/adapting_cases.h"
#include "casepush/execution/push_task.h"
#include "casepush/lab/closed_loop.h"

namespace casepush {

/// Plans at once, in the caller's thread: the lab's PlanClient.
class DirectPlanClient : public PlanClient {
 public:
  DirectPlanClient(const PushPlanner& planner, CaseSource cases);

  void request(const PlanRequest& request) override;
  std::optional<PlanResult> poll() override;
  void cancel() override;
  bool isAlive() const override { return true; }

 private:
  const PushPlanner& planner_;
  CaseSource cases_;
  std::optional<PlanResult> result_;
};

/// A push problem: where object and robot start, and where the object should go.
struct PushProblem {
  WorldModel world;  ///< With the object and the robot at their starts.
  std::string object_id;
  Pose2 map_T_goal;
};

/// A problem from a world file: the object at its place there, see placeObject().
/// @throws InputError from placeObject().
PushProblem problemFromWorld(const Catalog& catalog, const WorldModel& world,
                             const std::string& object, const Pose2& map_T_goal);

/// A random problem: start and goal at least `min_distance_m` apart, both at least
/// `clearance_m` clear of everything, connected for a robot that drives, and with room for the
/// robot behind the object all along some way from start to goal.
/// @throws InputError if the world has no room for one.
PushProblem randomProblem(const Catalog& catalog, const WorldModel& world,
                          const std::string& object, std::uint64_t seed,
                          double min_distance_m = 3.0, double clearance_m = 0.25);

/// What to ask a planner for to solve a problem; all other objects are obstacles.
/// @throws InputError from the catalog.
PlanRequest requestFor(const Catalog& catalog, const PushProblem& problem, std::uint64_t seed,
                       double deadline_s);

struct PushRunOptions {
  LabOptions lab;
  PushPlannerOptions planner;
  PushTaskOptions task;
  PushContext context;  ///< What is known of the object's load and the floor.
  AdaptingOptions adapting;
  bool adapt = true;  ///< In memory only; the case base is not touched.
  bool clear_obstacles =
      false;  ///< Push objects with known cases out of the way if that is quicker.
  double time_limit_s = 1200.0;
};

struct PushRunResult {
  bool success = false;  ///< By ground truth.
  std::string explanation;
  PushTaskStatus status = PushTaskStatus::kRunning;
  PushTaskProgress progress;
  double position_error_m = 0.0;  ///< By ground truth.
  double yaw_error_rad = 0.0;
  double sim_time_s = 0.0;
  double planning_s = 0.0;  ///< Wall time.
  int collisions = 0;
  std::vector<std::string> collision_names;
  std::vector<PushReport> reports;   ///< Of the cases as given, also if copies were pushed.
  std::vector<std::string> noticed;  ///< Changes of load or floor, in words; see AdaptingCases.
};

/// Runs one push task in the simulator from beginning to end.
/// @param cases  Of the object, and of others that may be pushed out of the way.
/// @param map  What the planner knows; by default a survey of the world.
PushRunResult runPushTask(const Catalog& catalog, const PushProblem& problem,
                          const std::vector<Case>& cases, std::shared_ptr<const Map> map,
                          const PushRunOptions& options,
                          const std::function<void(const PushTask&)>& watch = {});

/// The map that a survey of the world's static geometry gives.
std::shared_ptr<const Map> surveyMap(const WorldModel& world, double resolution_m = 0.05);

}  // namespace casepush
