#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "casepush/ros/learner_node.h"

namespace casepush {

struct LearnerNode::Run {
  static constexpr const char* kKept = "; finished pushes are kept";

  std::string object_id;
  const TrackedObject* instance = nullptr;
  ExplorationOptions options;
  PushContext context;  ///< What it is learnt in.
  std::unique_ptr<Exploration> exploration;
  bool teleport = false;
  Pose2 map_T_home;
  std::optional<PushGround> ground;  ///< For a robot that drives.
  int pushes = 0;
  int done_before = 0;  ///< Pushes that earlier runs had stored.
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  double start_s = 0.0;
  LearnObjectResult result;

  bool fail(std::uint8_t status, const std::string& explanation) {
    result.status = status;
    result.explanation = explanation;
    return false;
  }
};

}  // namespace casepush
