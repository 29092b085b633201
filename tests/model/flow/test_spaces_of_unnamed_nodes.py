"""Nodes whose own name is not one, and whose namespace the code gives."""

import pytest
from joining import graph

CPP = """
    #include <rclcpp/rclcpp.hpp>
    class Robot : public rclcpp::Node {{
     public:
      Robot(const std::string & name, const std::string & space) : Node(name, space) {{
        pub_ = create_publisher<std_msgs::msg::String>("out", 1);
        far_ = create_publisher<std_msgs::msg::String>("/far", 1);
      }}
      rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_, far_;
    }};
    int main(int argc, char ** argv) {{
      rclcpp::init(argc, argv);
      for (const std::string name : {{"a", "b"}}) {{ rclcpp::spin(std::make_shared<Robot>(name, {space})); }}
    }}
"""
PYTHON = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String
    class Robot(Node):
        def __init__(self, name, space):
            super().__init__(name, namespace=space)
            self.pub = self.create_publisher(String, "out", 1)
            self.far = self.create_publisher(String, "/far", 1)
    rclpy.init()
    for name in ("a", "b"):
        rclpy.spin(Robot(name, {space}))
"""


@pytest.mark.parametrize(("space", "expected"), [
    ('"fleet"', {("/fleet/out", "literal"), ("/far", "literal")}),
    ('""', {("/out", "literal"), ("/far", "literal")}),
    ("ask()", {("/<namespace>/out", "partly"), ("/far", "literal")}),
])  # fmt: skip
def test_relative_names_are_in_the_namespace_that_is_known(space, expected):
    for path, text in (("p/a.cpp", CPP), ("p/a.py", PYTHON)):
        found = graph({path: text.format(space=space)})
        published = {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied}
        assert published == expected
