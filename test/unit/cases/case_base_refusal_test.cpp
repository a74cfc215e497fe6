#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "case_fixtures.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;
namespace fs = std::filesystem;

std::string openingError(const fs::path& file, Access access) {
  return inputErrorOf([&] { CaseBase(file, access); });
}

void runSql(const fs::path& file, const char* sql) {
  sqlite3* raw = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &raw), SQLITE_OK);
  char* error = nullptr;
  EXPECT_EQ(sqlite3_exec(raw, sql, nullptr, nullptr, &error), SQLITE_OK) << error;
  sqlite3_close(raw);
}

// Acts as a user without special rights while alive; does nothing if the test is run by one.
class Unprivileged {
 public:
  Unprivileged() {
    if (::geteuid() == 0) {
      constexpr uid_t kNobody = 65534;
      is_changed_ = ::seteuid(kNobody) == 0;
    }
  }
  ~Unprivileged() {
    if (is_changed_ && ::seteuid(0) != 0) {
      std::abort();
    }
  }
  Unprivileged(const Unprivileged&) = delete;
  Unprivileged& operator=(const Unprivileged&) = delete;

 private:
  bool is_changed_ = false;
};

class CaseBaseRefusal : public ::testing::Test {
 protected:
  // Refused in every way of opening, with the same bytes and the same neighbours afterwards.
  void expectUntouchedRefusal(const fs::path& file, const std::string& reason) {
    const std::string before = readFile(file);
    const std::vector<std::string> neighbours = listFolder();
    for (const Access access : {Access::kReadOnly, Access::kReadWrite, Access::kCreate}) {
      expectRefusal(openingError(file, access), file, reason);
      EXPECT_EQ(readFile(file), before);
      EXPECT_EQ(listFolder(), neighbours);
    }
  }

  std::vector<std::string> listFolder() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  // A base of some tens of pages.
  void fillBase() {
    CaseBase base(file_, Access::kCreate);
    for (int i = 0; i < 20; ++i) {
      base.observe(base.add(recordedCase(i)), {}, {});
    }
  }

  TemporaryFolder folder_;
  fs::path file_ = folder_ / "my cases?#%.db";
};

TEST_F(CaseBaseRefusal, missingFile) {
  for (const Access access : {Access::kReadOnly, Access::kReadWrite}) {
    expectRefusal(openingError(file_, access), file_, "does not exist; learn an object first");
    EXPECT_FALSE(fs::exists(file_));
  }
}

TEST_F(CaseBaseRefusal, missingFolder) {
  const fs::path file = folder_ / "nowhere" / "cases.db";
  expectRefusal(openingError(file, Access::kReadOnly), file, "does not exist");
  expectRefusal(openingError(file, Access::kCreate), file,
                "there is no folder " + (folder_ / "nowhere").string());
}

TEST_F(CaseBaseRefusal, folder) {
  fs::create_directory(file_);
  for (const Access access : {Access::kReadOnly, Access::kReadWrite, Access::kCreate}) {
    expectRefusal(openingError(file_, access), file_, "is a folder");
  }
}

TEST_F(CaseBaseRefusal, noRegularFile) {
  expectRefusal(openingError("/dev/null", Access::kCreate), "/dev/null", "is no regular file");
}

TEST_F(CaseBaseRefusal, emptyFileUnlessCreating) {
  writeFile(file_, "");
  expectRefusal(openingError(file_, Access::kReadOnly), file_, "is empty");
  expectRefusal(openingError(file_, Access::kReadWrite), file_, "is empty");
  EXPECT_EQ(openingError(file_, Access::kCreate), "");
}

TEST_F(CaseBaseRefusal, noDatabase) {
  writeFile(file_, "casepush_cases: 1\ncases: []\n");
  expectUntouchedRefusal(file_, "is no case base");
  writeFile(file_, std::string(100000, 'x'));
  expectUntouchedRefusal(file_, "is no case base");
}

TEST_F(CaseBaseRefusal, databaseOfAnotherProgram) {
  runSql(file_, "CREATE TABLE songs (title TEXT); PRAGMA journal_mode = WAL;");
  expectUntouchedRefusal(file_, "belongs to another program");
  runSql(file_, "PRAGMA application_id = 7;");
  expectUntouchedRefusal(file_, "belongs to another program");
}

TEST_F(CaseBaseRefusal, newerSchema) {
  fillBase();
  runSql(file_, "PRAGMA user_version = 9;");
  expectUntouchedRefusal(file_, "has schema version 9, this program knows up to 3");
}

TEST_F(CaseBaseRefusal, truncatedFile) {
  fillBase();
  const std::string whole = readFile(file_);
  ASSERT_GT(whole.size(), 30000u);
  for (const std::size_t size : {std::size_t{50}, std::size_t{1000}, whole.size() / 2,
                                 whole.size() - 4096, whole.size() - 1}) {
    writeFile(file_, whole.substr(0, size));
    expectUntouchedRefusal(file_, "is damaged or truncated");
  }
  writeFile(file_, whole);
  EXPECT_EQ(CaseBase(file_, Access::kReadOnly).cases().size(), 20u);
}

TEST_F(CaseBaseRefusal, overwrittenPages) {
  fillBase();
  std::string content = readFile(file_);
  content.replace(4096, 8192, std::string(8192, '\xa5'));
  writeFile(file_, content);
  expectUntouchedRefusal(file_, "is damaged or truncated");
}

TEST_F(CaseBaseRefusal, missingTable) {
  fillBase();
  runSql(file_, "DROP TABLE outcomes;");
  expectUntouchedRefusal(file_, "is damaged or truncated (no table outcomes)");
}

TEST_F(CaseBaseRefusal, senselessRowsAreNamed) {
  fillBase();
  runSql(file_, "UPDATE cases SET cov_y_y = -1 WHERE id = 3;");
  expectRefusal(inputErrorOf([&] { CaseBase(file_, Access::kReadOnly).cases(); }), file_,
                "case 3: start_outcome.covariance");
  runSql(file_, "UPDATE steps SET steps = x'00' WHERE case_id = 2;");
  expectRefusal(inputErrorOf([&] { CaseBase(file_, Access::kReadOnly).get(2); }), file_,
                "case 2: steps: is damaged");
  runSql(file_, "UPDATE cases SET origin = 'dreamt' WHERE id = 1;");
  expectRefusal(inputErrorOf([&] { CaseBase(file_, Access::kReadOnly).get(1); }), file_,
                "case 1: origin: is damaged");
}

TEST_F(CaseBaseRefusal, unwritableFolder) {
  fs::permissions(folder_.path(), fs::perms(0555));
  {
    const Unprivileged unprivileged;
    expectRefusal(openingError(file_, Access::kCreate), file_, "cannot be opened");
  }
  fs::permissions(folder_.path(), fs::perms(0755));
}

// SQLite itself would go on to write to the file that has no name any more.
TEST_F(CaseBaseRefusal, nothingIsStoredInAFileThatWasDeletedOrReplaced) {
  fillBase();
  CaseBase base(file_, Access::kReadWrite);
  const int count = base.count();
  const fs::path elsewhere = file_.string() + ".moved";
  fs::rename(file_, elsewhere);
  const auto add = [&] { base.add(recordedCase(15)); };
  expectRefusal(inputErrorOf(add), file_, "was deleted, moved or replaced while in use");
  fs::copy_file(elsewhere, file_);
  expectRefusal(inputErrorOf(add), file_, "was deleted, moved or replaced while in use");
  EXPECT_EQ(base.count(), count);
  fs::rename(elsewhere, file_);
  add();
  EXPECT_EQ(base.count(), count + 1);
}

TEST_F(CaseBaseRefusal, unwritableFileIsReadable) {
  fillBase();
  fs::permissions(file_, fs::perms(0444));
  fs::permissions(folder_.path(), fs::perms(0555));
  const std::string before = readFile(file_);
  {
    const Unprivileged unprivileged;
    expectRefusal(openingError(file_, Access::kReadWrite), file_, "cannot be written");
    EXPECT_EQ(CaseBase(file_, Access::kReadOnly).cases().size(), 20u);
  }
  EXPECT_EQ(readFile(file_), before);
  fs::permissions(folder_.path(), fs::perms(0755));
}

}  // namespace
}  // namespace casepush
