#include "case_chains.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr double kBucket_m = 0.2;
constexpr int kTurns = 18;
constexpr int kMostSide = 64;  // Of the square of buckets; the outer ones hold the rest.

}  // namespace

CaseChains::CaseChains(const std::vector<PreparedCase>& cases, const PushTime& time) {
  const auto count = static_cast<std::int32_t>(cases.size());
  for (std::int32_t push = 0; push < count; ++push) {
    chains_.push_back({{push, -1, -1}, 1, cases[push].start_outcome.mean, 0.0});
  }
  std::size_t begin = 0;
  for (int length = 2; length <= CaseChain::kMost; ++length) {
    const std::size_t end = chains_.size();
    if (end + (end - begin) * cases.size() > kMostChains) break;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::int32_t push = 0; push < count; ++push) {
        CaseChain chain = chains_[i];
        chain.later_s += time.after(chain.pushes[length - 2], push);
        chain.pushes[length - 1] = push;
        chain.count = length;
        chain.start_T_end = chain.start_T_end * cases[push].start_outcome.mean;
        chains_.push_back(chain);
      }
    }
    begin = end;
  }
  for (const CaseChain& chain : chains_) {
    reach_m_ = std::max(reach_m_, chain.start_T_end.position().norm());
  }
  side_ = std::clamp(2 * static_cast<int>(std::ceil(reach_m_ / kBucket_m)), 2, kMostSide);
  // Counting sort into the buckets.
  first_.assign(static_cast<std::size_t>(side_) * side_ * kTurns + 1, 0);
  for (const CaseChain& chain : chains_) ++first_[bucket(chain.start_T_end) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  std::vector<CaseChain> sorted(chains_.size());
  for (const CaseChain& chain : chains_) sorted[next[bucket(chain.start_T_end)]++] = chain;
  chains_ = std::move(sorted);
}

int CaseChains::column(double metres) const {
  return static_cast<int>(std::clamp(std::floor(metres / kBucket_m) + side_ / 2, 0.0, side_ - 1.0));
}

int CaseChains::turn(double yaw_rad) const {
  return std::clamp(static_cast<int>((yaw_rad + M_PI) / (2.0 * M_PI) * kTurns), 0, kTurns - 1);
}

std::size_t CaseChains::bucket(const Pose2& pose) const {
  return (static_cast<std::size_t>(column(pose.y())) * side_ + column(pose.x())) * kTurns +
         turn(pose.yaw());
}

void CaseChains::into(const Pose2& start_T_goal, const GoalTolerance& tolerance,
                      std::vector<const CaseChain*>* found) const {
  const double range_m = tolerance.position_m;
  const int turns =
      std::min(kTurns, 2 + static_cast<int>(2.0 * tolerance.yaw_rad / (2.0 * M_PI) * kTurns));
  const int first_turn = turn(wrapAngle(start_T_goal.yaw() - tolerance.yaw_rad));
  for (int y = column(start_T_goal.y() - range_m); y <= column(start_T_goal.y() + range_m); ++y) {
    for (int x = column(start_T_goal.x() - range_m); x <= column(start_T_goal.x() + range_m); ++x) {
      for (int t = 0; t < turns; ++t) {
        const std::size_t at =
            (static_cast<std::size_t>(y) * side_ + x) * kTurns + (first_turn + t) % kTurns;
        for (std::int32_t i = first_[at]; i < first_[at + 1]; ++i) {
          if (tolerance.isMet(start_T_goal, chains_[i].start_T_end)) found->push_back(&chains_[i]);
        }
      }
    }
  }
}

}  // namespace casepush
