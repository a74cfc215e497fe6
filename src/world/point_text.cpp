#include "point_text.h"

#include <algorithm>
#include <cstdlib>
#include <istream>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr std::size_t kLongestLine = 10000;

std::string lineName(std::uint64_t number) { return "line " + std::to_string(number); }

/// std::getline that does not swallow a giant file without line ends.
bool readLine(std::istream& stream, std::string& line, const std::string& where,
              std::uint64_t number) {
  line.clear();
  for (int c = stream.get(); c != std::istream::traits_type::eof(); c = stream.get()) {
    if (c == '\n') return true;
    if (c == '\0' || line.size() >= kLongestLine) {
      throw InputError(where, lineName(number) + " is no text");
    }
    line += static_cast<char>(c);
  }
  return !line.empty();
}

/// The numbers of a line; throws if a word is none.
void splitNumbers(const std::string& line, std::vector<double>& numbers, const std::string& where,
                  std::uint64_t line_number) {
  numbers.clear();
  const char* at = line.c_str();
  for (;;) {
    while (*at == ' ' || *at == '\t' || *at == ',' || *at == '\r') ++at;
    if (*at == '\0' || *at == '#') return;
    char* end = nullptr;
    numbers.push_back(std::strtod(at, &end));
    if (end == at) {
      throw InputError(
          where, lineName(line_number) + ": '" + std::string(at).substr(0, 20) + "' is no number");
    }
    at = end;
  }
}

}  // namespace

void checkCloudSize(std::uint64_t points, const std::string& where) {
  if (points <= kMostCloudPoints) return;
  throw InputError(where, "holds " + std::to_string(points) + " points or more; must be at most " +
                              std::to_string(kMostCloudPoints) + ": thin it out first");
}

void checkCloudPoint(const Eigen::Vector3f& point, const std::string& where,
                     const std::string& place) {
  if (point.allFinite()) return;
  throw InputError(where, place +
                              " is not finite; remove such points, which often stand for "
                              "missing returns");
}

std::vector<Eigen::Vector3f> readPointLines(std::istream& stream, const std::array<int, 3>& columns,
                                            std::uint64_t line_number, const std::string& where) {
  const auto needed = static_cast<std::size_t>(*std::max_element(columns.begin(), columns.end()));
  std::vector<Eigen::Vector3f> points;
  std::vector<double> numbers;
  std::string line;
  while (readLine(stream, line, where, ++line_number)) {
    splitNumbers(line, numbers, where, line_number);
    if (numbers.empty()) continue;
    if (numbers.size() <= needed) {
      throw InputError(where, lineName(line_number) + " holds " + std::to_string(numbers.size()) +
                                  " numbers, must hold at least " + std::to_string(needed + 1));
    }
    checkCloudSize(points.size() + 1, where);
    Eigen::Vector3f& point = points.emplace_back();
    for (int i = 0; i < 3; ++i) {
      point[i] = static_cast<float>(numbers[static_cast<std::size_t>(columns[i])]);
    }
    checkCloudPoint(point, where, lineName(line_number));
  }
  return points;
}

std::vector<Eigen::Vector3f> readXyz(std::istream& stream, const std::string& where) {
  return readPointLines(stream, {0, 1, 2}, 0, where);
}

}  // namespace casepush
