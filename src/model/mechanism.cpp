#include "casepush/model/mechanism.h"

#include "casepush/common/check.h"

namespace casepush {

double Mechanism::massKg() const {
  double mass_kg = 0.0;
  for (const Link& link : links) {
    mass_kg += link.mass_kg;
  }
  return mass_kg;
}

int Mechanism::linkIndex(const std::string& link_name) const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == link_name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

Eigen::Isometry3d Mechanism::root_T_link(int link) const {
  CASEPUSH_CHECK(link >= 0 && link < static_cast<int>(links.size()), "link = " << link);
  Eigen::Isometry3d root_T_link = Eigen::Isometry3d::Identity();
  while (link > 0) {
    const Joint& joint = joints[link - 1];
    root_T_link = joint.parent_T_joint * root_T_link;
    link = joint.parent_link;
  }
  return root_T_link;
}

}  // namespace casepush
