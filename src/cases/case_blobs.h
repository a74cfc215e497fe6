#pragma once

#include <string>
#include <vector>

#include "casepush/model/case.h"

namespace casepush {

/// Trajectories as columns of the case base: IEEE 754 doubles, little-endian, and 8 bytes of
/// checksum, without which a flipped bit would be a different push.
///
/// Decoding throws InputError naming `where` if the bytes are not what was encoded.

/// Nine numbers a step: x, y, yaw of object_T_robot, vx, vy, wz of the action, x, y, yaw of
/// start_T_object [m, rad, m/s, rad/s].
std::string encodeSteps(const std::vector<CaseStep>& steps);
std::vector<CaseStep> decodeSteps(const std::string& bytes, const std::string& where);

/// Three numbers a pose.
std::string encodePath(const std::vector<Pose2>& path);
std::vector<Pose2> decodePath(const std::string& bytes, const std::string& where);

/// Nine numbers a step: x, y, yaw of the mean, upper triangle of the covariance.
std::string encodeTube(const std::vector<PoseGaussian>& tube);
std::vector<PoseGaussian> decodeTube(const std::string& bytes, const std::string& where);

/// Steps as schema version 1 had them: without a checksum.
std::vector<CaseStep> decodeUncheckedSteps(const std::string& bytes, const std::string& where);

}  // namespace casepush
