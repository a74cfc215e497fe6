// An object that was put behind a partition, out of the robot's sight, is found again.

#include <gtest/gtest.h>

#include "casepush/execution/object_search.h"
#include "casepush/lab/closed_loop.h"
#include "casepush/lab/push_run.h"
#include "casepush/planning/push_planner.h"

namespace casepush {
namespace {

// The chair stands on the robot's side of the office's south partition, 0.6 m from it.
constexpr double kPartitionX_m = 7.2;
const Pose2 kSeenAt(kPartitionX_m - 0.6, 3.6, 0.0);
const Pose2 kRobotAt(kPartitionX_m - 2.2, 3.4, 0.0);

class ObjectSearchInRoomTest : public testing::TestWithParam<Pose2> {
 protected:
  ObjectSearchInRoomTest() {
    LabOptions options;
    options.simulator.caster_model = CasterModel::kPlanar;
    loop_.emplace(catalog_, world_, options);
    planner_.emplace(surveyMap(world_), loop_->simulator().robot(), catalog_.objectsIn(world_),
                     PushPlannerOptions());
  }

  const Catalog catalog_ = Catalog::standard();
  const WorldModel world_ = catalog_.world("office");
  std::optional<ClosedLoop> loop_;
  std::optional<PushPlanner> planner_;
};

TEST_P(ObjectSearchInRoomTest, findsTheChairAgain) {
  loop_->place({{"robot", kRobotAt}, {"chair_1", kSeenAt}});
  const Observation before = loop_->observe();
  ASSERT_NE(before.object("chair_1"), nullptr);
  const Pose2 hidden = GetParam();
  loop_->simulator().setPoses({{"chair_1", hidden}});
  loop_->idle(1.5);
  const Observation after = loop_->observe();
  const ObjectState* lost = after.object("chair_1");
  ASSERT_NE(lost, nullptr);
  ASSERT_GT(after.stamp_s - lost->stamp_s, 1.0) << "the chair is still in sight";

  ObjectSearch search(*lost, loop_->simulator().robot(), approachPlanner(*planner_, "chair_1"),
                      ObjectSearchOptions());
  const double began_s = loop_->simulator().time();
  EXPECT_EQ(loop_->run(search, 120.0), BehaviourStatus::kSucceeded) << search.describe();
  EXPECT_LT(loop_->simulator().time() - began_s, 60.0);
  EXPECT_EQ(loop_->collisions(), 0);
  loop_->idle(1.0);
  EXPECT_LT(distance(loop_->observe().object("chair_1")->map_T_object, hidden), 0.05);
}

// 1.2 m and 2 m away, behind the partition.
INSTANTIATE_TEST_SUITE_P(BehindThePartition, ObjectSearchInRoomTest,
                         testing::Values(Pose2(kPartitionX_m + 0.6, 3.6, 0.5),
                                         Pose2(kPartitionX_m + 0.9, 2.3, -2.0)));

}  // namespace
}  // namespace casepush
