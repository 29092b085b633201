"""Names that code puts together, of which a part is not known: they are shown with brackets for it, and not certain."""

import pytest
from joining import graph

CPP = """
    #include <rclcpp/rclcpp.hpp>
    using std_msgs::msg::Empty;
    int main(int argc, char ** argv) {{
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("n", "robot");
      int count = find_count();
      {body}
    }}
"""


def list_names(found) -> set[tuple[str, str]]:
    made = [one for one in found.endpoints if not one.implied]
    # What is known in part does not count as resolved.
    assert all(one.reason for one in made if one.how == "partly")
    assert found.coverage.resolved == sum(one.how == "literal" for one in made)
    return {(one.topic, one.how) for one in made}


@pytest.mark.parametrize(("body", "expected"), [
    ('for (int i = 0; i < count; ++i) {\n'
     'auto p = node->create_publisher<Empty>("/camera_" + std::to_string(i) + "/x", 1);\n}',
     "/camera_<i>/x"),
    ('auto p = node->create_publisher<Empty>("q" + std::to_string(count), 1);', "/robot/q<count>"),
    ('auto p = node->create_publisher<Empty>(fmt::format("~/q{}/x", count), 1);', "/robot/n/q<count>/x"),
    ('char name[90];\nsnprintf(name, 90, "/t%d/x", count);\nauto p = node->create_publisher<Empty>(name, 1);',
     "/t<count>/x"),
    ('std::string name = "/a/";\nname += "b" + find_name();\nauto p = node->create_publisher<Empty>(name, 1);',
     "/a/b<find_name>"),
    # In which namespace a name is whose beginning is not known, is not known either.
    ('auto p = node->create_publisher<Empty>(find_name() + "/x", 1);', ""),
    ('auto p = node->create_publisher<Empty>("/" + find_name(), 1);', ""),
    ("auto p = node->create_publisher<Empty>(find_name(), 1);", ""),
])  # fmt: skip
def test_cpp(body, expected):
    found = graph({"p/n.cpp": CPP.format(body=body)})
    assert list_names(found) == {(expected, "partly" if expected else "unresolved")}


@pytest.mark.parametrize(("name", "expected"), [
    ('f"/v{self.count()}/x"', "/v<count>/x"),
    ('"/v%d" % self.count()', "/v<count>"),
    ('"/v" + str(self.ids[0]) + "/x"', "/v<ids>/x"),
    ('"/v{}/x".format(self.index)', "/v<index>/x"),
    ('f"{self.index}/x"', ""),
])  # fmt: skip
def test_python(name, expected):
    found = graph({"p/n.py": f"""
        import rospy
        from std_msgs.msg import Empty
        from elsewhere import Base

        class Part(Base):
            def __init__(self):
                self.pub = rospy.Publisher({name}, Empty)

        rospy.init_node("n")
        Part()
    """}, ros=1)  # fmt: skip
    assert list_names(found) == {(expected, "partly" if expected else "unresolved")}


def test_a_publish_statement_has_the_same_name():
    body = 'auto p = node->create_publisher<Empty>("q" + std::to_string(count), 1);\np->publish(Empty());'
    found = graph({"p/n.cpp": CPP.format(body=body)})
    assert {one.topic for one in found.publishes} == {"/robot/q<count>"}
