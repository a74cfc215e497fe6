#include "casepush/ros/object_watch.h"

#include <chrono>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr std::chrono::milliseconds kLook(20);

}  // namespace

ObjectWatch::ObjectWatch(ros::NodeHandle handle)
    : subscriber_(handle.subscribe(names::kObjects.name, 1, &ObjectWatch::onObjects, this,
                                   ros::TransportHints().tcpNoDelay())) {}

void ObjectWatch::onObjects(const PushableObjectArray& message) {
  try {
    std::vector<ObjectState> objects = fromMessage(message);
    const std::lock_guard<std::mutex> lock(mutex_);
    objects_ = std::move(objects);
    changed_.notify_all();
  } catch (const InputError& error) {
    ROS_ERROR_THROTTLE(1.0, "objects ignored: %s", error.what());
  }
}

std::optional<ObjectState> ObjectWatch::find(const std::string& id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const ObjectState& object : objects_) {
    if (object.id == id) {
      return object;
    }
  }
  return std::nullopt;
}

std::optional<ObjectState> ObjectWatch::wait(
    const std::string& id, const std::function<bool(const ObjectState&)>& condition,
    double patience_s, const std::function<bool()>& give_up) const {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (true) {
    const std::optional<ObjectState> object = find(id);
    if (object && condition(*object)) {
      return object;
    }
    if (give_up() || std::chrono::steady_clock::now() > end) {
      return std::nullopt;
    }
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kLook);
  }
}

}  // namespace casepush
