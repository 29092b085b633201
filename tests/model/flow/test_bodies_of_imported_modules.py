"""Endpoints that the body of a module makes, in the programs that import it."""

import pytest
from joining import graph

HELPER = """
    import rospy
    from std_srvs.srv import Trigger
    ARM = rospy.ServiceProxy("/arm", Trigger)
    MORE

    def arm():
        return ARM()
"""
BETWEEN = "from .helper import arm\n"
PROGRAM = """
    import rospy
    IMPORT
    rospy.init_node("boss")
    rospy.spin()
"""


@pytest.mark.parametrize(("imported", "more", "expected"), [
    ("from lib import helper", "", {"/boss"}),
    ("from lib.helper import arm", "", {"/boss"}),
    ("import lib.helper as helper", "", {"/boss"}),
    ("from lib import between", "", {"/boss"}),
    ("from lib import helper\n    helper.arm()", "", {"/boss"}),
    ("import math", "", set()),
    # A program of its own.
    ("from lib import helper", 'rospy.init_node("helper")', set()),
    ("from lib import helper", 'if __name__ == "__main__":\n        rospy.spin()', set()),
])  # fmt: skip
def test_endpoints_of_imported_modules(imported, more, expected):
    files = {
        "p/lib/__init__.py": "", "p/lib/helper.py": HELPER.replace("MORE", more), "p/lib/between.py": BETWEEN,
        "p/boss.py": PROGRAM.replace("IMPORT", imported),
    }  # fmt: skip
    found = graph(files, ros=1)
    names = {node.id: node.name for node in found.nodes}
    assert {names[one.node] for one in found.endpoints if one.role == "client"} & {"/boss"} == expected


def test_what_a_file_gives_that_the_program_reads():
    code = """
        import rospy
        import yaml
        from std_msgs.msg import Bool
        rospy.init_node("boss")
        with open("some.yaml") as file:
            settings = yaml.safe_load(file)
        part = settings.get("part", {}) or {}
        rospy.Publisher(str(part.get("topic", "/state")), Bool)
    """
    found = graph({"p/boss.py": code}, ros=1)
    made = {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert made == {("/state", "partly"), ("", "unresolved")} or made == {("/state", "partly")}
    assert [one.what for one in found.coverage.unresolved] == ["publisher name"]
