#pragma once

#include <filesystem>
#include <string>

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

}  // namespace casepush
