#include <ros/ros.h>

#include "casepush/ros/learner_node.h"
#include "casepush/ros/node_main.h"

int main(int argc, char** argv) {
  return casepush::runNode(argc, argv, "learner_node", [] {
    const ros::NodeHandle private_handle("~");
    casepush::LearnerNode node(
        casepush::loadLearnerNodeParameters(casepush::ParameterReader::ofNode(private_handle),
                                            casepush::Catalog::standard()),
        ros::NodeHandle());
    ros::spin();
    return 0;
  });
}
