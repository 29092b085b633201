"""Constants of released packages as names."""

import pytest
from joining import ends, graph
from rosimpact.impact.model.flow import endpoints, outside_constants
from rosimpact.impact.targets.constants import ReleasedConstants, load_constants

TABLE = ReleasedConstants(
    headers={
        "nav_util/names.hpp": {"nav_util::kPlan": "plan", "nav_util::Names::GOAL": "goal", "NAV_MAP": "map"},
        "nav_util/others.hpp": {"nav_others::kPlan": "other_plan", "nav_others::topic": "wrong"},
    },
    modules={"nav_names": {"PLAN": "plan"}, "nav_names.inner": {"GOAL": "goal", "Names.MAP": "map"}},
    messages={"nav_msgs/Names": {"SCAN": "scan"}},
)
CPP = """
    HEAD
    class Own : public rclcpp::Node {
     public:
      Own() : Node("own") { create_publisher<std_msgs::msg::Empty>(NAME, 1); }
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Own>()); }
"""
PYTHON = """
    import rospy
    from std_msgs.msg import Empty
    HEAD
    rospy.init_node("own")
    rospy.Publisher(NAME, Empty)
"""
NAMES, OTHERS = "#include <nav_util/names.hpp>", "#include <nav_util/others.hpp>"
IN_CPP = [
    (NAMES, "nav_util::kPlan", "/plan"),
    (f"{NAMES}\nusing namespace nav_util;", "kPlan", "/plan"),
    (NAMES, "nav_util::Names::GOAL", "/goal"),
    (NAMES, "NAV_MAP", "/map"),
    (NAMES, 'std::string(nav_util::kPlan) + "/raw"', "/plan/raw"),
    (OTHERS, "nav_others::kPlan", "/other_plan"),
    # Not included, two of the name, and a constant of the workspace's own.
    ("", "nav_util::kPlan", "?"),
    (f"{NAMES}\n{OTHERS}", "kPlan", "?"),
    (NAMES, "nav_util::kNothing", "?"),
    (f'{NAMES}\nnamespace mine {{ const char * kPlan = "mine"; }}', "mine::kPlan", "/mine"),
    ("#include <nav_msgs/msg/names.hpp>", "nav_msgs::msg::Names::SCAN", "/scan"),
]
IN_PYTHON = [
    ("import nav_names", "nav_names.PLAN", "/plan"),
    ("from nav_names import PLAN", "PLAN", "/plan"),
    ("from nav_names import inner as i", "i.GOAL", "/goal"),
    ("from nav_names.inner import Names", "Names.MAP", "/map"),
    ("from nav_msgs.msg import Names", "Names.SCAN", "/scan"),
    ("import nav_names", "nav_names.NOTHING", "?"),
    ("from nav_names import inner", "inner.PLAN", "?"),
    ("PLAN = argv()", "PLAN", "?"),
]


@pytest.fixture(autouse=True)
def table(monkeypatch):
    for module in (endpoints, outside_constants):
        monkeypatch.setattr(module, "load_constants", lambda: TABLE)


@pytest.mark.parametrize(("head", "name", "topic"), IN_CPP)
def test_in_cpp(head, name, topic):
    text = CPP.replace("HEAD", head).replace("NAME", name)
    assert {one for _, one, _ in ends(graph({"own/own.cpp": text}), "publisher")} == {topic}


def test_a_parameter_that_is_called_like_a_constant_is_none():
    text = CPP.replace("HEAD", OTHERS).replace("Own()", "Own(std::string topic)").replace("NAME", "topic")
    assert "/wrong" not in {one for _, one, _ in ends(graph({"own/own.cpp": text}), "publisher")}


@pytest.mark.parametrize(("head", "name", "topic"), IN_PYTHON)
def test_in_python(head, name, topic):
    text = PYTHON.replace("HEAD", head).replace("NAME", name)
    assert {one for _, one, _ in ends(graph({"own/own.py": text}, ros=1), "publisher")} == {topic}


def test_of_the_workspace_itself_counts_before():
    files = {
        "nav_util/include/nav_util/names.hpp": 'namespace nav_util { const char * kPlan = "here"; }',
        "own/own.cpp": CPP.replace("HEAD", NAMES).replace("NAME", "nav_util::kPlan"),
    }
    assert "/here" in {one for _, one, _ in ends(graph(files), "publisher")}


def test_the_shipped_table_has_the_encodings_of_images():
    shipped = load_constants()
    assert shipped.headers["sensor_msgs/image_encodings.hpp"]["sensor_msgs::image_encodings::RGB8"] == "rgb8"
    assert all(isinstance(value, str) for names in shipped.modules.values() for value in names.values())


def test_a_variable_that_is_called_like_a_module_is_none():
    lines = [
        "import rospy", "from std_msgs.msg import Empty", "import nav_names", "rospy.init_node('own')", "def f():",
        "    nav_names = make()", "    rospy.Publisher(nav_names.PLAN, Empty)", "f()",
    ]  # fmt: skip
    assert {one for _, one, _ in ends(graph({"own/own.py": "\n".join(lines)}, ros=1), "publisher")} == {"?"}
