"""The doors to the file system: what is read, what is written, what is refused, and what is left when writing fails."""

import errno
import os
import pathlib
import resource
import signal
import socket
import stat
import subprocess
import sys
import textwrap
import threading
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.edges import files

OLD, NEW = b"old\n" * 1000, b"new"


@pytest.fixture
def room(tmp_path):
    return furnish(tmp_path)


def furnish(tmp_path):
    """A workspace of many kinds of things, beside what must stay as it is."""
    outside = tmp_path / "outside"
    (outside / "folder").mkdir(parents=True)
    (outside / "secret").write_bytes(OLD)
    (outside / "folder/f").write_bytes(OLD)
    ws = tmp_path / "ws"
    for folder in ("sub", ".git", "sub/.GIT", "empty"):
        (ws / folder).mkdir(parents=True)
    for file in ("plain", "sub/f", ".git/config", "locked"):
        (ws / file).write_bytes(OLD)
    (ws / "locked").chmod(0o444)
    os.mkfifo(ws / "pipe")
    with socket.socket(socket.AF_UNIX) as made, here(ws):
        made.bind("socket")
    (ws / "zero").symlink_to("/dev/zero")
    (ws / "out").symlink_to(outside / "secret")
    (ws / "inner").symlink_to("plain")
    (ws / "dangling").symlink_to(outside / "not there")
    (ws / "loop").symlink_to("loop")
    (ws / "away").symlink_to(outside / "folder")
    (ws / "round").symlink_to("sub")
    (ws / "history").symlink_to(".git")
    return ws


class here:
    def __init__(self, folder):
        self.folder = folder

    def __enter__(self):
        self.back = os.getcwd()
        os.chdir(self.folder)

    def __exit__(self, *_):
        os.chdir(self.back)


def state(folder):
    """Everything in a folder: kind, permissions and content."""
    found = {}
    for place, folders, names in os.walk(folder):
        for name in (*folders, *names):
            path = os.path.join(place, name)
            status = os.lstat(path)
            regular = stat.S_ISREG(status.st_mode)
            content = (
                pathlib.Path(path).read_bytes() if regular else os.readlink(path) if os.path.islink(path) else None
            )
            found[path] = status.st_mode, content
    return found


# (path in the workspace, error when it is read)
UNREADABLE = [
    ("pipe", errno.EINVAL),
    ("socket", errno.EINVAL),
    ("zero", errno.EINVAL),
    ("sub", errno.EISDIR),
    ("dangling", errno.ENOENT),
    ("loop", errno.ELOOP),
    ("plain/x", errno.ENOTDIR),
    ("nul\0l", errno.EINVAL),
    ("half\ud800", errno.EINVAL),
    ("x" * 5000, errno.ENAMETOOLONG),
]


@pytest.mark.parametrize(("name", "number"), UNREADABLE)
def test_what_is_no_regular_file_is_not_read(room, name, number):
    for read in (
        lambda path: files.read_file(path, 100),
        lambda path: files.read_start(path, 10),
        lambda path: list(files.read_chunks(path)),
        lambda path: files.read_text(path, 100),
    ):
        with pytest.raises(OSError) as raised:
            read(f"{room}/{name}")
        assert raised.value.errno == number


def test_reading_keeps_to_its_limit(room):
    assert files.read_file(room / "plain", len(OLD)) == OLD
    assert files.read_file(room / "inner", len(OLD)) == OLD
    assert files.read_start(room / "plain", 5) == OLD[:5]
    assert b"".join(files.read_chunks(room / "plain", 7)) == OLD
    assert files.read_file("/proc/self/status", 1 << 20).startswith(b"Name:"), "files that say they are empty"
    with pytest.raises(OSError, match="larger than 1000 bytes"):
        files.read_file(room / "plain", 1000)
    with pytest.raises(OSError, match="larger than 20 bytes"):
        files.read_file("/proc/self/status", 20)
    with pytest.raises(OSError) as raised:
        files.read_file(room / "inner", len(OLD), follow=False)
    assert raised.value.errno == errno.EINVAL


# (path in the workspace, why it is refused; also when the user names it without a folder that must hold it)
REFUSED = [
    ("out", "is a link", True),
    ("inner", "is a link", True),
    ("dangling", "is a link", True),
    ("loop", "is a link", True),
    ("zero", "is a link", True),
    ("pipe", "not a regular file", True),
    ("socket", "not a regular file", True),
    ("sub", "is a folder", True),
    ("sub/", "is a folder", True),
    ("new/.", "is a folder", True),
    ("locked", "is read-only", True),
    (".git/config", r"\.git folder", True),
    (".git", r"\.git folder", True),
    ("sub/.GIT/hooks/new", r"\.git folder", True),
    ("sub/.Git", r"\.git folder", True),
    (".g\u200cit/config", r"\.git folder", True),
    ("GIT~1/config", r"\.git folder", True),
    ("history/config", r"\.git folder|`history` on the way is a link", True),
    ("history/new/x", r"\.git folder|`history` on the way is a link", True),
    ("plain/x", "no folder|Not a directory|File exists", True),
    ("nul\0l", "no name that a file can have", True),
    ("half\ud800", "no name that a file can have", True),
    ("x" * 300, "File name too long", True),
    ("away/f", "`away` on the way is a link", False),
    ("away/new", "`away` on the way is a link", False),
    ("round/f", "`round` on the way is a link", False),
    ("../outside/secret", "outside of the folder", False),
    ("sub/../plain", "outside of the folder", False),
    ("../ws/plain", "outside of the folder", False),
    (".", "is a folder", True),
]


@pytest.mark.parametrize("relative", [False, True])
@pytest.mark.parametrize(("name", "why", "always"), REFUSED)
def test_what_is_not_written(room, name, why, always, relative):
    before = state(room.parent)
    path, root = (name, ".") if relative else (f"{room}/{name}", room)
    with here(room):
        for beneath in (root, None)[: 1 + always]:
            with pytest.raises(OSError, match=why):
                files.write_file(path, NEW, beneath=beneath)
        if always:
            with pytest.raises(OSError, match=why), files.open_for_replacing(path) as file:
                file.write(NEW)
            if len(name) < 255:
                with pytest.raises(OSError, match=why):
                    files.check_writable_path(path)
        if len(name) < 255:
            with pytest.raises(OSError, match=why):
                files.check_writable_path(path, beneath=root)
    assert state(room.parent) == before, "nothing is touched, not even a folder is made"


WRITTEN = [
    "plain",
    "sub/f",
    "new",
    "sub/deep/er/new",
    ".github/workflows/x.yml",
    ".gitignore",
    "a.git/x",
    "\udcff\xe4 '",
]


@pytest.mark.parametrize("name", WRITTEN)
@pytest.mark.parametrize("relative", [False, True])
def test_what_is_written(room, name, relative):
    path, root = (name, ".") if relative else (f"{room}/{name}", room)
    with here(room):
        for beneath, data in ((root, NEW), (None, OLD)):
            files.check_writable_path(path, beneath=beneath)
            files.write_file(path, data, beneath=beneath)
            assert files.read_file(path, 1 << 20) == data
        with files.open_for_replacing(path) as file:
            file.write(b"one ")
            file.write(b"two")
        assert files.read_file(path, 1 << 20) == b"one two"
        assert not [name for name in os.listdir(os.path.dirname(path) or ".") if name.endswith(".part")]


def test_folders_that_the_user_names_may_be_links(room):
    files.check_writable_path(room / "away/f")
    files.write_file(room / "away/f", NEW)
    assert (room.parent / "outside/folder/f").read_bytes() == NEW


@pytest.mark.parametrize("mode", [0o600, 0o644, 0o755, 0o640])
def test_permissions_stay(room, mode):
    (room / "plain").chmod(mode)
    files.write_file(room / "plain", NEW, beneath=room)
    assert stat.S_IMODE((room / "plain").stat().st_mode) == mode


def test_other_names_of_a_file_keep_the_old_content(room):
    secret = room.parent / "outside/secret"
    os.link(secret, room / "same")
    files.write_file(room / "same", NEW, beneath=room)
    assert secret.read_bytes() == OLD and (room / "same").read_bytes() == NEW
    assert secret.stat().st_nlink == 1


def test_a_long_name_leaves_room_for_the_temporary_one(room):
    name = "\u20ac" * 85
    files.write_file(room / name, NEW, beneath=room)
    assert (room / name).read_bytes() == NEW


@pytest.mark.parametrize("present", [OLD + b"x", OLD[:-1] + b"x", b"", None])
def test_a_file_that_changed_since_is_left_alone(room, present):
    if present is None:
        (room / "plain").unlink()
    else:
        (room / "plain").write_bytes(present)
    before = state(room)
    with pytest.raises(OSError, match=files.CHANGED):
        files.write_file(room / "plain", NEW, beneath=room, instead_of=OLD)
    assert state(room) == before
    files.write_file(room / "sub/f", NEW, beneath=room, instead_of=OLD)
    assert (room / "sub/f").read_bytes() == NEW


def test_a_block_that_fails_leaves_the_old_file(room):
    before = state(room)
    for error in (ValueError, KeyboardInterrupt):
        with pytest.raises(error), files.open_for_replacing(room / "plain") as file:
            file.write(NEW)
            raise error
    assert state(room) == before


def test_a_full_disk_leaves_the_old_file(room):
    before = state(room)
    kept = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, kept[1]))
    try:
        for beneath in (room, None):
            with pytest.raises(OSError, match="File too large"):
                files.write_file(room / "plain", b"x" * 100_000, beneath=beneath)
        with pytest.raises(OSError), files.open_for_replacing(room / "plain") as file:
            file.write(b"x" * 100_000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, kept)
    assert state(room) == before


def test_killed_at_any_moment_the_file_is_old_or_new(room):
    """A process that writes all the time is killed; what is there is whole."""
    code = """
        import sys
        from rosimpact.edges.files import write_file
        print("ready", flush=True)
        while True:
            for sign in (b"a", b"b"):
                write_file(sys.argv[1], sign * 300_000, beneath=sys.argv[2])
    """
    file = room / "sub/f"
    for wait in (0.0, 0.003, 0.01, 0.02, 0.05):
        command = [sys.executable, "-c", textwrap.dedent(code), str(file), str(room)]
        with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
            assert process.stdout is not None and process.stdout.readline()
            time.sleep(wait)
            process.send_signal(signal.SIGKILL)
        data = file.read_bytes()
        assert data == OLD or (len(data) == 300_000 and len(set(data)) == 1)


def test_a_folder_that_becomes_a_link_leads_nowhere(room):
    """While files are written, somebody puts a link in the place of a folder on the way, again and again."""
    real, link = room / "sub", room / "link"
    link.symlink_to(room.parent / "outside/folder")
    victim = room.parent / "outside/folder/f"
    before = victim.stat()
    stop = threading.Event()

    def swap():
        while not stop.is_set():
            os.rename(real, room / "aside")
            os.rename(link, real)
            os.rename(real, link)
            os.rename(room / "aside", real)

    other = threading.Thread(target=swap)
    other.start()
    refused = 0
    try:
        end = time.monotonic() + 1
        while time.monotonic() < end:
            try:
                files.write_file(real / "f", OLD, beneath=room, instead_of=OLD)
            except OSError:
                refused += 1
    finally:
        stop.set()
        other.join()
    assert refused, "the link was met"
    assert victim.stat() == before, "not even its number has changed"
    assert os.listdir(victim.parent) == ["f"]


@pytest.mark.parametrize("target", ["/dev/null", "/dev/stdout", "/dev/stderr", "/dev/fd/1", "/proc/self/fd/2"])
def test_streams_are_written_to(target, capfd):
    files.check_writable_path(target)
    files.write_file(target, b"said")
    out, err = capfd.readouterr()
    assert (out, err) == {"1": ("said", ""), "2": ("", "said"), "t": ("said", ""), "r": ("", "said")}.get(
        target[-1], ("", "")
    )


def test_a_descriptor_that_is_not_open_is_refused():
    closed = os.open(os.devnull, os.O_RDONLY)
    os.close(closed)
    with pytest.raises(OSError):
        files.check_writable_path(f"/dev/fd/{closed}")


def test_appending(room):
    for _ in range(2):
        files.append_file(room / "log", NEW)
    assert (room / "log").read_bytes() == NEW * 2
    before = state(room.parent)
    for name in ("out", "dangling", "pipe", "sub", "zero", "socket"):
        with pytest.raises(OSError):
            files.append_file(room / name, NEW)
    assert state(room.parent) == before


@pytest.mark.parametrize(
    ("path", "folders", "expected"),
    [
        ("ws/sub/f", ["ws"], "ws"),
        ("ws/sub/f", ["ws/sub", "ws"], "ws"),
        ("ws/sub/f", ["ws/sub"], "ws/sub"),
        ("ws/new/deep/f", ["ws"], "ws"),
        ("ws/away/f", ["ws"], "ws"),
        ("to ws/sub/f", ["ws"], "to ws"),
        ("outside/f", ["ws", "not there", "nul\0l"], None),
        ("ws", ["ws"], None),
    ],
)
def test_the_folder_that_a_path_lies_in(room, path, folders, expected):
    (room.parent / "to ws").symlink_to(room)
    found = files.find_outermost(f"{room.parent}/{path}", [f"{room.parent}/{each}" for each in folders])
    assert found == (expected and f"{room.parent}/{expected}")


PARTS = st.sampled_from(
    ["sub", "new", "plain", "..", ".", "", "away", "round", "out", ".git", ".GiT", "history", "f", "empty"]
)


@given(st.lists(PARTS, min_size=1, max_size=5), st.booleans())
def test_nothing_outside_and_nothing_of_git_is_ever_written(tmp_path_factory, parts, absolute):
    ws = furnish(tmp_path_factory.mktemp("any"))
    outside, history = state(ws.parent / "outside"), state(ws / ".git")
    path = os.sep.join([str(ws), *parts] if absolute else parts)
    with here(ws):
        try:
            files.write_file(path, NEW, beneath=ws)
        except OSError as error:
            assert error.strerror
    assert state(ws.parent / "outside") == outside and state(ws / ".git") == history
