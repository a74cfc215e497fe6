#include "casepush/cases/transfer.h"

#include <algorithm>
#include <cmath>

#include "casepush/cases/case_tube.h"
#include "casepush/common/input_error.h"
#include "guess.h"

namespace casepush {
namespace {

constexpr double kOtherClass = 0.5;

double extent(const Box& box, const Eigen::Vector3d& shape_direction) {
  return 0.5 * box.size_m.dot(shape_direction.cwiseAbs());
}

double extent(const Cylinder& cylinder, const Eigen::Vector3d& shape_direction) {
  return 0.5 * cylinder.length_m * std::abs(shape_direction.z()) +
         cylinder.radius_m * shape_direction.head<2>().norm();
}

double extent(const Sphere& sphere, const Eigen::Vector3d& /*shape_direction*/) {
  return sphere.radius_m;
}

// How far a solid reaches from its origin in a horizontal direction [m].
double reach(const Solid& solid, const Eigen::Vector2d& direction) {
  const Eigen::Vector3d d(direction.x(), direction.y(), 0.0);
  double farthest = 0.0;
  for (const PlacedShape& shape : solid) {
    const Eigen::Vector3d shape_d = shape.frame_T_shape.linear().transpose() * d;
    const double half = std::visit([&](const auto& s) { return extent(s, shape_d); }, shape.shape);
    farthest = std::max(farthest, shape.frame_T_shape.translation().dot(d) + half);
  }
  return farthest;
}

struct Fit {
  const ObjectModel& from;
  const ObjectModel& to;
  double dissimilarity;
};

// Moves the robot's trajectory, seen from the object, from one outline to the other.
void fitToOutline(Case& push_case, const Fit& fit) {
  const double direction_rad = pushDirection(push_case);
  const Eigen::Vector2d behind(-std::cos(direction_rad), -std::sin(direction_rad));
  const Eigen::Vector2d beside(-behind.y(), behind.x());
  const double farther_m = reach(fit.to.solid, behind) - reach(fit.from.solid, behind);
  const double scale = fit.to.radius_m / fit.from.radius_m;
  for (CaseStep& step : push_case.steps) {
    const Eigen::Vector2d p = step.object_T_robot.position();
    const Eigen::Vector2d moved =
        (p.dot(behind) + farther_m) * behind + scale * p.dot(beside) * beside;
    step.object_T_robot = Pose2(moved.x(), moved.y(), step.object_T_robot.yaw());
  }
}

Eigen::Matrix3d diagonal(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2().asDiagonal();
}

// Covariance S / n and effective count n of proposeCases.
void loosen(Case& push_case, const Fit& fit, const TransferOptions& options) {
  const Pose2& mean = push_case.start_outcome.mean;
  const double share = options.share * (1.0 + 2.0 * fit.dissimilarity);
  const Eigen::Matrix3d mean_uncertainty =
      diagonal(options.base_m + share * mean.position().norm(),
               options.base_rad + share * std::abs(mean.yaw()));
  const Eigen::Matrix3d scatter = push_case.start_outcome.covariance +
                                  diagonal(options.extra_scatter_m, options.extra_scatter_rad);
  makeGuess(&push_case, scatter, mean_uncertainty);
}

}  // namespace

void TransferOptions::validate() const {
  const auto require = [](bool holds, const char* key, double value, const char* bound) {
    if (!holds || !std::isfinite(value)) {
      throw InputError(std::string("transfer: ") + key,
                       "is " + std::to_string(value) + "; must be " + bound);
    }
  };
  require(largest_dissimilarity >= 0.0, "largest_dissimilarity", largest_dissimilarity, ">= 0");
  require(base_m > 0.0, "base_m", base_m, "> 0");
  require(base_rad > 0.0, "base_rad", base_rad, "> 0");
  require(share >= 0.0, "share", share, ">= 0");
  require(extra_scatter_m > 0.0, "extra_scatter_m", extra_scatter_m, "> 0");
  require(extra_scatter_rad > 0.0, "extra_scatter_rad", extra_scatter_rad, "> 0");
}

double objectDissimilarity(const ObjectModel& a, const ObjectModel& b) {
  return std::abs(std::log(a.mechanism.massKg() / b.mechanism.massKg())) +
         std::abs(std::log(a.radius_m / b.radius_m)) +
         (a.class_name == b.class_name ? 0.0 : kOtherClass);
}

std::vector<Case> proposeCases(const std::vector<Case>& known, const ObjectModel& known_object,
                               const ObjectModel& new_object, const TransferOptions& options) {
  options.validate();
  const Fit fit{known_object, new_object, objectDissimilarity(known_object, new_object)};
  std::vector<Case> proposed;
  if (fit.dissimilarity > options.largest_dissimilarity) {
    return proposed;
  }
  for (const Case& known_case : known) {
    const bool is_guess =
        known_case.origin == CaseOrigin::kTransferred && known_case.observation_count == 0;
    if (known_case.object != known_object.name || is_guess) {
      continue;
    }
    Case push_case = known_case;
    push_case.id = 0;
    push_case.object = new_object.name;
    push_case.origin = CaseOrigin::kTransferred;
    push_case.source_id = known_case.id;
    push_case.observation_count = 0;
    fitToOutline(push_case, fit);
    loosen(push_case, fit, options);
    push_case.tube = tubeFromOutcome(push_case.steps, push_case.start_outcome, {});
    proposed.push_back(std::move(push_case));
  }
  return proposed;
}

}  // namespace casepush
