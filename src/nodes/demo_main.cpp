#include <ros/ros.h>

#include "casepush/ros/demo_node.h"
#include "casepush/ros/node_main.h"

int main(int argc, char** argv) {
  return casepush::runNode(argc, argv, "demo_node", [] {
    const ros::NodeHandle private_handle("~");
    casepush::DemoNode node(
        casepush::loadDemoNodeParameters(casepush::ParameterReader::ofNode(private_handle),
                                         casepush::Catalog::standard()),
        ros::NodeHandle());
    return node.run();
  });
}
