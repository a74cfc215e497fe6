#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "case_rows.h"

namespace casepush {

/// Cases as YAML. Numbers are written with as many digits as it takes to read back the same bits.
std::string formatCases(const std::vector<CaseRecord>& records);

/// Reads what formatCases writes; ids are ignored.
/// @throws InputError naming file, case and field: unreadable, missing or unknown key, a value that
///   is not finite, and all that validateCase refuses.
std::vector<CaseRecord> readCases(const std::filesystem::path& file);

}  // namespace casepush
