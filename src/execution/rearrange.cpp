#include "casepush/execution/rearrange.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "push_task_rules.h"
#include "watches.h"

namespace casepush {
namespace {

void checkGoals(const std::vector<PushTaskGoal>& tasks) {
  if (tasks.empty()) throw InputError("rearrange", "there is no goal");
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (!isSensible(tasks[i])) {
      throw InputError("rearrange", tasks[i].object_id + ": " + kNotSensible);
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (tasks[k].object_id == tasks[i].object_id) {
        throw InputError("rearrange",
                         tasks[i].object_id + " has two goals; give one for each object");
      }
    }
  }
}

/// Whatever else happens. A request that was not understood tells nothing of the goal.
bool canNeverBeMet(PlanStatus status) {
  return isInvalidGoal(status) && status != PlanStatus::kInvalidRequest;
}

bool contains(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

void RearrangeOptions::validate() const {
  Violations violations;
  violations.require("max_rounds", max_rounds, 1, 1000);
  violations.require("plan_deadline_s", plan_deadline_s, 0.01, 3600.0);
  violations.require("look_timeout_s", look_timeout_s, 0.1, 3600.0);
  violations.throwIfAny("rearrange options");
}

struct Rearrange::Data {
  enum class Stage { kLook, kOrder, kGoals, kTasks, kDone };

  Data(RearrangeRequest wanted, RearrangeServices outside, const RearrangeOptions& all)
      : goal(std::move(wanted)), services(std::move(outside)), options(all) {
    for (const PushTaskGoal& each : goal.tasks) {
      items.emplace_back();
      items.back().object_id = each.object_id;
    }
  }

  RearrangeRequest goal;
  RearrangeServices services;
  RearrangeOptions options;
  Stage stage = Stage::kLook;
  PushTaskStatus status = PushTaskStatus::kRunning;
  bool is_cancelled = false;
  std::string text = "looking for the objects";
  std::vector<Item> items;
  std::vector<int> left;   ///< Goals of this round.
  std::vector<int> order;  ///< Of this round.
  std::vector<std::optional<PushPlan>> plans;
  std::size_t next = 0;  ///< Plan to ask for, then task to run.
  bool asked = false;
  int round = 0;
  std::unique_ptr<PushTask> task;
  double task_began_s = 0.0;
  std::optional<double> began_s;
  double stage_began_s = 0.0;

  Tick run(const Observation& observation);
  void look(const Observation& observation);
  std::optional<PlanResult> ask(const PlanRequest& request);
  PlanRequest requestFor(const PushTaskGoal& wanted, const ObjectState& object,
                         const Observation& observation) const;
  void compareGoals(const Observation& observation);
  void beginRound(const Observation& observation);
  void plan(const Observation& observation);
  void chooseOrder(const Observation& observation);
  Tick runTask(const Observation& observation);
  std::vector<int> unmet(const Observation& observation) const;
  void endTask(PushTaskStatus how, const std::string& why);
  void end(PushTaskStatus how, const std::string& why);
  std::string failures() const;
};

// Notes how far the task has come.
void Rearrange::Data::endTask(PushTaskStatus how, const std::string& why) {
  Item& item = items[order[next]];
  item.status = how;
  item.explanation = why;
  item.pushes += task->progress().pushes;
  if (services.on_task_end) {
    services.on_task_end(goal.tasks[order[next]], *task, how, why, task_began_s);
  }
  task.reset();
}

void Rearrange::Data::end(PushTaskStatus how, const std::string& why) {
  if (asked) services.plans->cancel();
  if (task) endTask(how, why);
  stage = Stage::kDone;
  status = how;
  text = why;
}

std::vector<int> Rearrange::Data::unmet(const Observation& observation) const {
  std::vector<int> result;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const PushTaskGoal& wanted = goal.tasks[i];
    const ObjectState* object = usableObject(observation, wanted.object_id);
    const bool is_met =
        object != nullptr && wanted.tolerance.isMet(wanted.map_T_goal, object->map_T_object);
    if (!is_met) result.push_back(static_cast<int>(i));
  }
  return result;
}

void Rearrange::Data::look(const Observation& observation) {
  const auto unseen =
      std::find_if(goal.tasks.begin(), goal.tasks.end(), [&](const PushTaskGoal& each) {
        return usableObject(observation, each.object_id) == nullptr;
      });
  const bool may_wait = observation.stamp_s - stage_began_s <= options.look_timeout_s;
  if (unseen != goal.tasks.end() && may_wait) {
    text = "looking for " + unseen->object_id;
    return;
  }
  beginRound(observation);  // Who is still unseen fails in its own task, which says so.
}

std::optional<PlanResult> Rearrange::Data::ask(const PlanRequest& request) {
  if (!asked) {
    services.plans->request(request);
    asked = true;
    return std::nullopt;
  }
  std::optional<PlanResult> result = services.plans->poll();
  asked = !result;
  return result;
}

PlanRequest Rearrange::Data::requestFor(const PushTaskGoal& wanted, const ObjectState& object,
                                        const Observation& observation) const {
  PlanRequest request;
  request.object = {object.id, object.model, object.map_T_object};
  request.map_T_goal = wanted.map_T_goal;
  request.tolerance = wanted.tolerance;
  request.map_T_robot = observation.map_T_robot;
  request.seed = wanted.seed;
  request.deadline_s = options.plan_deadline_s;
  return request;
}

// Whether all objects, none of whose goals is in a wall, can be at their goals at once.
void Rearrange::Data::compareGoals(const Observation& observation) {
  if (next + 1 >= goal.tasks.size() || !services.plans->isAlive()) {
    chooseOrder(observation);
    return;
  }
  const PushTaskGoal& wanted = goal.tasks[next];
  const ObjectState* object = usableObject(observation, wanted.object_id);
  if (object == nullptr) {
    ++next;
    return;
  }
  PlanRequest request = requestFor(wanted, *object, observation);
  request.object.map_T_object = wanted.map_T_goal;
  for (std::size_t i = next + 1; i < goal.tasks.size(); ++i) {
    const ObjectState* other = usableObject(observation, goal.tasks[i].object_id);
    if (other != nullptr) {
      request.obstacles.push_back({other->id, other->model, goal.tasks[i].map_T_goal});
    }
  }
  const std::optional<PlanResult> result = ask(request);
  if (!result) return;
  if (result->status == PlanStatus::kStartInCollision) {
    items[next].status = PushTaskStatus::kInvalidGoal;
    items[next].explanation = "with all objects at their goals: " + result->explanation;
    end(PushTaskStatus::kInvalidGoal, items[next].explanation);
    return;
  }
  ++next;
}

void Rearrange::Data::beginRound(const Observation& observation) {
  left = unmet(observation);
  if (left.empty()) {
    end(PushTaskStatus::kSucceeded, "all objects are at their goals");
    return;
  }
  if (round++ >= options.max_rounds) {
    end(PushTaskStatus::kNoProgress, failures());
    return;
  }
  stage = Stage::kOrder;
  text = "choosing the order";
  plans.assign(left.size(), std::nullopt);
  order.clear();
  next = 0;
  asked = false;
}

std::string Rearrange::Data::failures() const {
  std::string list = "after " + std::to_string(options.max_rounds) + " rounds not at its goal:";
  for (const int i : left) list += " " + items[i].object_id + " (" + items[i].explanation + ")";
  return list;
}

// As if no object that has a goal of its own, or may be cleared away, stood around.
void Rearrange::Data::plan(const Observation& observation) {
  if (next == left.size() && round == 1) {
    stage = Stage::kGoals;
    next = 0;
    return;
  }
  if (next == left.size()) {
    chooseOrder(observation);
    return;
  }
  const PushTaskGoal& wanted = goal.tasks[left[next]];
  const ObjectState* object = usableObject(observation, wanted.object_id);
  if (object == nullptr || !services.plans->isAlive()) {
    ++next;
    return;
  }
  PlanRequest request = requestFor(wanted, *object, observation);
  for (const PlacedObject& other : otherObjects(observation, object->id)) {
    const bool has_goal = std::any_of(items.begin(), items.end(), [&other](const Item& item) {
      return item.object_id == other.id;
    });
    // One that may be cleared away will be gone when its turn comes.
    if (!has_goal && !wanted.clear_obstacles) request.obstacles.push_back(other);
  }
  if (const std::optional<PlanResult> result = ask(request)) {
    if (round == 1 && canNeverBeMet(result->status)) {
      Item& item = items[left[next]];
      item.status = PushTaskStatus::kInvalidGoal;
      item.explanation = result->explanation;
      end(PushTaskStatus::kInvalidGoal, item.object_id + ": " + result->explanation);
      return;
    }
    if (result->status == PlanStatus::kSolved) plans[next] = result->plan;
    ++next;
  }
}

void Rearrange::Data::chooseOrder(const Observation& observation) {
  std::vector<std::pair<int, int>> wishes;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!plans[i]) continue;
    for (std::size_t k = 0; k < left.size(); ++k) {
      const PushTaskGoal& other = goal.tasks[left[k]];
      const ObjectState* object = usableObject(observation, other.object_id);
      if (k == i || object == nullptr) continue;
      const auto blocks = [&](const Pose2& pose) {
        const PlacedObject there{object->id, object->model, pose};
        return contains(services.in_the_way(*plans[i], {there}), object->id);
      };
      const int a = static_cast<int>(i);
      const int b = static_cast<int>(k);
      if (blocks(object->map_T_object)) wishes.emplace_back(b, a);
      if (blocks(other.map_T_goal)) wishes.emplace_back(a, b);
    }
  }
  for (const int which : bestOrder(static_cast<int>(left.size()), wishes)) {
    order.push_back(left[which]);
  }
  stage = Stage::kTasks;
  next = 0;
}

Tick Rearrange::Data::runTask(const Observation& observation) {
  if (!task) {
    if (next == order.size()) {
      beginRound(observation);
      return {};
    }
    task = services.make_task(goal.tasks[order[next]]);
    ++items[order[next]].attempts;
    task_began_s = observation.stamp_s;
  }
  Tick tick = task->tick(observation);
  const Item& item = items[order[next]];
  text = item.object_id + ": " + task->describe();
  if (tick.status == BehaviourStatus::kRunning) return tick;
  endTask(task->status(), task->describe());
  if (is_cancelled) {
    end(PushTaskStatus::kCancelled, "cancelled");
  } else if (item.status == PushTaskStatus::kRobotLost ||
             item.status == PushTaskStatus::kPlannerGone) {
    end(item.status, text);  // The others would fare no better.
  } else {
    ++next;
  }
  return {};
}

Tick Rearrange::Data::run(const Observation& observation) {
  if (!std::isfinite(observation.stamp_s)) {
    return task ? runTask(observation) : Tick{};
  }
  if (!began_s) {
    began_s = observation.stamp_s;
    stage_began_s = observation.stamp_s;
  }
  if (observation.stamp_s - *began_s > goal.time_limit_s) {
    end(PushTaskStatus::kTimeout, "time is up: " + text);
    return {};
  }
  switch (stage) {
    case Stage::kLook:
      look(observation);
      break;
    case Stage::kGoals:
      compareGoals(observation);
      break;
    case Stage::kOrder:
      plan(observation);
      break;
    case Stage::kTasks:
      return runTask(observation);
    case Stage::kDone:
      break;
  }
  return {};
}

Rearrange::Rearrange(RearrangeRequest goal, RearrangeServices services, RearrangeOptions options) {
  options.validate();
  checkGoals(goal.tasks);
  if (services.plans == nullptr || !services.make_task || !services.in_the_way) {
    throw InputError("rearrange", "plans, make_task and in_the_way are required");
  }
  data_ = std::make_unique<Data>(std::move(goal), std::move(services), options);
}

Rearrange::~Rearrange() = default;

Tick Rearrange::tick(const Observation& observation) {
  Tick tick;
  if (data_->status == PushTaskStatus::kRunning) tick = data_->run(observation);
  tick.status = data_->status == PushTaskStatus::kRunning     ? BehaviourStatus::kRunning
                : data_->status == PushTaskStatus::kSucceeded ? BehaviourStatus::kSucceeded
                                                              : BehaviourStatus::kFailed;
  if (tick.status != BehaviourStatus::kRunning) tick.command = Command{};
  return tick;
}

std::string Rearrange::describe() const { return data_->text; }

void Rearrange::cancel() {
  if (data_->status != PushTaskStatus::kRunning) return;
  data_->is_cancelled = true;
  if (data_->task) {
    data_->task->cancel();  // Its push is to be reported.
  } else {
    data_->end(PushTaskStatus::kCancelled, "cancelled");
  }
}

PushTaskStatus Rearrange::status() const { return data_->status; }
bool Rearrange::isLooking() const { return data_->stage == Data::Stage::kLook; }
const std::vector<Rearrange::Item>& Rearrange::items() const { return data_->items; }
const std::vector<int>& Rearrange::order() const { return data_->order; }
std::size_t Rearrange::turn() const { return data_->next; }
const PushTask* Rearrange::task() const { return data_->task.get(); }
double Rearrange::taskBeganS() const { return data_->task_began_s; }

}  // namespace casepush
