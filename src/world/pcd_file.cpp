#include "pcd_file.h"

#include <cstring>
#include <istream>
#include <map>
#include <optional>
#include <sstream>

#include "casepush/common/input_error.h"
#include "point_text.h"

namespace casepush {
namespace {

constexpr std::size_t kMostHeaderLines = 100;
constexpr int kMostBytes = 65536;  // of one point

struct Field {
  std::string name;
  int size = 4;
  char type = 'F';
  int count = 1;
};

struct Header {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::string data;
  std::uint64_t lines = 0;
};

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw InputError(where, what);
}

/// The words after each key of the header.
std::map<std::string, std::vector<std::string>> readEntries(std::istream& stream, Header& header,
                                                            const std::string& where) {
  std::map<std::string, std::vector<std::string>> entries;
  char line[4096];
  while (entries.count("DATA") == 0) {
    if (++header.lines > kMostHeaderLines || !stream.getline(line, sizeof(line))) {
      refuse(where, "is no .pcd file or truncated: its header has no line DATA");
    }
    std::istringstream words(line);
    std::string key;
    if (!(words >> key) || key[0] == '#') continue;
    std::vector<std::string>& values = entries[key];
    for (std::string word; words >> word;) values.push_back(word);
  }
  return entries;
}

template <typename Number>
Number toNumber(const std::string& word, const std::string& key, const std::string& where) {
  std::istringstream stream(word);
  Number number{};
  if (word[0] == '-' || !(stream >> number) || !stream.eof()) {
    refuse(where, "is damaged: " + key + " holds '" + word + "', no valid number");
  }
  return number;
}

Header readHeader(std::istream& stream, const std::string& where) {
  Header header;
  auto entries = readEntries(stream, header, where);
  for (const std::string& name : entries["FIELDS"]) header.fields.push_back({name});
  const std::size_t count = header.fields.size();
  for (const char* key : {"SIZE", "TYPE", "COUNT"}) {
    if (entries.count(key) == 0 && std::string(key) == "COUNT") continue;
    if (entries[key].size() != count) {
      refuse(where, std::string("is damaged: ") + key + " has " +
                        std::to_string(entries[key].size()) + " entries for " +
                        std::to_string(count) + " fields");
    }
  }
  int bytes = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Field& field = header.fields[i];
    field.size = toNumber<int>(entries["SIZE"][i], "SIZE", where);
    field.type = entries["TYPE"][i][0];
    if (entries.count("COUNT") > 0)
      field.count = toNumber<int>(entries["COUNT"][i], "COUNT", where);
    if (field.size > 8 || field.count > kMostBytes ||
        (bytes += field.size * field.count) > kMostBytes) {
      refuse(where, "is damaged: a point of it would take more than 65536 bytes");
    }
  }
  const auto entry = [&](const char* key) -> std::optional<std::uint64_t> {
    if (entries[key].size() != 1) return std::nullopt;
    return toNumber<std::uint64_t>(entries[key][0], key, where);
  };
  const auto points = entry("POINTS");
  const auto width = entry("WIDTH");
  const auto height = entry("HEIGHT");
  if (!points) refuse(where, "is damaged: its header has no valid line POINTS");
  if (width && height && *width * *height != *points) {
    refuse(where, "is damaged: WIDTH times HEIGHT differs from POINTS");
  }
  header.points = *points;
  header.data = entries["DATA"].size() == 1 ? entries["DATA"][0] : "";
  return header;
}

/// Which number of a line, and which byte of a point, each of x, y, z is.
struct Places {
  std::array<int, 3> columns{};
  std::array<int, 3> bytes{};
  std::array<int, 3> sizes{};
  int point_bytes = 0;
};

Places findPlaces(const Header& header, const std::string& where) {
  Places places;
  std::array<bool, 3> found{};
  int column = 0;
  for (const Field& field : header.fields) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (field.name != std::string(1, static_cast<char>('x' + axis))) continue;
      if (field.type != 'F' || field.count != 1 || (field.size != 4 && field.size != 8)) {
        refuse(where, "has a field " + field.name + " that is neither float nor double");
      }
      found[axis] = true;
      places.columns[axis] = column;
      places.bytes[axis] = places.point_bytes;
      places.sizes[axis] = field.size;
    }
    column += field.count;
    places.point_bytes += field.size * field.count;
  }
  if (!(found[0] && found[1] && found[2])) refuse(where, "lacks a field x, y or z");
  return places;
}

float decode(const char* bytes, int size) {
  if (size == 8) {
    double value = 0.0;
    std::memcpy(&value, bytes, sizeof(value));
    return static_cast<float>(value);
  }
  float value = 0.0F;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

[[noreturn]] void refuseTruncated(const Header& header, std::uint64_t points,
                                  const std::string& where) {
  refuse(where, "is truncated: it holds " + std::to_string(points) + " of " +
                    std::to_string(header.points) + " points");
}

std::vector<Eigen::Vector3f> readBinary(std::istream& stream, const Header& header,
                                        const std::string& where) {
  const Places places = findPlaces(header, where);
  const std::streampos start = stream.tellg();
  stream.seekg(0, std::ios::end);
  const auto bytes = static_cast<std::uint64_t>(stream.tellg() - start);
  stream.seekg(start);
  const std::uint64_t held = bytes / static_cast<std::uint64_t>(places.point_bytes);
  if (held < header.points) refuseTruncated(header, held, where);
  std::vector<Eigen::Vector3f> points(header.points);
  std::vector<char> buffer(static_cast<std::size_t>(places.point_bytes));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!stream.read(buffer.data(), places.point_bytes)) refuseTruncated(header, i, where);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points[i][static_cast<int>(axis)] =
          decode(&buffer[static_cast<std::size_t>(places.bytes[axis])], places.sizes[axis]);
    }
    checkCloudPoint(points[i], where, "point " + std::to_string(i + 1));
  }
  return points;
}

std::vector<Eigen::Vector3f> readAscii(std::istream& stream, const Header& header,
                                       const std::string& where) {
  const Places places = findPlaces(header, where);
  std::vector<Eigen::Vector3f> points = readPointLines(stream, places.columns, header.lines, where);
  if (points.size() < header.points) refuseTruncated(header, points.size(), where);
  if (points.size() > header.points) {
    refuse(where, "is damaged: it holds " + std::to_string(points.size()) +
                      " points, its header says " + std::to_string(header.points));
  }
  return points;
}

}  // namespace

std::vector<Eigen::Vector3f> readPcd(std::istream& stream, const std::string& where) {
  const Header header = readHeader(stream, where);
  checkCloudSize(header.points, where);
  if (header.data == "ascii") return readAscii(stream, header, where);
  if (header.data == "binary") return readBinary(stream, header, where);
  refuse(where, "has DATA '" + header.data +
                    "'; must be ascii or binary (pcl_convert_pcd_ascii_binary converts)");
}

}  // namespace casepush
