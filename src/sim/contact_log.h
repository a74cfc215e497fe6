#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "casepush/sim/simulator.h"
#include "collision.h"

namespace casepush::sim {

/// One side of a contact.
struct ContactSide {
  const CollisionTag* tag;
  int child;  ///< Index of the shape.

  const std::string& part() const { return tag->part(child); }
};

/// "chair_1 (seat) overlaps wall_3".
std::string describeOverlap(const ContactSide& a, const ContactSide& b);

/// Sums normal impulses by pair of parts.
class ContactLog {
 public:
  /// @param map_point  Where they touch.
  /// @pre The tags live until the next take() or forgetTags().
  void add(const ContactSide& a, const ContactSide& b, double impulse_ns,
           const Eigen::Vector3d& map_point);

  /// Ordered by names; empties the log.
  std::vector<ContactReport> take();

  /// Keeps names instead of tags, which may then end.
  void forgetTags();

 private:
  // A push meets few pairs, each many times: a short list beats a map of strings.
  struct Entry {
    ContactSide a;
    ContactSide b;
    double impulse_ns;
    Eigen::Vector3d moment;  // Sum of impulses times places.
  };
  struct Sum {
    double impulse_ns = 0.0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  };
  std::vector<Entry> entries_;
  std::map<std::tuple<std::string, std::string, std::string, std::string>, Sum> sums_;
};

}  // namespace casepush::sim
