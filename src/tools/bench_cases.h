#pragma once

#include "command.h"

namespace casepush {

/// Adds `casepush bench cases`.
void addBenchCasesCommand(CLI::App& bench, Run& run);

}  // namespace casepush
