#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "casepush/cases/outcome_statistics.h"
#include "casepush/model/case.h"

namespace casepush {

/// Cases in one SQLite file (WAL, foreign keys, schema version). Each call is one transaction: a
/// finished push is never lost and the file is never corrupt, whenever the program dies.
///
/// Several readers and one writer may have the file open. Thread safety: one thread per instance.
class CaseBase {
 public:
  enum class Access { kReadOnly, kReadWrite, kCreate };  ///< kCreate: read-write, made if missing.

  /// @throws InputError if the file is missing, is no case base, is newer than this program, or is
  ///   corrupt. The file is left as it was.
  CaseBase(const std::filesystem::path& file, Access access);
  ~CaseBase();
  CaseBase(CaseBase&&) noexcept;
  CaseBase& operator=(CaseBase&&) noexcept;

  /// All cases of an object in ascending id; of all objects if `object` is empty.
  std::vector<Case> cases(const std::string& object = "") const;

  /// @throws InputError if there is no such case.
  Case get(std::int64_t id) const;

  /// Stores a new case together with its first observation. Returns its id.
  /// @throws InputError from validateCase.
  std::int64_t add(const Case& push_case);

  /// Adds one observed outcome by eq. 1, 2. Returns the updated case.
  Case observe(std::int64_t id, const Pose2& start_T_object, const CovarianceFloor& floor);

  /// Adds one observed outcome by eq. 7-9 with the given weight of the past.
  Case adapt(std::int64_t id, const Pose2& start_T_object, double weight,
             const CovarianceFloor& floor);

  /// Removes a case with its observations.
  void remove(std::int64_t id);

  /// Every outcome ever observed for a case, oldest first.
  std::vector<Pose2> observations(std::int64_t id) const;

  /// Writes all cases as YAML (written beside and renamed: never half a file).
  void exportYaml(const std::filesystem::path& file) const;

  /// Adds all cases of a YAML file under new ids, or none.
  /// @throws InputError naming file, case and field. Returns the number added.
  int importYaml(const std::filesystem::path& file);

 private:
  struct Database;
  std::unique_ptr<Database> database_;
};

}  // namespace casepush
