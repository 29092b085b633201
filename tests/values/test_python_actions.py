"""Callbacks of actions in Python: of servers and clients, by rclpy and rospy."""

import pytest
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values.outcomes import Reaction

MANIFEST = """<package format="3"><name>acts</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>MIT</license><depend>{client}</depend><depend>actionlib</depend>
<export><build_type>{tool}</build_type></export></package>
"""
CMAKE = {
    1: """cmake_minimum_required(VERSION 3.5)
project(acts)
find_package(catkin REQUIRED COMPONENTS rospy actionlib_msgs actionlib)
add_action_files(FILES Count.action)
generate_messages(DEPENDENCIES actionlib_msgs)
catkin_package()
catkin_install_python(PROGRAMS scripts/node.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
""",
    2: """cmake_minimum_required(VERSION 3.8)
project(acts)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME} "action/Count.action")
install(PROGRAMS scripts/node.py DESTINATION lib/acts)
ament_package()
""",
}
ACTION = "int32 order\n---\nint32[] sequence\n---\nint32[] sequence\n"
SERVER_2 = """import rclpy
from rclpy.action import ActionServer, GoalResponse, CancelResponse
from rclpy.node import Node
from acts.action import Count

class Counter(Node):
    def __init__(self):
        super().__init__("counter")
        self.limit = 5
        self._server = ActionServer(self, Count, "count", execute_callback=self.execute_callback,
                                    goal_callback=self.goal_callback, cancel_callback=self.cancel_callback)

    def goal_callback(self, goal_request):
        self.share = 100 // goal_request.order
        if goal_request.order > 50:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def cancel_callback(self, goal_handle):
        self.get_logger().info("cancelled")
        return CancelResponse.ACCEPT

    def execute_callback(self, goal_handle):
        feedback = Count.Feedback()
        if goal_handle.request.order < 0:
            goal_handle.abort()
            return Count.Result()
        feedback.sequence = [0, 1]
        feedback.sequence.append(10 // (goal_handle.request.order - 4))
        goal_handle.publish_feedback(feedback)
        goal_handle.succeed()
        result = Count.Result()
        result.sequence = feedback.sequence
        return result

def main():
    rclpy.init()
    rclpy.spin(Counter())
"""
CLIENT_2 = """import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from acts.action import Count

class Asker(Node):
    def __init__(self):
        super().__init__("asker")
        self._client = ActionClient(self, Count, "count")
        self.last = 0

    def send_goal(self, order):
        goal = Count.Goal()
        goal.order = order
        self._client.wait_for_server()
        self._future = self._client.send_goal_async(goal, feedback_callback=self.feedback_callback)
        self._future.add_done_callback(self.goal_response_callback)

    def goal_response_callback(self, future):
        goal_handle = future.result()
        if not goal_handle.accepted:
            self.get_logger().info("rejected")
            return
        self._result_future = goal_handle.get_result_async()
        self._result_future.add_done_callback(self.get_result_callback)

    def get_result_callback(self, future):
        result = future.result().result
        self.get_logger().info("Result: {0}".format(result.sequence[0]))
        rclpy.shutdown()

    def feedback_callback(self, feedback_msg):
        feedback = feedback_msg.feedback
        if feedback.sequence[1] > 3:
            self.get_logger().info("feedback")

def main():
    rclpy.init()
    asker = Asker()
    asker.send_goal(10)
    rclpy.spin(asker)
"""
SERVER_1 = """#!/usr/bin/env python3
import rospy, actionlib
from acts.msg import CountAction, CountFeedback, CountResult
class Counter:
    def __init__(self):
        self._as = actionlib.SimpleActionServer("count", CountAction, execute_cb=self.execute_cb, auto_start=False)
        self._as.start()
    def execute_cb(self, goal):
        feedback = CountFeedback()
        feedback.sequence = [1, 10 // (goal.order - 4)]
        if self._as.is_preempt_requested():
            self._as.set_preempted()
            return
        self._as.publish_feedback(feedback)
        self._as.set_succeeded(CountResult())
rospy.init_node("counter")
Counter()
rospy.spin()
"""
CLIENT_1 = """#!/usr/bin/env python3
import rospy, actionlib
from acts.msg import CountAction, CountGoal
class Asker:
    def __init__(self):
        self.client = actionlib.SimpleActionClient("count", CountAction)
        self.client.wait_for_server()
        goal = CountGoal(order=3)
        self.client.send_goal(goal, self.done_cb, active_cb=self.active_cb, feedback_cb=self.feedback_cb)
    def done_cb(self, state, result):
        rospy.loginfo(10 // (result.sequence[0] - state))
    def active_cb(self):
        rospy.loginfo("active")
    def feedback_cb(self, feedback):
        rospy.loginfo(feedback.sequence[2])
rospy.init_node("asker")
Asker()
rospy.spin()
"""


def explore(root, ros, source):
    """By callback: what follows, and the crashes with the values that they come for."""
    package = root / "acts"
    for folder in ("action", "scripts"):
        (package / folder).mkdir(parents=True)
    (package / "action" / "Count.action").write_text(ACTION)
    client, tool = ("rospy", "catkin") if ros == 1 else ("rclpy", "ament_cmake")
    (package / "package.xml").write_text(MANIFEST.format(client=client, tool=tool))
    (package / "CMakeLists.txt").write_text(CMAKE[ros])
    (package / "scripts" / "node.py").write_text(source)
    answer = explore_values(root, kinds=("action",), publishers=False, jobs=1, replays=True)
    found = {}
    for one in answer.report.callbacks:
        assert (one.reason, one.unknown) == ("", {})
        ways = "".join(way.value[0] for way in Reaction if one.counts.get(way))
        crashes = {(each.crash.value, tuple(sorted(each.values.items()))) for each in one.examples if each.crash}
        found[one.callback.rpartition(".")[2]] = ways, crashes
        assert {each.confirmed for each in one.examples} <= {None}
        assert {each.note for each in one.examples} == {"not replayed: callbacks of actions in Python are not run"}
    return found


@pytest.mark.parametrize(
    "ros, source, expected",
    [
        (2, SERVER_2, {
            "goal_callback": ("hc", {("division by zero", "goal.order", 0)}),
            "cancel_callback": ("h", set()),
            "execute_callback": ("hc", {("division by zero", "goal.order", 4)}),
        }),
        (2, CLIENT_2, {
            "goal_response_callback": ("hl", set()),
            "get_result_callback": ("hc", {("index out of range", "result.sequence.size", 0)}),
            "feedback_callback": ("lic", {("index out of range", "feedback.sequence.size", 0)}),
        }),
        (1, SERVER_1, {"execute_cb": ("hc", {("division by zero", "goal.order", 4)})}),
        (1, CLIENT_1, {
            "done_cb": ("lc", {("division by zero", "result.sequence.size", 1), ("index out of range", "state", 0)}),
            "active_cb": ("l", set()),
            "feedback_cb": ("lc", {("index out of range", "feedback.sequence.size", 0)}),
        }),
    ],
)  # fmt: skip
def test_callbacks_of_actions(tmp_path, ros, source, expected):
    found = explore(tmp_path / "ws", ros, source)
    assert {name: "".join(sorted(ways)) for name, (ways, _) in found.items()} == {
        name: "".join(sorted(ways)) for name, (ways, _) in expected.items()
    }
    for name, (_, crashes) in expected.items():
        assert {kind for kind, _ in found[name][1]} == {kind for kind, *_ in crashes}
        for kind, path, value in crashes:
            assert any(kind == one and dict(values).get(path, 0) == value for one, values in found[name][1])


OTHERS = """#!/usr/bin/env python3
import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from acts.action import Count
from std_srvs.srv import Empty

class Asker(Node):
    def __init__(self):
        super().__init__("asker")
        self._client = ActionClient(self, Count, "count")
        self._other = self.create_client(Empty, "empty")

    def ask(self):
        self._future = self._other.call_async(Empty.Request())
        self._future.add_done_callback(self.on_done)

    def on_done(self, future):
        self.get_logger().info("done")

rclpy.init()
rclpy.spin(Asker())
"""


def test_a_future_of_something_else_is_not_taken_for_that_of_a_goal(tmp_path):
    assert explore(tmp_path / "ws", 2, OTHERS) == {}
