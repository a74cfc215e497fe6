#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "casepush/common/input_error.h"

struct sqlite3;
struct sqlite3_stmt;

namespace casepush {

/// SQLite refused; the message is one line for a person and names the file.
class SqliteError : public InputError {
 public:
  SqliteError(const std::string& file, int code, const std::string& detail);
  int code() const { return code_; }  ///< Primary result code, e.g. SQLITE_CORRUPT.

 private:
  int code_;
};

/// An open SQLite file.
class SqliteDatabase {
 public:
  enum class Mode {
    kImmutable,  ///< Read-only without locks, log or side files: the main file as it lies there.
    kExisting,   ///< Read-write as far as permissions allow, see isWritable().
    kCreate,
  };

  /// @throws SqliteError
  SqliteDatabase(const std::filesystem::path& file, Mode mode);

  void execute(const std::string& sql);
  void useWriteAheadLog();
  std::int64_t integer(const std::string& sql);  ///< The first column of the only row.
  std::string text(const std::string& sql);      ///< As integer().
  std::int64_t lastInsertId() const;
  bool isWritable() const;
  bool hasMoved() const;  ///< True if the file is no longer where it was opened.

  /// Whether closing the last connection may write the log back into the main file.
  void allowCheckpointOnClose(bool allowed);

  /// A copy of the content that lives in memory; it keeps the file's name for messages.
  SqliteDatabase memoryCopy() const;

  const std::string& file() const { return file_; }

 private:
  friend class SqliteStatement;
  struct Closer {
    void operator()(sqlite3* handle) const;
  };
  SqliteDatabase() = default;
  [[noreturn]] void fail(int code) const;

  std::string file_;
  std::unique_ptr<sqlite3, Closer> handle_;
};

/// One SQL statement: bind its parameters in order, then step through its rows.
class SqliteStatement {
 public:
  SqliteStatement(SqliteDatabase& database, const std::string& sql);

  SqliteStatement& bind(std::int64_t value);
  SqliteStatement& bind(const std::optional<std::int64_t>& value);  ///< NULL if there is none.
  SqliteStatement& bind(double value);
  SqliteStatement& bind(const std::optional<double>& value);  ///< NULL if there is none.
  SqliteStatement& bind(const std::string& value);
  SqliteStatement& bindBlob(const std::string& bytes);

  bool step();  ///< True if there is a row to read.
  void run();   ///< For statements without rows.

  std::int64_t integer(int column) const;
  double real(int column) const;
  bool isNull(int column) const;
  std::string text(int column) const;
  std::string blob(int column) const;

 private:
  struct Finalizer {
    void operator()(sqlite3_stmt* handle) const;
  };
  void require(int code) const;

  const SqliteDatabase& database_;
  std::unique_ptr<sqlite3_stmt, Finalizer> handle_;
  int bound_ = 0;
};

/// Rolls back unless committed.
class SqliteTransaction {
 public:
  enum class Kind { kRead, kWrite };
  /// @throws InputError if it would write to a file that is no longer there.
  SqliteTransaction(SqliteDatabase& database, Kind kind);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;

  void commit();

 private:
  SqliteDatabase& database_;
  bool open_ = true;
};

}  // namespace casepush
