"""Modules of each version of Python, from typeshed and from its libraries."""

from pathlib import Path

from rosimpact.databuild.python_modules import build_table, list_modules, read_renamed, read_versions
from rosimpact.impact.targets.providers.stdlib import Modules

VERSIONS = """\
# a comment: 3.0-
abc: 2.7-
asyncio: 3.4-
graphlib: 3.9-  # new
imp: 2.7-3.11
Queues: 3.0-
queue: 2.7-
typing_extensions: 2.7-
xml.sax: 2.7-
"""


def make_folder(home: Path, version: str, *names: str) -> Path:
    place = home / version / "usr/lib" / f"python{version}"
    (place / "lib-dynload").mkdir(parents=True)
    for name in names:
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_text("")
    return home / version


def test_ranges_of_typeshed(tmp_path):
    (tmp_path / "VERSIONS").write_text(VERSIONS)
    found = read_versions(tmp_path)
    assert found["asyncio"] == ((3, 4), None) and found["imp"] == ((2, 7), 11) and "xml.sax" not in found


def test_modules_in_unpacked_libraries(tmp_path):
    folder = make_folder(
        tmp_path, "3.11", "abc.py", "json/__init__.py", "data/file.txt", "lib-dynload/_json.cpython-311.so", "abc.txt"
    )
    assert set(list_modules(folder)) == {"abc", "json", "_json"}


def test_a_table(tmp_path):
    stubs = tmp_path / "stdlib"
    (stubs / "@python2").mkdir(parents=True)
    (stubs / "VERSIONS").write_text(VERSIONS)
    (stubs / "@python2/Queue.pyi").write_text("")
    three = make_folder(tmp_path, "3.11", "abc.py", "asyncio/__init__.py", "graphlib.py", "imp.py", "queue.py")
    fixes = three / "usr/lib/python3.11/lib2to3/fixes"
    fixes.mkdir(parents=True)
    (fixes / "fix_imports.py").write_text("MAPPING = {'Queue': 'queue', 'ConfigParser': 'configparser'}\n")
    two = make_folder(tmp_path, "2.7", "abc.py", "imp.py", "sets.py")
    before = Modules("", "", {}, {12: "imp=importlib"}, "sets=builtins dl=ctypes", "", "")
    assert read_renamed(three) == {"Queue": "queue", "ConfigParser": "configparser"}
    made = build_table([stubs], {(3, 11): three, (2, 7): two}, before)
    assert made.added["graphlib"] == 9 and "asyncio" in made.always.split()
    assert made.removed[12].split() == ["imp=importlib"]
    assert made.python2.split() == ["ConfigParser=configparser", "Queue=queue", "sets=builtins"]
    assert {"queue", "asyncio"} <= set(made.not_in_2.split()) and "abc" not in made.not_in_2.split()
    assert "typing_extensions" not in made.always and "sys" in made.always.split()
