#pragma once

#include <filesystem>
#include <string>

namespace casepush {

/// Writes a file beside its destination, flushes it to the disk and renames it: whoever opens
/// `file`, at whatever moment, finds the old content or the new one. A link stays a link. What is
/// no file of its own (/dev/stdout, a pipe) is written to instead of being replaced.
/// @throws InputError if the file cannot be written; the old one is then as it was.
void writeFileAtomically(const std::filesystem::path& file, const std::string& content);

}  // namespace casepush
