#include "contact_log.h"

#include <algorithm>

namespace casepush::sim {
namespace {

bool isSame(const ContactSide& a, const ContactSide& b) {
  return a.tag == b.tag && a.child == b.child;
}

std::string nameOf(const ContactSide& side) {
  if (side.part().empty() || side.part() == side.tag->body) return side.tag->body;
  return side.tag->body + " (" + side.part() + ")";
}

}  // namespace

std::string describeOverlap(const ContactSide& a, const ContactSide& b) {
  // Things that move first: "chair_1 overlaps wall_3" reads better than the other way round.
  const bool swap = a.tag->kind == CollisionTag::Kind::kStatic;
  return nameOf(swap ? b : a) + " overlaps " + nameOf(swap ? a : b);
}

void ContactLog::add(const ContactSide& a, const ContactSide& b, double impulse_ns,
                     const Eigen::Vector3d& map_point) {
  for (Entry& entry : entries_) {
    if ((isSame(entry.a, a) && isSame(entry.b, b)) || (isSame(entry.a, b) && isSame(entry.b, a))) {
      entry.impulse_ns += impulse_ns;
      entry.moment += impulse_ns * map_point;
      return;
    }
  }
  entries_.push_back({a, b, impulse_ns, impulse_ns * map_point});
}

void ContactLog::forgetTags() {
  // Several shapes may share the name of a part, so entries are summed once more.
  for (const Entry& entry : entries_) {
    const bool swap = entry.b.tag->body < entry.a.tag->body;
    const ContactSide& a = swap ? entry.b : entry.a;
    const ContactSide& b = swap ? entry.a : entry.b;
    Sum& sum = sums_[{a.tag->body, a.part(), b.tag->body, b.part()}];
    sum.impulse_ns += entry.impulse_ns;
    sum.moment += entry.moment;
  }
  entries_.clear();
}

std::vector<ContactReport> ContactLog::take() {
  forgetTags();
  std::vector<ContactReport> reports;
  for (const auto& [names, sum] : sums_) {
    const auto& [body_a, part_a, body_b, part_b] = names;
    reports.push_back(
        {body_a, part_a, body_b, part_b, sum.impulse_ns, sum.moment / sum.impulse_ns});
  }
  sums_.clear();
  return reports;
}

}  // namespace casepush::sim
