#pragma once

#include <casepush/BodyContactArray.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "casepush/model/world_model.h"

namespace casepush {

/// Counts how often the robot or an object began to touch something that never moves.
class CollisionCounter {
 public:
  explicit CollisionCounter(const WorldModel& world);

  /// Contacts of one control period; a pair that was silent for `kApartS` touches anew.
  void add(const BodyContactArray& message);

  /// "chair_1/seat - desk_2" of each touch, in order.
  const std::vector<std::string>& touches() const { return touches_; }

 private:
  static constexpr double kApartS = 0.1;

  std::set<std::string> static_names_;
  std::map<std::pair<std::string, std::string>, double> last_touch_s_;
  std::vector<std::string> touches_;
};

}  // namespace casepush
