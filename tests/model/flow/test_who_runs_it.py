"""Which node makes an endpoint, under which name, and what has to hold for it."""

from textwrap import dedent

from rosimpact.impact.model.flow.names import is_open, make_open_part
from rosimpact.impact.model.flow.nodes import BuiltPackage

from tests.model.flow.joining import ends, graph, graph_on_disk, joined, manifest

NODE = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/string.hpp>
    class {name} : public rclcpp::Node {{
    public:
      {name}() : Node("{node}") {{ pub_ = create_publisher<std_msgs::msg::String>("{topic}", 1); }}
      rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
    }};
"""


def test_each_class_of_a_program_that_names_a_node_is_one():
    main = """
        #include "front.hpp"
        #include "rear.hpp"
        int main(int argc, char ** argv) {
          rclcpp::init(argc, argv);
          auto front = std::make_shared<Front>();
          auto rear = std::make_shared<Rear>();
        }
    """
    found = graph({
        "car/front.hpp": NODE.format(name="Front", node="front", topic="~/out"),
        "car/rear.hpp": NODE.format(name="Rear", node="rear", topic="~/out"),
        "car/main.cpp": main,
    })  # fmt: skip
    names = {node.id: node.name for node in found.nodes}
    told = {(names[node], topic) for node, topic, _ in ends(found, "publisher")}
    assert told == {("/front", "/front/out"), ("/rear", "/rear/out")}


def test_an_executable_has_nothing_of_the_sources_of_another():
    header = "class Base { public: void begin(); };"
    body = """
        #include "base.h"
        #include <ros/ros.h>
        #include <std_msgs/String.h>
        void Base::begin() {{ ros::NodeHandle n; n.advertise<std_msgs::String>("{topic}", 1); }}
    """
    main = """
        #include "base.h"
        int main(int argc, char ** argv) { ros::init(argc, argv, "%s"); Base base; base.begin(); }
    """
    files = {"car/base.h": header}
    for name in ("old", "new"):
        files |= {f"car/{name}.cpp": body.format(topic=name), f"car/{name}_main.cpp": main % name}
    programs = {name: (f"car/{name}.cpp", f"car/{name}_main.cpp") for name in ("old", "new")}
    found = graph(files, 1, built=(BuiltPackage("car", programs, {}, {}, {}, {}),))
    assert ends(found, "publisher") == {
        ("car/old", "/old", "std_msgs/String"), ("car/new", "/new", "std_msgs/String")
    }  # fmt: skip


def test_a_program_has_the_methods_of_the_library_that_it_links():
    """Of two sources that define one method, that of the target; what no source of it defines may be any."""
    header = """
        class Base : public rclcpp::Node {
         public:
          Base();
          void begin();
          void end();
          rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
        };
    """
    method = '#include "base.hpp"\nvoid Base::{}() {{ pub_ = create_publisher<std_msgs::msg::Empty>("{}", 1); }}\n'
    main = """
        #include "base.hpp"
        Base::Base() : Node("%s") {}
        int main(int argc, char ** argv) { auto base = std::make_shared<Base>(); base->end(); }
    """
    files = {"car/base.hpp": header, "car/last.cpp": method.format("end", "last")}
    for name in ("old", "new"):
        files |= {f"car/{name}.cpp": method.format("begin", name), f"car/{name}_main.cpp": main % name}
    built = BuiltPackage(
        "car", {name: (f"car/{name}_main.cpp",) for name in ("old", "new")},
        {f"lib_{name}": (f"car/{name}.cpp",) for name in ("old", "new")}, {}, {},
        {name: (f"lib_{name}",) for name in ("old", "new")},
    )  # fmt: skip
    assert ends(graph(files, built=(built,)), "publisher") == {
        (f"car/{name}", f"/{topic}", "std_msgs/Empty") for name in ("old", "new") for topic in (name, "last")
    }


def test_what_loads_a_plugin_is_not_known_and_not_invented():
    code = """
        #include <ros/ros.h>
        #include <pluginlib/class_list_macros.h>
        #include <std_msgs/String.h>
        class Tool : public Base {
          void onInitialize() {
            ros::NodeHandle n("~");
            own_ = n.advertise<std_msgs::String>("state", 1);
            ros::NodeHandle().advertise<std_msgs::String>("/whole", 1);
          }
          ros::Publisher own_;
        };
        PLUGINLIB_EXPORT_CLASS(Tool, Base)
    """
    found = graph({"car/tool.cpp": code}, 1)
    assert [(node.kind, node.name) for node in found.nodes] == [("plugin", "")]
    told = {(one.topic, one.how) for one in found.endpoints if not one.implied}
    assert told == {("/<Tool>/state", "partly"), ("/whole", "literal")}


def test_python_classes_are_classes_whatever_they_are_called():
    code = """
        import rospy
        from std_msgs.msg import String
        class clean_house():
            def __init__(self):
                rospy.init_node('cleaner')
                self.pub = rospy.Publisher('~state', String, queue_size=1)
        if __name__ == '__main__':
            clean_house()
    """
    assert ends(graph({"car/clean.py": code}, 1), "publisher") == {
        ("car/clean.py", "/cleaner/state", "std_msgs/String")
    }


def test_a_service_is_not_of_the_type_of_its_request():
    code = """
        #include <ros/ros.h>
        #include <std_srvs/SetBool.h>
        bool on(std_srvs::SetBoolRequest & ask, std_srvs::SetBoolResponse & answer) { return true; }
        int main(int argc, char ** argv) {
          ros::init(argc, argv, "lamp");
          ros::NodeHandle n;
          n.advertiseService("on", on);
        }
    """
    assert ends(graph({"car/lamp.cpp": code}, 1), "server") == {("car/lamp", "/on", "std_srvs/SetBool")}


def test_what_the_preprocessor_may_leave_out_is_told_so():
    code = """
        #include <ros/ros.h>
        #include <std_msgs/String.h>
        int main(int argc, char ** argv) {
          ros::init(argc, argv, "camera");
          ros::NodeHandle n;
          n.advertise<std_msgs::String>("always", 1);
        #ifdef WITH_IMAGE
          n.advertise<std_msgs::String>("image", 1);
        #endif
        }
    """
    found = graph({"car/camera.cpp": code}, 1)
    told = {one.topic: one.only_if for one in found.endpoints if not one.implied}
    assert told == {"/always": "", "/image": "defined(WITH_IMAGE)"}


def test_what_nothing_is_seen_to_call_is_told_so():
    code = """
        import rospy
        from std_msgs.msg import String
        class Old:
            def __init__(self):
                rospy.Subscriber('old', String, print)
        if __name__ == '__main__':
            rospy.init_node('ear')
            rospy.Subscriber('new', String, print)
    """
    found = graph({"car/ear.py": code}, 1)
    told = {one.topic: one.only_if for one in found.endpoints if not one.implied}
    assert told == {"/new": "", "/old": "something calls `Old.__init__`"}


PARAMETER = """
    #include <ros/ros.h>
    #include <std_msgs/String.h>
    int main(int argc, char ** argv) {
      std::string topic = "/first";
      ros::init(argc, argv, "talker");
      ros::NodeHandle n;
      ros::param::get("~topic", topic);
      n.advertise<std_msgs::String>(topic, 1);
    }
"""
CMAKE = """
    cmake_minimum_required(VERSION 3.0)
    project(car)
    find_package(catkin REQUIRED COMPONENTS roscpp std_msgs)
    add_executable(talker talker.cpp)
"""


def test_what_a_launch_file_sets_takes_the_place_of_what_the_code_begins_with(tmp_path):
    files = {"car/package.xml": manifest("car", "catkin"), "car/CMakeLists.txt": CMAKE, "car/talker.cpp": PARAMETER}
    assert ends(graph_on_disk(tmp_path / "alone", files), "publisher") == {("car/talker", "/first", "std_msgs/String")}
    files["car/launch/a.launch"] = """
        <launch><node pkg="car" type="talker" name="t"><param name="topic" value="/second"/></node></launch>
    """
    assert ends(graph_on_disk(tmp_path / "started", files), "publisher") == {("/t", "/second", "std_msgs/String")}


def test_what_two_launch_files_start_under_one_name_has_the_names_of_both(tmp_path):
    files = {"car/package.xml": manifest("car", "catkin"), "car/CMakeLists.txt": CMAKE, "car/talker.cpp": PARAMETER}
    for name in ("a", "b"):
        files[f"car/launch/{name}.launch"] = f"""
            <launch><node pkg="car" type="talker" name="t"><param name="topic" value="/{name}"/></node></launch>
        """
    found = graph_on_disk(tmp_path, files)
    assert [node.id for node in found.nodes] == ["/t"]
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"/a", "/b"}


def test_what_is_not_known_of_a_name_stands_in_one_pair_of_brackets():
    assert make_open_part("<$(env ROBOT)>") == "<ROBOT>"
    assert make_open_part("robot_<$(arg id)>/a") == "robot_<id>/a"
    assert make_open_part("<$(eval <x> / 2)>") == "<$(eval_x___2)>"
    assert make_open_part("plain/name") == "plain/name"
    assert is_open("/<$ROBOT>/scan") and not is_open("/a/scan")


def test_ros2_takes_names_that_are_known_in_part_and_refuses_what_it_always_did():
    code = joined({"car/front.hpp": NODE.format(name="Front", node="front", topic="not a name")})
    assert not [one for one in code.build().endpoints if one.topic and not one.implied]


def test_a_variable_of_another_source_is_the_one_that_this_defines():
    files = {
        "car/window.h": "#include <ros/ros.h>\nextern ros::Publisher tune;",
        "car/window.cpp": """
            #include "window.h"
            void press() { std_msgs::String words; tune.publish(words); }
        """,
        "car/node.cpp": """
            #include "window.h"
            #include <std_msgs/String.h>
            ros::Publisher tune;
            void press();
            int main(int argc, char ** argv) {
              ros::init(argc, argv, "tuner");
              ros::NodeHandle n;
              tune = n.advertise<std_msgs::String>("tune", 1);
              press();
            }
        """,
    }
    built = (BuiltPackage("car", {"tuner": ("car/window.cpp", "car/node.cpp")}, {}, {}, {}, {}),)
    found = graph(files, 1, built=built)
    assert [(one.topic, one.path) for one in found.publishes] == [("/tune", "car/window.cpp")]


def test_parameters_that_are_declared_together_are_each_declared():
    code = """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import String
        class Ear(Node):
            def __init__(self):
                super().__init__('ear')
                self.declare_parameters(namespace='', parameters=[('topic', 'words'), ('rate', 5)])
                topic = self.get_parameter('topic').get_parameter_value().string_value
                self.create_subscription(String, topic, print, 1)
        if __name__ == '__main__':
            rclpy.init()
            Ear()
    """
    found = graph({"car/ear.py": code})
    assert ends(found, "subscriber") == {("car/ear.py", "/words", "std_msgs/String")}
    assert {(one.name, one.kind) for one in found.parameters} >= {("topic", "declared"), ("rate", "declared")}


CAMERA = """
    import rospy
    from sensor_msgs.msg import Image
    class Camera:
        def __init__(self, ns="/camera", packed=False):
            if packed:
                rospy.Subscriber(ns + "/packed", Image, callback=print)
            else:
                rospy.Subscriber(ns + "/raw", Image, callback=print)
        def stop(self):
            rospy.Subscriber("/stop", Image, callback=print)
    if __name__ == '__main__':
        rospy.init_node('eye')
        Camera("front")
"""


def test_a_default_is_no_value_where_every_caller_gives_another_and_a_flag_that_is_down_is_told():
    found = graph({"car/eye.py": CAMERA}, 1)
    told = {one.topic: one.only_if for one in found.endpoints if not one.implied}
    assert told == {"/front/raw": "", "/front/packed": "packed", "/stop": "something calls `Camera.stop`"}
    # Who leaves it out has the default.
    both = graph({"car/eye.py": CAMERA + "        Camera()\n"}, 1)
    assert {one.topic for one in both.endpoints if one.topic.endswith("/raw")} == {"/front/raw", "/camera/raw"}


def test_a_method_that_is_called_or_handed_on_runs():
    for use in ("camera.stop()", "rospy.on_shutdown(camera.stop)"):
        code = CAMERA.replace('Camera("front")', f'camera = Camera("front"); {use}')
        found = graph({"car/eye.py": code}, 1)
        assert [one.only_if for one in found.endpoints if one.topic == "/stop"] == [""]


def test_a_header_that_was_put_aside_is_not_the_one_that_is_included():
    header = """
        #include <ros/ros.h>
        #include <std_msgs/String.h>
        class Lamp { public: Lamp() { ros::NodeHandle n; n.advertise<std_msgs::String>("%s", 1); } };
    """
    main = """
        #include "car/lamp.h"
        int main(int argc, char ** argv) { ros::init(argc, argv, "light"); Lamp lamp; }
    """
    files = {"car/include/car/lamp.h": header % "new", "car/include/car/old/lamp.h": header % "old"}
    found = graph({**files, "car/main.cpp": main}, 1)
    assert {(node, topic) for node, topic, _ in ends(found, "publisher") if node == "car/main"} == {
        ("car/main", "/new")
    }


def test_launch_files_outside_of_packages_start_nodes_too(tmp_path):
    files = {"car/package.xml": manifest("car", "catkin"), "car/CMakeLists.txt": CMAKE, "car/talker.cpp": PARAMETER}
    files["launch/all.launch"] = """
        <launch><group ns="left"><node pkg="car" type="talker" name="t"/></group></launch>
    """
    assert {node.id for node in graph_on_disk(tmp_path, files).nodes} == {"/left/t"}


def test_a_program_that_makes_no_node_has_no_name():
    code = """
        import rospy
        from std_srvs.srv import Empty
        if __name__ == '__main__':
            rospy.ServiceProxy('/reset', Empty)()
    """
    found = graph({"car/ask.py": code}, 1)
    assert [(node.kind, node.name) for node in found.nodes] == [("script", "")]


def test_a_module_that_is_called_like_a_test_is_code_and_a_backup_is_not(tmp_path):
    node = """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import String
        class Ear(Node):
            def __init__(self):
                super().__init__('ear')
                self.declare_parameter('topic', '%s')
                self.create_subscription(String, self.get_parameter('topic').value, print, 1)
        def main():
            rclpy.init()
            Ear()
    """
    setup = """
        from setuptools import setup
        setup(name="car_test", entry_points={"console_scripts": ["a = car_test.a:main", "b = car_test.b:main"]})
    """
    files = {
        "car_test/package.xml": manifest("car_test", "ament_python"), "car_test/setup.py": setup,
        "car_test/car_test/a.py": node % "/a", "car_test/car_test/b.py": node % "/b",
        "car_test/car_test/.ipynb_checkpoints/a.py": node % "/old", "car_test/test/test_a.py": node % "/tested",
    }  # fmt: skip
    # Each program has the default of its own code.
    assert {(node, topic) for node, topic, _ in ends(graph_on_disk(tmp_path, files), "subscriber")} == {
        ("car_test/a", "/a"), ("car_test/b", "/b")
    }  # fmt: skip


def test_defaults_stand_where_a_function_is_declared():
    files = {
        "car/servo.hpp": """
            #include <ros/ros.h>
            struct Servo { static void begin(ros::NodeHandle & n, const std::string & ns = "arm"); };
        """,
        "car/servo.cpp": """
            #include "servo.hpp"
            #include <std_msgs/String.h>
            void Servo::begin(ros::NodeHandle & n, const std::string & ns) {
              n.advertise<std_msgs::String>(ns + "/out", 1);
            }
            int main(int argc, char ** argv) {
              ros::init(argc, argv, "servo");
              ros::NodeHandle n;
              Servo::begin(n);
            }
        """,
    }
    assert ends(graph(files, 1), "publisher") == {("car/servo", "/arm/out", "std_msgs/String")}


def test_plugins_are_in_the_nodes_that_parameter_files_load_them_into(tmp_path):
    code = """
        #include <rclcpp/rclcpp.hpp>
        #include <std_msgs/msg/string.hpp>
        #include <pluginlib/class_list_macros.hpp>
        namespace car {
        class %s : public Base {
          void configure() {
            auto node = get_node();
            one_ = node->create_publisher<std_msgs::msg::String>("~/state", 1);
            two_ = node->create_publisher<std_msgs::msg::String>("/whole", 1);
            three_ = node->create_publisher<std_msgs::msg::String>("plain", 1);
          }
          rclcpp::Publisher<std_msgs::msg::String>::SharedPtr one_, two_, three_;
        };
        }
        PLUGINLIB_EXPORT_CLASS(car::%s, Base)
    """
    plugins = """
        <library path="car"><class name="car/Wheel" type="car::Wheel" base_class_type="Base"/>
        <class name="car::Layer" type="car::Layer" base_class_type="Base"/></library>
    """
    parameters = """
        left/controller_manager:
          ros__parameters:
            front_wheel: {type: car/Wheel}
        map/map:
          ros__parameters:
            layers: ["sky"]
            sky: {plugin: "car::Layer"}
    """
    cmake = """
        project(car)
        find_package(ament_cmake REQUIRED)
        add_library(car SHARED wheel.cpp layer.cpp)
        pluginlib_export_plugin_description_file(base plugins.xml)
        ament_package()
    """
    files = {
        "car/package.xml": manifest("car", "ament_cmake"), "car/CMakeLists.txt": cmake, "car/plugins.xml": plugins,
        "car/wheel.cpp": code % ("Wheel", "Wheel"), "car/layer.cpp": code % ("Layer", "Layer"),
        "car/config/a.yaml": parameters,
    }  # fmt: skip
    found = graph_on_disk(tmp_path, files)
    assert {node.id: node.started for node in found.nodes} == {
        "/left/front_wheel": "car/config/a.yaml:3", "/map/map": "car/config/a.yaml:7"
    }  # fmt: skip
    assert {(node, topic) for node, topic, _ in ends(found, "publisher")} == {
        ("/left/front_wheel", "/left/front_wheel/state"), ("/left/front_wheel", "/whole"),
        ("/left/front_wheel", "/left/plain"),
        ("/map/map", "/map/map/state"), ("/map/map", "/whole"), ("/map/map", "/map/plain"),
    }  # fmt: skip
    del files["car/config/a.yaml"]
    assert {node.name for node in graph_on_disk(tmp_path / "alone", files).nodes} == {""}


def test_a_local_variable_has_one_value_at_each_place():
    code = """
        import rospy
        from std_srvs.srv import Empty
        from std_msgs.msg import String
        def begin(fast):
            name = 'first'
            rospy.Service(name, Empty, print)
            name = 'second'
            if fast:
                name = 'third'
            rospy.Service(name, Empty, print)
            name = 'fourth'
            for kind in ('a', 'b'):
                rospy.Publisher(name, String)
                name = 'fifth'
        if __name__ == '__main__':
            rospy.init_node('desk')
            begin(True)
    """
    found = graph({"car/desk.py": code}, 1)
    told = {}
    for one in found.endpoints:
        if not one.implied:
            told.setdefault((one.role, one.line), set()).add(one.topic)
    assert sorted(map(sorted, told.values())) == [["/fifth", "/fourth"], ["/first"], ["/second", "/third"]]


def test_all_nodes_of_a_program_have_the_name_that_a_launch_file_gives(tmp_path):
    node = "".join(NODE.format(name=name, node=name.lower(), topic="~/out") for name in ("Front", "Rear"))
    main = """
        int main(int argc, char ** argv) {
          rclcpp::init(argc, argv);
          auto front = std::make_shared<Front>();
          auto rear = std::make_shared<Rear>();
        }
    """
    cmake = """
        project(car)
        find_package(ament_cmake REQUIRED)
        add_executable(both both.cpp)
        ament_package()
    """
    files = {"car/package.xml": manifest("car", "ament_cmake"), "car/CMakeLists.txt": cmake}
    files["car/both.cpp"] = dedent(node) + dedent(main)
    files["car/launch/a.launch.xml"] = '<launch><node pkg="car" exec="both" namespace="left"/></launch>'
    assert {node.id for node in graph_on_disk(tmp_path / "own", files).nodes} == {"/left/front", "/left/rear"}
    files["car/launch/a.launch.xml"] = '<launch><node pkg="car" exec="both" name="one"/></launch>'
    found = graph_on_disk(tmp_path / "given", files)
    assert {node for node, _, _ in ends(found, "publisher")} == {"/one"}
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"/one/out"}


def test_a_node_that_has_nothing_but_a_timer_is_in_the_graph():
    files = {
        "car/beat.py": """
            import rclpy
            from rclpy.node import Node
            class Beat(Node):
                def __init__(self):
                    super().__init__('beat')
                    self.create_timer(0.5, self.tick)
                def tick(self): pass
            def main():
                rclpy.spin(Beat())
        """,
        "car/idle.py": """
            import rclpy
            from rclpy.node import Node
            def main():
                rclpy.spin(Node('idle'))
        """,
    }
    found = graph(files)
    assert [(node.id, node.name) for node in found.nodes] == [("car/beat.py", "/beat")]
    assert [(timer.node, timer.period) for timer in found.timers] == [("car/beat.py", "0.5")]


HORN = """
    import rospy
    from std_msgs.msg import String
    from %s import TOPIC
    if __name__ == "__main__":
        rospy.init_node("%s")
        rospy.Publisher(TOPIC, String, queue_size=1)
"""


def test_programs_outside_of_packages_run_by_hand(tmp_path):
    files = {
        "src/car/package.xml": manifest("car", "catkin"),
        "src/car/CMakeLists.txt": "project(car)\ncatkin_install_python(PROGRAMS horn.py DESTINATION here)",
        "src/car/horn.py": HORN % ("car_names", "horn"),
        "src/car/car_names.py": "import rospy\nTOPIC = '/car'",
        # Outside of all packages: a program with what it imports, one that is no program, and one without ROS.
        "tools/by_hand.py": HORN % ("names", "by_hand"),
        "tools/names.py": "import rospy\nTOPIC = '/hand'",
        "tools/car_names.py": "import rospy\nTOPIC = '/wrong'",
        "tools/plot.py": "class Publisher: pass\nif __name__ == '__main__': Publisher('/plot', 1)",
        "tools/test_horn.py": HORN % ("names", "tested"),
        "tools/.old/horn.py": HORN % ("names", "old"),
        "tools/build.cpp": """
            int main() { ros::NodeHandle n; n.advertise<std_msgs::Empty>("x", 1); }
        """,
    }
    found = graph_on_disk(tmp_path, files)
    assert ends(found, "publisher") == {
        ("car/horn.py", "/car", "std_msgs/String"), ("tools/by_hand.py", "/hand", "std_msgs/String")
    }  # fmt: skip
    assert [(node.id, node.package, node.kind) for node in found.nodes if node.name == "/by_hand"] == [
        ("tools/by_hand.py", "", "script")
    ]


def test_programs_of_what_is_ignored_are_not_run_by_hand(tmp_path):
    files = {
        "car/package.xml": manifest("car", "catkin"), "car/horn.py": HORN % ("os", "horn"),
        "twin/package.xml": manifest("car", "catkin"), "twin/COLCON_IGNORE": "",
        "twin/horn.py": HORN.replace("TOPIC,", "'/twin',") % ("os", "twin"),
    }  # fmt: skip
    assert {node.name for node in graph_on_disk(tmp_path, files).nodes} == {"/horn"}


def test_what_a_started_program_is_built_of_is_its_own_where_nothing_is_seen_to_call_it(tmp_path):
    """The class of a method is not known here, so nothing leads to it."""
    files = {
        "car/package.xml": manifest("car", "ament_cmake"),
        "car/CMakeLists.txt": """
            project(car)
            find_package(ament_cmake REQUIRED)
            add_executable(lidar main.cpp driver.cpp)
            add_executable(other other.cpp)
            install(TARGETS lidar other DESTINATION lib/car)
            ament_package()
        """,
        "car/main.cpp": """
            #include "gone/driver.h"
            int main(int c, char** v) { rclcpp::init(c, v); Driver driver("lidar"); driver.open(); }
        """,
        "car/driver.cpp": """
            #include "gone/driver.h"
            bool Driver::open() {
              this->declare_parameter<int>("port", 2368);
              out_ = this->create_publisher<sensor_msgs::msg::PointCloud2>("points", 1);
              return true;
            }
        """,
        "car/other.cpp": 'int main(int c, char** v) { rclcpp::init(c, v); rclcpp::Node node("other"); }',
        "car/launch/all.launch.py": """
            from launch import LaunchDescription
            from launch_ros.actions import Node
            def generate_launch_description():
                return LaunchDescription([
                    Node(package="car", executable="lidar", name="left"),
                    Node(package="car", executable="other", name="right"),
                ])
        """,
    }
    found = graph_on_disk(tmp_path, files)
    assert [(one.node, one.topic, one.only_if) for one in found.endpoints if not one.implied] == [
        ("/left", "/points", "something calls `Driver::open`")
    ]
    assert [(one.node, one.name) for one in found.parameters] == [("/left", "port")]


def test_a_package_that_is_left_out_for_its_name_is_named(tmp_path):
    files = {
        "car/package.xml": manifest("car", "catkin"), "car/horn.py": HORN % ("os", "horn"),
        "old/car/package.xml": manifest("car", "catkin"), "old/car/horn.py": HORN % ("os", "old_horn"),
    }  # fmt: skip
    found = graph_on_disk(tmp_path, files)
    (read,) = (node.path.rpartition("/")[0] for node in found.nodes)
    named = [(one.path, one.written, one.reason) for one in found.coverage.unresolved if one.what == "package"]
    (left_out,) = {"car", "old/car"} - {read}
    assert named == [(f"{left_out}/package.xml", "car", f"another package of this name is read, in `{read}`")]
