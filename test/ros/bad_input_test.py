#!/usr/bin/env python3
"""Bad input ends a node with exit code 2 and one clear line; files stay as they are."""

import os
import shutil
import sys
import tempfile
import unittest

import rospy
import rostest

import harness

OFFICE = "_world:=office"


class BadInputTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        if rospy.has_param("/checked_sim_node"):  # Parameters of the run before.
            rospy.delete_param("/checked_sim_node")

    def tearDown(self):
        shutil.rmtree(self.folder)

    def write(self, name, content):
        file = os.path.join(self.folder, name)
        with open(file, "wb") as stream:
            stream.write(content)
        return file

    def expect(self, words, executable, *parameters):
        code, text = harness.run_node(executable, *parameters)
        lines = [line for line in text.splitlines() if line.startswith(executable)]
        self.assertEqual(code, 2, text)
        self.assertEqual(len(lines), 1, text)
        for word in words:
            self.assertIn(word, lines[0])

    def test_unknown_world(self):
        for executable in ("sim_node", "perception_node", "planner_node", "executor_node",
                           "learner_node", "demo_node"):
            self.expect(["atlantis"], executable, "_world:=atlantis")

    def test_worlds_that_cannot_be(self):
        chair = "{id: chair_1, model: office_chair, xy: [0, 0], yaw_deg: 0}"
        other = "{id: chair_2, model: office_chair, xy: [0.1, 0], yaw_deg: 0}"
        for objects, words in (
                (f"{chair}, {other}", ["chair_1", "chair_2", "overlaps"]),
                (chair.replace("office_chair", "piano"), ["chair_1", "piano", "office_chair"]),
                (chair.replace("[0, 0]", "[9, 0]"), ["objects[0].xy", "outside"]),
                (chair.replace("[0, 0]", "[-3, 0]"), ["robot", "overlaps"]),
                (chair.replace("chair_1", "chair 1"), ["'chair 1'", "letters"]),
                (chair.replace("yaw_deg: 0", "yaw_deg: 0, load: {mass_kg: 90, xy: [0, 0]}"),
                 ["load.mass_kg", "[0, 80]"])):
            text = ("bounds: {min: [-5, -5], max: [5, 5]}\n"
                    "robot: {model: cobot, xy: [-3, 0], yaw_deg: 0}\n"
                    f"objects: [{objects}]\n")
            file = self.write("room.yaml", text.encode())
            self.expect([file] + words, "sim_node", f"_world:={file}")

    def test_all_wrong_parameters_at_once(self):
        self.expect(["real_time_factor is -1", "unknown parameter sped"], "sim_node", OFFICE,
                    "_real_time_factor:=-1", "_sped:=3")

    def test_unreadable_map(self):
        self.expect(["missing.bt"], "planner_node", OFFICE, "_map_file:=missing.bt")
        broken = self.write("broken.bt", b"# Octomap OcTree binary file\nid OcTree\nsize 3\n")
        self.expect([broken], "planner_node", OFFICE, f"_map_file:={broken}")

    def test_corrupt_case_base(self):
        content = b"SQLite format 3\0" + bytes(range(256)) * 16
        file = self.write("cases.db", content)
        self.expect([file], "learner_node", OFFICE, f"_case_base:={file}")
        with open(file, "rb") as stream:
            self.assertEqual(stream.read(), content)
        text = self.write("cases.txt", b"no case base at all\n")
        self.expect([text], "learner_node", OFFICE, f"_case_base:={text}")

    def test_bad_goal_of_the_demo(self):
        self.expect(["three finite numbers"], "demo_node", OFFICE, "_goal:='1 2'")


if __name__ == "__main__":
    rostest.rosrun("casepush", "bad_input", BadInputTest, sys.argv)
