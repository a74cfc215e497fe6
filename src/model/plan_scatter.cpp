#include "casepush/model/plan_scatter.h"

#include "casepush/common/normal_samples.h"

namespace casepush {
namespace {

PoseGaussian afterPush(const PoseGaussian& map_before, const PlannedPush& push) {
  return compound(map_before, transform(push.map_T_start.inverse(), push.map_outcome));
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
  int inside = 0;
  for (const Eigen::Vector3d& normal : kNormals) {
    inside += tolerance.isMet(map_T_goal, map_pose.mean * expSe2(root * normal)) ? 1 : 0;
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
