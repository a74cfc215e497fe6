#include "casepush/ros/collision_counter.h"

namespace casepush {

CollisionCounter::CollisionCounter(const WorldModel& world) {
  for (const StaticBox& box : world.boxes) {
    static_names_.insert(box.name);
  }
}

void CollisionCounter::add(const BodyContactArray& message) {
  const double now_s = message.header.stamp.toSec();
  for (const BodyContact& contact : message.contacts) {
    const bool a_static = static_names_.count(contact.body_a) > 0;
    const bool b_static = static_names_.count(contact.body_b) > 0;
    if (a_static == b_static) {
      continue;
    }
    const std::string& body = a_static ? contact.body_b : contact.body_a;
    const std::string& part = a_static ? contact.part_b : contact.part_a;
    const std::string& wall = a_static ? contact.body_a : contact.body_b;
    const auto known = last_touch_s_.find({body, wall});
    if (known == last_touch_s_.end() || now_s - known->second > kApartS) {
      touches_.push_back(body + "/" + part + " - " + wall);
    }
    last_touch_s_[{body, wall}] = now_s;
  }
}

}  // namespace casepush
