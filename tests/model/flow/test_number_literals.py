"""Numbers in names are what the program writes, not what stands in the source."""

import pytest
from joining import graph
from rosimpact.impact.model.flow.literals import spell_number


@pytest.mark.parametrize(("text", "is_cpp", "expected"), [
    ("0x10", True, "16"), ("0X1f", True, "31"), ("0b11", True, "3"), ("010", True, "8"), ("10u", True, "10"),
    ("1'000ULL", True, "1000"), ("-0x10", True, "-16"), ("0", True, "0"), ("2.5f", True, "2.5f"), ("08", True, "08"),
    ("0x10", False, "16"), ("0o17", False, "15"), ("1_000", False, "1000"), ("2.50", False, "2.5"),
    ("1e3", False, "1000.0"), ("True", False, "True"), ("None", False, "None"), ("3j", False, "3j"),
    ("12", True, "12"), ("12", False, "12"), ("nullptr", True, "nullptr"), ("", True, ""),
])  # fmt: skip
def test_literals(text, is_cpp, expected):
    assert spell_number(text, is_cpp) == expected


@pytest.mark.parametrize(("written", "topic"), [
    ('"/v%s" % 0x10', "/v16"), ('f"/v{0b11}"', "/v3"), ('"/v" + str(1_0)', "/v10"), ('"/v{:02d}".format(0x5)', "/v05"),
    ('f"/v{INDEX}"', "/v31"), ('"/v" + "0x10"', "/v0x10"),
])  # fmt: skip
def test_python(written, topic):
    found = graph({"p/it.py": f"""
        import rospy
        from std_msgs.msg import Empty
        INDEX = 0x1F
        rospy.init_node("it")
        pub = rospy.Publisher({written}, Empty)
    """}, ros=1)  # fmt: skip
    assert {one.topic for one in found.endpoints if not one.implied} == {topic}


@pytest.mark.parametrize(("written", "topic"), [
    ('"v" + std::to_string(0x10)', "/v16"), ('"v" + std::to_string(010)', "/v8"), ('"v" + std::to_string(2u)', "/v2"),
    ('fmt::format("v{}", 0x10)', "/v16"), ('"v" + std::to_string(kPort)', "/v255"), ('"v" + std::to_string(2.5)', ""),
])  # fmt: skip
def test_cpp(written, topic):
    found = graph({"p/it.cpp": f"""
        #include <rclcpp/rclcpp.hpp>
        constexpr int kPort = 0xFF;
        int main(int argc, char ** argv) {{
          rclcpp::init(argc, argv);
          auto node = std::make_shared<rclcpp::Node>("it");
          auto pub = node->create_publisher<std_msgs::msg::Empty>({written}, 1);
        }}
    """})  # fmt: skip
    assert {one.topic if one.how == "literal" else "" for one in found.endpoints if not one.implied} == {topic}


def test_a_condition_compares_numbers():
    found = graph({"p/it.py": """
        import rospy
        from std_msgs.msg import Empty
        PORT = 0x10
        rospy.init_node("it")
        name = "a" if PORT == 16 else "b"
        pub = rospy.Publisher(name, Empty)
    """}, ros=1)  # fmt: skip
    assert {one.topic for one in found.endpoints if not one.implied} == {"/a"}
