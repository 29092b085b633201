"""Names of topics and nodes, by the rules of both generations of ROS."""

import pytest
from rosimpact.impact.model.flow.names import (
    NameRefused,
    RemappingRule,
    get_namespace,
    join_name,
    normalise,
    parse_ros2_rule,
    remap_ros1_name,
    remap_ros2_name,
    resolve_ros1_name,
    resolve_ros2_name,
)


# The table of http://wiki.ros.org/Names
@pytest.mark.parametrize(
    ("node", "name", "expected"),
    [
        ("/node1", "bar", "/bar"),
        ("/wg/node2", "bar", "/wg/bar"),
        ("/wg/node3", "foo/bar", "/wg/foo/bar"),
        ("/node1", "/bar", "/bar"),
        ("/wg/node2", "/bar", "/bar"),
        ("/wg/node3", "/foo/bar", "/foo/bar"),
        ("/node1", "~bar", "/node1/bar"),
        ("/wg/node2", "~bar", "/wg/node2/bar"),
        ("/wg/node3", "~foo/bar", "/wg/node3/foo/bar"),
        ("/wg/node3", "~/bar", "/wg/node3/bar"),
        ("/wg/node3", "", "/wg"),
        ("/node1", "//a//b/", "/a/b"),
    ],
)
def test_names_of_ros1(node, name, expected):
    assert resolve_ros1_name(name, node) == expected


@pytest.mark.parametrize(
    ("name", "remaps", "expected"),
    [
        ("scan", [("scan", "base_scan")], "/r/base_scan"),
        ("scan", [("scan", "/base_scan")], "/base_scan"),
        ("scan", [("/scan", "/base_scan")], "/r/scan"),
        ("scan", [("/r/scan", "x")], "/r/x"),
        ("/r/scan", [("scan", "x")], "/r/x"),
        ("~out", [("~out", "cloud")], "/r/cloud"),
        ("out", [("out", "~cloud")], "/r/n/cloud"),
        ("a", [("a", "b"), ("b", "c")], "/r/b"),
        ("a", [("a", "b"), ("a", "c")], "/r/c"),
        ("n/out", [("~out", "x")], "/r/x"),
    ],
)
def test_remapping_of_ros1(name, remaps, expected):
    assert remap_ros1_name(name, "/r/n", remaps) == expected


# The table of https://design.ros2.org/articles/topic_and_service_names.html
@pytest.mark.parametrize(
    ("name", "namespace", "node", "expected"),
    [
        ("foo", "/", "my_node", "/foo"),
        ("foo", "/my_ns", "my_node", "/my_ns/foo"),
        ("foo/bar", "/my_ns", "my_node", "/my_ns/foo/bar"),
        ("/foo", "/my_ns", "my_node", "/foo"),
        ("~", "/", "my_node", "/my_node"),
        ("~", "/my_ns", "my_node", "/my_ns/my_node"),
        ("~/foo", "/my_ns", "my_node", "/my_ns/my_node/foo"),
        ("{node}/foo", "/my_ns", "my_node", "/my_ns/my_node/foo"),
        ("/x/{node}", "/my_ns", "my_node", "/x/my_node"),
        ("{ns}/foo", "/my_ns", "my_node", "/my_ns/foo"),
        ("{namespace}/foo", "/", "my_node", "/foo"),
    ],
)
def test_names_of_ros2(name, namespace, node, expected):
    assert resolve_ros2_name(name, node, namespace) == expected


@pytest.mark.parametrize("name", ["", "~foo", "foo/", "a//b", "1a", "a b", "{who}/a", "a-b", "a/~"])
def test_names_that_ros2_refuses(name):
    with pytest.raises(NameRefused):
        resolve_ros2_name(name, "n", "/")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("scan:=/lidar/scan", RemappingRule("scan", "/lidar/scan")),
        ("talker:chatter:=news", RemappingRule("chatter", "news", "talker")),
        ("talker:__ns:=/a", RemappingRule("__ns", "/a", "talker")),
        ("rostopic://a:=b", RemappingRule("a", "b", "", "topic")),
        ("n:rosservice:///a:=b", RemappingRule("/a", "b", "n", "service")),
        ("~/a:=b", RemappingRule("~/a", "b")),
        ("a", None),
        (":=b", None),
        ("a:=", None),
    ],
)
def test_rules_of_ros2(text, expected):
    assert parse_ros2_rule(text) == expected


@pytest.mark.parametrize(
    ("name", "rules", "kind", "expected"),
    [
        ("scan", ["scan:=front"], "topic", "/r/front"),
        ("scan", ["scan:=/front"], "topic", "/front"),
        ("scan", ["/scan:=/front"], "topic", "/r/scan"),
        ("scan", ["/r/scan:=/front"], "topic", "/front"),
        ("~/out", ["~/out:=~/in"], "topic", "/r/n/in"),
        ("a", ["a:=b", "b:=c"], "topic", "/r/b"),
        ("a", ["a:=b", "a:=c"], "topic", "/r/b"),
        ("a", ["other:a:=b", "n:a:=c"], "topic", "/r/c"),
        ("a", ["rosservice://a:=b"], "topic", "/r/a"),
        ("a", ["rosservice://a:=b"], "service", "/r/b"),
        ("a", ["__ns:=/x", "__node:=m"], "topic", "/r/a"),
        ("a", ["a b:=c", "~a:=c"], "topic", "/r/a"),
        ("/tf", ["/tf:=tf"], "topic", "/r/tf"),
    ],
)
def test_remapping_of_ros2(name, rules, kind, expected):
    parsed = [rule for rule in map(parse_ros2_rule, rules) if rule is not None]
    assert remap_ros2_name(name, "n", "/r", parsed, kind) == expected




def test_small_ones():
    assert [normalise(n) for n in ("", "/", "//", "a//b/", "/a/")] == ["", "/", "/", "a/b", "/a"]
    assert [get_namespace(n) for n in ("/a/b", "/a", "/")] == ["/a", "/", "/"]
    assert join_name("/a", "b") == "/a/b"
    assert join_name("/a", "/b") == "/b"
    assert join_name("/", "b") == "/b"
    assert join_name("/a", "") == "/a"
