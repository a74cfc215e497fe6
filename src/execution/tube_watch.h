#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"

namespace casepush {

/// Watches during a push whether the object stays within what its case says (Case::tube).
class TubeWatch {
 public:
  /// @param push_case  Its tube; made from the outcome if it has none.
  TubeWatch(const Case& push_case, const TubeWatchOptions& options);

  /// @param push_time_s    Since the push began.
  /// @param stamp_s        When the object was seen; seeing it again in the same frame adds
  /// nothing.
  /// @return True once the object has been outside for long enough.
  bool hasLeft(double push_time_s, double stamp_s, const Pose2& start_T_object);

  /// Was the last pose outside, for however short a time?
  bool isOutside() const { return outside_since_s_.has_value(); }

  /// Probability of a pose as far off as the last one, at the time that fits best.
  double pValue() const { return p_value_; }

  /// How far off the last pose was, for a person: "12 cm and 3 deg off its course".
  std::string describe() const;

 private:
  bool isOutside(double push_time_s, const Pose2& start_T_object);

  TubeWatchOptions options_;
  double period_s_;
  double count_;
  std::vector<PoseGaussian> tube_;
  std::optional<double> last_stamp_s_;
  std::optional<double> outside_since_s_;
  double p_value_ = 1.0;
  double off_m_ = 0.0;
  double off_rad_ = 0.0;
};

}  // namespace casepush
