#include "scratch_case_base.h"

#include <stdlib.h>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

/// A folder that is gone when this is.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "casepush_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw InputError(name, "cannot make a temporary folder");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

ScratchLearning learnInScratch(const Catalog& catalog, const std::string& object,
                               const std::string& robot, const LearningOptions& options) {
  const TemporaryFolder folder;
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
