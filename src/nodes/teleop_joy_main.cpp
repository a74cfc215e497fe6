#include <ros/ros.h>

#include "casepush/ros/joy_teleop.h"
#include "casepush/ros/node_main.h"

int main(int argc, char** argv) {
  return casepush::runNode(argc, argv, "teleop_joy_node", [] {
    const ros::NodeHandle private_handle("~");
    casepush::JoyTeleop node(
        casepush::loadJoyTeleopParameters(casepush::ParameterReader::ofNode(private_handle)),
        ros::NodeHandle());
    ros::spin();
    return 0;
  });
}
