#include "casepush/ros/demo_node.h"

#include <casepush/SetPoses.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr double kStartPatienceS = 60.0;   // Wall time.
constexpr double kSettlePatienceS = 30.0;  // Wall time.
constexpr double kSettleS = 1.0;           // By the ROS clock.
constexpr double kForeverS = 1e7;
constexpr double kLineEveryS = 5.0;  // Wall time between progress lines.
constexpr double kPlacedM = 0.05;
constexpr double kDegree = M_PI / 180.0;
constexpr std::chrono::milliseconds kLook(50);

void say(const std::string& line) {
  std::printf("demo: %s\n", line.c_str());
  std::fflush(stdout);
}

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string durationText(double duration_s) {
  if (duration_s < 0.0) {
    return "";
  }
  return duration_s < 90.0 ? text(", about %.0f s left", duration_s)
                           : text(", about %.0f min left", duration_s / 60.0);
}

std::optional<ObjectState> find(const PushableObjectArray& message, const std::string& id) {
  for (const PushableObject& object : message.objects) {
    if (object.id == id) {
      return fromMessage(object);
    }
  }
  return std::nullopt;
}

}  // namespace

DemoNode::DemoNode(DemoNodeParameters parameters, ros::NodeHandle handle)
    : parameters_(std::move(parameters)),
      handle_(handle),
      collisions_(parameters_.world),
      learn_(handle, names::kLearnObjectAction, true),
      push_(handle, names::kPushObjectAction, true),
      spinner_(1),
      start_(SteadyClock::now()) {
  truth_subscriber_ = handle_.subscribe<PushableObjectArray>(
      names::kTrueObjects.name, 1, [this](const PushableObjectArray::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        truth_ = find(*message, parameters_.object_id);
        changed_.notify_all();
      });
  objects_subscriber_ = handle_.subscribe<PushableObjectArray>(
      names::kObjects.name, 1, [this](const PushableObjectArray::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        seen_ = find(*message, parameters_.object_id);
        changed_.notify_all();
      });
  contacts_subscriber_ =
      handle_.subscribe<BodyContactArray>(names::kContacts.name, names::kContacts.queue_size,
                                          [this](const BodyContactArray::ConstPtr& message) {
                                            const std::lock_guard<std::mutex> lock(mutex_);
                                            if (counting_) {
                                              collisions_.add(*message);
                                            }
                                          });
  spinner_.start();
}

int DemoNode::run() {
  std::filesystem::create_directories(parameters_.results);
  if (learn() && putBack() && push()) {
    judge();
  }
  say(success_ ? "success: " + explanation_ : "FAILED: " + explanation_);
  writeSummary();
  return success_ ? 0 : 1;
}

double DemoNode::wallSeconds() const {
  return std::chrono::duration<double>(SteadyClock::now() - start_).count();
}

bool DemoNode::wait(const std::function<bool()>& condition, double patience_s,
                    const std::string& what) {
  const double end_s = wallSeconds() + patience_s;
  while (!condition()) {
    if (!ros::ok() || wallSeconds() > end_s) {
      explanation_ = ros::ok() ? "waited in vain for " + what : "interrupted";
      return false;
    }
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kLook);
  }
  return true;
}

bool DemoNode::learn() {
  say("learning how " + parameters_.object_id + " moves when pushed");
  if (!wait([this] { return learn_.isServerConnected() && push_.isServerConnected(); },
            kStartPatienceS, "the actions learn_object and push_object")) {
    return false;
  }
  LearnObjectGoal goal;
  goal.object_id = parameters_.object_id;
  goal.cases = static_cast<std::uint32_t>(parameters_.cases);
  goal.practices = static_cast<std::uint32_t>(parameters_.practices);
  goal.seed = parameters_.seed;
  const double begin_s = wallSeconds();
  learn_.sendGoal(goal, LearnClient::SimpleDoneCallback(), LearnClient::SimpleActiveCallback(),
                  [this](const LearnObjectFeedbackConstPtr& feedback) { showLearning(*feedback); });
  if (!wait([this] { return learn_.getState().isDone() || !learn_.isServerConnected(); }, kForeverS,
            "learning")) {
    return false;
  }
  learn_wall_s_ = wallSeconds() - begin_s;
  if (learn_.getState().isDone() && learn_.getResult() != nullptr) {
    learn_result_ = *learn_.getResult();
  } else {
    learn_result_.status = LearnObjectResult::FAILED;
    learn_result_.explanation = "the learner node is gone";
  }
  explanation_ = "learning: " + learn_result_.explanation;
  say(explanation_ + text(" (%.0f s)", learn_wall_s_));
  return learn_result_.status == LearnObjectResult::DONE;
}

bool DemoNode::putBack() {
  ros::ServiceClient client = handle_.serviceClient<SetPoses>(names::kSetPoseService);
  if (!client.exists()) {
    return true;  // A real robot: the object is pushed from where it stands.
  }
  SetPoses::Request request;
  SetPoses::Response response;
  for (const ObjectPlacement& placement : parameters_.world.objects) {
    BodyPose body;
    body.id = placement.id;
    body.pose = toMessage(placement.map_T_object);
    request.bodies.push_back(body);
  }
  BodyPose robot;
  robot.id = "robot";
  robot.pose = toMessage(parameters_.world.map_T_robot);
  request.bodies.push_back(robot);
  if (!client.call(request, response) || !response.success) {
    explanation_ = "cannot put everything back: " + response.message;
    return false;
  }
  settle();
  return wait(
      [this] {
        const std::lock_guard<std::mutex> lock(mutex_);
        return truth_ && seen_ && !seen_->moving &&
               distance(truth_->map_T_object, seen_->map_T_object) < kPlacedM;
      },
      kSettlePatienceS, "the object to be seen where it stands");
}

void DemoNode::settle() {
  const double end_s = ros::Time::now().toSec() + kSettleS;
  wait([end_s] { return ros::Time::now().toSec() >= end_s; }, kSettlePatienceS, "time to pass");
}

bool DemoNode::push() {
  PushObjectGoal goal;
  goal.object_id = parameters_.object_id;
  goal.goal.header.frame_id = names::kMapFrame;
  goal.goal.pose = toPoseMessage(parameters_.map_T_goal);
  goal.time_limit = parameters_.time_limit_s;
  goal.seed = parameters_.seed;
  goal.adapt = true;
  std::ostringstream line;
  line << "pushing " << parameters_.object_id << " to (" << parameters_.map_T_goal.x() << ", "
       << parameters_.map_T_goal.y() << ") m, " << parameters_.map_T_goal.yaw() / kDegree
       << " degrees";
  say(line.str());
  const double begin_s = wallSeconds();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    counting_ = true;
  }
  push_.sendGoal(goal, PushClient::SimpleDoneCallback(), PushClient::SimpleActiveCallback(),
                 [this](const PushObjectFeedbackConstPtr& feedback) { showPushing(*feedback); });
  if (!wait([this] { return push_.getState().isDone() || !push_.isServerConnected(); }, kForeverS,
            "the push task")) {
    return false;
  }
  push_wall_s_ = wallSeconds() - begin_s;
  if (push_.getState().isDone() && push_.getResult() != nullptr) {
    push_result_ = *push_.getResult();
    explanation_ = push_result_.explanation;
  } else {
    explanation_ = "the executor node is gone";
    return false;
  }
  return true;
}

void DemoNode::judge() {
  settle();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!truth_) {
    explanation_ = "no ground truth came; " + explanation_;
    return;
  }
  position_error_m_ = distance(parameters_.map_T_goal, truth_->map_T_object);
  yaw_error_rad_ = std::abs(yawDifference(parameters_.map_T_goal, truth_->map_T_object));
  const bool at_goal = GoalTolerance().isMet(parameters_.map_T_goal, truth_->map_T_object);
  success_ = at_goal && push_result_.status == PushObjectResult::SUCCEEDED;
  explanation_ += text("; by ground truth %.3f m", position_error_m_) +
                  text(" and %.1f degrees from the goal", yaw_error_rad_ / kDegree);
}

void DemoNode::showLearning(const LearnObjectFeedback& feedback) {
  std::ostringstream line;
  line << "learning case " << feedback.case_number << " of " << feedback.case_count;
  const bool new_case = line.str() != last_line_;
  if (!new_case && wallSeconds() - last_line_wall_s_ < kLineEveryS) {
    return;
  }
  last_line_ = line.str();
  last_line_wall_s_ = wallSeconds();
  line << ", practice " << feedback.practice_number << " of " << feedback.practice_count;
  if (feedback.discarded > 0) {
    line << " (" << feedback.discarded << " useless pushes)";
  }
  say(line.str() + durationText(feedback.time_left));
}

void DemoNode::showPushing(const PushObjectFeedback& feedback) {
  std::ostringstream line;
  if (feedback.push_count == 0) {
    line << feedback.phase;
  } else {
    line << "push " << feedback.push_index << " of " << feedback.push_count;
  }
  if (feedback.replans > 0) {
    line << ", re-planned " << feedback.replans << " times";
  }
  if (line.str() == last_line_) {
    return;
  }
  last_line_ = line.str();
  say(line.str() + text(", %.2f m", feedback.distance_to_goal) +
      text(" and %.0f degrees to go", std::abs(feedback.yaw_to_goal) / kDegree));
}

void DemoNode::writeSummary() const {
  const Pose2& goal = parameters_.map_T_goal;
  const nlohmann::ordered_json summary = {
      {"success", success_},
      {"explanation", explanation_},
      {"object", parameters_.object_id},
      {"world", parameters_.world.name},
      {"seed", parameters_.seed},
      {"goal", {goal.x(), goal.y(), goal.yaw()}},
      {"position_error_m", position_error_m_},
      {"yaw_error_rad", yaw_error_rad_},
      {"pushes", push_result_.pushes},
      {"plans", push_result_.plans},
      {"replans", push_result_.replans},
      {"rejected_predictions", push_result_.rejected_predictions},
      {"plan_length_m", push_result_.plan_length},
      {"sim_time_s", push_result_.duration},
      {"collisions", collisions_.touches().size()},
      {"collision_names", collisions_.touches()},
      {"learning",
       {{"cases", learn_result_.cases},
        {"pushes", learn_result_.pushes},
        {"discarded", learn_result_.discarded},
        {"dropped_cases", learn_result_.dropped},
        {"sim_time_s", learn_result_.duration}}},
      {"timing",
       {{"learning_wall_s", learn_wall_s_},
        {"pushing_wall_s", push_wall_s_},
        {"wall_s", wallSeconds()}}}};
  const std::filesystem::path file = std::filesystem::path(parameters_.results) / "summary.json";
  std::ofstream stream(file);
  stream << summary.dump(2) << "\n";
  if (!stream.flush()) {
    throw InputError(file.string(), "cannot be written");
  }
}

}  // namespace casepush
