"""The facade that harnesses share: compiled once, kept, made anew where a header or the cache was changed."""

import os

import pytest
from harness_workspaces import needs_clang, write_workspace
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import link_for_flow
from rosimpact.impact.values.harness import precompiled
from rosimpact.impact.values.harness.compile import _IR_FLAGS
from rosimpact.impact.values.harness.interfaces import KnownInterfaces
from rosimpact.impact.values.harness.precompiled import (
    Facade,
    find_includes,
    find_plain_includes,
    split_dependencies,
)
from rosimpact.impact.values.harness.toolchain import find_clang
from rosimpact.impact.values.outcomes import Reaction

NODE = """
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/u_int8.hpp>
class Node : public rclcpp::Node {
 public:
  Node() : rclcpp::Node("node") {
    pub_ = create_publisher<std_msgs::msg::UInt8>("b", 1);
    sub_ = create_subscription<std_msgs::msg::UInt8>("a", 1, [this](const std_msgs::msg::UInt8::SharedPtr msg) {
      if (msg->data > 3) pub_->publish(*msg);
    });
  }
  rclcpp::Publisher<std_msgs::msg::UInt8>::SharedPtr pub_;
  rclcpp::Subscription<std_msgs::msg::UInt8>::SharedPtr sub_;
};
int main(int argc, char **argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Node>()); }
"""


@pytest.fixture
def root(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    return write_workspace(tmp_path / "ws", 2, {"src/node.cpp": NODE}, "src/node.cpp")


def list_compiled(monkeypatch):
    """The runs of a compiler that make a facade, as they come."""
    compiled = []
    known = precompiled.run_compiler

    def run(command, folder, *more):
        compiled.append(command)
        return known(command, folder, *more)

    monkeypatch.setattr(precompiled, "run_compiler", run)
    return compiled


def explore(root):
    answer = explore_values(root, jobs=1)
    (one,) = answer.report.callbacks
    assert (one.reason, one.unknown) == ("", {})
    handled = one.fields[0].sets[Reaction.HANDLED]
    assert handled.spans == ((4, 255),)


@needs_clang
def test_a_facade_is_compiled_once_and_a_damaged_one_again(root, tmp_path, monkeypatch):
    compiled = list_compiled(monkeypatch)
    explore(root)
    explore(root)
    assert len(compiled) == 1
    (made,) = (tmp_path / "cache" / "facades").glob("*/facade.pch")
    os.truncate(made, 1000)
    explore(root)
    assert len(compiled) == 2


@needs_clang
def test_a_header_that_was_changed_since_and_a_cache_that_cannot_be_written(root, tmp_path, monkeypatch):
    compiled = list_compiled(monkeypatch)
    explore(root)
    (listed,) = (tmp_path / "cache" / "facades").glob("*/facade.txt")
    lines = listed.read_text().splitlines()
    assert len(lines) > 100
    listed.write_text("\n".join([*lines[:-1], "1 1 " + lines[-1].split(" ", 2)[2], ""]))
    explore(root)
    assert len(compiled) == 2
    monkeypatch.setenv("ROSIMPACT_CACHE", str(root / "machine" / "package.xml"))
    explore(root)
    assert len(compiled) == 2


@needs_clang
def test_only_the_facades_that_were_used_last_are_kept(root, tmp_path, monkeypatch):
    monkeypatch.setattr(precompiled, "_MOST", 2)
    with Store(None) as store:
        facade = Facade(KnownInterfaces(link_for_flow(open_tree(root, ""), store, 1)))
    flags = ["-std=gnu++17", "-w", "-fno-access-control", "-DRI_ROS=2", "-DRI_ARRAY=3", *_IR_FLAGS]
    made = [facade.find_precompiled(find_clang(), [*flags, f"-DRI_TEXT={size}"]) for size in (1, 2, 3)]
    assert None not in made
    assert [one.exists() for one in made] == [False, True, True]
    facade.forget(made[2])
    assert not made[2].exists()


def test_what_is_included_and_what_a_rule_names():
    text = '#include <a/b.h>\n  #  include "c.hpp"\n// include <d.h>\n#if 0\n#include <e>\n#endif\n'
    assert find_includes(text) == ["a/b.h", "c.hpp", "e"]
    assert split_dependencies("x.o: a.cpp \\\n  /b\\ c/d.h e.h\n") == ["a.cpp", "/b c/d.h", "e.h"]


def test_what_is_included_without_a_condition():
    text = "#ifndef A_H\n#define A_H\n#include <a>\n#ifdef B\n#include <b>\n#else\n#include <c>\n#endif\n#include <d>\n"
    assert find_plain_includes(text + "#endif\n#if B\n#include <e>\n#endif\n") == {"a", "d"}
    assert find_plain_includes("#ifndef B\n#include <b>\n#endif\n# include <c>\n") == {"c"}


@needs_clang
def test_a_facade_with_further_members_is_compiled_once(root, tmp_path, monkeypatch):
    with Store(None) as store:
        facade = Facade(KnownInterfaces(link_for_flow(open_tree(root, ""), store, 1)))
    flags = ["-std=gnu++17", "-w", "-DRI_ROS=2", "-DRI_ARRAY=3", "-DRI_TEXT=4", *_IR_FLAGS]
    compiled = []

    def run(command, folder):
        compiled.append(command)
        return precompiled.run_compiler(command, folder)

    def find(*names):
        extras = [f"#define RI_EXTRA_rclcpp_Node {' '.join(f'int {each};' for each in names)}"]
        return facade.find_extended(find_clang(), flags, extras, tmp_path / "extended", run)

    first, second = find("one"), find("one", "two")
    assert first.exists() and second.exists() and find("one") == first and len(compiled) == 2
    third = find("three")  # the two that were asked for last are kept
    assert third.exists() and first.exists() and not second.exists()
    assert find("not valid") is None and find("not valid") is None and len(compiled) == 4
    assert first.exists() and third.exists()


@needs_clang
@pytest.mark.parametrize("more", ["", " _GNU_SOURCE=2"])
def test_macros_of_a_package_are_no_reason_for_another_facade(root, monkeypatch, more):
    """One that the facade was compiled with, too, with another value, is compiled without it."""
    compiled = list_compiled(monkeypatch)
    cmake = root / "machine" / "CMakeLists.txt"
    given = f"target_compile_definitions(machine PRIVATE LIMIT=3{more})"
    cmake.write_text(cmake.read_text().replace("ament_package()", f"{given}\nament_package()"))
    node = root / "machine" / "src" / "node.cpp"
    node.write_text(node.read_text().replace("> 3", "> LIMIT"))
    explore(root)
    assert len(compiled) == 1
    assert len(list((root.parent / "cache" / "facades").glob("*/facade.pch"))) == 1
