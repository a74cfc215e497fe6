#!/usr/bin/env python3
"""Every launch file loads, and every node in it exists."""

import glob
import os
import sys
import unittest

import roslaunch
import rostest

import harness

ARGUMENTS = {"nodes.launch": ["world:=office"], "robot.launch": ["world:=office"]}


class LaunchFilesTest(unittest.TestCase):

    def test_every_launch_file_loads(self):
        files = glob.glob(os.path.join(harness.share(), "launch", "*.launch"))
        self.assertGreaterEqual(len(files), 4)
        for file in files:
            arguments = ARGUMENTS.get(os.path.basename(file), [])
            with self.subTest(file=file):
                config = roslaunch.config.load_config_default([(file, arguments)], None)
                self.assertEqual(config.config_errors, [])
                self.assertTrue(config.nodes)
                for node in config.nodes:
                    found = roslaunch.node_args.create_local_process_args(
                        node, config.machines[""])
                    self.assertTrue(os.access(found[0], os.X_OK), found)

    def test_no_launch_file_leads_anything_else_to_the_base(self):
        for file in glob.glob(os.path.join(harness.share(), "launch", "*.launch")):
            arguments = ARGUMENTS.get(os.path.basename(file), [])
            with self.subTest(file=file):
                config = roslaunch.config.load_config_default([(file, arguments)], None)
                executors = [node for node in config.nodes if node.type == "executor_node"]
                self.assertLessEqual(len(executors), 1)
                for node in config.nodes:
                    self.assertNotIn("cmd_vel", [to.strip("/") for _, to in node.remap_args])
                    self.assertFalse(node.respawn and node.type == "sim_node")
                for node in executors:
                    self.assertTrue(node.respawn)


if __name__ == "__main__":
    rostest.rosrun("casepush", "launch_files", LaunchFilesTest, sys.argv)
