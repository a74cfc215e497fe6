#include "scratch_case_base.h"

#include "casepush/common/input_error.h"
#include "casepush/common/scratch_folder.h"

namespace casepush {
ScratchLearning learnInScratch(const Catalog& catalog, const std::string& object,
                               const std::string& robot, const LearningOptions& options) {
  const ScratchFolder folder;
  CaseBase case_base(folder.path() / "cases.db", CaseBase::Access::kCreate);
  ScratchLearning learnt;
  learnt.result = learnInLab(catalog, object, robot, case_base, options);
  if (!learnt.result.success) {
    throw InputError(
        "learning " + object + " with seed " + std::to_string(options.exploration.seed),
        learnt.result.explanation);
  }
  learnt.cases = case_base.cases();
  return learnt;
}

}  // namespace casepush
