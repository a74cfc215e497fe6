#include "push_pool.h"

#include <algorithm>

#include "casepush/common/random.h"
#include "room_builder.h"

namespace casepush {
namespace {

constexpr char kObjectId[] = "object";
constexpr double kOpenHalfM = 8.0;
constexpr double kWalledHalfM = 5.0;
constexpr double kPushLimitS = 180.0;
// Pushes under way ahead of the one that is judged, for each thread.
constexpr int kAheadPerJob = 2;

/// The robot is put right behind where a push starts, so its approach is a straight line.
RobotPath straightPath(const Observation& observation, const Pose2& goal,
                       double /*dock_direction_rad*/) {
  RobotPath path;
  path.found = true;
  path.waypoints = {observation.map_T_robot, goal};
  path.length_m = distance(observation.map_T_robot, goal);
  return path;
}

}  // namespace

void addWalls(WorldModel& world, double half_m) {
  const double at = half_m - 0.5 * kWall_m;
  const double inside = 2.0 * (half_m - kWall_m);
  world.boxes.push_back(wall("wall_south", 2.0 * half_m, kWall_m, 0.0, -at));
  world.boxes.push_back(wall("wall_north", 2.0 * half_m, kWall_m, 0.0, at));
  world.boxes.push_back(wall("wall_west", kWall_m, inside, -at, 0.0));
  world.boxes.push_back(wall("wall_east", kWall_m, inside, at, 0.0));
}

WorldModel learningArena(const std::string& object, const std::string& robot, bool walls) {
  const double half_m = walls ? kWalledHalfM : kOpenHalfM;
  WorldModel world;
  world.name = "arena";
  world.min_m = {-half_m, -half_m};
  world.max_m = {half_m, half_m};
  world.robot = robot;
  world.map_T_robot = Pose2(-2.0, 0.0, 0.0);
  world.objects.push_back({kObjectId, object, Pose2(), 0});
  if (walls) {
    addWalls(world, half_m);
  }
  return world;
}

LabOptions loadedLab(const LearningOptions& options, const std::string& object_id) {
  LabOptions lab = options.lab;
  if (options.load) {
    lab.simulator.loads[object_id] = *options.load;
  }
  return lab;
}

ExecutePush makePush(const std::string& object_id, const Exploration::Trial& trial,
                     const std::optional<Case>& push_case, const RobotModel& robot,
                     const ApproachPlanner& approach, const ExecutePushOptions& options) {
  return push_case ? ExecutePush(object_id, *push_case, robot, approach, options)
                   : ExecutePush(object_id, trial.configuration, robot, approach, options);
}

PushReport runPush(ClosedLoop& loop, ExecutePush push) {
  loop.run(push, kPushLimitS);
  if (!push.report()) {
    push.cancel();
    push.tick(loop.observe());
  }
  return *push.report();
}

PushPool::PushPool(const Catalog& catalog, const std::string& object, const std::string& robot,
                   const LearningOptions& options)
    : options_(options) {
  const WorldModel world = learningArena(object, robot, false);
  for (int i = 0; i < options_.jobs; ++i) {
    loops_.push_back(std::make_unique<ClosedLoop>(catalog, world, loadedLab(options_, kObjectId)));
  }
  for (int i = 0; options_.jobs > 1 && i < options_.jobs; ++i) {
    threads_.emplace_back([this, &loop = *loops_[i]] { work(loop); });
  }
}

PushPool::~PushPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

PushPool::Result PushPool::execute(ClosedLoop& loop, const Task& task) const {
  const std::string name =
      "push " + std::to_string(task.trial.serial) + "." + std::to_string(task.trial.repetition);
  loop.reset(Random::stream(options_.lab.simulator.seed, name).bits());
  loop.place({{kObjectId, Pose2()}, {"robot", task.trial.object_T_reset}});
  const std::optional<Case> push_case =
      task.push_case ? std::optional<Case>(*task.push_case) : std::nullopt;
  Result result;
  result.report = runPush(loop, makePush(kObjectId, task.trial, push_case, loop.simulator().robot(),
                                         straightPath, options_.push));
  result.sim_time_s = loop.simulator().time();
  return result;
}

void PushPool::work(ClosedLoop& loop) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
    if (ended_) {
      return;
    }
    const Task task = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    Result result = execute(loop, task);
    lock.lock();
    // Nobody waits any more for practices of a case that was dropped.
    const auto entry = results_.find({task.trial.serial, task.trial.repetition});
    if (entry != results_.end()) {
      entry->second = std::move(result);
    }
    changed_.notify_all();
  }
}

void PushPool::enqueue(const Task& task) {
  const Key key{task.trial.serial, task.trial.repetition};
  if (results_.emplace(key, std::nullopt).second) {
    waiting_.push_back(task);
    changed_.notify_all();
  }
}

PushPool::Result PushPool::run(const Exploration::Trial& trial,
                               const std::optional<Case>& push_case) {
  Task task{trial, push_case ? std::make_shared<const Case>(*push_case) : nullptr};
  if (threads_.empty()) {
    return execute(*loops_.front(), task);
  }
  const Key key{trial.serial, trial.repetition};
  std::unique_lock<std::mutex> lock(mutex_);
  if (results_.count(key) == 0) {
    // Another case, or a first trial: what is left over is not wanted.
    waiting_.clear();
    results_.clear();
  }
  enqueue(task);
  // The first push of a transferred case replaces its trajectories: those after it wait for them.
  const bool is_settled = push_case && push_case->observation_count > 0;
  const int left = is_settled ? options_.exploration.practices - trial.practice_number : 0;
  for (int i = 0; i < std::min(left, kAheadPerJob * options_.jobs); ++i) {
    ++task.trial.repetition;
    enqueue(task);
  }
  changed_.wait(lock, [&] { return results_.at(key).has_value(); });
  Result result = std::move(*results_.at(key));
  results_.erase(key);
  return result;
}

}  // namespace casepush
