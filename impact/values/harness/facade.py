"""Which header of the facades stands for a header of ROS, Boost or another library."""

from __future__ import annotations

import re
from pathlib import Path

RUNTIME = Path(__file__).with_name("runtime")
"""The folder of the headers and sources that harnesses are compiled with."""

_Rows = tuple[tuple[str, str], ...]
_BOTH: _Rows = (
    (r"tf2/LinearMath/.*|tf2/convert\.h(pp)?|tf2/impl/.*", "ri_tf2.hpp"),
    (r"(tf2|tf2_ros|tf2_geometry_msgs|tf2_sensor_msgs|tf2_eigen)/.*\.h(pp)?", "ri_tf2.hpp"),
    (r"message_filters/.*\.h(pp)?", "ri_filters.hpp"),
    (r"diagnostic_updater/.*\.h(pp)?", "ri_updater.hpp"),
    (r"angles/angles\.h(pp)?", "ri_angles.hpp"),
    (r"sensor_msgs/image_encodings\.h(pp)?", "ri_encodings.hpp"),
    (r"sensor_msgs/(impl/)?point_cloud2_iterator\.h(pp)?", "ri_clouds.hpp"),
    (r"cv_bridge/.*\.h(pp)?|opencv2?/.*\.h(pp)?", "ri_cv.hpp"),
    (r"Q[A-Z]\w+|Qt\w*/\w+|qt?[a-z]+\.h", "ri_qt.hpp"),
)
_ROS1: _Rows = (
    *_BOTH,
    (r"ros/(?!ri_).*\.h|rosconsole/.*\.h|xmlrpcpp/.*\.h|XmlRpc\w*\.h", "ros/ros.h"),
    (r"tf/.*\.h|tf_conversions/.*\.h", "ri_tf.hpp"),
    (r"actionlib/.*\.h", "ri_actions.hpp"),
    (r"(nodelet|pluginlib|class_loader|realtime_tools)/.*\.h(pp)?", "ri_more.hpp"),
    (r"dynamic_reconfigure/(server|client)\.h", "ri_more.hpp"),
    (r"image_transport/.*\.h", "ri_images.hpp"),
)
_ROS2: _Rows = (
    *_BOTH,
    (r"rosidl_runtime_cpp/(?!ri_).*|rosidl_typesupport_cpp/.*", "rosidl_runtime_cpp/ri_message.hpp"),
    (r"rclcpp_lifecycle/.*\.hpp", "ri_lifecycle.hpp"),
    (r"rclcpp_action/.*\.hpp", "ri_actions.hpp"),
    (r"(rclcpp|rclcpp_components|class_loader|pluginlib|rcutils|rmw|rcl)/.*\.h(pp)?", "rclcpp/rclcpp.hpp"),
    (r"image_transport/.*\.h(pp)?", "ri_images.hpp"),
)
# What ROS 1 code uses of Boost most; the rest is Boost's own, where it is installed.
_BOOST = (
    r"boost/(array|bind|bind/\w+|function|function/\w+|shared_ptr|make_shared|smart_ptr|smart_ptr/\w+|scoped_ptr|"
    r"shared_array|scoped_array|weak_ptr|enable_shared_from_this|pointer_cast|thread|thread/\w+|foreach|optional|"
    r"optional/\w+|lexical_cast|algorithm/string|algorithm/string/\w+|date_time|date_time/\w+(/\w+)*|math/\w+(/\w+)*|"
    r"unordered_map|unordered_set|ref|core/ref|chrono|chrono/\w+|atomic|tuple/tuple|noncopyable|core/noncopyable|"
    r"throw_exception|assert|static_assert|regex|none|mem_fn|cstdint|utility|type_traits|move/\w+)\.hpp"
)


def find_facade(header: str, ros: int, own_boost: bool = True) -> str:
    """The header that stands for another, by its include path; empty where none does. own_boost: ours stands for that
    of Boost."""
    if own_boost and re.fullmatch(_BOOST, header):
        return "boost/ri_boost.hpp"
    rows = _ROS1 if ros == 1 else _ROS2
    return next((to for pattern, to in rows if re.fullmatch(pattern, header)), "")


def list_folders(ros: int) -> list[Path]:
    """The include folders of the facades for a generation of ROS."""
    return [RUNTIME / f"ros{ros}", RUNTIME / "common", RUNTIME, RUNTIME / "boost"]
