#pragma once

#include <utility>

#include "casepush/execution/execute_push.h"
#include "execution/fake_world.h"

namespace casepush::test {

/// A push tried for the first time in a FakeWorld.
inline ExecutePush firstTrial(PushConfiguration configuration = straightPush(),
                              ApproachPlanner approach = detour) {
  return {"chair_1", configuration, fakeRobot(), std::move(approach), ExecutePushOptions{}};
}

/// A push that repeats a case.
inline ExecutePush replay(const Case& push_case) {
  return {"chair_1", push_case, fakeRobot(), detour, ExecutePushOptions{}};
}

}  // namespace casepush::test
