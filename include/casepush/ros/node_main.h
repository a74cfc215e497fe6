#pragma once

#include <functional>

namespace casepush {

/// Runs a node's body; an InputError becomes one line on stderr and exit code 2.
///
/// @param body  Builds the node, spins, and returns the exit code.
int runNode(int argc, char** argv, const char* name, const std::function<int()>& body);

}  // namespace casepush
