#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <queue>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "casepush/execution/push_task.h"
#include "execution/fake_world.h"

namespace casepush::test {

// Cases all around the object, each pushed once in a quiet world, with the scatter that others
// have.
inline const std::vector<Case>& learntCases() {
  static const std::vector<Case> cases = [] {
    std::vector<Case> learnt;
    for (int i = 0; i < 24; ++i) {
      FakeWorld world(500 + i);
      world.noise_m = 0.0;
      world.noise_rad = 0.0;
      PushConfiguration push;
      const double direction = 2.0 * M_PI * (i / 2) / 12.0;
      push.object_T_robot =
          Pose2(0.0, 0.0, direction) * Pose2(-0.66, i % 4 < 2 ? 0.04 : -0.12, 0.0);
      push.duration_s = i % 2 == 0 ? 2.5 : 1.2;
      world.robot = push.object_T_robot;
      ExecutePush trial("chair_1", push, fakeRobot(), detour, ExecutePushOptions{});
      run(trial, world);
      Case push_case = trial.report()->recorded;
      push_case.id = i + 1;
      push_case.start_outcome.covariance =
          Eigen::Vector3d(0.05, 0.05, 0.15).cwiseAbs2().asDiagonal();
      push_case.effective_count = 20;
      learnt.push_back(push_case);
    }
    return learnt;
  }();
  return cases;
}

inline double cost(const Pose2& a, const Pose2& b) {
  return std::hypot(distance(a, b), 0.5 * yawDifference(a, b));
}

// A search over the mean outcomes in open space: always extends the most promising pose.
inline PlanResult searchPlan(const PlanRequest& request) {
  struct Node {
    Pose2 pose;
    int parent;
    int case_index;
    int depth;
  };
  std::vector<Node> nodes{{request.object.map_T_object, -1, -1, 0}};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> open;
  open.push({0.0, 0});
  std::set<std::tuple<long, long, long>> visited;
  Random random(request.seed);
  PlanResult result;
  for (int round = 0; round < 3000 && !open.empty(); ++round) {
    const int best = open.top().second;
    open.pop();
    const Node node = nodes[best];
    if (request.tolerance.isMet(request.map_T_goal, node.pose)) {
      result.status = PlanStatus::kSolved;
      result.plan.object = request.object;
      result.plan.map_T_goal = request.map_T_goal;
      result.plan.tolerance = request.tolerance;
      for (int i = best; nodes[i].parent >= 0; i = nodes[i].parent) {
        const Case& push_case = learntCases()[nodes[i].case_index];
        const Pose2 start = nodes[nodes[i].parent].pose;
        result.plan.pushes.insert(result.plan.pushes.begin(),
                                  {push_case.id, start, transform(start, push_case.start_outcome)});
      }
      return result;
    }
    for (std::size_t c = 0; c < learntCases().size(); ++c) {
      const Pose2 next = node.pose * learntCases()[c].start_outcome.mean;
      if (!visited
               .insert({std::lround(next.x() / 0.08), std::lround(next.y() / 0.08),
                        std::lround(next.yaw() / 0.15)})
               .second) {
        continue;
      }
      nodes.push_back({next, best, static_cast<int>(c), node.depth + 1});
      open.push({2.0 * cost(next, request.map_T_goal) + 0.3 * (node.depth + 1) +
                     random.uniform(0.0, 0.02),
                 static_cast<int>(nodes.size()) - 1});
    }
  }
  result.status = PlanStatus::kUnreachable;
  result.explanation = "the tree was exhausted";
  return result;
}

class FakePlans : public PlanClient {
 public:
  void request(const PlanRequest& request) override {
    requests.push_back(request);
    polls_left = 5;
  }
  std::optional<PlanResult> poll() override {
    if (polls_left < 0 || --polls_left >= 0) {
      return std::nullopt;
    }
    return answer(requests.back());
  }
  void cancel() override { ++cancels; }
  bool isAlive() const override { return alive; }

  std::function<PlanResult(const PlanRequest&)> answer = searchPlan;
  std::vector<PlanRequest> requests;
  int polls_left = -1;
  int cancels = 0;
  bool alive = true;
};

inline PushPlanner::Continuation reanchored(const PushPlan& rest, const Pose2& map_T_object) {
  PushPlanner::Continuation continuation;
  continuation.plan = rest;
  Pose2 pose = map_T_object;
  for (PlannedPush& push : continuation.plan.pushes) {
    push.map_T_start = pose;
    push.map_outcome = transform(pose, learntCases()[push.case_id - 1].start_outcome);
    pose = push.map_outcome.mean;
  }
  continuation.chained = true;
  continuation.applicable = static_cast<int>(rest.pushes.size());
  continuation.valid = rest.tolerance.isMet(rest.map_T_goal, pose);
  continuation.explanation = continuation.valid ? "" : "the rest does not end in the goal any more";
  return continuation;
}

class PushTaskTest : public testing::Test {
 protected:
  PushTaskTest() {
    world.scatter = 0.05;
    goal.object_id = "chair_1";
    goal.map_T_goal = Pose2(2.0, 1.0, 0.5);
    services.plans = &plans;
    services.cases = [cases = std::make_shared<const std::vector<Case>>(learntCases())] {
      return cases;
    };
    services.approach = detour;
    services.continue_plan = [](const PushPlan& rest, const Pose2& pose, const std::vector<Case>&,
                                const std::vector<PlacedObject>&) {
      return reanchored(rest, pose);
    };
    services.on_report = [this](const PushReport& report) { reports.push_back(report); };
    services.on_plan = [this](const PlanResult&) { ++plan_reports; };
  }

  PushTask task() { return {goal, fakeRobot(), services, options}; }

  // Ticks until the task is in a phase of the given name.
  bool runUntil(PushTask& push_task, const std::string& phase) {
    for (int i = 0; i < 20000 && push_task.progress().phase != phase; ++i) {
      world.advance(push_task.tick(world.observe()).command.twist);
    }
    return push_task.progress().phase == phase;
  }

  FakeWorld world{1};
  FakePlans plans;
  PushTaskGoal goal;
  PushTaskServices services;
  PushTaskOptions options;
  std::vector<PushReport> reports;
  int plan_reports = 0;
};

}  // namespace casepush::test
