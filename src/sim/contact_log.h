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
  void add(const ContactSide& a, const ContactSide& b, double impulse_ns);

  /// Ordered by names; empties the log.
  std::vector<ContactReport> take();

 private:
  // A push meets few pairs, each many times: a short list beats a map of strings.
  struct Entry {
    ContactSide a;
    ContactSide b;
    double impulse_ns;
  };
  std::vector<Entry> entries_;
};

}  // namespace casepush::sim
