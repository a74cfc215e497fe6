#include "casepush/cases/outcome_statistics.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/common/paper_similarity.h"

namespace casepush {
namespace {

void requirePositive(const char* where, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    throw InputError(where, "is " + std::to_string(value) + "; must be finite and > 0");
  }
}

// Eq. 1 and 2 with the past counting `weight` observations (eq. 8, 9); t = weight + 1.
OutcomeStatistics blend(const OutcomeStatistics& past, const Pose2& start_T_object, double weight,
                        const CovarianceFloor& floor) {
  if (!start_T_object.isFinite()) {
    throw InputError("observed outcome", "is not finite");
  }
  floor.validate();
  const double t = weight + 1.0;
  const Pose2& old_mean = past.start_outcome.mean;
  const Eigen::Vector3d e = logSe2(old_mean.inverse() * start_T_object);
  // e' = log(mean_t^-1 x) lies on the same geodesic as e, so e' = (1 - 1/t) e exactly, and eq. 2's
  // product is positive semi-definite whatever the rounding.
  const Eigen::Matrix3d scatter = (weight / t) * (e * e.transpose());
  const Eigen::Matrix3d covariance = (weight * past.start_outcome.covariance + scatter) / t;
  const Pose2 mean = weight > 0.0 ? old_mean * expSe2(e / t) : start_T_object;
  return {{mean, raiseToFloor(0.5 * (covariance + covariance.transpose()), floor)}, t};
}

}  // namespace

void CovarianceFloor::validate() const {
  requirePositive("covariance floor: position_m", position_m);
  requirePositive("covariance floor: yaw_rad", yaw_rad);
}

Eigen::Matrix3d raiseToFloor(const Eigen::Matrix3d& covariance, const CovarianceFloor& floor) {
  const Eigen::Vector3d scale(floor.position_m, floor.position_m, floor.yaw_rad);
  const Eigen::Matrix3d scaled =
      scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
  const Eigen::Matrix3d excess = scaled - Eigen::Matrix3d::Identity();
  if (excess.llt().info() == Eigen::Success) {
    return covariance;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled);
  const Eigen::Matrix3d root = scale.asDiagonal() * solver.eigenvectors();
  const Eigen::Matrix3d raised =
      root * solver.eigenvalues().cwiseMax(1.0).asDiagonal() * root.transpose();
  return 0.5 * (raised + raised.transpose());
}

OutcomeStatistics addObservation(const OutcomeStatistics& past, const Pose2& start_T_object,
                                 const CovarianceFloor& floor) {
  CASEPUSH_CHECK(past.effective_count >= 0.0, "count = " << past.effective_count);
  return blend(past, start_T_object, past.effective_count, floor);
}

OutcomeStatistics adapt(const OutcomeStatistics& past, const Pose2& start_T_object, double weight,
                        const CovarianceFloor& floor) {
  CASEPUSH_CHECK(std::isfinite(weight) && weight >= 0.0, "weight = " << weight);
  return blend(past, start_T_object, weight, floor);
}

const char* toString(PastWeight weight) {
  return weight == PastWeight::kBounded ? "bounded" : "paper";
}

PastWeight pastWeightFromString(const std::string& text, const std::string& where) {
  for (const PastWeight weight : {PastWeight::kBounded, PastWeight::kPaper}) {
    if (text == toString(weight)) {
      return weight;
    }
  }
  throw InputError(where, "is '" + text + "'; must be bounded or paper");
}

void AdaptationOptions::validate() const {
  requirePositive("adaptation: scale_k", scale_k);
  requirePositive("adaptation: largest_distance_m", largest_distance_m);
}

double adaptationWeight(const OutcomeStatistics& past, const Pose2& start_T_object, double p_value,
                        const AdaptationOptions& options) {
  CASEPUSH_CHECK(p_value >= 0.0 && p_value <= 1.0, "p = " << p_value);
  options.validate();
  if (options.weight == PastWeight::kPaper) {
    return options.scale_k *
           paperSimilarity(past.start_outcome.mean, start_T_object, options.largest_distance_m);
  }
  return std::min(past.effective_count, std::max(1.0, p_value * options.scale_k));
}

}  // namespace casepush
