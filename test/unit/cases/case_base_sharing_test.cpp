// Several programs with one base: readers and a writer, each a process of its own.
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <vector>

#include "case_fixtures.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;
namespace fs = std::filesystem;

constexpr int kPushes = 60;

// Runs `work` in a process of its own, which ends with 0 if it returns true.
pid_t start(const std::function<bool()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    bool done = false;
    try {
      done = work();
    } catch (const std::exception& error) {
      ::fprintf(stderr, "%s\n", error.what());
    }
    ::_exit(done ? 0 : 1);
  }
  return child;
}

bool endsWell(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// What a reader sees is one moment: all that belongs to a push, or nothing of it.
bool isConsistent(const CaseBase& base, int& seen) {
  for (const Case& push_case : base.cases()) {
    const bool whole = push_case.tube.size() == push_case.steps.size() &&
                       push_case.effective_count == push_case.observation_count &&
                       push_case.tube.back().covariance == push_case.start_outcome.covariance;
    if (!whole || push_case.observation_count < seen) {
      return false;
    }
    seen = push_case.observation_count;
  }
  return true;
}

TEST(CaseBaseSharing, readersSeeWholePushesWhileOneWrites) {
  TemporaryFolder folder;
  const fs::path file = folder / "cases.db";
  const Case push_case = recordedCase(1);
  CaseBase(file, Access::kCreate).add(push_case);
  const auto write = [&] {
    CaseBase base(file, Access::kReadWrite);
    Random random(1);
    for (int i = 0; i < kPushes; ++i) {
      base.observe(1, practice(push_case, random), {});
    }
    return true;
  };
  const auto read = [&] {
    int seen = 0;
    while (seen < kPushes + 1) {
      const CaseBase base(file, Access::kReadOnly);  // Opening while another one writes, too.
      for (int i = 0; i < 10; ++i) {
        if (!isConsistent(base, seen)) {
          return false;
        }
      }
    }
    return true;
  };
  std::vector<pid_t> readers;
  for (int i = 0; i < 3; ++i) {
    readers.push_back(start(read));
  }
  EXPECT_TRUE(endsWell(start(write)));
  for (const pid_t reader : readers) {
    EXPECT_TRUE(endsWell(reader));
  }
}

TEST(CaseBaseSharing, writersOfSeveralProcessesLoseNothing) {
  TemporaryFolder folder;
  const fs::path file = folder / "cases.db";
  const Case push_case = recordedCase(2);
  CaseBase(file, Access::kCreate).add(push_case);
  std::vector<pid_t> writers;
  for (int writer = 0; writer < 3; ++writer) {
    writers.push_back(start([&, writer] {
      CaseBase base(file, Access::kReadWrite);
      Random random(static_cast<std::uint64_t>(writer));
      for (int i = 0; i < kPushes / 3; ++i) {
        base.observe(1, practice(push_case, random), {});
      }
      return true;
    }));
  }
  for (const pid_t writer : writers) {
    EXPECT_TRUE(endsWell(writer));
  }
  const CaseBase base(file, Access::kReadOnly);
  EXPECT_EQ(base.get(1).observation_count, 1 + kPushes);
  EXPECT_EQ(base.history(1).size(), 1u + kPushes);
}

// All open an old or missing file at once: one of them makes it or brings it up to date.
TEST(CaseBaseSharing, manyMayCreateTheBase) {
  TemporaryFolder folder;
  for (int round = 0; round < 5; ++round) {
    const fs::path file = folder / ("cases" + std::to_string(round) + ".db");
    std::vector<pid_t> programs;
    for (int i = 0; i < 4; ++i) {
      programs.push_back(
          start([&] { return CaseBase(file, Access::kCreate).add(recordedCase(3)) > 0; }));
    }
    for (const pid_t program : programs) {
      EXPECT_TRUE(endsWell(program));
    }
    EXPECT_EQ(CaseBase(file, Access::kReadOnly).count(), 4);
  }
}

}  // namespace
}  // namespace casepush
