#include <algorithm>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/lab/push_run.h"
#include "casepush/planning/robot_path_planner.h"
#include "push_ways.h"

namespace casepush {
namespace {

constexpr int kAttempts = 20000;
constexpr double kRobotStartGapM = 0.3;

ObjectPlacement& placementOf(WorldModel& world, const std::string& id) {
  return *std::find_if(world.objects.begin(), world.objects.end(),
                       [&id](const ObjectPlacement& placement) { return placement.id == id; });
}

Pose2 randomPose(const WorldModel& world, Random& random) {
  const double x = random.uniform(world.min_m.x(), world.max_m.x());
  const double y = random.uniform(world.min_m.y(), world.max_m.y());
  return {x, y, random.uniform(-M_PI, M_PI)};
}

/// Decides whether random poses make a problem that is fair to ask.
class ProblemChecker {
 public:
  ProblemChecker(const Catalog& catalog, const WorldModel& world, const ObjectPlacement& placement,
                 double clearance_m)
      : map_(surveyMap(world)),
        checker_(*map_),
        object_(catalog.object(placement.model)),
        robot_(catalog.robot(world.robot)),
        roomy_object_(checker_.footprint(object_.solid, clearance_m)),
        roomy_robot_(checker_.footprint(robot_.solid, 0.05)),
        paths_(robot_, RobotPathOptions{}),
        ways_(checker_, object_, robot_) {
    std::vector<PlacedSolid> others;
    for (const ObjectPlacement& other : world.objects) {
      if (other.id != placement.id) {
        others.push_back({catalog.object(other.model).solid, other.map_T_object});
      }
    }
    checker_.setObstacles(std::move(others));
  }

  bool objectFits(const Pose2& pose) const { return !checker_.collides(*roomy_object_, pose); }

  /// A free pose beside the object, found by going around it.
  std::optional<Pose2> robotBeside(const Pose2& map_T_object, Random& random) const {
    const double reach_m = object_.radius_m + robot_.radius_m + kRobotStartGapM;
    for (int i = 0; i < 16; ++i) {
      const double bearing = random.uniform(-M_PI, M_PI);
      const Eigen::Vector2d position =
          map_T_object.position() + reach_m * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
      const Pose2 pose(position.x(), position.y(), bearing + M_PI);
      if (!checker_.collides(*roomy_robot_, pose)) {
        return pose;
      }
    }
    return std::nullopt;
  }

  /// The robot could drive from one to the other, so the two are not in separate rooms.
  bool connected(const Pose2& from, const Pose2& to) const {
    return paths_.plan(checker_, from, to, to.yaw()).found;
  }

  /// The robot finds room behind the object all the way; not so in corners and along walls.
  bool pushable(const Pose2& start, const Pose2& goal) const { return ways_.lead(start, goal); }

 private:
  std::shared_ptr<const Map> map_;
  CollisionChecker checker_;
  ObjectModel object_;
  RobotModel robot_;
  std::shared_ptr<const Footprint> roomy_object_;
  std::shared_ptr<const Footprint> roomy_robot_;
  RobotPathPlanner paths_;
  PushWays ways_;
};

}  // namespace

std::shared_ptr<const Map> surveyMap(const WorldModel& world, double resolution_m) {
  auto map = std::make_shared<Map>(resolution_m);
  map->addSurvey(surveyPoints(world, resolution_m));
  return map;
}

PushProblem problemFromWorld(const Catalog& catalog, const WorldModel& world,
                             const std::string& object, const Pose2& map_T_goal) {
  PushProblem problem{world, "", map_T_goal};
  problem.object_id = placeObject(problem.world, catalog, object);
  return problem;
}

PushProblem randomProblem(const Catalog& catalog, const WorldModel& world,
                          const std::string& object, std::uint64_t seed, double min_distance_m,
                          double clearance_m) {
  PushProblem problem{world, "", Pose2()};
  problem.object_id = placeObject(problem.world, catalog, object);
  ObjectPlacement& placement = placementOf(problem.world, problem.object_id);
  const ProblemChecker checker(catalog, problem.world, placement, clearance_m);
  Random random = Random::stream(seed, "push problem");
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Pose2 start = randomPose(world, random);
    const Pose2 goal = randomPose(world, random);
    if (distance(start, goal) < min_distance_m || !checker.objectFits(start) ||
        !checker.objectFits(goal)) {
      continue;
    }
    const std::optional<Pose2> robot_start = checker.robotBeside(start, random);
    const std::optional<Pose2> robot_end = checker.robotBeside(goal, random);
    if (!robot_start || !robot_end || !checker.connected(*robot_start, *robot_end) ||
        !checker.pushable(start, goal)) {
      continue;
    }
    placement.map_T_object = start;
    problem.world.map_T_robot = *robot_start;
    problem.map_T_goal = goal;
    return problem;
  }
  throw InputError("world " + world.name, "has no room for a random start and goal of " + object +
                                              "; use a larger or emptier world, or give --goal");
}

PlanRequest requestFor(const Catalog& catalog, const PushProblem& problem, std::uint64_t seed,
                       double deadline_s) {
  PlanRequest request;
  for (const ObjectPlacement& placement : problem.world.objects) {
    const PlacedObject placed{placement.id, catalog.object(placement.model).name,
                              placement.map_T_object};
    if (placement.id == problem.object_id) {
      request.object = placed;
    } else {
      request.obstacles.push_back(placed);
    }
  }
  request.map_T_goal = problem.map_T_goal;
  request.map_T_robot = problem.world.map_T_robot;
  request.seed = seed;
  request.deadline_s = deadline_s;
  return request;
}

}  // namespace casepush
