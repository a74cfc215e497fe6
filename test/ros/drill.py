"""What the fault drills share: a task under way, a fault, and what must be true afterwards."""

import collections
import contextlib
import math
import os
import signal
import sqlite3
import xmlrpc.client

import rospy
from nav_msgs.msg import Odometry

import fault_relay
import harness
from casepush.msg import ExecutedPush, PushObjectGoal, PushObjectResult, TaskSummary
from casepush.srv import ImportCases
from pushing import PushingTest, speeds

STILL_MPS = 0.01
STILL_RPS = 0.02
# The limits of config/robots/cobot.yaml.
MAX_SPEED_MPS = 0.5
MAX_TURN_RPS = 1.0
# Of simulated time, within which every task has to end, whatever happens to it.
TIME_LIMIT_S = 240.0
# Outcomes of pushes that were made.
EXECUTED = (ExecutedPush.DONE, ExecutedPush.NOT_MOVED, ExecutedPush.BROKEN_OFF,
            ExecutedPush.STOPPED_SHORT)
STATUS_NAMES = {value: name.lower() for name, value in vars(PushObjectResult).items()
                if name.isupper() and isinstance(value, int)}


def moves(twist):
    speed, turn = speeds(twist)
    return speed > STILL_MPS or turn > STILL_RPS


def process_of(node):
    """The id of a node's process, also if roslaunch has started it anew. OSError: it is gone."""
    code, message, node_uri = rospy.get_master().lookupNode("/" + node)
    if code != 1:
        raise ConnectionError(message)
    return xmlrpc.client.ServerProxy(node_uri).getPid("/drill")[2]


def kill(node):
    """Kills a node. Returns a function that says whether roslaunch has started it again."""
    process = process_of(node)
    os.kill(process, signal.SIGKILL)

    def is_back():
        try:
            return process_of(node) != process
        except OSError:
            return False

    return is_back


@contextlib.contextmanager
def suspended(node):
    """A node that hangs, for as long as the context lasts."""
    process = process_of(node)
    os.kill(process, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(process, signal.SIGCONT)


class Drill(PushingTest):
    """Starts from a chair at the origin, a robot beside it and cases learnt before."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.relay = fault_relay.FaultRelay()
        cls.motion = harness.Recorder("raw/odom", Odometry)
        cls.summaries = harness.Recorder("task_summaries", TaskSummary)
        cls.await_nodes()
        importer = rospy.ServiceProxy("cases/import", ImportCases)
        importer.wait_for_service(30.0)
        answer = importer(os.path.join(harness.share(), "test/data/office_chair_cases.yaml"))
        assert answer.success, answer.message
        cls.cases.wait(lambda m: len(m.cases) == answer.count)
        cls.case_base = rospy.get_param("learner_node/case_base")

    @classmethod
    def tearDownClass(cls):
        for suffix in ("", "-wal", "-shm"):
            if os.path.exists(cls.case_base + suffix):
                os.remove(cls.case_base + suffix)

    def setUp(self):
        self.relay.mend()
        self.set_scene(box_1=(4.4, 4.4, 0.0))
        self.motion.clear()

    def tearDown(self):
        self.relay.mend()
        self.stop.wait_for_service(20.0)
        self.stop()

    def bar_the_way(self):
        """Puts the box that nobody knows of between robot and chair: so near to the robot that
        every way to the chair leads through it."""
        self.place(robot=(-2.7, 0.2, 0.0), box_1=(-1.8, 0.2, math.pi / 2))

    def start_task(self, x_m=1.2, y_m=0.8, yaw_rad=0.5):
        self.reports.clear()
        self.summaries.clear()
        self.start(self.push_object, PushObjectGoal(
            object_id=harness.OBJECT, goal=harness.pose(x_m, y_m, yaw_rad), seed=1, adapt=True,
            time_limit=TIME_LIMIT_S))

    def finish_task(self, *statuses, explanation=""):
        """Expects the task to end in one of these ways, the robot to stand and no case to be
        lost. Returns in which."""
        counts = self.case_counts()
        status = self.end_task(*statuses, explanation=explanation)
        for before, after in zip(counts, self.case_counts()):
            self.assertGreaterEqual(after, before)
        return status

    def end_task(self, *statuses, explanation=""):
        """The same with a case base that is damaged."""
        result = harness.result_of(self.push_object, 90.0)
        self.expect_still()
        for _, command in self.commands.all():
            speed, turn = speeds(command)
            self.assertLessEqual(speed, MAX_SPEED_MPS + 1e-6)
            self.assertLessEqual(turn, MAX_TURN_RPS + 1e-6)
        self.assertIn(result.status, statuses or [PushObjectResult.SUCCEEDED], result.explanation)
        if result.status != PushObjectResult.SUCCEEDED:
            self.assertIn(explanation, result.explanation)
        self.expect_summary(result)
        return result.status

    def expect_summary(self, result):
        """The record of the task says the same as its result and the reports of its pushes."""
        summary = self.summaries.wait()
        goal = self.push_object.gh.comm_state_machine.action_goal
        self.assertEqual((summary.goal_id, summary.object_id),
                         (goal.goal_id.id, goal.goal.object_id))
        self.assertEqual(summary.status, STATUS_NAMES[result.status])
        for field in ("explanation", "position_error", "yaw_error", "plan_length", "plans",
                      "pushes", "clearing_pushes", "rejected_predictions"):
            self.assertEqual(getattr(summary, field), getattr(result, field), field)
        self.assertEqual(len(summary.replan_causes), result.replans)
        self.assertEqual(len(summary.replan_reasons), result.replans)
        if not summary.start_stamp.is_zero():
            self.assertAlmostEqual((summary.header.stamp - summary.start_stamp).to_sec(),
                                   result.duration, places=6)
        self.expect_pushes(summary)

    def expect_pushes(self, summary):
        """Of the summary, as reported one by one."""
        reports = [m for _, m in self.reports.all()]
        executed = [m for m in reports if m.outcome in EXECUTED]
        of_plans = collections.Counter(m.plan_number for m in executed)
        self.assertEqual([of_plans[number] for number in sorted(of_plans)],
                         [count for count in summary.pushes_of_plans if count > 0])
        self.assertEqual(len(executed), summary.pushes)
        self.assertEqual(sum(m.rejected for m in reports), summary.rejected_predictions)
        told = [m.replan_cause for m in reports if m.replan_cause]
        left = iter(summary.replan_causes)
        self.assertTrue(all(cause in left for cause in told), (told, summary.replan_causes))

    def expect_next_task_succeeds(self):
        self.await_nodes()
        self.start_task()
        self.finish_task()

    def now(self):
        """[s] of simulated time, without the jumps of clocks."""
        return self.motion.last().header.stamp.to_sec()

    def wait_phase(self, *phases, patience_s=40.0):
        """Waits for the executor to come into a phase; it may have left it again already."""
        self.state.clear()
        try:
            harness.wait_until(lambda: any(m.phase in phases for _, m in self.state.all()),
                               patience_s, " or ".join(phases))
        except AssertionError as error:
            seen = [f"{m.phase}: {m.description}" for _, m in self.state.all()]
            raise AssertionError(f"{error}; instead: {list(dict.fromkeys(seen))}") from None

    def expect_still(self, is_told_to=True):
        """The base comes to a stand within 2 s and stays there, as told."""
        began_s = self.now()
        harness.wait_until(lambda: self.now() > began_s + 4.0, what="time to pass")
        late = [m.header.stamp.to_sec() - began_s for _, m in self.motion.all()
                if m.header.stamp.to_sec() > began_s + 2.0 and moves(m.twist.twist)]
        self.assertEqual(late, [])
        if is_told_to and self.commands.all():
            self.assertTrue(harness.is_zero(self.commands.last()))

    def stored(self, query):
        """Rows of the case base."""
        with contextlib.closing(sqlite3.connect(f"file:{self.case_base}?mode=ro",
                                                uri=True)) as database:
            return database.execute(query).fetchall()

    def case_counts(self):
        """How many cases and observations are stored, if the file is intact."""
        self.assertEqual(self.stored("PRAGMA integrity_check"), [("ok",)])
        self.assertEqual(self.stored("PRAGMA foreign_key_check"), [])
        return [self.stored(f"SELECT COUNT(*) FROM {table}")[0][0]
                for table in ("cases", "outcomes")]

    def observations(self):
        """What each case was learnt from, as told circumstances have it, by id."""
        rows = collections.defaultdict(list)
        for case, *row in self.stored("SELECT case_id, x_m, y_m, yaw_rad, stamp_s FROM outcomes "
                                      "WHERE noticed = 0 ORDER BY case_id, number"):
            rows[case].append(row)
        return rows
