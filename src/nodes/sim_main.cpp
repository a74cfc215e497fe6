#include <ros/ros.h>

#include "casepush/ros/node_main.h"
#include "casepush/ros/sim_node.h"

int main(int argc, char** argv) {
  return casepush::runNode(argc, argv, "sim_node", [] {
    const ros::NodeHandle private_handle("~");
    casepush::SimNode node(
        casepush::loadSimNodeParameters(casepush::ParameterReader::ofNode(private_handle),
                                        casepush::Catalog::standard()),
        ros::NodeHandle());
    node.run();
    return 0;
  });
}
