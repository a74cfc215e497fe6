#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "casepush/model/push_plan.h"
#include "casepush/planning/push_checker.h"
#include "casepush/planning/risk_options.h"

namespace casepush {

/// Estimates how likely a push collides or misses the goal, if both where it starts and what it
/// does scatter.
///
/// Directional simulation (Ditlevsen et al. 1990) over a fixed set of directions: along each, the
/// smallest standardised radius at which something collides is bracketed, and the probability
/// beyond it counted; whatever lies behind an obstacle counts as blocked. So a probability of a
/// thousandth shows with few tests, and the same push always has the same risk.
/// At each radius start and outcome deviate by that many standard deviations in the same direction.
/// Thus start, way and outcome each have their own distribution exactly; how they go together is
/// assumed. Not thread-safe: the checker is shared.
class PushRisk {
 public:
  /// @param cases, prepared  The same cases; prepared for the mean alone (zeta 0). They and the
  ///   checker must outlive this.
  PushRisk(std::vector<const Case*> cases, const std::vector<PreparedCase>& prepared,
           PushChecker* checker, const RiskOptions& options);

  /// Where a push may start if the ones before it scattered: covariance in the frame of the mean.
  /// @param pushes  Indices of the pushes so far, the last one first; those beyond the horizon do
  ///   not count.
  Eigen::Matrix3d startCovariance(const std::vector<int>& pushes) const;

  /// Where the object is compared with the plan. Pushes go on from wherever it came to rest, so
  /// that its deviations add up until the plan is changed, after kUncorrected pushes or so.
  /// @param pushes  As above.
  Eigen::Matrix3d driftedCovariance(const std::vector<int>& pushes) const;

  /// Probability that object or robot collides; 1 if the mean motion does. Not followed up beyond
  /// `limit`.
  double collisionProbability(int push, const Pose2& map_T_start,
                              const Eigen::Matrix3d& start_covariance, double limit = 1.0) const;

  /// Probability, roughly and rather too large, that the push cannot be made: its mean motion,
  /// begun where the object is then, collides. @pre From `map_T_start` it does not.
  double obstructionProbability(int push, const Pose2& map_T_start,
                                const Eigen::Matrix3d& start_covariance) const;

  /// Probability that the push does not end in the goal region.
  double missProbability(int push, const Pose2& map_T_start,
                         const Eigen::Matrix3d& start_covariance, const Pose2& map_T_goal,
                         const GoalTolerance& tolerance) const;

  /// How much nearer the push's own scatter brings the moment when the rest of a plan misses its
  /// goal: deviations add up as in a random walk, which leaves a disc of radius r after r^2 /
  /// (variance of a step) steps on average, and likewise for the heading.
  double expectedReplans(int push, const GoalTolerance& tolerance) const;

  const RiskOptions& options() const { return options_; }
  /// Pushes before one that anything above looks at.
  int pushesThatCount() const { return std::max(options_.horizon - 1, kUncorrected); }
  int caseCount() const { return static_cast<int>(cases_.size()); }

  static constexpr int kDirections = 32;
  static constexpr int kCoarseDirections = 16;  ///< Where a share of a tenth is near enough.
  static constexpr int kUncorrected = 8;        ///< Pushes until a plan is changed.

 private:
  /// The object somewhere along a push, in the start frame.
  struct Stop {
    Pose2 start_T_object;
    Eigen::Matrix3d carry;  ///< Takes a deviation of the start to one of the stop.
    Eigen::Matrix3d covariance;
  };
  /// A point that others of a trajectory are near, in the start frame.
  struct Guard {
    Eigen::Vector2d start_point_m;
    double range_m;
  };
  struct Guards {
    std::vector<Guard> object;
    std::vector<Guard> robot;
  };
  struct Motion {
    std::vector<Stop> stops;  ///< The outcome last.
    Guards guards;
  };
  struct Deviations;

  const Motion& motion(int push) const;
  Eigen::Matrix3d compounded(const std::vector<int>& pushes, int count) const;
  static std::vector<Stop> stopsOf(const Case& push_case);
  static Guards guardsOf(const Case& push_case);
  bool isMotionFarFromAll(int push, const Pose2& map_T_start,
                          const Eigen::Matrix3d& start_covariance) const;
  Deviations deviationsOf(int push, const Pose2& map_T_start,
                          const Eigen::Matrix3d& start_covariance) const;
  bool collidesAt(int push, const Pose2& map_T_start, const Deviations& deviations,
                  const Eigen::Vector3d& offset) const;

  const std::vector<PreparedCase>& prepared_;
  PushChecker& checker_;
  RiskOptions options_;
  std::vector<const Case*> cases_;
  /// Of each case, worked out when it is first asked for: there may be thousands.
  mutable std::vector<std::optional<Motion>> motions_;
  std::vector<Eigen::Vector3d> directions_;  ///< Unit vectors.
};

/// What a plan is made safe for: the sigma points of `zeta`, and with chance constraints a bound
/// for the whole plan besides.
struct SafetyLevel {
  double zeta = 0.0;
  std::optional<double> max_collision_probability;
  double deadline_share = 1.0;      ///< Of the time until the deadline, when to try the next level.
  bool first_plan_will_do = false;  ///< It need not be improved, nor be safe from dead ends.
};

/// Sets the collision probability of each push and of the plan.
/// @param pushes  Indices of the plan's cases.
void assessPlan(const PushRisk& risk, const std::vector<int>& pushes, PushPlan* plan);

/// The wanted level first, then less and less.
std::vector<SafetyLevel> safetyLevels(const RiskOptions& options, double zeta);

/// What prepareCases needs besides cases.
struct PreparationSizes {
  double step_m;
  double object_radius_m;
  double robot_radius_m;
};

/// The same for a plan of which the cases' ids are known.
/// @pre All cases of the plan are among `cases`.
void assessPlan(const std::vector<Case>& cases, const PreparationSizes& sizes,
                const RiskOptions& options, PushChecker* checker, PushPlan* plan);

/// How many pushes of a plan that was begun, from the first one on, may be made before their risk
/// is more than twice what a new plan may have.
/// @pre It was assessed from where the object now is.
int bearablePushes(const PushPlan& rest);

/// Why not all of them, or nothing.
std::string riskExplanation(const PushPlan& rest);

/// -log(1 - p): adds up along a plan, where the probabilities do not.
double riskOf(double probability);
/// The other way round.
double probabilityOf(double risk);

}  // namespace casepush
