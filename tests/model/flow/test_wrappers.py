"""Wrappers around the frameworks that are widely used, each as its users write it."""

import pytest
from joining import ends, graph

ROS2 = """
    class Hub : public rclcpp::Node {{
     public:
      Hub() : Node("hub") {{ {body} }}
      void heard(const std::shared_ptr<const std_msgs::msg::Bool>& m) {{}}
      void asked(const std::shared_ptr<std_srvs::srv::SetBool::Request> a, Answer b) {{}}
      void work() {{}}
      bool check(int goal) {{ return true; }}
      {members}
    }};
    int main(int c, char** v) {{ rclcpp::spin(std::make_shared<Hub>()); }}
"""
BOOL, CLOUD, IMAGE, SET = "std_msgs/Bool", "sensor_msgs/PointCloud2", "sensor_msgs/Image", "std_srvs/SetBool"
TABLE = [
    ('a_ = swri::advertise<std_msgs::msg::Bool>(*this, "x", 1);', "swri::Publisher a_;", "publisher", BOOL, ""),
    ('a_ = swri::Subscriber(*this, "x", 1, &Hub::heard, this);', "swri::Subscriber a_;", "subscriber", BOOL, "heard"),
    ('a_ = swri::ServiceServer(*this, "x", &Hub::asked, this);', "swri::ServiceServer a_;", "server", SET, "asked"),
    ('a_ = point_cloud_transport::create_publisher(this, "x");', "", "publisher", CLOUD, ""),
    ('a_ = point_cloud_transport::create_subscription(this, "x", std::bind(&Hub::work, this), "raw");', "",
     "subscriber", CLOUD, "work"),
    ('point_cloud_transport::PointCloudTransport t(*this); a_ = t.advertise("x", 1);', "", "publisher", CLOUD, ""),
    ('image_transport::ImageTransport t(*this); a_ = t.advertise("x", 1);', "", "publisher", IMAGE, ""),
    ('a_ = image_transport::create_publisher(this, "x");', "", "publisher", IMAGE, ""),
    ('a_ = create_generic_client("x", "std_srvs/srv/SetBool");', "", "client", SET, ""),
    ('a_ = create_generic_service("x", "std_srvs/srv/SetBool", std::bind(&Hub::work, this));', "", "server", SET,
     "work"),
    ('a_ = create_generic_publisher("x", "std_msgs/msg/Bool", 1);', "", "publisher", BOOL, ""),
    ("", 'autoware_utils::InterProcessPollingSubscriber<std_msgs::msg::Bool> a_{this, "x"};', "subscriber", BOOL, ""),
    ('a_ = nav2::interfaces::create_service<std_srvs::srv::SetBool>(this, "x", std::bind(&Hub::work, this));', "",
     "server", SET, "work"),
    ('a_ = std::make_unique<nav2::ServiceServer<std_srvs::srv::SetBool>>("x", this, std::bind(&Hub::work, this));',
     "", "server", SET, "work"),
]  # fmt: skip


@pytest.mark.parametrize("body, members, role, kind, callback", TABLE)
def test_wrappers_of_ros_2(body, members, role, kind, callback):
    found = graph({"p/hub.cpp": ROS2.format(body=body, members=members)})
    (one,) = (e for e in found.endpoints if not e.implied)
    assert (one.role, one.topic, one.type) == (role, "/x", kind)
    assert (one.callback.name if one.callback else "").removeprefix("Hub::") == callback


@pytest.mark.parametrize(
    "made",
    [
        'nav2::interfaces::create_action_server<a_msgs::action::Go>(this, "go", {0})',
        'node->create_action_server<a_msgs::action::Go>("go", {0})',
        'std::make_unique<nav2::SimpleActionServer<a_msgs::action::Go>>(this, "go", {0})',
        'std::make_unique<nav2_util::SimpleActionServer<a_msgs::action::Go>>(a(), b(), c(), d(), "go", {0})',
    ],
)
def test_what_does_the_work_is_the_callback_of_an_action_server(made):
    given = "std::bind(&Hub::work, this), std::bind(&Hub::check, this, std::placeholders::_1)"
    body = f"rclcpp::Node::SharedPtr node; a_ = {made.format(given)};"
    found = graph({"p/hub.cpp": ROS2.format(body=body, members="")})
    (one,) = (e for e in found.endpoints if e.role == "action server")
    assert (one.topic, one.type, one.callback.name) == ("/go", "a_msgs/Go", "Hub::work")


@pytest.mark.parametrize("inner", ["plain_", 'create_publisher<std_msgs::msg::Bool>("x", 1)'])
def test_a_publisher_in_a_publisher(inner):
    body = f"""
        {'plain_ = create_publisher<std_msgs::msg::Bool>("x", 1);' if inner == "plain_" else ""}
        fast_ = std::make_unique<realtime_tools::RealtimePublisher<std_msgs::msg::Bool>>({inner});
        fast_->try_publish(message_);
    """
    members = """
        rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr plain_;
        std::unique_ptr<realtime_tools::RealtimePublisher<std_msgs::msg::Bool>> fast_;
        std_msgs::msg::Bool message_;
    """
    found = graph({"p/hub.cpp": ROS2.format(body=body, members=members)})
    assert [(publish.topic, publish.type) for publish in found.publishes] == [("/x", BOOL)]


def test_transforms_that_a_filter_waits_for_do_not_run_its_callback():
    body = """
        buffer_ = std::make_shared<tf2_ros::Buffer>(get_clock());
        listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_);
        input_.subscribe(this, "scan");
        filter_ = std::make_shared<tf2_ros::MessageFilter<sensor_msgs::msg::LaserScan>>(input_, *buffer_, *listener_);
        filter_->registerCallback(std::bind(&Hub::work, this));
    """
    members = "message_filters::Subscriber<sensor_msgs::msg::LaserScan> input_;"
    found = graph({"p/hub.cpp": ROS2.format(body=body, members=members)})
    told = {e.topic: e.callback.name if e.callback else "" for e in found.endpoints}
    assert told == {"/scan": "Hub::work", "/tf": "", "/tf_static": ""}


def test_a_member_that_points_to_a_wrapper_is_none_yet():
    members = "nav2_util::ServiceClient<std_srvs::srv::SetBool>::SharedPtr client_;"
    assert not graph({"p/hub.cpp": ROS2.format(body="", members=members)}).endpoints


def test_point_clouds_of_pcl():
    main = """
        typedef pcl::PointCloud<pcl::PointXYZ> Cloud;
        int main(int c, char** v) {
          ros::init(c, v, "hub");
          ros::NodeHandle n;
          ros::Publisher a = n.advertise<Cloud>("a", 1);
          pcl_ros::Publisher<pcl::PointXYZ> b(n, "b", 1);
          diagnostic_updater::DiagnosedPublisher<std_msgs::Header> d(n.advertise<std_msgs::Header>("d", 1), u, f, t);
        }
    """
    assert ends(graph({"p/hub.cpp": main}, 1), "publisher") == {
        ("p/hub", "/a", CLOUD), ("p/hub", "/b", CLOUD), ("p/hub", "/d", "std_msgs/Header"),
    }  # fmt: skip


def test_a_helper_of_the_workspace_that_hands_on_the_name_beside_a_node():
    """Its callers declare; what it does itself is none of its own."""
    helper = """
        namespace nav2_util {
        template <typename NodeT>
        void declare_parameter_if_not_declared(NodeT node, const std::string& name, const ParameterValue& value) {
          if (!node->has_parameter(name)) { node->declare_parameter(name, value); }
        }
        }
    """
    code = """
        #include "util.hpp"
        class Dock : public rclcpp::Node {
         public:
          Dock() : Node("dock") {
            nav2_util::declare_parameter_if_not_declared(this, "speed", rclcpp::ParameterValue(1.0));
          }
        };
        int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Dock>()); }
    """
    found = graph({"deck/util.hpp": helper, "deck/dock.cpp": code})
    assert [(one.path, one.name) for one in found.parameters] == [("deck/dock.cpp", "speed")]


@pytest.mark.parametrize(("space", "names"), [("serial", set()), ("pcl_ros", {"/b"})])
def test_a_class_of_the_workspace_that_is_called_like_a_wrapper(space, names):
    """Its own class of another namespace is none; the wrapper itself, in the workspace, is one."""
    wrapper = f"""
        namespace {space} {{
        template <typename T>
        class Publisher {{
         public:
          Publisher(ros::NodeHandle& n, const std::string& topic, int queue) {{}}
        }};
        }}
    """
    main = f"""
        #include "publisher.hpp"
        using namespace {space};
        int main(int c, char** v) {{
          ros::init(c, v, "hub");
          ros::NodeHandle n;
          auto b = std::make_shared<Publisher<pcl::PointXYZ>>(n, "b", 1);
        }}
    """
    found = graph({"p/publisher.hpp": wrapper, "p/hub.cpp": main}, 1)
    assert {name for _, name, _ in ends(found, "publisher")} - {"/rosout"} == names
