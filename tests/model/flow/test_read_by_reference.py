"""Parameters that functions of the code read into what they are passed: what the variable held before is a default."""

import pytest
from joining import graph_on_disk, manifest

SOURCE = """
    #include <ros/ros.h>
    #include <std_msgs/Empty.h>
    #include <string>

    READER

    class Rig {
     public:
      explicit Rig(ros::NodeHandle& own) : own_(own) {
        begin(own);
        pub_ = own_.advertise<std_msgs::Empty>(name_, 1);
      }

     private:
      void begin(ros::NodeHandle& own) {
        STEPS
      }

      ros::NodeHandle own_;
      ros::Publisher pub_;
      std::string name_;
    };

    int main(int argc, char** argv) {
      ros::init(argc, argv, "rig");
      ros::NodeHandle own("~");
      Rig rig(own);
      ros::spin();
    }
"""
BY_REFERENCE = """
    template <typename T>
    bool fetch(const ros::NodeHandle& own, const std::string& key, T& value) {
      if (!own.getParam(key, value)) {
        ROS_WARN("no such parameter");
        return false;
      }
      return true;
    }
"""
WITH_DEFAULT = """
    template <typename T>
    T ask(const ros::NodeHandle& own, const std::string& key, const T& otherwise) {
      T value = otherwise;
      fetch(own, key, value);
      return value;
    }
"""
BY_POINTER = """
    bool fetch(const ros::NodeHandle& own, const std::string& key, std::string* value) {
      return own.getParam(key, *value);
    }
"""
CASES = [
    ("", 'name_ = "/usual";\n own.getParam("name", name_);'),
    ("", 'std::string name = "/usual";\n own.getParam("name", name);\n name_ = name;'),
    (BY_REFERENCE, 'name_ = "/usual";\n fetch(own, "name", name_);'),
    (BY_REFERENCE, 'std::string name = "/usual";\n fetch(own, "name", name);\n name_ = name;'),
    (BY_REFERENCE + WITH_DEFAULT, 'name_ = ask<std::string>(own, "name", "/usual");'),
    (BY_POINTER, 'name_ = "/usual";\n fetch(own, "name", &name_);'),
]
GIVEN = '<launch><node pkg="rig" type="rig" name="rig"><param name="name" value="/given"/></node></launch>'


@pytest.mark.parametrize(("reader", "steps"), CASES)
@pytest.mark.parametrize(("launch", "expected"), [(GIVEN, {("/given", "launch")}), ("", {("/usual", "default")})])
def test_what_was_there_before_is_a_default(tmp_path, reader, steps, launch, expected):
    files = {
        "rig/package.xml": manifest("rig", "catkin"),
        "rig/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.0.2)
            project(rig)
            find_package(catkin REQUIRED COMPONENTS roscpp std_msgs)
            catkin_package()
            add_executable(rig rig.cpp)
        """,
        "rig/rig.cpp": SOURCE.replace("READER", reader).replace("STEPS", steps),
    }
    if launch:
        files["rig/launch/rig.launch"] = launch
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch" if launch else "")
    assert {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied} == expected


@pytest.mark.parametrize("type_", ["const std::string&", "std::string", "const std::string*"])
def test_what_a_function_cannot_write_stays(tmp_path, type_):
    reader = f'void show(const ros::NodeHandle& own, {type_} value) {{ std::string read; own.getParam("name", read); }}'
    pointed = "&" if "*" in type_ else ""
    text = SOURCE.replace("READER", reader).replace("STEPS", f'name_ = "/usual";\n show(own, {pointed}name_);')
    files = {
        "rig/package.xml": manifest("rig", "catkin"),
        "rig/CMakeLists.txt": """
            project(rig)
            find_package(catkin REQUIRED)
            catkin_package()
            add_executable(rig rig.cpp)
        """,
        "rig/rig.cpp": text,
    }
    found = graph_on_disk(tmp_path, files)
    assert {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied} == {
        ("/usual", "literal")
    }
