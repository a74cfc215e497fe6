#include <gtest/gtest.h>

#include "casepush/common/input_error.h"
#include "planning/planner_fixture.h"

namespace casepush {
namespace {

/// The same search on the same map leaves the same numbers behind.
void expectSame(const PlanResult& a, const PlanResult& b) {
  ASSERT_EQ(a.status, b.status) << a.explanation << " / " << b.explanation;
  EXPECT_EQ(a.explanation, b.explanation);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.collision_checks, b.collision_checks);
  EXPECT_EQ(a.expected_s, b.expected_s);
  ASSERT_EQ(a.plan.pushes.size(), b.plan.pushes.size());
  for (std::size_t i = 0; i < a.plan.pushes.size(); ++i) {
    EXPECT_EQ(a.plan.pushes[i].case_id, b.plan.pushes[i].case_id);
    EXPECT_EQ(a.plan.pushes[i].map_outcome.mean.x(), b.plan.pushes[i].map_outcome.mean.x());
  }
}

void expectSame(const RobotPath& a, const RobotPath& b) {
  ASSERT_EQ(a.found, b.found) << a.explanation << " / " << b.explanation;
  EXPECT_EQ(a.explanation, b.explanation);
  EXPECT_EQ(a.length_m, b.length_m);
  EXPECT_EQ(a.waypoints.size(), b.waypoints.size());
}

/// A furnished room in which boxes come and go.
class UpdatedPlanner : public testing::Test {
 protected:
  UpdatedPlanner() : map_(mapOf(furnishedRoom())->copy()), cases_(syntheticPushes(14, 7)) {}

  static std::unique_ptr<PushPlanner> planner(const std::shared_ptr<const Map>& map,
                                              const PushPlannerOptions& options) {
    return std::make_unique<PushPlanner>(
        map, testRobot(), std::map<std::string, ObjectModel>{{"chair", testChair()}}, options);
  }

  std::shared_ptr<const Map> now() const { return std::make_shared<const Map>(map_.copy()); }

  void putBox(double low_m, double high_m) {
    const Eigen::Vector2d corner(random_.uniform(low_m, high_m), random_.uniform(low_m, high_m));
    const double size_m = random_.uniform(0.1, 0.8);
    std::vector<Eigen::Vector3f> points;
    for (double x = 0.0; x < size_m; x += map_.resolution()) {
      for (double y = 0.0; y < size_m; y += map_.resolution()) {
        for (double z = 0.1; z < 0.8; z += map_.resolution()) {
          points.push_back(Eigen::Vector3d(corner.x() + x, corner.y() + y, z).cast<float>());
        }
      }
    }
    map_.addSurvey(points);
  }

  void clearSomething() {
    const Eigen::Vector3d corner(random_.uniform(1.0, 12.0), random_.uniform(1.0, 12.0), 0.0);
    map_.clear({corner, corner + Eigen::Vector3d(2.0, 2.0, 2.0)},
               [](const Eigen::AlignedBox3d&) { return true; });
  }

  PlanRequest request() {
    PlanRequest request = requestFor(kStart, kGoal);
    request.seed = 1 + random_.below(1000);
    request.obstacles = {
        {"chair_2",
         "chair",
         {random_.uniform(6.0, 9.0), random_.uniform(6.0, 9.0), random_.uniform(-3.0, 3.0)}}};
    return request;
  }

  void expectAsAnew(const PushPlanner& updated) {
    const auto anew = planner(now(), updated.options());
    const PlanRequest wanted = request();
    expectSame(updated.plan(wanted, cases_), anew->plan(wanted, cases_));
    const Pose2 dock(random_.uniform(2.0, 13.0), random_.uniform(2.0, 13.0), 0.4);
    expectSame(updated.approachPath(wanted.object, wanted.obstacles, wanted.map_T_robot, dock, 0.4),
               anew->approachPath(wanted.object, wanted.obstacles, wanted.map_T_robot, dock, 0.4));
  }

  Random random_{11};
  Map map_;
  std::vector<Case> cases_;
};

TEST_F(UpdatedPlanner, plansAsOneMadeAnewAfterRandomChanges) {
  auto current = planner(now(), quick());
  current->plan(request(), cases_);  // Fills what is kept from plan to plan.
  for (int i = 0; i < 14; ++i) {
    if (i % 3 == 2) {
      clearSomething();
    } else if (i == 9) {
      putBox(14.0, 15.5);  // Beyond what was known.
    } else {
      putBox(1.0, 13.0);
    }
    current = current->updated(now());
    SCOPED_TRACE(i);
    expectAsAnew(*current);
  }
}

TEST_F(UpdatedPlanner, theLatticeDoesSoToo) {
  PushPlannerOptions options = PushPlannerOptions::forPlanner(PlannerKind::kLattice);
  options.max_nodes = 3000;
  auto current = planner(now(), options);
  for (int i = 0; i < 3; ++i) {
    putBox(2.0, 12.0);
    current = current->updated(now());
    expectAsAnew(*current);
  }
}

TEST_F(UpdatedPlanner, trustsAnAreaThatItIsTold) {
  const auto before = planner(now(), quick());
  const Map old = map_.copy();
  putBox(6.0, 8.0);
  const MapChange change = map_.changeSince(old);
  EXPECT_GT(change.cells, 0);
  expectAsAnew(*before->updated(now(), CollisionChecker::Area{change.where_m.min().head<2>(),
                                                              change.where_m.max().head<2>()}));
}

TEST_F(UpdatedPlanner, theOldOnePlansAsBefore) {
  const auto before = planner(now(), quick());
  const PlanRequest wanted = request();
  const PlanResult first = before->plan(wanted, cases_);
  for (int i = 0; i < 10; ++i) putBox(1.0, 13.0);
  const auto newer = before->updated(now());
  newer->plan(wanted, cases_);
  expectSame(before->plan(wanted, cases_), first);
}

TEST_F(UpdatedPlanner, takesAMapOfAnotherResolution) {
  const auto before = planner(now(), quick());
  Map coarse(0.1);
  coarse.addSurvey(surveyPoints(furnishedRoom(), 0.1));
  const auto shared = std::make_shared<const Map>(std::move(coarse));
  const PlanRequest wanted = request();
  expectSame(before->updated(shared)->plan(wanted, cases_),
             planner(shared, quick())->plan(wanted, cases_));
}

TEST_F(UpdatedPlanner, refusesAnEmptyMap) {
  const auto before = planner(now(), quick());
  EXPECT_THROW(before->updated(std::make_shared<const Map>(0.05)), InputError);
}

TEST_F(UpdatedPlanner, withOtherOptionsPlansAsOneMadeWithThem) {
  const auto first = planner(now(), quick());
  const PlanRequest wanted = request();
  for (const PlannerKind kind : {PlannerKind::kExpRrtPaper, PlannerKind::kLattice}) {
    PushPlannerOptions options = PushPlannerOptions::forPlanner(kind);
    options.max_nodes = 3000;
    expectSame(first->withOptions(options)->plan(wanted, cases_),
               planner(now(), options)->plan(wanted, cases_));
  }
  PushPlannerOptions bad = quick();
  bad.goal_bias = 1.5;
  EXPECT_THROW(first->withOptions(bad), InputError);
}

}  // namespace
}  // namespace casepush
