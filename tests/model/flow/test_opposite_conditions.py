"""Names that are the same whether a condition holds or not."""

import pytest
from joining import graph

CODE = """
    class A : public rclcpp::Node {{
     public:
      A() : Node("a") {{
        std::string name = ask();
        pub_ = create_publisher<std_msgs::msg::String>(name, 1);
      }}
      std::string ask() {{
        if ({asked}) {{ return "{yes}"; }}
        return "{no}";
      }}
      rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
    }};
    int main(int argc, char ** argv) {{ rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<A>()); }}
"""


@pytest.mark.parametrize(("asked", "yes", "no", "expected"), [
    ("ready == 1", "/a", "/a", {("/a", "")}),
    ("ready", "/a", "/a", {("/a", "")}),
    ("!ready", "/a", "/a", {("/a", "")}),
    ("ready == 1", "/a", "/b", {("/a", "ready == 1"), ("/b", "!(ready == 1)")}),
])  # fmt: skip
def test_a_name_that_is_so_either_way_hangs_on_nothing(asked, yes, no, expected):
    found = graph({"p/a.cpp": CODE.format(asked=asked, yes=yes, no=no)})
    published = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {(one.topic, one.only_if) for one in published} == expected
