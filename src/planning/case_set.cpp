#include "case_set.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace casepush {
namespace {

bool same(const Pose2& a, const Pose2& b) {
  return a.x() == b.x() && a.y() == b.y() && a.yaw() == b.yaw();
}

bool same(const PoseGaussian& a, const PoseGaussian& b) {
  return same(a.mean, b.mean) && a.covariance == b.covariance;
}

// Bit by bit: a plan takes little longer than to compare number by number.
template <typename T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  constexpr std::size_t kNumbers = std::is_same_v<T, CaseStep> ? 9 : 12;
  static_assert(sizeof(T) == kNumbers * sizeof(double), "nothing but numbers");
  return a.size() == b.size() &&
         std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                     a.size() * sizeof(T)) == 0;
}

// In all that matters for planning.
bool same(const Case& a, const Case& b) {
  return a.id == b.id && a.object == b.object && a.period_s == b.period_s &&
         a.push_steps == b.push_steps && a.effective_count == b.effective_count &&
         same(a.start_outcome, b.start_outcome) && same(a.steps, b.steps) && same(a.tube, b.tube);
}

}  // namespace

std::shared_ptr<const CaseSet> CaseSetLibrary::get(
    const Cases& cases, double zeta, const std::function<std::shared_ptr<const CaseSet>()>& make) {
  if (cases.size() > kMostCases) return make();
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.zeta == zeta &&
           std::equal(cases.begin(), cases.end(), entry.cases.begin(), entry.cases.end(),
                      [](const Case* a, const Case& b) { return same(*a, b); });
  });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front().set;
  }
  std::shared_ptr<const CaseSet> set = make();
  if (set == nullptr) return set;
  Entry entry{{}, zeta, set};
  for (const Case* push_case : cases) entry.cases.push_back(*push_case);
  entries_.push_front(std::move(entry));
  if (entries_.size() > kKept) entries_.pop_back();
  return set;
}

}  // namespace casepush
