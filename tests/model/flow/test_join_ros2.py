"""ROS 2 nodes in C++ and Python, ROS 1 nodes in Python, and a framework that is not ROS."""

from joining import ends, graph, joined

COMPONENT = """
    #include <rclcpp/rclcpp.hpp>
    using namespace std::chrono_literals;
    namespace demo {
    using Twist = geometry_msgs::msg::Twist;
    class Driver : public rclcpp::Node {
     public:
      explicit Driver(const rclcpp::NodeOptions& options) : rclcpp::Node("engine", options) {
        topic_ = this->declare_parameter("topic", "cmd_vel");
        pub_ = create_publisher<Twist>(topic_, rclcpp::QoS(1).transient_local());
        sub_ = this->create_subscription<sensor_msgs::msg::LaserScan>(
          "~/scan", rclcpp::SensorDataQoS(), [this](sensor_msgs::msg::LaserScan::ConstSharedPtr m) { last_ = m; });
        timer_ = create_wall_timer(100ms, std::bind(&Driver::tick, this));
        server_ = create_service<std_srvs::srv::Trigger>("stop", std::bind(&Driver::stop, this, _1, _2));
        client_ = create_client<std_srvs::srv::Empty>("/reset");
      }
     private:
      void tick() {
        if (last_ == nullptr) { return; }
        Twist m;
        pub_->publish(m);
      }
      void stop(const std::shared_ptr<std_srvs::srv::Trigger::Request> a,
                std::shared_ptr<std_srvs::srv::Trigger::Response> b) {}
      std::string topic_;
      rclcpp::Publisher<Twist>::SharedPtr pub_;
      sensor_msgs::msg::LaserScan::ConstSharedPtr last_;
    };
    }
    RCLCPP_COMPONENTS_REGISTER_NODE(demo::Driver)
"""


def test_a_component():
    found = graph({"demo/src/driver.cpp": COMPONENT})
    (node,) = found.nodes
    assert (node.kind, node.plugin, node.name) == ("component", "demo::Driver", "/engine")
    assert ends(found, "publisher") == {(node.id, "/cmd_vel", "geometry_msgs/Twist")}
    assert ends(found, "subscriber") == {(node.id, "/engine/scan", "sensor_msgs/LaserScan")}
    assert ends(found, "server") == {(node.id, "/stop", "std_srvs/Trigger")}
    assert ends(found, "client") == {(node.id, "/reset", "std_srvs/Empty")}
    by_role = {endpoint.role: endpoint for endpoint in found.endpoints}
    assert by_role["publisher"].how == "default"
    assert by_role["publisher"].qos.durability == "transient_local"
    assert by_role["publisher"].qos.reliability == "reliable"
    assert by_role["subscriber"].qos.reliability == "best_effort"
    assert "lambda@" in by_role["subscriber"].callback.name
    (publish,) = found.publishes
    assert [(g.kind, g.text) for g in publish.guards] == [("unless", "last_ == nullptr")]
    assert [(t.kind, t.detail) for t in publish.triggers] == [("timer", "100ms")]


def test_a_wrapper_of_a_node_is_seen_through():
    found = graph({
        "util/include/util/node.hpp": """
            namespace util {
            class Node : public rclcpp::Node {
             public:
              explicit Node(const std::string& name) : rclcpp::Node(name) {}
            };
            }
        """,
        "app/src/app.cpp": """
            class App : public util::Node {
             public:
              App() : util::Node("app") { out_ = create_publisher<std_msgs::msg::Bool>("out", 1); }
              void on(bool v) { out_->publish(b_); }
              rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr out_;
              std_msgs::msg::Bool b_;
            };
            int main(int c, char** v) { rclcpp::spin(std::make_shared<App>()); }
        """,
    })  # fmt: skip
    assert ends(found, "publisher") == {("app/app", "/out", "std_msgs/Bool")}
    assert [publish.topic for publish in found.publishes] == ["/out"]
    assert found.nodes[0].name == "/app"


def test_python_of_ros_2():
    found = graph({"demo/demo/talker.py": """
        import rclpy
        from rclpy.node import Node
        from rclpy.qos import QoSProfile, ReliabilityPolicy
        from std_msgs.msg import String

        TOPIC = "chat"

        class Talker(Node):
            def __init__(self):
                super().__init__("talker")
                self.declare_parameter("echo", "echo")
                qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
                self.pub = self.create_publisher(String, TOPIC + "ter", qos)
                self.sub = self.create_subscription(String, self.get_parameter("echo").value, self.on_echo, 10)
                self.create_timer(0.5, self.tick)
                self.count = 0

            def on_echo(self, message):
                pass

            def tick(self):
                self.count += 1
                if self.count % 2:
                    self.pub.publish(String(data="x"))

        def main():
            rclpy.init()
            rclpy.spin(Talker())
    """})  # fmt: skip
    node = "demo/talker.py"
    assert found.nodes[0].name == "/talker"
    assert ends(found, "publisher") == {(node, "/chatter", "std_msgs/String")}
    assert ends(found, "subscriber") == {(node, "/echo", "std_msgs/String")}
    by_role = {endpoint.role: endpoint for endpoint in found.endpoints}
    assert by_role["publisher"].qos.reliability == "best_effort"
    assert by_role["publisher"].qos.depth == 5
    assert by_role["subscriber"].how == "default"
    assert by_role["subscriber"].callback.name == "Talker.on_echo"
    (publish,) = found.publishes
    assert [(g.kind, g.text) for g in publish.guards] == [("if", "self.count % 2")]
    assert publish.triggers[0].kind == "timer"


def test_python_of_ros_1():
    found = graph({"demo/scripts/node.py": """
        #!/usr/bin/env python
        import rospy
        from std_msgs.msg import String
        from std_srvs.srv import Empty

        def callback(message):
            if message.data == "go":
                pub.publish(message)

        rospy.init_node("relay")
        pub = rospy.Publisher("out", String, queue_size=1, latch=True)
        rospy.Subscriber(rospy.get_param("~input", "in"), String, callback)
        rospy.Service("~reset", Empty, lambda request: None)
        rospy.spin()
    """}, 1)  # fmt: skip
    node = "demo/node.py"
    assert ends(found, "publisher") == {(node, "/out", "std_msgs/String")}
    assert ends(found, "subscriber") == {(node, "/in", "std_msgs/String")}
    assert ends(found, "server") == {(node, "/relay/reset", "std_srvs/Empty")}
    publisher = next(e for e in found.endpoints if e.role == "publisher" and not e.implied)
    assert publisher.qos.durability == "transient_local"
    (publish,) = found.publishes
    assert [(g.kind, g.text) for g in publish.guards] == [("if", "message.data == 'go'")] or [
        (g.kind, g.text) for g in publish.guards
    ] == [("if", 'message.data == "go"')]
    assert [(t.kind, t.detail) for t in publish.triggers] == [("subscriber", "in")]


def test_moos_is_rows_of_the_table():
    found = graph({"pHelm/Helm.cpp": """
        class Helm : public CMOOSApp {
          bool OnConnectToServer() { Register("NAV_X", 0); return true; }
          bool OnNewMail(MOOSMSG_LIST& mail) { if (ready_) Notify("DESIRED_SPEED", 1.5); return true; }
          bool ready_;
        };
        int main() { Helm helm; helm.Run("helm", "mission.moos"); }
    """})  # fmt: skip
    assert ends(found, "subscriber") == {("pHelm/Helm", "NAV_X", "*")}
    subscriber = next(e for e in found.endpoints if e.role == "subscriber")
    assert subscriber.callback.name == "Helm::OnNewMail"
    (publish,) = found.publishes
    assert (publish.topic, publish.expression) == ("DESIRED_SPEED", "1.5")
    assert [g.text for g in publish.guards] == ["ready_"]
    assert publish.triggers[0].kind == "subscriber"


def test_a_function_that_is_named_as_the_frameworks_own_is_a_wrapper():
    join = joined({"p/a.cpp": """
        template<class T>
        std::shared_ptr<rclcpp::Publisher<T>> create_publisher(rclcpp::Node* node, const std::string& topic) {
          return node->create_publisher<T>(topic, 10);
        }
    """})  # fmt: skip
    assert join.sites.endpoints == []
    assert [use.call.line for use in join.sites.wrapped] == [4]
    (wrapper,) = join.build().coverage.wrappers
    assert wrapper.line == 4


def test_a_class_of_the_same_name_in_another_package_is_another_class():
    source = """
        namespace {name} {{
        class Node : public rclcpp::Node {{
         public:
          explicit Node(const rclcpp::NodeOptions& o) : rclcpp::Node("{name}", o) {{
            pub_ = create_publisher<std_msgs::msg::Bool>("{name}_topic", 1);
          }}
          rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
        }};
        }}
        RCLCPP_COMPONENTS_REGISTER_NODE({name}::Node)
    """
    found = graph({f"{name}/node.cpp": source.format(name=name) for name in ("one", "two")})
    assert ends(found, "publisher") == {
        ("one/one::Node", "/one_topic", "std_msgs/Bool"),
        ("two/two::Node", "/two_topic", "std_msgs/Bool"),
    }


def test_actions():
    found = graph({"demo/deliver.cpp": """
        class Deliver : public rclcpp::Node {
         public:
          Deliver() : Node("deliver") {
            server_ = rclcpp_action::create_server<nav2_msgs::action::NavigateToPose>(
              this, "deliver", [this](auto, auto) { return ok(); }, [this](auto) { return ok(); }, [this](auto) {});
            client_ = rclcpp_action::create_client<nav2_msgs::action::Wait>(this, "wait");
          }
        };
        int main(int c, char** v) { rclcpp::spin(std::make_shared<Deliver>()); }
    """})  # fmt: skip
    assert ends(found, "action server") == {("demo/deliver", "/deliver", "nav2_msgs/NavigateToPose")}
    assert ends(found, "action client") == {("demo/deliver", "/wait", "nav2_msgs/Wait")}
    assert found.coverage.resolved == found.coverage.calls


def test_what_an_action_sends_by_itself_has_types_of_its_own():
    found = graph({"p/a.cpp": """
        using Dock = nav2_msgs::action::DockRobot;
        class A : public rclcpp::Node {
         public:
          A() : Node("a") {
            one_ = create_subscription<Dock::Impl::FeedbackMessage>("dock/_action/feedback", 1, [](auto msg) {});
            two_ = create_subscription<nav2_msgs::action::DockRobot::Impl::GoalStatusMessage>(
              "dock/_action/status", 1, [](auto msg) {});
          }
        };
        int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<A>()); }
    """})  # fmt: skip
    assert {(topic, type_) for _, topic, type_ in ends(found, "subscriber")} == {
        ("/dock/_action/feedback", "nav2_msgs/DockRobot_FeedbackMessage"),
        ("/dock/_action/status", "action_msgs/GoalStatusArray"),
    }
