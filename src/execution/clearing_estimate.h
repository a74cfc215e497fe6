#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/clear_way.h"

namespace casepush {

/// How long it will take to push all that stands in a plan's way away, one object after another.
class ClearingEstimate {
 public:
  /// @param blockers  Ids of those of the others that stand in the way.
  /// @param others    All that is known but the plan's object.
  ClearingEstimate(PushPlan way, std::vector<std::string> blockers,
                   std::vector<PlacedObject> others, const Pose2& map_T_robot,
                   const ClearWayServices& services, const ClearWayOptions& options);

  /// Seconds, infinity if one of them cannot be pushed away; nothing until that is known.
  std::optional<double> poll();

 private:
  ClearingRequest request() const;
  PlacedObject& next();
  void take(const ClearingResult& found);

  PushPlan way_;
  std::vector<std::string> left_;
  std::vector<PlacedObject> others_;  ///< Where they will stand by then.
  Pose2 map_T_robot_;
  const ClearWayServices& services_;
  const ClearWayOptions& options_;
  PendingClearing pending_;
  std::size_t next_ = 0;      ///< In left_.
  bool has_cleared_ = false;  ///< One of them, since the first of left_ was tried last.
  double time_s_ = 0.0;
  double back_s_ = 0.0;
};

}  // namespace casepush
