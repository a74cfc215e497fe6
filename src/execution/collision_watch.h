#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"

namespace casepush {

/// Watches during a push whether the object is about to touch something.
///
/// It goes on from where it is seen as its case says (Case::tube). Nothing is touched ahead of a
/// push that begins as planned, so that an object on its course is only looked after where things
/// have come into the way since.
class CollisionWatch {
 public:
  CollisionWatch(const Case& push_case, TouchCheck check);

  /// To be called when the push begins. What the object touches where it stands, like a cell of the
  /// map at a wall, is no reason to stop: the course is watched from where it would be free.
  void begin(const Observation& observation, const Pose2& map_T_start);

  /// What the object is about to touch; empty: nothing, or not twice in a row. To be asked at each
  /// tick; seeing the object again in the same frame adds nothing.
  /// @param push_time_s  Since the push began.
  const std::string& aheadOf(const Observation& observation, double push_time_s,
                             const ObjectState& object);

 private:
  std::vector<Pose2> courseFrom(const Pose2& start_T_object, double push_time_s) const;

  TouchCheck check_;
  double period_s_;
  std::vector<Pose2> course_;  ///< start_T_object, at rest at the end.
  Pose2 map_T_start_;
  std::size_t watched_from_ = 0;  ///< Step of the course.
  std::optional<double> last_stamp_s_;
  bool seen_once_ = false;
  std::string ahead_of_;
};

}  // namespace casepush
