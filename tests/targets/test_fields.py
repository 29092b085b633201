"""Interfaces by version: read from a small repository's tags, kept as a table, and asked for single versions."""

import pygit2
import pytest
from rosimpact.databuild.fields import build_table, read_repository
from rosimpact.impact.targets.surface.fields import FieldsHistory, covers, load_fields, was_there_before

MANIFEST = """<package format="3"><name>arm_msgs</name><version>{}</version>
<buildtool_depend>{}</buildtool_depend></package>"""
ONE = {
    "msg/State.msg": "string name\nfloat64[] resources\nHeader header\n",
    "srv/Start.srv": "string[] start_arms\nbool start_now\nint32 STRICT=1\n---\nbool ok\n",
    "msg/Old.msg": "bool on\n",
}
TWO = {
    "msg/State.msg": "string name\nfloat64[] held\nstd_msgs/Header header\n",
    "srv/Start.srv": "string[] start_arms\nbool start_now\nstring[] use_arms\nbool use_now\n---\nbool ok\n",
    "msg/New.msg": "State[] states\n",
}
THREE = {**TWO, "srv/Start.srv": "string[] use_arms\nbool use_now\n---\nbool ok\nstring text\n"}


def commit(repository, files: dict[str, str]) -> str:
    index = pygit2.Index()
    for path, text in files.items():
        index.add(pygit2.IndexEntry(path, repository.create_blob(text.encode()), pygit2.enums.FileMode.BLOB))
    signature = pygit2.Signature("Robots", "robots@example.org", 0, 0)
    return repository.create_commit(None, signature, signature, "", index.write_tree(repository), [])


def released(folder, versions: dict[str, tuple[str, str, dict[str, str]]]) -> dict[str, str]:
    """The table of a repository with a tag for each version: manifest version, build tool, files."""
    repository = pygit2.init_repository(str(folder), bare=True)
    for tag, (version, tool, files) in versions.items():
        named = {f"arm_msgs/{path}": text for path, text in files.items()}
        made = commit(repository, {**named, "arm_msgs/package.xml": MANIFEST.format(version, tool)})
        repository.references.create(f"refs/tags/{tag}", made)
    return build_table(read_repository(repository, frozenset({"arm_msgs"})))


@pytest.fixture
def history(tmp_path) -> FieldsHistory:
    made = released(
        tmp_path,
        {
            "10.0.0": ("10.0.0", "ament_cmake", THREE),
            "2.0.0": ("2.0.0", "ament_cmake", ONE),
            "2.0.1": ("2.0.1", "ament_cmake", ONE),
            "3.0.0": ("3.0.0", "ament_cmake", TWO),
            "moved": ("3.0.0", "ament_cmake", ONE),  # the tag that is called after the version counts
        },
    )
    assert list(made) == ["arm_msgs 2"]
    return FieldsHistory(made["arm_msgs 2"])


@pytest.mark.parametrize(
    ("version", "state"),
    [("1.9.9", None), ("2.0.0", 0), ("2.5.0", 0), ("3.0.0", 1), ("9.9.9", 1), ("10.0.0", 2), ("11.0.0", 2)],
)
def test_a_version_has_the_state_of_the_last_change_before_it(history, version, state):
    assert history.find_state(version) == state


@pytest.mark.parametrize(
    ("interface", "section", "member", "states", "successor"),
    [
        ("msg/State", "message", "name", [0, 1, 2], ""),
        ("msg/State", "message", "resources", [0], "held"),
        ("msg/State", "message", "held", [1, 2], ""),
        ("msg/State", "message", "header", [0, 1, 2], ""),  # `Header` is the same as `std_msgs/Header`
        ("srv/Start", "request", "start_arms", [0, 1], "use_arms"),  # deprecated in between
        ("srv/Start", "request", "start_now", [0, 1], "use_now"),
        ("srv/Start", "request", "STRICT", [0], ""),
        ("srv/Start", "response", "text", [2], ""),
    ],
)
def test_where_a_member_is(history, interface, section, member, states, successor):
    (row,) = history.find_definition(interface).list_members(section, member)
    assert ([s for s in range(3) if covers(row.spans, s)], row.successor) == (states, successor)


def test_where_an_interface_is(history):
    spans = {name: [s for s in range(3) if covers(history.find_spans(name), s)] for name in history.interfaces}
    assert spans == {"msg/Old": [0], "msg/New": [1, 2], "msg/State": [0, 1, 2], "srv/Start": [0, 1, 2]}
    assert was_there_before(history.find_spans("msg/Old"), 1)
    assert not was_there_before(history.find_spans("msg/New"), 0)


def test_nested_types_are_kept(history):
    (states,) = history.find_definition("msg/New").list_members("message", "states")
    assert (states.nested, states.array) == ("arm_msgs/State", True)


def test_what_changes(history):
    assert history.find_definition("srv/Start").changing == {
        *("start_arms", "start_now", "use_arms", "use_now", "STRICT", "text"),
    }


@pytest.mark.parametrize(
    ("version", "read"), [("2.0.0", True), ("2.0.1", True), ("2.0.2", False), ("3.0.0", True), ("4.0.0", False)]
)
def test_a_line_is_read_up_to_its_last_tag(history, version, read):
    assert history.read_up_to(version) == read


@pytest.mark.parametrize(
    ("version", "back"),
    [
        ("2.1.0", False),  # it was read, and lacks the message
        ("2.1.5", True),  # a release that was not read may go on from 2.0.1
        ("3.0.5", False),  # nothing of it comes later
    ],
)
def test_what_was_brought_to_an_older_line_may_be_in_its_later_releases(tmp_path, version, back):
    contents = {"2.0.0": ONE, "2.0.1": TWO, "2.1.0": ONE, "3.0.0": TWO}
    made = released(tmp_path, {v: (v, "ament_cmake", files) for v, files in contents.items()})
    history = FieldsHistory(made["arm_msgs 2"])
    assert history.may_be_back(history.find_spans("msg/New"), version) == back


@pytest.mark.parametrize(
    ("stem", "interface"),
    [("srv/start", "srv/Start"), ("StartRequest", "srv/Start"), ("State", "msg/State"), ("state", None)],
)
def test_headers_of_both_generations(history, stem, interface):
    assert history.by_header.get(stem) == interface


def test_generations_are_apart(tmp_path):
    made = released(tmp_path, {"1.0.0": ("1.0.0", "catkin", ONE), "2.0.0": ("2.0.0", "ament_cmake", TWO)})
    assert list(made) == ["arm_msgs 1", "arm_msgs 2"]


def test_interfaces_that_come_from_other_packages_are_not_known(tmp_path):
    cmake = {"CMakeLists.txt": "rosidl_generate_interfaces(arm_msgs ${shared_interfaces_MSG_FILES})"}
    assert released(tmp_path, {"1.0.0": ("1.0.0", "ament_cmake", {**ONE, **cmake})}) == {}


# package, generation, interface, section, member, versions that have it, versions that do not
KNOWN = [
    ("controller_manager_msgs", 2, "srv/SwitchController", "request", "start_controllers", "2.12.0 3.8.0", "4.0.0"),
    ("controller_manager_msgs", 2, "srv/SwitchController", "request", "activate_controllers", "2.12.0 4.0.0", "2.11.0"),
    ("controller_manager_msgs", 1, "msg/ControllerState", "message", "resources", "0.9.3", "0.10.0 0.19.0"),
    ("control_msgs", 2, "msg/JointTrajectoryControllerState", "message", "actual", "3.0.0 4.4.0", "5.0.0"),
    ("vision_msgs", 2, "msg/ObjectHypothesisWithPose", "message", "id", "1.0.0 2.0.0", "3.0.0 4.1.0"),
    ("rcl_interfaces", 2, "msg/ParameterDescriptor", "message", "dynamic_typing", "1.2.0", "1.0.0"),
]  # fmt: skip


@pytest.mark.parametrize(("package", "ros", "interface", "section", "member", "having", "lacking"), KNOWN)
def test_the_shipped_table(package, ros, interface, section, member, having, lacking):
    history = load_fields().find_history(package, ros)
    rows = history.find_definition(interface).list_members(section, member)
    found = {
        version: any(covers(row.spans, history.find_state(version)) for row in rows)
        for version in (*having.split(), *lacking.split())
    }
    assert found == {**dict.fromkeys(having.split(), True), **dict.fromkeys(lacking.split(), False)}


def test_the_shipped_table_is_whole():
    table = load_fields()
    for key in table.list_packages():
        package, ros = key.split(" ")
        history = table.find_history(package, int(ros))
        states = len(history.starts)
        for interface in history.interfaces:
            definition = history.find_definition(interface)
            spans = [
                definition.spans,
                *(r.spans for m in definition.sections.values() for rows in m.values() for r in rows),
            ]
            assert all(first < states and last < states for runs in spans for first, last in runs), (key, interface)
