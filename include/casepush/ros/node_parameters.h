#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "casepush/cases/adapting_cases.h"
#include "casepush/execution/demonstration.h"
#include "casepush/execution/exploration.h"
#include "casepush/execution/push_task.h"
#include "casepush/model/catalog.h"
#include "casepush/perception/pose_tracker.h"
#include "casepush/planning/push_planner.h"
#include "casepush/ros/parameter_reader.h"
#include "casepush/sim/simulator.h"
#include "casepush/world/live_map.h"
#include "casepush/world/occupancy_grid.h"

/// Parameters of each node. The loaders throw one InputError that lists every violation.
namespace casepush {

/// What the nodes other than the simulator know of a place beforehand: which objects there are and
/// how they look, never where they are.
struct Furnishing {
  std::vector<TrackedObject> instances;
  std::map<std::string, ObjectModel> models;  ///< By name.
  RobotModel robot;

  /// nullptr if there is no such instance.
  const TrackedObject* instance(const std::string& id) const;
};

struct SimNodeParameters {
  WorldModel world;
  RobotModel robot;
  std::map<std::string, ObjectModel> models;  ///< By the names that the world uses.
  SimulatorOptions simulator;
  double real_time_factor = 1.0;      ///< 0: as fast as the nodes keep up.
  bool lock_step = false;             ///< Time stands still but for the service sim/step.
  double max_sim_time_s = 0.0;        ///< Ends the node; 0: never.
  double survey_resolution_m = 0.05;  ///< Spacing of `survey`.
};

struct PerceptionNodeParameters {
  Furnishing furnishing;
  PoseTrackerOptions tracker;
  bool publish_camera_frames = false;  ///< Static TF of the robot's cameras, if nobody else does.
};

/// What a map starts from: a file, the topic `survey` or `map`, or nothing but scans.
enum class MapOrigin { kFile, kSurvey, kGrid, kNone };

struct MapParameters {
  MapOrigin source = MapOrigin::kSurvey;
  std::string file;                    ///< See loadMap().
  std::optional<double> resolution_m;  ///< Of a map that is made, not loaded.
  OccupancyOptions occupancy;          ///< For floor plans.
  bool live_map = false;               ///< Integrate the topic `points`.
  LiveMapOptions live;
  double live_rate_hz = 4.0;           ///< Scans used at most, by wall time.
  double live_max_delay_s = 1.0;       ///< Older scans are dropped.
  double live_publish_period_s = 2.0;  ///< Between changes of the planner's map, by wall time.

  double resolution() const { return resolution_m.value_or(0.05); }
};

struct PlannerNodeParameters {
  Furnishing furnishing;
  PushPlannerOptions planner;
  MapParameters map;
};

struct ExecutorNodeParameters {
  Furnishing furnishing;
  PushPlannerOptions planner;  ///< For approach paths and for judging the rest of a plan.
  PushTaskOptions task;
  double watchdog_s = 0.12;       ///< Wall time without a tick after which zero is commanded.
  double stale_objects_s = 0.15;  ///< Age of `objects` above which zero is commanded,
  double lost_objects_s = 2.0;    ///< and for how long until a goal is aborted.
  double teleop_timeout_s = 0.3;  ///< Wall time without teleop_cmd_vel after which the base stops.
  double dead_clock_s = 5.0;      ///< Wall time without a tick after which a goal is aborted.
};

enum class ResetMode { kAuto, kTeleport, kDrive };

struct LearnerNodeParameters {
  Furnishing furnishing;
  std::string case_base = "cases.db";
  ExplorationOptions exploration;  ///< cases, practices and seed come with each goal.
  DemonstrationOptions demonstration;
  AdaptingOptions adapting;
  PushContext context;  ///< That pushes are made in; cases are adapted and published for it.
  ResetMode reset = ResetMode::kAuto;
  std::optional<Pose2> home;  ///< Where the object starts each push; none: where the object stands.
};

struct DemoNodeParameters {
  WorldModel world;
  std::string object_id;
  Pose2 map_T_goal;
  std::uint64_t seed = 1;
  int cases = 14;
  int practices = 20;
  std::string results = ".";
  double time_limit_s = 1800.0;  ///< Of the push task, by the ROS clock.
};

SimNodeParameters loadSimNodeParameters(ParameterReader reader, const Catalog& catalog);
PerceptionNodeParameters loadPerceptionNodeParameters(ParameterReader reader,
                                                      const Catalog& catalog);
PlannerNodeParameters loadPlannerNodeParameters(ParameterReader reader, const Catalog& catalog);
ExecutorNodeParameters loadExecutorNodeParameters(ParameterReader reader, const Catalog& catalog);
LearnerNodeParameters loadLearnerNodeParameters(ParameterReader reader, const Catalog& catalog);
DemoNodeParameters loadDemoNodeParameters(ParameterReader reader, const Catalog& catalog);

}  // namespace casepush
