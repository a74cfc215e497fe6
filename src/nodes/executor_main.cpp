#include <ros/ros.h>

#include "casepush/ros/executor_node.h"
#include "casepush/ros/node_main.h"

int main(int argc, char** argv) {
  return casepush::runNode(argc, argv, "executor_node", [] {
    const ros::NodeHandle private_handle("~");
    casepush::ExecutorNode node(
        casepush::loadExecutorNodeParameters(casepush::ParameterReader::ofNode(private_handle),
                                             casepush::Catalog::standard()),
        ros::NodeHandle());
    ros::spin();
    return 0;
  });
}
