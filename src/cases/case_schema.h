#pragma once

#include "sqlite.h"

namespace casepush {

inline constexpr std::int64_t kCaseFileId = 0x43507368;  ///< PRAGMA application_id: "CPsh".
inline constexpr std::int64_t kSchemaVersion = 3;        ///< PRAGMA user_version.

/// The schema version of a file; 0 if it is empty.
std::int64_t schemaVersion(SqliteDatabase& database);

/// Brings an empty or older file to kSchemaVersion, in one transaction: it is old or new, never in
/// between. Nothing happens if another program was quicker.
/// @throws InputError naming file and case if a row makes no sense; the file is left as it was.
void migrate(SqliteDatabase& database);

}  // namespace casepush
