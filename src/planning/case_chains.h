#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "casepush/model/push_plan.h"
#include "casepush/planning/prepared_cases.h"
#include "casepush/planning/push_time.h"

namespace casepush {

/// Up to three cases one after the other.
struct CaseChain {
  static constexpr int kMost = 3;

  std::array<std::int32_t, kMost> pushes;
  int count;
  Pose2 start_T_end;  ///< Where the object comes to rest.
  double later_s;     ///< Expected time of all pushes but the first.
};

/// All short chains of cases, ordered by where they lead, so that those which end in a goal region
/// are found without trying. Made once for a set of cases.
class CaseChains {
 public:
  /// As long chains as make no more than kMostChains; single cases in any number.
  CaseChains(const std::vector<PreparedCase>& cases, const PushTime& time);

  static constexpr std::size_t kMostChains = 12000;

  /// Appends the chains from `start` that end in the region around `goal`.
  void into(const Pose2& start_T_goal, const GoalTolerance& tolerance,
            std::vector<const CaseChain*>* found) const;

  /// No chain leads farther than this [m].
  double reach() const { return reach_m_; }
  std::size_t size() const { return chains_.size(); }

 private:
  int column(double metres) const;
  int turn(double yaw_rad) const;
  std::size_t bucket(const Pose2& pose) const;

  double reach_m_ = 0.0;
  int side_ = 1;                     // buckets along x and along y
  std::vector<CaseChain> chains_;    // those of a bucket side by side
  std::vector<std::int32_t> first_;  // of each bucket in chains_, and the end
};

}  // namespace casepush
