#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "casepush/common/pose_gaussian.h"

namespace casepush {

/// One sample of a push: the paper's (R_j, a_j, O_j) of section 3.1.
struct CaseStep {
  Pose2 object_T_robot;  ///< R_j.
  Twist2 action;         ///< a_j, commanded, in the robot frame.
  Pose2 start_T_object;  ///< O_j, with respect to the object's last resting pose.

  Pose2 start_T_robot() const { return start_T_object * object_T_robot; }
};

enum class CaseOrigin { kExplored, kDemonstrated, kTransferred };
const char* toString(CaseOrigin origin);

/// Circumstances that change what a push does to an object.
struct PushContext {
  std::optional<double> load_kg;  ///< On top of the object; nothing if unknown.
  std::string floor;              ///< What the user calls the floor; empty if unknown.
  /// 0: as told. n > 0: the n-th change that nobody told of, but pushes gave away (AdaptingCases).
  int noticed = 0;

  friend bool operator==(const PushContext& a, const PushContext& b) {
    return a.load_kg == b.load_kg && a.floor == b.floor && a.noticed == b.noticed;
  }
};

/// A probabilistic case: a push that was tried, and the distribution of where the object rests.
///
/// Samples are `period_s` apart. The robot pushes during the first `push_steps` samples; later ones
/// record the object coasting to rest. The last step is at rest.
struct Case {
  std::int64_t id = 0;  ///< Positive once stored.
  std::string object;   ///< Name of the ObjectModel.
  std::string robot;    ///< Name of the RobotModel.
  CaseOrigin origin = CaseOrigin::kExplored;
  std::int64_t source_id = 0;  ///< Case that this one was copied or transferred from; 0: none.
  PushContext context;         ///< What its observations hold for.
  double period_s = 0.1;
  int push_steps = 0;
  std::vector<CaseStep> steps;  ///< The first trial, which practices repeat.

  PoseGaussian start_outcome;  ///< Over the final resting pose in the start frame (eq. 1, 2).
  double effective_count = 0;  ///< n of the statistics; W + 1 after adaptation (eq. 7-9).
  int observation_count = 0;   ///< Pushes ever observed.

  /// Where the object is at each step, over all practices: mean and covariance of start_T_object,
  /// aligned by dynamic time warping. One for each of `steps`, at the same time; the last one is
  /// `start_outcome`. Empty if unknown: cases from a CaseBase always have it.
  std::vector<PoseGaussian> tube;

  double durationS() const { return period_s * static_cast<double>(steps.size()); }
  double pushDurationS() const { return period_s * push_steps; }
};

/// Largest x and y of any pose in a case.
inline constexpr double kLargestCaseCoordinate_m = 100.0;

/// Checks what every part of the program relies on.
/// @throws InputError naming `where` and the field: a value that is not finite; no or more than
///   10000 steps; x or y beyond 100 m, a path beyond 1000 m, an action beyond 10 (m/s, rad/s); a
///   period outside of [0.001, 10] s; push_steps out of range; a matrix that is no covariance or a
///   standard deviation beyond 100 (m, rad); an effective count outside of (0, 1e9]; a tube of
///   another length than the steps; a load outside of [0, 10000] kg.
void validateCase(const Case& push_case, const std::string& where);

/// Checks a pose of a case's trajectory or outcome.
/// @throws InputError naming `where`: not finite, or x or y beyond 100 m.
void validateCasePose(const Pose2& pose, const std::string& where);

/// @throws InputError naming `where` and the field: a load outside of [0, 10000] kg, a floor that
///   is no text on one line, or a negative number of a noticed change.
void validateContext(const PushContext& context, const std::string& where);

/// Heading of the robot's first motion in a case, in the frame of the resting object [rad].
double pushDirection(const Case& push_case);

/// The case with an id, or else the copy that took its place for another context; null if neither
/// is there.
const Case* findCase(const std::vector<Case>& cases, std::int64_t id);

/// True if the case can be replayed by `robot` on `object` (names of models): what another robot's
/// shape did to an object says little about this one's.
bool isFor(const Case& push_case, const std::string& object, const std::string& robot);

}  // namespace casepush
