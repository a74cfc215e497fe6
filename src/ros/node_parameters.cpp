#include "casepush/ros/node_parameters.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "casepush/common/input_error.h"
#include "casepush/world/static_map.h"
#include "map_parameters.h"

namespace casepush {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kDegree = M_PI / 180.0;
constexpr double kUnbounded = 1e6;

void addInstance(Furnishing& furnishing, const ObjectModel& model, const std::string& id,
                 int tag_offset) {
  furnishing.models.emplace(model.name, model);
  furnishing.instances.push_back({id, model, tag_offset});
}

std::string memberText(XmlRpcValue& entry, const std::string& key) {
  if (!entry.hasMember(key) || entry[key].getType() != XmlRpcValue::TypeString) {
    throw InputError("objects", "each entry needs a string '" + key + "'");
  }
  return static_cast<std::string&>(entry[key]);
}

/// One entry of `objects`: {id, model, tag_offset (optional)}.
void addListed(Furnishing& furnishing, const Catalog& catalog, XmlRpcValue entry) {
  if (entry.getType() != XmlRpcValue::TypeStruct) {
    throw InputError("objects", "each entry must be a map {id, model, tag_offset}");
  }
  int tag_offset = 0;
  for (auto& [key, value] : entry) {
    if (key == "tag_offset" && value.getType() == XmlRpcValue::TypeInt) {
      tag_offset = static_cast<int&>(value);
    } else if (key != "id" && key != "model") {
      throw InputError("objects",
                       "'" + key + "' is no valid entry (id, model, tag_offset: integer)");
    }
  }
  addInstance(furnishing, catalog.object(memberText(entry, "model")), memberText(entry, "id"),
              tag_offset);
}

void readList(Furnishing& furnishing, const Catalog& catalog, XmlRpcValue list) {
  if (list.getType() != XmlRpcValue::TypeArray || list.size() == 0) {
    throw InputError("objects", "must be a list of maps {id, model, tag_offset}");
  }
  std::set<std::string> ids;
  for (int i = 0; i < list.size(); ++i) {
    addListed(furnishing, catalog, list[i]);
    if (!ids.insert(furnishing.instances.back().id).second) {
      throw InputError("objects", "two entries have the id " + furnishing.instances.back().id);
    }
  }
}

/// From `world`, or from `objects` and `robot`.
Furnishing readFurnishing(ParameterReader& reader, const Catalog& catalog) {
  Furnishing furnishing;
  std::string world_name;
  std::string robot_name;
  std::string object;
  reader.read("world", world_name);
  reader.read("object", object);
  reader.read("robot", robot_name);
  XmlRpcValue list = reader.raw("objects");
  reader.check([&] {
    if (world_name.empty() == !list.valid()) {
      throw InputError("world, objects", "give exactly one of the two");
    }
    if (list.valid()) {
      readList(furnishing, catalog, list);
    } else {
      WorldModel world = catalog.world(world_name);
      if (!object.empty()) {
        placeObject(world, catalog, object);
      }
      for (const ObjectPlacement& placement : world.objects) {
        addInstance(furnishing, catalog.object(placement.model), placement.id,
                    placement.tag_offset);
      }
      robot_name = robot_name.empty() ? world.robot : robot_name;
    }
    furnishing.robot = catalog.robot(robot_name.empty() ? WorldModel().robot : robot_name);
  });
  return furnishing;
}

void readTracker(ParameterReader& reader, PoseTrackerOptions& options) {
  reader.read("tracker/acceleration_noise", options.acceleration_noise_mps2);
  reader.read("tracker/yaw_acceleration_noise", options.yaw_acceleration_noise_rps2);
  reader.read("tracker/gate_p_value", options.gate_p_value);
  reader.read("tracker/reacquire_after", options.reacquire_after, 1, 1000);
  reader.read("tracker/moving_speed", options.moving_speed_mps);
  reader.read("tracker/moving_yaw_rate", options.moving_yaw_rate_rps);
  reader.read("tracker/forget_after", options.forget_after_s);
  reader.read("tracker/localisation_sigma", options.localisation_sigma_m);
  reader.read("tracker/localisation_sigma_yaw", options.localisation_sigma_rad);
  reader.check([&] { options.validate(); });
}

void readPlanner(ParameterReader& reader, PushPlannerOptions& options) {
  std::string kind = toString(options.planner);
  reader.read("planner/kind", kind);
  reader.check([&] { options = PushPlannerOptions::forPlanner(plannerKind(kind)); });
  std::string similarity = options.similarity == Similarity::kPaper ? "paper" : "metric";
  reader.read("planner/similarity", similarity, {"metric", "paper"});
  options.similarity = similarity == "paper" ? Similarity::kPaper : Similarity::kMetric;
  reader.read("planner/goal_bias", options.goal_bias);
  reader.read("planner/max_nodes", options.max_nodes, 1, 10000000);
  reader.read("planner/zeta", options.zeta);
  reader.read("planner/object_margin", options.object_margin_m);
  reader.read("planner/robot_margin", options.robot_margin_m);
  reader.read("planner/solutions", options.solutions, 1, 100000);
  std::string risk = toString(options.risk.model);
  reader.read("planner/risk", risk, {"sigma_points", "chance"});
  reader.check([&] { options.risk.model = riskModel(risk); });
  reader.read("planner/max_collision_probability", options.risk.max_collision_probability);
  reader.read("planner/risk_horizon", options.risk.horizon, 1, 1000);
  reader.read("planner/recovery_time", options.risk.recovery_s);
  reader.read("planner/path_margin", options.robot_path.margin_m);
  reader.read("planner/dock_margin", options.robot_path.dock_margin_m);
  reader.check([&] { options.validate(); });
}

void readPush(ParameterReader& reader, ExecutePushOptions& options) {
  reader.read("push/sample_period", options.sample_period_s);
  reader.read("push/approach_speed", options.approach_speed_mps);
  reader.read("push/dock_speed", options.dock_speed_mps);
  reader.read("push/position_gain", options.position_gain);
  reader.read("push/yaw_gain", options.yaw_gain);
  reader.read("push/dock_tolerance", options.dock_tolerance_m);
  reader.read("push/dock_tolerance_yaw", options.dock_tolerance_rad);
  reader.read("push/rest_speed", options.rest_speed_mps);
  reader.read("push/rest_yaw_rate", options.rest_yaw_rate_rps);
  reader.read("push/rest_time", options.rest_time_s);
  reader.read("push/rest_timeout", options.rest_timeout_s);
  reader.read("push/approach_timeout", options.approach_timeout_s);
  reader.read("push/stale_robot", options.stale_robot_s);
  reader.read("push/blind_push", options.blind_push_s);
  reader.read("push/lost_object", options.lost_object_s);
  reader.read("push/alpha", options.alpha);
  reader.read("push/watch_ahead", options.watch_ahead);
  std::string test = toString(options.test);
  reader.read("push/test", test, {"hotelling", "plug_in"});
  options.test = test == "plug_in" ? OutcomeTest::kPlugIn : OutcomeTest::kHotelling;
  reader.check([&] { options.validate(); });
}

void readTask(ParameterReader& reader, PushTaskOptions& options) {
  readPush(reader, options.push);
  reader.read("task/max_replans", options.max_replans, 0, 100000);
  reader.read("task/max_pushes", options.max_pushes, 1, 100000);
  reader.read("task/max_failed_plans", options.max_failed_plans, 1, 1000);
  reader.read("task/break_off", options.break_off);
  reader.read("task/least_goal_share", options.rest.least_share);
  reader.read("task/replan_when_rejected", options.rest.replan_when_rejected);
  reader.read("task/repair", options.rest.repair);
  reader.read("task/horizon", options.rest.horizon, 1, 100000);
  reader.read("task/plan_deadline", options.plan_deadline_s);
  reader.read("task/look_timeout", options.look_timeout_s);
  reader.read("task/max_searches", options.max_searches, 0, 1000);
  reader.read("task/search/wait", options.search.wait_s);
  reader.read("task/search/look", options.search.look_s);
  reader.read("task/search/near", options.search.near_m);
  reader.read("task/search/far", options.search.far_m);
  reader.read("task/search/speed", options.search.speed_mps);
  reader.read("task/search/time_limit", options.search.time_limit_s);
  reader.check([&] { options.validate(); });
}

void readExploration(ParameterReader& reader, ExplorationOptions& options) {
  reader.read("exploration/cases", options.cases, 1, 10000);
  reader.read("exploration/practices", options.practices, 1, 10000);
  std::string coverage = toString(options.coverage);
  reader.read("exploration/coverage", coverage, {"spread", "random"});
  reader.check([&] { options.coverage = coverageStrategyFromString(coverage); });
  reader.read("exploration/min_speed", options.min_speed_mps);
  reader.read("exploration/max_speed", options.max_speed_mps);
  reader.read("exploration/min_duration", options.min_duration_s);
  reader.read("exploration/max_duration", options.max_duration_s);
  reader.read("exploration/start_gap", options.start_gap_m);
  reader.read("exploration/min_displacement", options.min_displacement_m);
  reader.read("exploration/min_rotation", options.min_rotation_rad);
  reader.read("exploration/max_position_sigma", options.max_position_sigma_m);
  reader.read("exploration/max_yaw_sigma", options.max_yaw_sigma_rad);
  reader.read("exploration/max_failures", options.max_failures, 1, 1000000);
  reader.check([&] { options.validate(); });
}

/// Calls `change` for each name in a list like "front left".
void changeSensors(ParameterReader& reader, const std::string& key, RobotModel& robot,
                   void (*change)(RobotModel&, const std::string&)) {
  std::string list;
  reader.read(key, list);
  std::istringstream names(list);
  for (std::string name; names >> name;) {
    reader.check([&] {
      try {
        change(robot, name);
      } catch (const InputError& error) {
        throw InputError(key, error.what());
      }
    });
  }
}

void readDemonstration(ParameterReader& reader, DemonstrationOptions& options) {
  reader.read("demonstration/sample_period", options.sample_period_s);
  reader.read("demonstration/contact_gap", options.contact_gap_m);
  reader.read("demonstration/min_displacement", options.min_displacement_m);
  reader.read("demonstration/min_rotation", options.min_rotation_rad);
  reader.read("demonstration/max_push", options.max_push_s);
  reader.read("demonstration/max_recording", options.max_recording_s);
  reader.read("demonstration/lost_object", options.lost_object_s);
  reader.read("demonstration/rest_time", options.rest_time_s);
  reader.check([&] { options.validate(); });
}

/// "x y yaw_deg": metres and degrees.
Pose2 parsePose(const std::string& text, const std::string& key) {
  std::istringstream stream(text);
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;
  std::string rest;
  if (!(stream >> x_m >> y_m >> yaw_deg) || stream >> rest) {
    throw InputError(key, "is '" + text + "', must be three finite numbers: x [m] y [m] yaw [deg]");
  }
  return Pose2(x_m, y_m, yaw_deg * kDegree);
}

}  // namespace

const TrackedObject* Furnishing::instance(const std::string& id) const {
  const auto found = std::find_if(instances.begin(), instances.end(),
                                  [&id](const TrackedObject& each) { return each.id == id; });
  return found == instances.end() ? nullptr : &*found;
}

SimNodeParameters loadSimNodeParameters(ParameterReader reader, const Catalog& catalog) {
  SimNodeParameters parameters;
  std::string world = "office";
  std::string object;
  reader.read("world", world);
  reader.read("object", object);
  reader.read("seed", parameters.simulator.seed);
  reader.read("sensor_noise", parameters.simulator.sensor_noise);
  std::string caster_model = toString(parameters.simulator.caster_model);
  reader.read("caster_model", caster_model);
  reader.check([&] { parameters.simulator.caster_model = casterModelFromString(caster_model); });
  reader.read("command_timeout", parameters.simulator.command_timeout_s);
  reader.read("real_time_factor", parameters.real_time_factor, 0.0, 1000.0);
  reader.read("lock_step", parameters.lock_step);
  reader.read("max_sim_time", parameters.max_sim_time_s, 0.0, kUnbounded);
  reader.read("survey_resolution", parameters.survey_resolution_m, 0.01, 0.5);
  reader.check([&] { parameters.simulator.validate(); });
  reader.check([&] {
    parameters.world = loadWorld(catalog, world);
    if (!object.empty()) {
      placeObject(parameters.world, catalog, object);
    }
    parameters.robot = catalog.robotOf(parameters.world);
    parameters.models = catalog.objectsOf(parameters.world);
  });
  changeSensors(reader, "disabled_sensors", parameters.robot, disableSensor);
  changeSensors(reader, "exact_sensors", parameters.robot, makeSensorExact);
  reader.finish();
  return parameters;
}

PerceptionNodeParameters loadPerceptionNodeParameters(ParameterReader reader,
                                                      const Catalog& catalog) {
  PerceptionNodeParameters parameters;
  parameters.furnishing = readFurnishing(reader, catalog);
  readTracker(reader, parameters.tracker);
  reader.read("publish_camera_frames", parameters.publish_camera_frames);
  reader.finish();
  return parameters;
}

PlannerNodeParameters loadPlannerNodeParameters(ParameterReader reader, const Catalog& catalog) {
  PlannerNodeParameters parameters;
  parameters.furnishing = readFurnishing(reader, catalog);
  readPlanner(reader, parameters.planner);
  readMapParameters(reader, parameters.map);
  reader.finish();
  return parameters;
}

ExecutorNodeParameters loadExecutorNodeParameters(ParameterReader reader, const Catalog& catalog) {
  ExecutorNodeParameters parameters;
  parameters.furnishing = readFurnishing(reader, catalog);
  readPlanner(reader, parameters.planner);
  readTask(reader, parameters.task);
  reader.read("watchdog", parameters.watchdog_s, 0.02, 1.0);
  reader.read("stale_objects", parameters.stale_objects_s, 0.02, 10.0);
  reader.read("lost_objects", parameters.lost_objects_s, 0.02, 3600.0);
  reader.read("teleop_timeout", parameters.teleop_timeout_s, 0.05, 2.0);
  reader.read("dead_clock", parameters.dead_clock_s, 0.1, 3600.0);
  reader.finish();
  return parameters;
}

LearnerNodeParameters loadLearnerNodeParameters(ParameterReader reader, const Catalog& catalog) {
  LearnerNodeParameters parameters;
  parameters.furnishing = readFurnishing(reader, catalog);
  readExploration(reader, parameters.exploration);
  readDemonstration(reader, parameters.demonstration);
  reader.read("case_base", parameters.case_base);
  reader.read("floor_position", parameters.adapting.floor.position_m, 1e-6, 1.0);
  reader.read("floor_yaw", parameters.adapting.floor.yaw_rad, 1e-6, 1.0);
  reader.read("adaptation_k", parameters.adapting.adaptation.scale_k, 1.0, kUnbounded);
  std::string weight = toString(parameters.adapting.adaptation.weight);
  reader.read("adaptation_weight", weight, {"bounded", "paper"});
  reader.check([&] {
    parameters.adapting.adaptation.weight = pastWeightFromString(weight, "adaptation_weight");
  });
  reader.read("notice_changes", parameters.adapting.notice);
  double load_kg = -1.0;
  reader.read("load", load_kg, -1.0, 10000.0);
  if (load_kg >= 0.0) {
    parameters.context.load_kg = load_kg;
  }
  reader.read("floor_name", parameters.context.floor);
  std::string reset = "auto";
  reader.read("reset", reset, {"auto", "teleport", "drive"});
  parameters.reset = reset == "auto"       ? ResetMode::kAuto
                     : reset == "teleport" ? ResetMode::kTeleport
                                           : ResetMode::kDrive;
  std::string home;
  reader.read("home", home);
  reader.check([&] {
    if (!home.empty()) {
      parameters.home = parsePose(home, "home");
    }
  });
  reader.finish();
  return parameters;
}

DemoNodeParameters loadDemoNodeParameters(ParameterReader reader, const Catalog& catalog) {
  DemoNodeParameters parameters;
  std::string world = "office";
  std::string object;
  std::string goal;
  reader.read("world", world);
  reader.read("object", object);
  reader.read("goal", goal);
  reader.read("seed", parameters.seed);
  reader.read("cases", parameters.cases, 1, 10000);
  reader.read("practices", parameters.practices, 1, 10000);
  reader.read("results", parameters.results);
  reader.read("time_limit", parameters.time_limit_s, 1.0, kUnbounded);
  reader.check([&] {
    parameters.world = loadWorld(catalog, world);
    parameters.object_id = placeObject(parameters.world, catalog, object);
    if (goal.empty() && !parameters.world.goal) {
      throw InputError("goal", "world " + world + " has none; give x [m] y [m] yaw [deg]");
    }
    parameters.map_T_goal = goal.empty() ? *parameters.world.goal : parsePose(goal, "goal");
  });
  reader.finish();
  return parameters;
}

}  // namespace casepush
