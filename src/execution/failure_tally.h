#pragma once

#include <array>
#include <string>

#include "casepush/model/push_report.h"

namespace casepush {

/// Why pushes of an exploration were of no use.
class FailureTally {
 public:
  /// A push that brought nothing: it failed, or its outcome is known or too small.
  void add(PushOutcome outcome);
  void addUseful() { out_of_sight_in_row_ = 0; }

  /// The object or the robot was out of sight (or the push cancelled) so often in a row that more
  /// pushes would tell nothing about the object.
  bool isBlind() const;

  int total() const;

  /// One line for a person: how many, why, and what to do.
  std::string describe() const;

  /// True if a failure says nothing about the push that was tried.
  static bool isNoFaultOfThePush(PushOutcome outcome);

 private:
  std::array<int, static_cast<std::size_t>(kLastPushOutcome) + 1> counts_{};
  int out_of_sight_in_row_ = 0;
};

}  // namespace casepush
