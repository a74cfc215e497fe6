"""Stands between the simulator and the other nodes, and spoils what it passes on."""

import copy
import random
import threading

import rospy
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

from casepush.msg import AprilTagDetectionArray, PushableObjectArray


class FaultRelay:
    """Passes clock, transforms, odometry, scans and detections on, from `raw/...` as drill.launch
    names them, and tracked poses back to the simulator, which waits for them. Its attributes are the faults; they may be set at any time, by the test's thread."""

    def __init__(self):
        self._random = random.Random(1)
        self._lock = threading.Lock()
        self._publishers = {}
        self._subscribers = []
        self.mend()
        self.offset = rospy.Duration(0)
        for topic, message_type, relay in (("/clock", Clock, self._on_clock),
                                           ("/tf", TFMessage, self._on_tf),
                                           ("/odom", Odometry, self._on_odometry),
                                           ("/points", PointCloud2, self._on_scan),
                                           ("/tag_detections", AprilTagDetectionArray,
                                            self._on_tags)):
            self._publishers[topic] = rospy.Publisher(topic, message_type, queue_size=100,
                                                      tcp_nodelay=True)
            self._subscribers.append(rospy.Subscriber("/raw" + topic, message_type, relay,
                                                      queue_size=100, tcp_nodelay=True))

        self._publishers["/raw/objects"] = rospy.Publisher("/raw/objects", PushableObjectArray,
                                                           queue_size=1, tcp_nodelay=True)
        self._subscribers.append(rospy.Subscriber("/objects", PushableObjectArray,
                                                  self._on_objects, queue_size=1,
                                                  tcp_nodelay=True))

    def mend(self):
        """No faults from now on, but for what the clock says."""
        self.tf_frozen = False
        self.tf_ahead = rospy.Duration(0)  # Of their true stamps.
        self.odometry_frozen = False
        self.scans_frozen = False
        self.images_frozen = False   # No image comes at all.
        self.drop_share = 0.0        # Of single detections.
        self.hidden = False          # Images come, with nothing in them.

    def jump(self, seconds):
        """The clock, and with it every stamp, jumps by so much."""
        self.offset += rospy.Duration(seconds)

    def _on_clock(self, message):
        message.clock = self._shifted(message.clock)
        self._publishers["/clock"].publish(message)

    def _on_tf(self, message):
        if not self.tf_frozen:
            for transform in message.transforms:
                transform.header.stamp = self._shifted(transform.header.stamp) + self.tf_ahead
            self._publishers["/tf"].publish(message)

    def _on_odometry(self, message):
        if self.odometry_frozen:
            return
        message = copy.deepcopy(message)  # Whoever else in this process listens gets the very same.
        message.header.stamp = self._shifted(message.header.stamp)
        self._publishers["/odom"].publish(message)

    def _on_scan(self, message):
        if not self.scans_frozen:
            message.header.stamp = self._shifted(message.header.stamp)
            self._publishers["/points"].publish(message)

    def _on_objects(self, message):
        message = copy.deepcopy(message)
        message.header.stamp -= self.offset
        self._publishers["/raw/objects"].publish(message)

    def _on_tags(self, message):
        if self.images_frozen:
            return
        message.header.stamp = self._shifted(message.header.stamp)
        if self.hidden:
            message.detections = []
        elif self.drop_share > 0.0:
            with self._lock:
                message.detections = [detection for detection in message.detections
                                      if self._random.random() >= self.drop_share]
        self._publishers["/tag_detections"].publish(message)

    def _shifted(self, stamp):
        return stamp + self.offset
