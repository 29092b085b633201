"""Constants that stand in headers of other packages, in another source, or in messages."""

import pytest
from joining import ends, graph, graph_on_disk, manifest

HEADER = """
    #pragma once
    #define MAP_TOPIC "/map"
    extern const std::string kDeclared;
    namespace harbour {
    static const std::string kScan = "/scan";
    constexpr char kOdom[] = "/odom";
    inline constexpr auto kImu = "/imu";
    const char * const kSame = "/same_harbour";
    class Names { public: static const std::string kTf; static constexpr const char * kGps = "/gps"; };
    namespace deep { const char * const kDeep = "/deep"; }
    }
"""
DEFINED = """
    #include <harbour/names.hpp>
    const std::string kDeclared = "/declared";
    static const std::string kHidden = "/hidden";
    namespace harbour { const std::string Names::kTf = "/tf_raw"; }
"""
OTHER = """
    #pragma once
    namespace pier { const char * const kSame = "/same_pier"; }
"""
NODE = """
    #include <harbour/names.hpp>
    #include <pier/names.hpp>
    namespace pier {
    class Ship : public rclcpp::Node {
     public:
      Ship() : Node("ship") { create_publisher<std_msgs::msg::Empty>(HERE, 1); }
    };
    }
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<pier::Ship>()); }
"""
CASES = [
    ("MAP_TOPIC", "/map"),
    ("harbour::kScan", "/scan"),
    ("harbour::kOdom", "/odom"),
    ("harbour::kImu", "/imu"),
    ("harbour::Names::kGps", "/gps"),
    ("harbour::Names::kTf", "/tf_raw"),
    ("harbour::deep::kDeep", "/deep"),
    ("kDeclared", "/declared"),
    # Of two of one name, that of the scope around it, or of the one that is named.
    ("kSame", "/same_pier"),
    ("harbour::kSame", "/same_harbour"),
    # Neither seen here, nor of the scope that is named.
    ("kHidden", "?"),
    ("quay::kScan", "?"),
]


@pytest.mark.parametrize(("written", "name"), CASES)
def test_in_headers_of_other_packages(written, name):
    files = {
        "harbour/include/harbour/names.hpp": HEADER,
        "harbour/src/names.cpp": DEFINED,
        "pier/include/pier/names.hpp": OTHER,
        "ship/src/ship.cpp": NODE.replace("HERE", written),
    }
    assert {topic for _, topic, _ in ends(graph(files), "publisher")} == {name}


def test_a_header_that_is_not_included_says_nothing():
    files = {
        "harbour/include/harbour/names.hpp": HEADER,
        "ship/src/ship.cpp": NODE.replace("HERE", "harbour::kScan").replace("#include <harbour/names.hpp>", ""),
    }
    assert {topic for _, topic, _ in ends(graph(files), "publisher")} == {"?"}


def test_headers_that_disagree_say_nothing():
    one = 'namespace harbour { const char * const kScan = "/one"; }'
    files = {
        "harbour/include/harbour/names.hpp": one,
        "pier/include/pier/names.hpp": one.replace("/one", "/two"),
        "ship/src/ship.cpp": NODE.replace("HERE", "harbour::kScan"),
    }
    assert {topic for _, topic, _ in ends(graph(files), "publisher")} == {"?"}


def test_in_messages(tmp_path):
    python = """
        import rclpy
        from rclpy.node import Node
        from pier_msgs.msg import Topics

        def main():
            node = Node("python")
            node.create_publisher(Topics, Topics.PLAIN, 1)
            node.create_publisher(Topics, Topics.LACKING, 1)
    """
    cpp = """
        #include <pier_msgs/msg/topics.hpp>
        using Alias = pier_msgs::msg::Topics;
        int main(int c, char** v) {
          auto node = std::make_shared<rclcpp::Node>("cpp");
          node->create_publisher<Alias>(Alias::QUOTED, 1);
          node->create_publisher<Alias>(pier_msgs::msg::Topics::PLAIN, 1);
        }
    """
    files = {
        "pier_msgs/package.xml": manifest("pier_msgs", "ament_cmake"),
        "pier_msgs/msg/Topics.msg": "string PLAIN=/plain\nstring QUOTED='/quoted'\nint32 NUMBER=3\n",
        "ship/package.xml": manifest("ship", "ament_cmake"),
        "ship/src/ship.cpp": cpp,
        "ship/ship.py": python,
    }
    found = sorted((one.path[5:], one.topic) for one in graph_on_disk(tmp_path, files).endpoints)
    assert found == [("ship.py", ""), ("ship.py", "/plain"), ("src/ship.cpp", "/plain"), ("src/ship.cpp", "/quoted")]
