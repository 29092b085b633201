"""Of several values that a variable has under conditions which nothing decides, each is there only if its own holds."""

from joining import graph, manifest

AGENT = """
    #include <ros/ros.h>
    #include <std_msgs/Empty.h>
    std::string find_controller() {
      std::string name;
      ros::master::V_TopicInfo topics;
      if (ros::master::getTopics(topics)) {
        for (int i = 0; i < topics.size(); ++i) {
          if (topics[i].name == "/position/state") {
            name = "position";
            break;
          } else if (topics[i].name == "/torque/state") {
            name = "torque";
            break;
          }
        }
        if (name == "") {
          exit(-1);
        }
      }
      return name;
    }
    int main(int argc, char ** argv) {
      ros::init(argc, argv, "agent");
      ros::NodeHandle nh;
      BODY
      ros::Publisher pub = nh.advertise<std_msgs::Empty>(name + "/command", 1);
      ros::spin();
    }
"""


def list_topics(body: str) -> dict[str, str]:
    """Topic to only_if."""
    found = graph({"p/package.xml": manifest("p", "catkin"), "p/agent.cpp": AGENT.replace("BODY", body)}, 1)
    return {e.topic: e.only_if for e in found.endpoints if e.role == "publisher" and not e.implied}


def test_a_name_that_is_chosen_when_the_program_runs():
    found = list_topics("std::string name = find_controller();")
    assert set(found) == {"/position/command", "/torque/command"}
    assert '"/position/state"' in found["/position/command"]
    assert '"/torque/state"' in found["/torque/command"]


def test_the_value_before_stays_only_if_the_condition_does_not_hold():
    body = 'std::string name = "slow"; if (is_fast()) { name = "fast"; }'
    assert list_topics(body) == {"/slow/command": "!(is_fast())", "/fast/command": "is_fast()"}


def test_both_branches_that_give_the_same_value_are_sure():
    body = 'std::string name; if (is_fast()) { name = "one"; } else { name = "one"; }'
    assert list_topics(body) == {"/one/command": ""}


def test_the_only_value_is_no_choice():
    assert list_topics('std::string name; if (is_fast()) { name = "fast"; }') == {"/fast/command": ""}


def test_where_the_name_is_used_under_the_same_condition_it_is_sure_there():
    body = """
      std::string name = "slow";
      if (is_fast()) {
        name = "fast";
        ros::Publisher more = nh.advertise<std_msgs::Empty>(name + "/more", 1);
      }
    """
    assert list_topics(body)["/fast/more"] == ""
