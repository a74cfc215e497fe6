#include "casepush/ros/learner_node.h"

#include <casepush/PushCaseArray.h>
#include <casepush/SetPoses.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/markers.h"
#include "casepush/ros/names.h"
#include "casepush/ros/push_conversions.h"
#include "learner_run.h"

namespace casepush {
namespace {

using std::chrono::milliseconds;

// How near the tracked pose must be to where an object was put.
constexpr double kPlacedM = 0.05;
constexpr double kPlacedRad = 0.1;
constexpr double kSeenPatienceS = 10.0;                // Wall time.
constexpr std::chrono::seconds kExecutorPatience(20);  // Wall time.
constexpr milliseconds kLook(20);

const char* toString(Exploration::Trial::Kind kind) {
  switch (kind) {
    case Exploration::Trial::Kind::kExplore:
      return "explore";
    case Exploration::Trial::Kind::kPractise:
      return "practise";
    case Exploration::Trial::Kind::kBringBack:
      break;
  }
  return "bring back";
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

LearnerNode::LearnerNode(LearnerNodeParameters parameters, ros::NodeHandle handle)
    : parameters_(std::move(parameters)),
      handle_(handle),
      base_(parameters_.case_base, CaseBase::Access::kCreate),
      adapting_(&base_, parameters_.context, parameters_.adapting),
      objects_(handle),
      execute_push_(handle, names::kExecutePushAction, true),
      server_(handle, names::kLearnObjectAction,
              [this](const LearnObjectGoalConstPtr& goal) { onGoal(goal); }),
      demonstrations_(parameters_.furnishing, objects_, parameters_.demonstration, handle,
                      {[this] {
                         return server_.isActive() ? std::string("learning is under way")
                                                   : std::string();
                       },
                       [this](const Case& push_case) { return addDemonstrated(push_case); }}),
      diagnostics_(handle, "learner", [this](auto& status) { reportDiagnostics(status); }) {
  shown_object_ = parameters_.furnishing.instances.front().id;
  octomap_subscriber_ = handle_.subscribe(names::kOctomap.name, names::kOctomap.queue_size,
                                          &LearnerNode::onOctomap, this);
  set_pose_ = handle_.serviceClient<SetPoses>(names::kSetPoseService);
  cases_ = handle_.advertise<PushCaseArray>(names::kCases.name, names::kCases.queue_size, true);
  markers_ = handle_.advertise<MarkerArray>(names::kCaseMarkers.name,
                                            names::kCaseMarkers.queue_size, true);
  reports_subscriber_ = handle_.subscribe(names::kPushReports.name, names::kPushReports.queue_size,
                                          &LearnerNode::onReport, this);
  stops_subscriber_ =
      handle_.subscribe(names::kStops.name, names::kStops.queue_size, &LearnerNode::onStop, this);
  export_ = handle_.advertiseService(names::kExportCasesService, &LearnerNode::onExport, this);
  import_ = handle_.advertiseService(names::kImportCasesService, &LearnerNode::onImport, this);
  publishCases();
  marker_timer_ = handle_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publishMarkersIfMoved(); });
  server_.start();
}

ExplorationOptions LearnerNode::explorationOptions(const LearnObjectGoal& goal) const {
  ExplorationOptions options = parameters_.exploration;
  // Out of bounds all the same.
  constexpr std::uint32_t kMost = std::numeric_limits<int>::max();
  if (goal.cases > 0) {
    options.cases = static_cast<int>(std::min(goal.cases, kMost));
  }
  if (goal.practices > 0) {
    options.practices = static_cast<int>(std::min(goal.practices, kMost));
  }
  options.seed = goal.seed;
  options.validate();
  return options;
}

void LearnerNode::onGoal(const LearnObjectGoalConstPtr& goal) {
  Run run;
  run.start_s = ros::Time::now().toSec();
  try {
    learn(*goal, run);
  } catch (const InputError& error) {
    run.fail(LearnObjectResult::FAILED, error.what());
    noteStored(error.what());
  }
  LearnObjectResult& result = run.result;
  result.pushes = static_cast<std::uint32_t>(run.pushes);
  if (run.exploration != nullptr) {
    result.discarded = static_cast<std::uint32_t>(run.exploration->discarded());
    result.dropped = static_cast<std::uint32_t>(run.exploration->dropped());
    const std::lock_guard<std::mutex> lock(base_mutex_);
    result.cases = static_cast<std::uint32_t>(base_.cases(run.instance->model.name).size());
  }
  result.duration = ros::Time::now().toSec() - run.start_s;
  ROS_INFO("learning %s: %s", goal->object_id.c_str(), result.explanation.c_str());
  if (result.status == LearnObjectResult::DONE) {
    server_.setSucceeded(result, result.explanation);
  } else if (result.status == LearnObjectResult::CANCELLED) {
    server_.setPreempted(result, result.explanation);
  } else {
    server_.setAborted(result, result.explanation);
  }
}

void LearnerNode::learn(const LearnObjectGoal& goal, Run& run) {
  run.object_id = goal.object_id;
  run.instance = parameters_.furnishing.instance(goal.object_id);
  if (run.instance == nullptr) {
    run.fail(LearnObjectResult::INVALID_GOAL, "unknown object '" + goal.object_id + "'");
    return;
  }
  try {
    run.options = explorationOptions(goal);
  } catch (const InputError& error) {
    run.fail(LearnObjectResult::INVALID_GOAL, error.what());
    return;
  }
  resume(run);
  if (!begin(run)) {
    endIfAsked(run);
    return;
  }
  while (push(run)) {
  }
  if (!run.exploration->finished()) {
    return;
  }
  if (run.exploration->gaveUp()) {
    run.fail(LearnObjectResult::GAVE_UP, run.exploration->explanation());
    return;
  }
  run.result.status = LearnObjectResult::DONE;
  run.result.explanation = "knows " + std::to_string(run.options.cases) +
                           " cases, each practised " + std::to_string(run.options.practices) +
                           " times (" + describe(run.context) + ")";
}

void LearnerNode::resume(Run& run) {
  {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    was_stopped_ = false;
  }
  run.exploration =
      std::make_unique<Exploration>(run.instance->model, parameters_.furnishing.robot, run.options);
  const std::lock_guard<std::mutex> lock(base_mutex_);
  const std::string& object = run.instance->model.name;
  run.context = adapting_.context(object);
  // The executor knows no others than those that are published.
  run.exploration->resume(learntIn(adapting_.cases(object), run.context));
  run.done_before = run.exploration->pushesDone();
  ROS_INFO("learning %s (%s)", run.object_id.c_str(), describe(run.context).c_str());
}

bool LearnerNode::push(Run& run) {
  const std::optional<Exploration::Trial> trial = nextTrial(run);
  const std::optional<PushReport> report = trial ? execute(run, *trial) : std::nullopt;
  if (!report) {
    return false;
  }
  ++run.pushes;
  store(run, *trial, *report);
  return true;
}

bool LearnerNode::begin(Run& run) {
  if (!run.exploration->next()) {
    return true;
  }
  {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    shown_object_ = run.object_id;
  }
  if (!waitUntil([this] { return execute_push_.isServerConnected(); }, kExecutorPatience)) {
    return run.fail(LearnObjectResult::EXECUTOR_GONE, "action execute_push does not answer");
  }
  run.teleport = canTeleport();
  if (parameters_.reset == ResetMode::kTeleport && !run.teleport) {
    return run.fail(LearnObjectResult::FAILED, "reset is teleport, but there is no service " +
                                                   std::string(names::kSetPoseService));
  }
  const std::optional<ObjectState> object = see(run.object_id);
  if (!object) {
    return run.fail(LearnObjectResult::FAILED,
                    run.object_id + " has not been seen (topic objects)");
  }
  run.map_T_home = parameters_.home.value_or(object->map_T_object);
  return run.teleport || findGround(run);
}

std::optional<ObjectState> LearnerNode::see(const std::string& id) {
  const auto any = [](const ObjectState& /*object*/) { return true; };
  return objects_.wait(id, any, kSeenPatienceS, [this] { return shouldEnd(); });
}

bool LearnerNode::shouldEnd() {
  const std::lock_guard<std::mutex> lock(state_mutex_);
  return was_stopped_ || !ros::ok() || server_.isPreemptRequested();
}

bool LearnerNode::endIfAsked(Run& run) {
  if (!shouldEnd()) {
    return false;
  }
  const std::lock_guard<std::mutex> lock(state_mutex_);
  if (was_stopped_) {
    run.fail(LearnObjectResult::FAILED, std::string("stopped by the service stop") + Run::kKept);
  } else {
    run.fail(LearnObjectResult::CANCELLED, std::string("cancelled") + Run::kKept);
  }
  return true;
}

void LearnerNode::onStop(const std_msgs::Empty& /*message*/) {
  const std::lock_guard<std::mutex> lock(state_mutex_);
  was_stopped_ = true;
  state_changed_.notify_all();
}

bool LearnerNode::canTeleport() {
  return parameters_.reset != ResetMode::kDrive && set_pose_.exists();
}

bool LearnerNode::waitForChange(const std::function<bool()>& condition) {
  // Nothing of the action client is called with the mutex held: its thread takes it in callbacks.
  std::unique_lock<std::mutex> lock(state_mutex_);
  return state_changed_.wait_for(lock, kLook, condition);
}

bool LearnerNode::waitUntil(const std::function<bool()>& condition, milliseconds patience) {
  const std::chrono::steady_clock::time_point end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (shouldEnd() || std::chrono::steady_clock::now() > end) {
      return false;
    }
    waitForChange([] { return false; });
  }
  return true;
}

std::string LearnerNode::reset(const Run& run, const Exploration::Trial& trial) {
  if (!run.teleport) {
    return "";
  }
  SetPoses::Request request;
  SetPoses::Response response;
  BodyPose body;
  body.id = run.object_id;
  body.pose = toMessage(run.map_T_home);
  request.bodies.push_back(body);
  body.id = "robot";
  body.pose = toMessage(run.map_T_home * trial.object_T_reset);
  request.bodies.push_back(body);
  if (!set_pose_.call(request, response)) {
    return std::string("service ") + names::kSetPoseService + " failed";
  }
  if (!response.success) {
    return response.message;
  }
  // Images taken before the move may still be under way: only later ones count.
  const double moved_s = ros::Time::now().toSec();
  const auto stands_there = [&](const ObjectState& object) {
    return object.stamp_s > moved_s && !object.moving &&
           distance(object.map_T_object, run.map_T_home) < kPlacedM &&
           std::abs(yawDifference(object.map_T_object, run.map_T_home)) < kPlacedRad;
  };
  const std::optional<ObjectState> seen =
      objects_.wait(run.object_id, stands_there, kSeenPatienceS, [this] { return shouldEnd(); });
  return seen ? "" : run.object_id + " is not seen where it was put";
}

void LearnerNode::store(Run& run, const Exploration::Trial& trial, const PushReport& report) {
  {
    const std::lock_guard<std::mutex> lock(base_mutex_);
    const PushGround* ground = run.ground ? &*run.ground : nullptr;
    if (!keep(*run.exploration, trial, report, base_, {parameters_.adapting.floor, run.context},
              ground)) {
      ROS_DEBUG("push not kept: %s %s", toString(report.outcome), report.explanation.c_str());
      return;
    }
  }
  publishCases();
  noteStored("");
}

void LearnerNode::publishProgress(const Run& run, const Exploration::Trial& trial) {
  LearnObjectFeedback feedback;
  feedback.case_number = static_cast<std::uint32_t>(trial.case_number);
  feedback.case_count = static_cast<std::uint32_t>(run.options.cases);
  feedback.practice_number = static_cast<std::uint32_t>(trial.practice_number);
  feedback.practice_count = static_cast<std::uint32_t>(run.options.practices);
  feedback.pushes = static_cast<std::uint32_t>(run.pushes);
  feedback.discarded = static_cast<std::uint32_t>(run.exploration->discarded());
  const int done = run.exploration->pushesDone();
  const int left = run.options.cases * run.options.practices - done;
  const int done_now = done - run.done_before;
  feedback.time_left = done_now > 0 ? secondsSince(run.start) / done_now * left : -1.0;
  feedback.phase = toString(trial.kind);
  server_.publishFeedback(feedback);
}

}  // namespace casepush
