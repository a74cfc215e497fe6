#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "casepush/cases/outcome_statistics.h"
#include "casepush/model/case.h"

namespace casepush {

/// How an observed outcome came to be.
enum class OutcomeSource {
  kExplored,      ///< First trial of a push.
  kDemonstrated,  ///< Driven by a person.
  kTransferred,   ///< Seen with another object.
  kPractised,     ///< Added with eq. 1, 2.
  kAdapted,       ///< Added with eq. 7-9.
};

/// One observation behind a case.
struct ObservedOutcome {
  Pose2 start_T_object;
  OutcomeSource source = OutcomeSource::kExplored;
  double past_weight = 0.0;  ///< Observations that the past counted when this one was added.
};

/// Cases in one SQLite file (WAL, foreign keys, schema version). Each call is one transaction that
/// has reached the disk when the call returns: a finished push is never lost and the file is never
/// corrupt, whenever the program dies or the power fails.
///
/// Several readers and one writer may have the file open; a reader sees what was committed before
/// its call. The same calls give the same content: no clock is read. Thread safety: one thread per
/// instance. Do not use an instance across fork().
///
/// Every failure is an InputError of one line naming the file: also a full disk, a file kept locked
/// by another program for five seconds, and a write to a base opened read-only.
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

  /// Stores a new case together with its first observation. Returns its id, which no case had
  /// before. The case's own id is ignored.
  /// @throws InputError from validateCase.
  std::int64_t add(const Case& push_case);

  /// Adds one observed outcome by eq. 1, 2. Returns the updated case.
  /// @throws InputError if there is no such case or the pose is not finite; nothing is stored then.
  Case observe(std::int64_t id, const Pose2& start_T_object, const CovarianceFloor& floor);

  /// Adds one observed outcome by eq. 7-9 with the given weight of the past. The past never weighs
  /// more than the stored effective count, which may be newer than the one the caller knew.
  /// @throws InputError as observe, and if weight < 1.
  Case adapt(std::int64_t id, const Pose2& start_T_object, double weight,
             const CovarianceFloor& floor);

  /// Removes a case with its observations. @throws InputError if there is no such case.
  void remove(std::int64_t id);

  /// Every outcome ever observed for a case, oldest first.
  std::vector<Pose2> observations(std::int64_t id) const;

  /// The same with where they came from.
  std::vector<ObservedOutcome> history(std::int64_t id) const;

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
