#!/usr/bin/env python3
"""How long the base goes on after something went wrong. Times are simulated ones at real-time
factor 1. Other programs on the machine can only make them longer, so the best of a few tries
counts."""

import bisect
import contextlib
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
TRIES = 4


class StopTimesTest(drill.Drill):

    def start_push(self, phase):
        self.start(self.execute_push, ExecutePushGoal(object_id=harness.OBJECT, case_id=2))
        self.wait_phase(phase)
        self.commands.clear()
        self.wait_moving()

    def drive(self):
        self.start_push("approach")

    def push(self):
        self.place(robot=(-1.0, -1.2, 0.8))
        self.start_push("push")

    def drive_into_the_box(self):
        contacts = harness.Recorder("contacts", BodyContactArray)
        self.bar_the_way()
        self.start_push("approach")
        contacts.wait(lambda m: any("box_1" in (c.body_a, c.body_b) for c in m.contacts))

    def stop_times(self, event_s, within_s):
        """Simulated time from the event until the last command that is not zero and until the last
        motion."""
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
        return max(0.0, commanded[-1]), max(0.0, moved[-1])

    def expect_stop(self, begin, event, within_s=REACTION_S, brakes_itself=False):
        """`begin` gets the robot moving. `event` makes something go wrong, and returns the context
        that makes it well again, if it does not end by itself."""
        for _ in range(TRIES):
            begin()
            event_s = self.now()
            with event() or contextlib.nullcontext():
                commanded_s, moved_s = self.stop_times(event_s, within_s)
            rospy.loginfo("%s: %.2f s commanded, %.2f s in motion", self._testMethodName,
                          commanded_s, moved_s)
            # Whatever is commanded to a base without an executor: it brakes by itself.
            if ((brakes_itself or commanded_s < within_s + SLACK_S) and
                    moved_s < within_s + BRAKING_S + SLACK_S):
                return
            self.tearDown()
            self.setUp()
        self.fail(f"stops {moved_s:.2f} s after it should")

    def freeze_tf(self):
        self.relay.tf_frozen = True

    def freeze_tf_and_perception(self):
        self.freeze_tf()
        return drill.suspended("perception_node")

    def hide_the_object(self):
        self.relay.hidden = True

    def freeze_images(self):
        self.relay.images_frozen = True

    def kill_the_executor(self):
        drill.kill("executor_node")

    def test_after_a_cancelled_goal(self):
        self.expect_stop(self.drive, self.execute_push.cancel_goal)

    def test_after_the_service_stop(self):
        self.expect_stop(self.push, lambda: self.stop() and None)

    def test_when_tf_freezes(self):
        self.expect_stop(self.drive, self.freeze_tf)

    def test_when_perception_stands_still(self):
        self.expect_stop(self.push, lambda: drill.suspended("perception_node"))

    def test_when_perception_and_tf_fall_silent_together(self):
        self.expect_stop(self.push, self.freeze_tf_and_perception)

    def test_when_the_object_is_out_of_sight_during_a_push(self):
        self.expect_stop(self.push, self.hide_the_object, BLIND_PUSH_S)

    def test_when_the_cameras_fall_silent_during_a_push(self):
        self.expect_stop(self.push, self.freeze_images, BLIND_PUSH_S)

    def test_when_the_executor_dies(self):
        self.expect_stop(self.push, self.kill_the_executor, brakes_itself=True)
        self.await_nodes()

    def test_when_the_executor_stands_still(self):
        self.expect_stop(self.push, lambda: drill.suspended("executor_node"), brakes_itself=True)

    def test_when_something_unknown_is_in_the_way(self):
        self.expect_stop(self.drive_into_the_box, lambda: None)
        self.assertIn("holds the robot", harness.result_of(self.execute_push).explanation)


if __name__ == "__main__":
    rospy.init_node("stop_times_test")
    rostest.rosrun("casepush", "stop_times", StopTimesTest, sys.argv)
