"""Calls whose names parameters without a default give: they are resolved where launch files give these."""

import pytest
from joining import graph_on_disk, manifest

NODE = """
    #include <ros/ros.h>
    int main(int c, char** v) {
      ros::init(c, v, "talker");
      ros::NodeHandle n;
      std::string name;
      n.getParam("topic", name);
      ros::Publisher pub = n.advertise<std_msgs::Empty>(name, 1);
      pub.publish(std_msgs::Empty());
    }
"""
START = '<node pkg="pier" type="talker" name="{}"/>'
GIVEN = f'<launch><param name="topic" value="/out"/>{START.format("talker")}</launch>'
ALONE = f"<launch>{START.format('talker')}</launch>"
OTHER = f"<launch>{START.format('other')}</launch>"
PARTLY = f'<launch><arg name="x"/><param name="topic" value="/$(arg x)/out"/>{START.format("talker")}</launch>'


@pytest.mark.parametrize(
    ("launches", "names", "resolved"),
    [
        ([], {("pier/talker", "")}, 0),
        ([ALONE], {("/talker", "")}, 0),
        ([GIVEN], {("/talker", "/out")}, 2),
        # A start that does not give it makes nothing under another name.
        ([GIVEN, ALONE], {("/talker", "/out")}, 2),
        # Of another node it is not known.
        ([GIVEN, OTHER], {("/talker", "/out"), ("/other", "")}, 0),
        ([PARTLY], {("/talker", "/<x>/out")}, 0),
    ],
)
def test_names_that_launch_files_give(tmp_path, launches, names, resolved):
    files = {
        "pier/package.xml": manifest("pier", "catkin"),
        "pier/CMakeLists.txt": "project(pier)\ncatkin_package()\nadd_executable(talker talker.cpp)\n",
        "pier/talker.cpp": NODE,
        **{f"pier/launch/{place}.launch": text for place, text in enumerate(launches)},
    }
    found = graph_on_disk(tmp_path, files)
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {(one.node, one.topic) for one in made} == names
    assert (found.coverage.calls, found.coverage.resolved) == (2, resolved)
    assert len([one for one in found.coverage.unresolved if one.what in ("publish", "publisher name")]) == 2 - resolved
