#include "casepush/model/plan_scatter.h"

#include <cmath>

#include "casepush/common/normal_samples.h"

namespace casepush {
namespace {

PoseGaussian afterPush(const PoseGaussian& map_before, const PlannedPush& push) {
  return compound(map_before, transform(push.map_T_start.inverse(), push.map_outcome));
}

// As expSe2(), much faster where a pose deviates as little as most do.
Pose2 deviated(const Eigen::Vector3d& tangent) {
  constexpr double kLittle_rad = 0.5;  // The series' first term that is left out is below 1e-13.
  const double w = tangent.z();
  if (!(std::abs(w) <= kLittle_rad)) return expSe2(tangent);
  const double w2 = w * w;
  const double sinc =
      1.0 - w2 / 6 * (1.0 - w2 / 20 * (1.0 - w2 / 42 * (1.0 - w2 / 72 * (1.0 - w2 / 110))));
  const double cosc = w / 2 * (1.0 - w2 / 12 * (1.0 - w2 / 30 * (1.0 - w2 / 56 * (1.0 - w2 / 90))));
  return {sinc * tangent.x() - cosc * tangent.y(), cosc * tangent.x() + sinc * tangent.y(), w};
}

}  // namespace

PoseGaussian compoundedEnd(const std::vector<PlannedPush>& pushes, const PoseGaussian& map_start) {
  PoseGaussian end = map_start;
  for (const PlannedPush& push : pushes) {
    end = afterPush(end, push);
  }
  return end;
}

double goalProbability(const PoseGaussian& map_pose, const Pose2& map_T_goal,
                       const GoalTolerance& tolerance) {
  constexpr int kSamples = 256;
  constexpr std::uint64_t kSeed = 1;
  static const std::vector<Eigen::Vector3d> kNormals = normalSamples(kSamples, kSeed);
  const Eigen::Matrix3d root = covarianceRoot(map_pose.covariance);
  const Pose2 mean_T_goal = map_pose.mean.inverse() * map_T_goal;
  int inside = 0;
  for (const Eigen::Vector3d& normal : kNormals) {
    inside += tolerance.isMet(mean_T_goal, deviated(root * normal)) ? 1 : 0;
  }
  return static_cast<double>(inside) / kSamples;
}

void compoundPushes(PushPlan* plan) {
  PoseGaussian pose{plan->object.map_T_object, Eigen::Matrix3d::Zero()};
  for (PlannedPush& push : plan->pushes) {
    pose = afterPush(pose, push);
    push.map_compounded = pose;
  }
  plan->goal_probability = goalProbability(pose, plan->map_T_goal, plan->tolerance);
}

}  // namespace casepush
