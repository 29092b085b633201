"""Types of endpoints in C++ templates: what the code gives for the parameters, where it is made."""

from joining import ends, graph

BASE = """
    namespace calls {
    template <class ServiceT, int N = 3>
    class Caller : public rclcpp::Node {
     public:
      Caller() : Node("caller") {
        client_ = create_client<ServiceT>("call");
        begin();
      }
      void begin();
      typename rclcpp::Client<ServiceT>::SharedPtr client_;
    };
    template <typename S, int M>
    void Caller<S, M>::begin() { server_ = create_service<S>("served", [](auto, auto) {}); }

    template <typename T>
    class Twice : public Caller<T> {};
    class Clearer : public Caller<std_srvs::srv::Empty, 1> {};
    class Setter : public Twice<std_srvs::srv::SetBool> {};
    template <typename M>
    auto listen(rclcpp::Node* node) { return node->create_publisher<M>("heard", 1); }
    }
"""


def main(body: str) -> str:
    return f'#include "base.hpp"\nint main(int c, char** v) {{ rclcpp::init(c, v); {body} }}\n'


def test_each_program_has_the_type_that_its_class_gives():
    """Through a base, a base's base, a member function outside of its class, and an object of the template itself,
    beside Python."""
    found = graph({
        "p/a.py": "import rclpy",
        "p/base.hpp": BASE,
        "p/clear.cpp": main("rclcpp::spin(std::make_shared<calls::Clearer>());"),
        "p/set.cpp": main("rclcpp::spin(std::make_shared<calls::Setter>());"),
        "p/own.cpp": main("auto one = std::make_shared<calls::Caller<std_srvs::srv::Trigger>>(); rclcpp::spin(one);"),
    })  # fmt: skip
    assert ends(found, "client") == {
        ("p/clear", "/call", "std_srvs/Empty"), ("p/set", "/call", "std_srvs/SetBool"),
        ("p/own", "/call", "std_srvs/Trigger"),
    }  # fmt: skip
    assert {(node, type_) for node, _, type_ in ends(found, "server")} == {
        ("p/clear", "std_srvs/Empty"), ("p/set", "std_srvs/SetBool"), ("p/own", "std_srvs/Trigger"),
    }  # fmt: skip
    assert {one.line for one in found.coverage.unresolved} == {21}  # of `listen`, which is not called


def test_function_templates_are_given_types_by_their_callers():
    found = graph({
        "p/base.hpp": BASE,
        "p/a.cpp": main('rclcpp::Node n("a"); auto pub = calls::listen<std_msgs::msg::Bool>(&n);'),
        "p/b.cpp": main('rclcpp::Node n("b"); auto pub = calls::listen<std_msgs::msg::Int8>(&n);'),
    })  # fmt: skip
    assert ends(found, "publisher") == {("p/a", "/heard", "std_msgs/Bool"), ("p/b", "/heard", "std_msgs/Int8")}


def test_a_parameter_that_nothing_gives_is_no_type():
    text = """
        namespace lone_msgs {
        template <class ServiceT>
        class Caller : public rclcpp::Node {
          Caller() : Node("caller") { client_ = create_client<ServiceT>("call"); }
        };
        }
    """
    found = graph({"p/base.hpp": text})
    assert {type_ for _, _, type_ in ends(found, "client")} == {""}
    (one,) = found.coverage.unresolved
    assert (one.what, one.reason) == ("client type", "nothing here fixes the parameter `ServiceT` of the template")
