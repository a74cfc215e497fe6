#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <string>

namespace casepush {

/// Publishes one diagnostic task of a node once a second of wall time, also while simulated time
/// stands still.
class Diagnostics {
 public:
  Diagnostics(ros::NodeHandle handle, const std::string& task,
              const diagnostic_updater::TaskFunction& report)
      : timer_(handle.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
          updater_.force_update();
        })) {
    updater_.setHardwareID("none");
    updater_.add(task, report);
  }

 private:
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace casepush
