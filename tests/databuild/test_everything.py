"""`rosimpact data build SOURCES.toml`: which steps run, what is kept, what is said of sources that are not there."""

import json
from pathlib import Path

import pytest
import zstandard
from rosimpact.databuild.everything import STEPS, Sources, build_everything
from rosimpact.databuild.table_manifest import make_manifest
from rosimpact.edges.console import UserError
from rosimpact.impact.targets.tables import DATA, read_manifest

LISTENING = """find_path(EAR_INCLUDE_DIR ear.h)
find_package_handle_standard_args(Ear REQUIRED_VARS EAR_INCLUDE_DIR)
"""
PACKAGE = "<package format='3'><name>ear_cmake</name><version>1.0.0</version></package>"


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    modules = tmp_path / "cmake/Modules"
    modules.mkdir(parents=True)
    (modules / "FindEar.cmake").write_text(LISTENING)
    file = tmp_path / "sources.toml"
    file.write_text('[cmake]\nmodules = ["cmake/Modules"]\n')
    return file


def run(sources: Path, *only: str, again: tuple[str, ...] = ()) -> dict[str, str]:
    """What became of the steps that were not left."""
    home = sources.parent
    built = build_everything(sources, home / "data", home / "work", only, again)
    return {one.step: one.outcome for one in built if one.outcome != "left"}


def test_each_step_comes_behind_those_that_it_reads():
    names = [step.name for step in STEPS]
    assert all(names.index(other) < names.index(step.name) for step in STEPS for other in step.after)


def test_what_has_sources_is_built_once(sources):
    assert run(sources) == {"find-modules": "made"}
    data = sources.parent / "data"
    assert json.loads((data / "find_modules.json").read_bytes()) == {"Ear": {"header": ["ear.h"]}}
    assert (data / "behaviour.json").stat().st_size > 1000  # reviewed tables come along
    assert make_manifest(data, "2026-01-01").tables == read_manifest(data).tables != read_manifest(DATA).tables
    assert run(sources) == {"find-modules": "kept"}
    assert run(sources, again=("find-modules",)) == {"find-modules": "made"}
    assert run(sources, "conda") == {}


@pytest.mark.parametrize(
    ("named", "runs"),
    [({"pypi": True}, True), ({"apt": {"sid": "."}}, True), ({"clones": "."}, True), ({"commands": (".",)}, False)],
)
def test_rows_are_held_against_whatever_was_built(named, runs, tmp_path):
    (superseded,) = (step for step in STEPS if step.name == "superseded")
    assert (superseded.arguments(Sources(**named), tmp_path, tmp_path) is not None) == runs


def test_a_step_is_run_again_when_what_it_reads_changed(sources, tmp_path):
    (tmp_path / "cmakes").mkdir()
    (tmp_path / "cmakes/package.xml").write_text(PACKAGE)
    (tmp_path / "cmakes/ear.cmake").write_text("function(ear_listen)\nendfunction()\n")
    sources.write_text('commands = ["cmakes"]\n')
    assert run(sources) == {"commands": "made"}
    made = zstandard.decompress((tmp_path / "data/commands.json.zst").read_bytes())
    assert b'"ear_listen":"ear_cmake"' in made
    surfaces = tmp_path / "data/surfaces.sqlite"
    surfaces.write_bytes(surfaces.read_bytes() + b"\0" * 512)
    assert run(sources) == {"commands": "made"}


def test_of_a_step_that_fails_the_tables_stay(sources, tmp_path):
    for folder in ("lists", "cmakes"):
        (tmp_path / folder).mkdir()
    sources.write_text('[lists]\n"debian bookworm" = "lists"\n[cmake]\nmodules = ["cmake/Modules"]\n')
    found = {one.step: one for one in build_everything(sources, tmp_path / "data", tmp_path / "work")}
    assert {name: one.outcome for name, one in found.items() if one.outcome != "left"} == {
        "providers": "failed", "apt": "failed", "archive": "failed", "sonames": "failed", "find-modules": "made",
    }  # fmt: skip
    assert "no Contents or no Packages index" in " ".join(found["providers"].said)
    assert (tmp_path / "data/providers.sqlite.zst").read_bytes() == (DATA / "providers.sqlite.zst").read_bytes()
    assert (tmp_path / "work/logs/providers.txt").stat().st_size


def test_steps_whose_sources_are_not_there_are_skipped(sources, tmp_path):
    sources.write_text('clones = "nowhere"\n[lists]\n"debian sid" = "none"\n[cmake]\nmodules = ["cmake/Modules"]\n')
    found = {one.step: one for one in build_everything(sources, tmp_path / "data", tmp_path / "work")}
    assert found["find-modules"].outcome == "made"
    assert {found[name].outcome for name in ("conda", "surfaces", "sonames", "apt")} == {"unreached"}
    assert found["conda"].said == (f"{tmp_path / 'nowhere'} is not there",)
    assert set(found["providers"].said) == {f"{tmp_path / name} is not there" for name in ("none", "nowhere")}
    assert found["snapshot"].outcome == "left"
    assert (tmp_path / "data/conda.json.zst").read_bytes() == (DATA / "conda.json.zst").read_bytes()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('clonse = "."', "unknown field `clonse`"),
        ("clones = [", "sources.toml:1: "),
        ("gcc = 13", "Expected `object`"),
    ],
)
def test_what_is_wrong_with_sources_is_said(sources, text, said):
    sources.write_text(text)
    with pytest.raises(UserError) as told:
        run(sources)
    assert said in str(told.value)


def test_an_unknown_step_is_said_with_those_there_are(sources):
    with pytest.raises(UserError, match="no step `find`; the steps are snapshot, "):
        run(sources, "find")
