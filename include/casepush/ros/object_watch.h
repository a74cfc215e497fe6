#pragma once

#include <casepush/PushableObjectArray.h>
#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "casepush/model/observation.h"

namespace casepush {

/// The newest tracked poses (topic `objects`), for threads that wait for something to be seen.
/// Thread safety: all members.
class ObjectWatch {
 public:
  explicit ObjectWatch(ros::NodeHandle handle);

  /// Nothing if the object has never been seen.
  std::optional<ObjectState> find(const std::string& id) const;

  /// Waits until the object fulfils the condition.
  /// @param give_up  Asked again and again.
  /// @return  The object as it then is; nothing after `patience_s` of wall time, or if told to give
  ///          up.
  std::optional<ObjectState> wait(const std::string& id,
                                  const std::function<bool(const ObjectState&)>& condition,
                                  double patience_s, const std::function<bool()>& give_up) const;

 private:
  void onObjects(const PushableObjectArray& message);

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<ObjectState> objects_;
  ros::Subscriber subscriber_;
};

}  // namespace casepush
