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
// Lever arms of turning pushes, as shares of the object's radius.
constexpr double kLeastLever = 0.2;
constexpr double kMostLever = 0.7;
constexpr double kStraightLever = 0.08;
constexpr double kMostYawRateRps = 0.4;
// Share of trials that do not balance anything.
constexpr double kUnbalanced = 0.2;
constexpr int kMaxDraws = 100;

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

template <typename Kind, std::size_t kCount>
Kind rarest(const std::array<Kind, kCount>& kinds, const std::array<int, kCount>& counts,
            Random& random) {
  const int least = *std::min_element(counts.begin(), counts.end());
  std::vector<Kind> candidates;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (counts[i] == least) {
      candidates.push_back(kinds[i]);
    }
  }
  return candidates[random.below(candidates.size())];
}

Turn drawTurn(const std::vector<Pose2>& outcomes, Random& random) {
  std::array<int, 3> counts{};
  for (const Pose2& outcome : outcomes) {
    ++counts[static_cast<int>(turnOf(outcome))];
  }
  if (random.chance(kUnbalanced)) {
    counts = {};
  }
  return rarest(std::array<Turn, 3>{Turn::kLeft, Turn::kNone, Turn::kRight}, counts, random);
}

bool drawLong(const std::vector<Pose2>& outcomes, double usual_m, Random& random) {
  std::array<int, 2> counts{};
  for (const Pose2& outcome : outcomes) {
    ++counts[outcome.position().norm() > usual_m ? 1 : 0];
  }
  if (random.chance(kUnbalanced)) {
    counts = {};
  }
  return rarest(std::array<bool, 2>{false, true}, counts, random);
}

double drawDirection(const std::vector<Pose2>& outcomes, int failures, Random& random) {
  const std::vector<DirectionGap> gaps = directionGaps(outcomes);
  const DirectionGap& gap = gaps[static_cast<std::size_t>(failures) % gaps.size()];
  return wrapAngle(gap.from_rad + gap.width_rad * random.uniform(0.25, 0.75));
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

PushCandidates::PushCandidates(ObjectModel object, RobotModel robot,
                               const ExplorationOptions& options)
    : object_(std::move(object)), robot_(std::move(robot)), options_(options) {}

std::optional<PushConfiguration> PushCandidates::tryDraw(Random& random, int failures,
                                                         const std::vector<Pose2>& outcomes) const {
  const double middle_s = 0.5 * (options_.min_duration_s + options_.max_duration_s);
  const double middle_mps = 0.5 * (options_.min_speed_mps + options_.max_speed_mps);
  const double direction_rad = drawDirection(outcomes, failures, random);
  const Turn turn = drawTurn(outcomes, random);
  const bool is_long = drawLong(outcomes, middle_s * middle_mps, random);

  PushConfiguration push;
  push.speed_mps = random.uniform(is_long ? middle_mps : options_.min_speed_mps,
                                  is_long ? options_.max_speed_mps : middle_mps);
  push.duration_s = random.uniform(is_long ? middle_s : options_.min_duration_s,
                                   is_long ? options_.max_duration_s : middle_s);
  double lever = random.uniform(-kStraightLever, kStraightLever);
  if (turn != Turn::kNone) {
    // A push that passes right of the centre turns the object left.
    const double sign = turn == Turn::kLeft ? 1.0 : -1.0;
    lever = -sign * random.uniform(kLeastLever, kMostLever);
    push.yaw_rate_rps =
        sign * random.uniform(0.0, std::min(kMostYawRateRps, robot_.limits.max_yaw_rate_rps));
  }
  const auto start = contactStart(object_.solid, robot_.solid, object_.radius_m + robot_.radius_m,
                                  direction_rad, lever * object_.radius_m, options_.start_gap_m);
  if (!start) {
    return std::nullopt;
  }
  push.object_T_robot = *start;
  return push;
}

PushConfiguration PushCandidates::draw(int attempt, int failures,
                                       const std::vector<Pose2>& outcomes) const {
  Random random = Random::stream(options_.seed, "trial " + std::to_string(attempt));
  for (int i = 0; i < kMaxDraws; ++i) {
    if (const auto push = tryDraw(random, failures, outcomes)) {
      return *push;
    }
  }
  CASEPUSH_CHECK(false,
                 "the robot can not touch " << object_.name << " in " << kMaxDraws << " draws");
  return {};
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
