"""Classes, functions and constants of one name in several files of a package: each file means its own or what it
imports."""

import pytest
from joining import ends, graph, graph_on_disk, joined, manifest

NODE = """
    import rospy
    from std_msgs.msg import String

    class Node:
        def __init__(self):
            self.topic = "{topic}"
            self.pub = rospy.Publisher(self.topic, String, queue_size=1)

        def run(self):
            self.pub.publish("x")
"""
RUN = """
    {imported}
    import rospy
    rospy.init_node("run")
    {made}.run()
"""


def test_each_program_of_a_package_has_its_own_class():
    main = "\n    node = Node()\n    node.run()\n"
    files = {f"p/{name}.py": NODE.format(topic=name) + main for name in ("left", "right")}
    found = graph(files, ros=1)
    assert ends(found, "publisher") == {(f"p/{name}.py", f"/{name}", "std_msgs/String") for name in ("left", "right")}
    assert {(one.node, one.topic, one.path) for one in found.publishes} == {
        (f"p/{name}.py", f"/{name}", f"p/{name}.py") for name in ("left", "right")
    }


@pytest.mark.parametrize(
    ("program", "imported", "made", "expected"),
    [
        ("p/scripts/run.py", "from node import Node", "Node()", "/scripts"),
        ("p/scripts/run.py", "import node", "node.Node()", "/scripts"),
        ("p/scripts/run.py", "from p.node import Node", "Node()", "/package"),
        ("p/scripts/run.py", "from p import node as other", "other.Node()", "/package"),
        ("p/scripts/run.py", "from p import Node", "Node()", "/package"),  # handed on by __init__.py
        ("p/scripts/run.py", "from p.all import *", "Node()", "/package"),
        ("p/scripts/run.py", "from Node import Node", "Node()", "/upper"),
        ("p/scripts/run.py", "from q.node import Node", "Node()", "/other"),
        ("p/src/p/run.py", "from .node import Node", "Node()", "/package"),
        ("p/src/p/run.py", "from . import node", "node.Node()", "/package"),
        ("p/src/p/inner/run.py", "from ..node import Node", "Node()", "/package"),
        ("p/nodes/run.py", "from Node import Node", "Node()", "/upper"),  # found by a path that is set at run time
    ],
)
def test_a_program_has_the_class_that_it_imports(program, imported, made, expected):
    found = graph({
        "p/scripts/node.py": NODE.format(topic="scripts"),
        "p/scripts/Node.py": NODE.format(topic="upper"),
        "p/src/p/__init__.py": "from .node import Node\n",
        "p/src/p/all.py": "from p.node import *\n",
        "p/src/p/node.py": NODE.format(topic="package"),
        "q/q/__init__.py": "",
        "q/q/node.py": NODE.format(topic="other"),
        program: RUN.format(imported=imported, made=made),
    }, ros=1)  # fmt: skip
    assert {topic for node, topic, _ in ends(found, "publisher") if node == "p/run.py"} == {expected}


@pytest.mark.parametrize(
    "imported",
    [
        "import os",  # nothing imports it
        "from outside import Node",
        "from helper import Node",  # a file beside another package's program
        "from node import Node",  # two that are as near
    ],
)
def test_no_class_of_that_name_is_taken_from_elsewhere(imported):
    found = graph({
        "p/one/node.py": NODE.format(topic="one"),
        "p/two/node.py": NODE.format(topic="two"),
        "q/scripts/helper.py": NODE.format(topic="other"),
        "p/scripts/run.py": RUN.format(imported=imported, made="Node()"),
    }, ros=1)  # fmt: skip
    assert not {topic for node, topic, _ in ends(found, "publisher") if node == "p/run.py"}


def test_a_member_made_in_another_file_is_of_the_class_that_this_file_means():
    """A base class and the class that is derived from it have the same name, and hold an object of the same name."""
    base = """
        from part import Part

        class Robot:
            def __init__(self):
                self.part = Part()
    """
    program = """
        import base
        import rospy

        class Part:
            def say(self):
                pass

        class Robot(base.Robot):
            def __init__(self):
                super().__init__()
                self.part.say()

        Robot()
    """
    part = """
        import rospy
        from std_msgs.msg import String

        class Part:
            def say(self):
                rospy.Publisher("right", String, queue_size=1)
    """
    found = graph({"p/base.py": base, "p/part.py": part, "p/run.py": program}, ros=1)
    assert {topic for node, topic, _ in ends(found, "publisher") if node == "p/run.py"} == {"/right"}


@pytest.mark.parametrize(
    ("imported", "topic", "expected"),
    [
        ("from names import TOPIC", "TOPIC", "/names"),
        ("from names import TOPIC as NAME", "NAME", "/names"),
        ("from names import *", "TOPIC", "/names"),
        ("import names", "names.TOPIC", "/names"),
        ("import names as n", "n.TOPIC", "/names"),
        ("from names import make", "make()", "/made"),
        ("import names", "names.make()", "/made"),
        ("from names import TOPIC\nTOPIC = 'own'", "TOPIC", "/own"),
        ("import os", "TOPIC", "?"),
        ("import os", "make()", "?"),
    ],
)
def test_constants_and_functions_are_those_of_the_file_or_imported(imported, topic, expected):
    names = "TOPIC = '{0}'\ndef make():\n    return '{1}'\n"
    text = f"{imported}\nimport rospy\nfrom std_msgs.msg import String\nrospy.Publisher({topic}, String)\n"
    files = {"p/names.py": names.format("names", "made"), "p/alike.py": names.format("alike", "no"), "p/run.py": text}
    found = graph(files, ros=1)
    assert {topic for node, topic, _ in ends(found, "publisher") if node == "p/run.py"} == {expected}


def test_a_class_is_found_in_the_packages_that_setup_py_has_below_src(tmp_path):
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": "project(p)\ncatkin_python_setup()\n",
        "p/setup.py": "from distutils.core import setup\nsetup(packages=['p'], package_dir={'': 'src'})\n",
        "p/src/p/__init__.py": "",
        "p/src/p/node.py": NODE.format(topic="package"),
        "p/scripts/run.py": RUN.format(imported="from p.node import Node", made="Node()"),
        "p/scripts/alone.py": NODE.format(topic="alone") + "\n    rospy.init_node('alone')\n    Node().run()\n",
    }
    found = graph_on_disk(tmp_path, files)
    assert ends(found, "publisher") == {
        ("p/run.py", "/package", "std_msgs/String"), ("p/alone.py", "/alone", "std_msgs/String"),
    }  # fmt: skip


OWN = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/string.hpp>
    class Talker : public rclcpp::Node {{
     public:
      Talker();
      void say() {{ pub_->publish(std_msgs::msg::String()); }}
     private:
      std::string topic_ = "{topic}";
      rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
    }};
    Talker::Talker() : Node("{topic}") {{ pub_ = create_publisher<std_msgs::msg::String>(topic_, 1); }}
    int main() {{ auto node = std::make_shared<Talker>(); node->say(); }}
"""


def test_each_executable_of_a_package_has_the_class_of_its_own_source():
    found = graph({f"p/{name}.cpp": OWN.format(topic=name) for name in ("left", "right")})
    assert ends(found, "publisher") == {(f"p/{name}", f"/{name}", "std_msgs/String") for name in ("left", "right")}
    assert {(one.node, one.topic, one.path) for one in found.publishes} == {
        (f"p/{name}", f"/{name}", f"p/{name}.cpp") for name in ("left", "right")
    }


def test_a_source_that_is_included_has_its_classes_for_others():
    main = '#include "talker.cpp"\nint main() { auto node = std::make_shared<Talker>(); node->say(); }'
    talker = OWN.format(topic="said").partition("    int main")[0]
    join = joined({"p/talker.cpp": talker, "p/main.cpp": main, "p/other.cpp": OWN.format(topic="other")})
    assert ends(join.build(), "publisher") == {
        ("p/main", "/said", "std_msgs/String"), ("p/other", "/other", "std_msgs/String"),
    }  # fmt: skip


IN_CPP = """
    class Lamp : public rclcpp::Node {
     public:
      Lamp() : Node("lamp") { pub_ = create_publisher<std_msgs::msg::Bool>("lit", 1); }
      rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
      tf2_ros::TransformBroadcaster frames_ = tf2_ros::TransformBroadcaster(*this);
    };
    int main(int c, char ** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Lamp>()); }
"""
IN_PYTHON = """
    import rospy
    from std_msgs.msg import Bool
    rospy.init_node("lamp")
    pub = rospy.Publisher("lit", Bool, queue_size=1)
    rospy.spin()
"""


@pytest.mark.parametrize(("name", "text", "build"), [
    ("lamp.cpp", IN_CPP, "add_executable(run_{0} lamp.cpp)"),
    ("lamp.py", IN_PYTHON, "catkin_install_python(PROGRAMS lamp.py DESTINATION bin)"),
])  # fmt: skip
def test_files_that_are_byte_for_byte_the_same_are_programs_each(tmp_path, name, text, build):
    files = {f"{package}/{name}": text for package in ("desk", "hall")}
    for package in ("desk", "hall"):
        files[f"{package}/package.xml"] = manifest(package, "catkin" if name.endswith("py") else "ament_cmake")
        files[f"{package}/CMakeLists.txt"] = f"project({package})\n{build.format(package)}\n"
    found = graph_on_disk(tmp_path, files)
    assert len(found.nodes) == 2
    for topic in ("/lit", "/tf") if name.endswith("cpp") else ("/lit",):
        assert sorted(one.path for one in found.endpoints if one.topic == topic) == [f"desk/{name}", f"hall/{name}"]
