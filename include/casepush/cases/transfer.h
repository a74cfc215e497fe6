#pragma once

#include <string>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/object_model.h"

namespace casepush {

/// What a known object's cases are worth for a new one (the paper's fourth future-work item).
struct TransferOptions {
  /// No cases are proposed for objects farther apart, see objectDissimilarity.
  double largest_dissimilarity = 1.5;
  /// Standard deviation of how far the new object's mean outcome is from the known one's:
  /// base + share * (1 + 2 dissimilarity) * displacement.
  double base_m = 0.03;
  double base_rad = 0.1;
  double share = 0.1;
  /// Standard deviation of how much more than the known one the new object's outcomes may scatter.
  double extra_scatter_m = 0.02;
  double extra_scatter_rad = 0.05;

  void validate() const;  ///< @throws InputError naming what is out of bounds.
};

/// How different two objects are: |log of the mass ratio| + |log of the size ratio| (circumscribed
/// radii), and 0.5 if they are of different classes. 0 for equals; 1.5 is a factor of 2 in mass and
/// of 1.5 in size between different classes.
double objectDissimilarity(const ObjectModel& a, const ObjectModel& b);

/// Proposes the cases of a known object for a new one, or none if the objects are too different.
///
/// The robot starts as far behind the new object as it did behind the known one, seen along the
/// push, and as far beside its middle in proportion to the sizes. The mean outcome is that of the
/// known object. Its covariance is S / n, where S is how pushes scatter and n < 1 the effective
/// count, such that S / n covers S + D in every direction; D is how far the mean may be off. With
/// that, eq. 1, 2 do what Bayes' rule would: the first practice brings the mean to what was
/// observed and the covariance back to about S, and from there on the case is as good as one learnt
/// from scratch whose scatter was known.
///
/// @return Cases with origin `kTransferred`, `source_id` that of the known case, no observations
/// and
///   the context of the known case. Transferred cases that were never practised are not passed on.
std::vector<Case> proposeCases(const std::vector<Case>& known, const ObjectModel& known_object,
                               const ObjectModel& new_object, const TransferOptions& options);

}  // namespace casepush
