#pragma once

#include <string>
#include <vector>

#include "casepush/model/object_model.h"

namespace casepush {

/// Finds the wheels of a mechanism: continuous joints with a level axis, each on its own or below a
/// continuous joint with an upright axis (its swivel).
/// @throws InputError naming `where` and the joint: an axis that is neither, a swivel without a
///   wheel, a wheel that is no cylinder or sphere around its joint or does not touch the floor.
std::vector<Caster> findCasters(const Mechanism& mechanism, const std::string& where);

/// Collision shapes in the root frame; what hangs on a swivel becomes the upright cylinder that it
/// can sweep.
Solid sweptSolid(const Mechanism& mechanism, const std::vector<Caster>& casters);

}  // namespace casepush
