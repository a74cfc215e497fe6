#include "coverage.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr double kTurnRad = 0.3;
// Shorter displacements have no meaningful direction.
constexpr double kDirectedM = 0.1;
// Bearing of the object off the robot's motion at which the robot has passed it.
constexpr double kPassedRad = 1.3;
// A step of the recorded motion that is more than localisation noise.
constexpr double kNoticeableM = 0.05;

}  // namespace

OutcomeSigma outcomeSigma(const PoseGaussian& outcome, double effective_count) {
  const double n = std::max(2.0, effective_count);
  const double unbiased = n / (n - 1.0);
  const Eigen::Matrix2d position = outcome.covariance.topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(position, Eigen::EigenvaluesOnly);
  return {std::sqrt(unbiased * std::max(0.0, solver.eigenvalues()(1))),
          std::sqrt(unbiased * std::max(0.0, outcome.covariance(2, 2)))};
}

double outcomeDistance(const Pose2& a, const Pose2& b, double gyration_radius_m) {
  return std::hypot(distance(a, b), gyration_radius_m * yawDifference(a, b));
}

Turn turnOf(const Pose2& start_T_object) {
  if (start_T_object.yaw() > kTurnRad) {
    return Turn::kLeft;
  }
  return start_T_object.yaw() < -kTurnRad ? Turn::kRight : Turn::kNone;
}

std::vector<DirectionGap> directionGaps(const std::vector<Pose2>& outcomes) {
  std::vector<double> directions;
  for (const Pose2& outcome : outcomes) {
    if (outcome.position().norm() > kDirectedM) {
      directions.push_back(std::atan2(outcome.y(), outcome.x()));
    }
  }
  if (directions.empty()) {
    return {{-M_PI, 2.0 * M_PI}};
  }
  std::sort(directions.begin(), directions.end());
  std::vector<DirectionGap> gaps;
  for (std::size_t i = 0; i + 1 < directions.size(); ++i) {
    gaps.push_back({directions[i], directions[i + 1] - directions[i]});
  }
  gaps.push_back({directions.back(), directions.front() + 2.0 * M_PI - directions.back()});
  std::stable_sort(gaps.begin(), gaps.end(), [](const DirectionGap& a, const DirectionGap& b) {
    return a.width_rad > b.width_rad;
  });
  return gaps;
}

bool hasLostContact(const Case& push_case) {
  const int last = push_case.push_steps - 1;
  const Pose2 end = push_case.steps[last].start_T_robot();
  for (int i = last; i >= 0; --i) {
    const Eigen::Vector2d motion = end.position() - push_case.steps[i].start_T_robot().position();
    if (motion.norm() > kNoticeableM) {
      const Eigen::Vector2d to_object =
          push_case.steps[last].start_T_object.position() - end.position();
      const double cosine = motion.dot(to_object) / (motion.norm() * to_object.norm());
      return cosine < std::cos(kPassedRad);
    }
  }
  return false;
}

}  // namespace casepush
