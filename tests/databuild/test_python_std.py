"""What versions of Python's library offer, by states of stubs: conditions, lifetimes, stubs that were completed."""

from pathlib import Path

import pytest
from rosimpact.databuild.python_std import Stubs, pack_versions, read_versions
from rosimpact.impact.targets.surface.changes import Line
from rosimpact.impact.targets.surface.python import SurfaceNames
from rosimpact.impact.targets.surface.store import SurfaceHistory
from rosimpact.impact.targets.unpacked import read_packed

# The first state tells of 3.6 to 3.9, the second of 3.8 to 3.11.
OLD = {
    "VERSIONS": "drum: 3.0-\n_drum: 3.0-\nflute: 3.0-3.8 # gone\nband.stage: 3.7-\nband: 3.0-\nharp: 3.9-\n",
    "drum.pyi": """import sys
from _drum import beat as beat
if sys.version_info >= (3, 8):
    class Stick: ...
else:
    from _drum import *
_T = int
class Kit:
    size: int
    def hit(self, __how: int, soft: bool = ...) -> None: ...
    if sys.version_info < (3, 9):
        def isLoud(self) -> bool: ...
if sys.version_info >= (3, 8):
    def roll(long: int, *, fast: bool = ...) -> None: ...
elif sys.version_info >= (3, 7):
    def roll(long: int) -> None: ...
if sys.platform == "win32":
    def beep() -> None: ...
""",
    "_drum.pyi": "import sys\ndef beat(): ...\nif sys.version_info < (3, 8):\n    class Stick: ...\n",
    "flute.pyi": "def play(): ...\n",
    "harp.pyi": "def pluck(): ...\n",
    "band/__init__.pyi": "",
    "band/stage.pyi": "LIGHTS: int\n",
}
NEW = {
    "VERSIONS": "drum: 3.0-\n_drum: 3.0-\nflute: 3.0-3.8\nband.stage: 3.7-\nband: 3.0-\nharp: 3.9-\ncello: 3.0-\n",
    "drum.pyi": """import sys
from typing import overload
from typing_extensions import deprecated
from _drum import beat as beat, Rack, stool
__all__ = ["beat", "stool"]
class Stick: ...
class Kit(Rack):
    size: int
    weight: int
    def hit(self, how: int, /, soft: bool = False) -> None: ...
    if sys.version_info < (3, 9):
        def isLoud(self) -> bool: ...
def roll(long: int, *, fast: bool = False) -> None: ...
@overload
def tune(to: int) -> int: ...
@overload
def tune(to: str, by: int) -> str: ...
if sys.version_info >= (3, 11):
    def muffle() -> None: ...
    @deprecated("Mute yourself.")
    def mute() -> None: ...
else:
    def mute() -> None: ...
@deprecated("Long ago.")
def thump() -> None: ...
""",
    "_drum.pyi": "def beat(): ...\ndef stool(): ...\nclass Rack:\n    def fold(self): ...\n",
    "flute.pyi": "def play(): ...\n",
    "harp.pyi": "def pluck(): ...\n",
    "cello.pyi": "def bow(): ...\n",
    "band/__init__.pyi": "import sys\nif sys.version_info >= (3, 9):\n    def tour() -> None: ...\n",
    "band/stage.pyi": "LIGHTS: int\n",
}


def write(folder: Path, files: dict[str, str]) -> Stubs:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return Stubs(folder)


@pytest.fixture(scope="module")
def history(tmp_path_factory) -> tuple[SurfaceHistory, Line]:
    states = [write(tmp_path_factory.mktemp(name), files) for name, files in (("old", OLD), ("new", NEW))]
    assert [state.span for state in states] == [(6, 9), (8, 11)]
    (packed,) = pack_versions(read_versions(states)).values()
    return SurfaceHistory("python", packed.data, packed.includes), read_packed(packed.changes, Line)


@pytest.mark.parametrize(
    ("name", "versions"),
    [
        ("drum.beat", "6 7 8 9 10 11"),
        ("drum.Kit.isLoud", "6 7 8"),
        ("drum.roll", "7 8 9 10 11"),
        ("drum.muffle", "11"),
        ("drum.beep", ""),
        # What a stub imports for itself is not there for others, but tells what its classes are.
        ("drum.Rack", "6 7"),  # the old state takes all of that module
        ("drum.stool", "6 7 8 9 10 11"),
        ("drum.Kit.fold", "6 7 8 9 10 11"),
        ("drum.sys", ""),
        # It stood in another module up to 3.7.
        ("drum.Stick", "6 7 8 9 10 11"),
        ("flute", "6 7 8"),
        ("harp.pluck", "9 10 11"),
        ("band.stage.LIGHTS", "7 8 9 10 11"),
        ("band.tour", "9 10 11"),
        # The first state did not have them yet, which is no change of Python.
        ("drum.Kit.weight", "6 7 8 9 10 11"),
        ("drum.tune", "6 7 8 9 10 11"),
        ("cello.bow", "6 7 8 9 10 11"),
    ],
)
def test_which_versions_have_a_name(history, name, versions):
    stored, _ = history
    found = [v for v in stored.versions if SurfaceNames(stored.load_python(v)).find(name) is not None]
    assert [v.removeprefix("3.") for v in found] == versions.split()


def test_what_changed_is_told_of_each_version(history):
    stored, line = history
    told = {name: [stored.versions[event.place] for event in events] for name, events in line.events["python"].items()}
    assert told == {
        "band.stage": ["3.7"], "band.stage.LIGHTS": ["3.7"], "band.tour": ["3.9"], "drum.Kit.isLoud": ["3.9"],
        "drum.muffle": ["3.11"], "drum.mute": ["3.11"], "drum.roll": ["3.7", "3.8"], "flute": ["3.9"],
        "harp": ["3.9"], "harp.pluck": ["3.9"],
    }  # fmt: skip


def test_since_when_something_is_deprecated_is_known_by_a_condition(history):
    stored, _ = history

    def find_message(name: str, version: str) -> str:
        entry = SurfaceNames(stored.load_python(version)).find(name)
        assert entry is not None and entry.bound is not None
        return entry.bound.deprecated

    assert [find_message("drum.mute", version) for version in ("3.10", "3.11")] == ["", "Mute yourself."]
    assert find_message("drum.thump", "3.11") == ""


def test_parameters(history):
    stored, _ = history

    def list_parameters(name: str, version: str) -> list[tuple[str, str]]:
        entry = SurfaceNames(stored.load_python(version)).find(name)
        assert entry is not None and entry.bound is not None
        return [(one.name, one.kind) for one in entry.bound.parameters]

    assert list_parameters("drum.roll", "3.7") == [("long", "normal")]
    assert list_parameters("drum.roll", "3.10") == [("long", "normal"), ("fast", "keyword")]
    assert list_parameters("drum.Kit.hit", "3.10") == [("how", "positional"), ("soft", "normal")]
    assert list_parameters("drum.tune", "3.10") == [("args", "args"), ("kwargs", "kwargs")]
