#include "command.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>

namespace casepush {
namespace {

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void addCommonOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--seed", options.seed, "Fixes everything random")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()))
      ->capture_default_str();
  command.add_flag("--json", options.json, "Print one JSON object on stdout; logs go to stderr");
}

void printResult(const nlohmann::ordered_json& result, bool json) {
  if (json) {
    std::cout << result.dump() << std::endl;
    return;
  }
  for (const auto& [key, value] : result.items()) {
    std::cout << key << ": " << (value.is_string() ? value.get<std::string>() : value.dump())
              << '\n';
  }
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (open_) {
    std::cerr << std::endl;
  }
}

void ProgressLine::show(const std::string& text) {
  if (text.empty() || text == last_) {
    return;
  }
  last_ = text;
  if (terminal_) {
    std::cerr << "\r\033[K" << text << std::flush;
    open_ = true;
  } else {
    std::cerr << text << '\n';
  }
}

std::string durationText(double seconds) {
  const int whole = static_cast<int>(std::lround(seconds));
  if (whole < 60) {
    return std::to_string(whole) + " s";
  }
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

Stopwatch::Stopwatch() : start_s_(steadySeconds()) {}

double Stopwatch::seconds() const { return steadySeconds() - start_s_; }

}  // namespace casepush
