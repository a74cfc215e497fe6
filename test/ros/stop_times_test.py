#!/usr/bin/env python3
"""How long the base goes on after something went wrong. Times are simulated ones at real-time
factor 1. Other programs on the machine can only make them longer, so the best of a few tries
counts."""

import bisect
import contextlib
import pathlib
import subprocess
import sys
import tempfile

import rospy
import rostest

import drill
import harness
from casepush.msg import BodyContactArray, ExecutePushGoal, Octomap

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
# A watchdog stops the base if ticks cease for 0.12 s.
MOST_SILENT_S = 0.1
# A large map: a hall with pillars, which fill a twentieth of it.
HALL_M = 50
PILLARS_EVERY_M = 1.0
RESOLUTION_M = 0.05


def large_map():
    """As planner_node would publish it."""
    cells = int(HALL_M / RESOLUTION_M)
    every = int(PILLARS_EVERY_M / RESOLUTION_M)
    # No pillars around the origin, where the tests are.
    free = range(cells // 2 - 6 * every, cells // 2 + 6 * every)
    rows = bytearray()
    for y in range(cells):
        rows += bytes(0 if x % every < 4 and y % every < 5 and not (x in free and y in free)
                      else 255 for x in range(cells))
    with tempfile.TemporaryDirectory() as folder:
        hall = pathlib.Path(folder)
        (hall / "hall.pgm").write_bytes(b"P5 %d %d 255\n" % (cells, cells) + rows)
        (hall / "hall.yaml").write_text(
            f"image: hall.pgm\nresolution: {RESOLUTION_M}\norigin: [{-HALL_M / 2}, "
            f"{-HALL_M / 2}, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n")
        subprocess.run([harness.node_path("casepush"), "map", "convert", hall / "hall.yaml",
                        hall / "hall.bt"], check=True, capture_output=True)
        data = (hall / "hall.bt").read_bytes().split(b"data\n", 1)[1]
    message = Octomap(binary=True, id="OcTree", resolution=RESOLUTION_M)
    message.header.frame_id = "map"
    message.data = [byte - 256 if byte > 127 else byte for byte in data]
    return message


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

    def test_goes_on_when_a_large_map_comes(self):
        usual, large = self.map.last(), large_map()
        maps = rospy.Publisher("map/octomap", Octomap, queue_size=1)
        harness.wait_until(lambda: maps.get_num_connections() >= 3, what="the nodes to listen")
        for _ in range(TRIES):
            self.push()
            event_s = self.now()
            maps.publish(large)
            harness.wait_until(lambda: self.now() > event_s + 0.8, what="time to pass")
            commands = self.commands.all()
            gap_s = max(b - a for (a, _), (b, _) in zip(commands, commands[1:]))
            stops = sum(harness.is_zero(m) for _, m in commands)
            rospy.loginfo("%s: no command for %.2f s, %d times zero", self._testMethodName, gap_s,
                          stops)
            self.tearDown()
            maps.publish(usual)
            self.setUp()
            if stops == 0 and gap_s < MOST_SILENT_S:
                return
        self.fail(f"no command for {gap_s:.2f} s, {stops} times zero")


if __name__ == "__main__":
    rospy.init_node("stop_times_test")
    rostest.rosrun("casepush", "stop_times", StopTimesTest, sys.argv)
