#include "casepush/ros/learner_node.h"

#include <casepush/PushCaseArray.h>
#include <casepush/SetPoses.h>

#include <algorithm>
#include <chrono>
#include <cmath>
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
constexpr int kRefusals = 5;  // In a row by the executor, before learning gives up.

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
  export_ = handle_.advertiseService(names::kExportCasesService, &LearnerNode::onExport, this);
  import_ = handle_.advertiseService(names::kImportCasesService, &LearnerNode::onImport, this);
  publishCases();
  marker_timer_ = handle_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publishMarkersIfMoved(); });
  server_.start();
}

ExplorationOptions LearnerNode::explorationOptions(const LearnObjectGoal& goal) const {
  ExplorationOptions options = parameters_.exploration;
  if (goal.cases > 0) {
    options.cases = static_cast<int>(goal.cases);
  }
  if (goal.practices > 0) {
    options.practices = static_cast<int>(goal.practices);
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
  run.exploration =
      std::make_unique<Exploration>(run.instance->model, parameters_.furnishing.robot, run.options);
  {
    const std::lock_guard<std::mutex> lock(base_mutex_);
    run.exploration->resume(learntIn(base_.cases(run.instance->model.name), parameters_.context));
    run.done_before = run.exploration->pushesDone();
  }
  if (!begin(run)) {
    return;
  }
  while (const std::optional<Exploration::Trial> trial = nextTrial(run)) {
    const std::optional<PushReport> report = execute(run, *trial);
    if (!report) {
      return;
    }
    ++run.pushes;
    store(run, *trial, *report);
  }
  if (run.exploration->gaveUp()) {
    run.fail(LearnObjectResult::GAVE_UP, run.exploration->explanation());
    return;
  }
  run.result.status = LearnObjectResult::DONE;
  run.result.explanation = "knows " + std::to_string(run.options.cases) +
                           " cases, each practised " + std::to_string(run.options.practices) +
                           " times";
}

bool LearnerNode::begin(Run& run) {
  if (!run.exploration->next()) {
    return true;
  }
  {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    shown_object_ = run.object_id;
  }
  if (!waitForExecutor()) {
    return run.fail(LearnObjectResult::EXECUTOR_GONE, "action execute_push does not answer");
  }
  run.teleport = canTeleport();
  if (parameters_.reset == ResetMode::kTeleport && !run.teleport) {
    return run.fail(LearnObjectResult::FAILED, "reset is teleport, but there is no service " +
                                                   std::string(names::kSetPoseService));
  }
  const auto any = [](const ObjectState& /*object*/) { return true; };
  if (!objects_.wait(run.object_id, any, kSeenPatienceS, [this] { return shouldEnd(); })) {
    return run.fail(LearnObjectResult::FAILED,
                    run.object_id + " has not been seen (topic objects)");
  }
  run.map_T_home = parameters_.home.value_or(objects_.find(run.object_id)->map_T_object);
  return run.teleport || findGround(run);
}

bool LearnerNode::shouldEnd() { return !ros::ok() || server_.isPreemptRequested(); }

bool LearnerNode::canTeleport() {
  return parameters_.reset != ResetMode::kDrive && set_pose_.exists();
}

bool LearnerNode::waitForChange(const std::function<bool()>& condition) {
  // Nothing of the action client is called with the mutex held: its thread takes it in callbacks.
  std::unique_lock<std::mutex> lock(state_mutex_);
  return state_changed_.wait_for(lock, kLook, condition);
}

bool LearnerNode::waitForExecutor() {
  const std::chrono::steady_clock::time_point end =
      std::chrono::steady_clock::now() + kExecutorPatience;
  while (!execute_push_.isServerConnected()) {
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
  const bool seen =
      objects_.wait(run.object_id, stands_there, kSeenPatienceS, [this] { return shouldEnd(); });
  return seen ? "" : run.object_id + " is not seen where it was put";
}

std::optional<PushReport> LearnerNode::execute(Run& run, const Exploration::Trial& trial) {
  ExecutePushGoal goal;
  goal.object_id = run.object_id;
  goal.case_id = trial.case_id.value_or(0);
  goal.configuration = toMessage(trial.configuration);
  for (run.refusals = 0; run.refusals < kRefusals; ++run.refusals) {
    publishProgress(run, trial);
    const std::string problem = reset(run, trial);
    if (shouldEnd()) {
      run.fail(LearnObjectResult::CANCELLED, "cancelled; finished pushes are kept");
      return std::nullopt;
    }
    if (!problem.empty()) {
      run.fail(LearnObjectResult::FAILED, problem);
      ROS_WARN("reset: %s", problem.c_str());
      continue;
    }
    const std::optional<ExecutePushResult> result = call(goal, run);
    if (!result) {
      return std::nullopt;
    }
    if (result->status == ExecutePushResult::EXECUTED) {
      return fromMessage(result->report);
    }
    // The executor may not have heard of a case that was stored a moment ago.
    run.fail(LearnObjectResult::FAILED, "execute_push: " + result->explanation);
  }
  return std::nullopt;
}

std::optional<ExecutePushResult> LearnerNode::call(const ExecutePushGoal& goal, Run& run) {
  {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    push_done_ = false;
  }
  execute_push_.sendGoal(goal, [this](const actionlib::SimpleClientGoalState& /*state*/,
                                      const ExecutePushResultConstPtr& /*result*/) {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    push_done_ = true;
    state_changed_.notify_all();
  });
  while (!waitForChange([this] { return push_done_; })) {
    if (shouldEnd()) {
      execute_push_.cancelGoal();
      run.fail(LearnObjectResult::CANCELLED, "cancelled; finished pushes are kept");
      return std::nullopt;
    }
    if (!execute_push_.isServerConnected()) {
      run.fail(LearnObjectResult::EXECUTOR_GONE, "action execute_push went away");
      return std::nullopt;
    }
  }
  const ExecutePushResultConstPtr result = execute_push_.getResult();
  return result == nullptr ? ExecutePushResult() : *result;
}

void LearnerNode::store(Run& run, const Exploration::Trial& trial, const PushReport& report) {
  {
    const std::lock_guard<std::mutex> lock(base_mutex_);
    const PushGround* ground = run.ground ? &*run.ground : nullptr;
    if (!keep(*run.exploration, trial, report, base_,
              {parameters_.adapting.floor, parameters_.context}, ground)) {
      ROS_DEBUG("push not kept: %s %s", toString(report.outcome), report.explanation.c_str());
      return;
    }
  }
  publishCases();
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
