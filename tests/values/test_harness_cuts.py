"""Parts of sources that do not compile: what is left out, and what is said of the callbacks around it."""

import pytest
from harness_workspaces import Prepared, needs_clang, write_workspace
from rosimpact.impact.values.harness.cuts import SourceFile, locate_errors
from rosimpact.impact.values.ir.explore import explore
from rosimpact.impact.values.outcomes import Bounds, Reaction

SOURCE = """#include <vendor.h>
namespace a {
class Own : public Base {
 public:
  Own(int x) : y_(x), z_{x} { vendor::start(z_); if (x) { y_ = 2; } else { y_ = vendor::give(x); } done(); }
  int get() const { return vendor::get(y_); }
  void take(const Message & m) {
    switch (m.a) {
      case vendor::FIRST: y_ = 1; break;
      default: y_ = vendor::other(); break;
    }
    auto f = [this](int q) { vendor::hand(q); y_ = q; };
    for (int i = 0; i < vendor::count(); ++i) { y_ += i; }
    std::vector<int> v{1, vendor::two(), 3};
    say("a ; vendor::quoted() }");  // vendor::noted() {
  }
  vendor::Thing<int> t_;
};
static vendor::Kind kind{3};
}
"""


@pytest.mark.parametrize(
    "mark, least, then",
    [
        ("vendor::start", "vendor::start(z_);", " vendor::start(z_); if"),
        ("vendor::give", "y_ = vendor::give(x);", "if (x) { y_ = 2; } else"),
        ("vendor::get", "return vendor::get(y_);", " return vendor::get(y_); "),
        ("vendor::FIRST", "switch (m.a)", "\n    switch (m.a)"),
        ("vendor::other", "y_ = vendor::other();", "switch (m.a)"),
        ("vendor::hand", "vendor::hand(q);", "auto f = [this]"),
        ("vendor::count", "for (int i = 0; i < vendor::count(); ++i) { y_ += i; }", "\n    switch (m.a)"),
        ("vendor::two", "std::vector<int> v{1, vendor::two(), 3};", "\n    switch (m.a)"),
        ("vendor::Thing", "vendor::Thing<int> t_;", None),
        ("vendor::Kind", "static vendor::Kind kind{3};", None),
        ("z_{x}", ": y_(x), z_{x} ", "\n  Own(int x) : y_(x)"),
        ("vendor::quoted", 'say("a ; vendor::quoted() }");', "\n    switch (m.a)"),
    ],
)
def test_the_least_part_is_left_out_first(mark, least, then):
    at = SOURCE.index(mark)
    file = SourceFile(SOURCE)
    for expected in filter(None, (least, then)):
        assert file.cut(file.rendered.count("\n", 0, at) + 1, at - file.rendered.rfind("\n", 0, at), "why")
        (cut,) = file.cuts
        at = cut.start  # where an error of what stands there now would be
        assert SOURCE[cut.start : cut.end].startswith(expected)
        assert file.rendered.count("\n") == SOURCE.count("\n")
        said = cut.text.partition(" ::ri::Anything")[0].strip()
        assert (said in ("", '::ri::cut("why");', '::ri::cut_end("why");')) and cut.text in file.rendered


def test_what_gives_a_value_ends_the_way():
    file = SourceFile("int f() { if (g()) return vendor::one(); return 2; }\nvoid h() { vendor::two(); }")
    assert file.cut(1, 27, "one") and file.cut(2, 12, "two")
    assert file.rendered == 'int f() { ::ri::cut_end("one"); return 2; }\nvoid h() { ::ri::cut("two"); }'


@pytest.mark.parametrize(
    "statement, declared",
    [
        ("const vendor::Info info = vendor::ask();", ["info"]),
        ("std::vector<vendor::Info> all(vendor::list());", ["all"]),
        ("auto & [one, two] = vendor::pair();", ["one", "two"]),
        ("vendor::Info *at = vendor::find();", ["at"]),
        ("return vendor::ask();", []),
        ("delete vendor::held;", []),
        ("known = vendor::ask();", []),
        ("vendor::start(known);", []),
        ("known == vendor::ask();", []),
    ],
)
def test_variables_of_a_declaration_that_is_left_out_are_there(statement, declared):
    file = SourceFile(f"void f() {{ {statement} }}")
    assert file.cut(1, 12 + statement.index("vendor"), "why")
    assert [each.strip(" ;") for each in file.rendered.split("::ri::Anything ")[1:]] == [
        *declared[:-1], *(f"{each}; }}" for each in declared[-1:])
    ]  # fmt: skip


def test_an_error_of_the_preprocessor_is_no_reason_to_leave_out_what_is_around_it():
    file = SourceFile("int one;\n#if VENDOR_VERSION(1)\nusing std::string;\n#endif\nint two;\n")
    assert not file.cut(2, 5, "why") and file.rendered == file.text
    assert file.cut(3, 7, "why") and "using" not in file.rendered


def test_errors_elsewhere_are_where_they_come_from():
    output = (
        "/lib/core.hpp:9:3: error: no matching function\n"
        "/lib/core.hpp:4:1: note: in instantiation of function template specialization 'x' requested here\n"
        "/ws/a.cpp:7:5: note: in instantiation of function template specialization 'y' requested here\n"
        "/ws/a.cpp:9:1: error: no member\n"
        "/lib/core.hpp:10:3: error: lost\n"
    )
    found = locate_errors(output, lambda path: path.startswith("/ws/"))
    assert [(one.path, one.line, one.text) for one in found] == [
        ("/ws/a.cpp", 7, "no matching function"), ("/ws/a.cpp", 9, "no member"),
    ]  # fmt: skip


NODE = """
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int32.hpp>
#include <std_msgs/msg/bool.hpp>
using Message = std_msgs::msg::Int32;
class Machine : public rclcpp::Node {
 public:
  Machine() : Node("machine") {
    limit_ = wrong(3) + std::nothing::of(4);
    out_ = create_publisher<Message>("out", 10);
    numbers_ = create_subscription<Message>("numbers", 10, std::bind(&Machine::onNumber, this, std::placeholders::_1));
    switches_ = create_subscription<std_msgs::msg::Bool>("switches", 10,
      [this](std_msgs::msg::Bool::SharedPtr msg) { if (msg->data) out_->publish(Message()); });
  }
 private:
  void onNumber(const Message::SharedPtr msg) {
    if (msg->data == 1) { out_->publish(*msg); return; }
    if (msg->data == 2) { std::never::there(3); return; }  // LEFT
    if (msg->data == 10) { int got = 7 / (msg->data - 10); out_->publish(Message().set__data(got)); }  // ZERO
    if (msg->data == limit_) { RCLCPP_INFO(get_logger(), "the limit"); return; }
    if (msg->data == 11) { *place_ = 2; }
  }
  int unused() { return std::never::there(limit_); }
  rclcpp::Publisher<Message>::SharedPtr out_;
  rclcpp::SubscriptionBase::SharedPtr numbers_, switches_;
  int limit_ = 0;
  int *place_ = nullptr;
};
int main(int argc, char ** argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Machine>());
}
"""


@pytest.fixture(scope="module")
def machine(tmp_path_factory):
    root = write_workspace(tmp_path_factory.mktemp("ws"), 2, {"src/machine.cpp": NODE}, "src/machine.cpp")
    return Prepared(root, tmp_path_factory.mktemp("made"), ("subscriber",))


@needs_clang
def test_a_callback_is_explored_around_what_does_not_compile(machine):
    one = machine.by_name["onNumber"]
    assert not one.reason, one.reason
    found = explore(one.ir_texts, one.entry, Bounds(seconds=120), one.is_workspace_file)
    results = {path.result for path in found.paths}
    assert Reaction.HANDLED in results and Reaction.LOG_ONLY in results
    # What is left out in the callback is named, and what was to be set before it is not known.
    zero, left = (machine.find_line("machine/src/machine.cpp", mark) for mark in ("ZERO", "LEFT"))
    unknown = [path.reason for path in found.paths if path.result is Reaction.UNKNOWN]
    assert any(reason.startswith(f"machine/src/machine.cpp:{left} does not compile") for reason in unknown), unknown
    crashes = {path.place.line for path in found.paths if path.result is Reaction.CRASH}
    assert crashes == {zero}
    assert any("null" in reason for reason in unknown), unknown


@needs_clang
def test_what_other_callbacks_do_not_reach_is_no_hindrance(machine):
    one = next(each for each in machine.all if "lambda" in each.callback)
    found = explore(one.ir_texts, one.entry, Bounds(seconds=120), one.is_workspace_file)
    assert {path.result for path in found.paths} == {Reaction.HANDLED, Reaction.IGNORED}
