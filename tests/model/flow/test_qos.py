"""Quality of service as the code writes it, in all its nestings."""

import pytest
from joining import graph

NODE = """
    {before}
    class Horn : public rclcpp::Node {{
     public:
      Horn() : Node("horn") {{
        other_ = create_publisher<std_msgs::msg::Bool>("other", rclcpp::QoS(99).reliable().transient_local());
        pub_ = create_publisher<std_msgs::msg::Bool>("loud", {qos});
      }}
      {member}
    }};
    int main(int c, char** v) {{ rclcpp::spin(std::make_shared<Horn>()); }}
"""
MEMBER = "rclcpp::QoS latched_ = rclcpp::QoS(6).best_effort().transient_local();"
CONSTANT = "const rclcpp::QoS kLatched = rclcpp::QoS(6).best_effort().transient_local();"
FUNCTION = "rclcpp::QoS latched() { return rclcpp::QoS(6).best_effort().transient_local(); }"


@pytest.mark.parametrize(
    "qos, expected, before, member",
    [
        ("rclcpp::QoS(10).reliable().transient_local()", ("reliable", "transient_local", "keep_last", 10), "", ""),
        ("rclcpp::QoS{4}.best_effort()", ("best_effort", "volatile", "keep_last", 4), "", ""),
        ("rclcpp::QoS(rclcpp::KeepLast(7)).best_effort().transient_local()",
         ("best_effort", "transient_local", "keep_last", 7), "", ""),
        ("rclcpp::QoS(10).durability(RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL).best_effort()",
         ("best_effort", "transient_local", "keep_last", 10), "", ""),
        ("rclcpp::SensorDataQoS().keep_last(2).reliable()", ("reliable", "volatile", "keep_last", 2), "", ""),
        ("latched_", ("best_effort", "transient_local", "keep_last", 6), "", MEMBER),
        ("kLatched", ("best_effort", "transient_local", "keep_last", 6), CONSTANT, ""),
        ("latched()", ("best_effort", "transient_local", "keep_last", 6), FUNCTION, ""),
        ("latched().reliable()", ("reliable", "", "", -1), "", ""),  # of what is not known only what is set is
    ],
)  # fmt: skip
def test_chains_of_settings(qos, expected, before, member):
    found = graph({"p/horn.cpp": NODE.format(qos=qos, before=before, member=member)})
    one = next(e.qos for e in found.endpoints if e.topic == "/loud")
    assert (one.reliability, one.durability, one.history, one.depth) == expected


def test_a_name_from_one_of_two_parameters_that_are_declared_on_a_line():
    made = 'create_publisher<std_msgs::msg::Bool>(declare_parameter("{}", "{}").as_string(), 1);'
    main = f"""
        class Horn : public rclcpp::Node {{
          Horn() : Node("horn") {{ a_ = {made.format("a", "one")} b_ = {made.format("b", "two")} }}
        }};
        int main(int c, char** v) {{ rclcpp::spin(std::make_shared<Horn>()); }}
    """
    found = graph({"p/horn.cpp": main})
    assert {(e.variable, e.topic) for e in found.endpoints} == {("a_", "/one"), ("b_", "/two")}
