#include "number_table.h"

#include <charconv>
#include <cmath>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

const char* skipBlanks(const char* at, const char* end) {
  while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) {
    ++at;
  }
  return at;
}

}  // namespace

void appendNumber(std::string& text, double value) {
  std::array<char, 32> digits;
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

std::vector<std::vector<double>> parseNumberTable(const std::string& text, std::size_t columns,
                                                  const std::string& where) {
  std::vector<std::vector<double>> rows;
  const char* at = text.data();
  const char* const end = at + text.size();
  std::size_t line = 0;
  const auto fail = [&](const std::string& what) {
    throw InputError(where, "line " + std::to_string(line) + " " + what + "; must be " +
                                std::to_string(columns) + " finite numbers");
  };
  while (at != end) {
    ++line;
    std::vector<double> row;
    row.reserve(columns);
    for (at = skipBlanks(at, end); at != end && *at != '\n'; at = skipBlanks(at, end)) {
      double value = 0.0;
      const auto [next, error] = std::from_chars(at, end, value);
      const bool ends =
          next == end || *next == ' ' || *next == '\n' || *next == '\t' || *next == '\r';
      if (error != std::errc() || !ends) {
        fail("holds something else than numbers");
      }
      if (!std::isfinite(value)) {
        fail("holds a number that is not finite");
      }
      row.push_back(value);
      at = next;
    }
    at += at != end ? 1 : 0;
    if (!row.empty() && row.size() != columns) {
      fail("holds " + std::to_string(row.size()) + " numbers");
    }
    if (!row.empty()) {
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace casepush
