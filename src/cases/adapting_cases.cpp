#include "casepush/cases/adapting_cases.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/same_pose.h"
#include "context_view.h"
#include "predictive.h"

namespace casepush {
namespace {

// Of the prediction test, when circumstances are asked whether they explain pushes.
constexpr double kAlpha = 0.01;

std::tuple<int, double, std::string> keyOf(const PushContext& context) {
  return {context.noticed, context.load_kg.value_or(-1.0), context.floor};
}

OutcomeStatistics statistics(const Case& push_case) {
  return {push_case.start_outcome, push_case.effective_count};
}

/// Whether a case was learnt in the present circumstances; in unknown ones all were that were told.
bool isIn(const PushContext& context, const PushContext& present) {
  return present == PushContext{} ? context.noticed == 0 : contextDistance(context, present) == 0.0;
}

/// Whether circumstances are possible ones for somebody who knows what was told.
bool mayBe(const PushContext& context, const PushContext& told) {
  return (!told.load_kg || context.load_kg == told.load_kg) &&
         (told.floor.empty() || context.floor == told.floor);
}

}  // namespace

std::string describe(const PushContext& context) {
  if (context.noticed > 0) {
    return "noticed change " + std::to_string(context.noticed);
  }
  std::string text = "as told: ";
  text += context.load_kg ? std::to_string(static_cast<int>(std::lround(*context.load_kg))) + " kg"
                          : "load unknown";
  return context.floor.empty() ? text : text + ", floor " + context.floor;
}

AdaptingCases::AdaptingCases(CaseBase* base, PushContext told, const AdaptingOptions& options)
    : base_(base), told_(std::move(told)), options_(options) {
  options_.adaptation.validate();
  options_.floor.validate();
  options_.change.validate();
}

AdaptingCases::Circumstances& AdaptingCases::of(const std::string& object) {
  const auto found = circumstances_.find(object);
  if (found != circumstances_.end()) {
    return found->second;
  }
  tell(object, told_);
  return circumstances_.at(object);
}

void AdaptingCases::tell(const std::string& object, const PushContext& told) {
  circumstances_.insert_or_assign(
      object, Circumstances{told, told, ChangeDetector(options_.change), {}, {}});
}

PushContext AdaptingCases::context(const std::string& object) const {
  const auto found = circumstances_.find(object);
  return found == circumstances_.end() ? told_ : found->second.context;
}

std::map<std::string, int> AdaptingCases::noticed() const {
  std::map<std::string, int> changes;
  for (const auto& [object, now] : circumstances_) {
    if (now.context.noticed > 0) changes[object] = now.context.noticed;
  }
  return changes;
}

std::vector<Case> AdaptingCases::cases(const std::string& object) const {
  std::map<std::string, std::vector<Case>> by_object;
  for (const Case& push_case : base_->cases(object)) {
    by_object[push_case.object].push_back(push_case);
  }
  std::map<std::int64_t, Case> present;
  for (const auto& [name, known] : by_object) {
    ContextView view(known, context(name));
    for (const Case& push_case : inContext(known, context(name))) {
      present[push_case.id] = view.expected(push_case);
    }
  }
  std::vector<Case> result;
  for (auto& [id, push_case] : present) {
    result.push_back(std::move(push_case));
  }
  return result;
}

std::string AdaptingCases::learnFrom(const PushReport& report) {
  const std::string object = base_->get(report.case_id).object;
  Circumstances& now = of(object);
  const ObservedPush push = observedPush(report, now.context);
  const std::vector<Case> known = base_->cases(object);
  const Case member = memberFor(report.case_id, known, now.context);
  base_->adapt(member.id, push, report.test.p_value, options_.adaptation, options_.floor);
  if (!options_.notice) {
    return {};
  }
  now.recent.push_back({member.id, push, takesOverTrajectories(member, push)});
  compare(known, report.case_id, push.start_T_object, &now);
  member.observation_count == 0 ? now.detector.addNothing() : now.detector.add(report.test.p_value);
  return judge(object, &now);
}

/// What circumstances met before say of a push, compared with the present ones. A conjecture says
/// too little for that: whatever is known better would win.
void AdaptingCases::compare(const std::vector<Case>& known, std::int64_t id,
                            const Pose2& start_T_object, Circumstances* now) const {
  const std::map<std::int64_t, std::int64_t> family_of = families(known);
  std::map<ContextKey, const Case*> family;
  const Case* expected = nullptr;
  for (const Case& push_case : known) {
    if (push_case.observation_count == 0) continue;
    const bool is_present = isIn(push_case.context, now->context);
    const bool is_of_family = family_of.at(push_case.id) == family_of.at(id);
    if (is_present && is_of_family) {
      expected = &push_case;
    } else if (!is_present && mayBe(push_case.context, now->told)) {
      const ContextKey key = keyOf(push_case.context);
      now->others.try_emplace(key, push_case.context, ChangeDetector(options_.change));
      if (is_of_family) family[key] = &push_case;
    }
  }
  for (auto& [key, other] : now->others) {
    const auto member = family.find(key);
    if (member == family.end() || expected == nullptr) {
      other.second.addNothing();
      continue;
    }
    const double log_ratio = logPredictive(statistics(*member->second), start_T_object) -
                             logPredictive(statistics(*expected), start_T_object);
    // Many pushes do about the same in either circumstances, and whichever case is known better
    // wins then. Only what surprises the present one, and not the other, speaks for the other; a
    // bet with less to win is a fair one still.
    const bool counts = isSurprising(statistics(*expected), start_T_object) &&
                        !isSurprising(statistics(*member->second), start_T_object);
    other.second.addLogRatio(counts ? log_ratio : std::min(0.0, log_ratio));
  }
}

std::string AdaptingCases::judge(const std::string& object, Circumstances* now) {
  int suspicious = now->detector.pushesSinceChange();
  for (const auto& [key, other] : now->others) {
    if (other.second.isRaised()) {
      return change(object, other.first, other.second.pushesSinceChange(), now);
    }
    suspicious = std::max(suspicious, other.second.pushesSinceChange());
  }
  if (now->detector.isRaised()) {
    PushContext changed = now->context;
    for (const Case& push_case : base_->cases(object)) {
      changed.noticed = std::max(changed.noticed, push_case.context.noticed);
    }
    ++changed.noticed;
    return change(object, changed, now->detector.pushesSinceChange(), now);
  }
  suspicious = std::min(suspicious, static_cast<int>(now->recent.size()));
  now->recent.erase(now->recent.begin(), now->recent.end() - suspicious);
  return {};
}

/// The case of a family that is to learn in a context, as it is before; made for that if need be.
Case AdaptingCases::memberFor(std::int64_t id, const std::vector<Case>& known,
                              const PushContext& context) {
  const Case* const original = findCase(known, id);
  if (original == nullptr) throw InputError("case " + std::to_string(id), "it no longer exists");
  if (context == PushContext{}) return *original;
  ContextView view(known, context);
  if (const Case* member = view.member(id)) return *member;
  Case copy = view.expected(*original);
  copy.source_id = id;
  copy.observation_count = 0;  // None in this context.
  copy.context = context;
  copy.id = base_->add(copy, std::nullopt, options_.floor);
  return copy;
}

/// Takes pushes back from their cases, and returns those that are to be learnt anew. Another
/// program may have written to the base: only the very observations are taken back, and pushes of
/// cases that are gone are left out, as are those that made their cases what they are.
std::vector<AdaptingCases::Testimony> AdaptingCases::takeBack(const std::string& object,
                                                              std::vector<Testimony> pushes) {
  const std::vector<Case> known = base_->cases(object);
  const auto stays = [&known](const Testimony& testimony) {
    return testimony.made_the_case || findCase(known, testimony.case_id) == nullptr;
  };
  pushes.erase(std::remove_if(pushes.begin(), pushes.end(), stays), pushes.end());
  for (auto it = pushes.rbegin(); it != pushes.rend(); ++it) {
    const std::vector<Pose2> observations = base_->observations(it->case_id);
    if (!observations.empty() && isSame(observations.back(), it->push.start_T_object)) {
      base_->undo(it->case_id);
    }
  }
  return pushes;
}

std::string AdaptingCases::change(const std::string& object, PushContext context, int pushes,
                                  Circumstances* now) {
  pushes = std::min(pushes, static_cast<int>(now->recent.size()));
  const std::vector<Testimony> since =
      takeBack(object, {now->recent.end() - pushes, now->recent.end()});
  const PushContext before = now->context;
  *now = Circumstances{now->told, context, ChangeDetector(options_.change), {}, {}};
  for (Testimony testimony : since) {
    const Case member = memberFor(testimony.case_id, base_->cases(object), context);
    testimony.push.context = context;
    const PredictionTest test =
        testPrediction(statistics(member), testimony.push.start_T_object, kAlpha);
    base_->adapt(member.id, testimony.push, test.p_value, options_.adaptation, options_.floor);
  }
  return object + " no longer moves as its cases say (" + describe(before) +
         "): another load or floor? From its last " + std::to_string(pushes) +
         " pushes on it is taken for " + describe(context) + "; what was known before is kept";
}

}  // namespace casepush
