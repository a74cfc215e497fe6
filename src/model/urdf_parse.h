#pragma once

#include <urdf_world/types.h>

#include <filesystem>

namespace casepush {

/// Parses a URDF file without printing anything.
/// @throws InputError with what the parser would have printed, on one line.
urdf::ModelInterfaceSharedPtr parseUrdf(const std::filesystem::path& path);

}  // namespace casepush
