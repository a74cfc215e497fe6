#include "sqlite.h"

#include <sqlite3.h>

#include <cctype>
#include <chrono>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr int kBusyTimeoutMs = 5000;

std::string explain(int code, const std::string& detail) {
  switch (code) {
    case SQLITE_NOTADB:
      return "is no case base; give the path of a file made by casepush";
    case SQLITE_CORRUPT:
      return "is damaged or truncated (" + detail +
             "); restore a copy, or import a YAML export into a new file";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "is kept locked by another program; end that program or try again";
    case SQLITE_READONLY:
      return "cannot be written: it was opened for reading only, or permissions of file or folder "
             "forbid";
    case SQLITE_CANTOPEN:
      return "cannot be opened; check that its folder exists and the permissions of both";
    case SQLITE_FULL:
      return "cannot be written: the disk is full";
    default:
      return "SQLite reports: " + detail;
  }
}

std::string uri(const std::filesystem::path& file) {
  static const char kHex[] = "0123456789ABCDEF";
  std::string encoded = "file:";
  for (const char c : file.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '-' || c == '_') {
      encoded += c;
    } else {
      encoded += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return encoded + "?immutable=1";
}

int openFlags(SqliteDatabase::Mode mode) {
  switch (mode) {
    case SqliteDatabase::Mode::kImmutable:
      return SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
    case SqliteDatabase::Mode::kExisting:
      return SQLITE_OPEN_READWRITE;
    case SqliteDatabase::Mode::kCreate:
      break;
  }
  return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
}

}  // namespace

SqliteError::SqliteError(const std::string& file, int code, const std::string& detail)
    : InputError(file, explain(code & 0xff, detail)), code_(code & 0xff) {}

void SqliteDatabase::Closer::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

SqliteDatabase::SqliteDatabase(const std::filesystem::path& file, Mode mode)
    : file_(file.string()) {
  const std::string name = mode == Mode::kImmutable ? uri(file) : file_;
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &handle, openFlags(mode), nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) {
    fail(code);
  }
  sqlite3_busy_timeout(handle, kBusyTimeoutMs);
}

SqliteDatabase SqliteDatabase::memoryCopy() const {
  SqliteDatabase copy;
  copy.file_ = file_;
  sqlite3* handle = nullptr;
  int code = sqlite3_open(":memory:", &handle);
  copy.handle_.reset(handle);
  if (code != SQLITE_OK) {
    copy.fail(code);
  }
  sqlite3_backup* backup = sqlite3_backup_init(handle, "main", handle_.get(), "main");
  if (backup == nullptr) {
    copy.fail(sqlite3_errcode(handle));
  }
  sqlite3_backup_step(backup, -1);
  code = sqlite3_backup_finish(backup);
  if (code != SQLITE_OK) {
    copy.fail(code);
  }
  return copy;
}

void SqliteDatabase::fail(int code) const {
  throw SqliteError(file_, code, handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(code));
}

void SqliteDatabase::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    fail(code);
  }
}

// SQLite itself does not wait for other programs while it changes the mode.
void SqliteDatabase::useWriteAheadLog() {
  using Clock = std::chrono::steady_clock;
  constexpr int kPauseMs = 5;
  const auto deadline = Clock::now() + std::chrono::milliseconds(kBusyTimeoutMs);
  const auto change = [this] {
    return sqlite3_exec(handle_.get(), "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
  };
  int code = change();
  while (code == SQLITE_BUSY && Clock::now() < deadline) {
    sqlite3_sleep(kPauseMs);
    code = change();
  }
  if (code != SQLITE_OK) {
    fail(code);
  }
}

std::int64_t SqliteDatabase::integer(const std::string& sql) {
  SqliteStatement statement(*this, sql);
  CASEPUSH_CHECK(statement.step(), sql);
  return statement.integer(0);
}

std::string SqliteDatabase::text(const std::string& sql) {
  SqliteStatement statement(*this, sql);
  CASEPUSH_CHECK(statement.step(), sql);
  return statement.text(0);
}

std::int64_t SqliteDatabase::lastInsertId() const {
  return sqlite3_last_insert_rowid(handle_.get());
}

bool SqliteDatabase::isWritable() const { return sqlite3_db_readonly(handle_.get(), "main") == 0; }

bool SqliteDatabase::hasMoved() const {
  int moved = 0;
  sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_HAS_MOVED, &moved);
  return moved != 0;
}

void SqliteDatabase::allowCheckpointOnClose(bool allowed) {
  sqlite3_db_config(handle_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, allowed ? 0 : 1, nullptr);
}

void SqliteStatement::Finalizer::operator()(sqlite3_stmt* handle) const {
  sqlite3_finalize(handle);
}

SqliteStatement::SqliteStatement(SqliteDatabase& database, const std::string& sql)
    : database_(database) {
  sqlite3_stmt* handle = nullptr;
  const int code = sqlite3_prepare_v2(database.handle_.get(), sql.c_str(), -1, &handle, nullptr);
  handle_.reset(handle);
  require(code);
}

void SqliteStatement::require(int code) const {
  if (code != SQLITE_OK) {
    database_.fail(code);
  }
}

SqliteStatement& SqliteStatement::bind(std::int64_t value) {
  require(sqlite3_bind_int64(handle_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind(const std::optional<std::int64_t>& value) {
  if (value) {
    return bind(*value);
  }
  return bind(std::optional<double>());
}

SqliteStatement& SqliteStatement::bind(double value) {
  require(sqlite3_bind_double(handle_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind(const std::optional<double>& value) {
  if (value) {
    return bind(*value);
  }
  require(sqlite3_bind_null(handle_.get(), ++bound_));
  return *this;
}

SqliteStatement& SqliteStatement::bind(const std::string& value) {
  require(sqlite3_bind_text64(handle_.get(), ++bound_, value.data(), value.size(), SQLITE_TRANSIENT,
                              SQLITE_UTF8));
  return *this;
}

SqliteStatement& SqliteStatement::bindBlob(const std::string& bytes) {
  require(
      sqlite3_bind_blob64(handle_.get(), ++bound_, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    database_.fail(code);
  }
  return code == SQLITE_ROW;
}

void SqliteStatement::run() { CASEPUSH_CHECK(!step(), sqlite3_sql(handle_.get())); }

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

double SqliteStatement::real(int column) const {
  return sqlite3_column_double(handle_.get(), column);
}

bool SqliteStatement::isNull(int column) const {
  return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
}

std::string SqliteStatement::text(int column) const { return blob(column); }

std::string SqliteStatement::blob(int column) const {
  const void* bytes = sqlite3_column_blob(handle_.get(), column);
  const int size = sqlite3_column_bytes(handle_.get(), column);
  return size == 0 ? std::string() : std::string(static_cast<const char*>(bytes), size);
}

SqliteTransaction::SqliteTransaction(SqliteDatabase& database, Kind kind) : database_(database) {
  // A write lock taken at once waits for other writers; one taken later could only fail.
  database_.execute(kind == Kind::kWrite ? "BEGIN IMMEDIATE" : "BEGIN");
  if (kind == Kind::kWrite && database_.hasMoved()) {
    database_.execute("ROLLBACK");
    throw InputError(database_.file(),
                     "was deleted, moved or replaced while in use, so that nothing more is stored; "
                     "put it back and start the program again");
  }
}

SqliteTransaction::~SqliteTransaction() {
  if (open_) {
    try {
      database_.execute("ROLLBACK");
    } catch (const SqliteError&) {
      // SQLite has rolled back by itself, as it does after some failures.
    }
  }
}

void SqliteTransaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace casepush
