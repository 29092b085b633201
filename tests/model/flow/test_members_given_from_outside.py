"""Members that are declared with a value, and given another by code outside of their class."""

import pytest
from joining import graph, graph_on_disk, manifest

CPP = """
    #include <ros/ros.h>
    #include <std_msgs/String.h>
    struct Settings {{ std::string out = "/declared"; bool on = false; }};
    class Part {{
     public:
      explicit Part(const Settings & settings) : settings_(settings) {{}}
      void run() {{ pub_ = nh_.advertise<std_msgs::String>(settings_.out, 1); }}
     private:
      ros::NodeHandle nh_;
      Settings settings_;
      ros::Publisher pub_;
    }};
    int main(int argc, char ** argv) {{
      ros::init(argc, argv, "a");
      Settings settings;
      {given}
      Part part(settings);
      part.run();
    }}
"""
PYTHON = """
    import rospy
    from std_msgs.msg import String
    class Settings:
        out = "/declared"
        on = False
    class Part:
        def __init__(self, settings: Settings):
            self.settings = settings
        def run(self):
            self.pub = rospy.Publisher(self.settings.out, String, queue_size=1)
    rospy.init_node("a")
    settings = Settings()
    {given}
    Part(settings).run()
"""


@pytest.mark.parametrize(("given", "sure"), [
    ("", {"/declared"}),
    ('settings.on = true;', {"/declared"}),
    ('settings.out = "/given";', {"/given"}),
])  # fmt: skip
def test_what_a_member_is_declared_with_is_sure_where_nothing_gives_another(given, sure):
    for found in (
        graph({"p/a.cpp": CPP.format(given=given)}, ros=1),
        graph({"p/a.py": PYTHON.format(given=given.rstrip(";").replace("true", "True"))}, ros=1),
    ):
        published = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
        assert {one.topic for one in published if not one.only_if} == sure
        assert {one.topic for one in published} <= {*sure, "/declared"}


@pytest.mark.parametrize(("space", "expected"), [
    ("/", {"/out", "/named/x", "/a/own"}), ("g", {"/g/out", "/g/named/x", "/g/a/own"}),
])  # fmt: skip
def test_the_namespace_of_rospy_ends_in_a_slash(tmp_path, space, expected):
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": "project(p)\ncatkin_package()\ncatkin_install_python(PROGRAMS scripts/a.py)\n",
        "p/scripts/a.py": """
            #!/usr/bin/env python3
            import rospy
            from std_msgs.msg import String
            rospy.init_node("a")
            rospy.Publisher(rospy.get_namespace() + "out", String, queue_size=1)
            rospy.Publisher(rospy.get_namespace() + "/named/x", String, queue_size=1)
            rospy.Publisher(rospy.get_name() + "/own", String, queue_size=1)
        """,
        "p/a.launch": f'<launch><group ns="{space}"><node pkg="p" type="a.py" name="a"/></group></launch>',
    }
    found = graph_on_disk(tmp_path, files, "p/a.launch")
    assert {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied} == expected
