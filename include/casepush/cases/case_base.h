#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/cases/case_upkeep.h"
#include "casepush/cases/observed_push.h"
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
const char* toString(OutcomeSource source);

/// One observation behind a case, and all it takes to add it again.
struct ObservedOutcome {
  Pose2 start_T_object;
  OutcomeSource source = OutcomeSource::kExplored;
  double past_weight = 0.0;       ///< Observations that the past counted when this one was added.
  CovarianceFloor noise;          ///< The floor of that update.
  std::optional<double> stamp_s;  ///< ROS time at rest, simulated in a simulation; if known.
  PushContext context;
  std::vector<Pose2> path;  ///< start_T_object over the push; empty if it was not recorded, and
                            ///< for the first trial, whose is Case::steps.
};

/// Cases in one SQLite file (WAL, foreign keys, schema version; docs/cases.md describes it). Each
/// call is one transaction that has reached the disk when the call returns: a finished push is
/// never lost and the file is never corrupt, whenever the program dies or the power fails.
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

  /// A file of an older version is brought up to date, or, read-only, a copy in memory, which does
  /// not see later changes.
  /// @throws InputError if the file is missing, is no case base, is newer than this program, or is
  ///   corrupt. The file is left as it was.
  CaseBase(const std::filesystem::path& file, Access access);
  /// A base that lives in memory only: these cases under their own ids.
  /// @param floor  That their statistics were made with.
  /// @throws InputError from validateCase; two of them have the same id.
  CaseBase(const std::vector<Case>& cases, const CovarianceFloor& floor);
  ~CaseBase();
  CaseBase(CaseBase&&) noexcept;
  CaseBase& operator=(CaseBase&&) noexcept;

  /// All cases of an object in ascending id; of all objects if `object` is empty.
  std::vector<Case> cases(const std::string& object = "") const;

  /// Number of cases, without reading them.
  int count() const;

  /// @throws InputError if there is no such case.
  Case get(std::int64_t id) const;

  /// Stores a new case together with its first observation. Returns its id, which no case had
  /// before. The case's own id is ignored; a missing tube is derived.
  /// @param stamp_s  When the object had come to rest, see ObservedPush.
  /// @param floor    That its statistics were made with.
  /// @throws InputError from validateCase.
  std::int64_t add(const Case& push_case, const std::optional<double>& stamp_s = std::nullopt,
                   const CovarianceFloor& floor = {});

  /// Adds one push by eq. 1, 2. Returns the updated case.
  /// @throws InputError if there is no such case or a pose is not finite; nothing is stored then.
  Case observe(std::int64_t id, const ObservedPush& push, const CovarianceFloor& floor);

  /// Adds one push by eq. 7-9, weighed by what is stored now, which may be newer than what the
  /// caller knew.
  /// @param p_value  Of the prediction test that was made before, in [0, 1].
  /// @throws InputError as observe, and if p_value is out of range.
  Case adapt(std::int64_t id, const ObservedPush& push, double p_value,
             const AdaptationOptions& options, const CovarianceFloor& floor);

  /// Takes the last observation of a case back, as if it had not been made. May be called again,
  /// until the first observation, or the state in which the case came from elsewhere.
  /// @throws InputError if there is no such case or nothing can be taken back.
  Case undo(std::int64_t id);

  /// Copies a case with all its observations for another context: adapt the copy and keep the
  /// original. Returns the copy's id. @throws InputError if there is no such case.
  std::int64_t copy(std::int64_t id, const PushContext& context);

  /// Removes a case with its observations. @throws InputError if there is no such case.
  void remove(std::int64_t id);

  /// Removes what uselessCases names, all or nothing.
  /// @param object  Only cases of this object; all if empty.
  std::vector<UselessCase> prune(const std::string& object, const PruneOptions& options);

  /// Takes over the cases of another base under new ids. A case that both have (same object, robot,
  /// context and recorded steps) gets the observations that only the other one holds.
  MergeResult merge(const CaseBase& other);

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
