#include "context_view.h"

#include <utility>

namespace casepush {

ContextView::ContextView(std::vector<Case> cases, const PushContext& context)
    : cases_(std::move(cases)), context_(context), family_of_(families(cases_)) {
  for (const Case& push_case : cases_) {
    if (contextDistance(push_case.context, context_) == 0.0) {
      members_.try_emplace(family_of_.at(push_case.id), &push_case);
    }
  }
}

const Case* ContextView::member(std::int64_t id) const {
  const auto found = members_.find(family_of_.at(id));
  return found == members_.end() ? nullptr : found->second;
}

Case ContextView::expected(const Case& push_case) {
  if (context_ == PushContext{} || contextDistance(push_case.context, context_) == 0.0) {
    return push_case;
  }
  for (const auto& [from, shift] : shifts_) {
    if (from == push_case.context) return shift.conjecture(push_case);
  }
  ContextShift shift;
  for (const Case& before : cases_) {
    const Case* now = member(before.id);
    if (now != nullptr && contextDistance(before.context, push_case.context) == 0.0) {
      shift.add(before, *now);
    }
  }
  shifts_.emplace_back(push_case.context, shift);
  return shift.conjecture(push_case);
}

}  // namespace casepush
