#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "casepush/model/case.h"

namespace casepush {

/// When a case is not worth keeping.
struct PruneOptions {
  /// Useless: the mean outcome moves the object less than this, in both.
  double least_motion_m = 0.03;
  double least_turn_rad = 0.05;
  /// Useless: the outcome scatters by more than this (largest standard deviation), once there are
  /// `least_observations`.
  double largest_sigma_m = 0.4;
  double largest_sigma_rad = 1.0;
  int least_observations = 5;
  /// Duplicates: outcomes and start poses of the robot closer than this, in position and in yaw.
  double outcome_distance_m = 0.03;
  double outcome_turn_rad = 0.06;
  double start_distance_m = 0.1;
  double start_turn_rad = 0.2;

  void validate() const;  ///< @throws InputError unless all are finite and not negative.
};

/// A case that is not worth keeping.
struct UselessCase {
  std::int64_t id = 0;
  std::string reason;  ///< One line for a person.
};

/// What PruneOptions call useless, and of duplicates (of the same object, robot and context) all
/// but the one with the most observations; of equals, the one that scatters least, then the oldest.
/// Ascending by id.
std::vector<UselessCase> uselessCases(const std::vector<Case>& cases, const PruneOptions& options);

/// How far apart two contexts are [kg]; another floor is farther than any load, and between them a
/// change that was noticed. An unknown load counts as none, an unknown floor as any.
double contextDistance(const PushContext& a, const PushContext& b);

/// For each case the id of the one that it is a copy of, at whatever remove; its own if it is none.
std::map<std::int64_t, std::int64_t> families(const std::vector<Case>& cases);

/// One case of each family of copies (see CaseBase::copy): the one whose context is nearest, of
/// equals the oldest. Ascending by id.
std::vector<Case> inContext(const std::vector<Case>& cases, const PushContext& context);

/// Those that were learnt in a context: what learning in it resumes from. Unlike inContext(), no
/// case of another load stands in for one that is missing.
std::vector<Case> learntIn(std::vector<Case> cases, const PushContext& context);

/// What CaseBase::merge did, in cases.
struct MergeResult {
  int added = 0;         ///< Known to the other base only.
  int extended = 0;      ///< Known to both, with new observations.
  int unchanged = 0;     ///< Known to both, with nothing new.
  int observations = 0;  ///< Added to the extended ones.
};

}  // namespace casepush
