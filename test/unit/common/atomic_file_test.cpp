#include "casepush/common/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "casepush/common/scratch_folder.h"
#include "common/input_error_text.h"

namespace casepush {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class AtomicFile : public testing::Test {
 protected:
  std::string refusal(const fs::path& file) const {
    return inputErrorText([&] { writeFileAtomically(file, "new"); });
  }

  std::size_t filesInFolder() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
};

TEST_F(AtomicFile, replacesAFileAndLeavesNothingElse) {
  writeFileAtomically(folder_ / "a", "old");
  writeFileAtomically(folder_ / "a", "new");
  EXPECT_EQ(contentOf(folder_ / "a"), "new");
  EXPECT_EQ(filesInFolder(), 1U);
}

TEST_F(AtomicFile, writesTheFileThatALinkPointsTo) {
  writeFileAtomically(folder_ / "a", "old");
  fs::create_symlink("a", folder_ / "link");
  writeFileAtomically(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(contentOf(folder_ / "a"), "new");
}

TEST_F(AtomicFile, saysWhyItCannotWrite) {
  EXPECT_EQ(refusal(""), "file: its name is empty");
  const fs::path nowhere = folder_ / "absent" / "a";
  EXPECT_EQ(refusal(nowhere), nowhere.string() + ": cannot be written: No such file or directory");
  EXPECT_EQ(refusal(folder_), folder_.string() + ": cannot be written: Is a directory");
}

// Whoever may write to /dev could otherwise lose its devices by `--output /dev/null`.
TEST_F(AtomicFile, writesToWhatIsNoFileInsteadOfReplacingIt) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal(pipe), pipe.string() + ": cannot be written: No such device or address");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(filesInFolder(), 1U);
  std::fstream reader(pipe, std::ios::in | std::ios::out);
  writeFileAtomically(pipe, "new\n");
  std::string line;
  std::getline(reader, line);
  EXPECT_EQ(line, "new");
}

}  // namespace
}  // namespace casepush
