"""Lighter message definitions."""

import json
from pathlib import Path
from textwrap import dedent

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.impact.cli.app import app
from rosimpact.impact.facts.interface import PRIMITIVES, extract, make_full_name
from rosimpact.impact.prune.light import LightenError, lighten
from typer.testing import CliRunner

RUNNER = CliRunner()
POSES = {
    "pier_msgs/Pose": "Point position\nQuaternion orientation\n",
    "pier_msgs/Point": "float64 x\nfloat64 y\n# up\nfloat64 z\n",
    "pier_msgs/Quaternion": "float64 x 0\nfloat64 w 1\n",
    "std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id\n",
}


def write_light(text, keep, others=POSES, name="", origin="dock_msgs/Mooring", taken=None):
    """The lighter texts by name. keep: as on the command line."""
    texts = {each: other.encode() for each, other in others.items()} | {origin: dedent(text).encode()}
    found = lighten(texts.get, origin, keep.split(","), name, taken)
    return {each: one.text.decode() for each, one in found.items()}


CASES = [
    # What is kept stays byte for byte: indentation, comments, constants, defaults, bounds, annotations.
    ("int32 a\nint32  b   # the b\n", "b", "int32  b   # the b\n"),
    ("int32 a 5\nint32 b\n", "a", "int32 a 5\n"),
    ("string<=5[<=3] a ['x']\nwstring<=3 b\n", "a", "string<=5[<=3] a ['x']\n"),
    ("string<=5 a\nwstring<=3 b\n", "b", "wstring<=3 b\n"),
    ("int8 A=1 # one\nint32 a\nstring B= x # y\nint32 b\n", "b", "int8 A=1 # one\nstring B= x # y\nint32 b\n"),
    ("int32 a\r\nint32 b\r\n", "b", "int32 b\r\n"),
    ("int32 a\nint32 b", "b", "int32 b"),
    ("int32 a\nint32 b", "a", "int32 a\n"),
    ("\ufeffint32 a\nint32 b\n", "b", "\ufeffint32 b\n"),
    ("int32 a # \x0c page\nint32 b # \u2028\n", "b", "int32 b # \u2028\n"),
    # The comment right above a field goes with it, one that stands for itself does not.
    ("# of a\n# too\nint32 a # and this\n# of b\nint32 b\n", "b", "# of b\nint32 b\n"),
    ("# File\n\n# of a\nint32 a\n\n# of b\nint32 b\n", "b", "# File\n\n# of b\nint32 b\n"),
    ("# File\n\n# of a\nint32 a\n\n# of b\nint32 b\n", "a", "# File\n\n# of a\nint32 a\n\n"),
    ("int32 a\n# for itself\n\nint32 b\n", "a", "int32 a\n# for itself\n\n"),
    ("int32 A=1\n# of a\nint32 a\nint32 b\n", "b", "int32 A=1\nint32 b\n"),
    ("int32 a\n\nint32 b\n\nint32 c\n", "a,c", "int32 a\n\nint32 c\n"),
    # An annotation belongs to the field that follows, however far.
    ('@unit("m")\nint32 a\n@key int32 b\n', "b", "@key int32 b\n"),
    ('@unit("m")\n\n# of a\nint32 a\nint32 b\n', "b", "int32 b\n"),
    ('@unit("é") @key\n# of a\n@optional\nint32 a\nint32 b\n', "b", "int32 b\n"),
    # Order is that of the file.
    ("int32 a\nint32 b\nint32 c\n", "c,a", "int32 a\nint32 c\n"),
    ("Header header\nint32 a\n", "header", "Header header\n"),
    ("time a\nduration[] b\n", "b", "duration[] b\n"),
    ("pier_msgs/Pose[3] a\nint32 b\n", "a", "pier_msgs/Pose[3] a\n"),
]


@pytest.mark.parametrize(("text", "keep", "expected"), CASES)
def test_what_stays(text, keep, expected):
    assert write_light(text, keep) == {"MooringLight": expected}


def test_bytes_that_are_no_utf_8_stay():
    text = b'int32 a\n@unit("\xe9\xe9") pier_msgs/Pose b # caf\xe9\n'
    texts = {"dock_msgs/M": text} | {name: other.encode() for name, other in POSES.items()}
    found = lighten(texts.get, "dock_msgs/M", ["b.position"])
    assert found["MLight"].text == b'@unit("\xe9\xe9") MLightPose b # caf\xe9\n'


def test_nested_definitions():
    """Types of another package get its name, where the definition moves and they stay whole."""
    found = write_light(
        """\
        pier_msgs/Pose  pose  # where
        pier_msgs/Pose[<=4] poses
        pier_msgs/msg/Pose[] rest
        """,
        "pose.position,poses[].position,rest.position.x",
    )
    assert found == {
        "MooringLight": "MooringLightPose  pose  # where\nMooringLightPose[<=4] poses\nMooringLightPose2[] rest\n",
        "MooringLightPose": "pier_msgs/Point position\n",
        "MooringLightPoint": "float64 x\n",
        "MooringLightPose2": "MooringLightPoint position\n",
    }


def test_header_of_another_package_is_named_in_full():
    found = write_light("pier_msgs/Stamped s\n", "s.header", POSES | {"pier_msgs/Stamped": "Header header\nint8 a\n"})
    assert found["MooringLightStamped"] == "std_msgs/Header header\n"
    assert write_light("Header header\n", "header.stamp") == {
        "MooringLight": "MooringLightHeader header\n", "MooringLightHeader": "time stamp\n",
    }  # fmt: skip


def test_what_is_kept_in_all_its_parts_keeps_its_type():
    text = "pier_msgs/Pose pose\nint32 a\n"
    whole = {"MooringLight": "pier_msgs/Pose pose\n"}
    assert write_light(text, "pose.position.x,pose.position.y,pose.orientation,pose.position.z") == whole
    assert write_light(text, "pose.position.x,pose") == whole
    assert write_light(text, "pose,pose.position.x") == whole


def test_a_message_that_holds_itself():
    others = {"dock_msgs/Tree": "Tree[] children\nint32 a\nint32 b\n"}
    found = write_light("Tree tree\n", "tree.children.a,tree.b", others)
    assert found["MooringLightTree2"] == "MooringLightTree[] children\nint32 b\n"
    assert found["MooringLightTree"] == "int32 a\n"


def test_names_that_are_taken():
    text, keep = "pier_msgs/Pose pose\n", "pose.orientation"
    taken = {"mooringlightpose": b"int32 other\n"}
    assert list(write_light(text, keep, taken=taken)) == ["MooringLight", "MooringLightPose2"]
    # The same file once more is no clash.
    again = {name: one.encode() for name, one in write_light(text, keep).items()}
    assert list(write_light(text, keep, taken=again)) == ["MooringLight", "MooringLightPose"]
    with pytest.raises(LightenError, match="another message of this name"):
        write_light(text, keep, taken={"MooringLight": b"int32 other\n"})
    assert list(write_light(text, keep, name="Slim")) == ["Slim", "SlimPose"]


ERRORS = [
    ("int32 a\n", "", "names no field|no path"),
    ("int32 a\n", "a-b", "is no path of a field"),
    ("int32 above\n", "abovo", "dock_msgs/Mooring has no field `abovo`; did you mean `above`"),
    ("int32 a\n", "zzz", "has no field `zzz`; it has a"),
    ("int32 A=1\nint32 a\n", "A", "no field `A`"),
    ("int32 a\n", "a.b", "--keep a: is a int32, which has no fields"),
    ("time a\n", "a.secs", "is a time, which has no fields"),
    ("far_msgs/Far f\n", "f.a", "f: the definition of far_msgs/Far is not known"),
    ("int32 a\nwhat?!\n", "a", "dock_msgs/Mooring, line 2: .*; mend it first"),
    ("int32 a\nint32 a\n", "a", "line 2: a second field `a`"),
    ("int32 a\n", "a" + ".a" * 60, "more than 50 levels"),
]


@pytest.mark.parametrize(("text", "keep", "expected"), ERRORS)
def test_what_cannot_be_done(text, keep, expected):
    with pytest.raises(LightenError, match=expected):
        write_light(text, keep)


# Definitions in which a later message may hold earlier ones; each declaration with the lines that belong to it.
TYPES = [*sorted(PRIMITIVES - {"octet", "wchar"}), "time", "duration", "string<=7", "wstring<=2"]
ARRAYS = st.sampled_from(["", "", "", "[]", "[3]", "[<=5]"])
COMMENTS = st.lists(st.sampled_from(["# far", "#", "  # x = 1", "#@unit", "# int32 a"]), max_size=2)


@st.composite
def definitions(draw):
    """[(package/Name, [(name of the field or None, its lines)])], and paths to keep of the last one."""
    count = draw(st.integers(1, 5))
    made = []
    for number in range(count):
        package = draw(st.sampled_from(["a", "b"])) if number < count - 1 else "a"
        blocks = []
        for place in range(draw(st.integers(1, 5))):
            above = draw(COMMENTS) + draw(st.sampled_from([[], ["@key"], ['@unit("m")']]))
            tail = draw(st.sampled_from(["", "  # behind", "#"]))
            earlier = [full for full, _ in made]
            kind = draw(st.integers(0, 3))
            if kind == 0:
                blocks.append((None, [*draw(COMMENTS), f"int8 C{place}={place}  # c"]))
            elif kind == 1 and earlier:
                full = draw(st.sampled_from(earlier))
                short = full.partition("/")[2]
                written = [full, full.replace("/", "/msg/"), *([short] if full.startswith(f"{package}/") else [])]
                type_ = draw(st.sampled_from(written)) + draw(ARRAYS)
                blocks.append((f"f{place}", [*above, f"{type_} f{place}{tail}"]))
            else:
                type_ = draw(st.sampled_from(TYPES)) + draw(ARRAYS)
                blocks.append((f"f{place}", [*above, f" {type_}  f{place}{tail}"]))
            if draw(st.booleans()):
                blocks.append((None, ["", *draw(COMMENTS), ""]))
        if not any(name for name, _ in blocks):
            blocks.append(("last", ["int8 last"]))
        made.append((f"{package}/M{number}", blocks))
    every = list_paths({full: parse_blocks(blocks) for full, blocks in made}, made[-1][0])
    return made, draw(st.lists(st.sampled_from(every), min_size=1, max_size=6))


def parse_blocks(blocks):
    return only(write_blocks(blocks))


def write_blocks(blocks):
    return "".join(line + "\n" for _, lines in blocks for line in lines).encode()


def only(data):
    facts = extract(data, "msg")
    assert facts.problems == ()
    return facts.sections[0]


def walk(sections, full, above=""):
    """(path, types on the way with their arrays, whether it has no fields of its own) of all fields, in order."""
    for field in sections[full].fields:
        path = f"{above}.{field.name}" if above else field.name
        nested = make_full_name(field.type, full.partition("/")[0])
        if nested in sections:
            yield path, field.array, False
            yield from walk(sections, nested, path)
        else:
            yield path, field.type + field.array, True


def list_paths(sections, full):
    return [path for path, *_ in walk(sections, full)]


@given(definitions())
@settings(max_examples=150)
def test_what_is_kept_is_there_and_nothing_else(drawn):
    made, keep = drawn
    texts = {full: write_blocks(blocks) for full, blocks in made}
    origin = made[-1][0]
    found = lighten(texts.get, origin, keep)

    before = {full: only(text) for full, text in texts.items()}
    after = before | {f"a/{name}": only(one.text) for name, one in found.items()}
    chosen = [
        (path, type_)
        for path, type_, leaf in walk(before, origin)
        if any((path + ".").startswith(each + ".") or (not leaf and each.startswith(path + ".")) for each in keep)
    ]
    assert [(path, type_) for path, type_, _ in walk(after, f"a/{next(iter(found))}")] == chosen

    assert len({name.lower() for name in found}) == len(found)
    blocks_of = dict(made)
    for name, one in found.items():
        # Line by line what stood there, but for the types of fields.
        blocks = (lines for owner, lines in blocks_of[one.origin] if owner in (None, *one.fields))
        kept = [line for lines in blocks for line in lines if line]
        lines = [line for line in one.text.decode().splitlines() if line]
        assert len(lines) == len(kept)
        for new, old in zip(lines, kept, strict=True):
            assert new == old or new.partition(" ")[2].lstrip() == old.partition(" ")[2].lstrip(), name
        assert [c.name for c in after[f"a/{name}"].constants] == [c.name for c in before[one.origin].constants]


@pytest.fixture
def dock(tmp_path):
    for package, messages in {
        "dock_msgs": {"Mooring": "pier_msgs/Pose pose\nstring name\n", "Other": "int8 a\n"},
        "pier_msgs": {name.partition("/")[2]: text for name, text in POSES.items() if name.startswith("pier")},
    }.items():
        folder = tmp_path / "ws" / package / "msg"
        folder.mkdir(parents=True)
        (folder.parent / "package.xml").write_text(f"<package><name>{package}</name></package>")
        for name, text in messages.items():
            (folder / f"{name}.msg").write_text(text)
    return tmp_path


def run_light(dock, *arguments, file="ws/dock_msgs/msg/Mooring.msg"):
    return RUNNER.invoke(app, ["msg", "light", str(dock / file), *map(str, arguments)])


def test_the_command_finds_nested_messages_around_the_package(dock):
    found = run_light(dock, "--keep", "pose.position.x,name")
    assert found.exit_code == 0
    assert found.stdout == dedent("""\
        MooringLightPose pose
        string name
        ================================================================================
        MSG: dock_msgs/MooringLightPoint
        float64 x
        ================================================================================
        MSG: dock_msgs/MooringLightPose
        MooringLightPoint position
        """)
    assert "MooringLightPose.msg: pier_msgs/Pose without orientation" in found.stderr
    assert "3 files, all for the msg folder of dock_msgs; add them to its CMakeLists.txt" in found.stderr


def test_the_command_writes_files(dock):
    for _ in range(2):
        found = run_light(dock, "--keep", "pose.position", "--name", "Slim", "--output", dock / "out")
        assert (found.exit_code, found.stdout) == (0, "")
        assert {path.name: path.read_text() for path in (dock / "out").iterdir()} == {
            "Slim.msg": "SlimPose pose\n", "SlimPose.msg": "pier_msgs/Point position\n",
        }  # fmt: skip


def test_the_command_as_json(dock):
    found = run_light(dock, "--keep", "pose.position,name", "--format", "json")
    assert json.loads(found.stdout)[1] == {
        "name": "MooringLightPose", "file": "MooringLightPose.msg", "origin": "pier_msgs/Pose",
        "fields": ["position"], "dropped": ["orientation"], "text": "pier_msgs/Point position\n",
    }  # fmt: skip


def test_definitions_of_the_sourced_environment(dock, monkeypatch):
    installed = dock / "install" / "share"
    installed.parent.mkdir()
    (dock / "ws" / "pier_msgs").rename(dock / "pier_msgs")
    failed = run_light(dock, "--keep", "pose.position")
    assert failed.exit_code == 2
    assert "pose: the definition of pier_msgs/Pose is not known" in failed.stderr
    assert run_light(dock, dock / "pier_msgs", "--keep", "pose.position").exit_code == 0
    installed.mkdir()
    (dock / "pier_msgs").rename(installed / "pier_msgs")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/nowhere:{installed.parent}")
    assert run_light(dock, "--keep", "pose.position").exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("--keep", "pose", "--name", "Other"), "Other: there is another message of this name"),
        (("--keep", "pose", "--name", "a b"), "--name a b: is no name of a message"),
        (("--keep", "poze"), "has no field `poze`; did you mean `pose`?"),
        (("ws/nowhere", "--keep", "pose.position"), "ws/nowhere: is no folder"),
    ],
)
def test_errors_of_the_command(dock, arguments, expected):
    found = run_light(dock, *arguments)
    assert found.exit_code == 2
    assert expected in found.stderr
    assert found.stderr.count("\n") == 1


def test_only_messages(dock):
    (dock / "Call.srv").write_text("int8 a\n---\n")
    assert "is no .msg file" in run_light(dock, "--keep", "a", file="Call.srv").stderr
    assert "No such file" in run_light(dock, "--keep", "a", file="Gone.msg").stderr


def test_a_message_outside_of_any_package(tmp_path):
    Path(tmp_path, "Loose.msg").write_text("Near near\nint8 a\n")
    Path(tmp_path, "Near.msg").write_text("int8 b\nint8 c\n")
    found = RUNNER.invoke(app, ["msg", "light", str(tmp_path / "Loose.msg"), "--keep", "near.c"])
    assert found.stdout.startswith("LooseLightNear near\n=")
