"""Types of interfaces of the workspace's packages, however these are called and used; and what is no framework's."""

import pytest
from joining import ends, graph
from rosimpact.impact.model.flow.defined import DefinedInterfaces

OWN = DefinedInterfaces({"DOCK": {"order", "State"}, "pier": {"Load", "Crane"}}, 1)
NODE = """
    HEAD
    using namespace pier;
    using namespace other;
    class Dock {
     public:
      Dock() { HERE }
      bool lift(Crane::Request& asked, Crane::Response& given) { return true; }
      void heard(const Load::ConstPtr& load) {}
      ros::NodeHandle n_;
    };
    int main(int c, char** v) {
      ros::init(c, v, "dock");
      Dock dock;
    }
"""


@pytest.mark.parametrize(
    ("written", "role", "expected"),
    [
        ('n_.advertise<DOCK::order>("x", 1);', "publisher", "DOCK/order"),
        ('n_.advertise<DOCK::State>("x", 1);', "publisher", "DOCK/State"),
        ('n_.advertise<Load>("x", 1);', "publisher", "pier/Load"),
        ('n_.subscribe("x", 1, &Dock::heard, this);', "subscriber", "pier/Load"),
        ('n_.advertiseService("x", &Dock::lift, this);', "server", "pier/Crane"),
        ('n_.advertise<Unknown>("x", 1);', "publisher", ""),
        ('n_.advertise<DOCK::other>("x", 1);', "publisher", ""),
    ],
)
def test_types(written, role, expected):
    found = graph({"p/dock.cpp": NODE.replace("HERE", written).replace("HEAD", "")}, 1, defined=OWN)
    assert {one for one in ends(found, role) if one[1] == "/x"} == {("p/dock", "/x", expected)}


@pytest.mark.parametrize(
    ("head", "written", "expected"),
    [
        ("", 'Server server(n_, "x", false);', {"/x"}),
        ("", "Server* server;", set()),
        ("", "Server* server = nullptr;", set()),
        ("", 'Server* server = new Server(n_, "x", false);', {"/x"}),
        ("", 'SimpleActionServer<pier::LiftAction> own(n_, "x", false);', {"/x"}),
        # A class of the code in no namespace that derives from nothing is none of the framework's.
        ("class SimpleActionServer { public: SimpleActionServer(ros::NodeHandle&, const char*, bool); };",
         'SimpleActionServer own(n_, "x", false);', set()),
        ("class SimpleActionServer : public actionlib::SimpleActionServer<pier::LiftAction> {"
         " public: using actionlib::SimpleActionServer<pier::LiftAction>::SimpleActionServer; };",
         'SimpleActionServer own(n_, "x", false);', {"/x"}),
    ],
)  # fmt: skip
def test_objects(head, written, expected):
    head += "\ntypedef actionlib::SimpleActionServer<pier::LiftAction> Server;"
    found = graph({"p/dock.cpp": NODE.replace("HERE", written).replace("HEAD", head)}, 1, defined=OWN)
    assert {name for _, name, _ in ends(found, "action server")} == expected
    assert not [one for one in found.coverage.unresolved if one.what == "action server name"]
