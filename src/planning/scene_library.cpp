#include "scene_library.h"

#include <algorithm>
#include <utility>

namespace casepush {
namespace {

bool isSame(const PlacedObject& a, const PlacedObject& b) {
  const Pose2& here = a.map_T_object;
  const Pose2& there = b.map_T_object;
  return a.id == b.id && a.model == b.model && here.x() == there.x() && here.y() == there.y() &&
         here.yaw() == there.yaw();
}

}  // namespace

std::shared_ptr<const Scene> SceneLibrary::get(const std::string& model, const Obstacles& obstacles,
                                               const std::function<Scene()>& make) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.model == model &&
           std::equal(obstacles.begin(), obstacles.end(), entry.obstacles.begin(),
                      entry.obstacles.end(), isSame);
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
