"""What pruning a workspace changes: lighter messages, publishers that fill them, subscribers that take them, builds."""

import shutil
from pathlib import Path

import pytest
from rosimpact.edges.console import UserError
from rosimpact.impact.prune.session import JOURNAL, Prepared, apply_plan, make_diff, prepare, undo, write_copy

FLEET = Path(__file__).parents[2] / "examples" / "fleet"

ROS1 = {
    "msgs/package.xml": """<package format="2"><name>msgs</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">m</maintainer><license>BSD</license>
  <buildtool_depend>catkin</buildtool_depend>
</package>
""",
    "msgs/CMakeLists.txt": """project(msgs)
find_package(catkin REQUIRED COMPONENTS message_generation)
add_message_files(FILES State.msg Point.msg)
generate_messages()
catkin_package()
""",
    "msgs/msg/Point.msg": "float64 x\nfloat64 y\n",
    "msgs/msg/State.msg": "int32 KEPT = 3\nint32 level # how full\nstring text\nPoint[] points\nPoint at\n",
    "nodes/package.xml": """<package format="2"><name>nodes</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">m</maintainer><license>BSD</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>msgs</depend>
  <depend>roscpp</depend>
</package>
""",
    "nodes/CMakeLists.txt": """project(nodes)
find_package(catkin REQUIRED COMPONENTS roscpp msgs)
catkin_package()
add_executable(talk src/talk.cpp)
add_executable(hear src/hear.cpp)
""",
}
TALK = """#include <ros/ros.h>
#include <msgs/State.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "talk");
  ros::NodeHandle nh;
  ros::Publisher pub = nh.advertise<msgs::State>("state", 1);
  msgs::State state;
  while (ros::ok()) {
    PUBLISH
  }
}
"""
HEAR = """#include <ros/ros.h>
#include <msgs/State.h>

BEFORE
void onState(PARAMETER) {
  BODY
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "hear");
  ros::NodeHandle nh;
  ros::Subscriber sub = nh.subscribe("state", 1, onState);
  ros::spin();
}
"""


def write(root: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return root


def plan_ros1(
    root: Path, body: str, parameter: str = "const msgs::State::ConstPtr& state", before: str = "",
    publish: str = "pub.publish(state);", **more: str,
) -> Prepared:  # fmt: skip
    hear = HEAR.replace("BODY", body).replace("PARAMETER", parameter).replace("BEFORE", before)
    files = {**ROS1, "nodes/src/talk.cpp": TALK.replace("PUBLISH", publish), "nodes/src/hear.cpp": hear, **more}
    return prepare(write(root, files))


def added(prepared: Prepared) -> set[str]:
    """The lines that the change adds, without the white space around them."""
    lines = make_diff(prepared).split("\n")
    return {line[1:].strip() for line in lines if line[:1] == "+" and not line.startswith("+++")} - {""}


def test_a_topic_gets_a_lighter_message(tmp_path):
    prepared = plan_ros1(tmp_path, "ROS_INFO(\"%d %f\", state->level, state->at.x);")
    (plan,) = prepared.plan.plans
    assert (plan.topics, plan.light, plan.keep) == (("/state",), "msgs/StateLight", ("level", "at.x"))
    assert plan.dropped == ("text", "points[].x", "points[].y", "at.y")
    assert prepared.plan.created == {
        "msgs/msg/StateLight.msg": b"int32 KEPT = 3\nint32 level # how full\nStateLightPoint at\n",
        "msgs/msg/StateLightPoint.msg": b"float64 x\n",
    }
    found = added(prepared)
    assert "void onState(const msgs::StateLight::ConstPtr& state) {" in found
    assert 'ros::Publisher pub = nh.advertise<msgs::StateLight>("state", 1);' in found
    assert "pub.publish(fill_state_light(state));" in found
    assert {"light.level = full.level;", "light.at.x = full.at.x;", "#include <msgs/StateLight.h>"} <= found
    assert "add_message_files(FILES State.msg StateLight.msg StateLightPoint.msg Point.msg)" in found
    assert (plan.full_bytes, plan.light_bytes) == (4 + 14 + 4 + 10 * 16 + 16, 12)


# The parameter, the body, what stands before, and lines that the change adds to the subscriber.
CALLBACKS = {
    "elements": ("const msgs::State::ConstPtr& state", "for (auto& p : state->points) use(p.x);", "", (
        "void onState(const msgs::StateLight::ConstPtr& state) {",
    )),
    "a reference": ("const msgs::State& state", "use(state.level);", "", (
        "void onState(const msgs::StateLight& state) {",
    )),
    "a typedef of ROS": ("const msgs::StateConstPtr& state", "use(state->level);", "", (
        "void onState(const msgs::StateLightConstPtr& state) {",
    )),
    "a shared pointer": ("const boost::shared_ptr<msgs::State const>& state", "use(state->level);", "", (
        "void onState(const boost::shared_ptr<msgs::StateLight const>& state) {",
    )),
    "a helper": ("const msgs::State& state", "help(state);", "int help(const msgs::State& s) { return s.level; }", (
        "void onState(const msgs::StateLight& state_light) {",
        "const msgs::State state = widen_state_light(state_light);", "full.level = light.level;",
    )),
    "kept": ("const msgs::State::ConstPtr& state", "last = state;",
             "msgs::State::ConstPtr last;\nint f() { return last->level; }", (
        "void onState(const msgs::StateLight::ConstPtr& state_light) {",
        "const msgs::State::ConstPtr state(new msgs::State(widen_state_light(*state_light)));",
    )),
    "a part with its type": ("const msgs::State& state", "msgs::Point p = state.at; use(p.x);", "", (
        "const msgs::State state = widen_state_light(state_light);",
    )),
    "a part by auto": ("const msgs::State& state", "auto p = state.at; use(p.x);", "", (
        "void onState(const msgs::StateLight& state) {",
    )),
}  # fmt: skip


@pytest.mark.parametrize("name", CALLBACKS)
def test_callbacks_take_the_lighter_message(name, tmp_path):
    parameter, body, before, lines = CALLBACKS[name]
    prepared = plan_ros1(tmp_path, body, parameter, before)
    assert prepared.plan.refusals == ()
    assert set(lines) <= added(prepared)


# What stands in the subscriber's callback, what is published, more files, and a part of the reason.
REFUSED = {
    "published again": ("pub2.publish(state);", {}, "the whole message is handed on: published again"),
    "everything": ("use(state->level, state->text, state->points[0].x, state->points[0].y, state->at.x, state->at.y);",
                   {}, "every field is read"),
    "two arguments": ("use(state->level);", {"publish": "pub.publish(state, 3);"}, "publishes something other than"),
    "braces": ("use(state->level);", {"publish": "pub.publish({});"}, "publishes a list in braces"),
    "handed on": ("use(state->level);", {"publish": "pub.publish(state); give(pub);"}, "the publisher of"),
    "a caller": ("use(state->level);", {"before": "struct A { void f() { onState(nullptr); } };"}, "is called at"),
    "no listing": ("use(state->level);", {"msgs/CMakeLists.txt": "project(msgs)\n"}, "does not name State.msg"),
    "an alias": ("use(state->level);", {"before": "using Some = msgs::State;", "parameter": "const Some& state"},
                 "names the type otherwise"),
    "waited for": ("use(state->level);",
                   {"before": "void once() { ros::topic::waitForMessage<msgs::State>(\"state\"); }"},
                   "nodes/src/hear.cpp:4 waits for a message, which is not followed"),
    "any type": ("use(state->level);", {"nodes/src/any.cpp": (
        '#include <topic_tools/shape_shifter.h>\nvoid any(const topic_tools::ShapeShifter::ConstPtr& m) {}\n'
        'int main(int argc, char** argv) { ros::init(argc, argv, "any"); ros::NodeHandle nh;\n'
        '  ros::Subscriber s = nh.subscribe(argv[1], 1, any); ros::spin(); }\n')}, "subscribes to any type"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_pruned_is_told_with_its_reason(name, tmp_path):
    body, more, reason = REFUSED[name]
    if name == "any type":
        more = {**more, "nodes/CMakeLists.txt": ROS1["nodes/CMakeLists.txt"] + "add_executable(any src/any.cpp)\n"}
    prepared = plan_ros1(tmp_path, body, **more)
    assert prepared.plan.plans == ()
    assert prepared.plan.changed == prepared.plan.created == {}
    (refusal,) = [one for one in prepared.plan.refusals if one.topic == "/state"]
    assert reason in refusal.reason


ROS2_HEAR = """#include <rclcpp/rclcpp.hpp>
#include <msgs/msg/state.hpp>

class Hear : public rclcpp::Node {
 public:
  Hear() : Node("hear") {
    sub_ = create_subscription<msgs::msg::State>("state", 10, std::bind(&Hear::onState, this, std::placeholders::_1));
    more_ = create_subscription<msgs::msg::State>(
      "state", 10, [this](const msgs::msg::State::SharedPtr state) { use(state->level); });
  }
 private:
  void onState(const msgs::msg::State::ConstSharedPtr state) { use(state->at.y); }
  rclcpp::Subscription<msgs::msg::State>::SharedPtr sub_;
  rclcpp::Subscription<msgs::msg::State>::SharedPtr more_;
};
int main(int argc, char** argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Hear>()); }
"""
ROS2_TALK = """#include <rclcpp/rclcpp.hpp>
#include <msgs/msg/state.hpp>

class Talk : public rclcpp::Node {
 public:
  Talk() : Node("talk") { pub_ = create_publisher<msgs::msg::State>("state", 10); }
  void tick() {
    auto state = std::make_unique<msgs::msg::State>();
    state->level = 3;
    pub_->publish(std::move(state));
  }
 private:
  rclcpp::Publisher<msgs::msg::State>::SharedPtr pub_;
};
int main(int argc, char** argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Talk>()); }
"""
MANIFEST2 = """<package format="3"><name>{0}</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">m</maintainer><license>BSD</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>{1}</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
NODES2 = """project(nodes)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package({0} REQUIRED)
add_executable(talk src/talk.cpp)
ament_target_dependencies(talk rclcpp {0})
add_executable(hear src/hear.cpp)
target_link_libraries(hear rclcpp::rclcpp ${{{0}_TARGETS}})
ament_package()
"""
ROS2 = {
    "msgs/package.xml": MANIFEST2.format("msgs", "rosidl_default_generators"),
    "msgs/CMakeLists.txt": """project(msgs)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME}
  "msg/Point.msg"
  "msg/State.msg"
)
ament_package()
""",
    "msgs/msg/Point.msg": ROS1["msgs/msg/Point.msg"],
    "msgs/msg/State.msg": ROS1["msgs/msg/State.msg"],
    "nodes/package.xml": MANIFEST2.format("nodes", "msgs"),
    "nodes/CMakeLists.txt": NODES2.format("msgs"),
    "nodes/src/hear.cpp": ROS2_HEAR,
    "nodes/src/talk.cpp": ROS2_TALK,
}


def test_a_topic_that_is_called_like_its_type(tmp_path):
    files = {name: text.replace('"state"', '"State"') for name, text in ROS2.items()}
    found = added(prepare(write(tmp_path, files)))
    assert 'Talk() : Node("talk") { pub_ = create_publisher<msgs::msg::StateLight>("State", 10); }' in found


def test_a_publisher_whose_type_has_another_name(tmp_path):
    text = ROS2_TALK.replace("rclcpp::Publisher<msgs::msg::State>::SharedPtr pub_", "Out pub_")
    text = text.replace("class Talk", "using Out = rclcpp::Publisher<msgs::msg::State>::SharedPtr;\nclass Talk")
    (refusal,) = prepare(write(tmp_path, {**ROS2, "nodes/src/talk.cpp": text})).plan.refusals
    assert refusal.reason == "`pub_` at nodes/src/talk.cpp:14 is of type `Out`"


@pytest.mark.parametrize("both", [False, True])
def test_publishers_that_are_declared_together(both, tmp_path):
    talk = ROS2_TALK.replace("SharedPtr pub_;", "SharedPtr pub_, more_;").replace(
        'Node("talk") {', 'Node("talk") { \nmore_ = create_publisher<msgs::msg::State>("more", 10);\n')  # fmt: skip
    hear = ROS2_HEAR.replace('      "state", 10, [this]', '      "more", 10, [this]')
    files = {**ROS2, "nodes/src/talk.cpp": talk, "nodes/src/hear.cpp": hear if both else ROS2_HEAR}
    found = prepare(write(tmp_path, files)).plan
    assert [plan.topics for plan in found.plans] == ([("/more", "/state")] if both else [])
    reasons = {one.topic: one.reason for one in found.refusals}
    assert list(reasons) == ([] if both else ["/more", "/state"])
    assert both or "nobody else reads /more" in reasons["/state"]


def test_a_publisher_that_is_declared_with_something_else(tmp_path):
    talk = ROS2_TALK.replace("SharedPtr pub_;", "SharedPtr pub_, last_;")
    (refusal,) = prepare(write(tmp_path, {**ROS2, "nodes/src/talk.cpp": talk})).plan.refusals
    assert refusal.reason == "`pub_` at nodes/src/talk.cpp:13 is declared with `last_`, which keeps its type"


def test_ros2(tmp_path):
    prepared = prepare(write(tmp_path, ROS2))
    (plan,) = prepared.plan.plans
    assert plan.keep == ("level", "at.y")
    assert {
        'sub_ = create_subscription<msgs::msg::StateLight>("state", 10, std::bind(&Hear::onState, this, '
        "std::placeholders::_1));",
        "more_ = create_subscription<msgs::msg::StateLight>(",
        '"state", 10, [this](const msgs::msg::StateLight::SharedPtr state) { use(state->level); });',
        "void onState(const msgs::msg::StateLight::ConstSharedPtr state) { use(state->at.y); }",
        "rclcpp::Subscription<msgs::msg::StateLight>::SharedPtr sub_;",
        "rclcpp::Publisher<msgs::msg::StateLight>::SharedPtr pub_;",
        'Talk() : Node("talk") { pub_ = create_publisher<msgs::msg::StateLight>("state", 10); }',
        "pub_->publish(fill_state_light(std::move(state)));",
        "inline auto fill_state_light(const Pointer & full) -> decltype(fill_state_light(*full))",
        "#include <msgs/msg/state_light.hpp>",
        '"msg/StateLight.msg"',
        '"msg/StateLightPoint.msg"',
    } <= added(prepared)


def test_a_message_of_a_released_package_gets_a_lighter_one_in_a_new_package(tmp_path):
    pytest.importorskip("rosbags")
    files = {name: text for name, text in ROS2.items() if name.startswith("nodes/")}
    swap = (("msgs::msg::State", "sensor_msgs::msg::BatteryState"), ("msgs/msg/state", "sensor_msgs/msg/battery_state"),
            ("state->level", "state->voltage"), ("state->at.y", "state->current"))  # fmt: skip
    for name in ("nodes/src/hear.cpp", "nodes/src/talk.cpp"):
        for old, new in swap:
            files[name] = files[name].replace(old, new)
    files["nodes/package.xml"] = MANIFEST2.format("nodes", "sensor_msgs")
    files["nodes/CMakeLists.txt"] = NODES2.format("sensor_msgs")
    prepared = prepare(write(tmp_path / "ws", {f"src/{name}": text for name, text in files.items()}))
    (plan,) = prepared.plan.plans
    assert (plan.light, plan.keep) == ("light_msgs/BatteryStateStateLight", ("voltage", "current"))
    created = prepared.plan.created
    assert sorted(created) == [
        f"src/light_msgs/{name}" for name in ("CMakeLists.txt", "msg/BatteryStateStateLight.msg", "package.xml")
    ]
    assert b'  "msg/BatteryStateStateLight.msg"\n' in created["src/light_msgs/CMakeLists.txt"]
    assert {
        "<depend>light_msgs</depend>", "find_package(light_msgs REQUIRED)",
        "ament_target_dependencies(talk rclcpp sensor_msgs light_msgs)",
        "target_link_libraries(hear rclcpp::rclcpp ${sensor_msgs_TARGETS} ${light_msgs_TARGETS})",
        "#include <light_msgs/msg/battery_state_state_light.hpp>",
        "rclcpp::Publisher<light_msgs::msg::BatteryStateStateLight>::SharedPtr pub_;",
    } <= added(prepared)  # fmt: skip


PYTHON = {
    "nodes/CMakeLists.txt": "project(nodes)\nfind_package(catkin REQUIRED)\ncatkin_package()\n",
    "nodes/scripts/talk.py": """#!/usr/bin/env python3
import rospy
from msgs.msg import Point, State

rospy.init_node("talk")
pub = rospy.Publisher("state", State, queue_size=1)
while not rospy.is_shutdown():
    state = State(level=3)
    state.points.append(Point(1, 2))
    pub.publish(state)
""",
    "nodes/scripts/hear.py": """#!/usr/bin/env python3
import rospy
import msgs.msg


def on_state(state):
    rospy.loginfo(sum(p.y for p in state.points))


rospy.init_node("hear")
rospy.Subscriber("state", msgs.msg.State, on_state)
rospy.spin()
""",
}


def test_python(tmp_path):
    files = {name: text for name, text in ROS1.items() if name.startswith("msgs/") or name == "nodes/package.xml"}
    prepared = prepare(write(tmp_path, {**files, **PYTHON}))
    (plan,) = prepared.plan.plans
    assert plan.keep == ("points.y",)
    assert {
        "from msgs.msg import StateLight", "from msgs.msg import StateLightPoint",
        'pub = rospy.Publisher("state", StateLight, queue_size=1)', "pub.publish(fill_state_light(state))",
        "for each in full.points:", "made = StateLightPoint()", "made.y = each.y", "light.points.append(made)",
        'rospy.Subscriber("state", StateLight, on_state)',
    } <= added(prepared)  # fmt: skip
    for path, data in prepared.plan.changed.items():
        if path.endswith(".py"):
            compile(data, path, "exec")


# What a callback in Python asks for beside the level, and what is kept, or the reason why nothing is dropped.
ASKED = {
    "the class": ("isinstance(state, State)", "nodes/scripts/hear.py:6 asks for the class of the message"),
    "the type": ("type(state) is State", "nodes/scripts/hear.py:6 asks for the class of the message"),
    "the class of a part": ("state.at.x, isinstance(state.at, Point)",
                            "nodes/scripts/hear.py:6 asks for the class of the message"),
    "the class of a number": ("isinstance(state.level, int)", ("level",)),
    "whether there is a field": ('hasattr(state, "text")', ("level", "text")),
    "whether there is any field": ("hasattr(state, NAME)", "the whole message is handed on: given"),
}  # fmt: skip


@pytest.mark.parametrize("name", ASKED)
def test_what_a_class_is_asked_for_stays(name, tmp_path):
    code, expected = ASKED[name]
    files = {name: text for name, text in ROS1.items() if name.startswith("msgs/") or name == "nodes/package.xml"}
    hear = PYTHON["nodes/scripts/hear.py"].replace("import msgs.msg\n\n", "from msgs.msg import Point, State\n")
    hear = hear.replace("msgs.msg.State", "State").replace("sum(p.y for p in state.points)", f"state.level, {code}")
    plan = prepare(write(tmp_path, {**files, **PYTHON, "nodes/scripts/hear.py": hear})).plan
    if isinstance(expected, tuple):
        assert [one.keep for one in plan.plans] == [expected]
    else:
        assert plan.plans == () and plan.refusals[0].reason.startswith(expected)


def test_topics_with_equal_needs_share_a_message(tmp_path):
    shutil.copytree(FLEET, tmp_path / "fleet")
    brain = tmp_path / "fleet/src/fleet_brain/src/brain.cpp"
    text = brain.read_text()
    brain.write_text(text.replace("say(describe(report));", "say(report.stops.empty() ? \"none\" : \"some\");"))
    log = tmp_path / "fleet/src/fleet_log/scripts/track.py"
    log.write_text(log.read_text().replace(
        'labels = [stop.place.label for stop in report.stops]\n    '
        'said.publish(f"archive {report.state} {report.driver} {labels}")',
        'said.publish(f"archive {len(report.stops)}")',
    ))  # fmt: skip
    plans = {topic: plan.light for plan in prepare(tmp_path / "fleet").plan.plans for topic in plan.topics}
    assert plans["/archive"] == plans["/spare_report"] == "fleet_msgs/ReportArchiveLight"
    assert plans["/report"] != plans["/archive"]


TWO_TALK = """#include <ros/ros.h>
#include <msgs/State.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "talk");
  ros::NodeHandle nh;
  ros::Publisher one = nh.advertise<msgs::State>("one", 1);
  ros::Publisher two = nh.advertise<msgs::State>("two", 1);
  msgs::StatePtr state(new msgs::State);
  one.publish(*state);
  two.publish(state);
}
"""
TWO_HEAR = """#include <ros/ros.h>
#include <msgs/State.h>

int help(const msgs::State& s) { return s.level; }
void onOne(const msgs::State& state) { help(state); }
void onTwo(const msgs::State& state) { help(state); }

int main(int argc, char** argv) {
  ros::init(argc, argv, "hear");
  ros::NodeHandle nh;
  ros::Subscriber one = nh.subscribe("one", 1, onOne);
  ros::Subscriber two = nh.subscribe("two", 1, onTwo);
  ros::spin();
}
"""


def test_a_file_that_uses_a_shared_message_for_two_topics_defines_its_functions_once(tmp_path):
    files = {**ROS1, "nodes/src/talk.cpp": TWO_TALK, "nodes/src/hear.cpp": TWO_HEAR}
    prepared = prepare(write(tmp_path, files))
    (plan,) = prepared.plan.plans
    assert (plan.topics, plan.light, plan.keep) == (("/one", "/two"), "msgs/StateOneLight", ("level",))
    talk, hear = (prepared.plan.changed[f"nodes/src/{name}.cpp"].decode() for name in ("talk", "hear"))
    assert talk.count("inline msgs::StateOneLight fill_state_one_light(") == 1
    assert talk.count("inline auto fill_state_one_light(") == 1
    assert hear.count("inline msgs::State widen_state_one_light(") == 1
    assert "one.publish(fill_state_one_light(*state));" in talk
    assert "two.publish(fill_state_one_light(state));" in talk


def test_a_lighter_message_is_not_called_like_one_of_another_package(tmp_path):
    files = {
        "more/package.xml": ROS1["msgs/package.xml"].replace("msgs", "more"),
        "more/CMakeLists.txt": ROS1["msgs/CMakeLists.txt"].replace("msgs", "more").replace("State.", "statelight."),
        "more/msg/statelight.msg": "int8 x\n",
        "more/msg/Point.msg": "float64 x\n",
    }
    prepared = plan_ros1(tmp_path, "use(state->level);", **files)
    assert [plan.light for plan in prepared.plan.plans] == ["msgs/StateLight2"]


def read_all(root: Path) -> dict[str, bytes]:
    return {one.relative_to(root).as_posix(): one.read_bytes() for one in root.rglob("*") if one.is_file()}


def test_writing_and_taking_back(tmp_path):
    shutil.copytree(FLEET, tmp_path / "fleet")
    root = tmp_path / "fleet"
    before = read_all(root)
    prepared = prepare(root)
    assert len(prepared.plan.plans) == 4
    write_copy(root, tmp_path / "copy", prepared)
    assert read_all(root) == before
    apply_plan(root, prepared)
    after = {path: data for path, data in read_all(root).items() if not path.startswith(JOURNAL)}
    assert after == read_all(tmp_path / "copy") == {**before, **prepared.plan.changed, **prepared.plan.created}
    with pytest.raises(UserError, match="an earlier pruning"):
        apply_plan(root, prepared)
    assert sorted(undo(root)) == sorted({**prepared.plan.changed, **prepared.plan.created})
    assert read_all(root) == before
    with pytest.raises(UserError, match="nothing was pruned here"):
        undo(root)


def test_what_was_changed_since_is_not_taken_back(tmp_path):
    shutil.copytree(FLEET, tmp_path / "fleet")
    root = tmp_path / "fleet"
    apply_plan(root, prepare(root))
    (root / "src/fleet_msgs/CMakeLists.txt").write_text("mine")
    now = read_all(root)
    with pytest.raises(UserError, match=r"CMakeLists\.txt: was changed since"):
        undo(root)
    assert read_all(root) == now


def test_a_pruned_workspace_has_nothing_more_to_prune(tmp_path):
    shutil.copytree(FLEET, tmp_path / "fleet")
    write_copy(tmp_path / "fleet", tmp_path / "copy", prepare(tmp_path / "fleet"))
    assert prepare(tmp_path / "copy").plan.plans == ()


# Files as other editors write them: what is put before each, and how lines end; non-ASCII text stands before the edits.
WRITTEN = {"a byte order mark": ("\ufeff", "\n"), "other line ends": ("", "\r\n"), "both": ("\ufeff", "\r\n"),
           "plain": ("", "\n")}  # fmt: skip


@pytest.mark.parametrize("name", WRITTEN)
def test_files_keep_their_bytes_besides_the_change(name, tmp_path):
    mark, end = WRITTEN[name]
    code = {
        "nodes/src/talk.cpp": TALK.replace("PUBLISH", "/* größer → ∞ 🤖 */ pub.publish(state);"),
        "nodes/src/hear.cpp": HEAR.replace("BEFORE", "// Ärger\n").replace(
            "PARAMETER", "const msgs::State::ConstPtr& state").replace("BODY", "/* ü */ last = state;").replace(
            "// Ärger", "// Ärger\nmsgs::State::ConstPtr last;\nint f() { return last->level; }"),
    }  # fmt: skip
    write(tmp_path, {**ROS1, **dict.fromkeys(code, "")})
    for path, text in code.items():
        (tmp_path / path).write_bytes((mark + text.replace("\n", end)).encode())
    prepared = prepare(tmp_path)
    changed = {path: data.decode() for path, data in prepared.plan.changed.items()}
    talk, hear = changed["nodes/src/talk.cpp"], changed["nodes/src/hear.cpp"]
    assert talk.startswith(f"{mark}#include <ros/ros.h>{end}#include <msgs/State.h>{end}#include <msgs/StateLight.h>")
    assert "/* größer → ∞ 🤖 */ pub.publish(fill_state_light(state));" in talk
    assert f"void onState(const msgs::StateLight::ConstPtr& state_light) {{{end}" in hear
    assert "/* ü */ last = state;" in hear
    assert talk.count("\n") == talk.count(end) and hear.count("\n") == hear.count(end)


def test_a_source_that_is_not_utf8_keeps_its_bytes(tmp_path):
    write(tmp_path, {**ROS1, "nodes/src/hear.cpp": HEAR.replace("BEFORE", "").replace(
        "PARAMETER", "const msgs::State& state").replace("BODY", "use(state.level);")})  # fmt: skip
    text = TALK.replace("PUBLISH", "/* gr\u00f6\u00dfer */ pub.publish(state);").encode("latin-1")
    (tmp_path / "nodes/src/talk.cpp").write_bytes(text)
    changed = prepare(tmp_path).plan.changed["nodes/src/talk.cpp"]
    assert b"/* gr\xf6\xdfer */ pub.publish(fill_state_light(state));" in changed


# What is named but not read has to be there: the callback, and what is kept.
NAMED = {
    "a part": ("const msgs::State& state", "auto p = state.at; use(state.level);", ("level", "at.x")),
    "written": ("msgs::State state", "state.at.y = 1; use(state.level);", ("level", "at.y")),
    "cleared": ("msgs::State state", "state.points.clear(); use(state.level);", ("level", "points.x")),
    "counted": ("const msgs::State& state", "int n = 0; for (const auto& p : state.points) ++n; use(n);", ("points",)),
    "nothing named": ("const msgs::State& state", "use(state.level);", ("level",)),
}


@pytest.mark.parametrize("name", NAMED)
def test_what_is_named_is_kept(name, tmp_path):
    parameter, body, kept = NAMED[name]
    prepared = plan_ros1(tmp_path, body, parameter)
    assert [plan.keep for plan in prepared.plan.plans] == [kept]


def test_names_are_kept_in_python(tmp_path):
    files = {name: text for name, text in ROS1.items() if name.startswith("msgs/") or name == "nodes/package.xml"}
    hear = PYTHON["nodes/scripts/hear.py"].replace("sum(p.y for p in state.points)", "state.level, state.at")
    hear = hear.replace("rospy.loginfo(", "at = state.at; print(").replace(", state.at)", ")")
    prepared = prepare(write(tmp_path, {**files, **PYTHON, "nodes/scripts/hear.py": "\ufeff" + hear}))
    assert [plan.keep for plan in prepared.plan.plans] == [("level", "at.x")]
    assert "import rospy" in prepared.plan.changed["nodes/scripts/hear.py"].decode("utf-8-sig").split("\n")


def test_headers_that_are_included_together_define_a_function_once(tmp_path):
    helper = """#pragma once
#include <msgs/State.h>
struct KIND {
  void send() { msgs::State state; pub.publish(state); }
  ros::NodeHandle nh;
  ros::Publisher pub = nh.advertise<msgs::State>("state", 1);
};
"""
    more = {f"nodes/include/nodes/{name}.h": helper.replace("KIND", name) for name in ("One", "Two")}
    more["nodes/src/hear.cpp"] = HEAR.replace("BEFORE", '#include "nodes/One.h"\n#include "nodes/Two.h"').replace(
        "PARAMETER", "const msgs::State& state").replace("BODY", "use(state.level);")  # fmt: skip
    prepared = prepare(write(tmp_path, {**ROS1, **more, "nodes/src/talk.cpp": TALK.replace("PUBLISH", "")}))
    assert len(prepared.plan.plans) == 1
    for path in ("nodes/include/nodes/One.h", "nodes/include/nodes/Two.h"):
        text = prepared.plan.changed[path].decode()
        assert "#ifndef MSGS_FILL_STATE_LIGHT_DEFINED\n#define MSGS_FILL_STATE_LIGHT_DEFINED\n// Fills" in text
        assert text.count("#endif") == 1


def test_overloads_of_a_callback_keep_their_type(tmp_path):
    before = "void onState(const msgs::State& state, int more);"
    prepared = plan_ros1(tmp_path, "use(state.level);", "const msgs::State& state", before)
    assert len(prepared.plan.plans) == 1
    assert before in prepared.plan.changed["nodes/src/hear.cpp"].decode()


def test_a_macro_that_publishes_is_no_publish_statement(tmp_path):
    publish = "pub.publish(state); SEND(state);\n#define SEND(what) pub.publish(what)"
    (refusal,) = plan_ros1(tmp_path, "use(state->level);", publish=publish).plan.refusals
    assert refusal.reason == "a macro of nodes/src/talk.cpp names `pub`, which is not followed"


def test_what_may_be_the_one_field_of_a_message_is_not_wrapped(tmp_path):
    files = {name: text for name, text in ROS1.items() if name.startswith("msgs/") or name == "nodes/package.xml"}
    files["msgs/msg/State.msg"] = "Point at\n"
    talk = PYTHON["nodes/scripts/talk.py"].replace("pub.publish(state)", "pub.publish(Point(1, 2))")
    hear = PYTHON["nodes/scripts/hear.py"].replace("sum(p.y for p in state.points)", "state.at.x")
    talk = talk.replace("State(level=3)", "State()").replace("    state.points.append(Point(1, 2))\n", "")
    files.update({**PYTHON, "nodes/scripts/talk.py": talk, "nodes/scripts/hear.py": hear})
    (refusal,) = prepare(write(tmp_path, files)).plan.refusals
    assert refusal.reason == "nodes/scripts/talk.py:9 may publish the one field that msgs/State has"


RELEASED = {
    "src/nodes/package.xml": """<package format="2"><name>nodes</name><version>1.0.0</version>
  <description>d</description>
  <maintainer email="a@b.org">m</maintainer><license>BSD</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>sensor_msgs</depend>
  <depend>nav_msgs</depend>
</package>
""",
    "src/nodes/CMakeLists.txt": """project(nodes)
find_package(catkin REQUIRED COMPONENTS roscpp nav_msgs sensor_msgs)
catkin_package()
add_executable(talk src/talk.cpp)
""",
    "src/nodes/src/talk.cpp": """#include <ros/ros.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "talk");
  ros::NodeHandle nh;
  ros::Publisher odom = nh.advertise<nav_msgs::Odometry>("odom", 1);
  ros::Publisher imu = nh.advertise<sensor_msgs::Imu>("imu", 1);
  odom.publish(nav_msgs::Odometry());
  imu.publish(sensor_msgs::Imu());
}
""",
    "src/scripts/package.xml": """<package format="2"><name>scripts</name><version>1.0.0</version>
  <description>d</description>
  <maintainer email="a@b.org">m</maintainer><license>BSD</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>nav_msgs</depend>
</package>
""",
    "src/scripts/CMakeLists.txt": "project(scripts)\nfind_package(catkin REQUIRED)\ncatkin_package()\n",
    "src/scripts/nodes/hear": """#!/usr/bin/env python3
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

rospy.init_node("hear")
rospy.Subscriber("odom", Odometry, lambda msg: print(msg.pose.pose.position.x))
rospy.Subscriber("imu", Imu, lambda msg: print(msg.orientation.w))
rospy.spin()
""",
}  # fmt: skip


def test_a_new_package_is_named_once_in_cmake_and_not_for_scripts(tmp_path):
    pytest.importorskip("rosbags")
    prepared = prepare(write(tmp_path, RELEASED))
    assert {plan.topics for plan in prepared.plan.plans} == {("/odom",), ("/imu",)}
    build = prepared.plan.changed["src/nodes/CMakeLists.txt"].decode()
    assert build.count("light_msgs") == 1
    assert "src/scripts/CMakeLists.txt" not in prepared.plan.changed
    for name in ("nodes", "scripts"):
        assert prepared.plan.changed[f"src/{name}/package.xml"].count(b"<depend>light_msgs</depend>") == 1


@pytest.mark.parametrize(
    "head",
    ["#!/usr/bin/env python3\n# -*- coding: utf-8 -*-\n", "# -*- coding: utf-8 -*-\n", "#!/usr/bin/env python3\n", ""],
)
def test_the_coding_of_a_script_stays_in_its_first_lines(head, tmp_path):
    hear = f"""{head}def on_state(state):
    import rospy
    rospy.loginfo(state.level)


def main():
    import rospy
    from msgs.msg import State
    rospy.init_node("hear")
    rospy.Subscriber("state", State, on_state)
    rospy.spin()


main()
"""
    files = {name: text for name, text in ROS1.items() if name.startswith("msgs/") or name == "nodes/package.xml"}
    prepared = prepare(write(tmp_path, {**files, **PYTHON, "nodes/scripts/hear.py": hear}))
    found = prepared.plan.changed["nodes/scripts/hear.py"].decode()
    assert found.startswith(f"{head}from msgs.msg import StateLight\n")
    compile(found, "hear.py", "exec")
