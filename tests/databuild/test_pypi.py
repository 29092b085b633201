"""What versions of a library on PyPI lost or deprecate, told from wheels."""

import subprocess
import zipfile
from pathlib import Path

import pytest
from rosimpact.databuild.pypi import (
    FILE,
    MovedNames,
    OfferedNames,
    find_losses,
    group_losses,
    group_moved,
    main,
    read_versions,
    read_wheel,
)
from rosimpact.databuild.table_file import write_table
from rosimpact.edges.console import UserError
from rosimpact.impact.targets.unpacked import read_table


def make_release(folder, version, files):
    """A wheel of a package `arm`, read. files: sources by path."""
    path = folder / f"arm-{version}-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as wheel:
        for name, text in {"arm/__init__.py": "", **files}.items():
            wheel.writestr(name, text)
        wheel.writestr(f"arm-{version}.dist-info/METADATA", f"Name: arm\nVersion: {version}\n")
    return read_wheel(path, version)


def list_losses(folder, *versions):
    """Names with removed_in and deprecated_in. versions: sources of 1.0, 1.1 and so on."""
    read = [make_release(folder, f"1.{minor}", files) for minor, files in enumerate(versions)]
    return {loss.name: (loss.removed_in, loss.deprecated_in) for loss in find_losses([*map(OfferedNames, read)])}


INIT, STUB, TABLE = "arm/__init__.py", "arm/__init__.pyi", "arm/_gone.py"
REFUSES = """
{table}
def __getattr__(name):
    if name in GONE:
        raise AttributeError(GONE[name])
    if name == "late":
        import warnings
        warnings.warn("late goes", DeprecationWarning)
        return 3
    raise AttributeError(name)
"""


@pytest.mark.parametrize(
    ("before", "after", "lost"),
    [
        ({INIT: "def move(): ..."}, {INIT: ""}, {"arm.move": ("1.1", "")}),
        ({INIT: "def move(): ..."}, {INIT: "from elsewhere import move"}, {}),
        ({INIT: "def move(): ..."}, {INIT: "from arm._own import *", "arm/_own.py": "def move(): ..."}, {}),
        ({INIT: "class Arm:\n    SPEED = 3"}, {INIT: "class Arm: ..."}, {}),
        # What it stands in tells it.
        ({"arm/tool.py": "def open(): ..."}, {}, {"arm.tool": ("1.1", "")}),
        # Private names, those of tests, and what an `__all__` leaves out, are nobody's.
        ({INIT: "def _move(): ...", "arm/tests/test_a.py": "def f(): ...", "arm/_own.py": "A = 1"}, {}, {}),
        ({INIT: "__all__ = ['move']\ndef move(): ...\ndef own(): ..."}, {INIT: "def move(): ..."}, {}),
        # What may be put there in other ways is not surely gone.
        ({INIT: "def move(): ..."}, {INIT: "globals().update(load())"}, {}),
        ({INIT: "def move(): ..."}, {INIT: "from elsewhere import *"}, {}),
        ({INIT: "def move(): ..."}, {INIT: "def __getattr__(name): return load(name)"}, {}),
        ({INIT: "def move(): ..."}, {INIT: "from arm.fast import *", "arm/fast.cpython-310.so": ""}, {}),
        ({INIT: "def move(): ..."}, {INIT: "type x = ?"}, {}),
        ({INIT: "move = 1"}, {INIT: "", "arm/_own.py": "import arm\narm.move = 2"}, {}),
        ({INIT: "def move(): ..."}, {INIT: "__all__ = ['move']"}, {}),
        ({INIT: "def move(): ..."}, {INIT: "__getattr__, *_ = serve(__name__)"}, {}),
        # lazy_loader serves what the stub imports from the package, and that alone.
        ({INIT: "def move(): ...\ndef turn(): ..."},
         {INIT: "import lazy_loader as lazy\n__getattr__, *_ = lazy.attach_stub(__name__, __file__)",
          STUB: "from .way import move", "arm/way.py": "def move(): ...\ndef turn(): ..."},
         {"arm.turn": ("1.1", "")}),
        ({INIT: "def move(): ..."}, {INIT: "def load():\n    global move\n    from fast import move"}, {}),
        # `__getattr__` lists what it raises for, here or in a module beside it.
        ({INIT: "MOVE = 1"}, {INIT: REFUSES.format(table="GONE = {'MOVE': 'use go'}\nfrom elsewhere import *")},
         {"arm.MOVE": ("1.1", ""), "arm.late": ("", "1.1")}),
        ({INIT: "MOVE = 1"}, {INIT: REFUSES.format(table="from ._gone import GONE\nfrom elsewhere import *"),
                              TABLE: "GONE = {'MOVE': 1}"},
         {"arm.MOVE": ("1.1", ""), "arm.late": ("", "1.1")}),
        ({INIT: "late = 1"}, {INIT: REFUSES.format(table="GONE = {}")}, {"arm.late": ("", "1.1")}),
        # A stub tells what is built; it may leave out what it never had, and Python may not see what only a stub has.
        ({STUB: "def move() -> int: ...", INIT: "from elsewhere import *"}, {STUB: "", INIT: "from elsewhere import *"},
         {"arm.move": ("1.1", "")}),
        ({STUB: "def move() -> int: ...", INIT: "from elsewhere import *"},
         {STUB: "", INIT: "from elsewhere import *", "arm/_own.py": "TABLE = {'move': 3}"}, {}),
        ({STUB: "def move() -> int: ...", INIT: "from elsewhere import *"},
         {STUB: "", INIT: "from elsewhere import *", "arm/_own.so": "\0remove\0move\0"}, {}),
        ({STUB: "def move() -> int: ...", INIT: "from elsewhere import *"}, {STUB: "type x = ?"}, {}),
        ({INIT: "def move(): ..."}, {STUB: "", INIT: "from elsewhere import *"}, {}),
        ({STUB: "def move() -> int: ..."}, {}, {}),
        ({"arm/fast.so": "", "arm/fast.pyi": "def move() -> int: ..."}, {"arm/fast.so": "", "arm/fast.pyi": ""},
         {"arm.fast.move": ("1.1", "")}),
        ({"arm/fast.so": "", "arm/fast.pyi": "def move() -> int: ..."}, {"arm/fast.so": ""}, {}),
    ],
)  # fmt: skip
def test_what_is_lost(before, after, lost, tmp_path):
    assert list_losses(tmp_path, before, after) == lost


WARNS = "import warnings\ndef move():\n    warnings.warn('use go', DeprecationWarning)"


def test_a_name_that_comes_back_is_not_lost(tmp_path):
    there = {INIT: "def move(): ..."}
    assert list_losses(tmp_path, there, {}, there) == {}


def test_a_loss_is_told_from_the_version_on_that_surely_lacks_it(tmp_path):
    unknown = {INIT: "from elsewhere import *"}
    versions = [{INIT: "def move(): ..."}, {INIT: WARNS}, unknown, {INIT: "import os"}]
    assert list_losses(tmp_path, *versions[:2], {INIT: "import os"}) == {"arm.move": ("1.2", "1.1")}
    (loss,) = find_losses([OfferedNames(make_release(tmp_path, f"1.{n}", v)) for n, v in enumerate(versions)])
    # It may not have been deprecated at last.
    assert loss == ("arm.move", "1.1", "1.3", "")
    (group,) = group_losses("arm", "arm", [loss])
    assert {key: group[key] for key in ("last_in", "removed_in", "names")} == {
        "last_in": "1.1", "removed_in": "1.3", "names": {"arm.move": ""}
    }  # fmt: skip


def test_versions_of_which_nothing_is_known_hide_no_earlier_loss(tmp_path):
    there, gone = {INIT: "def move(): ..."}, {INIT: "import os"}
    unknown = {INIT: "def __getattr__(name): return load(name)"}

    def tell(*versions):
        read = [OfferedNames(make_release(tmp_path, f"1.{n}", files)) for n, files in enumerate(versions)]
        return [(loss.last_in, loss.removed_in) for loss in find_losses(read)]

    assert tell(there, gone, gone, unknown, gone) == [("1.0", "1.1")]
    # A version alone is not enough, and the newest has to lack it.
    assert tell(there, gone, unknown, gone) == [("1.0", "1.3")]
    assert tell(there, gone, gone, unknown) == []
    assert tell(there, gone, gone, unknown, there) == []


def test_names_that_a_module_lost_before_all_wheels(tmp_path):
    files = {
        "arm/gui.pyi": "class Icon: ...\nclass Kept: ...",
        "arm/widgets.pyi": "class Button: ...\nclass Kept: ...\nOLD_SIGNAL = 1\ndef make(): ...",
        "arm/other.pyi": "class Table: ...",
    }
    release = OfferedNames(make_release(tmp_path, "5.1", files))
    group = group_moved("arm5", MovedNames("arm", "arm.gui", ("arm.widgets",), "5.0", "its guide"), release)
    assert (group["package"], group["removed_in"], group["source"]) == ("arm5", "5.0", "its guide")
    assert group["names"] == {"arm.gui.Button": "arm.widgets.Button"}


def test_versions_between_are_read_where_something_went(tmp_path):
    asked = []

    def load(version):
        asked.append(version)
        return make_release(tmp_path, version, {INIT: "def move(): ..."} if version < "1.5" else {})

    available = [f"1.{minor}.{patch}" for minor in range(10) for patch in range(3)]
    read = read_versions(["1.1.2", "1.2.1", "1.8.0", "3.0"], available, load)
    # Of the others it is clear what they have.
    assert [one.release.version for one in read] == ["1.0.0", "1.1.2", "1.2.1", "1.4.0", "1.5.0", "1.8.0", "1.9.0"]
    assert len(asked) == len(set(asked))


def test_what_has_no_wheel_is_left_out(tmp_path):
    read = read_versions(["1.0.0", "1.2.0"], ["1.0.0", "1.1.0", "1.2.0"], lambda version: None)
    assert read == []


def test_versions_between_without_a_wheel_are_passed_over(tmp_path):
    without = {"1.5.0", "1.4.0"}

    def load(version):
        if version in without:
            return None
        return make_release(tmp_path, version, {INIT: "def move(): ..."} if version < "1.6" else {})

    available = [f"1.{minor}.0" for minor in range(9)]
    read = [one.release.version for one in read_versions(["1.1.0", "1.8.0"], available, load)]
    assert {"1.3.0", "1.6.0"} <= set(read) and not without & set(read)


@pytest.fixture
def pip(monkeypatch, tmp_path):
    """Stands in for pip: it has wheels of each project from 1.0 to 1.2 but of those in `fails`. Returns that."""
    fails = set()

    def run(command, **_):
        asked = command[command.index("--disable-pip-version-check") + 1 :]
        project, _, version = asked[-1].partition("==")
        if project in fails:
            return subprocess.CompletedProcess(command, 1, "", "ERROR: connection reset")
        if asked[0] == "index":
            return subprocess.CompletedProcess(command, 0, "Available versions: 1.2, 1.1, 1.0", "")
        if version == "0.dev0":
            said = "(from versions: 1.0, 1.1, 1.2)\nERROR: No matching distribution found"
            return subprocess.CompletedProcess(command, 1, "", said)
        make_release(
            Path(asked[asked.index("--dest") + 1]), version, {INIT: "" if version > "1.1" else "def move(): ..."}
        )
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr("rosimpact.databuild.pypi.subprocess.run", run)
    monkeypatch.setattr("rosimpact.databuild.pypi.PROJECTS", {"hand": "hand", "foot": "foot"})
    monkeypatch.setattr("rosimpact.databuild.pypi.MOVED", {})
    monkeypatch.setattr("rosimpact.databuild.pypi.list_platform_versions", lambda library: ["1.1", "1.2", "1.7"])
    return fails


def test_a_library_that_cannot_be_read_keeps_its_rows(pip, tmp_path, capsys):
    write_table(tmp_path / FILE, {"changes": [{"package": name, "names": {"old": ""}} for name in ("foot", "hand")]})
    pip.add("hand")
    main([str(tmp_path / "work"), "--output", str(tmp_path)])
    rows = {(group["package"], *group["names"]) for group in read_table(tmp_path / FILE, dict)["changes"]}
    assert rows == {("foot", "arm.move"), ("hand", "old")}
    printed = capsys.readouterr().out
    assert "foot: 3 versions read, 1 names; no wheel of 1.7" in printed
    assert "hand: not read: pip index versions" in printed
    assert printed.splitlines()[-1] == "1 of 2 libraries read; not read: hand"
    # A later run goes on with what is lacking alone.
    pip.clear()
    main([str(tmp_path / "work"), "--output", str(tmp_path)])
    assert capsys.readouterr().out.splitlines()[-3].startswith("3 wheels downloaded")


def test_where_nothing_can_be_read_the_table_stays(pip, tmp_path):
    write_table(tmp_path / FILE, {"changes": []})
    pip.update(("hand", "foot"))
    with pytest.raises(UserError, match="none of 2 libraries could be read"):
        main([str(tmp_path / "work"), "--output", str(tmp_path)])
    assert read_table(tmp_path / FILE, dict) == {"changes": []}
