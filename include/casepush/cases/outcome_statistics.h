#pragma once

#include <string>

#include "casepush/common/pose_gaussian.h"
#include "casepush/model/push_report.h"

namespace casepush {

/// Where an object comes to rest after a push, learnt from observations.
///
/// The covariance belongs to the frame of the mean (see PoseGaussian). When an update moves the
/// mean by d, the past covariance is *not* turned into the new frame: that is eq. 2 as it stands.
/// It neglects a relative change of about half of d's yaw, in all 2 % for a scatter of 0.1 m and
/// 0.2 rad; the estimate itself scatters by 30 % at n = 20.
struct OutcomeStatistics {
  PoseGaussian start_outcome;    ///< Population covariance (divides by the count), floored.
  double effective_count = 0.0;  ///< Observations that the distribution is worth.
};

/// Measurement noise that keeps covariances positive definite.
struct CovarianceFloor {
  double position_m = 0.005;
  double yaw_rad = 0.01;

  void validate() const;  ///< @throws InputError unless both are finite and positive.
};

/// Raises a covariance to the floor: in coordinates scaled by the floor every eigenvalue below 1
/// becomes 1, the others and all directions stay.
///
/// Raising twice is raising once, so that the floor does not pile up over updates. An update starts
/// from the raised covariance: what that leaves too much in a direction that has risen above the
/// floor since fades with 1/n, and makes the prediction test more cautious, never less.
/// @pre covariance is symmetric positive semi-definite.
Eigen::Matrix3d raiseToFloor(const Eigen::Matrix3d& covariance, const CovarianceFloor& floor);

/// Adds one observation: the running mean and covariance of paper eq. 1 and 2 on SE(2).
/// @return Updated statistics whose covariance is positive definite.
/// @throws InputError if the pose is not finite or the floor not positive.
OutcomeStatistics addObservation(const OutcomeStatistics& past, const Pose2& start_T_object,
                                 const CovarianceFloor& floor);

/// Adds one observation with the past counting `weight` observations: paper eq. 7-9. With
/// `weight == past.effective_count` it is addObservation.
/// @return Updated statistics, worth `weight + 1` observations.
/// @pre weight is finite and >= 0.
/// @throws InputError as addObservation.
OutcomeStatistics adapt(const OutcomeStatistics& past, const Pose2& start_T_object, double weight,
                        const CovarianceFloor& floor);

/// How many observations the past counts when a case is adapted: W of paper eq. 7.
enum class PastWeight {
  /// W = s K with s the p-value of the prediction test, and 1 <= W <= effective count (but never
  /// more than the effective count): the past gives way to what it cannot explain.
  kBounded,
  /// W = sim K as printed, with sim of eq. 3 (paperSimilarity): hundreds for any deviation below a
  /// metre, so that the past hardly ever gives way. For comparison.
  kPaper,
};
const char* toString(PastWeight weight);
/// @throws InputError unless `text` is "bounded" or "paper".
PastWeight pastWeightFromString(const std::string& text, const std::string& where);

struct AdaptationOptions {
  PastWeight weight = PastWeight::kBounded;
  double scale_k = 20.0;             ///< K; paper: the number of initial practices.
  double largest_distance_m = 21.2;  ///< d_max of eq. 3, the diagonal of the environment.

  void validate() const;  ///< @throws InputError unless both are finite and positive.
};

/// W of eq. 7 for a case about to be adapted by `start_T_object`.
/// @param p_value  Of the prediction test that was made before, in [0, 1].
double adaptationWeight(const OutcomeStatistics& past, const Pose2& start_T_object, double p_value,
                        const AdaptationOptions& options);

/// Hotelling's prediction region for a new observation, n = effective_count, p = 3:
/// T^2 = n/(n+1) e' S^-1 e with the unbiased S; T^2 (n-p) / (p (n-1)) ~ F(p, n-p).
///
/// For n <= p + 1 the F distribution does not exist or says nothing. Then T^2 = e' S^-1 e with
/// S = (1 + 1/n) (covariance + prior) is tested against chi-square with 3 degrees of freedom; the
/// prior is the scatter of a push nobody knows anything about, (0.15 m)^2 and (0.3 rad)^2. Raises
/// at most alpha false alarms as long as pushes scatter less than that. With n < 1 the covariance
/// is a guess that already holds the uncertainty of the mean (see transfer.h), and S = covariance +
/// prior.
/// @return {0, 1, false} if nothing has been observed yet.
/// @pre 0 < alpha < 1.
/// @throws InputError if the pose is not finite.
PredictionTest testPrediction(const OutcomeStatistics& past, const Pose2& start_T_object,
                              double alpha);

/// Log density of the predictive distribution at an observation [nat, up to a constant]: Gaussian,
/// with the uncertainty of the mean and a floor of what no case is sharper than,
/// (0.015 m)^2 and (0.05 rad)^2. For comparing what two cases say about the same push.
/// @pre past.effective_count > 0
double logPredictive(const OutcomeStatistics& past, const Pose2& start_T_object);

/// The plug-in test: squared Mahalanobis distance against chi-square with 3 degrees of freedom, as
/// if the estimated covariance were the true one. For comparison: it raises too many false alarms.
/// @see testPrediction for result, precondition and errors.
PredictionTest testPlugIn(const OutcomeStatistics& past, const Pose2& start_T_object, double alpha);

}  // namespace casepush
