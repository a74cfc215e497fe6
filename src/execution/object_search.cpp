#include "casepush/execution/object_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "blocked_watch.h"
#include "bystanders.h"
#include "casepush/common/violations.h"
#include "motion_control.h"
#include "path_follower.h"
#include "watches.h"

namespace casepush {
namespace {

constexpr int kSides = 6;
constexpr double kSeenS = 0.3;  // Age up to which an object counts as in sight.
constexpr double kYawToleranceRad = 0.1;
constexpr double kTurnTimeoutS = 10.0;
constexpr double kArrivedM = 0.05;
// After a longer pause the robot starts from a standstill.
constexpr double kPauseS = 0.1;
constexpr TrackingGains kGains{2.0, 2.5};
// An object at the very edge of an image is not recognised.
constexpr double kEdgeRad = 0.15;
constexpr double kViewWithoutCamerasRad = 1.0;

double bearing(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

}  // namespace

void ObjectSearchOptions::validate() const {
  Violations violations;
  violations.require("wait_s", wait_s, 0.0, 600.0);
  violations.require("look_s", look_s, 0.1, 60.0);
  violations.require("near_m", near_m, 0.1, 20.0);
  violations.require("far_m", far_m, 0.1, 20.0);
  violations.require("speed_mps", speed_mps, 0.02, 5.0);
  violations.require("time_limit_s", time_limit_s, 0.0, 3600.0);
  violations.throwIfAny("search options");
}

double viewingYaw(const RobotModel& robot, const Pose2& map_T_robot,
                  const Eigen::Vector2d& target_position) {
  const double to_target = bearing(map_T_robot.position(), target_position);
  double least_turn = 2.0 * M_PI;
  const auto consider = [&](double axis_rad, double fov_rad) {
    const double off = wrapAngle(to_target - map_T_robot.yaw() - axis_rad);
    const double free = std::max(0.0, 0.5 * fov_rad - kEdgeRad);
    const double turn = std::abs(off) <= free ? 0.0 : off;
    if (std::abs(turn) < std::abs(least_turn)) {
      least_turn = turn;
    }
  };
  for (const CameraModel& camera : robot.cameras) {
    const Eigen::Vector3d axis = camera.base_T_camera.linear().col(2);
    consider(std::atan2(axis.y(), axis.x()), camera.horizontal_fov_rad);
  }
  if (robot.cameras.empty()) {
    consider(0.0, kViewWithoutCamerasRad);
  }
  return wrapAngle(map_T_robot.yaw() + least_turn);
}

struct ObjectSearch::Data {
  enum class Stage { kWait, kTurn, kLook, kDrive, kFound, kGivenUp };

  Data(ObjectState seen, RobotModel robot_model, ApproachPlanner approach,
       const ObjectSearchOptions& search_options)
      : last_seen(std::move(seen)),
        robot(std::move(robot_model)),
        way(std::move(approach)),
        options(search_options),
        limiter(robot.limits),
        robot_watch(ExecutePushOptions().stale_robot_s) {}

  ObjectState last_seen;
  RobotModel robot;
  ApproachPlanner way;
  ObjectSearchOptions options;
  CommandLimiter limiter;
  TickClock clock;
  RobotWatch robot_watch;
  BlockedWatch blocked;

  Stage stage = Stage::kWait;
  std::optional<double> began_s;
  double stage_began_s = 0.0;
  std::vector<Eigen::Vector2d> near_places;
  std::vector<Eigen::Vector2d> far_places;
  int looks = 0;
  Pose2 turn_goal;
  Eigen::Vector2d place_to_look_from = Eigen::Vector2d::Zero();
  std::optional<PathFollower> follower;
  Bystanders bystanders;
  Twist2 commanded;

  bool isOver() const { return stage == Stage::kFound || stage == Stage::kGivenUp; }
  Twist2 run(const Observation& observation);
  Twist2 step(const Observation& observation, double dt_s);
  void enter(Stage next, double now_s);
  void beginTurn(const Observation& observation);
  Twist2 turn(const Observation& observation);
  Twist2 drive(const Observation& observation, double dt_s);
  void listPlaces(const Pose2& map_T_robot);
  void goToNextPlace(const Observation& observation);
  bool setOffTo(const Eigen::Vector2d& place, const Observation& observation);
  RobotPath pathTo(const Observation& observation, const Eigen::Vector2d& place) const;
};

void ObjectSearch::Data::enter(Stage next, double now_s) {
  stage = next;
  stage_began_s = now_s;
  blocked.reset();
  looks += next == Stage::kLook ? 1 : 0;
}

void ObjectSearch::Data::beginTurn(const Observation& observation) {
  const Pose2& here = observation.map_T_robot;
  turn_goal = Pose2(here.x(), here.y(), viewingYaw(robot, here, last_seen.map_T_object.position()));
  enter(Stage::kTurn, observation.stamp_s);
}

Twist2 ObjectSearch::Data::turn(const Observation& observation) {
  const bool there = std::abs(yawDifference(observation.map_T_robot, turn_goal)) < kYawToleranceRad;
  if (there || blocked.isBlocked(observation, commanded, BlockedWatch::Drive::kFree) ||
      observation.stamp_s - stage_began_s > kTurnTimeoutS) {
    enter(Stage::kLook, observation.stamp_s);
    return Twist2{};
  }
  return track(observation.map_T_robot, {turn_goal, Twist2{}}, kGains);
}

void ObjectSearch::Data::listPlaces(const Pose2& map_T_robot) {
  const Eigen::Vector2d centre = last_seen.map_T_object.position();
  const double first = bearing(centre, map_T_robot.position());
  for (int k = 0; k < kSides; ++k) {
    const double angle = first + 2.0 * M_PI * k / kSides;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    // The robot has already looked from its own side.
    if (k > 0) {
      near_places.push_back(centre + options.near_m * direction);
    }
    far_places.push_back(centre + options.far_m * direction);
  }
}

RobotPath ObjectSearch::Data::pathTo(const Observation& observation,
                                     const Eigen::Vector2d& place) const {
  Observation with_object = observation;
  if (observation.object(last_seen.id) == nullptr) {
    with_object.objects.push_back(last_seen);
  }
  const Eigen::Vector2d from = observation.map_T_robot.position();
  const Pose2 there(place.x(), place.y(), observation.map_T_robot.yaw());
  const Pose2 goal(place.x(), place.y(),
                   viewingYaw(robot, there, last_seen.map_T_object.position()));
  RobotPath path = way(with_object, goal, bearing(from, place));
  if (!path.found) {
    path = way(with_object, goal, bearing(place, last_seen.map_T_object.position()));
  }
  return path;
}

// Asks for one path only, so that a tick does not take long.
void ObjectSearch::Data::goToNextPlace(const Observation& observation) {
  std::vector<Eigen::Vector2d>& places = near_places.empty() ? far_places : near_places;
  if (places.empty()) {
    enter(Stage::kGivenUp, observation.stamp_s);
    return;
  }
  const Eigen::Vector2d here = observation.map_T_robot.position();
  const auto nearest = std::min_element(
      places.begin(), places.end(), [&here](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return (a - here).squaredNorm() < (b - here).squaredNorm();
      });
  const Eigen::Vector2d place = *nearest;
  places.erase(nearest);
  setOffTo(place, observation);
}

bool ObjectSearch::Data::setOffTo(const Eigen::Vector2d& place, const Observation& observation) {
  const RobotPath path = pathTo(observation, place);
  if (!path.found || path.waypoints.empty()) return false;
  const double speed = options.speed_mps;
  follower.emplace(path.waypoints, robot.limits, PathFollower::Speeds{speed, speed});
  bystanders.note(observation, last_seen.id, path.waypoints);
  place_to_look_from = place;
  enter(Stage::kDrive, observation.stamp_s);
  return true;
}

Twist2 ObjectSearch::Data::drive(const Observation& observation, double dt_s) {
  const bool is_cut_off = bystanders.haveChanged(observation) &&
                          !setOffTo(Eigen::Vector2d(place_to_look_from), observation);
  if (is_cut_off || blocked.isBlocked(observation, commanded, BlockedWatch::Drive::kFree)) {
    enter(Stage::kLook, observation.stamp_s);
    return Twist2{};
  }
  const Reference reference = follower->advance(dt_s, observation.map_T_robot);
  if (follower->atEnd() &&
      distance(observation.map_T_robot, reference.map_T_reference) < kArrivedM) {
    beginTurn(observation);
    return Twist2{};
  }
  return track(observation.map_T_robot, reference, kGains);
}

Twist2 ObjectSearch::Data::step(const Observation& observation, double dt_s) {
  const double in_stage_s = observation.stamp_s - stage_began_s;
  switch (stage) {
    case Stage::kWait:
      if (in_stage_s >= options.wait_s) {
        listPlaces(observation.map_T_robot);
        beginTurn(observation);
      }
      break;
    case Stage::kTurn:
      return turn(observation);
    case Stage::kLook:
      if (in_stage_s >= options.look_s) {
        goToNextPlace(observation);
      }
      break;
    case Stage::kDrive:
      return drive(observation, dt_s);
    case Stage::kFound:
    case Stage::kGivenUp:
      break;
  }
  return Twist2{};
}

Twist2 ObjectSearch::Data::run(const Observation& observation) {
  const double now_s = observation.stamp_s;
  if (robot_watch.check(observation) != RobotWatch::Status::kFresh) {
    limiter.stop();
    return Twist2{};
  }
  const std::optional<double> dt_s = clock.advance(now_s);
  if (!began_s) {
    began_s = now_s;
    stage_began_s = now_s;
  }
  const ObjectState* object = usableObject(observation, last_seen.id);
  if (object != nullptr && object->stamp_s > last_seen.stamp_s &&
      now_s - object->stamp_s <= kSeenS) {
    enter(Stage::kFound, now_s);
    return Twist2{};
  }
  if (!dt_s || now_s - *began_s > options.time_limit_s) {
    enter(Stage::kGivenUp, now_s);
    return Twist2{};
  }
  if (*dt_s > kPauseS) {
    limiter.stop();
  }
  const Twist2 wanted = step(observation, *dt_s);
  if (stage != Stage::kTurn && stage != Stage::kDrive) {
    limiter.stop();
    return Twist2{};
  }
  return limiter.limit(wanted, *dt_s);
}

ObjectSearch::ObjectSearch(ObjectState last_seen, RobotModel robot, ApproachPlanner way,
                           ObjectSearchOptions options) {
  options.validate();
  data_ = std::make_unique<Data>(std::move(last_seen), std::move(robot), std::move(way), options);
}

ObjectSearch::~ObjectSearch() = default;
ObjectSearch::ObjectSearch(ObjectSearch&&) noexcept = default;
ObjectSearch& ObjectSearch::operator=(ObjectSearch&&) noexcept = default;

Tick ObjectSearch::tick(const Observation& observation) {
  Tick tick;
  if (!data_->isOver()) {
    data_->commanded = data_->run(observation);
    tick.command.twist = data_->commanded;
  }
  if (data_->isOver()) {
    tick.status = data_->stage == Data::Stage::kFound ? BehaviourStatus::kSucceeded
                                                      : BehaviourStatus::kFailed;
  }
  return tick;
}

std::string ObjectSearch::describe() const {
  const std::string& id = data_->last_seen.id;
  const std::string places =
      std::to_string(data_->looks) + (data_->looks == 1 ? " place" : " places");
  switch (data_->stage) {
    case Data::Stage::kFound:
      return id + " is in sight again";
    case Data::Stage::kGivenUp:
      return id + " is not in sight, looked for from " + places + " around where it was last seen";
    case Data::Stage::kDrive:
      return "driving to see " + id + " from elsewhere, so far from " + places + " in vain";
    case Data::Stage::kWait:
    case Data::Stage::kTurn:
    case Data::Stage::kLook:
      break;
  }
  return "looking for " + id;
}

}  // namespace casepush
