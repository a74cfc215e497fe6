#include "case_file.h"

#include <sqlite3.h>

#include <string>
#include <vector>

#include "case_schema.h"
#include "casepush/common/input_error.h"

namespace casepush {
namespace {

namespace fs = std::filesystem;

enum class Content { kEmpty, kCaseBase };

bool isEmpty(SqliteDatabase& database) {
  return database.integer("PRAGMA application_id") == 0 &&
         database.integer("SELECT count(*) FROM sqlite_master") == 0;
}

// Refuses other programs' and newer files.
Content identify(SqliteDatabase& database) {
  if (isEmpty(database)) {
    return Content::kEmpty;
  }
  if (database.integer("PRAGMA application_id") != kCaseFileId) {
    throw InputError(database.file(),
                     "belongs to another program; give the path of a file made by casepush");
  }
  const std::int64_t version = schemaVersion(database);
  if (version > kSchemaVersion) {
    throw InputError(database.file(), "has schema version " + std::to_string(version) +
                                          ", this program knows up to " +
                                          std::to_string(kSchemaVersion) + "; update casepush");
  }
  return Content::kCaseBase;
}

void checkTables(SqliteDatabase& database) {
  std::vector<std::string> tables{"cases", "outcomes"};
  if (schemaVersion(database) >= 2) {
    tables.insert(tables.end(), {"steps", "tubes", "priors"});
  }
  for (const std::string& table : tables) {
    if (database.integer("SELECT count(*) FROM sqlite_master WHERE name = '" + table + "'") == 0) {
      throw SqliteError(database.file(), SQLITE_CORRUPT, "no table " + table);
    }
  }
}

// Reading all of a large file would take longer than anything else. Of such a file only the table
// of cases is checked at once; damage to trajectories and observations, which have checksums, is
// noticed when they are read.
constexpr std::int64_t kLargeFileBytes = 32 * 1024 * 1024;

void checkIntegrity(SqliteDatabase& database) {
  const bool is_large =
      database.integer("PRAGMA page_count") * database.integer("PRAGMA page_size") >
      kLargeFileBytes;
  const std::string answer =
      database.text(is_large ? "PRAGMA quick_check(cases)" : "PRAGMA quick_check(1)");
  if (answer != "ok") {
    throw SqliteError(database.file(), SQLITE_CORRUPT, answer.substr(0, answer.find('\n')));
  }
  checkTables(database);
}

// SQLite takes the missing rest of a last page for zeros.
void checkSize(SqliteDatabase& database, const fs::path& file) {
  const std::uintmax_t expected =
      database.integer("PRAGMA page_count") * database.integer("PRAGMA page_size");
  const std::uintmax_t size = fs::file_size(file);
  if (size < expected) {
    throw SqliteError(database.file(), SQLITE_CORRUPT,
                      std::to_string(size) + " of " + std::to_string(expected) + " bytes");
  }
}

// Whether another program has the file open for writing, or died while it had.
bool isUnfinished(const fs::path& file) {
  for (const char* suffix : {"-wal", "-journal"}) {
    std::error_code failure;
    const auto size = fs::file_size(file.string() + suffix, failure);
    if (!failure && size > 0) {
      return true;
    }
  }
  return false;
}

// Looks at the main file alone: opening a foreign or damaged file properly could already write to
// it. An unfinished file may look damaged here; only the proper opening can repair and judge it.
void refuseForeignFile(const fs::path& file) {
  const bool was_unfinished = isUnfinished(file);
  try {
    SqliteDatabase database(file, SqliteDatabase::Mode::kImmutable);
    if (identify(database) == Content::kCaseBase && !was_unfinished) {
      checkSize(database, file);
      checkIntegrity(database);
    }
  } catch (const SqliteError& error) {
    if (error.code() != SQLITE_CORRUPT || !(was_unfinished || isUnfinished(file))) {
      throw;
    }
  }
}

void checkPath(const fs::path& file, CaseBase::Access access) {
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (status.type() == fs::file_type::not_found) {
    if (access != CaseBase::Access::kCreate) {
      throw InputError(file.string(), "does not exist; learn an object first or check the path");
    }
    const fs::path folder = fs::absolute(file).parent_path();
    if (!fs::is_directory(folder, failure)) {
      throw InputError(file.string(), "cannot be made: there is no folder " + folder.string());
    }
    return;
  }
  if (status.type() == fs::file_type::directory) {
    throw InputError(file.string(), "is a folder; give the path of a case base file");
  }
  if (status.type() != fs::file_type::regular) {
    throw InputError(file.string(), "is no regular file" +
                                        (failure ? " (" + failure.message() + ")" : "") +
                                        "; give the path of a case base file");
  }
  if (fs::file_size(file, failure) > 0) {
    refuseForeignFile(file);
  }
}

void verify(SqliteDatabase& database, CaseBase::Access access, bool is_unfinished) {
  database.allowCheckpointOnClose(false);
  if (identify(database) == Content::kEmpty) {
    if (access != CaseBase::Access::kCreate) {
      throw InputError(database.file(), "is empty; learn an object first or check the path");
    }
  } else if (is_unfinished) {
    checkIntegrity(database);
  }
  database.allowCheckpointOnClose(true);
}

void configure(SqliteDatabase& database, CaseBase::Access access) {
  if (access == CaseBase::Access::kReadOnly) {
    database.execute("PRAGMA query_only = ON");
    return;
  }
  if (!database.isWritable()) {
    throw SqliteError(database.file(), SQLITE_READONLY, "");
  }
  database.useWriteAheadLog();
  // Each commit reaches the disk. A push takes the robot half a minute and this a fraction of a
  // millisecond to some milliseconds; a robot's battery does die.
  database.execute("PRAGMA synchronous = FULL");
  database.execute("PRAGMA foreign_keys = ON");
}

SqliteDatabase open(const fs::path& file, CaseBase::Access access, SqliteDatabase::Mode mode) {
  const bool is_unfinished = isUnfinished(file);
  SqliteDatabase database(file, mode);
  verify(database, access, is_unfinished);
  if (access == CaseBase::Access::kReadOnly && schemaVersion(database) < kSchemaVersion) {
    // Only the copy is brought up to date; nobody who merely reads changes a file.
    database = database.memoryCopy();
    migrate(database);
  }
  configure(database, access);
  if (access != CaseBase::Access::kReadOnly && schemaVersion(database) < kSchemaVersion) {
    migrate(database);
  }
  return database;
}

}  // namespace

SqliteDatabase openCaseFile(const fs::path& file, CaseBase::Access access) {
  using Mode = SqliteDatabase::Mode;
  checkPath(file, access);
  try {
    return open(file, access,
                access == CaseBase::Access::kCreate ? Mode::kCreate : Mode::kExisting);
  } catch (const SqliteError& error) {
    // Reading needs a file beside the base. In a folder that nobody may write to, nobody writes to
    // the base either, and it can be read as it lies there.
    const bool is_closed = error.code() == SQLITE_CANTOPEN || error.code() == SQLITE_READONLY;
    if (access != CaseBase::Access::kReadOnly || !is_closed || isUnfinished(file)) {
      throw;
    }
  }
  return open(file, access, Mode::kImmutable);
}

SqliteDatabase openCaseMemory() {
  SqliteDatabase database(":memory:", SqliteDatabase::Mode::kCreate);
  database.execute("PRAGMA foreign_keys = ON");
  migrate(database);
  return database;
}

}  // namespace casepush
