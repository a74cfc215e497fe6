#pragma once

#include <iosfwd>
#include <string>

namespace casepush {

/// First lines of OctoMap's .bt and .ot files.
struct MapHeader {
  bool binary = false;  ///< .bt: two bits for each child; else .ot: log-odds.
  double resolution_m = 0.0;
  unsigned long nodes = 0;
};

/// Reads a header and leaves the stream at the first byte of data.
/// @throws InputError naming `where` if this is no OcTree file.
MapHeader readMapHeader(std::istream& stream, const std::string& where);

/// @throws InputError naming `where` unless the resolution is in [0.01, 0.5] m.
void checkResolution(double resolution_m, const std::string& where);

/// Walks through the nodes and returns their number; the stream is left behind the last one.
///
/// OctoMap itself reads on past the end of a truncated file, into unset memory; so nothing is
/// handed to it before it has passed this.
/// @throws InputError naming `where` if the data end early, nest too deep or hold no number.
unsigned long countMapNodes(std::istream& stream, bool binary, const std::string& where);

}  // namespace casepush
