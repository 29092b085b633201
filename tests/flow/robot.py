"""A small robot's message-flow graph, made from sources."""

from textwrap import dedent

from rosimpact.impact.facts.cpp import flow as flow_cpp
from rosimpact.impact.model.flow.graph import Graph
from rosimpact.impact.model.flow.join import Join
from rosimpact.impact.model.flow.nodes import BuiltPackage

DRIVER = """
    class Driver : public rclcpp::Node {
     public:
      Driver() : Node("driver") {
        pub_ = create_publisher<sensor_msgs::msg::LaserScan>("scan", rclcpp::SensorDataQoS());
        timer_ = create_wall_timer(100ms, [this]() { if (ready_) pub_->publish(scan_); });
        server_ = create_service<std_srvs::srv::Trigger>("calibrate", std::bind(&Driver::calibrate, this, _1, _2));
      }
      void calibrate(const std::shared_ptr<std_srvs::srv::Trigger::Request> a,
                     std::shared_ptr<std_srvs::srv::Trigger::Response> b) {}
      rclcpp::Publisher<sensor_msgs::msg::LaserScan>::SharedPtr pub_;
      sensor_msgs::msg::LaserScan scan_;
      bool ready_;
    };
    int main(int c, char** v) { rclcpp::spin(std::make_shared<Driver>()); }
"""
PLANNER = """
    class Planner : public rclcpp::Node {
     public:
      Planner() : Node("planner") {
        sub_ = create_subscription<sensor_msgs::msg::LaserScan>("scan", 10, std::bind(&Planner::onScan, this, _1));
        pub_ = create_publisher<nav_msgs::msg::Path>("plan", 1);
        other_ = create_publisher<nav_msgs::msg::Path>(unknown(), 1);
        client_ = create_client<std_srvs::srv::Trigger>("calibrate");
      }
      void onScan(sensor_msgs::msg::LaserScan::ConstSharedPtr scan) { pub_->publish(path_); }
      rclcpp::Publisher<nav_msgs::msg::Path>::SharedPtr pub_, other_;
      nav_msgs::msg::Path path_;
    };
    int main(int c, char** v) { rclcpp::spin(std::make_shared<Planner>()); }
"""
MOVER = """
    class Mover : public rclcpp::Node {
     public:
      Mover() : Node("mover") {
        sub_ = create_subscription<nav_msgs::msg::Path>("plan", 1, [](nav_msgs::msg::Path::ConstSharedPtr) {});
      }
    };
    int main(int c, char** v) { rclcpp::spin(std::make_shared<Mover>()); }
"""


def robot(**sources: str) -> Graph:
    """The graph of driver, planner and mover; sources: other text for one of them, or further packages."""
    texts = {"driver": DRIVER, "planner": PLANNER, "mover": MOVER, **sources}
    files = {f"{name}/{name}.cpp": flow_cpp.extract(dedent(text).encode()) for name, text in texts.items() if text}
    built = [BuiltPackage(path.split("/")[0], {path.split("/")[0]: (path,)}, {}, {}, {}, {}) for path in files]
    return Join(files, lambda path: path.split("/")[0], built, 2).build("ws")
