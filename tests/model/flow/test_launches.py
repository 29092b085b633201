"""What the launch files of a workspace start, from one process and from several."""

import os

import pytest
from joining import graph_on_disk, manifest, write
from rosimpact.edges import processes
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow import launches as module
from rosimpact.impact.model.flow.workspace import get_flow, link_for_flow
from rosimpact.impact.report.graph import list_unknown_names

EYE = """
    #include <rclcpp/rclcpp.hpp>
    class Eye : public rclcpp::Node {
     public:
      Eye() : Node("eye") { pub_ = create_publisher<sensor_msgs::msg::Image>("image", 1); }
      rclcpp::Publisher<sensor_msgs::msg::Image>::SharedPtr pub_;
    };
    int main(int argc, char** argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Eye>()); }
"""
FILES = {
    "eyes/package.xml": manifest("eyes", "ament_cmake"),
    "eyes/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.16)
        project(eyes)
        find_package(ament_cmake REQUIRED)
        find_package(rclcpp REQUIRED)
        add_executable(eye src/eye.cpp)
        ament_package()
    """,
    "eyes/src/eye.cpp": EYE,
    "eyes/launch/all.launch.xml": """
        <launch><include file="$(find-pkg-share eyes)/launch/eye0.launch.xml"/></launch>
    """,
    "eyes/launch/nothing.launch.xml": "<launch/>",
    **{
        f"eyes/launch/eye{number}.launch.xml": f"""
            <launch>
              <node pkg="eyes" exec="eye" name="eye{number}"><remap from="image" to="image{number}"/></node>
              <node pkg="elsewhere" exec="ear"/>
            </launch>
        """
        for number in range(9)
    },
}


# What an include is given, and what is said of it; empty for one that is followed.
INCLUDES = [
    ("$(find-pkg-share eyes)/launch/eye0.launch.xml", ""),
    ("$(dirname)/eye0.launch.xml", ""),
    ("$(find-pkg-share elsewhere)/launch/ear.launch.py", "of another package"),
    ("$(find-pkg-share eyes)/launch/absent.launch.xml", "`eyes` has no such file"),
    ("$(find-pkg-share eyes)/package.txt", "`eyes/package.txt` is no launch file that can be read"),
    ("$(find-pkg-share eyes)/launch/$(var side).launch.xml", "argument `side` has no value"),
    ("$(env WHERE)/eye0.launch.xml", "the environment variable `WHERE` is not known"),
    ("/opt/eyes/eye0.launch.xml", "it is not in the share folder of a package"),
    ("", "its path is not known"),
]


@pytest.mark.parametrize("written, expected", INCLUDES)
def test_an_include_that_is_not_followed_is_told(tmp_path, written, expected):
    top = f'<launch><include file="{written}"/></launch>'
    files = {**FILES, "eyes/launch/all.launch.xml": top, "eyes/package.txt": "no launch file"}
    foreign = expected == "of another package"
    for launch in ("", "eyes/launch/all.launch.xml"):
        found = graph_on_disk(tmp_path, files, launch)
        rows = [one for one in found.coverage.unresolved if one.what.startswith("included launch file")]
        # The whole system leaves out what other packages are started by, as it does the programs of these.
        said = bool(expected) and not (foreign and not launch)
        assert [(one.path, one.line) for one in rows] == [("eyes/launch/all.launch.xml", 1)] * said
        assert all(expected in f"{one.what}: {one.reason}" for one in rows)
        assert not list_unknown_names(found)


@pytest.fixture
def workspace(tmp_path):
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        yield link_for_flow(open_tree(tmp_path / "ws", ""), store)


@pytest.mark.skipif(not processes.may_fork(), reason="processes are forked here only on Linux")
@pytest.mark.parametrize("dying", ["", "_follow", "_start"])
def test_several_processes_tell_the_same_as_one(workspace, monkeypatch, dying):
    """dying: what ends every process but this one."""
    here = os.getpid()
    if dying:
        done = getattr(module, dying)
        monkeypatch.setattr(module, dying, lambda *given: done(*given) if os.getpid() == here else os._exit(1))
    alone, several = (
        tuple(module._find_launches(workspace, lambda: get_flow(workspace).code, jobs)) for jobs in (1, 2)
    )
    assert several == alone
    assert [(each.path.rpartition("/")[2], [start.names for start in each.starts]) for each in alone] == [
        ("all.launch.xml", [("/image",)]),
        *((f"eye{number}.launch.xml", [("/image",)]) for number in range(1, 9)),
    ]
    assert [node.renamed[0].written for node in alone[1].starts] == ["image"]
    assert all(each.missing for each in alone)
