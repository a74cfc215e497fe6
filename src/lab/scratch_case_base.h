#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "casepush/lab/learning.h"

namespace casepush {

/// Learns an object in a case base that is gone afterwards.
struct ScratchLearning {
  std::vector<Case> cases;
  LearningResult result;
};

/// @throws InputError as learnInLab; also if learning gives up.
ScratchLearning learnInScratch(const Catalog& catalog, const std::string& object,
                               const std::string& robot, const LearningOptions& options);

/// The cases of several objects, learnt one after the other in one such case base: no two have the
/// same id, and those of the first object are as if it were learnt alone.
std::vector<Case> learnAllInScratch(const Catalog& catalog, const std::vector<std::string>& objects,
                                    const std::string& robot, const LearningOptions& options);

}  // namespace casepush
