"""DATA.md tells the truth about what is shipped in impact/targets/data."""

import json
import re
import sqlite3
from pathlib import Path

import pytest
import yaml
import zstandard
from rosimpact.databuild.everything import STEPS
from rosimpact.impact.targets.changes import load_rows, load_transitive
from rosimpact.impact.targets.platform import CODENAMES, find_neighbours
from rosimpact.impact.targets.providers.libraries import load_libraries
from rosimpact.impact.targets.surface.store import load_shipped
from rosimpact.impact.targets.tables import DATA

CARD = (Path(__file__).parents[2] / "DATA.md").read_text(encoding="utf-8")
SNAPSHOT = json.loads((DATA / "snapshot.json").read_text())


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """Rows by table of both databases."""
    rows = {}
    for name in ("distros", "providers"):
        file = tmp_path_factory.mktemp("data") / name
        with (DATA / f"{name}.sqlite.zst").open("rb") as packed, file.open("wb") as unpacked:
            zstandard.ZstdDecompressor().copy_stream(packed, unpacked)
        with sqlite3.connect(file) as database:
            for (table,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall():
                rows[table] = database.execute(f'SELECT count(*) FROM "{table}"').fetchone()[0]
    return rows


@pytest.mark.parametrize("file", sorted(path.name for path in DATA.iterdir() if path.is_file()))
def test_every_file_is_on_the_card(file):
    assert f"`{file}`" in CARD


def test_date_and_sources_are_those_of_the_snapshot():
    assert f"Until **{SNAPSHOT['date']}**." in CARD
    for repository, commit in SNAPSHOT["sources"].items():
        assert re.search(rf"\[{repository}\].*`{commit[:8]}`", CARD), repository


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("distro", r"the (\d+) distros of the index"),
        ("platforms", r"platforms over time \| \d+, (\d+) \|"),
        ("sync", r"the commit that it held \| (\d+) \|"),
        ("package", r"\(([\d,]+) of them\)"),
        ("release", r"([\d,]+) releases \|"),
        ("source", r"status of each repository over time \| ([\d,]+) \|"),
        ("manifest", r"([\d,]+) changes \|"),
        ("rule", r"operating system, moment, packages \| ([\d,]+) \|"),
        ("header", r"([\d,]+) include paths, "),
        ("program", r"([\d,]+) programs"),
        ("pkgconfig", r"([\d,]+) pkg-config files"),
        ("module", r"([\d,]+) Python modules"),
        ("cmake", r"([\d,]+) CMake names; for each"),
        ("ros_header", r"([\d,]+) include paths of"),
        ("ros_package", r"([\d,]+) packages read in all"),
    ],
)
def test_counts_are_those_of_the_tables(tables, table, said):
    found = re.search(said, CARD)
    assert found and int(found[1].replace(",", "")) == tables[table]


def test_surfaces_are_counted():
    about = load_shipped().about
    said = re.search(
        r"`surfaces.sqlite` holds ([\d,]+) packages in ([\d,]+) versions, each that ([\w,\s]+?) released", CARD
    )
    assert said
    assert [int(number.replace(",", "")) for number in said.groups()[:2]] == [about.packages, about.versions]
    assert [name for name in re.findall(r"\w+", said[3]) if name != "and"] == about.distros.split()
    size = re.search(r"^\| `surfaces.sqlite` \|.*\| ([\d.]+) MB \|$", CARD, re.MULTILINE)
    assert size and float(size[1]) == pytest.approx((DATA / "surfaces.sqlite").stat().st_size / 1e6, abs=0.06)
    assert (DATA / "surfaces.sqlite").stat().st_size <= 12_000_000


def test_all_that_is_shipped_is_summed():
    said = re.search(r"^([\d.]+) MB in all", CARD, re.MULTILINE)
    assert said
    assert float(said[1]) == pytest.approx(sum(path.stat().st_size for path in DATA.iterdir()) / 1e6, abs=0.1)


def test_library_versions_are_counted():
    platforms = yaml.safe_load((DATA / "platform_versions.yaml").read_text())["platforms"]
    libraries = {name for cells in platforms.values() for name in cells}
    cells = sum(len(cells) for cells in platforms.values())
    assert (
        f"versions of {len(libraries)} libraries on {len(platforms)} platforms, each with its source | {cells} |"
        in CARD
    )


@pytest.mark.parametrize(
    ("said", "count"),
    [
        (r"About ([\d,]+) names of headers", lambda: len(load_rows())),
        (r"about ([\d,]+) names whose header", lambda: len(load_transitive())),
    ],
)
def test_known_changes_are_about_as_many(said, count):
    found = re.search(said, CARD)
    assert found and int(found[1].replace(",", "")) == pytest.approx(count(), rel=0.1)


def test_the_steps_of_the_build_are_all_on_the_card():
    table = CARD[CARD.index("| step | makes |") :].partition("\n\n")[0].splitlines()[2:]
    said = [tuple(cell.strip() for cell in row.split("|")[1:3]) for row in table]
    assert said == [(f"`{step.name}`", ", ".join(f"`{file}`" for file in step.makes)) for step in STEPS]


def test_which_releases_of_debian_stand_for_one_of_ubuntu():
    releases = load_libraries().list_versions("boost")
    said = {}
    for names, judges in re.findall(r"^\| (ubuntu \w+(?:, ubuntu \w+)*) \| (debian [\w, ]+) \|$", CARD, re.MULTILINE):
        found = tuple(re.findall(r"debian \w+", judges))
        said |= dict.fromkeys(names.split(", "), ("", *found) if "a later release" in judges else found)
    known = {name: find_neighbours(name, releases) for name in CODENAMES.values() if name.startswith("ubuntu ")}
    assert said == {name: both for name, both in known.items() if any(both)}


@pytest.mark.parametrize(
    "notice", ["Copyright (c) Open Source Robotics Foundation, Inc.", "Copyright (c) 2012, BMW Car IT GmbH"]
)
def test_notices_that_go_with_the_data_are_there(notice):
    assert notice in CARD
