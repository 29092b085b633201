"""Code before and after a change, and what is said of publishing: what only moved is no change, what is not known to
have changed is not said to have."""

from __future__ import annotations

import pytest
from rosimpact.impact.facts.cpp import flow as flow_cpp
from rosimpact.impact.facts.python import flow as flow_python
from rosimpact.impact.logic.changes import Side
from rosimpact.impact.logic.history import PackageFile, PackageState
from rosimpact.impact.logic.statements import digest_package
from rosimpact.impact.logic.states import compare_sides

Files = dict[str, str]

CPP = """
#include <ros/ros.h>
struct State { bool ready() { if (ready_) { return true; } else { return false; } } bool ready_; bool idle_; };
struct Sight { bool ready_; };
class Talker {
public:
  Talker() {
    pub_ = nh_.advertise<std_msgs::String>("out", 1);
    sub_ = nh_.subscribe("in", 1, &Talker::onInput, this);
    more_ = nh_.subscribe("more", 1, &Talker::onMore, this);
  }
  BODY
  void onMore(const std_msgs::String& msg) {}
  ros::NodeHandle nh_;
  ros::Publisher pub_;
  ros::Subscriber sub_, more_;
  State state_;
  std::vector<Item> items_;
};
int main(int argc, char** argv) {
  ros::init(argc, argv, "talker");
  Talker talker;
  ros::spin();
}
"""
ON_INPUT = "void onInput(const std_msgs::String& msg) { %s }"

PYTHON = """
import rospy
from std_msgs.msg import String

class Talker:
    def __init__(self):
        self.pub = rospy.Publisher("out", String, queue_size=1)
        self.other = make_other()
        rospy.Subscriber("in", String, self.on_input)

    def on_input(self, msg):
        self.last = msg
BODY

if __name__ == "__main__":
    rospy.init_node("talker")
    Talker()
    rospy.spin()
"""


def compare(old: Files, new: Files, names: tuple[str, str] = ("talk", "talk")) -> list[tuple[str, str]]:
    """(kind, why) of all changes between two states of a package, rewordings left out."""
    texts: dict[str, bytes] = {}
    sides: list[Side] = []
    for name, files in zip(names, (old, new), strict=True):
        listed, facts = [], {}
        for path, text in sorted(files.items()):
            extract, kind = (flow_python.extract, "python") if path.endswith(".py") else (flow_cpp.extract, "cpp")
            facts[path] = extract(text.encode())
            listed.append(PackageFile(path, str(hash(text)), kind))
            texts[str(hash(text))] = text.encode()
        state = PackageState(name, "", 1, tuple(listed), b"")
        sides.append(Side([(state, digest_package(state, facts))] if files else []))
    found = compare_sides(sides[0], sides[1], dict, lambda file: texts[file.id])
    return [(change.kind, change.why) for change in found if change.kind != "equivalent"]


def compare_cpp(old: str, new: str) -> list[tuple[str, str]]:
    return compare({"talker.cpp": CPP.replace("BODY", old)}, {"talker.cpp": CPP.replace("BODY", new)})


def compare_python(old: str, new: str) -> list[tuple[str, str]]:
    return compare({"talker.py": PYTHON.replace("BODY", old)}, {"talker.py": PYTHON.replace("BODY", new)})


def say(statements: str) -> str:
    return ON_INPUT % statements


LOOP = "for (auto& item : items_) { if (item.loud) pub_.publish(msg); }"
BRANCHES = "if (msg.data.empty()) { pub_.publish(msg); } else { pub_.publish(last_); }"

CPP_CASES = [
    # A condition that moved into an object, a getter, or out of it.
    ("a getter", say("if (state_.ready()) pub_.publish(msg);"), say("if (state_.ready_) pub_.publish(msg);"), []),
    (
        "a getter of another object is another condition",
        "State more_state_;\n" + say("if (state_.ready()) pub_.publish(msg);"),
        "State more_state_;\n" + say("if (more_state_.ready()) pub_.publish(msg);"),
        [("changed", "`more_state_.ready()` was `state_.ready()`")],
    ),
    (
        "a member of an inner object",
        say("if (state_.ready_) pub_.publish(msg);"),
        say("if (state_.sight_.ready_) pub_.publish(msg);"),
        [],
    ),
    (
        "members become those of an object",
        "bool heard_;\n" + say("heard_ = true; if (heard_) pub_.publish(msg);"),
        "Sight sight_;\n" + say("sight_.heard_ = true; if (sight_.heard_) pub_.publish(msg);"),
        [],
    ),
    (
        "what a message says is asked instead",
        "bool valid_;\n" + say("valid_ = true; if (valid_) pub_.publish(msg);"),
        "bool valid_;\n" + say("valid_ = true; if (msg.valid_) pub_.publish(msg);"),
        [("changed", "`msg.valid_` was `valid_`")],
    ),
    # Loops through the same container.
    (
        "an index for a loop through a container",
        say(LOOP),
        say("for (size_t i = 0; i < items_.size(); ++i) { if (items_[i].loud) pub_.publish(msg); }"),
        [],
    ),
    (
        "an iterator",
        say("for (auto it = items_.begin(); it != items_.end(); it++) { if (it->loud) pub_.publish(msg); }"),
        say(LOOP),
        [],
    ),
    (
        "a loop through another one",
        say(LOOP),
        say("for (size_t i = 0; i < others_.size(); ++i) { if (others_[i].loud) pub_.publish(msg); }"),
        [("changed", "")],
    ),
    (
        "another element of it",
        say("for (size_t i = 0; i < items_.size(); ++i) { if (items_[i].loud) pub_.publish(msg); }"),
        say("for (size_t i = 0; i < items_.size(); ++i) { if (items_[0].loud) pub_.publish(msg); }"),
        [("changed", "`items_[0].loud` was `items_[i].loud`")],
    ),
    (
        "whether there is anything is asked by the loop itself",
        say("if (items_.empty()) return; for (auto& item : items_) { pub_.publish(item); }"),
        say("for (auto& item : items_) { pub_.publish(item); }"),
        [],
    ),
    (
        "a loop that comes sends more and fewer",
        say("pub_.publish(msg);"),
        say("for (auto& item : items_) { pub_.publish(item); }"),
        [("changed", "only inside `for (auto& item : items_)`")],
    ),
    (
        "a loop that goes",
        say("bool done = false; while (!done) { pub_.publish(msg); done = true; }"),
        say("bool done = false; if (true) { pub_.publish(msg); done = true; }"),
        [("changed", "no longer asks for `!done`")],
    ),
    # Statements that become one, and one that becomes several.
    ("one statement behind both branches", say(BRANCHES), say("pub_.publish(msg.data.empty() ? msg : last_);"), []),
    ("one statement in each branch", say("pub_.publish(msg);"), say(BRANCHES), []),
    (
        "a helper for both branches",
        say(BRANCHES),
        "void send(const std_msgs::String& m) { pub_.publish(m); }\n"
        + say("if (msg.data.empty()) { send(msg); } else { send(last_); }"),
        [],
    ),
    (
        "one of two that were sent",
        say("pub_.publish(msg); pub_.publish(msg);"),
        say("pub_.publish(msg);"),
        [("gone", "was published on messages of `in`")],
    ),
    (
        "one branch alone",
        say(BRANCHES),
        say("if (msg.data.empty()) { pub_.publish(msg); }"),
        [("gone", "was published on messages of `in`")],
    ),
    (
        "a function of the same name with other arguments is called",
        "void send() {}\n  void send(int level) { if (able_) pub_.publish(last_); }\n" + say("if (loud_) send(1);"),
        "void send() {}\n  void send(int level) { if (able_) pub_.publish(last_); }\n"
        + say("send(); if (loud_) send(1);"),
        [],
    ),
    # A part of a function that calls itself through others.
    (
        "a helper on a way that goes round",
        "void plan() { pub_.publish(last_); if (far_) { if (long_) go(); } }\n  void go() { plan(); }\n"
        + say("plan();"),
        "void plan() { pub_.publish(last_); if (far_) halve(); }\n  void halve() { if (long_) go(); }\n"
        "  void go() { plan(); }\n" + say("plan();"),
        [],
    ),
    # Who calls a function is known on one side alone.
    (
        "a call of what something unseen may call",
        "void send() { if (able_) pub_.publish(last_); }\n" + say("last_ = msg;"),
        "void send() { if (able_) pub_.publish(last_); }\n" + say("if (loud_) send();"),
        [],
    ),
    (
        "no longer a call of it",
        "void send() { if (able_) pub_.publish(last_); }\n" + say("if (loud_) send();"),
        "void send() { if (able_) pub_.publish(last_); }\n" + say("last_ = msg;"),
        [],
    ),
    (
        "what it asks itself",
        "void send() { pub_.publish(last_); }\n" + say("last_ = msg;"),
        "void send() { if (able_) pub_.publish(last_); }\n" + say("if (loud_) send();"),
        [("tightened", "only when `able_`")],
    ),
    (
        "an unseen caller is left out, and another one comes",
        "void start() { send(); }\n  void send() { pub_.publish(last_); }\n" + say("last_ = msg;"),
        "void start() { last_.clear(); }\n  void send() { pub_.publish(last_); }\n" + say("if (loud_) send();"),
        [],
    ),
    (
        "something unseen instead of messages",
        "void send() { pub_.publish(last_); }\n" + say("if (loud_) send();"),
        "void send() { pub_.publish(last_); }\n  void onOther() { if (loud_ && able_) send(); }\n"
        + say("last_ = msg;"),
        [("changed", "only when `able_` too")],
    ),
    (
        "a call more where all are known",
        "void send() { pub_.publish(last_); }\n" + say("if (loud_) send();"),
        "void send() { pub_.publish(last_); }\n" + say("if (loud_ || quiet_) send();"),
        [("widened", "`loud_ || quiet_` was `loud_`")],
    ),
    (
        "a thread instead of messages",
        "void send() { pub_.publish(last_); }\n" + say("send();"),
        "void send() { pub_.publish(last_); }\n  void run() { while (ros::ok()) { if (fresh_) send(); } }\n"
        + say("fresh_ = true;"),
        [("trigger changed", "on loop, was on messages of `in`; only when `fresh_`")],
    ),
    # What a function gives that returns more than once, and what branches assign to a variable.
    (
        "early returns become a function",
        say("if (!ready_) return; if (level_ <= 3) return; pub_.publish(msg);"),
        'bool can() { if (!ready_) { ROS_WARN("no"); return false; } if (level_ <= 3) return false; return true; }\n'
        + say("if (can()) pub_.publish(msg);"),
        [],
    ),
    (
        "early returns become a function that asks for less",
        say("if (!ready_) return; if (level_ <= 3) return; pub_.publish(msg);"),
        "bool can() { if (!ready_) { return false; } return level_ > 2; }\n" + say("if (can()) pub_.publish(msg);"),
        [("widened", "")],
    ),
    (
        "nothing is returned instead of something",
        say("if (!ready_) return; pub_.publish(msg);"),
        "std::optional<Item> make() { if (!ready_) return std::nullopt; return Item(); }\n"
        + say("auto made = make(); if (!made) return; pub_.publish(msg);"),
        [],
    ),
    (
        "a pointer that is returned says no condition",
        say("if (ready_) pub_.publish(msg);"),
        "Item* find() { if (!ready_) return nullptr; return first_; }\n" + say("if (find()) pub_.publish(msg);"),
        [("changed", "`find()` was `ready_`")],
    ),
    (
        "a variable that branches assign",
        say("if (level_ == 1 ? ready_ : loud_) pub_.publish(msg);"),
        say("bool go;\n if (level_ == 1) { go = ready_; } else { go = loud_; }\n if (go) pub_.publish(msg);"),
        [],
    ),
    (
        "a variable that conditions take back",
        say("if (ready_ && !loud_) pub_.publish(msg);"),
        say("bool go = ready_;\n if (loud_) go = false;\n if (go) pub_.publish(msg);"),
        [],
    ),
    (
        "a variable that a loop assigns is what it is",
        say("bool go = ready_;\n for (auto& item : items_) go = item.loud;\n if (go) pub_.publish(msg);"),
        say("if (ready_) pub_.publish(msg);"),
        [("changed", "`ready_` was `go`")],
    ),
    # What is given for a parameter.
    (
        "a condition that is handed on",
        say("if (ready_) pub_.publish(msg);"),
        "void send(bool go) { if (go) pub_.publish(last_); }\n" + say("send(ready_);"),
        [],
    ),
    (
        "a parameter that is always true",
        say("pub_.publish(msg);"),
        "void send(bool go = true) { if (go) pub_.publish(last_); }\n" + say("send();"),
        [],
    ),
    (
        "a flag that goes round a condition",
        "void send() { if (ready_) pub_.publish(last_); }\n" + say("send();"),
        "void send(bool force) { if (force || ready_) pub_.publish(last_); }\n" + say("send(true);"),
        [("widened", "`force || ready_` was `ready_`")],
    ),
    (
        "two calls that give something else",
        "void send() { pub_.publish(last_); }\n" + say("if (ready_) send(); if (loud_) send();"),
        "void send(bool go) { if (go) pub_.publish(last_); }\n" + say("send(ready_); send(loud_);"),
        [],
    ),
    (
        "a call less of two that give something else",
        "void send(bool go) { if (go) pub_.publish(last_); }\n" + say("send(ready_); send(loud_);"),
        "void send(bool go) { if (go) pub_.publish(last_); }\n" + say("send(ready_);"),
        [("tightened", "")],
    ),
    (
        "a call whose argument a guard shuts out",
        "void set(int mode) { if (mode == RUN) pub_.publish(last_); }\n  enum Mode { OFF, RUN };\n"
        "  void other() { set(OFF); }\n" + say("set(RUN);"),
        "void set(int mode) { if (mode == RUN) pub_.publish(last_); }\n  enum Mode { OFF, RUN };\n"
        "  void other() { halt(); }\n" + say("set(RUN);"),
        [],
    ),
    (
        "a parameter of a callback that is called otherwise",
        say("if (msg.data.empty()) return; pub_.publish(msg);"),
        "void onInput(const std_msgs::String& in) { if (in.data.empty()) return; pub_.publish(in); }",
        [],
    ),
    # Lambdas with a name.
    (
        "a lambda that is called under a condition",
        say("if (ready_) pub_.publish(msg);"),
        say("auto send = [&]() { pub_.publish(msg); }; if (ready_) send();"),
        [],
    ),
    (
        "a condition that is a lambda",
        say("if (ready_) pub_.publish(msg);"),
        say("auto can = [this]() { return ready_; }; if (can()) pub_.publish(msg);"),
        [],
    ),
    (
        "a pause with a name",
        "void send() { pub_.publish(last_); }\n  void run() { while (ros::ok()) { send(); std::this_thread::sleep_for("
        "std::chrono::milliseconds(5)); } }\n" + say("last_ = msg;"),
        "void send() { pub_.publish(last_); }\n  void run() { while (ros::ok()) { send(); "
        "std::chrono::milliseconds pause(5); std::this_thread::sleep_for(pause); } }\n" + say("last_ = msg;"),
        [],
    ),
    # Names for numbers and objects, and other words for one thing.
    ("an object with a short name", say("if (state_.ready_) pub_.publish(msg);"),
     say("const auto& state = state_; if (state.ready_) pub_.publish(msg);"), []),
    (
        "a number with a name",
        say("if (level_ > 3) pub_.publish(msg);"),
        "static constexpr int kLevel = 3;\n" + say("if (level_ > kLevel) pub_.publish(msg);"),
        [],
    ),
    (
        "a constant that is larger now",
        "static constexpr int kLevel = 3;\n" + say("if (level_ > kLevel) pub_.publish(msg);"),
        "static constexpr int kLevel = 5;\n" + say("if (level_ > kLevel) pub_.publish(msg);"),
        [("tightened", "`level_ > 5` was `level_ > 3`")],
    ),
    (
        "a number with a name that may change",
        say("if (level_ > 3) pub_.publish(msg);"),
        "int kLevel = 3;\n" + say("if (level_ > kLevel) pub_.publish(msg);"),
        [("changed", "`level_ > kLevel` was `level_ > 3`")],
    ),
    ("a key that is looked for", say("if (known_.find(msg.data) != known_.end()) pub_.publish(msg);"),
     say("if (known_.count(msg.data)) pub_.publish(msg);"), []),
    ("an atomic", say("if (ready_) pub_.publish(msg);"), say("if (ready_.load()) pub_.publish(msg);"), []),
    ("a getter for a member", say("if (state_.idle_) pub_.publish(msg);"),
     say("if (state_.idle()) pub_.publish(msg);"), []),
    ("a constant of another class", say("if (level_ == Old::BUSY) pub_.publish(msg);"),
     say("if (level_ == New::BUSY) pub_.publish(msg);"), []),
    ("another constant of it", say("if (level_ == Old::BUSY) pub_.publish(msg);"),
     say("if (level_ == Old::IDLE) pub_.publish(msg);"), [("changed", "`level_ == Old::IDLE` was `level_ == Old")]),
    ("what one method says with other words", say('if (get("a").ok()) pub_.publish(msg);'),
     say('bool fine = get("b").ok(); if (fine) pub_.publish(msg);'), [("changed", "")]),
    (
        "what never ran",
        say("return; pub_.publish(msg);"),
        say("pub_.publish(msg);"),
        [("widened", "never ran before: it stands after return")],
    ),
    ("code that is put aside", say("pub_.publish(msg);"), say("\n#if 0\n pub_.publish(msg);\n#endif\n"),
     [("tightened", "never runs")]),
    (
        "a variable that keeps its value",
        say("pub_.publish(msg);"),
        say("static double last = -1;\n if (stamp_ - last >= 3) {\n pub_.publish(msg);\n last = stamp_; }"),
        [("tightened", "only when `stamp_ - last >= 3`")],
    ),
    (
        "what a loop counts",
        say("int count = 0;\n while (count < 1000) {\n pub_.publish(msg);\n count += 1; }"),
        say("int count = 0;\n while (count < limit_) {\n pub_.publish(msg);\n count += 1; }"),
        [("changed", "`count < limit_` was `count < 1000`")],
    ),
    (
        "a helper that is called once for each statement there was",
        say("if (ready_) { pub_.publish(a_); pub_.publish(b_); pub_.publish(c_); }"),
        "void put(const std_msgs::String& m) { pub_.publish(m); }\n"
        + say("if (ready_) { put(a_); put(b_); put(c_); }"),
        [],
    ),
    (
        "a helper that is called less often",
        say("if (ready_) { pub_.publish(a_); pub_.publish(b_); pub_.publish(c_); }"),
        "void put(const std_msgs::String& m) { pub_.publish(m); }\n" + say("if (ready_) { put(a_); put(b_); }"),
        [("gone", ""), ("gone", "")],
    ),
    (
        "a structure's members become the class's",
        say("if (arena_.x < 2 || arena_.y < 1) return; pub_.publish(msg);"),
        say("if (arena_x_ < 2 || arena_y_ < 1) return; pub_.publish(msg);"),
        [],
    ),
    (
        "a structure's members become each other's",
        say("if (arena_.x < 2 || arena_.y < 1) return; pub_.publish(msg);"),
        say("if (arena_y_ < 2 || arena_x_ < 1) return; pub_.publish(msg);"),
        [("changed", "")],
    ),
    (
        "a function that computes with its own variables",
        "bool find() { bool found = false; do { found = look(); } while (!found); return found; }\n"
        + say("if (find()) pub_.publish(msg);"),
        "bool find() { bool seen = false; do { seen = look(); } while (!seen); return seen; }\n"
        + say("if (find()) pub_.publish(msg);"),
        [],
    ),
]


@pytest.mark.parametrize(("old", "new", "said"), [case[1:] for case in CPP_CASES], ids=[case[0] for case in CPP_CASES])
def test_what_is_said_of_cpp(old: str, new: str, said: list[tuple[str, str]]) -> None:
    found = compare_cpp(old, new)
    assert [kind for kind, _ in found] == [kind for kind, _ in said], found
    for (_, why), (_, wanted) in zip(found, said, strict=True):
        assert wanted in why


EACH = "        for item in self.items:\n            if item.loud:\n                self.pub.publish(msg)"
NUMBERED = EACH.replace("for item in self.items", "for i, item in enumerate(self.items)")

PYTHON_CASES = [
    (
        "whether there is anything is asked by the loop itself",
        "        if not self.items:\n            return\n" + EACH,
        EACH,
        [],
    ),
    (
        "places in a list",
        EACH,
        "        for i in range(len(self.items)):\n            if self.items[i].loud:\n"
        "                self.pub.publish(msg)",
        [],
    ),
    (
        "places with what is there",
        EACH,
        NUMBERED,
        [],
    ),
    (
        "not the first of them",
        NUMBERED,
        NUMBERED.replace("item.loud", "i > 0"),
        [("changed", "`i > 0` was `item.loud`")],
    ),
    (
        "members become those of an object",
        "        self.heard = True\n        if self.heard:\n            self.pub.publish(msg)",
        "        self.sight.heard = True\n        if self.sight.heard:\n            self.pub.publish(msg)",
        [],
    ),
    (
        "a constructor's part becomes a method",
        "        pass\n\nclass Sender:\n    def __init__(self, pub):\n        if loaded:\n            pub.publish(1)",
        "        sender = Sender()\n        if msg.data:\n            sender.begin(self.pub)\n\nclass Sender:\n"
        "    def begin(self, pub):\n        if loaded:\n            pub.publish(1)",
        [],
    ),
    (
        "a property",
        "        if self.ready and self.level > 3:\n            self.pub.publish(msg)",
        "        if self.can:\n            self.pub.publish(msg)\n\n    @property\n    def can(self):\n"
        "        return self.ready and self.level > 3",
        [],
    ),
    (
        "early returns become a method",
        "        if not self.ready:\n            return\n        if self.level > 3:\n            self.pub.publish(msg)",
        "        if self.can():\n            self.pub.publish(msg)\n\n    def can(self):\n        if not self.ready:\n"
        "            return False\n        return self.level > 3",
        [],
    ),
    (
        "a parameter with a name",
        "        if rospy.get_param('~a'):\n            self.pub.publish(msg)",
        "        asked = rospy.get_param('~a')\n        if asked:\n            self.pub.publish(msg)",
        [],
    ),
    (
        "another parameter with a name",
        "        if self.get('a').value:\n            self.pub.publish(msg)",
        "        asked = self.get('b').value\n        if asked:\n            self.pub.publish(msg)",
        [("changed", "")],
    ),
    (
        "a condition that is handed on",
        "        if self.ready:\n            self.pub.publish(msg)",
        "        self.send(msg, go=self.ready)\n\n    def send(self, msg, go=True):\n        if go:\n"
        "            self.pub.publish(msg)",
        [],
    ),
    (
        "a lambda that is called under a condition",
        "        if self.ready:\n            self.pub.publish(msg)",
        "        send = lambda: self.pub.publish(msg)\n        if self.ready:\n            send()",
        [],
    ),
    (
        "keys of a dictionary",
        "        if msg.data in self.known.keys():\n            self.pub.publish(msg)",
        "        if self.known.has_key(msg.data):\n            self.pub.publish(msg)",
        [],
    ),
]


@pytest.mark.parametrize(
    ("old", "new", "said"), [case[1:] for case in PYTHON_CASES], ids=[case[0] for case in PYTHON_CASES]
)
def test_what_is_said_of_python(old: str, new: str, said: list[tuple[str, str]]) -> None:
    found = compare_python(old, new)
    assert [kind for kind, _ in found] == [kind for kind, _ in said], found
    for (_, why), (_, wanted) in zip(found, said, strict=True):
        assert wanted in why


RUN = """
import rospy
from std_msgs.msg import String
from wrapper import make_timer, ros_ok

pub = rospy.Publisher("out", String, queue_size=1)

def step():
    if ready:
        pub.publish("a")

def main():
    rospy.init_node("talker")
BODY

main()
"""
AT_TEN = "    rate = rospy.Rate(10)\n    while not rospy.is_shutdown():\n        step()\n        rate.sleep()"
NAMED = AT_TEN.replace("Rate(10)", "Rate(pace)").replace("not rospy.is_shutdown()", "ros_ok()")
LOOP_CASES = [
    (
        "a wrapper that asks whether the node is up, and a rate with a name",
        AT_TEN,
        "    pace = 10\n" + NAMED,
        [],
    ),
    (
        "another rate with a name",
        AT_TEN,
        "    pace = 20\n" + NAMED,
        [("trigger changed", "loop `rate 20`, was `rate 10`")],
    ),
    (
        "whether the node is up is asked once, and no loop",
        "    if ros_ok():\n        step()\n    rospy.spin()",
        "    step()\n    rospy.spin()",
        [("widened", "no longer asks for `ros_ok()`")],
    ),
    (
        "a pause in one branch beside the rate",
        AT_TEN,
        AT_TEN.replace("        step()", "        if old:\n            rospy.sleep(0.002)\n        step()"),
        [],
    ),
    (
        "a pause that every round meets",
        AT_TEN,
        AT_TEN.replace("rate.sleep()", "rospy.sleep(0.5)"),
        [("trigger changed", "loop `every 0.5`, was `rate 10`")],
    ),
    (
        "what a lambda is handed to calls it when it wants",
        AT_TEN,
        "    make_timer(0.1, lambda: step())\n    rospy.spin()",
        [],
    ),
    (
        "a loop that calls it and one that does not ask",
        "    step()\n    rospy.spin()",
        "    while ros_ok():\n        step()",
        [("trigger changed", "on loop, was on the start")],
    ),
]


@pytest.mark.parametrize(
    ("old", "new", "said"), [case[1:] for case in LOOP_CASES], ids=[case[0] for case in LOOP_CASES]
)
def test_what_is_said_of_loops(old: str, new: str, said: list[tuple[str, str]]) -> None:
    found = compare({"run.py": RUN.replace("BODY", old)}, {"run.py": RUN.replace("BODY", new)})
    assert [kind for kind, _ in found] == [kind for kind, _ in said], found
    for (_, why), (_, wanted) in zip(found, said, strict=True):
        assert wanted in why


SENDING = "        if msg.data:\n            self.pub.publish(msg)"


def test_a_file_that_cannot_be_read_any_more_loses_nothing() -> None:
    files = {"talker.py": PYTHON.replace("BODY", SENDING), "same.py": "A = 1\n"}
    broken = {
        **files,
        "talker.py": files["talker.py"].replace("        self.last = msg\n", "          self.last = msg\n"),
    }
    assert compare(files, broken) == []
    assert compare(broken, files) == []
    assert [kind for kind, _ in compare(files, {"same.py": "A = 1\n"})] == ["gone"]


def test_a_package_that_is_not_built_any_more_is_named() -> None:
    files = {"talker.py": PYTHON.replace("BODY", SENDING)}
    assert compare(files, {}) == [("gone", "was published on messages of `in`; no package `talk` is built any more")]
    assert compare({}, files) == [("new", "is published on messages of `in`; there was no package `talk`")]


SERIAL = """
class Serial:
    def __init__(self, delegate):
        self.delegate = delegate

    def read(self):
        if self.ready:
            self.delegate.publish(ARGUMENTS)
"""
DELEGATE = """
class Delegate:
    def publish(self, command, data):
        pass
"""


def test_a_method_of_the_codes_own_is_no_publisher() -> None:
    twice = {"serial.py": SERIAL.replace("ARGUMENTS", "cmd, data"), "delegate.py": DELEGATE}
    assert compare(twice, {}) == []
    alone = {"serial.py": SERIAL.replace("ARGUMENTS", "msg"), "delegate.py": DELEGATE}
    assert [kind for kind, _ in compare(alone, {})] == ["gone"]


PACED = """
#include "rclcpp/rclcpp.hpp"
constexpr auto kPause = 100ms;
class Beacon : public rclcpp::Node {
public:
  Beacon() : Node("beacon") {
    pub_ = create_publisher<std_msgs::msg::String>("out", 10);
    timer_ = create_wall_timer(PERIOD, [this]() { pub_->publish(last_); });
  }
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
  rclcpp::TimerBase::SharedPtr timer_;
};
"""


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("100ms", "std::chrono::milliseconds(100)", []),
        ("0.1s", "kPause", []),
        ("100ms", "kLonger", [("trigger changed", "timer `kLonger`, was `100ms`")]),
        ("200ms", "kPause", [("trigger changed", "timer `100ms`, was `200ms`")]),
    ],
)
def test_a_period_is_what_it_comes_to(old: str, new: str, said: list[tuple[str, str]]) -> None:
    assert compare({"b.cpp": PACED.replace("PERIOD", old)}, {"b.cpp": PACED.replace("PERIOD", new)}) == said


STATES = """
        if self.state == 1:
            msg = 1
            self.pub.publish(msg)
        elif self.state == 2:
            if self.height <= 0.05:
                msg = 2
                self.pub.publish(msg)
        elif self.state == 3:
            msg = 3
            self.pub.publish(msg)
"""


def test_statements_of_one_publisher_are_told_apart_where_their_function_changes() -> None:
    moved = "        self.step()\n\n    def other(self):\n        pass\n\n    def step(self):\n"
    moved += "        self.last = 1\n" * 9
    assert compare_python(STATES, moved + STATES) == []
    found = compare_python(STATES, moved + STATES.replace("0.05", "0.5"))
    assert found == [("widened", "`self.height <= 0.5` was `self.height <= 0.05`")]


ROUTER = {
    "talker.cpp": CPP.replace(
        "BODY", "Router router_;\n  bool plan() { return router_.table(3); }\n" + say("if (plan()) pub_.publish(msg);")
    )
}
TABLE = "struct Router { bool table(int a); int size_; };\nbool Router::table(int a) { return size_ > a; }\n"


def test_a_name_that_becomes_known_is_no_change() -> None:
    assert compare(ROUTER, {**ROUTER, "router.cpp": TABLE}) == []
    assert compare({**ROUTER, "router.cpp": TABLE}, ROUTER) == []
    larger = {**ROUTER, "talker.cpp": ROUTER["talker.cpp"].replace("table(3)", "table(5)"), "router.cpp": TABLE}
    known = {**ROUTER, "router.cpp": TABLE}
    assert compare(known, larger) == [("tightened", "`router_.size_ > 5` was `router_.size_ > 3`")]


def test_a_latch_with_a_name_is_a_latch() -> None:
    body = say("pub_.publish(msg);")
    latched = CPP.replace("BODY", body).replace('("out", 1)', '("out", 1, true)')
    named = latched.replace("Talker() {", "Talker() {\n    bool latch = true;").replace("1, true)", "1, latch)")
    assert compare({"talker.cpp": latched}, {"talker.cpp": named}) == []
    off = {"talker.cpp": named.replace("latch = true", "latch = false")}
    assert compare({"talker.cpp": latched}, off) == [("trigger changed", "durability `volatile` was `transient_local`")]


LOOKED = "x = self.look(msg)"
TRIED = "try:\n    x = self.look(msg)\nexcept %s:\n    %s"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        # What was not caught ended the callback, too.
        (LOOKED, TRIED % ("KeyError", "return"), []),
        (TRIED % ("(KeyError, TypeError)", "return"), TRIED % ("KeyError", "return"), []),
        (LOOKED, TRIED % ("KeyError", "print(1)\n    raise"), []),
        # What was not tried before, or was caught and the callback went on.
        ("pass", TRIED % ("KeyError", "return"), [("tightened", "only when `no except KeyError`")]),
        ("self.look(2)", TRIED % ("KeyError", "return"), [("tightened", "only when `no except KeyError`")]),
        (
            TRIED % ("KeyError", "x = 1"),
            TRIED % ("KeyError", "return"),
            [("tightened", "only when `no except KeyError`")],
        ),
        (TRIED % ("KeyError", "return"), TRIED % ("KeyError", "x = 1"), [("widened", "no longer asks")]),
    ],
)
def test_what_is_raised_leads_nowhere_whether_it_is_caught_or_not(
    old: str, new: str, said: list[tuple[str, str]]
) -> None:
    bodies = [
        "".join(f"        {line}\n" for line in f"{text}\nself.pub.publish(msg)".split("\n")) for text in (old, new)
    ]
    found = compare_python(*bodies)
    assert [kind for kind, _ in found] == [kind for kind, _ in said], found
    for (_, why), (_, wanted) in zip(found, said, strict=True):
        assert wanted in why


@pytest.mark.parametrize(
    ("old", "caught", "said"),
    [
        ("look(msg);", "return;", []),
        ("", "warn(); throw;", []),
        ("", "return;", [("tightened", "only when `no catch (const std::exception& e)`")]),
        (
            "try { look(msg); } catch (const std::exception& e) { warn(); }",
            "return;",
            [("tightened", "only when `no catch (const std::exception& e)`")],
        ),
    ],
)
def test_what_is_thrown_leads_nowhere_whether_it_is_caught_or_not(
    old: str, caught: str, said: list[tuple[str, str]]
) -> None:
    tried = f"try {{ look(msg); }} catch (const std::exception& e) {{ {caught} }} pub_.publish(msg);"
    assert compare_cpp(say(f"{old} pub_.publish(msg);"), say(tried)) == said


def test_a_condition_that_an_else_denies_is_said_once() -> None:
    told = "        if ASKED:\n            self.tell()\n        elif self.late > 4:\n            self.tell()\n"
    told += "    def tell(self):\n        self.pub.publish(1)\n"
    narrower = told.replace("ASKED", "self.halted and self.halted != 2")
    said = [("tightened", "`self.halted and self.halted != 2` was `self.halted`")]
    assert compare_python(told.replace("ASKED", "self.halted"), narrower) == said
    later = told.replace("ASKED", "self.halted").replace("4", "5")
    said = [("tightened", "`self.late > 5` was `self.late > 4`")]
    assert compare_python(told.replace("ASKED", "self.halted"), later) == said


def test_a_further_way_without_a_condition_keeps_what_all_ask() -> None:
    told = "    def tell(self):\n        if self.late > 4:\n            self.pub.publish(1)\n"
    looped = f"        for sample in self.monitor:\n            self.tell()\n{told}"
    asked = looped.replace("            self.tell()", "            if self.active:\n                self.tell()", 1)
    found = compare_python(looped, f"        self.tell()\n{asked}")
    assert [why for _, why in found] == ["also without `for sample in self.monitor`"]


OVERLOADS = """
void tell(std_msgs::String m) { pub_.publish(m); }
void tell(const std_msgs::Bool& m) { more_pub_.publish(m); }
ros::Publisher more_pub_;
"""


def test_of_overloads_the_one_is_called_that_takes_what_is_given() -> None:
    told = "std_msgs::String text; if (heard_) tell(text);"
    more = f"std_msgs::Bool flag; {told} if (late_) tell(flag);"
    assert compare_cpp(OVERLOADS + say(told), OVERLOADS + say(more)) == []
    other = told.replace("heard_", "seen_")
    assert [why for _, why in compare_cpp(OVERLOADS + say(more), OVERLOADS + say(more.replace(told, other)))] == [
        "`seen_` was `heard_`"
    ]


def test_a_truth_value_that_is_handed_on_is_still_what_it_was_made_with() -> None:
    plain = say("if (pub_.getNumSubscribers()) pub_.publish(msg);")
    named = say("bool seen = pub_.getNumSubscribers() > 0; Globals::draw = seen; if (seen) pub_.publish(msg);")
    assert compare_cpp(plain, named) == []
    changed = named.replace("if (seen)", "spin([&]() { seen = false; }); if (seen)")
    assert [kind for kind, _ in compare_cpp(plain, changed)] == ["changed"]


def test_time_that_has_passed_is_asked_alike_in_both_kinds_of_ros() -> None:
    one = say("if ((ros::Time::now() - last_).toSec() > 3.0) pub_.publish(msg);")
    for other in ("now()", "this->now()", "node_->now()", "get_clock()->now()"):
        assert compare_cpp(one, say(f"if (({other} - last_).seconds() > 3.0) pub_.publish(msg);")) == []
    steady = say("if ((std::chrono::steady_clock::now() - last_).seconds() > 3.0) pub_.publish(msg);")
    assert [kind for kind, _ in compare_cpp(one, steady)] == ["changed"]
    longer = say("if ((now() - last_).seconds() > 5.0) pub_.publish(msg);")
    assert [kind for kind, _ in compare_cpp(one, longer)] == ["tightened"]
    asked = "        if {} > self.last:\n            self.pub.publish(msg)"
    old, new = asked.format("rospy.Time.now()"), asked.format("self.get_clock().now()")
    assert compare_python(old, new) == []
    assert [kind for kind, _ in compare_python(old, asked.format("time.time()"))] == ["changed"]


def test_a_topic_that_is_not_known_is_no_other_one() -> None:
    body = say("pub_.publish(msg);")
    old = CPP.replace("BODY", body)
    later = "void listen(const std::string& topic) { sub_ = nh_.subscribe(topic, 1, &Talker::onInput, this); }"
    made = 'sub_ = nh_.subscribe("in", 1, &Talker::onInput, this);'
    handed = CPP.replace("BODY", f"{body} {later}").replace(made, "")
    assert compare({"talker.cpp": old}, {"talker.cpp": handed}) == []
    assert compare({"talker.cpp": handed}, {"talker.cpp": handed.replace("topic", "name")}) == []
    other = old.replace('"in"', '"other"')
    said = [("trigger changed", "messages of `other`, was `in`")]
    assert compare({"talker.cpp": old}, {"talker.cpp": other}) == said


SERVED = """
import rospy
from std_msgs.msg import String
from std_srvs.srv import Empty

class Talker:
    def __init__(self):
        self.pub = rospy.Publisher("out", String, queue_size=1)
        SERVE

    def serve(self, name, callback):
        return rospy.Service("arm/" + name, Empty, callback)

    def on_open(self, request):
        self.pub.publish("open")

    def on_close(self, request):
        if request.now:
            self.pub.publish("closed")

if __name__ == "__main__":
    rospy.init_node("talker")
    Talker()
    rospy.spin()
"""


def test_a_service_that_a_helper_makes_is_the_same_service() -> None:
    named = SERVED.replace("SERVE", "\n        ".join(
        f'rospy.Service("arm/{one}", Empty, self.on_{one})' for one in ("open", "close")
    ))  # fmt: skip
    helped = SERVED.replace("SERVE", "\n        ".join(
        f'self.serve("{one}", self.on_{one})' for one in ("open", "close")
    ))  # fmt: skip
    assert compare({"talker.py": named}, {"talker.py": helped}) == []
    other = named.replace('"arm/close"', '"arm/shut"')
    assert compare({"talker.py": named}, {"talker.py": other}) == [
        ("trigger changed", "service `arm/shut`, was `arm/close`")
    ]


def test_that_a_file_is_run_is_no_condition() -> None:
    program = RUN.replace("BODY", AT_TEN)
    guarded = program.replace("\nmain()\n", "\nif __name__ == '__main__':\n    main()\n")
    assert guarded != program
    assert compare({"run.py": guarded}, {"run.py": program}) == []
    asked = program.replace("\nmain()\n", "\nif len(sys.argv) == 2:\n    main()\n")
    assert compare({"run.py": program}, {"run.py": asked}) == [("tightened", "only when `len(sys.argv) == 2` too")]


def test_what_nothing_assigns_publishes_nothing() -> None:
    sends = "        self.speak_pub.publish(msg)"
    assert compare_python("        pass", sends) == []
    made = f"        self.speak_pub = make(msg)\n{sends}"
    assert [kind for kind, _ in compare_python("        pass", made)] == ["new"]
    other = "\n\nclass Other:\n    def __init__(self):\n        self.speak_pub = rospy.Publisher('more', String)\n"
    assert compare_python(f"        pass{other}", f"{sends}{other}") == []
    derived = PYTHON.replace("class Talker:", "class Voice:\n    pass\n\nclass Talker(Voice):")
    silent, sending = (derived.replace("BODY", body) for body in ("        pass", sends))
    assert compare({"talker.py": silent}, {"talker.py": sending}) == []
    unseen = [text.replace("(Voice)", "(other.Voice)") for text in (silent, sending)]
    assert [kind for kind, _ in compare({"talker.py": unseen[0]}, {"talker.py": unseen[1]})] == ["new"]
    given = "\n\ndef give(one):\n    one.speak_pub = make(one)\n"
    assert [kind for kind, _ in compare_python(f"        pass{given}", f"{sends}{given}")] == ["new"]
