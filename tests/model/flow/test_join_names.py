"""Names that depend on who runs the code, and names that are none."""

from joining import ends, graph

SHARED = """
    class Out {
     public:
      Out(rclcpp::Node* node, const std::string& topic) {
        pub_ = node->create_publisher<geometry_msgs::msg::Twist>(topic, 1);
      }
      void send() { pub_->publish(message_); }
      rclcpp::Publisher<geometry_msgs::msg::Twist>::SharedPtr pub_;
      geometry_msgs::msg::Twist message_;
    };
"""


def program(name: str, topics: str) -> str:
    made = "".join(f'Out o{place}(&node, "{topic}"); o{place}.send(); ' for place, topic in enumerate(topics.split()))
    return f'#include "out.hpp"\nint main(int c, char** v) {{ rclcpp::Node node("{name}"); {made} }}\n'


def test_a_node_has_the_names_that_the_code_it_runs_gives():
    found = graph({
        "p/out.hpp": SHARED, "p/a.cpp": program("a", "one"), "p/b.cpp": program("b", "two three"),
    })  # fmt: skip
    twist = "geometry_msgs/Twist"
    assert ends(found, "publisher") == {("p/a", "/one", twist), ("p/b", "/two", twist), ("p/b", "/three", twist)}
    assert {(publish.node, publish.topic) for publish in found.publishes} == {
        ("p/a", "/one"), ("p/b", "/two"), ("p/b", "/three"),
    }  # fmt: skip


def test_a_node_is_not_called_by_what_options_replace():
    text = """
        class Panel : public rclcpp::Node {
         public:
          explicit Panel(const rclcpp::NodeOptions& o) : rclcpp::Node("_", o) {
            pub_ = create_publisher<std_msgs::msg::Bool>("~/on", 1);
          }
          rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
        };
        RCLCPP_COMPONENTS_REGISTER_NODE(Panel)
    """
    found = graph({"p/panel.cpp": text})
    assert [node.name for node in found.nodes] == ["/<panel>"]


def test_a_name_that_rospy_remaps():
    text = """
        import rospy
        from std_msgs.msg import Bool
        rospy.init_node("lamp")
        rospy.Publisher(rospy.remap_name("on"), Bool, queue_size=1)
    """
    assert ends(graph({"p/lamp.py": text}, 1), "publisher") == {("p/lamp.py", "/on", "std_msgs/Bool")}


def test_a_method_may_be_written_with_the_namespace_that_it_stands_in():
    found = graph({
        "p/lamp.hpp": """
            namespace shop {
            class Lamp : public rclcpp::Node {
              Lamp();
              void light();
              rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
            };
            }
        """,
        "p/lamp.cpp": """
            #include "lamp.hpp"
            namespace shop {
            shop::Lamp::Lamp() : Node("lamp") { pub_ = create_publisher<std_msgs::msg::Bool>("on", 1); }
            void Lamp::light() { pub_->publish(std_msgs::msg::Bool()); }
            }
            int main(int c, char** v) { rclcpp::spin(std::make_shared<shop::Lamp>()); }
        """,
    })  # fmt: skip
    assert [(publish.node, publish.topic) for publish in found.publishes] == [("p/lamp", "/on")]
