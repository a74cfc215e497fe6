#include "casepush/common/scratch_folder.h"

#include <stdlib.h>

#include <string>
#include <system_error>

#include "casepush/common/input_error.h"

namespace casepush {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "casepush_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw InputError(name, "cannot make a temporary folder");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace casepush
