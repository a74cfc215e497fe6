#pragma once

#include <actionlib/server/action_server.h>
#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace casepush {

/// Serves an action, one goal at a time, in a thread of its own. A new goal asks the one under way
/// to end, and takes the place of one that still waits.
///
/// Like actionlib's SimpleActionServer, which drops goals with older stamps than the last one's:
/// that is deaf after the clock has jumped back, as when a simulator is started again.
/// Thread safety: all members; results and feedback are for the thread that executes.
template <typename ActionSpec>
class GoalServer {
 public:
  ACTION_DEFINITION(ActionSpec)
  using Execute = std::function<void(const GoalConstPtr&)>;

  /// @param execute  Ends its goal by one of the functions setSucceeded, setAborted, setPreempted.
  GoalServer(ros::NodeHandle handle, const std::string& name, Execute execute)
      : execute_(std::move(execute)),
        server_(
            handle, name, [this](GoalHandle goal) { onGoal(std::move(goal)); },
            [this](GoalHandle goal) { onCancel(std::move(goal)); }, false) {}

  ~GoalServer() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
      must_end_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  GoalServer(const GoalServer&) = delete;
  GoalServer& operator=(const GoalServer&) = delete;

  void start() {
    thread_ = std::thread([this] { run(); });
    server_.start();
  }

  bool isActive() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return current_.has_value();
  }

  /// The goal under way should end: it was cancelled, or a newer one waits.
  bool isPreemptRequested() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return must_end_;
  }

  void publishFeedback(const Feedback& feedback) {
    if (std::optional<GoalHandle> goal = current()) goal->publishFeedback(feedback);
  }
  void setSucceeded(const Result& result, const std::string& text) {
    if (std::optional<GoalHandle> goal = release()) goal->setSucceeded(result, text);
  }
  void setAborted(const Result& result, const std::string& text) {
    if (std::optional<GoalHandle> goal = release()) goal->setAborted(result, text);
  }
  void setPreempted(const Result& result, const std::string& text) {
    if (std::optional<GoalHandle> goal = release()) goal->setCanceled(result, text);
  }

 private:
  using Server = actionlib::ActionServer<ActionSpec>;
  using GoalHandle = typename Server::GoalHandle;

  // No call of a handle is made with the mutex held: handles have a lock of their own.
  void onGoal(GoalHandle goal) {
    std::optional<GoalHandle> replaced;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      replaced = std::exchange(next_, std::move(goal));
      must_end_ = current_.has_value();
    }
    if (replaced) replaced->setCanceled(Result(), "a newer goal came before it was begun");
    changed_.notify_all();
  }

  void onCancel(GoalHandle goal) {
    bool waits = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      waits = next_ && *next_ == goal;
      if (waits) next_.reset();
      must_end_ = must_end_ || (current_ && *current_ == goal);
    }
    if (waits) goal.setCanceled(Result(), "cancelled before it was begun");
  }

  void run() {
    while (std::optional<GoalHandle> goal = waitForGoal()) {
      goal->setAccepted();
      execute_(goal->getGoal());
      setAborted(Result(), "the goal was left without a result");
    }
  }

  std::optional<GoalHandle> waitForGoal() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return next_ || ending_; });
    if (ending_) return std::nullopt;
    current_ = std::exchange(next_, std::nullopt);
    must_end_ = false;
    return current_;
  }

  std::optional<GoalHandle> current() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return current_;
  }

  std::optional<GoalHandle> release() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(current_, std::nullopt);
  }

  Execute execute_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<GoalHandle> current_;  ///< Being executed.
  std::optional<GoalHandle> next_;     ///< Waits for its turn.
  bool must_end_ = false;
  bool ending_ = false;
  std::thread thread_;
  Server server_;
};

}  // namespace casepush
