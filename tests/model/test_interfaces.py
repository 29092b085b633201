"""Message hashes against published ones, and against rosbags' own reading of the same text."""

import pytest
from rosimpact.impact.facts.interface import extract
from rosimpact.impact.model.interfaces import UnknownInterface, ros1_md5, ros2_hash

ADD = "int64 a\nint64 b\n---\nint64 sum\n"
HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"
VECTOR = "float64 x\nfloat64 y\nfloat64 z\n"

# As roscore, `rosmsg md5` and the generated headers of noetic give them.
MD5 = [
    ("std_msgs/String", {"std_msgs/String": "string data"}, "992ce8a1687cec8c8bd883ec73ca41d1"),
    ("std_msgs/msg/String", {"std_msgs/String": "string data # text\n"}, "992ce8a1687cec8c8bd883ec73ca41d1"),
    ("std_msgs/Empty", {"std_msgs/Empty": ""}, "d41d8cd98f00b204e9800998ecf8427e"),
    ("std_msgs/Header", {"std_msgs/Header": HEADER}, "2176decaecbce78abc3b96ef049fabed"),
    ("std_msgs/Header", {}, "2176decaecbce78abc3b96ef049fabed"),
    ("geometry_msgs/Twist", {"geometry_msgs/Twist": "Vector3 linear\nVector3 angular", "geometry_msgs/Vector3": VECTOR},
     "9f195f881246fdfa2798d1d3eebca84a"),
    ("geometry_msgs/PointStamped", {"geometry_msgs/PointStamped": "Header header\nPoint point"},
     "c63aecb41bfdfd6b7e1fac37c7cbe7bf"),
    ("rospy_tutorials/AddTwoInts", {"rospy_tutorials/AddTwoInts": ADD}, "6a2e34150c00229791cc89ff309fff21"),
    ("std_srvs/Empty", {"std_srvs/Empty": "---\n"}, "d41d8cd98f00b204e9800998ecf8427e"),
    ("std_srvs/Trigger", {"std_srvs/srv/Trigger": "---\nbool success\nstring message"},
     "937c9679a518e3a18d831e57125ea522"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "definitions", "expected"), MD5)
def test_published_md5(name, definitions, expected):
    assert ros1_md5(name, definitions) == expected


# As the documentation of rmw_zenoh gives them.
HASHES = [
    ("std_msgs/msg/String", {"std_msgs/msg/String": "string data"},
     "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
    ("std_msgs/String", {"std_msgs/String": "# text\nstring data\n"},
     "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
    ("example_interfaces/srv/AddTwoInts", {"example_interfaces/srv/AddTwoInts": ADD},
     "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"),
    ("example_interfaces/AddTwoInts", {"example_interfaces/AddTwoInts": ADD},
     "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "definitions", "expected"), HASHES)
def test_published_type_hash(name, definitions, expected):
    assert ros2_hash(name, definitions) == expected
    facts = {n: extract(t.encode(), "srv" if "---" in t else "msg") for n, t in definitions.items()}
    assert ros2_hash(name, facts) == expected


TEXTS = [
    "int32 X=1\nint32 x\nstring[] s\nfloat32[3] f\nstring<=5[<=2] b\n",
    "geometry_msgs/Point p\ngeometry_msgs/Pose[] q\nstd_msgs/Header header\n",
    "builtin_interfaces/Time t\nbuiltin_interfaces/Duration[2] d\nbool ok true\n",
    "",
]


@pytest.mark.parametrize("text", TEXTS)
def test_type_hash_agrees_with_rosbags_own_parser(text):
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.LATEST)
    store.register(get_types_from_msg(text, "own/msg/Thing"))
    assert ros2_hash("own/msg/Thing", {"own/msg/Thing": text}) == store.hash_rihs01("own/msg/Thing")


CHANGES = [
    ("int32 x", "int64 x", True),
    ("int32 x", "int32 y", True),
    ("int32 x\nint32 y", "int32 y\nint32 x", True),
    ("int32[] x", "int32[<=4] x", True),
    ("int32 x", "int32 x 5", False),
    ("int32 x", "# said\nint32 x # more", False),
    ("int32 x", "int32 A=1\nint32 x", False),
]


@pytest.mark.parametrize(("before", "after", "differs"), CHANGES)
def test_type_hash_changes_with_the_wire_alone(before, after, differs):
    first, second = (ros2_hash("a/msg/B", {"a/msg/B": text}) for text in (before, after))
    assert (first != second) == differs


def test_constants_count_in_an_md5_as_written():
    assert ros1_md5("a/B", {"a/B": "uint8 A=0x01"}) != ros1_md5("a/B", {"a/B": "uint8 A=1"})


@pytest.mark.parametrize(("part", "changed"), [(0, "int8 goal"), (1, "int8 result"), (2, "int8 feedback")])
def test_every_part_of_an_action_counts(part, changed):
    parts = ["int32 order", "int32[] sequence", "int32[] partial"]
    before = ros2_hash("a/action/F", {"a/action/F": "\n---\n".join(parts)})
    parts[part] = changed
    assert ros2_hash("a/action/F", {"a/action/F": "\n---\n".join(parts)}) != before
    assert before.startswith("RIHS01_")


def test_names_that_look_like_parts_are_found_whole():
    given = {"a/srv/Set_Request": ADD, "a/srv/Set_Goal": ADD}
    assert ros2_hash("a/srv/Set_Request", given).startswith("RIHS01_")


UNKNOWN = [
    ("a/msg/B", {}, "a/msg/B"),
    ("a/msg/B", {"a/msg/B": "gone_msgs/Gone x"}, "gone_msgs/msg/Gone"),
    ("a/msg/B", {"a/msg/B": "B again"}, "a/msg/B"),
    ("a/msg/B", {"a/msg/B": "C c", "a/msg/C": "B[] b"}, "a/msg/B"),
    ("a/srv/S", {}, "a/srv/S"),
]


@pytest.mark.parametrize("hash_of", [ros1_md5, ros2_hash])
@pytest.mark.parametrize(("name", "definitions", "unknown"), UNKNOWN)
def test_what_is_unknown_is_named(hash_of, name, definitions, unknown):
    with pytest.raises(UnknownInterface) as raised:
        hash_of(name, definitions)
    assert raised.value.name == unknown


def test_an_action_has_no_md5():
    with pytest.raises(ValueError, match="is an action"):
        ros1_md5("a/F", {"a/action/F": "---\n---\n"})
