#pragma once

#include <functional>

namespace casepush {

/// Calls `work` once for each index in [0, count), in ascending order, on up to `jobs` threads, and
/// returns when all are done. If one throws, no further one is begun and its exception is thrown
/// here.
void forEachIndex(int count, int jobs, const std::function<void(int)>& work);

}  // namespace casepush
