#include "push_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "casepush/common/check.h"
#include "casepush/world/collision_checker.h"
#include "coverage.h"

namespace casepush {
namespace {

constexpr double kSlideStepM = 0.01;
constexpr double kContactAccuracyM = 1e-3;
// Room to each side of the line, so that docking tolerance does not make contact.
constexpr double kSideRoomM = 0.02;
// Lever arm of a push, as a share of the object's radius, and turning while pushing: more of either
// and the robot slides off.
constexpr double kMostLever = 0.8;
constexpr double kMostYawRateRps = 0.6;
// Ahead of the others in a trial: the best of so many draws.
constexpr int kChoices = 48;
constexpr int kMaxDraws = 400;
// Objects go on after the robot has stopped, but start behind it: of speed times duration.
constexpr double kReachShare = 0.65;
constexpr double kCoveredYawRad = 1.2;
constexpr double kPlainSpeedMps = 0.3;
constexpr double kPlainDurationS = 2.0;

/// Distance along the direction, from the object's origin, at which the robot first touches it.
std::optional<double> firstContact(const Solid& object, const Solid& robot, double reach_m,
                                   double direction_rad, double offset_m) {
  const Pose2 object_T_line(0.0, 0.0, direction_rad);
  const auto touches = [&](double s) {
    return solidsOverlap(object, Pose2(), robot, object_T_line * Pose2(s, offset_m, 0.0));
  };
  double free = -reach_m;
  while (!touches(free + kSlideStepM)) {
    free += kSlideStepM;
    if (free > reach_m) {
      return std::nullopt;
    }
  }
  double contact = free + kSlideStepM;
  while (contact - free > kContactAccuracyM) {
    const double middle = 0.5 * (free + contact);
    (touches(middle) ? contact : free) = middle;
  }
  return free;
}

}  // namespace

std::optional<Pose2> contactStart(const Solid& object, const Solid& robot, double reach_m,
                                  double direction_rad, double offset_m, double gap_m) {
  std::optional<double> contact = firstContact(object, robot, reach_m, direction_rad, offset_m);
  if (!contact) {
    return std::nullopt;
  }
  for (const double side : {-kSideRoomM, kSideRoomM}) {
    const auto beside = firstContact(object, robot, reach_m, direction_rad, offset_m + side);
    contact = std::min(*contact, beside.value_or(*contact));
  }
  return Pose2(0.0, 0.0, direction_rad) * Pose2(*contact - gap_m, offset_m, 0.0);
}

DisplacementCoverage::Region coverageRegion(const ExplorationOptions& options) {
  DisplacementCoverage::Region region;
  region.max_m =
      std::max(2.0 * region.min_m, kReachShare * options.max_speed_mps * options.max_duration_s);
  region.max_yaw_rad = kCoveredYawRad;
  return region;
}

PushCandidates::PushCandidates(ObjectModel object, RobotModel robot,
                               const ExplorationOptions& options)
    : object_(std::move(object)),
      robot_(std::move(robot)),
      options_(options),
      predictor_(object_, robot_) {}

std::optional<PushConfiguration> PushCandidates::at(double direction_rad, double offset_m) const {
  const auto start = contactStart(object_.solid, robot_.solid, object_.radius_m + robot_.radius_m,
                                  direction_rad, offset_m, options_.start_gap_m);
  if (!start) {
    return std::nullopt;
  }
  PushConfiguration push;
  push.object_T_robot = *start;
  return push;
}

std::optional<PushConfiguration> PushCandidates::tryDraw(Random& random) const {
  const double direction_rad = random.uniform(-M_PI, M_PI);
  const double lever = random.uniform(-kMostLever, kMostLever);
  const double most_rps = std::min(kMostYawRateRps, robot_.limits.max_yaw_rate_rps);
  const double yaw_rate_rps = random.uniform(-most_rps, most_rps);
  const double speed_mps = random.uniform(options_.min_speed_mps, options_.max_speed_mps);
  const double duration_s = random.uniform(options_.min_duration_s, options_.max_duration_s);
  std::optional<PushConfiguration> push = at(direction_rad, lever * object_.radius_m);
  if (push) {
    push->speed_mps = speed_mps;
    push->yaw_rate_rps = yaw_rate_rps;
    push->duration_s = duration_s;
  }
  return push;
}

std::optional<PushConfiguration> PushCandidates::plainPush(double direction_rad) const {
  std::optional<PushConfiguration> push = at(direction_rad, 0.0);
  if (push) {
    push->speed_mps = std::clamp(kPlainSpeedMps, options_.min_speed_mps, options_.max_speed_mps);
    push->duration_s =
        std::clamp(kPlainDurationS, options_.min_duration_s, options_.max_duration_s);
  }
  return push;
}

std::optional<PushConfiguration> PushCandidates::draw(int attempt,
                                                      const std::vector<Pose2>& outcomes,
                                                      const Filter& filter) const {
  Random random = Random::stream(options_.seed, "trial " + std::to_string(attempt));
  DisplacementCoverage coverage(coverageRegion(options_));
  for (const Pose2& outcome : outcomes) {
    coverage.add(outcome);
  }
  const bool is_spread = options_.coverage == CoverageStrategy::kSpread;
  const int choices = is_spread ? kChoices : 1;
  std::optional<PushConfiguration> best;
  double best_gain = -1.0;
  int considered = 0;
  for (int i = 0; i < kMaxDraws && considered < choices; ++i) {
    const std::optional<PushConfiguration> push = tryDraw(random);
    if (!push || (is_spread && predictor_.slidesOff(*push))) {
      continue;
    }
    const Pose2 predicted = predictor_.predict(*push);
    if (filter && !filter(*push, predicted)) {
      continue;
    }
    ++considered;
    const double gain = coverage.gain(predicted);
    if (gain > best_gain) {
      best = push;
      best_gain = gain;
    }
  }
  return best;
}

Pose2 PushCandidates::runUp(const Pose2& object_T_start, double push_direction_rad) const {
  constexpr int kSteps = 6;
  constexpr double kStepM = 0.025;
  Pose2 pose = object_T_start;
  for (int i = 1; i <= kSteps; ++i) {
    const double run_up_m = i * kStepM;
    const Pose2 farther(object_T_start.x() - run_up_m * std::cos(push_direction_rad),
                        object_T_start.y() - run_up_m * std::sin(push_direction_rad),
                        object_T_start.yaw());
    if (solidsOverlap(object_.solid, Pose2(), robot_.solid, farther)) {
      break;
    }
    pose = farther;
  }
  return pose;
}

}  // namespace casepush
