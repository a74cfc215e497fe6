#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "approach_check.h"
#include "case_set.h"
#include "casepush/planning/push_checker.h"
#include "casepush/planning/push_planner.h"
#include "disposal.h"
#include "goal_guide.h"
#include "plan_request.h"
#include "plan_search.h"
#include "scene_library.h"
#include "search_spaces.h"
#include "sweep_library.h"

namespace casepush {

/// What PushPlanner keeps. Copies share all but the options; those for another map are made in
/// planner_data.cpp. Plans are made in push_planner.cpp, ways cleared in way_clearing.cpp.
struct PushPlanner::Data {
  struct Footprints {
    std::shared_ptr<const Footprint> exact;
    std::shared_ptr<const Footprint> grown;
    std::shared_ptr<const SweepChecker> sweeps;  ///< Of the grown object and the robot on the map.
  };

  std::shared_ptr<const Map> map;
  RobotModel robot;
  ObjectModels objects;
  PushPlannerOptions options;
  CollisionChecker checker;
  RobotPathPlanner paths;
  std::shared_ptr<const Footprint> robot_footprint;
  std::map<std::string, Footprints> footprints;
  std::shared_ptr<Disposal> disposal;
  std::shared_ptr<SweepLibrary> library;
  std::shared_ptr<ApproachLibrary> approaches;
  std::shared_ptr<CaseSetLibrary> case_sets;
  std::shared_ptr<SearchSpaces> spaces;
  std::shared_ptr<const ClearanceGrid> travel;
  std::shared_ptr<RoomLibrary> rooms;
  std::shared_ptr<SceneLibrary> scenes;

  Data(std::shared_ptr<const Map> new_map, RobotModel new_robot, ObjectModels new_objects,
       const PushPlannerOptions& all);

  /// Takes over a newer map of the same resolution that differs only within an area.
  void update(std::shared_ptr<const Map> newer, const CollisionChecker::Area& changed);

  CollisionChecker checkerWith(const std::vector<PlacedSolid>& obstacles) const {
    CollisionChecker copy = checker;
    copy.setObstacles(obstacles);
    return copy;
  }

  PushChecker pushChecker(const std::string& model,
                          const std::vector<PlacedSolid>& obstacles) const {
    return pushChecker(model, footprints.at(model).sweeps->withObstaclesOf(checkerWith(obstacles)));
  }
  PushChecker pushChecker(const std::string& model, SweepChecker sweeps) const {
    return PushChecker(
        std::move(sweeps),
        {footprints.at(model).grown, objects.at(model).radius_m + options.object_margin_m},
        {robot_footprint, robot.radius_m + options.robot_margin_m});
  }

  /// A search's problem; `request`, `cases`, `obstacles` and this must outlive it.
  SearchProblem problem(const PlanRequest& request, const std::vector<const Case*>& cases,
                        const std::vector<PlacedSolid>& obstacles) const;
  /// What came of one level of safety.
  struct Attempt {
    PlanResult result;
    bool is_worth_relaxing = false;  ///< A lesser level may have a plan, or a finer search.
  };
  Attempt search(const PlanRequest& request, const std::vector<const Case*>& cases,
                 const SearchClock& clock) const;
  Attempt searchLevels(const SearchProblem& problem, PushChecker* push_checker, GoalGuide* guide,
                       const SearchClock& clock) const;
  Attempt searchLevel(const SearchProblem& problem, PushChecker* push_checker,
                      const SafetyLevel& safety, GoalGuide* guide, const SearchClock& clock) const;
  PlanResult searchFinestLast(const PlanRequest& request, const std::vector<const Case*>& cases,
                              const SearchClock& clock) const;
  void searchAgain(const PlanRequest& request, const std::vector<const Case*>& cases,
                   const SearchClock& clock, PlanResult* result) const;
  void improve(const PlanRequest& request, const std::vector<const Case*>& cases,
               const SearchClock& clock, PlanResult* result) const;
  ClearingResult clearAway(const ClearingRequest& request, const PlanRequest& plan_request,
                           const std::vector<const Case*>& own, const std::vector<Case>& cases,
                           const SearchClock& clock) const;
  bool mayGetStuck(const PushPlan& plan, const std::vector<Case>& cases,
                   const std::vector<PlacedObject>& obstacles,
                   const std::vector<PlacedSolid>& placed, PushChecker* push_checker) const;
  void chain(const std::vector<Case>& cases, PushChecker* push_checker, Continuation* rest) const;
};

}  // namespace casepush
