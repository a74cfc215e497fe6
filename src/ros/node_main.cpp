#include "casepush/ros/node_main.h"

#include <ros/ros.h>

#include <csignal>
#include <cstdio>

#include "casepush/common/input_error.h"

namespace casepush {

int runNode(int argc, char** argv, const char* name, const std::function<int()>& body) {
  constexpr int kBadInput = 2;
  // A file that may not grow any more (ulimit -f) is told of like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    ros::init(argc, argv, name);
    return body();
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  } catch (const ros::Exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  }
  return kBadInput;
}

}  // namespace casepush
