#include <ros/ros.h>

#include "casepush/ros/node_main.h"
#include "casepush/ros/perception_node.h"

int main(int argc, char** argv) {
  return casepush::runNode(argc, argv, "perception_node", [] {
    const ros::NodeHandle private_handle("~");
    casepush::PerceptionNode node(
        casepush::loadPerceptionNodeParameters(casepush::ParameterReader::ofNode(private_handle),
                                               casepush::Catalog::standard()),
        ros::NodeHandle());
    ros::spin();
    return 0;
  });
}
