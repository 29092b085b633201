"""What a package says of publishing, state after state: what is kept of the state before changes nothing."""

import pytest
from rosimpact.impact.facts.cpp import flow as flow_cpp
from rosimpact.impact.logic.history import PackageFile, PackageState
from rosimpact.impact.logic.statements import Before, PackageStatements, digest_package

TALKER = """
#include "types.h"
ros::Publisher pub;
void onTimer(const ros::TimerEvent&) { if (ready) send(pub); }
int main(int argc, char** argv) {
  ros::init(argc, argv, "talker");
  ros::NodeHandle nh;
  pub = nh.advertise<Text>("chatter", 1);
  Driver driver;
  driver.pub_ = nh.advertise<Text>("driven", 1);
  driver.drive();
  ros::Timer timer = nh.createTimer(ros::Duration(1), onTimer);
  ros::spin();
}
"""
FILES = {
    "talker.cpp": TALKER,
    "types.h": "typedef std_msgs::String Text;\n",
    "send.cpp": "void send(ros::Publisher& out) { out.publish(text); }\n",
    "driver.h": "struct Base { ros::Publisher pub_; };\nstruct Driver : Base { void drive(); };\n",
    "driver.cpp": "void Driver::drive() { pub_.publish(text); }\n",
}
CHANGES = {
    "a helper elsewhere moves and asks for more": ("send.cpp", "{ out.pub", "\n{\n  if (loud) out.pub"),
    "a helper elsewhere is called otherwise": ("send.cpp", "void send", "void emit"),
    "a name stands for another type": ("types.h", "String", "Int32"),
    "a name stands for nothing": ("types.h", "typedef std_msgs::String Text;", ""),
    "a class has another base": ("driver.h", "Driver : Base", "Driver : Other"),
    "a class moves to another namespace": ("driver.h", "struct Driver", "namespace b { struct Driver"),
    "a method moves": ("driver.cpp", "{ pub_", "\n\n{ pub_"),
    "a file itself changes": ("talker.cpp", "if (ready)", "if (ready && able)"),
    "a file is not there": ("send.cpp", FILES["send.cpp"], None),
}


class Package:
    """The states of a package; what does not change has the same facts."""

    def __init__(self) -> None:
        self.known = {}

    def digest(self, files: dict[str, str], before: Before | None = None) -> PackageStatements:
        listed = tuple(PackageFile(path, str(hash(text)), "cpp") for path, text in sorted(files.items()))
        for path, text in files.items():
            self.known.setdefault((path, text), flow_cpp.extract(text.encode()))
        facts = {path: self.known[path, text] for path, text in files.items()}
        return digest_package(PackageState("talk", "", 1, listed, b""), facts, before)


@pytest.mark.parametrize("change", CHANGES)
def test_what_is_kept_of_the_state_before_changes_nothing(change: str) -> None:
    path, old, new = CHANGES[change]
    after = {name: text for name, text in FILES.items() if name != path or new is not None}
    if new is not None:
        after[path] = FILES[path].replace(old, new)
    package, before = Package(), Before()
    said = [package.digest(files) for files in (FILES, after)]
    assert said[0] != said[1]
    for files, expected in ((FILES, said[0]), (after, said[1]), (FILES, said[0])):
        assert package.digest(files, before) == expected
