#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/model/load.h"
#include "casepush/model/object_model.h"
#include "casepush/model/range_scan.h"
#include "casepush/model/robot_model.h"
#include "casepush/model/tag_detection.h"
#include "casepush/model/world_model.h"

namespace casepush {

/// How casters move, see docs/simulator.md.
enum class CasterModel {
  kFeatherstone,  ///< The reference: every fork and wheel is a body in space.
  kPlanar,        ///< Fast: a body in the plane with a swivel angle for each caster.
};

/// "featherstone" or "planar".
const char* toString(CasterModel model);

/// @throws InputError if there is no model of that name.
CasterModel casterModelFromString(const std::string& name);

struct SimulatorOptions {
  std::uint64_t seed = 1;
  double step_s = 1.0 / 240.0;
  int solver_iterations = 30;
  CasterModel caster_model = CasterModel::kFeatherstone;
  bool sensor_noise = true;        ///< False: every sensor of the robot is exact.
  double command_timeout_s = 0.2;  ///< The base stops when commands cease for this long.
  /// By object id: on it at the start, in the place of what the world puts there.
  std::map<std::string, Load> loads;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// Who touched whom during the steps since the last query.
struct ContactReport {
  std::string body_a;  ///< Object id, "robot", or the name of a static box.
  std::string part_a;  ///< Link of it.
  std::string body_b;
  std::string part_b;
  double impulse_ns = 0.0;                              ///< Sum of normal impulses.
  Eigen::Vector3d map_point = Eigen::Vector3d::Zero();  ///< Mean place, weighted by impulse.
};

/// What the robot itself would report.
struct OdometryReading {
  double stamp_s = 0.0;
  Pose2 map_T_odom;    ///< From localisation.
  Pose2 odom_T_robot;  ///< From the wheels.
  Twist2 robot_twist;  ///< In the robot frame.
};

/// The bundled world: Bullet in double precision, furniture on casters, sensors.
///
/// Deterministic: the same world, seed and sequence of calls give bit-identical results.
/// Thread safety: none for one simulator; separate ones may run in separate threads.
class Simulator {
 public:
  /// @throws InputError naming the world's file and the element: start poses that overlap each
  /// other or a wall or lie outside, ids that are bad or taken, a load that an object cannot carry.
  Simulator(WorldModel world, RobotModel robot, std::map<std::string, ObjectModel> models,
            SimulatorOptions options);
  ~Simulator();

  /// Commands the base; a twist that is not finite is ignored, one beyond limits is clamped.
  /// Returns false in either case.
  bool setCommand(const Twist2& robot_twist);

  /// What is wrong with a command, naming values and bounds; empty if setCommand() takes it.
  std::string commandFault(const Twist2& robot_twist) const;

  void step(int count = 1);
  double time() const;             ///< Simulated seconds.
  std::int64_t stepCount() const;  ///< Since the start or the last reset.
  double stepSeconds() const;

  /// Images taken since the last call whose latency has passed, oldest first. Without calls the
  /// last 1000 images wait.
  std::vector<TagFrame> takeTagFrames();

  /// Range sensors work while scans are wanted, which they are not at first: rays cost time.
  void setScanning(bool wanted);
  /// Scans measured since the last call whose latency has passed, oldest first; without calls the
  /// last 100 wait.
  std::vector<RangeScan> takeScans();

  OdometryReading odometry() const;

  /// Contacts that bore force during the steps since the last call, by pair of parts and ordered by
  /// name. The floor is left out.
  std::vector<ContactReport> takeContacts();

  /// Ground truth, for judging only.
  Pose2 trueRobotPose() const;
  Pose2 trueObjectPose(const std::string& id) const;
  Twist2 trueObjectTwist(const std::string& id) const;
  /// Pose of each link in the map, in the order of the object's mechanism.
  std::vector<Eigen::Isometry3d> trueLinkPoses(const std::string& id) const;

  /// Puts an object or the robot ("robot") somewhere, at rest; the casters swivel at random and the
  /// robot forgets its command.
  /// Time goes on. @throws InputError if there is no such body, the pose is not finite, outside the
  /// world, or overlaps something (everything stays as it was).
  void setPose(const std::string& id, const Pose2& map_T_body);
  /// Several at once, so that they may trade places.
  void setPoses(const std::map<std::string, Pose2>& map_T_bodies);

  /// Puts a load on an object in the place of the one it carries; 0 kg takes that away. Time goes
  /// on, and so does all motion: the load has the object's velocity from the start.
  /// @throws InputError if there is no such object or it cannot carry the load: see placedLoad(),
  /// and the planar caster model refuses what would tip over (everything stays as it was).
  void setLoad(const std::string& id, const Load& load);
  /// What lies on an object now, with its height.
  std::optional<Load> load(const std::string& id) const;

  /// Everything as at the start, loads too, with a new seed; time starts at 0.
  void reset(std::uint64_t seed);

  const WorldModel& world() const;
  const RobotModel& robot() const;
  const ObjectModel& object(const std::string& id) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
