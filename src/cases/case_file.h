#pragma once

#include <filesystem>

#include "casepush/cases/case_base.h"
#include "sqlite.h"

namespace casepush {

/// Opens the SQLite file of a case base and makes sure that it is one this program understands.
///
/// Everything that can be refused is refused before anything is written.
/// @throws InputError, see CaseBase.
SqliteDatabase openCaseFile(const std::filesystem::path& file, CaseBase::Access access);

/// An empty case base in memory.
SqliteDatabase openCaseMemory();

}  // namespace casepush
