#pragma once

#include <optional>
#include <vector>

#include "casepush/common/pose2.h"

namespace casepush {

/// Heading of the first motion of a robot that follows poses, in their frame [rad].
///
/// Taken where it is 5 cm away from its start, so that neither the noise of the poses nor a
/// correction at the start decides. Nothing if it never gets so far, e.g. because it only turns.
std::optional<double> motionDirection(const std::vector<Pose2>& poses);

}  // namespace casepush
