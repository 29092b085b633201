"""A member of an object has what the program that runs writes into its own object, not what another program does."""

from joining import ends, graph, manifest

MAIN = """
    #include <ros/ros.h>
    #include "pilot.hpp"
    int main(int argc, char ** argv) {
      ros::init(argc, argv, "NAME");
      Settings settings;
      settings.name = "NAME";
      Pilot pilot(settings);
      ros::spin();
    }
"""


def test_each_program_has_the_members_that_its_own_main_writes():
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/pilot.hpp": """
            #pragma once
            #include <ros/ros.h>
            struct Settings { std::string name; };
            class Pilot {
            public:
              explicit Pilot(const Settings & settings);
              ros::NodeHandle nh_;
              ros::Publisher pub_;
              Settings settings_;
              std::string name_;
            };
        """,
        "p/pilot.cpp": """
            #include <std_msgs/Empty.h>
            #include "pilot.hpp"
            Pilot::Pilot(const Settings & settings) : settings_(settings) {
              name_ = settings_.name;
              pub_ = nh_.advertise<std_msgs::Empty>(name_ + "/state", 1);
            }
        """,
        "p/left.cpp": MAIN.replace("NAME", "left"),
        "p/right.cpp": MAIN.replace("NAME", "right"),
    }
    found = graph(files, 1)
    names = {node.id: node.name for node in found.nodes}
    assert {(names[node], topic) for node, topic, _ in ends(found, "publisher")} == {
        ("/left", "/left/state"), ("/right", "/right/state"),
    }  # fmt: skip
