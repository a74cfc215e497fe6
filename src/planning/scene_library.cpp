#include "scene_library.h"

#include <algorithm>
#include <utility>

#include "casepush/common/same_pose.h"

namespace casepush {
namespace {

bool isSameObject(const PlacedObject& a, const PlacedObject& b) {
  return a.id == b.id && a.model == b.model && isSame(a.map_T_object, b.map_T_object);
}

}  // namespace

std::shared_ptr<const Scene> SceneLibrary::get(const std::string& model, const Obstacles& obstacles,
                                               const std::function<Scene()>& make) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.model == model &&
           std::equal(obstacles.begin(), obstacles.end(), entry.obstacles.begin(),
                      entry.obstacles.end(), isSameObject);
  });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
  } else {
    entries_.push_front({model, obstacles, std::make_shared<const Scene>(make())});
    if (entries_.size() > kKept) entries_.pop_back();
  }
  return entries_.front().scene;
}

}  // namespace casepush
