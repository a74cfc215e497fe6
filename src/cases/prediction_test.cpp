#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "casepush/cases/outcome_statistics.h"
#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "predictive.h"

namespace casepush {
namespace {

constexpr double kDimension = 3.0;

// Scatter of pushes before anything is known. Casters at unknown angles alone put an object up to
// about 0.24 m off (90th percentile), that is 0.15 m for each axis.
constexpr CovarianceFloor kPrior{0.15, 0.3};

// No distribution is trusted to be sharper; keeps a singular covariance from dividing by zero.
constexpr CovarianceFloor kSharpest{1e-4, 1e-4};

// Between one day and another, however sharp a case.
constexpr CovarianceFloor kUnexplained{0.015, 0.05};

Eigen::Matrix3d diagonal(const CovarianceFloor& deviation) {
  return Eigen::Vector3d(deviation.position_m, deviation.position_m, deviation.yaw_rad)
      .cwiseAbs2()
      .asDiagonal();
}

double squaredMahalanobis(const Eigen::Vector3d& e, const Eigen::Matrix3d& covariance) {
  return e.dot(raiseToFloor(covariance, kSharpest).ldlt().solve(e));
}

double chiSquareTail(double squared) {
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared_distribution<double>(kDimension), squared));
}

double hotellingTail(double t_squared, double n) {
  const boost::math::fisher_f_distribution<double> f(kDimension, n - kDimension);
  const double ratio = t_squared * (n - kDimension) / (kDimension * (n - 1.0));
  return boost::math::cdf(boost::math::complement(f, ratio));
}

// In the frame of the mean.
Eigen::Vector3d meanDeviation(const OutcomeStatistics& past, const Pose2& start_T_object) {
  return logSe2(past.start_outcome.mean.inverse() * start_T_object);
}

// Deviation of an observation from the mean.
Eigen::Vector3d deviation(const OutcomeStatistics& past, const Pose2& start_T_object,
                          double alpha) {
  CASEPUSH_CHECK(alpha > 0.0 && alpha < 1.0, "alpha = " << alpha);
  if (!start_T_object.isFinite()) {
    throw InputError("observed outcome", "is not finite");
  }
  return meanDeviation(past, start_T_object);
}

Eigen::Matrix3d predictiveCovariance(const OutcomeStatistics& past) {
  CASEPUSH_CHECK(past.effective_count > 0.0, "count = " << past.effective_count);
  const double n = past.effective_count;
  const double spread = n < 1.0 ? 1.0 : 1.0 + 1.0 / n;
  return spread * past.start_outcome.covariance + diagonal(kUnexplained);
}

PredictionTest verdict(double t_squared, double p_value, double alpha) {
  return {t_squared, p_value, p_value < alpha};
}

}  // namespace

PredictionTest testPrediction(const OutcomeStatistics& past, const Pose2& start_T_object,
                              double alpha) {
  const Eigen::Vector3d e = deviation(past, start_T_object, alpha);
  const double n = past.effective_count;
  if (n <= 0.0) {
    return {};
  }
  const Eigen::Matrix3d& covariance = past.start_outcome.covariance;
  if (n <= kDimension + 1.0) {
    // A count below 1 belongs to a covariance that holds the uncertainty of the mean already.
    const double spread = n < 1.0 ? 1.0 : 1.0 + 1.0 / n;
    const double t_squared = squaredMahalanobis(e, spread * (covariance + diagonal(kPrior)));
    return verdict(t_squared, chiSquareTail(t_squared), alpha);
  }
  const double t_squared = n / (n + 1.0) * squaredMahalanobis(e, n / (n - 1.0) * covariance);
  return verdict(t_squared, hotellingTail(t_squared, n), alpha);
}

double logPredictive(const OutcomeStatistics& past, const Pose2& start_T_object) {
  const Eigen::Matrix3d covariance = predictiveCovariance(past);
  return -0.5 * (squaredMahalanobis(meanDeviation(past, start_T_object), covariance) +
                 std::log(covariance.determinant()));
}

bool isSurprising(const OutcomeStatistics& past, const Pose2& start_T_object) {
  constexpr double kChiSquare90 = 6.251;  // 3 degrees of freedom.
  return squaredMahalanobis(meanDeviation(past, start_T_object), predictiveCovariance(past)) >
         kChiSquare90;
}

PredictionTest testPlugIn(const OutcomeStatistics& past, const Pose2& start_T_object,
                          double alpha) {
  const Eigen::Vector3d e = deviation(past, start_T_object, alpha);
  if (past.effective_count <= 0.0) {
    return {};
  }
  const double squared = squaredMahalanobis(e, past.start_outcome.covariance);
  return verdict(squared, chiSquareTail(squared), alpha);
}

}  // namespace casepush
