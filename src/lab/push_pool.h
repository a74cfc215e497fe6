#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "casepush/lab/learning.h"

namespace casepush {

/// The world in which objects are learnt, with or without walls; the object is called "object".
WorldModel learningArena(const std::string& object, const std::string& robot, bool walls);

/// Walls around a square from -half_m to half_m in x and y.
void addWalls(WorldModel& world, double half_m);

/// The lab's options with the load that the object carries while it is learnt.
LabOptions loadedLab(const LearningOptions& options, const std::string& object_id);

/// The behaviour that a trial asks for.
ExecutePush makePush(const std::string& object_id, const Exploration::Trial& trial,
                     const std::optional<Case>& push_case, const RobotModel& robot,
                     const ApproachPlanner& approach, const ExecutePushOptions& options);

/// Runs the behaviour to its end; a push that never ends is cancelled.
PushReport runPush(ClosedLoop& loop, ExecutePush push);

/// Executes trials, each in a simulation of its own, in several threads.
///
/// While a practice is judged the next ones of the same case are under way already. What a push
/// brings depends on the learning's seed and the trial's serial and repetition only, so the number
/// of threads changes nothing but time.
class PushPool {
 public:
  PushPool(const Catalog& catalog, const std::string& object, const std::string& robot,
           const LearningOptions& options);
  ~PushPool();
  PushPool(const PushPool&) = delete;
  PushPool& operator=(const PushPool&) = delete;

  struct Result {
    PushReport report;
    double sim_time_s = 0.0;
  };
  /// @param push_case   For a practice.
  Result run(const Exploration::Trial& trial, const std::optional<Case>& push_case);

  const ObjectModel& object() const { return loops_.front()->simulator().object("object"); }
  const RobotModel& robot() const { return loops_.front()->simulator().robot(); }

 private:
  using Key = std::pair<int, int>;  ///< Serial and repetition.
  struct Task {
    Exploration::Trial trial;
    std::shared_ptr<const Case> push_case;
  };
  Result execute(ClosedLoop& loop, const Task& task) const;
  void work(ClosedLoop& loop);
  void enqueue(const Task& task);

  LearningOptions options_;
  std::vector<std::unique_ptr<ClosedLoop>> loops_;

  std::mutex mutex_;  ///< Guards the following.
  std::condition_variable changed_;
  std::deque<Task> waiting_;
  std::map<Key, std::optional<Result>> results_;  ///< Empty while under way.
  bool ended_ = false;

  std::vector<std::thread> threads_;  ///< None for a single job.
};

}  // namespace casepush
