#pragma once

#include <string>

#include "casepush/model/observation.h"

namespace casepush {

enum class BehaviourStatus { kRunning, kSucceeded, kFailed };

struct Tick {
  Command command;
  BehaviourStatus status = BehaviourStatus::kRunning;
};

/// Something the robot does, decided once per observation. Pure logic: no clock, no sleep, no ROS.
///
/// Once it has succeeded or failed it commands zero for ever.
class Behaviour {
 public:
  virtual ~Behaviour() = default;
  virtual Tick tick(const Observation& observation) = 0;

  /// What is being done or why it failed, in a few words for a person.
  virtual std::string describe() const = 0;
};

}  // namespace casepush
