#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "casepush/cases/case_base.h"
#include "casepush/cases/change_detector.h"
#include "casepush/model/push_report.h"

namespace casepush {

/// For a person, e.g. "noticed change 1" or "as told: 15 kg, floor carpet".
std::string describe(const PushContext& context);

struct AdaptingOptions {
  AdaptationOptions adaptation;
  CovarianceFloor floor;
  ChangeDetectorOptions change;
  bool notice = true;  ///< Changes that nobody told of.
};

/// Cases that adapt by pushes (paper section 3.3), each in the circumstances it was made in.
///
/// Circumstances are what was told of load and floor (PushContext), until pushes give away that
/// they changed: then what was learnt since the change is taken back, and learnt again by copies of
/// the cases for the new circumstances. The originals keep what they knew. Cases not yet pushed in
/// the present circumstances are offered as ContextShift conjectures, and copied when they are. If
/// cases of circumstances met before explain the pushes since the change, and nothing else was
/// told, those are taken for the present ones; else it is a change of its own
/// (PushContext::noticed). Only cases that were observed in the present circumstances testify: what
/// others predict is a guess anyway.
class AdaptingCases {
 public:
  /// @param base  Must outlive this; may be written to by others between the calls.
  /// @param told  Of all objects but those with circumstances of their own, see tell().
  AdaptingCases(CaseBase* base, PushContext told, const AdaptingOptions& options = {});

  /// What is known of an object's circumstances; forgets what was noticed of them.
  void tell(const std::string& object, const PushContext& told);

  /// Of each family of copies the case for the present circumstances, ascending by id; of all
  /// objects if `object` is empty.
  std::vector<Case> cases(const std::string& object = "") const;

  /// Adapts the case that was pushed.
  /// @return A line for a person if the circumstances turn out to have changed; else empty.
  /// @pre report.case_id > 0, and the report is of a push that can be learnt from.
  /// @throws InputError as CaseBase::adapt; the push counts for nothing then.
  std::string learnFrom(const PushReport& report);

  /// Present circumstances of an object, by the name of its model.
  PushContext context(const std::string& object) const;

  /// Objects in circumstances that nobody told of, with PushContext::noticed.
  std::map<std::string, int> noticed() const;

 private:
  using ContextKey = std::tuple<int, double, std::string>;
  struct Testimony {
    std::int64_t case_id;
    ObservedPush push;
    bool made_the_case;  ///< It can not be taken back: the case took over its trajectories.
  };
  struct Circumstances {
    PushContext told;
    PushContext context;  ///< As told, or as the pushes say since.
    ChangeDetector detector;
    std::map<ContextKey, std::pair<PushContext, ChangeDetector>> others;  ///< Met before.
    std::vector<Testimony> recent;  ///< The last ones, which may be from after a change.
  };

  Circumstances& of(const std::string& object);
  Case memberFor(std::int64_t id, const std::vector<Case>& known, const PushContext& context);
  void compare(const std::vector<Case>& known, std::int64_t id, const Pose2& start_T_object,
               Circumstances* now) const;
  std::string judge(const std::string& object, Circumstances* now);
  std::vector<Testimony> takeBack(const std::string& object, std::vector<Testimony> pushes);
  std::string change(const std::string& object, PushContext context, int pushes,
                     Circumstances* now);

  CaseBase* base_;
  PushContext told_;
  AdaptingOptions options_;
  std::map<std::string, Circumstances> circumstances_;
};

}  // namespace casepush
