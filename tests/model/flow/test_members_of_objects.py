"""A member's value from an assignment is that of the object it is assigned to."""

import pytest
from joining import ends, graph

STRUCT = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/string.hpp>
    struct Params {{
      Params() = default;
      Params(const std::string& name, int depth = 1) : topic(name), depth_(depth) {{}}
      std::string topic;
      int depth_;
    }};
    {code}
"""
READER = """
    class Reader : public rclcpp::Node {
     public:
      explicit Reader(const Params& params) : Node("reader") {
        pub_ = create_publisher<std_msgs::msg::String>(params.topic, 1);
      }
      rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
    };
"""


@pytest.mark.parametrize(
    ("main", "expected"),
    [
        ('Params params; params.topic = "a"; Reader reader(params);', {"/a"}),
        ('Params given; given.topic = "a"; Params copy = given; Reader reader(copy);', {"/a"}),
        ('Params a; a.topic = "a"; Params b; b.topic = "b"; Reader reader(b);', {"/b"}),
        ('Params a; a.topic = "a"; Params b; b.topic = "b"; Reader one(a); Reader two(b);', {"/a", "/b"}),
        ('Params a("a"); Params b("b"); Reader reader(b);', {"/b"}),
        ('Params a("a"); Params b("b"); auto reader = std::make_shared<Reader>(b);', {"/b"}),
        ("Params params; fill(params); Reader reader(params);", {"/filled"}),
        ("Params params = made(); Reader reader(params);", {"/made"}),
        # Nothing makes a reader: of which object the name is, is not known.
        ('Params params; params.topic = "a";', {"?"}),
        ('Params params("a");', {"?"}),
        ('Params other; other.topic = "a"; Params params; Reader reader(params);', {"?"}),
    ],
)
def test_a_member_is_that_of_the_object_that_is_passed(main, expected):
    functions = (
        'void fill(Params& p) { p.topic = "filled"; }\nParams made() { Params p; p.topic = "made"; return p; }\n'
    )
    code = f"{READER}\n{functions}int main() {{ {main} }}"
    found = graph({"p/main.cpp": STRUCT.format(code=code)})
    assert {topic for _, topic, _ in ends(found, "publisher")} == expected


def test_what_a_class_gives_all_its_objects_is_theirs():
    struct = STRUCT.replace("std::string topic;", 'std::string topic = "declared";')
    main = 'int main() { Params other; other.topic = "other"; }'
    found = graph({"p/main.cpp": struct.format(code=READER + main)})
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"/declared"}
