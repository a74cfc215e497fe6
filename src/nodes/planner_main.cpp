#include <ros/ros.h>

#include "casepush/ros/node_main.h"
#include "casepush/ros/planner_node.h"

int main(int argc, char** argv) {
  return casepush::runNode(argc, argv, "planner_node", [] {
    const ros::NodeHandle private_handle("~");
    casepush::PlannerNode node(
        casepush::loadPlannerNodeParameters(casepush::ParameterReader::ofNode(private_handle),
                                            casepush::Catalog::standard()),
        ros::NodeHandle());
    ros::spin();
    return 0;
  });
}
