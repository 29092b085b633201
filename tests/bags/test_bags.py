"""What bags tell of their topics and fields, in all three forms."""

import contextlib
import json
import os
import re
import shutil
import sqlite3
import sys
from contextlib import closing

import pytest

pytest.importorskip("rosbags.rosbag2")

from bag_maker import DEFINITIONS, FORMS, make_message, make_quays, make_store, write_bag
from hypothesis import given
from hypothesis import strategies as st
from rosbags import rosbag1, rosbag2
from rosbags.typesys import get_types_from_msg
from rosimpact.impact.analysis.bag_files import BagError
from rosimpact.impact.analysis.bags import LengthFacts, list_silent_fields, measure_bag
from rosimpact.impact.analysis.rosbag_file import RosbagFile
from rosimpact.impact.cli.app import app
from typer.testing import CliRunner


@pytest.fixture(scope="module", params=FORMS)
def quay(request, tmp_path_factory):
    store = make_store()
    return request.param, write_bag(tmp_path_factory.mktemp("bag"), request.param, make_quays(store, 20), store=store)


def run_fields(*arguments):
    return CliRunner().invoke(app, ["fields", *map(str, arguments)])


def test_topics(quay):
    form, path = quay
    found = measure_bag(path)
    assert (found.form, found.encoding) == (form, "ros1" if form == "rosbag" else "cdr")
    assert (found.count, found.whole, found.duration) == (21, True, pytest.approx(1.9))
    assert [topic.topic for topic in found.topics] == ["/quay", "/berth"]
    assert found.empty_topics == ("/never",)
    first, second = found.topics
    assert (first.type, first.count, first.definition, first.problem) == ("quay_msgs/Quay", 20, "bag", "")
    assert (first.rate, first.duration) == (pytest.approx(10), pytest.approx(1.9))
    assert first.bytes_per_second == pytest.approx(first.bytes.mean * 10)
    assert (second.count, second.rate, second.bytes_per_second) == (1, None, None)
    size = 17 if form == "rosbag" else 4 + 24
    assert (second.bytes.mean, second.bytes.p50, second.bytes.p95, second.bytes.max) == (size, size, size, size)


def test_sizes_are_those_of_the_messages(quay):
    form, path = quay
    store = make_store()
    serialize = store.serialize_ros1 if form == "rosbag" else store.serialize_cdr
    rows = [row for row in make_quays(store, 20) if row[0] == "/quay"]
    sizes = sorted(len(serialize(message, "quay_msgs/msg/Quay")) for *_, message in rows)
    topic = measure_bag(path).topics[0]
    assert topic.bytes.mean == pytest.approx(sum(sizes) / 20, abs=0.01)
    assert (topic.bytes.p50, topic.bytes.p95, topic.bytes.max) == (sizes[9], sizes[18], sizes[-1])
    assert topic.overhead + sum(field.bytes for field in topic.fields) == pytest.approx(topic.bytes.mean, abs=0.1)
    assert (topic.overhead == 0) == (form == "rosbag")


def test_fields(quay):
    form, path = quay
    topic = measure_bag(path).topics[0]
    zero = form != "rosbag"  # CDR sends the zero behind a string
    assert {field.field: (field.type, field.filled, field.nonzero, field.bytes) for field in topic.fields} == {
        "header.stamp": ("time" if form == "rosbag" else "builtin_interfaces/Time", True, True, 8),
        "header.frame_id": ("string", True, True, 7 + zero),
        "open": ("bool", False, False, 1),
        "spare": ("float64[3]", False, False, 24),
        "berths": ("quay_msgs/Berth[]", True, False, 4),
        "berths[].kind": ("uint8", False, False, 0.95),
        # -0.0 is 0.
        "berths[].depth": ("float64", False, False, 7.6),
        "berths[].tide": ("float64", True, True, 7.6),
        "picture": ("uint8[]", True, False, 104),
        "names": ("string[]", True, True, 12.5 if form == "rosbag" else 15),
        "levels": ("float32[]", True, True, 12),
        "note": ("string", False, False, 4 + zero),
    }
    assert [field.field for field in list_silent_fields(topic)] == [
        "open", "spare", "berths[].kind", "berths[].depth", "note",
    ]  # fmt: skip
    lengths = {field.field: field.lengths for field in topic.fields if field.lengths is not None}
    assert lengths == {
        "header.frame_id": LengthFacts(3, 3, 3, 20),
        "berths": LengthFacts(0, 0.95, 2, 20),
        "picture": LengthFacts(100, 100, 100, 20),
        "names": LengthFacts(1, 1.5, 2, 20),
        "levels": LengthFacts(2, 2, 2, 20),
        "note": LengthFacts(0, 0, 0, 20),
    }
    assert sum(field.share for field in topic.fields) + topic.overhead / topic.bytes.mean == pytest.approx(1, abs=1e-3)


def test_only_some_topics_and_messages(quay):
    _, path = quay
    assert [topic.topic for topic in measure_bag(path, ["berth"]).topics] == ["/berth"]
    assert [topic.topic for topic in measure_bag(path, ["/q*", "/berth"]).topics] == ["/quay", "/berth"]
    part = measure_bag(path, ["/quay"], limit=5)
    assert (part.count, part.whole, part.topics[0].count) == (5, False, 5)
    assert measure_bag(path, limit=21).whole
    with pytest.raises(BagError, match=r"--topic /kay: .* has no such topic; it has /berth, /never, /quay"):
        measure_bag(path, ["/quay", "/kay"])


def test_the_command(quay):
    form, path = quay
    found = run_fields("--bag", path)
    assert found.exit_code == 0, found.stderr
    lines = found.stdout.splitlines()
    assert lines[0] == f"{path}  {form}, 21 messages in 1.9 s, 2 topics"
    assert lines[2] == "/quay  quay_msgs/Quay"
    said = {line.split()[0]: line.split("%")[-1].strip() for line in lines if line.startswith("    ")}
    assert said["open"] == "always 0"
    assert said["note"] == "always empty"
    assert said["picture"] == "100 elements  always zeros"
    assert said["names"] == "1 to 2 elements, 1.5 on average"
    assert said["header.stamp"] == ""
    assert ("(padding)" in said) == (form != "rosbag")
    assert lines[-1] == "without messages: /never"


def test_the_command_as_json(quay):
    form, path = quay
    found = run_fields("--bag", path, "--topic", "/berth", "--format", "json")
    report = json.loads(found.stdout)
    assert report["schema"] == 1
    assert report["bag"]["form"] == form
    assert report["bag"]["topics"][0]["fields"][0] == {
        "field": "kind", "type": "uint8", "filled": True, "nonzero": True, "bytes": 1.0,
        "share": pytest.approx(1 / (17 if form == "rosbag" else 28)), "lengths": None,
    }  # fmt: skip


def test_fields_of_arrays_that_were_always_empty(tmp_path):
    store = make_store()
    rows = [("/quay", "quay_msgs/Quay", 1.0, make_message(store, "quay_msgs/Quay"))]
    found = run_fields("--bag", write_bag(tmp_path, "mcap", rows, store=store)).stdout
    said = {line.split()[0]: line.split("%")[-1].strip() for line in found.splitlines() if line.startswith("    ")}
    assert said["berths"] == said["picture"] == said["names"] == "always empty"
    assert said["berths[].depth"] == "never sent"
    assert said["spare"] == "always 0"


COMPRESSED = [
    ("rosbag", (rosbag1.Writer.CompressionFormat.BZ2,)),
    ("rosbag", (rosbag1.Writer.CompressionFormat.LZ4,)),
    ("mcap", (rosbag2.CompressionMode.STORAGE, rosbag2.CompressionFormat.ZSTD)),
    ("mcap", (rosbag2.CompressionMode.MESSAGE, rosbag2.CompressionFormat.ZSTD)),
    ("mcap", (rosbag2.CompressionMode.FILE, rosbag2.CompressionFormat.ZSTD)),
    ("sqlite3", (rosbag2.CompressionMode.MESSAGE, rosbag2.CompressionFormat.ZSTD)),
    ("sqlite3", (rosbag2.CompressionMode.FILE, rosbag2.CompressionFormat.ZSTD)),
]


@pytest.mark.parametrize(("form", "compression"), COMPRESSED)
def test_compressed_bags_tell_the_same(tmp_path, form, compression):
    store = make_store()
    (tmp_path / "plain").mkdir()
    plain = write_bag(tmp_path / "plain", form, make_quays(store, 9), store=store)
    packed = write_bag(tmp_path, form, make_quays(store, 9), store=store, compression=compression)
    assert measure_bag(packed) == measure_bag(plain)


def test_a_compressed_file_that_unpacks_to_too_much(tmp_path, monkeypatch):
    store = make_store()
    how = (rosbag2.CompressionMode.FILE, rosbag2.CompressionFormat.ZSTD)
    path = write_bag(tmp_path, "mcap", make_quays(store, 9), store=store, compression=how)
    file = next(path.glob("*.zstd"))
    assert measure_bag(file).count == 10
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: shutil._ntuple_diskusage(9_000, 1_000, 8_000))
    failed = run_fields("--bag", path)
    assert f"{file}: unpacks to more than half of what is free in " in failed.stderr
    monkeypatch.undo()
    file.write_bytes(file.read_bytes()[:-20])
    failed = run_fields("--bag", path)
    assert (failed.exit_code, failed.stderr.count("\n")) == (2, 1)
    file.write_bytes(b"no zstd at all")
    assert f"{file}: cannot be unpacked: " in run_fields("--bag", path).stderr


def test_several_ways_to_name_a_bag(quay):
    form, path = quay
    if form == "rosbag":
        return
    found = measure_bag(path)
    storage = next(each for each in path.iterdir() if each.suffix in (".mcap", ".db3"))
    assert measure_bag(path / "metadata.yaml") == found
    assert measure_bag(storage).topics == found.topics


def test_a_recording_that_was_cut_off_has_no_metadata(tmp_path, quay):
    form, path = quay
    if form == "rosbag":
        return
    copy = shutil.copytree(path, tmp_path / "copy")
    (copy / "metadata.yaml").unlink()
    assert measure_bag(copy).topics == measure_bag(path).topics


def write_plain_sqlite(tmp_path, messages=None, definitions=DEFINITIONS):
    """A bag as Foxy wrote them, without definitions."""
    store = make_store(definitions)
    path = write_bag(tmp_path, "sqlite3", messages or make_quays(store, 5), store=store)
    file = next(path.glob("*.db3"))
    with closing(sqlite3.connect(file)) as bag, bag:
        bag.execute("DELETE FROM message_definitions")
    return file


def test_definitions_that_the_bag_does_not_have(tmp_path):
    file = write_plain_sqlite(tmp_path)
    topic = measure_bag(file).topics[0]
    assert (topic.fields, topic.definition) == ((), "")
    assert topic.problem == "the definition of quay_msgs/Quay is not known"
    found = run_fields("--bag", file)
    assert "fields are not known: the definition of quay_msgs/Quay is not known; name the workspace" in found.stdout

    for name, text in DEFINITIONS.items():
        package, _, short = name.partition("/")
        folder = tmp_path / "ws" / package / "msg"
        folder.mkdir(parents=True, exist_ok=True)
        (folder.parent / "package.xml").write_text(f"<package><name>{package}</name></package>")
        if package == "quay_msgs":
            (folder / f"{short}.msg").write_text(text)
    report = json.loads(run_fields(tmp_path / "ws", "--bag", file, "--format", "json").stdout)
    topic = report["bag"]["topics"][0]
    # What ROS itself has need not be in the workspace.
    assert topic["definition"] == "workspace, rosbags (latest)"
    assert len(topic["fields"]) == 12


def test_messages_unlike_their_definition(tmp_path, quay):
    form, _ = quay
    store = make_store()
    rows = list(make_quays(store, 150))
    one = write_bag(tmp_path, form, [*rows, ("/quay", "quay_msgs/Quay", 99.0, b"\0\1\0\0ab")], store=store)
    topic = measure_bag(one).topics[0]
    assert (topic.count, topic.unlike, len(topic.fields)) == (151, 1, 12)
    assert topic.problem == "a message ends early, after 6 bytes" if form != "rosbag" else topic.problem
    (tmp_path / "many").mkdir()
    long = bytes(store.serialize_ros1(rows[0][3], "quay_msgs/msg/Quay"))
    if form != "rosbag":
        long = bytes(store.serialize_cdr(rows[0][3], "quay_msgs/msg/Quay"))
    rows = [("/quay", "quay_msgs/Quay", float(at), long + b"more!") for at in range(5)]
    topic = measure_bag(write_bag(tmp_path / "many", form, rows, store=store)).topics[0]
    assert (topic.unlike, topic.fields) == (5, ())
    assert "bytes where its definition says" in topic.problem


def test_other_byte_order(tmp_path):
    store = make_store()
    rows = [row for row in make_quays(store, 6) if row[0] == "/quay"]
    big = [
        (topic, type_, at, bytes(store.serialize_cdr(message, "quay_msgs/msg/Quay", little_endian=False)))
        for topic, type_, at, message in rows
    ]
    (tmp_path / "big").mkdir()
    assert measure_bag(write_bag(tmp_path / "big", "mcap", big, store=store)) == measure_bag(
        write_bag(tmp_path, "mcap", rows, store=store)
    )


def test_an_encoding_that_is_not_read(tmp_path):
    rows = [("/berth", "quay_msgs/Berth", 1.0, b"\0\7\0\0" + bytes(24))]
    topic = measure_bag(write_bag(tmp_path, "mcap", rows)).topics[0]
    assert topic.problem == "a message begins with 00 07 00 00, which is no CDR of the first version"


HOSTILE = {
    "more than 20,000 fields": {f"h/B{n}": f"h/B{n + 1} a\nh/B{n + 1} b\n" for n in range(30)} | {"h/B30": "int8 a\n"},
    "holds itself": {"h/B0": "h/B1[] a\n", "h/B1": "h/B0[] a\n"},
    "more than 50 levels deep": {f"h/B{n}": f"h/B{n + 1} a\n" for n in range(70)} | {"h/B70": "int8 a\n"},
    "the definition of h/B0 cannot be read: line 2 `??!` is neither": {"h/B0": "int8 import os; os.abort()\n??!\n"},
}


@pytest.mark.parametrize("expected", HOSTILE)
def test_hostile_definitions(tmp_path, expected):
    """rosbags makes code of definitions; nothing of that is run here, and what explodes is refused."""
    texts = dict(HOSTILE[expected])
    whole = texts.pop("h/B0") + "".join(f"{'=' * 80}\nMSG: {name}\n{text}" for name, text in texts.items())
    path = tmp_path / "hostile.bag"
    with rosbag1.Writer(path) as bag:
        bag.write(bag.add_connection("/a", "h/msg/B0", msgdef=whole, md5sum="0" * 32), 0, b"abc")
    topic = measure_bag(path).topics[0]
    assert expected in topic.problem
    assert (topic.count, topic.fields) == (1, ())


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ("int8[] a\n", b"\xff\xff\xff\xffab"),
        ("string a\n", b"\xff\xff\xff\xffab"),
        ("h/E[] a\n", b"\xff\xff\xff\xff!"),
        ("string[999999999999] a\n", b"\1\0\0\0ab"),
        ("float64[999999999999] a\n", b"\1\0\0\0ab"),
        ("h/S[999999999999] a\n", b"\1\0\0\0ab"),
        ("h/S[] a\n", b"\xff\xff\xff\xffab"),
        ("h/P[] a\n", b"\xff\xff\xff\xff" + bytes(200)),
        ("h/E[999999999999] a\n", b"!"),
    ],
)
def test_hostile_lengths(tmp_path, text, data):
    path = tmp_path / "hostile.bag"
    others = {"h/E": "int8 ONLY=1\n", "h/S": "string s\n", "h/P": "int8 a\nint32 b\n"}
    whole = text + "".join(f"{'=' * 80}\nMSG: {name}\n{other}" for name, other in others.items())
    with rosbag1.Writer(path) as bag:
        bag.write(bag.add_connection("/a", "h/msg/B", msgdef=whole, md5sum="0" * 32), 0, data)
    assert measure_bag(path).topics[0].unlike == 1


def test_an_idl_definition(tmp_path):
    from mcap.writer import Writer

    idl = (
        f"{'=' * 80}\nIDL: quay_msgs/msg/Pier\nmodule quay_msgs {{ module msg {{ struct Pier {{\n"
        "  quay_msgs::msg::Post post; sequence<double> depths; }; }; };\n"
        f"{'=' * 80}\nIDL: quay_msgs/msg/Post\nmodule quay_msgs {{ module msg {{ struct Post {{ long a; }}; }}; }};\n"
    )
    path = tmp_path / "idl.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start(profile="ros2")
        schema = writer.register_schema(name="quay_msgs/msg/Pier", encoding="ros2idl", data=idl.encode())
        channel = writer.register_channel(schema_id=schema, topic="/pier", message_encoding="cdr")
        data = b"\0\1\0\0\5\0\0\0\1\0\0\0" + bytes(8)
        writer.add_message(channel_id=channel, log_time=0, data=data, publish_time=0)
        writer.finish()
    fields = measure_bag(path).topics[0].fields
    assert [(field.field, field.filled, field.nonzero) for field in fields] == [
        ("post.a", True, True), ("depths", True, False),
    ]  # fmt: skip


def break_cut(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])


def break_empty(path):
    path.write_bytes(b"")


def break_middle(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 4 : len(data) // 2] = b"\xa5" * (len(data) // 2 - len(data) // 4)
    path.write_bytes(data)


def break_all(path):
    path.write_bytes(b"\x5a" * 5_000)


@pytest.mark.parametrize("damage", [break_cut, break_empty, break_middle, break_all])
def test_damaged_bags(quay, tmp_path, damage):
    form, path = quay
    if form == "rosbag":
        file = copy = shutil.copy(path, tmp_path / "copy.bag")
    else:
        copy = shutil.copytree(path, tmp_path / "copy")
        file = next(each for each in copy.iterdir() if each.suffix in (".mcap", ".db3"))
    damage(file)
    found = run_fields("--bag", copy)
    assert (found.exit_code, found.stdout) == (2, "")
    assert found.stderr.startswith(f"rosimpact: {copy}: ")
    assert found.stderr.count("\n") == 1
    assert any(word in found.stderr for word in ("reindex`", "recover`", "`sqlite3 FILE .recover`")), found.stderr


def drop_index(path, tmp_path, size=None):
    data = bytearray(path.read_bytes())[:size]
    at = data.index(b"index_pos=") + len("index_pos=")
    data[at : at + 8] = bytes(8)
    copy = tmp_path / "copy.bag.active"
    copy.write_bytes(data)
    return copy


def test_a_recording_of_ros_1_that_was_not_closed(tmp_path):
    store = make_store()
    path = write_bag(tmp_path, "rosbag", make_quays(store, 8_000), store=store)
    found = measure_bag(path)
    assert measure_bag(drop_index(path, tmp_path)) == found

    cut = drop_index(path, tmp_path, path.stat().st_size * 2 // 3)
    failed = run_fields("--bag", cut)
    assert (failed.exit_code, failed.stderr.count("\n")) == (2, 1)
    said = re.search(r"damaged after ([\d,]+) messages: it ends in the middle .* with --limit (\d+)", failed.stderr)
    assert said is not None, failed.stderr
    assert int(said[2]) > 1_000
    assert measure_bag(cut, limit=int(said[2])).count == int(said[2])


def test_messages_of_ros_1_are_those_that_rosbags_reads(tmp_path):
    store = make_store()
    rows = [*make_quays(store, 3_000), *make_quays(store, 10)]
    path = write_bag(tmp_path, "rosbag", rows, store=store, compression=(rosbag1.Writer.CompressionFormat.LZ4,))
    with rosbag1.Reader(path) as bag:
        expected = sorted((each.topic, time, bytes(data)) for each, time, data in bag.messages())
    with RosbagFile(path) as bag:
        wanted = {number for number, each in bag.connections.items() if each.topic == "/quay"}
        found = [(bag.connections[number].topic, *rest) for number, *rest in bag.read_messages(bag.connections)]
        assert [row[0] for row in found].count("/quay") == len(list(bag.read_messages(wanted))) == bag.count - 2
    assert sorted(found) == expected
    assert len(expected) == bag.count == 3_012


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (b"#ROSBAG V2.0", b"#ROSBAG V1.2", "its format is 1.2, not supported; convert it"),
        (b"#ROSBAG V2.0", b"#ROSBUG V2.0", "it does not begin as a bag does"),
        (b"compression=none", b"compression=nine", "compression by nine is not supported; convert it"),
        (b"op=\x02", b"op\x02=", "a chunk holds what is no record"),
    ],
)
def test_parts_of_a_bag_of_ros_1_that_are_not_read(quay, tmp_path, old, new, expected):
    form, path = quay
    if form != "rosbag":
        return
    copy = tmp_path / "copy.bag"
    copy.write_bytes(path.read_bytes().replace(old, new))
    with pytest.raises(BagError, match=expected):
        measure_bag(copy)


@given(st.binary(max_size=30), st.integers(0, 100_000), st.booleans())
def test_any_bytes_of_a_bag_are_read_or_refused(small_bag, noise, at, cut):
    folder, data = small_bag
    at %= len(data)
    (folder / "noise.bag").write_bytes(data[:at] + noise + (b"" if cut else data[at + len(noise) :]))
    with contextlib.suppress(BagError):
        assert measure_bag(folder / "noise.bag").count <= 40


@pytest.fixture(scope="module")
def small_bag(tmp_path_factory):
    folder = tmp_path_factory.mktemp("small")
    store = make_store()
    return folder, write_bag(folder, "rosbag", make_quays(store, 5), store=store).read_bytes()


METADATA = [
    ("rosbag2_bagfile_information: {relative_file_paths: [gone.db3]}\n", "gone.db3 is not there; copy the whole"),
    ("rosbag2_bagfile_information: {relative_file_paths: []}\n", "names no file"),
    ("rosbag2_bagfile_information: 5\n", "does not name the files of a bag; make it anew with `ros2 bag reindex`"),
    ("a: [\n", "make it anew with `ros2 bag reindex`"),
]


@pytest.mark.parametrize(("text", "expected"), METADATA)
def test_damaged_metadata(tmp_path, text, expected):
    (tmp_path / "metadata.yaml").write_text(text)
    found = run_fields("--bag", tmp_path)
    assert (found.exit_code, found.stderr.count("\n")) == (2, 1)
    assert f"{tmp_path}/metadata.yaml" in found.stderr
    assert expected in found.stderr


def test_what_is_no_bag(tmp_path):
    (tmp_path / "notes.txt").write_text("x")
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe.mcap")
    for name, expected in {
        "notes.txt": "is no bag; name a .bag, .mcap or .db3 file, or the folder of a bag",
        "folder": "holds no metadata.yaml and no .mcap or .db3 file",
        "pipe.mcap": "not a regular file",
        "gone.bag": "No such file or directory; name a .bag",
    }.items():
        found = run_fields("--bag", tmp_path / name)
        assert (found.exit_code, found.stderr.count("\n")) == (2, 1)
        assert f"{name}: {expected}" in found.stderr


def test_a_library_that_is_missing(quay, monkeypatch):
    form, path = quay
    if form == "rosbag":
        return
    for module in [one for one in sys.modules if one.partition(".")[0] == "rosbags"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "rosbags", None)
    found = run_fields("--bag", path)
    assert found.exit_code == 2
    assert "needs the Python package `rosbags`; install it with `pip install 'rosimpact[bags]'`" in found.stderr


def test_a_part_that_unpacks_to_too_much(tmp_path, monkeypatch):
    monkeypatch.setattr("rosimpact.impact.analysis.bag_files.get_limits", lambda: LIMITS)
    store = make_store({"quay_msgs/Blob": "uint8[] data\n"})
    rows = [("/blob", "quay_msgs/Blob", 1.0, b"\0\1\0\0\0\xe1\xf5\5" + bytes(100_000_000))]
    how = (rosbag2.CompressionMode.STORAGE, rosbag2.CompressionFormat.ZSTD)
    path = write_bag(tmp_path, "mcap", rows, store=store, compression=how)
    with pytest.raises(BagError, match="needs too much memory; allow more with ROSIMPACT_LIMITS=bag=8GB"):
        measure_bag(path)


class LIMITS:
    bag = 50_000_000
    capture = 1_000_000


def test_progress_is_told_on_standard_error(tmp_path):
    store = make_store()
    berth = bytes(store.serialize_cdr(make_message(store, "quay_msgs/Berth"), "quay_msgs/msg/Berth"))
    rows = (("/berth", "quay_msgs/Berth", at / 1000, berth) for at in range(12_000))
    path = write_bag(tmp_path, "mcap", rows, store=store)
    told = []
    measure_bag(path, progress=lambda *what: told.append(what))
    assert told == [(f"reading {path.name}", at, 12_000) for at in (5_000, 10_000, 12_000)]
    assert run_fields("--bag", path).stderr == f"reading {path.name}\n"
    assert run_fields("--bag", path, "--quiet").stderr == ""


def test_many_sizes_are_counted_in_steps(tmp_path, monkeypatch):
    monkeypatch.setattr("rosimpact.impact.analysis.bags._SIZES_AT_MOST", 100)
    store = make_store({"quay_msgs/Text": "string text\n"})
    store.register(get_types_from_msg("string text\n", "quay_msgs/msg/Text"))
    texts = (make_message(store, "quay_msgs/Text", text="x" * at) for at in range(1_000))
    rows = (("/text", "quay_msgs/Text", at / 10, text) for at, text in enumerate(texts))
    sizes = measure_bag(write_bag(tmp_path, "rosbag", rows, store=store)).topics[0].bytes
    assert sizes.mean == 4 + 499.5
    assert 500 <= sizes.p50 <= 520
    assert 950 <= sizes.p95 <= 970
