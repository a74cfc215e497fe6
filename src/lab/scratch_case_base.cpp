#include "scratch_case_base.h"

#include "casepush/common/input_error.h"
#include "casepush/common/scratch_folder.h"

namespace casepush {
namespace {

LearningResult learnInto(CaseBase* case_base, const Catalog& catalog, const std::string& object,
                         const std::string& robot, const LearningOptions& options) {
  LearningResult result = learnInLab(catalog, object, robot, *case_base, options);
  if (!result.success) {
    throw InputError(
        "learning " + object + " with seed " + std::to_string(options.exploration.seed),
        result.explanation);
  }
  return result;
}

}  // namespace

ScratchLearning learnInScratch(const Catalog& catalog, const std::string& object,
                               const std::string& robot, const LearningOptions& options) {
  const ScratchFolder folder;
  CaseBase case_base(folder.path() / "cases.db", CaseBase::Access::kCreate);
  ScratchLearning learnt;
  learnt.result = learnInto(&case_base, catalog, object, robot, options);
  learnt.cases = case_base.cases();
  return learnt;
}

std::vector<Case> learnAllInScratch(const Catalog& catalog, const std::vector<std::string>& objects,
                                    const std::string& robot, const LearningOptions& options) {
  const ScratchFolder folder;
  CaseBase case_base(folder.path() / "cases.db", CaseBase::Access::kCreate);
  for (const std::string& object : objects) {
    learnInto(&case_base, catalog, object, robot, options);
  }
  return case_base.cases();
}

}  // namespace casepush
