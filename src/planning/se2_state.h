#pragma once

#include <ompl/base/spaces/SE2StateSpace.h>

#include <cmath>

#include "casepush/common/pose2.h"

namespace casepush {

/// @pre The state is one of ompl::base::SE2StateSpace.
inline Pose2 poseOf(const ompl::base::State* state) {
  const auto* se2 = state->as<ompl::base::SE2StateSpace::StateType>();
  return {se2->getX(), se2->getY(), se2->getYaw()};
}

/// OMPL's bounds exclude pi, which is the heading of a half turn here.
/// @pre The state is one of ompl::base::SE2StateSpace.
inline void setPose(const Pose2& pose, ompl::base::State* state) {
  auto* se2 = state->as<ompl::base::SE2StateSpace::StateType>();
  se2->setXY(pose.x(), pose.y());
  se2->setYaw(pose.yaw() < M_PI ? pose.yaw() : -M_PI);
}

}  // namespace casepush
