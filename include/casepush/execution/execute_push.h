#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/behaviour.h"
#include "casepush/model/case.h"
#include "casepush/model/push_report.h"
#include "casepush/model/robot_model.h"
#include "casepush/planning/push_planner.h"

namespace casepush {

/// A push to try for the first time (paper section 3.2): where to start, which way, how long.
struct PushConfiguration {
  Pose2 object_T_robot;        ///< Start pose R_0 with respect to the resting object.
  double direction_rad = 0.0;  ///< Of the motion, in the robot frame.
  double speed_mps = 0.3;
  double yaw_rate_rps = 0.0;
  double duration_s = 2.0;  ///< 1 to 3 s in the paper.
};

/// What the robot's base should do during a push, in the frame of the object's resting pose.
struct PushTrajectory {
  double period_s = 0.1;
  std::vector<Pose2> start_T_robot;  ///< Samples from t = 0; at least one.
  std::vector<Twist2> action;        ///< In the robot frame; as many.

  double durationS() const;           ///< Of the motion: from the first sample to the last.
  Pose2 poseAt(double t_s) const;     ///< Interpolated; the ends go on for ever.
  Twist2 actionAt(double t_s) const;  ///< Interpolated.

  /// Heading of the first noticeable motion in the start frame [rad]: how to dock.
  double startDirectionRad() const;
};

/// A constant velocity in the robot frame with ramps within the limits (a trapezoid in time).
/// @throws InputError if a value is not finite, the speed is not positive or above the limit, or
/// the
///   duration not in (0, 60] s.
PushTrajectory pushTrajectory(const PushConfiguration& configuration, const RobotLimits& limits,
                              double period_s);

/// The pushing phase of a recorded case. Poses and actions are smoothed over three samples
/// (1/4, 1/2, 1/4): recordings carry the robot's localisation noise, which a replay would turn into
/// jerks. A trapezoid at 0.8 m/s^2 changes by 2 mm.
/// @throws InputError from validateCase.
PushTrajectory pushTrajectory(const Case& push_case);

/// How it is judged whether a case explains where the object came to rest.
enum class OutcomeTest {
  kHotelling,  ///< Counts how often the case was practised: see testPrediction().
  kPlugIn,     ///< As if the case's Gaussian were known for certain: see testPlugIn().
};
const char* toString(OutcomeTest test);

/// When a replayed push is broken off because the object leaves the course that the case says (its
/// tube): for `hold_s` it is outside of the tube at every time within `slack_s` of now.
struct TubeWatchOptions {
  bool on = false;         ///< Practices go on to the end, whatever happens.
  double alpha = 1e-4;     ///< Outside: a pose so far off is rarer than this,
  double least_m = 0.06;   ///< and it is off by more than this
  double least_rad = 0.2;  ///< or that.
  double slack_s = 0.3;    ///< The object sets off now earlier, now later.
  double hold_s = 0.1;
};

struct ExecutePushOptions {
  double sample_period_s = 0.1;
  double approach_speed_mps = 0.5;
  double dock_speed_mps = 0.15;
  double position_gain = 2.0;  ///< Of trajectory tracking [1/s].
  double yaw_gain = 2.5;       ///< [1/s]
  double dock_tolerance_m = 0.015;
  double dock_tolerance_rad = 0.03;
  double rest_speed_mps = 0.02;  ///< Below both for rest_time_s: at rest.
  double rest_yaw_rate_rps = 0.05;
  double rest_time_s = 0.4;
  double rest_timeout_s = 15.0;
  double approach_timeout_s = 120.0;
  double stale_robot_s = 0.15;  ///< Age of the robot's pose above which it stops.
  double blind_push_s = 0.3;    ///< Age of the object's pose, or pause, above which a push fails,
  double lost_object_s = 1.0;   ///< and above which nobody waits for it to come to rest.
  double alpha = 0.01;          ///< Of the prediction test.
  OutcomeTest test = OutcomeTest::kHotelling;
  TubeWatchOptions tube;
  double blocked_m = 0.2;  ///< The robot is blocked if it is so far from where it should be
  double blocked_s = 0.3;  ///< during the push, for so long.
  /// Stop before the object touches something, where it is known what stands around (TouchCheck).
  bool watch_ahead = true;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// True if the pushed object came to rest where it was seen, so that the push tells something about
/// the case (also if it missed the object, or was broken off): the outcome is
/// `recorded.start_outcome.mean`.
bool isObservation(const PushReport& report);
/// True if the object was pushed, or missed, and came to rest where it was seen: an observation, or
/// a push that was stopped short.
bool wasMade(const PushReport& report);

/// Gives a planner on the newest map.
using PlannerSource = std::function<std::shared_ptr<const PushPlanner>()>;

/// Finds the robot's way to `goal` ending straight along `dock_direction_rad` (in the map).
using ApproachPlanner = std::function<RobotPath(const Observation& observation, const Pose2& goal,
                                                double dock_direction_rad)>;

/// The approach planner of a push planner: all objects but `object_id` stand around.
/// @param planner  Must outlive the result.
ApproachPlanner approachPlanner(const PushPlanner& planner, const std::string& object_id);
/// The same with a planner that is asked for anew each time.
ApproachPlanner approachPlanner(const PlannerSource& planner, const std::string& object_id);

/// What the object would touch, map or other objects, at the first of these poses at which it
/// touches anything; empty: nothing.
using TouchCheck = std::function<std::string(const Observation& observation,
                                             const std::vector<Pose2>& map_T_object)>;

/// By a planner that is asked for anew each time, with all objects but `object_id` standing around;
/// overlaps of up to 2 cm do not count.
TouchCheck touchCheck(const PlannerSource& planner, const std::string& object_id);

/// Every object of an observation but one, as obstacles.
std::vector<PlacedObject> otherObjects(const Observation& observation, const std::string& but_id);

/// Approaches, pushes, waits until the object rests, and reports: one push from beginning to end.
///
/// The robot follows the approach path, docks slowly, and waits until it has seen the object at
/// rest. That pose is the start frame, in which it follows the push's trajectory: recorded actions
/// plus feedback on the pose. Then it stands still until the object has come to rest. If docking
/// nudged the object, it docks anew, a limited number of times. It breaks the push off if the
/// object leaves the case's tube (TubeWatchOptions) or is about to touch something (watchAhead()),
/// and fails if something holds the robot.
///
/// It commands zero at once while the robot's pose is stale or the observation is not finite, and
/// goes on if things are well again in time; a push that was interrupted for longer than
/// `blind_push_s` has failed, as it is not the one of the case any more.
class ExecutePush : public Behaviour {
 public:
  /// Tries a configuration for the first time.
  /// @throws InputError from pushTrajectory and the options.
  ExecutePush(std::string object_id, PushConfiguration configuration, RobotModel robot,
              ApproachPlanner approach, ExecutePushOptions options);
  /// Replays a case (practice or plan execution) and tests its prediction.
  /// @throws InputError from pushTrajectory and the options.
  ExecutePush(std::string object_id, Case push_case, RobotModel robot, ApproachPlanner approach,
              ExecutePushOptions options);
  ~ExecutePush() override;
  ExecutePush(ExecutePush&&) noexcept;
  ExecutePush& operator=(ExecutePush&&) noexcept;

  Tick tick(const Observation& observation) override;
  std::string describe() const override;

  void cancel();  ///< The next tick fails with kCancelled and commands zero.

  /// Stops the push before the object touches something, unless the options say otherwise; only of
  /// pushes that replay a case. To be called before the first tick.
  void watchAhead(TouchCheck check);

  enum class Phase { kApproach, kDock, kPush, kRest, kFinished };
  Phase phase() const;

  /// Set once finished, whether it succeeded or failed.
  const std::optional<PushReport>& report() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
