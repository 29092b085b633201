"""Keys of our own code: a key changes with the module and with what it imports, and with nothing else."""

import os

import pytest
from rosimpact.databuild.extract import cpp, parameters, python
from rosimpact.impact import source_keys
from rosimpact.impact.facts import kinds
from rosimpact.impact.source_keys import compute_keys, compute_source_key

SOURCES = {
    "impact.facts.__init__": b"",
    "impact.facts.place": b"import msgspec\n",
    "impact.facts.cpp": b"from .place import Problem\n",
    "impact.facts.python": b"from . import python2, place\nimport ast\n",
    "impact.facts.room.__init__": b"from .inner import a\n",
    "impact.facts.room.inner": b"",
    "impact.facts.guest": b"from . import room\n",
    "impact.facts.python2": b"from ...edges.limits import (\n    limits,\n    other,\n)\n",
    "impact.facts.late": b"def read():\n    from .cpp import extract\n",
    "impact.facts.typed": b"if TYPE_CHECKING:\n    from .cpp import extract\n",
    "impact.facts.table": b'TABLE = Path(__file__).with_name("rows.toml")\n',
    "impact.facts/rows.toml": b"",
    "impact.facts.compiled": b"\0\1",
    "impact.facts.circle": b"from .around import a\n",
    "impact.facts.around": b"from .circle import b\n",
    "edges.limits": b"",
}
CHANGES = [
    ("impact.facts.cpp", {"cpp", "late"}),
    ("impact.facts.place", {"place", "cpp", "python", "late"}),
    ("impact.facts.python2", {"python", "python2"}),
    ("impact.facts.typed", {"typed"}),
    ("impact.facts.room.inner", {"inner", "room", "guest"}),
    ("impact.facts/rows.toml", {"table"}),
    ("impact.facts.around", {"around", "circle"}),
    ("edges.limits", {"python", "python2"}),
    ("impact.facts.__init__", {"facts"}),
]


def changed(before, after):
    """Last parts of the modules whose keys differ."""
    names = (name for name in before if "/" not in name and before[name] != after[name])
    return {name.removesuffix(".__init__").rpartition(".")[2] for name in names} - {"limits"}


@pytest.mark.parametrize(("module", "expected"), CHANGES)
def test_a_change_reaches_the_modules_that_import_it(module, expected):
    before = compute_keys(SOURCES, lambda library: "1")
    after = compute_keys({**SOURCES, module: SOURCES[module] + b"# changed\n"}, lambda library: "1")
    assert changed(before, after) == expected | {"compiled"}  # what it imports cannot be seen


def test_a_library_reaches_the_modules_that_import_it():
    before, after = compute_keys(SOURCES, lambda library: "1"), compute_keys(SOURCES, lambda library: "2")
    assert changed(before, after) == {"place", "cpp", "python", "late", "compiled"}


def sources():
    return {name: open(path, "rb").read() for name, path, _ in source_keys._list_sources()}


PARAMETERS = set(map(parameters.make_kind, parameters.LIMITS))
# A module of each extractor that no other extractor imports, and the kinds that it makes.
EXTRACTORS = [
    ("impact.facts.interface", {"msg", "srv", "action", "idl"}),
    ("impact.facts.manifest", {"manifest", "manifest_variant"}),
    ("impact.facts.cmake", {"cmake"}),
    ("impact.facts.launch.python_calls", {"flow_launch_xml", "flow_launch_yaml", "flow_launch_python"}),
    ("impact.facts.nodl", {"flow_nodl"}),
    ("impact.facts.reconfigure", {"flow_reconfigure"}),
    ("databuild.extract.cpp_enums", {cpp.__name__}),
    ("databuild.extract.python", {python.__name__}),
    ("databuild.extract.parameters", PARAMETERS),
]
KINDS = (*kinds.EXTRACTORS, cpp.__name__, python.__name__, *PARAMETERS)


@pytest.mark.parametrize(("module", "expected"), EXTRACTORS)
def test_one_line_of_an_extractor_changes_its_key_alone(monkeypatch, module, expected):
    found = sources()
    before = {kind: kinds.make_version(kind) for kind in KINDS}
    found[module] += b"_ADDED = 1\n"
    keys = compute_keys(found, lambda library: "")
    unchanged = compute_keys(sources(), lambda library: "")
    monkeypatch.setattr(source_keys, "_load_keys", lambda: keys)
    after = {kind: kinds.make_version(kind) for kind in KINDS}
    monkeypatch.setattr(source_keys, "_load_keys", lambda: unchanged)
    again = {kind: kinds.make_version(kind) for kind in KINDS}
    assert {kind for kind in after if after[kind] != again[kind]} == expected
    assert len(set(before.values())) == len(before)


@pytest.fixture
def anew(monkeypatch, tmp_path):
    """Works out the keys again, with a cache folder of its own."""
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path))
    monkeypatch.setattr(source_keys, "cache_folder", lambda: tmp_path)
    yield source_keys._load_keys.__wrapped__
    assert not [name for name in os.listdir(tmp_path) if not name.startswith("code-")]


def test_keys_are_remembered_until_a_file_changes(anew, monkeypatch, tmp_path):
    first = anew()
    worked_out = []
    monkeypatch.setattr(source_keys, "compute_keys", lambda *found: worked_out.append(found) or {"impact.memo": "new"})
    assert anew() == first and not worked_out
    state = source_keys._compute_state
    monkeypatch.setattr(source_keys, "_compute_state", lambda libraries: state(libraries)[:-1])
    assert anew() == {"impact.memo": "new"} and len(worked_out) == 1


@pytest.mark.parametrize("data", [b"", b"\xc1", b"not what it was"])
def test_a_damaged_memory_is_worked_out_again(anew, tmp_path, data):
    first = anew()
    (place,) = tmp_path.iterdir()
    place.write_bytes(data)
    assert anew() == first


def test_a_memory_with_another_name_in_it_is_worked_out_again(anew, tmp_path):
    first = anew()
    (place,) = tmp_path.iterdir()
    data = place.read_bytes()
    place.write_bytes(data.replace(b"impact.source_keys", b"impact.source_kezs"))
    assert place.read_bytes() != data
    assert anew() == first


def test_what_cannot_be_looked_at_is_never_read_back(anew, monkeypatch):
    def fails():
        raise NotADirectoryError(20, "Not a directory")

    monkeypatch.setattr(source_keys, "_list_sources", fails)
    one, other = anew(), anew()
    assert one["impact.memo"] == one["impact.memo"] != other["impact.memo"]


def test_a_module_that_is_not_there_has_no_key():
    with pytest.raises(KeyError):
        compute_source_key("rosimpact.impact.nothing")
