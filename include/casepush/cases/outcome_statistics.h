#pragma once

#include "casepush/common/pose_gaussian.h"
#include "casepush/model/push_report.h"

namespace casepush {

/// Where an object comes to rest after a push, learnt from observations.
struct OutcomeStatistics {
  PoseGaussian start_outcome;    ///< Population covariance (divides by the count).
  double effective_count = 0.0;  ///< Observations that the distribution is worth.
};

/// Measurement noise that keeps covariances positive definite.
struct CovarianceFloor {
  double position_m = 0.005;
  double yaw_rad = 0.01;
};

/// Adds one observation: the running mean and covariance of paper eq. 1 and 2 on SE(2).
OutcomeStatistics addObservation(const OutcomeStatistics& past, const Pose2& start_T_object,
                                 const CovarianceFloor& floor);

/// Adds one observation with the past counting `weight` observations: paper eq. 7-9.
/// @pre 1 <= weight <= past.effective_count.
OutcomeStatistics adapt(const OutcomeStatistics& past, const Pose2& start_T_object, double weight,
                        const CovarianceFloor& floor);

/// W = s K of method.md: the p-value of the prediction test, bounded to [1, effective_count].
double adaptationWeight(double p_value, double scale_k, double effective_count);

/// Hotelling's prediction region for a new observation: T^2 (n-p) / (p (n-1)) ~ F(p, n-p).
/// For n <= p + 1 a chi-square test on an inflated covariance.
PredictionTest testPrediction(const OutcomeStatistics& past, const Pose2& start_T_object,
                              double alpha);

/// The plug-in test: squared Mahalanobis distance against chi-square with 3 degrees of freedom.
PredictionTest testPlugIn(const OutcomeStatistics& past, const Pose2& start_T_object, double alpha);

}  // namespace casepush
