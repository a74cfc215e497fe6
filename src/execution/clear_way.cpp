#include "casepush/execution/clear_way.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "casepush/common/violations.h"
#include "watches.h"

namespace casepush {
namespace {

/// Of the plan's object, on average, in so many pushes [m].
double wayM(const PushPlan& plan, int pushes) {
  const auto all = static_cast<double>(plan.pushes.size());
  return plan.pushes.empty() ? 0.0 : plan.lengthM() * std::min(1.0, pushes / all);
}

}  // namespace

void ClearWayOptions::validate() const {
  push.validate();
  Violations violations;
  violations.require("max_pushes", max_pushes, 1, 100000);
  violations.require("max_depth", max_depth, 1, 100);
  violations.require("pushes_ahead", pushes_ahead, 1, 1000);
  violations.require("deadline_s", deadline_s, 0.01, 3600.0);
  violations.require("look_timeout_s", look_timeout_s, 0.1, 3600.0);
  violations.throwIfAny("clearing options");
}

struct ClearWay::Data {
  /// Pushes that are looked for.
  struct Search {
    ClearingRequest request;
    PendingClearing pending;
    bool may_move_others;  ///< If there are none while all others stand still.
  };

  Data(PushPlan plan, RobotModel robot_model, ClearWayServices outside, ClearWayOptions all)
      : robot(std::move(robot_model)),
        services(std::move(outside)),
        options(std::move(all)),
        ways{std::move(plan)} {}

  RobotModel robot;
  ClearWayServices services;
  ClearWayOptions options;
  std::vector<PushPlan> ways;  ///< The plan, then those of the obstacles that are being cleared.
  std::optional<Search> search;
  std::optional<ExecutePush> push;
  PushPlan rest;  ///< Of the obstacle's plan after that push.
  std::optional<std::vector<std::string>> first_blockers;  ///< Until the first tick.
  double looking_since_s = -1.0;
  bool on_the_trip = false;  ///< What is being cleared could be left for later.
  int pushes = 0;
  std::string text = "looking what is in the way";
  std::string stuck;
  BehaviourStatus status = BehaviourStatus::kRunning;

  Tick run(const Observation& observation);
  Tick pushOn(const Observation& observation);
  bool isOnTheWay(const std::string& id) const;
  std::vector<std::string> blockers(const Observation& observation, int pushes_ahead) const;
  std::vector<std::string> nowOrOnTheTrip(const Observation& observation);
  bool isWorthTheTrip(const std::string& id, const Observation& observation) const;
  std::optional<PlacedObject> nextBlocker(const Observation& observation);
  void decide(const Observation& observation);
  void clear(const PlacedObject& obstacle, const Observation& observation);
  void beginSearch(const PlacedObject& obstacle, const Observation& observation);
  bool searchAmongMovable();
  void searchOn();
  bool isAtRest(const std::string& id, const Observation& observation);
  void startPush();
  void end(BehaviourStatus how, const std::string& why);
  void getStuck(const std::string& id, const std::string& why);
};

void ClearWay::Data::end(BehaviourStatus how, const std::string& why) {
  search.reset();
  status = how;
  text = why;
}

void ClearWay::Data::getStuck(const std::string& id, const std::string& why) {
  if (on_the_trip) {
    end(BehaviourStatus::kSucceeded, "the way is clear for now; " + id + " stays: " + why);
    return;
  }
  stuck = id;
  end(BehaviourStatus::kFailed, id + " cannot be pushed out of the way: " + why);
}

bool ClearWay::Data::isOnTheWay(const std::string& id) const {
  return std::any_of(ways.begin(), ways.end(),
                     [&id](const PushPlan& way) { return way.object.id == id; });
}

// In the way of the last plan on the stack. That of an obstacle is made anew after each push.
std::vector<std::string> ClearWay::Data::blockers(const Observation& observation,
                                                  int pushes_ahead) const {
  std::vector<std::string> ids =
      services.blockers(ways.back(), observation, ways.size() == 1 ? pushes_ahead : 1);
  const auto stays = [&](const std::string& id) {
    const ObjectState* object = usableObject(observation, id);
    return object == nullptr || isOnTheWay(id) ||
           !services.is_movable({id, object->model, object->map_T_object});
  };
  ids.erase(std::remove_if(ids.begin(), ids.end(), stays), ids.end());
  return ids;
}

// The way there now, against one there and back as soon as the pushes ahead reach it.
bool ClearWay::Data::isWorthTheTrip(const std::string& id, const Observation& observation) const {
  const Pose2& obstacle = usableObject(observation, id)->map_T_object;
  const Pose2& object = ways.front().object.map_T_object;
  const double now_m = distance(observation.map_T_robot, obstacle) + distance(obstacle, object) -
                       distance(observation.map_T_robot, object);
  return now_m < 2.0 * wayM(ways.front(), options.pushes_ahead);
}

// Once an obstacle was pushed, the robot is among them: what else it would come back for goes too.
std::vector<std::string> ClearWay::Data::nowOrOnTheTrip(const Observation& observation) {
  std::vector<std::string> ids = blockers(observation, options.pushes_ahead);
  if (ways.size() > 1 || !ids.empty()) return ids;
  on_the_trip = pushes > 0;
  if (!on_the_trip) return ids;
  ids = blockers(observation, static_cast<int>(ways.front().pushes.size()));
  ids.erase(std::remove_if(ids.begin(), ids.end(),
                           [&](const auto& id) { return !isWorthTheTrip(id, observation); }),
            ids.end());
  return ids;
}

std::optional<PlacedObject> ClearWay::Data::nextBlocker(const Observation& observation) {
  const std::vector<std::string> ids =
      first_blockers ? *first_blockers : nowOrOnTheTrip(observation);
  first_blockers.reset();
  if (ids.empty()) return std::nullopt;
  const ObjectState* object = usableObject(observation, ids.front());
  if (object == nullptr) return std::nullopt;
  return PlacedObject{object->id, object->model, object->map_T_object};
}

void ClearWay::Data::beginSearch(const PlacedObject& obstacle, const Observation& observation) {
  ClearingRequest request;
  request.obstacle = obstacle;
  request.ways = ways;
  request.standing = otherObjects(observation, obstacle.id);
  request.next_pushes = options.pushes_ahead;
  request.map_T_robot = observation.map_T_robot;
  request.deadline_s = options.deadline_s;
  search = {request, services.clear(request), static_cast<int>(ways.size()) < options.max_depth};
  searchOn();
}

// As if none of the others were there that may be in its way in turn. False if there are none.
bool ClearWay::Data::searchAmongMovable() {
  std::vector<PlacedObject>& standing = search->request.standing;
  const auto last =
      std::remove_if(standing.begin(), standing.end(), [this](const PlacedObject& other) {
        return !isOnTheWay(other.id) && services.is_movable(other);
      });
  if (!search->may_move_others || last == standing.end()) return false;
  standing.erase(last, standing.end());
  search->may_move_others = false;
  search->pending = services.clear(search->request);
  return true;
}

void ClearWay::Data::searchOn() {
  std::optional<ClearingResult> found = search->pending();
  if (found && !found->found && searchAmongMovable()) found = search->pending();
  if (!found) return;
  const std::string id = search->request.obstacle.id;
  search.reset();
  if (!found->found || found->plan.pushes.empty()) {
    getStuck(id, found->explanation);
  } else {
    ways.push_back(found->plan);
  }
}

// As it was last seen: who pushes it looks again before.
bool ClearWay::Data::isAtRest(const std::string& id, const Observation& observation) {
  const ObjectState* object = usableObject(observation, id);
  if (object != nullptr && !object->moving) return true;
  if (looking_since_s < 0.0) looking_since_s = observation.stamp_s;
  if (observation.stamp_s - looking_since_s > options.look_timeout_s) {
    getStuck(id, "it does not come to rest");
  }
  return false;
}

void ClearWay::Data::clear(const PlacedObject& obstacle, const Observation& observation) {
  text = "looking at " + obstacle.id + ", which is in the way";
  if (!isAtRest(obstacle.id, observation)) return;
  looking_since_s = -1.0;
  if (pushes >= options.max_pushes) {
    getStuck(obstacle.id, "still there after " + std::to_string(pushes) + " pushes");
    return;
  }
  beginSearch(obstacle, observation);
}

// One step down or up the stack of ways; what is in the way of the last one comes first.
void ClearWay::Data::decide(const Observation& observation) {
  if (const std::optional<PlacedObject> blocker = nextBlocker(observation)) {
    clear(*blocker, observation);
  } else if (ways.size() == 1) {
    end(BehaviourStatus::kSucceeded, "the way is clear");
  } else {
    startPush();
  }
}

void ClearWay::Data::startPush() {
  PushPlan plan = std::move(ways.back());
  ways.pop_back();  // It goes on from where the obstacle comes to rest.
  const std::vector<Case> cases = services.cases(plan.object.model);
  const Case* found = findCase(cases, plan.pushes.front().case_id);
  if (found == nullptr) {
    getStuck(plan.object.id, "a case of its plan is not known here");
    return;
  }
  text = "clearing " + plan.object.id + " out of the way";
  push.emplace(plan.object.id, *found, robot, services.approach(plan.object.id), options.push);
  push->watchAhead(services.touches(plan.object.id));
  rest = std::move(plan);
  rest.pushes.erase(rest.pushes.begin());
}

Tick ClearWay::Data::pushOn(const Observation& observation) {
  Tick tick = push->tick(observation);
  if (!push->report()) return tick;
  const PushReport report = *push->report();
  push.reset();
  ++pushes;  // Also those that came to nothing: clearing must end.
  services.on_report(report);
  if (report.outcome == PushOutcome::kRobotLost || report.outcome == PushOutcome::kCancelled) {
    end(BehaviourStatus::kFailed, report.explanation);
  } else if (isObservation(report) && pushes < options.max_pushes) {
    // Else it would be planned anew from scratch, and the obstacle might be pushed to and fro.
    if (const std::optional<PushPlan> plan = services.go_on(rest, observation)) {
      ways.push_back(*plan);
    }
  }
  return {};
}

Tick ClearWay::Data::run(const Observation& observation) {
  if (push) return pushOn(observation);
  if (search) {
    searchOn();
  } else {
    decide(observation);
  }
  return {};
}

ClearWay::ClearWay(PushPlan way, RobotModel robot, ClearWayServices services,
                   ClearWayOptions options) {
  options.validate();
  data_ = std::make_unique<Data>(std::move(way), std::move(robot), std::move(services),
                                 std::move(options));
}

ClearWay::~ClearWay() = default;

bool ClearWay::isNeeded(const Observation& observation) {
  data_->first_blockers = data_->blockers(observation, data_->options.pushes_ahead);
  return !data_->first_blockers->empty();
}

Tick ClearWay::tick(const Observation& observation) {
  Tick tick;
  if (data_->status == BehaviourStatus::kRunning) tick = data_->run(observation);
  tick.status = data_->status;
  if (tick.status != BehaviourStatus::kRunning) tick.command = Command{};
  return tick;
}

std::string ClearWay::describe() const {
  return data_->push ? data_->text + ": " + data_->push->describe() : data_->text;
}

void ClearWay::cancel() {
  if (data_->push) data_->push->cancel();
  data_->end(BehaviourStatus::kFailed, "cancelled");
}

int ClearWay::pushes() const { return data_->pushes; }

const std::string& ClearWay::stuckObstacle() const { return data_->stuck; }

}  // namespace casepush
