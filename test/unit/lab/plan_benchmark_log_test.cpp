#include <gtest/gtest.h>

#include <sstream>

#include "casepush/lab/plan_benchmark.h"

namespace casepush {
namespace {

/// Reads the lines of a log one after the other, as ompl_benchmark_statistics.py does.
class LogLines {
 public:
  explicit LogLines(const std::string& text) : text_(text) {}

  std::string next() {
    std::string line;
    EXPECT_TRUE(std::getline(text_, line)) << "the log ends too early";
    return line;
  }
  /// The number that a line begins with, of a line that ends with `words`.
  double number(const std::string& words) {
    const std::string line = next();
    EXPECT_EQ(line.substr(line.find(' ') + 1), words);
    return std::stod(line);
  }
  void block() {
    EXPECT_EQ(next(), "<<<|");
    while (next() != "|>>>") {
    }
  }
  bool isAtEnd() { return text_.peek() == EOF; }

 private:
  std::istringstream text_;
};

// "1; 0.25; " -> 2.
std::size_t fieldsOf(const std::string& line) {
  std::size_t count = 0;
  for (std::size_t at = line.find("; "); at != std::string::npos; at = line.find("; ", at + 2)) {
    ++count;
  }
  return count;
}

PlanBenchmark twoPlannersOnThreeProblems() {
  PlanBenchmark benchmark;
  benchmark.planners = {PlannerKind::kExpRrt, PlannerKind::kOmplSst};
  PlanRun run;
  run.world = "office";
  run.solved = true;
  run.planning_s = 0.25;
  run.pushes = 7;
  run.length_m = 5.5;
  run.nodes = 40;
  PlanRun failed;
  benchmark.runs = {{run, failed, run}, {failed, failed, run}};
  return benchmark;
}

TEST(OmplLog, hasTheOrderThatOmplsToolsRead) {
  PlanBenchmarkOptions options;
  options.seed = 9;
  options.deadline_s = 0.5;
  const PlanBenchmark benchmark = twoPlannersOnThreeProblems();
  std::ostringstream text;
  writeOmplLog(benchmark, options, 0, text);
  LogLines log(text.str());
  EXPECT_EQ(log.next(), "OMPL version 1.5.2");
  EXPECT_EQ(log.next(), "Experiment office_chair_office");
  EXPECT_EQ(log.next(), "Running on casepush");
  EXPECT_EQ(log.next(), "Starting at 1970-01-01 00:00:00");
  log.block();  // set-up
  log.block();  // processor
  EXPECT_EQ(log.number("is the random seed"), 9);
  EXPECT_EQ(log.number("seconds per run"), 0.5);
  EXPECT_EQ(log.number("MB per run"), 0);
  EXPECT_EQ(log.number("runs per planner"), 3);
  EXPECT_EQ(log.number("seconds spent to collect the data"), 0);
  EXPECT_EQ(log.number("enum types"), 0);
  ASSERT_EQ(log.number("planners"), 2);
  for (const char* name : {"casepush_exp_rrt", "casepush_ompl_sst"}) {
    EXPECT_EQ(log.next(), name);
    EXPECT_EQ(log.number("common properties"), 0);
    const auto properties = static_cast<int>(log.number("properties for each run"));
    for (int i = 0; i < properties; ++i) {
      const std::string line = log.next();
      const std::string type = line.substr(line.rfind(' ') + 1);
      EXPECT_TRUE(type == "BOOLEAN" || type == "REAL" || type == "INTEGER") << line;
    }
    ASSERT_EQ(log.number("runs"), 3);
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(fieldsOf(log.next()), static_cast<std::size_t>(properties));
    EXPECT_EQ(log.next(), ".");
  }
  EXPECT_TRUE(log.isAtEnd());
}

}  // namespace
}  // namespace casepush
