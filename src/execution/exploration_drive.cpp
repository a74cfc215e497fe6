// How Exploration chooses a push for a robot that has to drive to it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/common/check.h"
#include "exploration_data.h"

namespace casepush {
namespace {

// Moved by more than this, an object may be pushed again in ways that did not work before.
constexpr double kElsewhereM = 0.05;
constexpr double kElsewhereRad = 0.1;
// Scatter of a push that was never made.
constexpr double kUnknownSigmaM = 0.12;
constexpr double kUnknownSigmaRad = 0.3;
// A push back must bring the object so much nearer to the middle.
constexpr double kHeadwayM = 0.05;
constexpr int kMaxBroughtBackInRow = 40;
constexpr int kDirections = 24;
constexpr double kSamePushRad = 1e-6;
constexpr double kTrajectoryPeriodS = 0.1;

PushCourse forecast(const PushConfiguration& push, const Pose2& start_T_predicted,
                    const RobotLimits& limits) {
  PushCourse course;
  course.start_T_robot = pushTrajectory(push, limits, kTrajectoryPeriodS).start_T_robot;
  const double last = static_cast<double>(course.start_T_robot.size());
  for (std::size_t i = 1; i <= course.start_T_robot.size(); ++i) {
    course.start_T_object.push_back(
        interpolate(Pose2(), start_T_predicted, static_cast<double>(i) / last));
  }
  course.start_outcome.mean = start_T_predicted;
  course.start_outcome.covariance =
      Eigen::Vector3d(kUnknownSigmaM, kUnknownSigmaM, kUnknownSigmaRad).cwiseAbs2().asDiagonal();
  return course;
}

}  // namespace

bool Exploration::Data::isBlocked(const KnownCase& known) const {
  return std::find(blocked_cases.begin(), blocked_cases.end(), known.push_case.id) !=
         blocked_cases.end();
}

void Exploration::Data::noteBlocked(const Trial& trial) {
  if (trial.case_id) {
    blocked_cases.push_back(*trial.case_id);
  } else if (trial.kind == Trial::Kind::kBringBack) {
    blocked_directions_rad.push_back(trial.object_T_robot.yaw());
  }
}

std::optional<Exploration::Trial> Exploration::Data::practiceWithRoom(const PushGround& ground,
                                                                      const Pose2& map_T_object,
                                                                      double least_room_m) const {
  for (const KnownCase& known : cases) {
    if (!isPending(known) || isBlocked(known)) {
      continue;
    }
    const auto room_m = ground.roomAfter(map_T_object, courseOf(known.push_case));
    if (room_m && *room_m >= least_room_m) {
      return practice(known);
    }
  }
  return std::nullopt;
}

std::optional<Exploration::Trial> Exploration::Data::exploringWithRoom(
    const PushGround& ground, const Pose2& map_T_object) const {
  const auto has_room = [&](const PushConfiguration& push, const Pose2& start_T_predicted) {
    const auto room_m =
        ground.roomAfter(map_T_object, forecast(push, start_T_predicted, robot.limits));
    return room_m && *room_m >= ground.neededRoomM();
  };
  const auto push = candidates.draw(attempt, outcomes(), has_room);
  return push ? std::optional<Trial>(exploring(*push)) : std::nullopt;
}

std::optional<Exploration::Trial> Exploration::Data::wayBack(const PushGround& ground,
                                                             const Pose2& map_T_object) const {
  std::optional<Trial> best;
  double nearest_m = (map_T_object.position() - ground.middle()).norm() - kHeadwayM;
  const auto consider = [&](const PushCourse& course, const auto& make) {
    const Pose2 end = map_T_object * course.start_outcome.mean;
    const double left_m = (end.position() - ground.middle()).norm();
    if (left_m < nearest_m && ground.roomAfter(map_T_object, course)) {
      best = make();
      best->kind = Trial::Kind::kBringBack;
      nearest_m = left_m;
    }
  };
  for (const KnownCase& known : cases) {
    if (!isBlocked(known) && !known.set_aside) {
      consider(courseOf(known.push_case), [&] { return practice(known); });
    }
  }
  for (int i = 0; i < kDirections; ++i) {
    const double direction_rad = wrapAngle(2.0 * M_PI * i / kDirections);
    const auto push = candidates.plainPush(direction_rad);
    const auto is_same = [&](double blocked) {
      return std::abs(wrapAngle(blocked - direction_rad)) < kSamePushRad;
    };
    if (push &&
        std::none_of(blocked_directions_rad.begin(), blocked_directions_rad.end(), is_same)) {
      consider(forecast(*push, candidates.predict(*push), robot.limits),
               [&] { return exploring(*push); });
    }
  }
  return best;
}

std::optional<Exploration::Trial> Exploration::next(const PushGround& ground,
                                                    const Pose2& map_T_object) {
  CASEPUSH_CHECK(!data_->to_store, "stored() must follow a verdict kStoreCase");
  if (finished()) {
    return std::nullopt;
  }
  if (distance(data_->blocked_at, map_T_object) > kElsewhereM ||
      std::abs(yawDifference(data_->blocked_at, map_T_object)) > kElsewhereRad) {
    data_->blocked_cases.clear();
    data_->blocked_directions_rad.clear();
    data_->blocked_at = map_T_object;
  }
  std::optional<Trial> trial = data_->practiceWithRoom(ground, map_T_object, ground.neededRoomM());
  if (!trial && data_->wantsCases()) {
    trial = data_->exploringWithRoom(ground, map_T_object);
  }
  if (trial) {
    data_->brought_back_in_row = 0;
    return trial;
  }
  if (data_->brought_back_in_row < kMaxBroughtBackInRow) {
    trial = data_->wayBack(ground, map_T_object);
  }
  if (trial) {
    ++data_->brought_back;
    ++data_->brought_back_in_row;
    return trial;
  }
  trial = data_->practiceWithRoom(ground, map_T_object, -std::numeric_limits<double>::infinity());
  if (!trial) {
    data_->stuck = "no push is possible where " + data_->object.name +
                   " stands now; put it where there is room on all sides and start again (what was "
                   "learnt is kept)";
  }
  return trial;
}

}  // namespace casepush
