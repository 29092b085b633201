"""Hashes of messages: those that public tools give for definitions that everybody knows."""

import pytest
from rosimpact.databuild.surface.hashes import compute_hash
from rosimpact.impact.facts.interface import extract

ROS1 = {
    "std_msgs/msg/String": "string data",
    "std_msgs/msg/Header": "uint32 seq\ntime stamp  # when\nstring frame_id",
    "geometry_msgs/msg/Point": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/msg/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w",
    "geometry_msgs/msg/Pose": "Point position\nQuaternion orientation",
    "geometry_msgs/msg/PoseStamped": "Header header\ngeometry_msgs/Pose pose",
    "std_srvs/srv/Empty": "---",
    "std_srvs/srv/SetBool": "bool data # e.g. for hardware\n---\nbool success\nstring message",
    "diagnostic_msgs/msg/KeyValue": "string key\nstring value",
    "diagnostic_msgs/msg/DiagnosticStatus": "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n\nbyte level\n"
    "string name\nstring message\nstring hardware_id\nKeyValue[] values",
    "arm_msgs/msg/Broken": "leg_msgs/Foot foot",
    "arm_msgs/msg/Loop": "Loop inner",
    "arm_msgs/action/Grip": "---\n---",
}
ROS2 = {
    "builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec",
    "std_msgs/msg/Header": "builtin_interfaces/Time stamp\nstring frame_id",
    "std_msgs/msg/Char": "char data",
    "std_msgs/msg/Empty": "",
    "sensor_msgs/msg/JointState": "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
    "float64[] effort",
    "rcl_interfaces/msg/FloatingPointRange": "float64 from_value\nfloat64 to_value\nfloat64 step",
    "rcl_interfaces/msg/IntegerRange": "int64 from_value\nint64 to_value\nuint64 step",
    "rcl_interfaces/msg/ParameterDescriptor": "string name\nuint8 type\nstring description\n"
    "string additional_constraints\nbool read_only false\nbool dynamic_typing false\n"
    "FloatingPointRange[<=1] floating_point_range\nIntegerRange[<=1] integer_range",
    "shape_msgs/msg/Plane": "float64[4] coef",
    "arm_msgs/msg/Broken": "leg_msgs/Foot foot",
    "arm_msgs/srv/Grip": "---",
}
# From the message files of ROS 1 and of Jazzy; rosbags 0.11 gives the same, but for `char`.
HASHES = [
    (1, "std_msgs/msg/String", "992ce8a1687cec8c8bd883ec73ca41d1"),
    (1, "std_msgs/msg/Header", "2176decaecbce78abc3b96ef049fabed"),
    (1, "geometry_msgs/msg/Pose", "e45d45a5a1ce597b249e23fb30fc871f"),
    (1, "geometry_msgs/msg/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5"),
    (1, "std_srvs/srv/Empty", "d41d8cd98f00b204e9800998ecf8427e"),
    (1, "std_srvs/srv/SetBool", "09fb03525b03e7ea1fd3992bafd87e16"),
    (1, "diagnostic_msgs/msg/DiagnosticStatus", "d0ce08bc6e5ba34c7754f563a9cabaf1"),
    (2, "std_msgs/msg/Header", "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01"),
    (2, "std_msgs/msg/Char", "RIHS01_3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9"),
    (2, "std_msgs/msg/Empty", "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312"),
    (2, "sensor_msgs/msg/JointState", "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"),
    (2, "shape_msgs/msg/Plane", "RIHS01_dfbfe8314689c850615d4a727af017e9aa86c10e369a606c8c851ef8f16c58c8"),
    (2, "rcl_interfaces/msg/ParameterDescriptor",
     "RIHS01_52175dbfda6c51153101d33d2a9da05743f66f02d5ab2ca9ec4709b46b73d704"),
    # What is not known, contains itself, or is several messages, has none.
    *((1, f"arm_msgs/{name}", None) for name in ("msg/Broken", "msg/Loop", "action/Grip")),
    *((2, f"arm_msgs/{name}", None) for name in ("msg/Broken", "srv/Grip")),
]  # fmt: skip


@pytest.mark.parametrize(("ros", "name", "expected"), HASHES)
def test_hashes_of_interfaces(ros, name, expected):
    texts = ROS1 if ros == 1 else ROS2
    known = {one: extract(text.encode(), one.split("/")[1]) for one, text in texts.items()}
    assert compute_hash(name, ros, known[name], lambda one: known.get(one.replace("/", "/msg/"))) == expected


def test_a_bound_that_is_no_number_has_no_hash():
    idl = b"module arm { module msg { const long MOST = 5; struct A { sequence<long, MOST> a; }; }; };"
    assert compute_hash("arm/msg/A", 2, extract(idl, "idl"), lambda one: None) is None
