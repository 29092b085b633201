"""Which fields of a message callbacks read: in C++ and Python, through all that a message may be handed on to."""

from textwrap import indent

import pytest
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.fields.report import FieldReport, SubscriberFields
from rosimpact.impact.model.fields.topics import report_fields
from rosimpact.impact.model.flow.workspace import link_for_flow, make_graph

STATUS = """std_msgs/Header header
geometry_msgs/Pose pose
int32 level
string name
float32[] ranges
geometry_msgs/Point[] points
"""
MANIFEST = """<package format="2"><name>robot</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">m</maintainer><license>BSD</license>
<buildtool_depend>catkin</buildtool_depend><depend>roscpp</depend><depend>rospy</depend></package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.5)
project(robot)
find_package(catkin REQUIRED COMPONENTS roscpp message_generation)
add_message_files(FILES Status.msg)
generate_messages()
catkin_package()
add_executable(watch src/watch.cpp)
"""
SOURCE = """#include <ros/ros.h>
#include <robot/Status.h>
{before}
class Watch {{
 public:
  Watch() {{ sub_ = nh_.subscribe("status", 1, &Watch::onStatus, this); }}
  void onStatus(const robot::Status::ConstPtr& msg) {{
{body}
  }}
{members}
  ros::NodeHandle nh_;
  ros::Subscriber sub_;
  ros::Publisher pub_;
}};
{after}
int main(int argc, char** argv) {{ ros::init(argc, argv, "watch"); Watch watch; ros::spin(); }}
"""
SCRIPT = """#!/usr/bin/env python3
import copy
import numpy as np
import rospy
from robot.msg import Status
{before}
class Keeper:
    def add(self, status):
        self.name = status.name

class Watch:
    def __init__(self):
        self.last = None
        self.all = []
        self.keeper = Keeper()
        self.sub = rospy.Subscriber("status", Status, self.on_status)

    def on_status(self, msg):
{body}

{members}
if __name__ == "__main__":
    rospy.init_node("watch")
    Watch()
    rospy.spin()
"""


def report(root, files: dict[str, str]) -> FieldReport:
    for name, text in {"package.xml": MANIFEST, "CMakeLists.txt": CMAKE, "msg/Status.msg": STATUS, **files}.items():
        path = root / "robot" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    tree = open_tree(root, "")
    with Store() as store:
        workspace = link_for_flow(tree, store)
        return report_fields(workspace, make_graph(workspace, store, code_alone=True), store, jobs=1)


def read_cpp(root, body: str, members: str = "", before: str = "", after: str = "") -> SubscriberFields:
    code = SOURCE.format(body=indent(body, "    "), members=members, before=before, after=after)
    return find_subscriber(report(root, {"src/watch.cpp": code}))


def read_python(root, body: str, members: str = "", before: str = "") -> SubscriberFields:
    code = SCRIPT.format(body=indent(body, "        "), members=indent(members, "    "), before=before)
    return find_subscriber(report(root, {"scripts/watch.py": code}))


def find_subscriber(found: FieldReport) -> SubscriberFields:
    (topic,) = [one for one in found.topics if one.topic == "/status"]
    (subscriber,) = topic.subscribers
    return subscriber


def tell(subscriber: SubscriberFields) -> tuple[set[str], set[str]]:
    """The fields that are read, and those that escape; `*` for the whole message."""
    return {one.field for one in subscriber.reads}, {one.field or "*" for one in subscriber.escapes}


# What stands in the callback, besides it in the class, before and behind the class; what is read, what escapes.
CPP = {
    "a member": ("int x = msg->level;", "", "", "", "level", ""),
    "nothing": ("(void)msg;", "", "", "", "", ""),
    "a path": ("double x = 2 * msg->pose.position.x;", "", "", "", "pose.position.x", ""),
    "dereferenced": ("double x = (*msg).pose.position.x;", "", "", "", "pose.position.x", ""),
    "a log": ('ROS_INFO("%d %s", msg->level, msg->name.c_str());', "", "", "", "level name", ""),
    "a stream": ("ROS_INFO_STREAM(msg->name << msg->level);", "", "", "", "level name", ""),
    "a test of the pointer": ("if (!msg || msg == nullptr) return;", "", "", "", "", ""),
    "a condition": ("if (msg->level > 3 && msg->name.empty()) { return; }", "", "", "", "level name", ""),
    "a switch": ("switch (msg->level) { case 1: break; }", "", "", "", "level", ""),
    "an index": ("double x = table_[msg->level];", "double table_[9];", "", "", "level", ""),
    "elements": ("for (size_t i = 0; i < msg->ranges.size(); ++i) sum_ += msg->ranges[i];", "double sum_;", "", "",
                 "ranges", ""),
    "elements of a message": ("for (const auto& p : msg->points) sum_ += p.x;", "double sum_;", "", "",
                              "points[].x", ""),
    "an iterator": ("for (auto it = msg->points.begin(); it != msg->points.end(); ++it) sum_ += it->y;",
                    "double sum_;", "", "", "points[].y", ""),
    "a reference": ("const auto& pose = msg->pose; double x = pose.orientation.w;", "", "", "",
                    "pose.orientation.w", ""),
    "a copy": ("geometry_msgs::Pose pose = msg->pose; double x = pose.orientation.w;", "", "", "",
               "pose.orientation.w", ""),
    "a copy by parentheses": ("robot::Status copy(*msg); double x = copy.level;", "", "", "", "level", ""),
    "a pointer to a part": ("const geometry_msgs::Pose* p = &msg->pose; double x = p->position.z;", "", "", "",
                            "pose.position.z", ""),
    "a helper": ("help(*msg);", "void help(const robot::Status& s) { x_ = s.level; } int x_;", "", "", "level", ""),
    "a free helper behind it": ("help(msg);", "", "void help(const robot::StatusConstPtr& s);",
                                "void help(const robot::StatusConstPtr& s) { ROS_INFO(\"%s\", s->name.c_str()); }",
                                "name", ""),
    "a part given": ("double x = norm(msg->pose.position);", "",
                     "double norm(const geometry_msgs::Point& p) { return p.x * p.x + p.y * p.y; }", "",
                     "pose.position.x pose.position.y", ""),
    "a template": ("show(*msg);", "", "template <class T> void show(const T& t) { int x = t.level; }", "",
                   "level", ""),
    "kept": ("last_ = msg;", "robot::Status::ConstPtr last_; void tick() { int x = last_->level; }", "", "",
             "level", ""),
    "kept as a copy": ("last_ = *msg;", "robot::Status last_; double f() { return last_.pose.position.x; }", "", "",
                       "pose.position.x", ""),
    "kept by another class": ("state.last = msg;", "", "struct State { robot::StatusConstPtr last; }; State state;",
                              "int look(State& s) { return s.last->level; }", "level", ""),
    "kept in a list": ("list_.push_back(*msg);",
                       "std::vector<robot::Status> list_; int f() { return list_.back().level + list_.size(); }",
                       "", "", "level", ""),
    "a global": ("last = *msg;", "", "robot::Status last;", "int f() { return last.level; }", "level", ""),
    "a getter": ("last_ = msg;",
                 "robot::StatusConstPtr last_; robot::StatusConstPtr get() { return last_; }"
                 " int f() { return get()->level; }", "", "", "level", ""),
    "a lambda": ("auto f = [&]() { return msg->level; }; f();", "", "", "", "level", ""),
    "a lambda with a name of its own": ("auto f = [m = msg]() { return m->level; }; f();", "", "", "", "level", ""),
    "the same name captured": ("auto f = [msg = msg]() { return msg->level; }; f();", "", "", "", "level", ""),
    "a shared copy": ("auto copy = boost::make_shared<robot::Status>(*msg); int x = copy->level;", "", "", "",
                      "level", ""),
    "published": ("pub_.publish(msg);", "", "", "", "", "*"),
    "handed away": ("elsewhere(*msg);", "", "", "", "", "*"),
    "a part handed away": ("elsewhere(msg->pose);", "", "", "", "", "pose"),
    "put into another message": ("out_.pose = msg->pose;", "nav_msgs::Odometry out_;", "", "", "", "pose"),
    "put below another message": ("robot::Big big; big.inner.status = *msg;", "", "", "", "", "*"),
    "printed": ("ROS_INFO_STREAM(*msg);", "", "", "", "", "*"),
    "printed by a stream": ("std::cout << *msg;", "", "", "", "", "*"),
    "compared": ("if (*msg == old_) return;", "robot::Status old_;", "", "", "", "*"),
    "taken apart": ("auto [a, b] = split(*msg);", "", "", "", "", "*"),
    "in a macro": ("GRAB;", "int x_;", "#define GRAB x_ = msg->level", "", "", "*"),
    "given back by a lambda": ("auto f = [msg]() { return msg; };", "", "", "", "", "*"),
    "a choice": ("const auto& p = flag_ ? msg->pose : other_; double x = p.position.x;",
                 "bool flag_; geometry_msgs::Pose other_;", "", "", "pose.position.x", ""),
    "assigned only": ("robot::Status copy = *msg; copy.level = 3;", "", "", "", "", ""),
    "changed in place": ("robot::Status copy = *msg; copy.level += 3;", "", "", "", "level", ""),
    "a member of a base class that is not here": ("last_ = msg; look();", "", "", "", "", "*"),
    "the size alone": ("size_t n = msg->points.size();", "", "", "", "", ""),
    "a copy of an array of messages": ("std::vector<geometry_msgs::Point> ps = msg->points; x_ = ps[0].x;",
                                       "double x_;", "", "", "points[].x", ""),
    "a swap": ("robot::Status s = *msg; std::swap(s, other_); x_ = other_.level;",
               "robot::Status other_; int x_;", "", "", "", "*"),
    "a class made of it": ("Keeper keeper(*msg);", "",
                           "struct Keeper { Keeper(const robot::Status& s) : level(s.level) {} int level; };", "",
                           "level", ""),
    "through a reference": ("put(last_, *msg);", "robot::Status last_;",
                            "void put(robot::Status& to, const robot::Status& s) { to = s; }", "", "", "*"),
    "through a pointer": ("robot::Status* p = &last_; *p = *msg; x_ = last_.level;", "robot::Status last_; int x_;", "",
                          "", "level", ""),
    "through another name of a list": ("auto& list = list_; list.push_back(*msg);",
                                       "std::vector<robot::Status> list_; int f() { return list_[0].level; }", "", "",
                                       "level", ""),
    "two to make a list": ("std::vector<robot::Status> v{*msg, *msg}; x_ = v[0].level;", "int x_;", "", "", "", "*"),
    "a class made of it by =": ("Keeper keeper = *msg;", "",
                                "struct Keeper { Keeper(const robot::Status& s) : level(s.level) {} int level; };",
                                "", "", "*"),
    "a class given back": ("make(*msg);", "",
                           "struct Keeper { Keeper(const robot::Status& s) : level(s.level) {} int level; };\n"
                           "Keeper make(const robot::Status& s) { return s; }", "", "", "*"),
    "a local function": ("auto f = [](const robot::Status& s) { return s.level; }; f(*msg);", "",
                         "int f(const robot::Status& s) { return 3; }", "", "level", ""),
    "a container of one's own": ("kept_.add(*msg);", "Kept kept_;",
                                 "struct Kept { void add(const robot::Status& s) { x = s.level; } int x; };", "",
                                 "level", ""),
    "an ordered set": ("set_.insert(*msg);", "std::set<robot::Status, Less> set_;",
                       "struct Less { bool operator()(const robot::Status& a, const robot::Status& b) const"
                       " { return a.level < b.level; } };", "", "", "*"),
    "swapped": ("robot::Status s = *msg; last_.swap(s); x_ = last_.level;", "Swap last_; int x_;",
                "struct Swap { int level; };", "", "", "*"),
    "moved": ("auto s = std::move(msg); int x = s->level;", "", "", "", "level", ""),
    "a template that is made": ("last_ = *msg; x_ = last_.level;", "robot::Status last_; int x_;",
                                "template <class T> struct Box { T t; };",
                                "template class Box<int>; extern template struct Box<char>;", "level", ""),
    "an algorithm": ("std::for_each(msg->points.begin(), msg->points.end(),"
                     " [&](const geometry_msgs::Point& p) { sum_ += p.x; });", "double sum_;", "", "",
                     "points[].x", ""),
    "an algorithm that finds": ("auto it = std::find_if(msg->points.begin(), msg->points.end(),"
                                " [](const auto& p) { return p.x > 0; }); x_ = it->z;", "double x_;", "", "",
                                "points[].x points[].z", ""),
    "an algorithm that compares": ("x_ = std::min_element(msg->points.begin(), msg->points.end(),"
                                   " [](auto& a, auto& b) { return a.x < b.y; })->z;", "double x_;", "", "",
                                   "points[].x points[].y points[].z", ""),
    "a sum": ("x_ = std::accumulate(msg->points.begin(), msg->points.end(), 0.0,"
              " [](double s, const geometry_msgs::Point& p) { return s + p.y; });", "double x_;", "", "",
              "points[].y", ""),
    "an algorithm that transforms": ("std::transform(msg->points.begin(), msg->points.end(), std::back_inserter(xs_),"
                                     " [](const geometry_msgs::Point& p) { return p.z; });", "std::vector<double> xs_;",
                                     "", "", "points[].z", ""),
    "an algorithm that copies": ("std::copy_if(msg->points.begin(), msg->points.end(), std::back_inserter(ps_),"
                                 " [](const auto& p) { return p.z > 0; });", "std::vector<geometry_msgs::Point> ps_;",
                                 "", "", "", "points[]"),
    "an algorithm with a function": ("std::for_each(msg->points.begin(), msg->points.end(), each);", "", "", "",
                                     "", "points[]"),
    "an algorithm over a part": ("std::for_each(msg->points.begin(), other_, [](const auto& p) { x_ += p.x; });",
                                 "", "", "", "", "points[]"),
    "two loops of a name": ("for (const auto& p : msg->points) sum_ += p.x;\n"
                            "for (const auto& p : list_.back().poses) sum_ += p.position.y;",
                            "double sum_; std::vector<geometry_msgs::PoseArray> list_;", "", "", "points[].x",
                            "points[]"),
    "given back by what is around a lambda": ("x_ = get(*msg).level;", "int x_;",
                                              "robot::Status get(const robot::Status& s) { robot::Status found;"
                                              " auto f = [&]() { found = s; }; f(); return found; }", "", "level", ""),
    "functions of one line": ("put(*msg);", "robot::Status last_; void put(const robot::Status& s) { last_ = s; }"
                              " const robot::Status& fetch() { return last_; } int f() { return fetch().level; }",
                              "", "", "level", ""),
    "set by a lambda": ("robot::Status found; auto f = [&]() { found = *msg; }; f(); x_ = found.level;", "int x_;", "",
                        "", "level", ""),
    "returned through": ("int x = pass(msg)->level;", "",
                         "robot::StatusConstPtr pass(const robot::StatusConstPtr& s) { return s; }", "", "level", ""),
}  # fmt: skip


@pytest.mark.parametrize("name", CPP)
def test_what_a_callback_in_cpp_reads(name, tmp_path):
    body, members, before, after, reads, escapes = CPP[name]
    found = read_cpp(tmp_path, body, members, before, after)
    assert tell(found) == (set(reads.split()), set(escapes.split()))


# What stands in the callback, besides it in the class, and before it.
PYTHON = {
    "a member": ("x = msg.level", "", "", "level", ""),
    "a path": ("x = 2 * msg.pose.position.x", "", "", "pose.position.x", ""),
    "nothing": ("pass", "", "", "", ""),
    "a log": ('rospy.loginfo("%s", msg.name)', "", "", "name", ""),
    "printed": ("print(msg)", "", "", "", "*"),
    "a format": ('s = f"{msg.name} {msg.level}"', "", "", "level name", ""),
    "a format of all": ('s = "%s" % msg', "", "", "", "*"),
    "none": ("if msg is None: return", "", "", "", ""),
    "elements": ("x = [r * 2 for r in msg.ranges]", "", "", "ranges", ""),
    "elements of a message": ("x = sum(p.x for p in msg.points)", "", "", "points[].x", ""),
    "numbered elements": ("for i, p in enumerate(msg.points):\n    x = p.y * i", "", "", "points[].y", ""),
    "pairs": ("for a, p in zip(msg.ranges, msg.points):\n    x = p.z", "", "", "ranges points[].z", ""),
    "two loops of a name": ("for p in msg.points:\n    x = p.y\nfor p in [msg.pose]:\n    x = p.position.x",
                            "", "", "points[].y", "pose points[]"),
    "one name for two fields": ("p = msg.pose\nx = p.orientation.w\nfor p in msg.points:\n    x = p.y",
                                "", "", "pose.orientation.w points[].y", ""),
    "a copy of a list": ("self.some.append(msg)", "some = []\nothers = []\n"
                         "def tick(self):\n    self.others = self.some.copy()\n    self.some = self.others.copy()\n"
                         "def see(self):\n    return self.others[0].level", "", "level", ""),
    "numpy": ("x = np.array(msg.ranges, dtype=float)", "", "", "ranges", ""),
    "a slice": ("x = [p.x for p in msg.points[1:]]", "", "", "points[].x", ""),
    "a name for a part": ("p = msg.pose.position\nx = p.x", "", "", "pose.position.x", ""),
    "getattr": ('x = getattr(msg, "level")', "", "", "level", ""),
    "getattr of a constant": ("x = getattr(msg, FIELD)", "", 'FIELD = "level"\n', "level", ""),
    "getattr of a constant that is changed": ("x = getattr(msg, FIELD)", "",
                                              'FIELD = "level"\nFIELD += "s"\n', "", "*"),
    "getattr of a parameter": ("self.show(msg, 'name')",
                               "def show(self, status, FIELD):\n    x = getattr(status, FIELD)",
                               'FIELD = "level"\n', "", "*"),
    "getattr of what is not known": ("x = getattr(msg, self.field)", "", "", "", "*"),
    "kept": ("self.last = msg", "def tick(self):\n    return self.last.level", "", "level", ""),
    "a property": ("self._last = msg", "@property\ndef seen(self):\n    return self._last\n"
                   "def tick(self):\n    return self.seen.level", "", "level", ""),
    "a helper": ("self.help(msg)", "def help(self, status):\n    return status.level", "", "level", ""),
    "a function": ("help(msg)", "", "def help(status):\n    return status.name\n", "name", ""),
    "a keyword": ("help(status=msg)", "", "def help(status):\n    return status.name\n", "name", ""),
    "a keyword of a method": ("self.help(status=msg)", "def help(self, *, status=None):\n    return status.name", "",
                              "name", ""),
    "a keyword of what is not here": ("elsewhere.use(status=msg)", "", "", "", "*"),
    "a keyword of many": ("self.help(status=msg)", "def help(self, **every):\n    return every", "", "", "*"),
    "a static method": ("Tools.help(msg)", "",
                        "class Tools:\n    @staticmethod\n    def help(status):\n        return status.level\n",
                        "level", ""),
    "a static method's second": ("Tools.help(3, msg)", "",
                                 "class Tools:\n    @staticmethod\n    def help(n, status):\n"
                                 "        return status.level\n", "level", ""),
    "a method by its class": ("Base.help(self, msg)", "",
                              "class Base:\n    def help(self, status):\n        return status.level\n",
                              "level", ""),
    "a variable of a method's name": ("name = msg\nx = name.level", "def name(self):\n    return 3", "",
                                      "level", ""),
    "given back to its giver alone": ("x = pick(msg).level",
                                      "def other(self):\n    return pick(self.else_).name",
                                      "def pick(status):\n    return status\n", "level", ""),
    "given back through two": ("x = self.twice(msg)", "def twice(self, status):\n    return pick(status)\n"
                               "def see(self):\n    return self.twice(self.last).name",
                               "def pick(status):\n    return status\n", "", ""),
    "given back where it is kept": ("self.last = msg\npick(msg)",
                                    "def see(self):\n    return pick(self.last).level",
                                    "def pick(status):\n    return status\n", "level", ""),
    "given back from what is kept": ("self.last = msg", "def get(self, other):\n    x = other or self.last\n"
                                     "    return x\ndef see(self):\n    return self.get(3).level", "", "level", ""),
    "given back by what is around": ("self.last = msg", "def get(self, n):\n    found = None\n    def see():\n"
                                     "        nonlocal found\n        found = self.last\n    see()\n"
                                     "    return found\ndef tick(self):\n    return self.get(1).level", "", "level",
                                     ""),
    "given back by a function that is called": ("self.see(msg)", "def see(self, status):\n    self.keep(status)\n"
                                                "def keep(self, status):\n    global kept\n    kept = status\n"
                                                "def get(self, n):\n    return kept\n"
                                                "def tick(self):\n    return self.get(1).level", "kept = None\n",
                                                "level", ""),
    "given back to who is given it": ("self.last = msg", "def get(self):\n    return self.last\n"
                                      "def more(self, n):\n    return self.get()\n"
                                      "def see(self):\n    return self.more(1).level", "", "level", ""),
    "a member of a module's name": ("self.path = msg",
                                    "def tick(self):\n    return os.path.join('a', str(self.path.level))",
                                    "import os\n", "level", ""),
    "a member of an object in a module": ("self.last = msg", "def tick(self):\n    return config.watch.last.level",
                                          "import config\n", "level", ""),
    "a list": ("self.all.append(msg)", "def tick(self):\n    return [m.level for m in self.all]", "", "level", ""),
    "a list that is passed on": ("fill(self.all, msg)", "", "def fill(every, status):\n    every.append(status)\n",
                                 "", "*"),
    "another name of a list": ("every = self.all\nevery.append(msg)",
                               "def tick(self):\n    return self.all[0].level", "", "level", ""),
    "what is no list": ("self.keeper.add(msg)", "", "", "name", ""),
    "what may be a list": ("self.unknown.add(msg)", "", "", "", "*"),
    "taken from a list": ("self.all.append(msg)", "def tick(self):\n    return self.all.pop(0).level", "", "level", ""),
    "sorted": ("self.all.append(msg)", "def tick(self):\n    self.all.sort(key=lambda m: m.level)", "", "level", ""),
    "sorted by themselves": ("self.all.append(msg)", "def tick(self):\n    self.all.sort()", "", "", "*"),
    "sorted by a key": ("x = sorted(msg.points, key=lambda p: p.z)[0].y", "", "", "points[].y points[].z", ""),
    "sorted by a function": ("x = sorted(msg.points, key=by)", "", "", "", "points"),
    "the first": ("x = min(msg.points, key=lambda p: p.z, default=None).x", "", "", "points[].x points[].z", ""),
    "the first of two": ("x = min(msg.points, self.points, key=lambda p: p.z)", "", "", "", "points"),
    "mapped": ("x = list(map(lambda p: p.x, msg.points))", "", "", "points[].x", ""),
    "mapped by two": ("x = list(map(lambda a, p: p.x, self.points, msg.points))", "", "", "points[].x", ""),
    "mapped to themselves": ("x = list(map(lambda p: p, msg.points))", "", "", "", "points[]"),
    "filtered": ("for p in filter(lambda p: p.x > 0, msg.points):\n    y = p.y", "", "",
                 "points[].x points[].y", ""),
    "a property that is set": ("self.kept = msg",
                               "@property\ndef kept(self):\n    return 1\n"
                               "@kept.setter\ndef kept(self, status):\n    self.x = status.level", "", "level", ""),
    "a property that is made": ("self.kept = msg",
                                "def get(self):\n    return self._x\n"
                                "def put(self, status):\n    self._x = status.level\n"
                                "kept = property(get, put)", "", "", "*"),
    "a copy": ("m = copy.deepcopy(msg)\nx = m.level", "", "", "level", ""),
    "a lambda": ("f = lambda: msg.level", "", "", "level", ""),
    "a global": ("global last\nlast = msg", "def tick(self):\n    return last.level", "last = None\n", "level", ""),
    "handed away": ("elsewhere.use(msg)", "", "", "", "*"),
    "in a tuple": ("self.pair = (msg, 3)", "def tick(self):\n    return self.pair[0].level", "", "level", ""),
    "in a dictionary": ("self.seen = {1: msg}", "", "", "", "*"),
    "published": ("self.pub.publish(msg)", "", "", "", "*"),
    "both names": ("a, b = msg.level, msg.pose\nx = b.position.x", "", "", "level pose.position.x", ""),
    "or": ("m = msg or self.last\nx = m.level", "", "", "level", ""),
    "put into another": ("out = Status()\nout.pose = msg.pose", "", "", "", "pose"),
    "yielded": ("yield msg", "", "", "", "*"),
    "length": ("n = len(msg.points)", "", "", "", ""),
    "a method of a part": ("t = msg.header.stamp.to_sec()", "", "", "header.stamp", ""),
}


@pytest.mark.parametrize("name", PYTHON)
def test_what_a_callback_in_python_reads(name, tmp_path):
    body, members, before, reads, escapes = PYTHON[name]
    found = read_python(tmp_path, body, members, before)
    assert tell(found) == (set(reads.split()), set(escapes.split()))


FILTERS = """#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <robot/Status.h>
{include}
typedef message_filters::sync_policies::ApproximateTime<robot::Status, robot::Status> Policy;
class Watch {{
 public:
  Watch() : first_(nh_, "status", 1), second_(nh_, "other", 1), sync_(Policy(10), first_, second_) {{
    sync_.registerCallback(boost::bind(&Watch::onBoth, this, _1, _2));
  }}
  void onBoth(const robot::Status::ConstPtr& one, const robot::Status::ConstPtr& two) {{ int x = one->level; }}
  ros::NodeHandle nh_;
  message_filters::Subscriber<robot::Status> first_, second_;
  message_filters::Synchronizer<Policy> sync_;
}};
int main(int argc, char** argv) {{ ros::init(argc, argv, "watch"); Watch watch; ros::spin(); }}
"""
SYNCHRONIZED = """#!/usr/bin/env python3
import rospy
from message_filters import ApproximateTimeSynchronizer, Subscriber
from robot.msg import Status

def on_both(one, two):
    print(one.level, two.level)

rospy.init_node("watch")
both = ApproximateTimeSynchronizer([Subscriber("status", Status), Subscriber("other", Status)], 10, 0.1)
both.registerCallback(on_both)
rospy.spin()
"""
CAMERA = """#include <image_transport/image_transport.h>
void onImage(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& info) {
  int x = image->width + info->height;
}
int main(int argc, char** argv) {
  ros::init(argc, argv, "watch");
  ros::NodeHandle nh;
  image_transport::ImageTransport it(nh);
  auto sub = it.subscribeCamera("status", 1, onImage);
  ros::spin();
}
"""


@pytest.mark.parametrize(
    ("path", "code", "reads", "escapes"),
    [
        ("src/watch.cpp", FILTERS.format(include=""), {"level"}, {"header.stamp"}),
        ("src/watch.cpp", FILTERS.format(include="#include <tf2_ros/message_filter.h>"), {"level"},
         {"header.stamp", "header.frame_id"}),
        ("scripts/watch.py", SYNCHRONIZED, {"level"}, {"header.stamp"}),
        ("src/watch.cpp", CAMERA, {"width"}, {"header.stamp"}),
    ],
    ids=["a synchronizer", "one that waits for transforms", "a synchronizer in Python", "a camera"],
)  # fmt: skip
def test_filters_look_at_the_header(path, code, reads, escapes, tmp_path):
    assert tell(find_subscriber(report(tmp_path, {path: code}))) == (reads, escapes)


TWO = """#include <message_filters/synchronizer.h>
#include <robot/Status.h>
using Sync = message_filters::Synchronizer<Policy>;
class Watch {{
 public:
  Watch() {{
    one_.subscribe(nh_, "other", 1);
    two_.subscribe(nh_, "status", 1);
    sync_ = std::make_shared<Sync>(Policy(5), one_, two_);
    sync_->registerCallback({callback});
  }}
  void onBoth(const robot::Status::ConstPtr& one, const robot::Status::ConstPtr& two) {{
    int x = one->level + two->name.size();
  }}
  void onSwapped(const robot::Status::ConstPtr& two, const robot::Status::ConstPtr& one) {{ onBoth(one, two); }}
  ros::NodeHandle nh_;
  message_filters::Subscriber<robot::Status> one_, two_;
  std::shared_ptr<Sync> sync_;
}};
int main(int argc, char** argv) {{ ros::init(argc, argv, "watch"); Watch watch; ros::spin(); }}
"""


@pytest.mark.parametrize(
    ("callback", "reads"),
    [
        ("std::bind(&Watch::onBoth, this, std::placeholders::_1, std::placeholders::_2)", {"name"}),
        ("boost::bind(&Watch::onBoth, this, _1, _2)", {"name"}),
        ("&Watch::onBoth, this", {"name"}),
        ("boost::bind(&Watch::onSwapped, this, _2, _1)", {"level", "name"}),
    ],
)
def test_a_synchronizer_gives_messages_in_the_order_of_its_filters(callback, reads, tmp_path):
    found = report(tmp_path, {"src/watch.cpp": TWO.format(callback=callback)})
    assert tell(find_subscriber(found)) == (reads, {"header.stamp"})


@pytest.mark.parametrize(
    ("body", "unread"),
    [
        ("n = len(msg.points)", set()),
        ("n = len(msg.points)\nx = msg.points[0].y", {"points[].x", "points[].z"}),
        ("elsewhere(msg.points[0].y)\nn = len(msg.points)", {"points[].x", "points[].z"}),
        ("x = msg.level", {"points[].x", "points[].y", "points[].z"}),
    ],
)
def test_where_the_size_is_asked_for_elements_stay(body, unread, tmp_path):
    assert {field for field in read_python(tmp_path, body).unread if field.startswith("points")} == unread


LAUNCH = """<launch>
  <node pkg="robot" type="watch.py" name="watch"/>
  {more}
</launch>
"""


@pytest.mark.parametrize(
    ("more", "why"),
    [
        ("", ""),
        ('<node pkg="rviz" type="rviz" name="rviz"/>',
         "robot/launch/all.launch:3 starts `rviz`, whose code is not here"),
        ('<include file="$(find other)/launch/other.launch"/>',
         "robot/launch/all.launch:3 includes `$(find other)/launch/other.launch`, which is not here"),
    ],
    ids=["its own nodes", "a program of another package", "a launch file of another package"],
)  # fmt: skip
def test_what_a_launch_file_starts_of_other_packages_may_read_a_topic(more, why, tmp_path):
    code = SCRIPT.format(body="        x = msg.level", members="", before="")
    found = report(tmp_path, {"scripts/watch.py": code, "launch/all.launch": LAUNCH.format(more=more)})
    (topic,) = [one for one in found.topics if one.topic == "/status"]
    assert topic.open == ((why,) if why else ())
    assert bool(topic.unread) == (not why)


def test_subscribers_whose_topic_is_not_known_are_told_apart(tmp_path):
    code = SCRIPT.format(body="        x = msg.level", members="", before="")
    code = code.replace('rospy.Subscriber("status"', 'rospy.Subscriber(rospy.get_param("~topic")')
    found = report(tmp_path, {"scripts/watch.py": code})
    assert [one.topic for one in found.topics] == []
    (unnamed,) = found.unnamed
    assert (unnamed.topic, unnamed.type, unnamed.unread) == ("", "robot/Status", ())
    assert tell(unnamed.subscribers[0]) == ({"level"}, set())


MIRROR = """class Mirror:
    def __setattr__(self, name, value):
        print(value.pose.position.x)

class Other:
    def __setattr__(self, name, value):
        print(value.name)
"""


@pytest.mark.parametrize(("base", "reads"), [("Mirror", {"pose.position.x"}), ("object", set())])
def test_setting_an_attribute_calls_what_its_class_has_for_it(base, reads, tmp_path):
    code = SCRIPT.format(body="        self.kept = msg", members="", before=MIRROR)
    code = code.replace("class Watch:", f"class Watch({base}):")
    assert tell(find_subscriber(report(tmp_path, {"scripts/watch.py": code})))[0] == reads


def test_a_filter_that_a_pointer_is_made_of(tmp_path):
    code = """#include <message_filters/subscriber.h>
#include <robot/Status.h>
void onStatus(const robot::Status::ConstPtr& msg) { int x = msg->level; }
int main(int argc, char** argv) {
  ros::init(argc, argv, "watch");
  ros::NodeHandle nh;
  boost::shared_ptr<message_filters::Subscriber<robot::Status> > sub(
      new message_filters::Subscriber<robot::Status>(nh, "status", 1));
  sub->registerCallback(onStatus);
  ros::spin();
}
"""
    found = report(tmp_path, {"src/watch.cpp": code})
    assert tell(find_subscriber(found)) == ({"level"}, {"header.stamp"})


# What the publisher does with `msg` before it publishes it, and the lengths that this writes.
LENGTHS = {
    "a text": ('msg.name = "base";', 'msg.name = "base"', {"name": 4}),
    "a text in a part": ('msg.header.frame_id = "map";', 'msg.header.frame_id = "map"', {"header.frame_id": 3}),
    "the longest": ('msg.name = "a"; if (ok) msg.name = "abc";', 'msg.name = "abc"\nmsg.name = "a"', {"name": 3}),
    "bytes of UTF-8": ('msg.name = "\u00e4";', 'msg.name = "\u00e4"', {"name": 2}),
    "elements": ("msg.ranges.resize(720);", "msg.ranges = [0.0] * 720", {"ranges": 720}),
    "elements and a value": ("msg.ranges.assign(8u, 0.0f);", "msg.ranges = 8 * [0.0]", {"ranges": 8}),
    "a vector": ("msg.ranges = std::vector<float>(16);", "msg.ranges = [1.0, 2.0]", {"ranges": (16, 2)}),
    "a number that is not written": ("msg.ranges.resize(count);", "msg.ranges = [0.0] * count", {}),
    "added to": ('msg.name += "more";', 'msg.name += "more"', {}),
    "another message": ('other.name = "base";', 'other.name = "base"', {}),
}
TALK_CPP = """#include <ros/ros.h>
#include <robot/Status.h>
int main(int argc, char** argv) {{
  ros::init(argc, argv, "talk");
  ros::NodeHandle nh;
  ros::Publisher pub = nh.advertise<robot::Status>("status", 1);
  bool ok = argc > 1;
  int count = argc;
  robot::Status msg, other;
  {body}
  pub.publish(msg);
}}
"""
TALK_PYTHON = """#!/usr/bin/env python3
import rospy
from robot.msg import Status
rospy.init_node("talk")
pub = rospy.Publisher("status", Status, queue_size=1)
count = len(rospy.myargv())
msg = Status()
other = Status()
{body}
pub.publish(msg)
"""


@pytest.mark.parametrize("language", [0, 1])
@pytest.mark.parametrize("case", LENGTHS)
def test_lengths_that_publishers_write(tmp_path, case, language):
    *bodies, lengths = LENGTHS[case]
    name, text = (("src/watch.cpp", TALK_CPP), ("scripts/talk.py", TALK_PYTHON))[language]
    (topic,) = [one for one in report(tmp_path, {name: text.format(body=bodies[language])}).topics if one.publishers]
    (publisher,) = topic.publishers
    expected = {key: value if isinstance(value, int) else value[language] for key, value in lengths.items()}
    assert dict(publisher.lengths) == expected


def test_lengths_of_what_is_made_with_keywords(tmp_path):
    body = 'pub.publish(Status(name="base", ranges=[1.0, 2.0, 3.0], level=2))'
    (topic,) = [one for one in report(tmp_path, {"scripts/talk.py": TALK_PYTHON.format(body=body)}).topics]
    assert [dict(one.lengths) for one in topic.publishers] == [{"name": 4, "ranges": 3}, {}]
