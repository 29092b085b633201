"""Which uses of other packages' fields and constants are found in a source file, as tables."""

import msgspec
import pytest
import zstandard
from rosimpact.impact.facts.python.source import extract
from rosimpact.impact.model.cpp.resolver import Resolver
from rosimpact.impact.model.cpp.uses import MemberUses
from rosimpact.impact.model.members import InterfaceScope, find_included_interfaces, find_interface
from rosimpact.impact.model.python.members import find_changing_members, list_used
from rosimpact.impact.targets.surface.fields import Fields

from tests.model.known_files import make_known

# Two states: of each pair, the first member is in the old one alone, the second in the new one.
TEXT = """1.0.0 2.0.0
1.0.0 2.0.0
msg/Joint
 message name old_name@0-0>new_name new_name@1-
msg/Arm
 message joints:arm_msgs/Joint* tool:arm_msgs/Joint mode@0-0 OLD!@0-0
msg/Other
 message name other_field
srv/Start
 request start_arms@0-0 use_arms@1- FAST!@0-0
 response ok@0-0 done@1- arms:arm_msgs/Arm*
action/Move
 goal speed_limit@0-0
 result reached@0-0 end:arm_msgs/Arm
 feedback left"""


@pytest.fixture
def fields(tmp_path) -> Fields:
    path = tmp_path / "fields.json.zst"
    texts = {"arm_msgs 1": TEXT, "arm_msgs 2": TEXT}
    path.write_bytes(zstandard.ZstdCompressor().compress(msgspec.json.encode(texts)))
    return Fields(path)


ROS2 = ("arm_msgs/msg/arm.hpp", "arm_msgs/srv/start.hpp", "arm_msgs/action/move.hpp", "arm_msgs/msg/other.hpp")
ROS1 = ("arm_msgs/Arm.h", "arm_msgs/Start.h", "arm_msgs/MoveAction.h")


def found_in(text: str, scope: InterfaceScope, headers=(), guess=False):
    known = [make_known(each) for each in (text, *headers)]
    found = MemberUses(Resolver(known, None, scope)).find_uses(sorted(scope.changing), guess)
    return sorted(found, key=lambda use: use.at)


def cpp(text: str, fields: Fields, includes=ROS2, headers=()) -> list[str]:
    scope = InterfaceScope(find_included_interfaces(includes, fields)[0], fields)
    found = found_in(text, scope, headers)
    return [f"{f.interface.short}.{f.section}.{f.member}" for f in found if f.sure]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("void f(const arm_msgs::msg::Arm & a) { a.mode; }", ["Arm.message.mode"]),
        ("void f(arm_msgs::msg::Arm::ConstSharedPtr a) { a->tool.old_name; }", ["Joint.message.old_name"]),
        ("void f(const std::shared_ptr<arm_msgs::srv::Start::Request> r) { r->start_arms = {}; }",
         ["Start.request.start_arms"]),
        ("auto r = std::make_shared<arm_msgs::srv::Start::Request>(); r->start_arms;", ["Start.request.start_arms"]),
        ("auto r = arm_msgs::srv::Start::Request(); r.start_arms.clear();", ["Start.request.start_arms"]),
        ("using arm_msgs::msg::Arm; Arm a; a.joints[0].old_name;", ["Joint.message.old_name"]),
        ("using Begin = arm_msgs::srv::Start; void f(Begin::Response & r) { r.ok; }", ["Start.response.ok"]),
        ("std::vector<arm_msgs::msg::Arm> v; v[i].mode; v.at(1).mode; v.front().mode;", ["Arm.message.mode"] * 3),
        ("std::vector<arm_msgs::msg::Arm> v; v.mode;", []),
        ("arm_msgs::msg::Arm a; for (const auto & j : a.joints) { j.old_name; }", ["Joint.message.old_name"]),
        ("arm_msgs::msg::Arm a; auto & t = a.tool; t.old_name;", ["Joint.message.old_name"]),
        ("class N { arm_msgs::msg::Arm a_; void f() { this->a_.mode; } };", ["Arm.message.mode"]),
        ("void f() { auto g = [](const arm_msgs::msg::Arm & a) { a.mode; }; }", ["Arm.message.mode"]),
        ("arm_msgs::msg::Arm a; void f() { auto g = [](Own a) { a.mode; }; }", []),
        ("arm_msgs::msg::Arm a; void f() { auto g = [a = own()] { a.mode; }; auto h = [&a] { a.mode; }; }",
         ["Arm.message.mode"]),
        ("void f(arm_msgs::msg::Arm & a) { (&a)->mode; (*&a).mode; }", ["Arm.message.mode"] * 2),
        ("int x = arm_msgs::msg::Arm::OLD;", ["Arm.message.OLD"]),
        ("int x = arm_msgs::srv::Start::Request::FAST;", ["Start.request.FAST"]),
        ("arm_msgs::action::Move::Goal g; g.speed_limit = 1;", ["Move.goal.speed_limit"]),
        # what another version has as well, what is not a field, and what is another type's
        ("void f(const arm_msgs::msg::Arm & a) { a.joints; a.unheard; a.mode(); }", []),
        ("void f(const Own & a) { a.mode; }", []),
        ("void f(arm_msgs::msg::Arm a) { } void g(Own a) { a.mode; }", []),
        ("void f(arm_msgs::msg::Arm a) { } void g() { a.mode; }", []),
        ("arm_msgs::msg::Arm a; void g() { Own a; a.mode; }", []),
        ("arm_msgs::msg::Arm a; void g() { auto a = own(); a.mode; }", []),
        ("rclcpp::Publisher<arm_msgs::msg::Arm> a; a.mode;", []),
        ("std::map<int, arm_msgs::msg::Arm> a; a[0].mode; a.at(1).mode;", ["Arm.message.mode"] * 2),
        ("std::map<arm_msgs::msg::Arm, int> a; a[0].mode;", []),
        ("other_msgs::msg::Arm a; a.mode;", []),
        ("Own::Arm::OLD;", []),
        ("int x = arm_msgs::srv::Start::request::FAST;", []),
    ],
)  # fmt: skip
def test_cpp(text, found, fields):
    assert cpp(text, fields) == found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("void f(const arm_msgs::Arm::ConstPtr & a) { a->mode; }", ["Arm.message.mode"]),
        ("void f(const arm_msgs::ArmConstPtr & a) { a->mode; }", ["Arm.message.mode"]),
        ("bool f(arm_msgs::Start::Request & q, arm_msgs::Start::Response & p) { q.start_arms; p.ok = 1; }",
         ["Start.request.start_arms", "Start.response.ok"]),
        ("arm_msgs::Start s; s.request.start_arms; s.response.arms[0].mode;",
         ["Start.request.start_arms", "Arm.message.mode"]),
        ("arm_msgs::MoveGoal g; g.speed_limit = 1;", ["Move.goal.speed_limit"]),
        ("void f(const arm_msgs::MoveResultConstPtr & r) { r->end.mode; }", ["Arm.message.mode"]),
        ("int x = arm_msgs::StartRequest::FAST;", ["Start.request.FAST"]),
    ],
)  # fmt: skip
def test_cpp_of_ros1(text, found, fields):
    assert cpp(text, fields, ROS1) == found


@pytest.mark.parametrize(
    ("header", "found"),
    [
        ("struct N { arm_msgs::msg::Arm a_; };", ["Arm.message.mode"]),
        ("struct N { arm_msgs::msg::Arm a_; }; struct M { Own a_; };", ["Arm.message.mode"]),
        ("struct M { arm_msgs::msg::Arm a_; }; struct N { Own a_; };", []),
        ("struct N { Own a_; };", []),
    ],
)
def test_members_that_a_header_declares(header, found, fields):
    assert cpp("void N::f() { a_.mode; }", fields, headers=[header]) == found


def test_two_classes_of_one_name_tell_nothing(fields):
    headers = ["namespace l { struct N { arm_msgs::msg::Arm a_; }; }", "namespace m { struct N { Own a_; }; }"]
    assert cpp("void N::f() { a_.mode; }", fields, headers=headers) == []


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("get()->start_arms = {};", ["start_arms"]),
        ("unseen.start_arms = {};", ["start_arms"]),
        ("Own o; o.start_arms = {};", []),  # it has a type of its own
        ("class N { Own o_; void f() { o_.start_arms = {}; } };", []),
        ("struct M { int o(); }; void N::f() { o.start_arms = {}; }", ["start_arms"]),  # that is another's function
        ("struct Own { int start_arms; }; get()->start_arms = {};", []),
        ("get()->mode;", []),  # a common word
        ("get()->old_name; get()->new_name;", ["old_name", "new_name"]),
    ],
)
def test_names_that_can_mean_nothing_else(text, found, fields):
    scope = InterfaceScope(find_included_interfaces(ROS2, fields)[0], fields)
    assert [f.member for f in found_in(text, scope, guess=True) if not f.sure] == found


IMPORTS = "from arm_msgs.msg import Arm\nfrom arm_msgs.srv import Start as Begin\n"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("a = Arm()\na.mode = 1\n", ["Arm.message.mode"]),
        ("r = Begin.Request(start_arms=[f(x=1)], use_arms=[])\n",
         ["Start.request.start_arms", "Start.request.use_arms"]),
        ("class N:\n  def f(self):\n    self.a = Arm()\n  def g(self):\n    self.a.tool.old_name\n",
         ["Joint.message.old_name"]),
        ("def f(a: Arm):\n  return a.joints[0].old_name\n", ["Joint.message.old_name"]),
        ("class N:\n  def s(self):\n    self.create_subscription(Arm, 'x', self.got, 1)\n"
         "  def got(self, m):\n    m.mode\n",
         ["Arm.message.mode"]),
        ("class N:\n  def s(self):\n    self.create_subscription(Arm, topic, self.got, 1)\n"
         "  def got(self, m):\n    m.mode\n",
         ["Arm.message.mode"]),
        ("x = Arm.OLD\n", ["Arm.message.OLD"]),
        ("x = Begin.Request.FAST\n", ["Start.request.FAST"]),
        ("def f(a):\n  a.mode\n", []),
        ("def f():\n  a = Arm()\ndef g(a):\n  a.mode\n", []),
        ("a = Arm()\na = other()\na.mode\n", []),
        ("a = Arm()\na.joints\n", []),
        ("a = Arm()\nt = a.tool\nt.old_name\n", ["Joint.message.old_name"]),
        ("def f(a: Arm):\n  for j in a.joints:\n    j.old_name\n", ["Joint.message.old_name"]),
        ("def f(a: Arm):\n  return [j.old_name for j in a.joints]\n", ["Joint.message.old_name"]),
        ("def f(a: 'Arm'):\n  g(lambda a: a.mode)\n", []),
        ("def f(a: Arm, b):\n  if b:\n    a = b\n  a.mode\n", []),
        ("if b:\n  a = Arm()\nelse:\n  a = Arm()\na.mode\n", ["Arm.message.mode"]),
        ("if b:\n  a = Arm()\nelse:\n  a = 1\na.mode\n", []),
        ("a = Arm()\nfor x in y:\n  a.mode\n  a = x\n", []),
        ("a = Arm()\ntry:\n  a = f()\nfinally:\n  a.mode\n", []),
        ("a = Arm()\nwith f() as a:\n  a.mode\n", []),
        ("a = Arm()\na.mode()\n", []),
        ("def Arm():\n  pass\na = Arm()\na.mode\n", []),
        ("import arm_msgs.msg\na = arm_msgs.msg.Arm(mode=1)\n", ["Arm.message.mode"]),
        ("import arm_msgs.msg as m\ndef f(a: m.Arm):\n  a.tool.new_name\n", ["Joint.message.new_name"]),
        ("class N:\n  def s(self):\n    self.create_service(Begin, 'x', self.got)\n"
         "  def got(self, q, r):\n    q.start_arms\n    r.done\n    r.arms[0].tool.old_name\n    return r\n",
         ["Joint.message.old_name", "Start.request.start_arms", "Start.response.done"]),
        ("class N:\n  def s(self):\n    self.create_subscription(Arm, 'x', partial(self.got, 1), 1)\n"
         "  def got(self, n, m):\n    n.mode\n", []),
        ("class N:\n  def f(self):\n    self.a = Arm()\n  def g(self, x):\n    self.a = x\n    self.a.mode\n", []),
        ("class N:\n  a: Arm\n  def f(self):\n    self.b: Arm = x()\n    self.b.mode\n", ["Arm.message.mode"]),
    ],
)  # fmt: skip
def test_python(text, found, fields):
    uses = extract((IMPORTS + text).encode()).fields
    scope = InterfaceScope([interface for interface in list_used(uses, fields) if interface.ros == 2], fields)
    members = {f"{f.interface.short}.{f.section}.{f.member}" for _, f in find_changing_members(uses, scope)}
    assert sorted(members) == found


def test_includes_that_are_not_known(fields):
    known, unknown = find_included_interfaces(
        ("arm_msgs/msg/arm.hpp", "leg_msgs/msg/leg.hpp", "arm/arm.hpp", "arm.h"), fields
    )
    assert ([i.name for i in known], unknown) == (["msg/Arm"], ["leg_msgs/msg/leg.hpp"])


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("arm_msgs::msg::Arm::OLD", (2, "msg/Arm")),
        ("arm_msgs::ArmConstPtr", (1, "msg/Arm")),
        ("arm_msgs::MoveGoal", (1, "action/Move")),
        ("arm_msgs::msg::Leg", None),
        ("Arm", None),
    ],
)
def test_interfaces_told_by_a_qualified_name(text, named, fields):
    found = find_interface(text, fields)
    assert (found and (found.ros, found.name)) == named
