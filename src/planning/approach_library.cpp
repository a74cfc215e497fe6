#include "approach_library.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "casepush/world/shadow.h"
#include "straight_motion.h"

namespace casepush {
namespace {

constexpr double kOpenHalf_m = 5.0;   // Of the square without anything else.
constexpr double kWayStep_m = 0.025;  // Between ends of a straight way.
constexpr double kLongest_m = 1.2;    // Of a straight way in or out.
constexpr int kDirections = 24;       // Of ways out.

Map openMap(double resolution_m) {
  WorldModel world;
  world.name = "open floor";
  world.min_m = {-kOpenHalf_m, -kOpenHalf_m};
  world.max_m = {kOpenHalf_m, kOpenHalf_m};
  Map map(resolution_m);
  map.addSurvey(surveyPoints(world, resolution_m));
  return map;
}

/// Bytes of the numbers, as a key.
std::string keyOf(const std::string& model, const PreparedCase& push_case) {
  std::string key = model;
  const auto append = [&key](double value) {
    char bytes[sizeof(double)];
    std::memcpy(bytes, &value, sizeof(value));
    key.append(bytes, sizeof(bytes));
  };
  for (const Pose2& pose : {push_case.robot_begin, push_case.outcome_T_robot}) {
    append(pose.x());
    append(pose.y());
    append(pose.yaw());
  }
  append(push_case.push_direction_rad);
  return key;
}

Pose2 shifted(const Pose2& pose, double direction_rad, double length_m) {
  return {pose.x() + length_m * std::cos(direction_rad),
          pose.y() + length_m * std::sin(direction_rad), pose.yaw()};
}

}  // namespace

ObjectClearance::ObjectClearance(const Solid& object, const std::vector<TravelDisc>& discs) {
  double widest_m = 0.0;
  for (const TravelDisc& disc : discs) widest_m = std::max(widest_m, disc.radius_m);
  beside_m_ = circumscribedRadius(object) + widest_m;
  reach_m_ = beside_m_ + kRange_m;
  side_ = 2 * static_cast<int>(std::ceil(reach_m_ / kNode_m)) + 1;
  clearance_m_.assign(static_cast<std::size_t>(side_) * side_, static_cast<float>(kRange_m));
  for (const ConvexPart& part : convexParts(object)) {
    for (const TravelDisc& disc : discs) {
      const Shadow shadow = part.shadow(disc.low_m, disc.high_m);
      if (shadow.empty()) continue;
      const BoundingDisc around = boundingDisc(shadow);
      for (int i = 0; i < side_ * side_; ++i) {
        const Eigen::Vector2d node =
            kNode_m * Eigen::Vector2d(i % side_ - side_ / 2, i / side_ - side_ / 2);
        const double least_m = (node - around.centre_m).norm() - around.radius_m - disc.radius_m;
        if (least_m >= clearance_m_[i]) continue;
        const double clear_m = separation(shadow, node) - disc.radius_m;
        clearance_m_[i] = std::min(clearance_m_[i], static_cast<float>(clear_m));
      }
    }
  }
  // Nowhere is the clearance less than at the next node, minus the way there.
  for (float& value : clearance_m_) value -= static_cast<float>(kNode_m * M_SQRT1_2);
}

ApproachLibrary::ApproachLibrary(const CollisionChecker& checker, const RobotModel& robot,
                                 const ObjectModels& objects, const RobotPathOptions& options)
    : objects_(objects),
      discs_(travelDiscs(robot.solid, options.margin_m)),
      docking_(checker.footprint(robot.solid, options.dock_margin_m)),
      plain_(checker.footprint(robot.solid)),
      open_(openMap(checker.columns().resolution_m)),
      min_clearance_m_(
          std::max(0.0, checker.columns().resolution_m * M_SQRT1_2 - options.margin_m)) {}

const ObjectClearance& ApproachLibrary::clearance(const std::string& model) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<ObjectClearance>& entry = clearances_[model];
  if (!entry) entry = std::make_unique<ObjectClearance>(objects_.at(model).solid, discs_);
  return *entry;
}

std::shared_ptr<const ApproachLibrary::Ways> ApproachLibrary::ways(const std::string& model,
                                                                   const PreparedCase& push_case) {
  const std::string key = keyOf(model, push_case);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = ways_.find(key);
    if (found != ways_.end()) return found->second;
  }
  auto made = std::make_shared<const Ways>(findWays(model, push_case));
  const std::lock_guard<std::mutex> lock(mutex_);
  return ways_.emplace(key, std::move(made)).first->second;
}

std::unique_ptr<ApproachLibrary::Flood> ApproachLibrary::borrowFlood(int cells) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto flood = std::make_unique<Flood>();
  if (!floods_.empty()) {
    flood = std::move(floods_.back());
    floods_.pop_back();
  }
  flood->visited.resize(cells, 0);
  return flood;
}

void ApproachLibrary::giveBack(std::unique_ptr<Flood> flood) {
  const std::lock_guard<std::mutex> lock(mutex_);
  floods_.push_back(std::move(flood));
}

std::unique_ptr<ApproachLibrary::Known> ApproachLibrary::borrowKnown(
    const std::shared_ptr<const void>& owner) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = std::find_if(known_.begin(), known_.end(), [&owner](const auto& known) {
    return owner != nullptr && known->owner.lock() == owner;
  });
  if (found == known_.end()) {
    auto known = std::make_unique<Known>();
    known->owner = owner;
    return known;
  }
  std::unique_ptr<Known> known = std::move(*found);
  known_.erase(found);
  return known;
}

void ApproachLibrary::giveBack(std::unique_ptr<Known> known) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto is_gone = [](const auto& each) { return each->owner.expired(); };
  known_.erase(std::remove_if(known_.begin(), known_.end(), is_gone), known_.end());
  if (!is_gone(known)) known_.push_back(std::move(known));
}

// With the motions that the path planner makes, so that the two agree.
ApproachLibrary::Ways ApproachLibrary::findWays(const std::string& model,
                                                const PreparedCase& push_case) {
  Ways ways;
  CollisionChecker checker = open_;
  checker.setObstacles({{objects_.at(model).solid, Pose2()}});
  const ObjectClearance& clear = clearance(model);
  waysOut(checker, push_case.outcome_T_robot, [&](const Pose2& end) {
    if (clear.at(end.position()) >= 0.0F) ways.object_T_undocked.push_back(end);
    return true;
  });
  const Pose2& docked = push_case.robot_begin;
  const StraightMotion motion(checker, *docking_, {checker, *docking_, docked});
  Pose2 last = docked;
  for (double back_m = 0.0; back_m <= kLongest_m; back_m += kWayStep_m) {
    const Pose2 pose = shifted(docked, push_case.push_direction_rad, -back_m);
    if (motion.firstBlock(last, pose)) break;
    last = pose;
    if (clear.at(pose.position()) >= 0.0F) ways.object_T_predock.push_back(pose);
  }
  return ways;
}

void ApproachLibrary::waysOut(const CollisionChecker& checker, const Pose2& start,
                              const std::function<bool(const Pose2&)>& visit) const {
  bool is_any = false;
  std::vector<Pose2> front(kDirections, start);
  std::vector<bool> blocked(kDirections, false);
  for (const auto& footprint : {docking_, plain_}) {
    const StraightMotion motion(checker, *footprint, {checker, *footprint, start});
    std::fill(front.begin(), front.end(), start);
    std::fill(blocked.begin(), blocked.end(), false);
    for (double out_m = kWayStep_m; out_m <= kLongest_m; out_m += kWayStep_m) {
      for (int i = 0; i < kDirections; ++i) {
        if (blocked[i]) continue;
        const Pose2 pose = shifted(start, 2.0 * M_PI * i / kDirections, out_m);
        blocked[i] = motion.firstBlock(front[i], pose).has_value();
        front[i] = pose;
        if (blocked[i]) continue;
        is_any = true;
        if (!visit(pose)) return;
      }
    }
    if (is_any) return;  // The robot need not come closer to anything than it stands.
  }
}

bool ApproachLibrary::isDirect(const std::string& model, const PreparedCase& previous,
                               const PreparedCase& next) {
  if (distance(previous.outcome_T_robot, next.robot_begin) >= RobotPathPlanner::kDirect_m) {
    return false;
  }
  const std::string key = keyOf(model, previous) + keyOf("", next);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = direct_.find(key);
    if (found != direct_.end()) return found->second;
  }
  CollisionChecker checker = open_;
  checker.setObstacles({{objects_.at(model).solid, Pose2()}});
  const Pose2& from = previous.outcome_T_robot;
  const StraightMotion motion(checker, *docking_, {checker, *docking_, next.robot_begin});
  const bool is_direct =
      !checker.collides(*docking_, from) && !motion.firstBlock(from, next.robot_begin);
  const std::lock_guard<std::mutex> lock(mutex_);
  return direct_.emplace(key, is_direct).first->second;
}

}  // namespace casepush
