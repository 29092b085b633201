"""Uses of ROS packages that only some versions accept: each row with a line that it is about, and the line fixed."""

# ruff: noqa: E501
import json
import re

import pytest
from rosimpact.impact.facts.usage import find_use_places
from rosimpact.impact.targets.changes import DISTROS, load_uses
from rosimpact.impact.targets.tables import DATA

BOUND = re.compile(r"\d+(\.\d+)+\Z")
OURS = {
    label
    for group in json.loads((DATA / "uses_ros.json").read_bytes())["uses"]
    for label in group["uses"]
}
ROWS = {label: row for label, row in load_uses().items() if label in OURS}

# label: code that looks so, and code that does not. A label without an example is code itself.
EXAMPLES = {
    **{
        f"{macro} with boost::none, without boost/optional/optional_io.hpp": (
            f"#include <boost/optional.hpp>\n{macro}(filter.value(), boost::none);",
            f"#include <boost/optional/optional_io.hpp>\n{macro}(filter.value(), boost::none); f(boost::none);",
        )
        for macro in ("EXPECT_EQ", "EXPECT_NE", "ASSERT_EQ", "ASSERT_NE")
    },
    "add_on_set_parameters_callback()": (
        "node->add_on_set_parameters_callback(a, b);",
        "node->other(a); int add_on_set_parameters_callback = 0;",
    ),
    "create_generic_publisher()": (
        "node->create_generic_publisher(a, b);",
        "node->other(a); int create_generic_publisher = 0;",
    ),
    "create_generic_subscription()": (
        "node->create_generic_subscription(a, b);",
        "node->other(a); int create_generic_subscription = 0;",
    ),
    "remove_pending_request()": (
        "node->remove_pending_request(a, b);",
        "node->other(a); int remove_pending_request = 0;",
    ),
    "prune_pending_requests()": (
        "node->prune_pending_requests(a, b);",
        "node->other(a); int prune_pending_requests = 0;",
    ),
    "prune_requests_older_than()": (
        "node->prune_requests_older_than(a, b);",
        "node->other(a); int prune_requests_older_than = 0;",
    ),
    "add_pre_shutdown_callback()": (
        "node->add_pre_shutdown_callback(a, b);",
        "node->other(a); int add_pre_shutdown_callback = 0;",
    ),
    "wait_for_all_acked()": (
        "node->wait_for_all_acked(a, b);",
        "node->other(a); int wait_for_all_acked = 0;",
    ),
    "set_on_new_message_callback()": (
        "node->set_on_new_message_callback(a, b);",
        "node->other(a); int set_on_new_message_callback = 0;",
    ),
    "set_on_new_request_callback()": (
        "node->set_on_new_request_callback(a, b);",
        "node->other(a); int set_on_new_request_callback = 0;",
    ),
    "set_on_new_response_callback()": (
        "node->set_on_new_response_callback(a, b);",
        "node->other(a); int set_on_new_response_callback = 0;",
    ),
    "add_pre_set_parameters_callback()": (
        "node->add_pre_set_parameters_callback(a, b);",
        "node->other(a); int add_pre_set_parameters_callback = 0;",
    ),
    "add_post_set_parameters_callback()": (
        "node->add_post_set_parameters_callback(a, b);",
        "node->other(a); int add_post_set_parameters_callback = 0;",
    ),
    "enable_logger_service()": (
        "node->enable_logger_service(a, b);",
        "node->other(a); int enable_logger_service = 0;",
    ),
    "create_generic_client()": (
        "node->create_generic_client(a, b);",
        "node->other(a); int create_generic_client = 0;",
    ),
    "create_generic_service()": (
        "node->create_generic_service(a, b);",
        "node->other(a); int create_generic_service = 0;",
    ),
    "Executor::spin_all()": (
        "executor.spin_all(1s);",
        "executor.spin_some(1s);",
    ),
    "event_callbacks.message_lost_callback": (
        "options.event_callbacks.message_lost_callback = f;",
        "options.event_callbacks.deadline_callback = f;",
    ),
    "event_callbacks.incompatible_qos_callback": (
        "options.event_callbacks.incompatible_qos_callback = f;",
        "options.event_callbacks.deadline_callback = f;",
    ),
    "event_callbacks.matched_callback": (
        "options.event_callbacks.matched_callback = f;",
        "options.event_callbacks.deadline_callback = f;",
    ),
    "options.content_filter_options": (
        "options.content_filter_options.filter_expression = s;",
        "options.filter = s;",
    ),
    "Executor::add_callback_group()": (
        "executor.add_callback_group(group, base);",
        "executor.add_node(base);",
    ),
    "InitOptions::set_domain_id()": (
        "rclcpp::InitOptions options; options.set_domain_id(7);",
        "options.domain_id = 7;",
    ),
    "Logger::set_level()": (
        "get_logger().set_level(rclcpp::Logger::Level::Debug);",
        "sink.set_level(3);",
    ),
    "Clock::sleep_for()": (
        "node->get_clock()->sleep_for(1s);",
        "rclcpp::sleep_for(1s);",
    ),
    "Clock::sleep_until()": (
        "node->get_clock()->sleep_until(t);",
        "std::this_thread::sleep_until(t);",
    ),
    "declare_parameter<T>(name)": (
        'auto a = declare_parameter<std::string>("a");',
        'auto a = declare_parameter<std::string>("a", "b");',
    ),
    "declare_parameter(name, type)": (
        'node->declare_parameter("a", rclcpp::ParameterType::PARAMETER_STRING);',
        'node->declare_parameter("a", rclcpp::ParameterValue("b"));',
    ),
    "declare_parameter<T>(name, {})": (
        'node->declare_parameter<std::vector<double>>("a", {});',
        'node->declare_parameter<std::vector<double>>("a", std::vector<double>());',
    ),
    "rclcpp::Duration(seconds)": (
        "auto a = rclcpp::Duration(0.5);",
        "auto a = rclcpp::Duration(rclcpp::Duration::from_seconds(0.5));",
    ),
    "rclcpp::Duration(nanoseconds)": (
        "rclcpp::Duration a(500000000);",
        "rclcpp::Duration a(std::chrono::nanoseconds(500000000)), b(5, 0), c(5s);",
    ),
    "create_publisher<T>(topic)": (
        'a = node->create_publisher<std_msgs::msg::String>("a");',
        'a = node->create_publisher<std_msgs::msg::String>("a", 10);',
    ),
    "create_publisher<T>(topic, rmw_qos_profile_t)": (
        'a = create_publisher<String>("a", rmw_qos_profile_default);',
        'a = create_publisher<String>("a", rclcpp::QoS(1));',
    ),
    "create_subscription<T>(topic, callback)": (
        'a = node->create_subscription<String>("a", f);',
        'a = node->create_subscription<String>("a", 10, f);',
    ),
    "create_subscription<T>(topic, callback, rmw_qos_profile_t)": (
        'a = create_subscription<String>("a", f, rmw_qos_profile_default);',
        'a = create_subscription<String>("a", rclcpp::QoS(1), f);',
    ),
    "publish(shared pointer)": (
        "rclcpp::Node b; auto a = std::make_shared<std_msgs::msg::String>(); publisher->publish(a);",
        "auto a = std::make_unique<std_msgs::msg::String>(); publisher->publish(std::move(a)); publisher->publish(*b);",
    ),
    "create_subscription<T>(topic, qos, callback, nullptr, ignore_local)": (
        'a = create_subscription<String>("a", rclcpp::SensorDataQoS(), f, nullptr, true);',
        'a = create_subscription<String>("a", rclcpp::SensorDataQoS(), f, options);',
    ),
    "callback(..., const rmw_message_info_t &)": (
        "void f(String::SharedPtr m, const rmw_message_info_t & info);\nauto a = create_subscription<String>(t, q, f);",
        "void f(String::SharedPtr m, const rclcpp::MessageInfo & info);\nauto a = create_subscription<String>(t, q, f);",
    ),
    "async_send_request(request).share()": (
        "future_ = client_->async_send_request(request).share();",
        "future_ = client_->async_send_request(request);",
    ),
    "async_send_request(request).future": (
        "auto a = client_->async_send_request(request).future;",
        "auto a = client_->async_send_request(request);",
    ),
    "auto result = async_send_request(request); result.future": (
        "auto a = client_->async_send_request(request); wait(node, a.future);",
        "auto a = client_->async_send_request(request); wait(node, a);",
    ),
    "std::shared_future = async_send_request(request)": (
        "rclcpp::Client<T>::SharedFuture a = client->async_send_request(request);",
        "auto a = client->async_send_request(request).future.share();",
    ),
    "RCLCPP_DEBUG(logger, std::string)": (
        'RCLCPP_DEBUG(logger, "no " + name);',
        'RCLCPP_DEBUG(logger, "no %s", name.c_str()); RCLCPP_DEBUG(logger, ("no " + name).c_str());',
    ),
    "RCLCPP_INFO(logger, std::string)": (
        'RCLCPP_INFO(logger, "no " + name);',
        'RCLCPP_INFO(logger, "no %s", name.c_str()); RCLCPP_INFO(logger, ("no " + name).c_str());',
    ),
    "RCLCPP_WARN(logger, std::string)": (
        'RCLCPP_WARN(logger, "no " + name);',
        'RCLCPP_WARN(logger, "no %s", name.c_str()); RCLCPP_WARN(logger, ("no " + name).c_str());',
    ),
    "RCLCPP_ERROR(logger, std::string)": (
        'RCLCPP_ERROR(logger, "no " + name);',
        'RCLCPP_ERROR(logger, "no %s", name.c_str()); RCLCPP_ERROR(logger, ("no " + name).c_str());',
    ),
    "RCLCPP_FATAL(logger, std::string)": (
        'RCLCPP_FATAL(logger, "no " + name);',
        'RCLCPP_FATAL(logger, "no %s", name.c_str()); RCLCPP_FATAL(logger, ("no " + name).c_str());',
    ),
    "RCLCPP_DEBUG_ONCE(logger, std::string)": (
        'RCLCPP_DEBUG_ONCE(logger, "no " + name);',
        'RCLCPP_DEBUG_ONCE(logger, "no %s", name.c_str());',
    ),
    "RCLCPP_INFO_ONCE(logger, std::string)": (
        'RCLCPP_INFO_ONCE(logger, "no " + name);',
        'RCLCPP_INFO_ONCE(logger, "no %s", name.c_str());',
    ),
    "RCLCPP_WARN_ONCE(logger, std::string)": (
        'RCLCPP_WARN_ONCE(logger, "no " + name);',
        'RCLCPP_WARN_ONCE(logger, "no %s", name.c_str());',
    ),
    "RCLCPP_ERROR_ONCE(logger, std::string)": (
        'RCLCPP_ERROR_ONCE(logger, "no " + name);',
        'RCLCPP_ERROR_ONCE(logger, "no %s", name.c_str());',
    ),
    "RCLCPP_FATAL_ONCE(logger, std::string)": (
        'RCLCPP_FATAL_ONCE(logger, "no " + name);',
        'RCLCPP_FATAL_ONCE(logger, "no %s", name.c_str());',
    ),
    "RCLCPP_DEBUG_THROTTLE(logger, clock, time, std::string)": (
        'RCLCPP_DEBUG_THROTTLE(logger, clock, 5, "no " + name);',
        'RCLCPP_DEBUG_THROTTLE(logger, clock, 5, "no %s", name.c_str());',
    ),
    "RCLCPP_INFO_THROTTLE(logger, clock, time, std::string)": (
        'RCLCPP_INFO_THROTTLE(logger, clock, 5, "no " + name);',
        'RCLCPP_INFO_THROTTLE(logger, clock, 5, "no %s", name.c_str());',
    ),
    "RCLCPP_WARN_THROTTLE(logger, clock, time, std::string)": (
        'RCLCPP_WARN_THROTTLE(logger, clock, 5, "no " + name);',
        'RCLCPP_WARN_THROTTLE(logger, clock, 5, "no %s", name.c_str());',
    ),
    "RCLCPP_ERROR_THROTTLE(logger, clock, time, std::string)": (
        'RCLCPP_ERROR_THROTTLE(logger, clock, 5, "no " + name);',
        'RCLCPP_ERROR_THROTTLE(logger, clock, 5, "no %s", name.c_str());',
    ),
    "RCLCPP_FATAL_THROTTLE(logger, clock, time, std::string)": (
        'RCLCPP_FATAL_THROTTLE(logger, clock, 5, "no " + name);',
        'RCLCPP_FATAL_THROTTLE(logger, clock, 5, "no %s", name.c_str());',
    ),
    "create_client<T>(name, rmw_qos_profile_t)": (
        'a = node->create_client<T>("a", rmw_qos_profile_services_default, group);',
        'a = node->create_client<T>("a", rclcpp::ServicesQoS(), group);',
    ),
    "create_service<T>(name, callback, rmw_qos_profile_t)": (
        'a = node->create_service<T>("a", f, rmw_qos_profile_services_default, group);',
        'a = node->create_service<T>("a", f, rclcpp::ServicesQoS(), group);',
    ),
    "create_client<T>(name, rclcpp::QoS)": (
        'a = node->create_client<T>("a", rclcpp::QoS(1), group);',
        'a = node->create_client<T>("a", rmw_qos_profile_services_default, group);',
    ),
    "create_service<T>(name, callback, rclcpp::QoS)": (
        'a = node->create_service<T>("a", f, rclcpp::QoS(1), group);',
        'a = node->create_service<T>("a", f, rclcpp::QoS(1).get_rmw_qos_profile(), group);',
    ),
    "Node::create_timer(period, callback)": (
        "a = node->create_timer(500ms, f);",
        "a = rclcpp::create_timer(node, clock, 500ms, f);",
    ),
    "goal_response_callback(std::shared_future)": (
        "void goal_response_callback(std::shared_future<GoalHandleMove::SharedPtr> future); void send() {"
        " options.goal_response_callback = std::bind(&Client::goal_response_callback, this, _1); }",
        # which nothing hands over
        "void goal_response_callback(std::shared_future<GoalHandleMove::SharedPtr> future); void send() {"
        " // options.goal_response_callback = std::bind(&Client::goal_response_callback, this, _1); }",
    ),
    "goal_response_callback = [](std::shared_future)": (
        "options.goal_response_callback = [this](std::shared_future<GoalHandleMove::SharedPtr> future) {};",
        "options.goal_response_callback = [this](const GoalHandleMove::SharedPtr & handle) {};",
    ),
    "goal_response_callback(GoalHandle::SharedPtr)": (
        "void goal_response_callback(const GoalHandleMove::SharedPtr & handle) {} void send() {"
        " options.goal_response_callback = std::bind(&Client::goal_response_callback, this, _1); }",
        "void goal_response_callback(std::shared_future<GoalHandleMove::SharedPtr> future) {} void send() {"
        " options.goal_response_callback = std::bind(&Client::goal_response_callback, this, _1); }",
    ),
    "tf2_ros::Buffer without a clock": (
        "int main() { tf2_ros::Buffer buffer; }",
        "int main() { tf2_ros::Buffer buffer(node->get_clock()); }",
    ),
    "make_shared<tf2_ros::Buffer>()": (
        "a = std::make_shared<tf2_ros::Buffer>();",
        "a = std::make_shared<tf2_ros::Buffer>(node->get_clock());",
    ),
    "make_unique<tf2_ros::Buffer>()": (
        "a = std::make_unique<tf2_ros::Buffer>();",
        "a = std::make_unique<tf2_ros::Buffer>(node->get_clock());",
    ),
    "new tf2_ros::Buffer()": (
        "a.reset(new tf2_ros::Buffer());",
        "a.reset(new tf2_ros::Buffer(node->get_clock()));",
    ),
    "tf_buffer_ without a clock": (
        "A::A() : listener_(tf_buffer_) {}",
        "A::A() : tf_buffer_(node->get_clock()), listener_(tf_buffer_), other_(*tf_buffer_) {}",
    ),
    "tfBuffer_ without a clock": (
        "A::A() : listener_(tfBuffer_) {}",
        "A::A() : tfBuffer_(node->get_clock()), listener_(tfBuffer_), other_(*tfBuffer_) {}",
    ),
    "buffer_ without a clock": (
        "A::A() : listener_(buffer_) {}",
        "A::A() : buffer_(node->get_clock()), listener_(buffer_), other_(*buffer_) {}",
    ),
    "message_filters::Subscriber<M, NodeType>": (
        "message_filters::Subscriber<Image, rclcpp_lifecycle::LifecycleNode> a;",
        "message_filters::Subscriber<Image> a;",
    ),
    "message_filters::SubscriberBase<NodeType>": (
        "std::shared_ptr<message_filters::SubscriberBase<rclcpp::Node>> a;",
        "std::shared_ptr<message_filters::SubscriberBase> a;",
    ),
    "message_filters::Subscriber(node, topic, rmw_qos_profile_t)": (
        'message_filters::Subscriber<Image> a(node, "a", rmw_qos_profile_default);',
        'message_filters::Subscriber<Image> a(node, "a", rclcpp::SensorDataQoS());',
    ),
    "message_filters::Subscriber::subscribe(node, topic, rmw_qos_profile_t)": (
        'message_filters::Subscriber<Image> a; void f() { a.subscribe(node, "a", rmw_qos_profile_sensor_data); }',
        'message_filters::Subscriber<Image> a; void f() { a.subscribe(node, "a", rclcpp::SensorDataQoS()); }',
    ),
    "make_shared<message_filters::Subscriber>(node, topic, rmw_qos_profile_t)": (
        'a = std::make_shared<message_filters::Subscriber<Image>>(node, "a", rmw_qos_profile_default);',
        'a = std::make_shared<message_filters::Subscriber<Image>>(node, "a", rclcpp::QoS(1));',
    ),
    "message_filters::Subscriber(node, topic, rclcpp::QoS)": (
        'message_filters::Subscriber<Image> a(node, "a", rclcpp::SensorDataQoS());',
        'message_filters::Subscriber<Image> a(node, "a", rmw_qos_profile_sensor_data);',
    ),
    "message_filters::Subscriber::subscribe(node, topic, rclcpp::QoS)": (
        'message_filters::Subscriber<Image> a; void f() { a.subscribe(node, "a", rclcpp::QoS(1)); }',
        'message_filters::Subscriber<Image> a; void f() { a.subscribe(node, "a", rclcpp::QoS(1).get_rmw_qos_profile()); }',
    ),
    "image_transport::create_publisher(node, topic, rclcpp::QoS)": (
        'a = image_transport::create_publisher(node, "a", rclcpp::QoS(1));',
        'a = image_transport::create_publisher(node, "a", rclcpp::QoS(1).get_rmw_qos_profile());',
    ),
    "image_transport::create_subscription(..., rclcpp::QoS)": (
        'a = image_transport::create_subscription(node, "a", f, "raw", rclcpp::QoS(1));',
        'a = image_transport::create_subscription(node, "a", f, "raw", rmw_qos_profile_default);',
    ),
    "image_transport::create_camera_publisher(node, topic, rclcpp::QoS)": (
        'a = image_transport::create_camera_publisher(node, "a", rclcpp::QoS(1));',
        'a = image_transport::create_camera_publisher(node, "a");',
    ),
    "image_transport::create_camera_subscription(..., rclcpp::QoS)": (
        'a = image_transport::create_camera_subscription(node, "a", f, "raw", rclcpp::QoS(1));',
        'a = image_transport::create_camera_subscription(node, "a", f, "raw");',
    ),
    "get_optional()": (
        "double a = command_interfaces_[0].get_optional().value();",
        "double a = command_interfaces_[0].get_value();",
    ),
    "return_type configure(HardwareInfo)": (
        "class A : public hardware_interface::SystemInterface { hardware_interface::return_type configure(const hardware_interface::HardwareInfo & info) override; };",
        "class A : public hardware_interface::SystemInterface { hardware_interface::CallbackReturn on_init(const hardware_interface::HardwareInfo & info) override; };",
    ),
    "return_type start()": (
        "class A : public hardware_interface::SystemInterface { hardware_interface::return_type start() override; };",
        "class A : public hardware_interface::SystemInterface { hardware_interface::CallbackReturn on_activate(const rclcpp_lifecycle::State & state) override; };",
    ),
    "return_type stop()": (
        "class A : public hardware_interface::SystemInterface { hardware_interface::return_type stop() override; };",
        "class A : public hardware_interface::SystemInterface { hardware_interface::CallbackReturn on_deactivate(const rclcpp_lifecycle::State & state) override; };",
    ),
    "CallbackReturn on_init(HardwareInfo)": (
        "class A : public hardware_interface::SystemInterface { hardware_interface::CallbackReturn on_init(const hardware_interface::HardwareInfo & info) override; };",
        "class A : public hardware_interface::SystemInterface { hardware_interface::return_type configure(const hardware_interface::HardwareInfo & info) override; };",
    ),
    "return_type update()": (
        "class A : public controller_interface::ControllerInterface { controller_interface::return_type update() override; };",
        "class A : public controller_interface::ControllerInterface { controller_interface::return_type update(const rclcpp::Time & time, const rclcpp::Duration & period) override; };",
    ),
    "return_type update(time, period)": (
        "class A : public controller_interface::ControllerInterface { controller_interface::return_type update(const rclcpp::Time & time, const rclcpp::Duration & period) override; };",
        "class A : public controller_interface::ControllerInterface { controller_interface::return_type update() override; };",
    ),
    "CallbackReturn on_init()": (
        "class A : public controller_interface::ControllerInterface { controller_interface::CallbackReturn on_init() override; };",
        "class A : public controller_interface::ControllerInterface { controller_interface::return_type init(const std::string & name) override; };",
    ),
    "controller->init(name)": (
        'controller_interface::A a; controller_->init("a");',
        'controller_->init("a", "", 0, "", controller_->define_custom_node_options());',
    ),
    "get_state()": (
        "if (controller_interface::a && get_state().id() == 3) {}",
        "if (controller_interface::a && get_lifecycle_state().id() == 3) {}",
    ),
    "get_lifecycle_state()": (
        "if (controller_interface::a && get_lifecycle_state().id() == 3) {}",
        "if (controller_interface::a && get_state().id() == 3) {}",
    ),
    "ResourceManager(urdf)": (
        "a = std::make_unique<hardware_interface::ResourceManager>(urdf);",
        "a = std::make_unique<hardware_interface::ResourceManager>(urdf, clock, logger);",
    ),
    "HardwareInfo::hardware_class_type": (
        "f(info_.hardware_class_type);",
        "f(info_.hardware_plugin_name);",
    ),
    "HardwareInfo::hardware_plugin_name": (
        "f(info_.hardware_plugin_name);",
        "f(info_.hardware_class_type);",
    ),
    "RealtimePublisher::msg_": (
        "realtime_tools::RealtimePublisher<T> * a; f(realtime_publisher_->msg_.data);",
        "realtime_tools::RealtimePublisher<T> * a; realtime_publisher_->try_publish(message_);",
    ),
    "nav2_util::LifecycleNode(name, namespace, use_rclcpp_node)": (
        'A() : nav2_util::LifecycleNode("a", "", true) {}',
        'A() : nav2_util::LifecycleNode("a", "", options) {}',
    ),
    "SerializedBagMessage::time_stamp": (
        "rosbag2_cpp::Reader a; auto b = a.read_next()->time_stamp;",
        "rosbag2_cpp::Reader a; auto b = a.read_next()->recv_timestamp;",
    ),
    "SerializedBagMessage::recv_timestamp": (
        "rosbag2_cpp::Reader a; auto b = a.read_next()->recv_timestamp;",
        "rosbag2_cpp::Reader a; auto b = a.read_next()->time_stamp;",
    ),
    "createSharedInstance()": (
        'a = loader.createSharedInstance("a");',
        'a = loader.createInstance("a");',
    ),
    "boost::shared_ptr = createInstance()": (
        'boost::shared_ptr<Base> a = loader.createInstance("a");',
        'auto a = loader.createInstance("a");',
    ),
    "createUniqueInstance()": (
        'a = loader.createUniqueInstance("a");',
        'a = loader.createInstance("a");',
    ),
    "kdl_parser::treeFromXml(TiXmlDocument *, tree)": (
        "TiXmlDocument document; kdl_parser::treeFromXml(&document, tree);",
        "kdl_parser::treeFromString(text, tree);",
    ),
    "bool success = plan(...)": (
        "MoveGroupInterface group; bool success = group.plan(my_plan);",
        "bool success = (group.plan(my_plan) == MoveItErrorCode::SUCCESS);",
    ),
    "PlanningSceneMonitor(description, tf::TransformListener)": (
        'boost::shared_ptr<tf::TransformListener> tf(new tf::TransformListener()); a.reset(new planning_scene_monitor::PlanningSceneMonitor("robot_description", tf));',
        'a.reset(new planning_scene_monitor::PlanningSceneMonitor("robot_description", tf_buffer)); tf2_ros::Buffer b;',
    ),
    "boost::shared_ptr<urdf::ModelInterface> = getURDF()": (
        "const boost::shared_ptr<urdf::ModelInterface>& model = loader.getURDF();",
        "const urdf::ModelInterfaceSharedPtr& model = loader.getURDF();",
    ),
    "boost::shared_ptr<srdf::Model> = getSRDF()": (
        "const boost::shared_ptr<srdf::Model>& model = loader.getSRDF();",
        "const srdf::ModelSharedPtr& model = loader.getSRDF();",
    ),
    "Plan::trajectory_": (
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.trajectory_);",
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.trajectory);",
    ),
    "Plan::start_state_": (
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.start_state_);",
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.start_state);",
    ),
    "Plan::planning_time_": (
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.planning_time_);",
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.planning_time);",
    ),
    "Plan::trajectory": (
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.trajectory);",
        "moveit::planning_interface::MoveGroupInterface::Plan plan; f(plan.trajectory_);",
    ),
    "initRequest(..., std::set<std::string> & claimed_resources)": (
        "bool initRequest(hardware_interface::RobotHW * hw, ros::NodeHandle & n, std::set<std::string> & claimed_resources);",
        "bool initRequest(hardware_interface::RobotHW * hw, ros::NodeHandle & n, ClaimedResources & claimed_resources);",
    ),
    "initRequest(..., ClaimedResources &)": (
        "bool initRequest(hardware_interface::RobotHW * hw, ros::NodeHandle & n, ClaimedResources & claimed_resources);",
        "bool initRequest(hardware_interface::RobotHW * hw, ros::NodeHandle & n, std::set<std::string> & claimed_resources);",
    ),
    "ControllerInfo::hardware_interface": (
        "for (std::list<hardware_interface::ControllerInfo>::const_iterator it = a.begin(); it != a.end(); ++it) { f(it->hardware_interface); }",
        "for (std::list<hardware_interface::ControllerInfo>::const_iterator it = a.begin(); it != a.end(); ++it) { f(it->claimed_resources[0].hardware_interface); }",
    ),
    "hardware_interface::InterfaceResources": (
        "std::vector<hardware_interface::InterfaceResources> a;",
        "std::set<std::string> a;",
    ),
    "RobotHW::read(time, period)": (
        "class A : public hardware_interface::RobotHW { void read(const ros::Time & time, const ros::Duration & period) override; };",
        "class A : public hardware_interface::RobotHW { void read(const ros::Time & time, const ros::Duration & period); };",
    ),
    "RobotHW::write(time, period)": (
        "class A : public hardware_interface::RobotHW { void write(const ros::Time & time, const ros::Duration & period) override; };",
        "class A : public hardware_interface::RobotHW { void write(const ros::Time & time, const ros::Duration & period); };",
    ),
    "initialize(name, tf::TransformListener *, ...)": (
        "class A : public nav_core::BaseLocalPlanner { void initialize(std::string name, tf::TransformListener * tf, costmap_2d::Costmap2DROS * costmap); };",
        "class A : public nav_core::BaseLocalPlanner { void initialize(std::string name, tf2_ros::Buffer * tf, costmap_2d::Costmap2DROS * costmap); };",
    ),
    "Costmap2DROS(name, tf::TransformListener)": (
        'tf::TransformListener tf(ros::Duration(10)); costmap_2d::Costmap2DROS costmap("a", tf);',
        'tf2_ros::Buffer buffer; tf2_ros::TransformListener tf(buffer); costmap_2d::Costmap2DROS costmap("a", buffer);',
    ),
    "getRobotPose(tf::Stamped<tf::Pose>)": (
        "tf::Stamped<tf::Pose> pose; costmap_ros_->getRobotPose(pose);",
        "geometry_msgs::PoseStamped pose; costmap_ros_->getRobotPose(pose);",
    ),
    "initialize(name, tf2_ros::Buffer *, ...)": (
        "class A : public nav_core::BaseLocalPlanner { void initialize(std::string name, tf2_ros::Buffer * tf, costmap_2d::Costmap2DROS * costmap); };",
        "class A : public nav_core::BaseLocalPlanner { void initialize(std::string name, tf::TransformListener * tf, costmap_2d::Costmap2DROS * costmap); };",
    ),
    "boost::shared_ptr<urdf::Joint>": (
        "std::map<std::string, boost::shared_ptr<urdf::Joint> >::iterator i;",
        "std::map<std::string, urdf::JointSharedPtr>::iterator i; boost::shared_ptr<urdf::Model> m;",
    ),
    "__connection_header": (
        'std::string a = (*message->__connection_header)["callerid"];',
        "std::string a = event.getPublisherName();",
    ),
    "Node.create_publisher(type, topic)": (
        "self.create_publisher(String, 'a')",
        "self.create_publisher(String, 'a', 10)",
    ),
    "Node.create_subscription(type, topic, callback)": (
        "self.create_subscription(String, 'a', f)",
        "self.create_subscription(String, 'a', f, 10)",
    ),
    "ServerGoalHandle.set_succeeded()": (
        "ActionServer(); goal_handle.set_succeeded()",
        "goal_handle.succeed()",
    ),
    "ServerGoalHandle.set_aborted()": (
        "ActionServer(); goal_handle.set_aborted()",
        "goal_handle.abort()",
    ),
    "ServerGoalHandle.set_canceled()": (
        "ActionServer(); goal_handle.set_canceled()",
        "goal_handle.canceled()",
    ),
    "Node.set_parameters_callback()": (
        "self.set_parameters_callback(f)",
        "self.add_on_set_parameters_callback(f)",
    ),
    "Node.add_on_set_parameters_callback()": (
        "self.add_on_set_parameters_callback(f)",
        "self.set_parameters_callback(f)",
    ),
    "Node.wait_for_node()": (
        "self.wait_for_node('a', 5.0)",
        "self.wait('a', 5.0)",
    ),
    "create_timer(..., autostart)": (
        "self.create_timer(1.0, f, autostart=False)",
        "self.create_timer(1.0, f)",
    ),
    "ReliabilityPolicy": (
        "from rclpy.qos import ReliabilityPolicy",
        "from rclpy.qos import QoSReliabilityPolicy",
    ),
    "DurabilityPolicy": (
        "from rclpy.qos import DurabilityPolicy",
        "from rclpy.qos import QoSDurabilityPolicy",
    ),
    "HistoryPolicy": (
        "from rclpy.qos import HistoryPolicy",
        "from rclpy.qos import QoSHistoryPolicy",
    ),
    "LivelinessPolicy": (
        "from rclpy.qos import LivelinessPolicy",
        "from rclpy.qos import QoSLivelinessPolicy",
    ),
    "Node(executable=...)": (
        "import launch_ros; Node(package='a', executable='b')",
        "import launch_ros; Node(package='a', node_executable='b')",
    ),
    "Node(name=...)": (
        "import launch_ros; Node(package='a', node_executable='b', name='c')",
        "import launch_ros; Node(package='a', node_executable='b', node_name='c')",
    ),
    "Node(namespace=...)": (
        "import launch_ros; Node(package='a', node_executable='b', namespace='c')",
        "import launch_ros; Node(package='a', node_executable='b', node_namespace='c')",
    ),
}


def seen(label: str, code: str) -> bool:
    return bool(list(find_use_places(f"{code}\n".encode(), ROWS[label].pattern)))


def test_every_example_has_its_row():
    assert set(EXAMPLES) <= set(ROWS)


@pytest.mark.parametrize("label", EXAMPLES)
def test_a_row_sees_its_example_and_not_the_cured_code(label):
    before, after = EXAMPLES[label]
    assert (seen(label, before), seen(label, after)) == (True, False)


@pytest.mark.parametrize("label", [label for label in ROWS if "::" in label and label not in EXAMPLES])
def test_a_label_without_example_is_code_that_is_seen(label):
    assert (seen(label, f"{label} a;"), seen(label, f"other::{ROWS[label].pattern.word} a;")) == (True, False)


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_a_row_says_what_when_and_whence(row):
    assert row.kind in ("call-changed", "field-changed")
    assert row.source
    assert row.removed_in or row.new_since, "a change that never happens"
    for bound in (row.removed_in, row.back_in, row.new_since):
        assert not bound or bound == "ros2" or bound in DISTROS or BOUND.match(bound)
    for expression in (row.pattern.before, row.pattern.after, row.pattern.file, row.pattern.unless):
        re.compile(expression)
