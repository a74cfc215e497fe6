#pragma once

#include <array>
#include <string>
#include <vector>

namespace casepush {

/// Appends a number with as many digits as it takes to read back the same bits.
void appendNumber(std::string& text, double value);

/// Reads a text of lines of `columns` numbers each, divided by blanks; empty lines do not count.
/// @throws InputError naming `where` and the line: another number of numbers, something else than a
///   number, or one that is not finite.
std::vector<std::vector<double>> parseNumberTable(const std::string& text, std::size_t columns,
                                                  const std::string& where);

}  // namespace casepush
