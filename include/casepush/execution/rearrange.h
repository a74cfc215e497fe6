#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "casepush/execution/push_task.h"

namespace casepush {

/// Goals of several objects. Ids differ.
struct RearrangeRequest {
  std::vector<PushTaskGoal> tasks;
  double time_limit_s = 3600.0;  ///< For all of them, by the observations' stamps.
};

struct RearrangeOptions {
  int max_rounds = 3;            ///< Tasks that failed, or whose object was moved, are done again.
  double plan_deadline_s = 2.0;  ///< Wall time for each plan that the order is chosen by.
  double look_timeout_s = 10.0;  ///< Wait for all objects to be seen.
  void validate() const;         ///< @throws InputError listing every violation.
};

/// All but on_task_end are required.
struct RearrangeServices {
  PlanClient* plans = nullptr;  ///< Must outlive the behaviour.
  std::function<std::unique_ptr<PushTask>(const PushTaskGoal&)> make_task;
  /// Ids of the objects that the plan would hit.
  std::function<std::vector<std::string>(const PushPlan&, const std::vector<PlacedObject>&)>
      in_the_way;
  /// Called once for each task when it has ended, in whatever way.
  /// @param began_s  Its first observation's stamp.
  std::function<void(const PushTaskGoal& goal, const PushTask& task, PushTaskStatus how,
                     const std::string& why, double began_s)>
      on_task_end;
};

/// An order of `count` things that keeps as many wishes "first before second" as possible; of equal
/// ones the one nearest to the given order. Exact for up to 8, beyond that the least blocked one is
/// taken next again and again.
std::vector<int> bestOrder(int count, const std::vector<std::pair<int, int>>& wishes);

/// Brings several objects to their goals, one after the other.
///
/// Each object's way is planned as if the others were not there. An object that stands on the way
/// of another goes before it; one whose goal lies on the way of another goes after it. Whatever an
/// order cannot avoid is left to the push tasks, which go around or clear the way. Tasks that
/// failed and objects that were moved again get another round. If a goal can never be met (in a
/// collision with what stands still or with another goal, outside of the map, no cases of the
/// object), nothing is pushed.
class Rearrange : public Behaviour {
 public:
  /// @throws InputError from the options, if a service is missing, if there is no goal, a goal
  /// makes no sense or an object has two.
  Rearrange(RearrangeRequest goal, RearrangeServices services, RearrangeOptions options);
  ~Rearrange() override;

  Tick tick(const Observation& observation) override;
  std::string describe() const override;
  void cancel();  ///< The next tick ends it.

  /// kRunning, kSucceeded, kCancelled, kInvalidGoal, kTimeout, kRobotLost, kPlannerGone, or
  /// kNoProgress if some objects are not at their goals after all rounds.
  PushTaskStatus status() const;
  bool isLooking() const;  ///< Before the order of the first round is chosen.

  /// How far each goal has come, in the order of RearrangeRequest::tasks.
  struct Item {
    std::string object_id;
    PushTaskStatus status = PushTaskStatus::kRunning;  ///< kRunning also before its turn.
    std::string explanation;
    int attempts = 0;
    int pushes = 0;
  };
  const std::vector<Item>& items() const;
  const std::vector<int>& order() const;  ///< Of the last round; empty before it is known.
  std::size_t turn() const;               ///< Index in order() of the task that runs.
  const PushTask* task() const;           ///< The one that runs; nullptr if none does.
  double taskBeganS() const;              ///< The stamp of its first observation.

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
