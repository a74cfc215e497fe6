#!/usr/bin/env python3
"""How long the base goes on after something went wrong. Times are simulated ones at real-time
factor 1."""

import bisect
import sys

import rospy
import rostest

import drill
import harness
from casepush.msg import BodyContactArray, ExecutePushGoal

# Within this time after the event nothing but zero is commanded any more.
REACTION_S = 0.2
# And the base, which brakes with 150 N at most, stands within this time after that.
BRAKING_S = 0.15
# Without any sight of the object a push goes on for so long: two images of a camera (15 Hz, 0.05 s
# late) may be lost.
BLIND_PUSH_S = 0.3
# For the scheduling of a busy machine.
SLACK_S = 0.1


class StopTimesTest(drill.Drill):

    def start_push(self, phase="approach"):
        self.start(self.execute_push, ExecutePushGoal(object_id=harness.OBJECT, case_id=2))
        self.wait_phase(phase)
        self.commands.clear()
        self.wait_moving()

    def expect_stop(self, name, event_s, within_s=REACTION_S, brakes_itself=False):
        """`event_s`: simulated time."""
        end_s = event_s + within_s + 1.0
        harness.wait_until(lambda: self.now() > end_s, what="time to pass")
        motion = self.motion.all()
        arrivals = [stamp for stamp, _ in motion]

        def simulated(wall):
            return motion[max(0, bisect.bisect(arrivals, wall) - 1)][1].header.stamp.to_sec()

        commanded = [simulated(wall) - event_s for wall, m in self.commands.all()
                     if not harness.is_zero(m)]
        moved = [m.header.stamp.to_sec() - event_s for _, m in motion
                 if drill.moves(m.twist.twist)]
        self.assertTrue(commanded and moved)
        rospy.loginfo("stop time: %s: %.2f s commanded, %.2f s in motion", name,
                      max(0.0, commanded[-1]), max(0.0, moved[-1]))
        if not brakes_itself:
            self.assertLess(commanded[-1], within_s + SLACK_S)
        self.assertLess(moved[-1], within_s + BRAKING_S + SLACK_S)

    def test_after_a_cancelled_goal(self):
        self.start_push()
        event_s = self.now()
        self.execute_push.cancel_goal()
        self.expect_stop("cancelled", event_s)

    def test_after_the_service_stop(self):
        self.start_push("push")
        event_s = self.now()
        self.stop()
        self.expect_stop("service stop", event_s)

    def test_when_tf_freezes(self):
        self.start_push()
        event_s = self.now()
        self.relay.tf_frozen = True
        self.expect_stop("TF frozen", event_s)

    def test_when_perception_stands_still(self):
        self.start_push("push")
        event_s = self.now()
        with drill.suspended("perception_node"):
            self.expect_stop("perception stands still", event_s)

    def test_when_perception_and_tf_fall_silent_together(self):
        self.start_push("push")
        event_s = self.now()
        with drill.suspended("perception_node"):
            self.relay.tf_frozen = True
            self.expect_stop("perception and TF", event_s)

    def test_when_the_object_is_out_of_sight_during_a_push(self):
        self.start_push("push")
        event_s = self.now()
        self.relay.hidden = True
        self.expect_stop("object out of sight", event_s, BLIND_PUSH_S)

    def test_when_the_cameras_fall_silent_during_a_push(self):
        self.start_push("push")
        event_s = self.now()
        self.relay.images_frozen = True
        self.expect_stop("no images", event_s, BLIND_PUSH_S)

    def test_when_the_executor_dies(self):
        self.start_push("push")
        event_s = self.now()
        drill.kill("executor_node")
        self.expect_stop("executor killed", event_s, brakes_itself=True)
        self.await_nodes()

    def test_when_the_executor_stands_still(self):
        self.start_push("push")
        event_s = self.now()
        with drill.suspended("executor_node"):
            self.expect_stop("executor stands still", event_s, brakes_itself=True)

    def test_when_something_unknown_is_in_the_way(self):
        contacts = harness.Recorder("contacts", BodyContactArray)
        self.bar_the_way()
        self.start_push()
        contacts.wait(lambda m: any("box_1" in (c.body_a, c.body_b) for c in m.contacts))
        event_s = self.now()
        self.expect_stop("something in the way", event_s)
        self.assertIn("holds the robot", harness.result_of(self.execute_push).explanation)


if __name__ == "__main__":
    rospy.init_node("stop_times_test")
    rostest.rosrun("casepush", "stop_times", StopTimesTest, sys.argv)
