"""A member of an object that a call gives is the one that the class of that object has."""

import pytest
from joining import graph, manifest

SETTINGS = """
    #pragma once
    #include <memory>
    #include <ros/ros.h>
    class Settings {
     public:
      static Settings & instance() { static Settings one; return one; }
      static Settings * find() { return &instance(); }
      std::shared_ptr<ros::NodeHandle> handle_;
      std::string topic_;
     private:
      Settings() : topic_("shared") { handle_ = std::make_shared<ros::NodeHandle>("inner"); }
    };
    inline Settings & settings() { return Settings::instance(); }
    class Holder {
     public:
      Settings & choose() { return Settings::instance(); }
    };
"""
TALKER = """
    #include <std_msgs/Empty.h>
    #include "p/settings.h"
    class Talker {
     public:
      Talker() { pub_ = MADE; }
     private:
      Holder holder_;
      ros::Publisher pub_;
    };
    int main(int argc, char ** argv) {
      ros::init(argc, argv, "talker");
      Talker talker;
      ros::spin();
    }
"""


def list_topics(made: str, header: str = SETTINGS) -> list[str | None]:
    """The topics that a publisher gets; None for a name that is not known."""
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/include/p/settings.h": header,
        "p/src/talker.cpp": TALKER.replace("MADE", made),
    }
    return [e.topic for e in graph(files, 1).endpoints if e.role == "publisher" and not e.implied]


@pytest.mark.parametrize(
    "given",
    ("Settings::instance().", "Settings::find()->", "settings().", "holder_.choose().", "this->holder_.choose()."),
)
def test_the_handle_of_an_object_that_a_call_gives_has_its_own_namespace(given: str):
    assert list_topics(f'{given}handle_->advertise<std_msgs::Empty>("said", 1)') == ["/inner/said"]


def test_a_text_of_an_object_that_a_call_gives_is_known():
    made = "Settings::instance().handle_->advertise<std_msgs::Empty>(Settings::instance().topic_, 1)"
    assert list_topics(made) == ["/inner/shared"]


def test_the_handle_of_an_object_that_nothing_tells_of_is_in_no_known_namespace():
    header = "#include <ros/ros.h>\n#include <outside/settings.h>\nclass Holder {};\n"
    found = list_topics('outside::Settings::instance().handle_->advertise<std_msgs::Empty>("said", 1)', header)
    assert "/said" not in found
