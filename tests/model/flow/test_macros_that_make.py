"""Function-like macros that make endpoints, or put their names together."""

import pytest
from joining import graph, manifest

CODE = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/empty.hpp>
    DEFINES
    class Arm : public rclcpp::Node {
     public:
      Arm() : Node("arm") {
        BODY
      }
      void hear(std_msgs::msg::Empty::SharedPtr) {}
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
      rclcpp::SubscriptionBase::SharedPtr sub_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      rclcpp::spin(std::make_shared<Arm>());
    }
"""
PUB = "#define PUB(type, name) this->create_publisher<std_msgs::msg::type>(name, 1)"


def list_ends(defines: str, body: str) -> set[tuple[str, str]]:
    code = CODE.replace("DEFINES", defines.replace("\n", "\n    ")).replace("BODY", body)
    found = graph({"p/package.xml": manifest("p", "ament_cmake"), "p/arm.cpp": code})
    return {(e.role, e.topic or "?") for e in found.endpoints if not e.implied}


@pytest.mark.parametrize(
    ("defines", "body", "expected"),
    [
        (PUB, 'pub_ = PUB(Empty, "a");', {("publisher", "/a")}),
        (PUB, 'pub_ = PUB(Empty,\n  "a"); pub_ = PUB(Empty, "b");', {("publisher", "/a"), ("publisher", "/b")}),
        (
            "#define HEAR(name) \\\n  sub_ = create_subscription<std_msgs::msg::Empty>( \\\n    #name, 1, "
            "std::bind(&Arm::hear, this, std::placeholders::_1));",
            "HEAR(a)",
            {("subscriber", "/a")},
        ),
        (f'{PUB}\n#define IN(name) "arm/" name', 'pub_ = PUB(Empty, IN("a"));', {("publisher", "/arm/a")}),
        (
            f'{PUB}\n#define BOTH(name) pub_ = PUB(Empty, name "/x"); pub_ = PUB(Empty, name "/y")', 'BOTH("a");',
            {("publisher", "/a/x"), ("publisher", "/a/y")},
        ),
        ("#define MAKE(kind, ...) create_##kind<std_msgs::msg::Empty>(__VA_ARGS__)", 'pub_ = MAKE(publisher, "a", 1);',
         {("publisher", "/a")}),
        ('#define NAME(x) "arm/" #x', "pub_ = create_publisher<std_msgs::msg::Empty>(NAME(a), 1);",
         {("publisher", "/arm/a")}),
    ],
)  # fmt: skip
def test_what_a_macro_makes(defines, body, expected):
    assert list_ends(defines, body) == expected


@pytest.mark.parametrize(
    ("defines", "body"),
    [
        (PUB, ""),  # nothing is made where it is only defined
        (PUB, '// PUB(Empty, "a")'),
        (PUB, 'log("PUB(Empty, a)");'),
        (PUB, 'pub_ = PUB("a");'),  # it takes two
        (f"#ifdef SIM\n{PUB}\n#else\n{PUB.replace('name', 'n').replace('1', '2')}\n#endif", 'pub_ = PUB(Empty, "a");'),
        (f"{PUB}\n#undef PUB", 'pub_ = PUB(Empty, "a");'),
    ],
)
def test_what_no_macro_makes(defines, body):
    assert list_ends(defines, body) == set()


def test_lines_stay_where_they_are():
    code = CODE.replace("DEFINES", PUB).replace("BODY", 'pub_ = PUB(\n  Empty,\n  "a");\n pub_ = PUB(Empty, "b");')
    found = graph({"p/package.xml": manifest("p", "ament_cmake"), "p/arm.cpp": code})
    assert {(e.topic, e.line) for e in found.endpoints if not e.implied} == {("/a", 8), ("/b", 11)}


def test_what_would_become_too_long_is_left_as_it_is():
    """Each macro doubles what the one before stands for."""
    macros = ['#define M0(x) create_publisher<std_msgs::msg::Empty>("a", 1); ' + " " * 500]
    macros += [f"#define M{n}(x) {f'M{n - 1}(x) ' * 40}" for n in range(1, 5)]
    assert list_ends("\n".join(macros), "M4(1)") == set()
    assert list_ends("\n".join(macros), "M0(1)") == {("publisher", "/a")}
