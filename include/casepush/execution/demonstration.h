#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/object_model.h"
#include "casepush/model/observation.h"
#include "casepush/model/robot_model.h"

namespace casepush {

struct DemonstrationOptions {
  double sample_period_s = 0.1;
  double contact_gap_m = 0.05;       ///< Robot and object nearer than this may be in contact.
  double min_displacement_m = 0.05;  ///< An object that moved less than both was not pushed.
  double min_rotation_rad = 0.1;
  double max_push_s = 15.0;        ///< Longest contact.
  double max_recording_s = 300.0;  ///< Longest recording.
  double lost_object_s = 1.0;      ///< Longest time without seeing the object while it is pushed.
  double rest_time_s = 0.5;        ///< The object must have rested so long before and after.
  void validate() const;           ///< @throws InputError listing every violation.
};

/// Makes a case of what robot and object do while a person drives.
///
/// The recording is trimmed to the contact: it begins where the robot was clear of the object for
/// the last time before it moved, with a short run-up in front of it, since a replay starts from
/// standstill, and the push ends where the robot lost contact or stopped. The outcome is where the
/// object came to rest. Pure logic: time is that of the observations.
class Demonstration {
 public:
  /// @throws InputError from the options.
  Demonstration(std::string object_id, ObjectModel object, RobotModel robot,
                DemonstrationOptions options = {});

  /// To be called with each observation, some 50 times a second.
  void add(const Observation& observation);

  struct Result {
    std::optional<Case> recorded;  ///< With the statistics of this one outcome; not stored yet.
    std::string explanation;       ///< Why there is none, or what was recorded; for a person.
    bool wait = false;             ///< Nothing is wrong, but the object still moves.
  };
  /// What was demonstrated so far; more may be added afterwards.
  Result result() const;

 private:
  struct Sample {
    double t_s;
    Pose2 map_T_robot;
    Twist2 robot_twist;
    Pose2 map_T_object;
    double seen_s;  ///< When the object was last seen.
    bool moving;
    bool touching;
  };
  /// Indices into the samples; all inclusive.
  struct Contact {
    std::size_t clear;  ///< Last sample without contact before the push.
    std::size_t end;    ///< Last sample in contact, or where the robot stopped.
    std::size_t rest;   ///< First sample of the final rest.
  };
  bool hasMoved(const Pose2& from, const Pose2& to) const;
  bool isTouching(const Pose2& map_T_object, const Pose2& map_T_robot) const;
  std::string whyNothing() const;
  std::optional<std::size_t> firstMotion() const;
  Result findContact(Contact& contact) const;
  Result checkContact(const Contact& contact) const;
  Case record(const Contact& contact) const;

  std::string object_id_;
  ObjectModel object_;
  RobotModel robot_;
  DemonstrationOptions options_;
  std::vector<Sample> samples_;
  bool overflow_ = false;
};

}  // namespace casepush
