#!/usr/bin/env python3
"""A recorded joystick drives the robot against the chair; the push becomes a case to practise."""

import os
import pty
import shutil
import subprocess
import sys
import tempfile

import actionlib
import rosbag
import rospy
import rostest
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Joy

import harness
from casepush.msg import (ExecutePushGoal, ExecutePushResult, ExecutorState, LearnObjectAction,
                          LearnObjectGoal, LearnObjectResult, PushCase)
from casepush.srv import StartDemonstration, StopDemonstration
from pushing import PushingTest

RATE_HZ = 20
AXIS_X, DEAD_MAN = 1, 4


def write_joy_bag(file, strokes):
    """strokes: (seconds, deflection of the forward axis, dead-man button held)."""
    start = rospy.Time(1000)
    with rosbag.Bag(file, "w") as bag:
        i = 0
        for seconds, deflection, held in strokes:
            for _ in range(round(seconds * RATE_HZ)):
                joy = Joy(axes=[0.0] * 6, buttons=[0] * 8)
                joy.axes[AXIS_X] = deflection
                joy.buttons[DEAD_MAN] = int(held)
                bag.write("joy", joy, start + rospy.Duration(i / RATE_HZ))
                i += 1


class DemonstrationTest(PushingTest):

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.mkdtemp()
        cls.learner = harness.start_node("learner_node", "_world:=open_floor",
                                         f"_case_base:={cls.folder}/cases.db")
        cls.begin = rospy.ServiceProxy("demonstration/start", StartDemonstration)
        cls.finish = rospy.ServiceProxy("demonstration/stop", StopDemonstration)
        cls.begin.wait_for_service(20.0)
        cls.cases.wait()
        cls.objects.wait(lambda m: any(o.id == harness.OBJECT for o in m.objects))

    @classmethod
    def tearDownClass(cls):
        harness.end_node(cls.learner)
        shutil.rmtree(cls.folder)

    def play(self, *strokes):
        file = os.path.join(self.folder, "joy.bag")
        write_joy_bag(file, strokes)
        subprocess.run(["rosbag", "play", "-q", "--wait-for-subscribers", file], check=True,
                       timeout=60.0, stdin=subprocess.DEVNULL)

    def test_a_refusals_say_what_to_do(self):
        answer = self.finish()
        self.assertFalse(answer.success)
        self.assertIn("no demonstration is under way", answer.message)
        answer = self.begin("piano_1")
        self.assertFalse(answer.success)
        self.assertIn("piano_1", answer.message)
        self.assertTrue(self.begin(harness.OBJECT).success)
        answer = self.finish()
        self.assertFalse(answer.success)
        self.assertRegex(answer.message, "did not move|was not seen")

    def test_b_without_the_dead_man_button_nothing_moves(self):
        self.commands.clear()
        self.play((0.5, 1.0, False))
        self.assertEqual([m for _, m in self.commands.all() if not harness.is_zero(m)], [])

    def test_c_a_push_by_hand_becomes_a_case(self):
        self.assertTrue(self.begin(harness.OBJECT).success)
        self.play((0.5, 0.0, True), (3.6, 0.9, True), (0.3, 0.0, False))
        answers = []

        def stopped():
            answers.append(self.finish())
            return answers[-1].success or "rest yet" not in answers[-1].message

        harness.wait_until(stopped, 20.0, "the chair to rest")
        self.assertTrue(answers[-1].success, answers[-1].message)
        self.cases.wait(lambda m: len(m.cases) == 1)
        case = self.cases.last().cases[0]
        self.assertEqual(case.id, answers[-1].case_id)
        self.assertEqual((case.origin, case.object, case.observation_count),
                         (PushCase.DEMONSTRATED, "office_chair", 1))
        self.assertGreater(case.outcome.mean.x, 0.1)
        self.assertLess(case.push_steps * case.period, 4.0)
        self.commands.wait(harness.is_zero)

    def test_d_it_is_practised_like_any_other(self):
        client = actionlib.SimpleActionClient("learn_object", LearnObjectAction)
        harness.wait_until(client.action_client.wait_for_server, what="learn_object")
        client.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=1, practices=3, seed=1))
        self.state.wait(lambda m: m.activity == ExecutorState.EXECUTING_PUSH)
        self.assertFalse(self.begin(harness.OBJECT).success)
        result = harness.result_of(client, 90.0)
        self.assertEqual(result.status, LearnObjectResult.DONE, result.explanation)
        self.cases.wait(lambda m: [c.observation_count for c in m.cases] == [3])
        self.assertEqual(self.cases.last().cases[0].origin, PushCase.DEMONSTRATED)

    def test_e_goals_are_refused_while_somebody_drives(self):
        self.await_nodes()
        publisher = rospy.Publisher("teleop_cmd_vel", Twist, queue_size=1)
        harness.wait_until(lambda: publisher.get_num_connections() > 0, what="the executor")

        def driven():
            publisher.publish(Twist())
            return self.state.last().phase == "teleop"

        harness.wait_until(driven, what="teleop")
        publisher.publish(Twist())
        self.execute_push.send_goal(ExecutePushGoal(object_id=harness.OBJECT))
        result = harness.result_of(self.execute_push)
        self.assertEqual(result.status, ExecutePushResult.BUSY, result.explanation)
        self.assertIn("driven by hand", result.explanation)
        self.state.wait(lambda m: m.phase == "idle")

    def test_f_the_keyboard_drives(self):
        wanted = harness.Recorder("teleop_cmd_vel", Twist)
        ours, theirs = pty.openpty()
        keyboard = subprocess.Popen([harness.node_path("teleop_keyboard")], stdin=theirs,
                                    stdout=subprocess.DEVNULL)
        try:
            def turned():
                os.write(ours, b"q")
                last = wanted.last()
                return last is not None and last.angular.z > 0.1

            harness.wait_until(turned, what="a turn")
            os.write(ours, b" ")
            wanted.wait(harness.is_zero)
        finally:
            harness.end_node(keyboard)
            os.close(ours)
            os.close(theirs)


if __name__ == "__main__":
    rospy.init_node("demonstration_test")
    rostest.rosrun("casepush", "demonstration", DemonstrationTest, sys.argv)
