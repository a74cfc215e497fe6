#include "map_stream.h"

#include <array>
#include <cmath>
#include <istream>
#include <sstream>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr int kTreeDepth = 16;
constexpr double kMinResolution_m = 0.01;
constexpr double kMaxResolution_m = 0.5;

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw InputError(where, what);
}

unsigned readByte(std::istream& stream, const std::string& where) {
  const int value = stream.get();
  if (value < 0) refuse(where, "is truncated: the octree's data end early");
  return static_cast<unsigned>(value);
}

/// A leaf's and an inner node's codes in a .bt file (00 is unknown).
constexpr unsigned kInner = 3;

unsigned long countBinary(std::istream& stream, int depth, const std::string& where) {
  if (depth >= kTreeDepth) refuse(where, "is damaged: the octree is nested deeper than 16 levels");
  const unsigned low = readByte(stream, where);
  const unsigned children = low | readByte(stream, where) << 8;
  unsigned long count = 1;
  for (int child = 0; child < 8; ++child) {
    const unsigned code = children >> (2 * child) & 3;
    if (code == kInner) {
      count += countBinary(stream, depth + 1, where);
    } else if (code != 0) {
      ++count;
    }
  }
  return count;
}

unsigned long countFull(std::istream& stream, int depth, const std::string& where) {
  float log_odds = 0.0F;
  if (!stream.read(reinterpret_cast<char*>(&log_odds), sizeof(log_odds))) {
    refuse(where, "is truncated: the octree's data end early");
  }
  if (!std::isfinite(log_odds)) refuse(where, "is damaged: an occupancy is not finite");
  const unsigned children = readByte(stream, where);
  if (children != 0 && depth >= kTreeDepth) {
    refuse(where, "is damaged: the octree is nested deeper than 16 levels");
  }
  unsigned long count = 1;
  for (int child = 0; child < 8; ++child) {
    if (children >> child & 1) count += countFull(stream, depth + 1, where);
  }
  return count;
}

}  // namespace

void checkResolution(double resolution_m, const std::string& where) {
  if (resolution_m >= kMinResolution_m && resolution_m <= kMaxResolution_m) return;
  std::ostringstream what;
  what << "resolution is " << resolution_m << " m, must be in [" << kMinResolution_m << ", "
       << kMaxResolution_m << "] m";
  refuse(where, what.str());
}

MapHeader readMapHeader(std::istream& stream, const std::string& where) {
  std::string line;
  if (!std::getline(stream, line)) refuse(where, "is empty, must be an OctoMap .bt or .ot file");
  MapHeader header;
  header.binary = line.rfind("# Octomap OcTree binary file", 0) == 0;
  if (!header.binary && line.rfind("# Octomap OcTree file", 0) != 0) {
    refuse(where, "is no OctoMap file: its first line is neither that of a .bt nor of a .ot file");
  }
  std::string type;
  bool has_size = false;
  while (std::getline(stream, line) && line != "data") {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "id") words >> type;
    if (key == "res") words >> header.resolution_m;
    if (key == "size") has_size = static_cast<bool>(words >> header.nodes);
  }
  if (!stream) refuse(where, "is truncated: its header has no line \"data\"");
  if (type != "OcTree") refuse(where, "holds a tree of type \"" + type + "\", must be OcTree");
  if (!has_size) refuse(where, "is damaged: its header has no valid line \"size\"");
  checkResolution(header.resolution_m, where);
  return header;
}

unsigned long countMapNodes(std::istream& stream, bool binary, const std::string& where) {
  return binary ? countBinary(stream, 0, where) : countFull(stream, 0, where);
}

}  // namespace casepush
