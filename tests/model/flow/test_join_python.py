"""Nodes in Python whose classes, functions and types come from other modules."""

import pytest
from joining import ends, graph, graph_on_disk, manifest
from rosimpact.impact.model.flow.defined import DefinedInterfaces

NODE = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Bool

    class Lamp(Node):
        def __init__(self):
            super().__init__("lamp")
            self.pub = self.create_publisher(Bool, "{topic}", 1)

    def main():
        rclpy.spin(Lamp())
"""


def test_an_entry_point_may_name_a_package_that_has_the_function_from_a_module(tmp_path):
    """Two packages that are alike: each one's entry point leads to its own module."""
    files = {}
    for name in ("desk", "hall"):
        files |= {
            f"{name}/package.xml": manifest(name, "ament_python"),
            f"{name}/setup.py": f"""
                from setuptools import setup
                programs = ["run_{name} = {name}:main"]
                setup(name="{name}", packages=["{name}"], entry_points={{"console_scripts": programs}})
            """,
            f"{name}/{name}/__init__.py": "from .node import *\n" if name == "desk" else "from .node import main\n",
            f"{name}/{name}/node.py": NODE.format(topic=name),
        }
    found = graph_on_disk(tmp_path, files)
    assert ends(found, "publisher") == {
        ("desk/run_desk", "/desk", "std_msgs/Bool"), ("hall/run_hall", "/hall", "std_msgs/Bool"),
    }  # fmt: skip


@pytest.mark.parametrize(
    "imported",
    [
        "from lights import Lamp",
        "from lights import Lamp as Lamp",
        "from lights.inner import Lamp",
        "from lights import *",
    ],
)
def test_classes_that_a_package_has_from_its_modules(imported):
    program = (
        f"{imported}\nimport rclpy\n\ndef main():\n    rclpy.spin(Lamp())\n\nif __name__ == '__main__':\n    main()\n"
    )
    found = graph({
        "lights/lights/__init__.py": "from .inner import Lamp\n",
        "lights/lights/inner/__init__.py": "from .node import Lamp\n",
        "lights/lights/inner/node.py": NODE.format(topic="lit"),
        "app/run.py": program,
    })  # fmt: skip
    assert ("app/run.py", "/lit", "std_msgs/Bool") in ends(found, "publisher")


TALKER = """
    import rospy
    from {first}.msg import *
    from {last}.msg import *
    rospy.init_node("talker")
    rospy.Publisher("out", {name}, queue_size=1)
"""


@pytest.mark.parametrize(
    "first, last, name, expected",
    [
        ("std_msgs", "geometry_msgs", "Pose", "geometry_msgs/Pose"),
        ("geometry_msgs", "std_msgs", "Pose", "geometry_msgs/Pose"),
        ("own_msgs", "std_msgs", "String", "std_msgs/String"),
        ("std_msgs", "own_msgs", "String", "own_msgs/String"),  # both have it: the last holds
        ("own_msgs", "std_msgs", "MoveAction", "own_msgs/MoveAction"),
        ("std_msgs", "unknown_msgs", "Thing", "unknown_msgs/Thing"),
        ("std_msgs", "unknown_msgs", "String", ""),  # the second may have one too
        ("other_msgs", "unknown_msgs", "Thing", ""),
    ],
)
def test_types_of_modules_that_are_imported_whole(first, last, name, expected):
    files = {"p/talker.py": TALKER.format(first=first, last=last, name=name)}
    found = graph(files, 1, defined=DefinedInterfaces({"own_msgs": {"String", "Move"}}, 1))
    assert ends(found, "publisher") == {("p/talker.py", "/out", expected)}


def test_types_of_modules_that_are_imported_whole_by_their_kind():
    """Services are in modules of services: what a message module may have is none."""
    found = graph({"p/asks.py": """
        import rospy
        from mavros_msgs.srv import *
        from unknown_msgs.msg import *
        rospy.init_node("asks")
        rospy.ServiceProxy("/mode", SetMode)
        rospy.Subscriber("/mode", SetMode, print)
    """}, 1, defined=DefinedInterfaces({"mavros_msgs": {"SetMode"}}, 1))  # fmt: skip
    assert ends(found, "client") == {("p/asks.py", "/mode", "mavros_msgs/SetMode")}
    assert ends(found, "subscriber") == {("p/asks.py", "/mode", "unknown_msgs/SetMode")}


def test_function_that_is_given_the_object_as_self():
    found = graph({"p/talker.py": """
        import rospy
        from std_msgs.msg import Bool

        def advertise(self, topic, size=1):
            return rospy.Publisher(topic, Bool, queue_size=size)

        class Talker:
            def __init__(self):
                self.out = advertise(self, "lit", 3)

        rospy.init_node("talker")
        Talker()
    """}, 1)  # fmt: skip
    assert ends(found, "publisher") == {("p/talker.py", "/lit", "std_msgs/Bool")}


@pytest.mark.parametrize(
    "first, last, expected",
    [("std_msgs", "geometry_msgs", "geometry_msgs/Pose"), ("other_msgs", "unknown_msgs", "")],
)
def test_types_of_namespaces_that_are_used_whole(first, last, expected):
    main = f"""
        using namespace {first};
        using namespace {last};
        int main(int c, char** v) {{
          ros::init(c, v, "talker");
          ros::NodeHandle n;
          ros::Publisher pub = n.advertise<Pose>("out", 1);
        }}
    """
    found = graph({"p/talker.cpp": main}, 1, defined=DefinedInterfaces({}, 1))
    assert ends(found, "publisher") == {("p/talker", "/out", expected)}


@pytest.mark.parametrize(
    "imported, name, expected",
    [
        ("import nav_msgs.msg as nav_msgs", "nav_msgs.Path", "nav_msgs/Path"),
        ("from nav_msgs import msg as nav_msgs", "nav_msgs.Path", "nav_msgs/Path"),
        ("from nav_msgs import msg", "msg.Path", "nav_msgs/Path"),
        ("from nav_msgs import msg as m", "m.Path", "nav_msgs/Path"),
        ("import nav_msgs.msg as nav", "nav.Path", "nav_msgs/Path"),
        ("import nav_msgs.msg", "nav_msgs.msg.Path", "nav_msgs/Path"),
        ("import nav_msgs.msg._path as nav_msgs", "nav_msgs.Path", "nav_msgs/Path"),
        ("from nav_msgs.msg import Path as msg", "msg", "nav_msgs/Path"),
        ("import other as nav_msgs", "nav_msgs.Path", ""),  # nothing tells what it has
    ],
)
def test_types_by_other_names_of_their_modules(imported, name, expected):
    text = f"""
        import rospy
        {imported}
        rospy.init_node("walker")
        rospy.Publisher("way", {name}, queue_size=1)
    """
    found = graph({"p/walker.py": text}, 1)
    assert ends(found, "publisher") == {("p/walker.py", "/way", expected)}


@pytest.mark.parametrize(
    "imported, name, expected",
    [
        ("from names import Way", "Way", "nav_msgs/Path"),
        ("from names import *", "Way", "nav_msgs/Path"),
        ("import names", "names.Way", "nav_msgs/Path"),
        ("import names as n", "n.Odometry", "nav_msgs/Odometry"),
        ("from names import Bool", "Bool", "std_msgs/Bool"),
        ("from names import Other", "Other", ""),
        ("from names import Way as Other", "Way", ""),
        ("import absent", "absent.Path", ""),
    ],
)
def test_types_that_another_module_imports(imported, name, expected):
    text = f"""
        import rospy
        {imported}
        rospy.init_node("walker")
        rospy.Publisher("way", {name}, queue_size=1)
    """
    names = "from nav_msgs.msg import Path as Way, Odometry\nfrom std_msgs.msg import *\nfrom elsewhere import Other\n"
    found = graph({"p/walker.py": text, "p/names.py": names}, 1, defined=DefinedInterfaces({}, 1))
    assert ends(found, "publisher") == {("p/walker.py", "/way", expected)}


@pytest.mark.parametrize("name", ['"."', '"..." + name', '"::"'])
def test_a_topic_of_nothing_but_separators_is_no_fault(name):
    text = f"import rospy\nrospy.init_node('n')\nname = 'x'\nrospy.Publisher({name}, String, queue_size=1)\n"
    found = graph({"demo/scripts/n.py": text}, 1)
    assert found.coverage.calls
