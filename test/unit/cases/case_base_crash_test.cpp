#include <poll.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <limits>
#include <vector>

#include "case_fixtures.h"

namespace casepush {
namespace {

using Access = CaseBase::Access;
namespace fs = std::filesystem;

// What the child says after a call has returned: observation `number` of this case is stored.
struct Acknowledgement {
  std::int64_t case_id;
  std::int64_t number;
};

// Which outcome is observed is a function of case and number, so that the parent can check it.
Pose2 outcomeOf(std::int64_t case_id, std::int64_t number) {
  return {0.001 * static_cast<double>(case_id), 0.0001 * static_cast<double>(number), 0.1};
}

// Which push is observed, too.
ObservedPush pushOf(const Case& push_case, std::int64_t number) {
  Random random(static_cast<std::uint64_t>(100 * push_case.id + number));
  ObservedPush push = practice(push_case, random);
  push.start_T_object = outcomeOf(push_case.id, number);
  return push;
}

// Everything that learning, adapting and looking after a base write.
[[noreturn]] void learnForEver(const fs::path& file, int acknowledgements) {
  CaseBase base(file, Access::kCreate);
  const auto say = [&](const Acknowledgement& stored) {
    if (::write(acknowledgements, &stored, sizeof(stored)) != sizeof(stored)) {
      ::_exit(1);
    }
  };
  while (true) {
    const std::int64_t id = base.add(recordedCase(5, 60));
    say({id, 1});
    const Case push_case = base.get(id);
    for (std::int64_t number = 2; number <= 6; ++number) {
      if (number == 4) {
        base.observe(id, pushOf(push_case, 9), {});
        base.undo(id);
      }
      if (number == 5) {
        base.adapt(id, pushOf(push_case, number), 0.3, {}, {});
      } else {
        base.observe(id, pushOf(push_case, number), {});
      }
      say({id, number});
    }
    base.remove(base.copy(id, {3.0, ""}));
  }
}

// Lets the child store so many observations, and kills it at whatever it is doing a little later.
std::vector<Acknowledgement> learnAndKill(const fs::path& file, int count, int delay_us) {
  int ends[2];
  if (::pipe(ends) != 0) {
    throw std::runtime_error("no pipe");
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    learnForEver(file, ends[1]);
  }
  ::close(ends[1]);
  std::vector<Acknowledgement> stored;
  const auto hear = [&](int limit) {
    Acknowledgement next{};
    while (static_cast<int>(stored.size()) < limit &&
           ::read(ends[0], &next, sizeof(next)) == sizeof(next)) {
      stored.push_back(next);
    }
  };
  hear(count);
  const timespec delay{0, 1000L * delay_us};
  ::ppoll(nullptr, 0, &delay, nullptr);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";
  hear(std::numeric_limits<int>::max());
  ::close(ends[0]);
  return stored;
}

std::string integrityOf(const fs::path& file) {
  sqlite3* raw = nullptr;
  sqlite3_open(file.c_str(), &raw);
  sqlite3_stmt* check = nullptr;
  sqlite3_prepare_v2(raw, "PRAGMA integrity_check", -1, &check, nullptr);
  std::string answer = sqlite3_step(check) == SQLITE_ROW
                           ? reinterpret_cast<const char*>(sqlite3_column_text(check, 0))
                           : sqlite3_errmsg(raw);
  sqlite3_finalize(check);
  sqlite3_close(raw);
  return answer;
}

void expectStored(const fs::path& file, const std::vector<Acknowledgement>& stored) {
  const CaseBase base(file, Access::kReadOnly);
  for (const Acknowledgement& acknowledged : stored) {
    const std::vector<Pose2> observations = base.observations(acknowledged.case_id);
    ASSERT_GE(static_cast<std::int64_t>(observations.size()), acknowledged.number);
    if (acknowledged.number > 1) {
      expectSamePose(observations[acknowledged.number - 1],
                     outcomeOf(acknowledged.case_id, acknowledged.number));
    }
  }
  for (const Case& push_case : base.cases()) {
    // Statistics, tube and observations change together or not at all.
    EXPECT_EQ(push_case.observation_count,
              static_cast<int>(base.observations(push_case.id).size()));
    ASSERT_EQ(push_case.tube.size(), push_case.steps.size());
    expectSamePose(push_case.tube.back().mean, push_case.start_outcome.mean);
  }
}

TEST(CaseBaseCrash, losesNothingThatWasAcknowledged) {
  // More by hand: CASEPUSH_KILLS=200.
  const char* wanted = std::getenv("CASEPUSH_KILLS");
  const int kills = wanted == nullptr ? 24 : std::atoi(wanted);
  TemporaryFolder folder;
  Random random(1);
  std::vector<Acknowledgement> stored;
  for (int kill = 0; kill < kills; ++kill) {
    const fs::path file = folder / "cases.db";
    const std::vector<Acknowledgement> more = learnAndKill(file, static_cast<int>(random.below(20)),
                                                           static_cast<int>(random.below(4000)));
    stored.insert(stored.end(), more.begin(), more.end());
    // Opening repairs; the next child goes on with what this one left.
    ASSERT_NO_THROW(CaseBase(file, Access::kCreate));
    EXPECT_EQ(integrityOf(file), "ok");
    expectStored(file, stored);
  }
  EXPECT_GT(stored.size(), 100u) << "hardly anything was tested";
  RecordProperty("kills", kills);
  RecordProperty("acknowledged_and_found", static_cast<int>(stored.size()));
}

TEST(CaseBaseCrash, beingKilledWhileCreatingLeavesSomethingThatOpens) {
  constexpr int kKills = 8;
  TemporaryFolder folder;
  for (int kill = 0; kill < kKills; ++kill) {
    const fs::path file = folder / ("cases" + std::to_string(kill) + ".db");
    const std::vector<Acknowledgement> stored = learnAndKill(file, 0, 1000 * kill);
    ASSERT_NO_THROW(CaseBase(file, Access::kCreate));
    expectStored(file, stored);
  }
}

}  // namespace
}  // namespace casepush
