"""What versions of platform libraries lost, by their Debian packages: small packages of a made-up history."""

import io
import json
import lzma
import tarfile

import pytest
import zstandard
from rosimpact.databuild import debian
from rosimpact.databuild.libraries import Packaged, Run, read_packages
from rosimpact.impact.targets.changes import find_row_version, iterate_in_force, load_rows, load_uses
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.evidence import holds_on, make_evidence
from rosimpact.impact.targets.providers.libraries import load_libraries
from rosimpact.impact.targets.providers.providers import load_providers
from rosimpact.impact.targets.tables import DATA
from rosimpact.impact.targets.version import is_at_least, parse

OLD = """#pragma once
#define YAML_OLD_MACRO_NAME 1
namespace YAML
{
class Walker { public: enum Kind { StrictWalk, EasyWalk }; };
class Runner {};
class Taken {};
struct Swimmer {};
void explore(int depth);
void lighten(int first, int second = 0);
void tighten(int first, int second);
typedef int Stepper_t;
[[deprecated("use ascendTo instead")]] void climbUp(int height);
namespace detail { void innards(); }
bool operator==(const Walker &, const Walker &);
}
"""
NEW = """#pragma once
// Walker and climbUp are no more; a comment brings nothing back.
#define Runner YAML::Racer
namespace YAML
{
class Racer {};
using Swimmer = Racer;
void explore(long depth);
void lighten(int first, int second);
template <class... T> void tighten(T... all);
void ascendTo(int height);
}
"""


def put(folder, release, package, files):
    """Writes a Debian package into the folder of a release."""
    archive = io.BytesIO()
    with tarfile.open(fileobj=archive, mode="w") as tar:
        for path, text in files.items():
            entry = tarfile.TarInfo(f"./usr/{path}" if path.startswith("lib/") else f"./usr/include/{path}")
            entry.size = len(text.encode())
            tar.addfile(entry, io.BytesIO(text.encode()))
    data = b"!<arch>\n"
    for part, content in (("debian-binary", b"2.0\n"), ("data.tar.xz", lzma.compress(archive.getvalue()))):
        data += f"{part:<16}{0:<12}{0:<6}{0:<6}{'100644':<8}{len(content):<10}`\n".encode() + content
        data += b"\n" * (len(content) % 2)
    file = folder / f"{package}_amd64.deb"
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(data)
    name, _, version = package.partition("_")
    run = Run(folder)
    run.keep(release, read_packages("yaml-cpp", [(Packaged(name, version, len(data), "yaml-cpp"), file)], run.texts))


@pytest.fixture
def archive(tmp_path, monkeypatch):
    # What some ROS package has is not told of; reading all that is shipped would take its time.
    monkeypatch.setattr(debian, "_collect_ros_names", lambda: frozenset({"YAML::Taken", "yaml-cpp/taken.h"}))
    folder = tmp_path / "debian"
    away = "namespace YAML { class Faraway {}; }"
    first = {"yaml-cpp/all.h": OLD, "yaml-cpp/old.h": "namespace YAML { class Holder {}; class Keeper {}; }"}
    first |= {f"yaml-cpp/{path}.h": "" for path in ("detail/inner", "impl", "taken")}
    put(folder, "bullseye", "libyaml-cpp-dev_1.3.1+dfsg-1", first | {"yaml-cpp/away.h": away})
    put(
        folder,
        "bookworm",
        "libyaml-cpp-dev_2.0+really1.9.0-2+b1",
        {"yaml-cpp/all.h": NEW, "yaml-cpp/new.h": "namespace YAML { class Holder {}; class Keeper {}; }\n"},
    )
    # It came back, so it is not told of.
    put(
        folder,
        "trixie",
        "libyaml-cpp-dev_2.1-1",
        {"yaml-cpp/all.h": NEW, "yaml-cpp/new.h": "", "yaml-cpp/away.h": away},
    )
    return folder


def built(folder, tmp_path):
    """The tables that are made of a folder, by kind: names of each group."""
    debian.main([str(folder), "--output", str(tmp_path)])
    changes = json.loads(zstandard.decompress((tmp_path / "changes_debian.json.zst").read_bytes()))["changes"]
    uses = json.loads((tmp_path / "uses_debian.json").read_text())["uses"]
    return changes, uses


def test_what_went_between_two_releases_is_told_with_both_versions(archive, tmp_path):
    changes, uses = built(archive, tmp_path)
    first = [group for group in changes if group["last_in"] == "1.3.1"]
    assert {group["removed_in"] for group in first} == {"1.9.0"}
    told = {name: new for group in first for name, new in group["names"].items()}
    assert told == {
        # Nothing of the whole class is told beside it; what moved as a whole has its new place.
        "YAML::Walker": "",
        "YAML::Stepper_t": "",
        "YAML::climbUp": "YAML::ascendTo",
        "yaml-cpp/old.h": "yaml-cpp/new.h",
    }
    assert "bullseye" in first[0]["source"] and "bookworm" in first[0]["source"]
    # A macro, an alias, another overload, a pack: each still takes the old use.
    assert [list(group["uses"]) for group in uses] == [["YAML::lighten with one argument"]]


def test_a_name_that_only_a_later_version_lost_is_told_of_that_one(archive, tmp_path):
    changes, _ = built(archive, tmp_path)
    later = [group for group in changes if group["last_in"] != "1.3.1"]
    assert [(group["last_in"], group["removed_in"], group["names"]) for group in later] == [
        ("1.9.0", "2.1", {"YAML::Holder": "", "YAML::Keeper": ""})
    ]


def tagged(folder, tags):
    """A clone whose tags have these headers."""
    import pygit2

    repository = pygit2.init_repository(folder / "jbeder+yaml-cpp", bare=True)
    signature = pygit2.Signature("Robots", "robots@example.org", 1, 0)
    for tag, files in tags.items():
        index = pygit2.Index()
        for path, text in files.items():
            index.add(pygit2.IndexEntry(path, repository.create_blob(text.encode()), pygit2.enums.FileMode.BLOB))
        commit = repository.create_commit(None, signature, signature, tag, index.write_tree(repository), [])
        repository.references.create(f"refs/tags/{tag}", commit)
    return folder


def test_versions_before_the_first_packaged_one_are_read_at_their_tags(archive, tmp_path, monkeypatch):
    monkeypatch.setattr(debian, "list_platform_versions", lambda name: frozenset({"1.0.1", "1.3.1"}))
    early = {
        "include/yaml-cpp/all.h": OLD + "namespace YAML { class Ancient {}; class Holder {}; }",
        "include/yaml-cpp/lost.h": "",
        "test/include/yaml-cpp/check.h": "namespace YAML { class Checker {}; }",  # which nobody installs
    }
    clones = tagged(
        tmp_path / "clones",
        {
            "release-0.9.0": {"include/yaml-cpp/all.h": "namespace YAML { class Oldest {}; }"},  # no platform has it
            "yaml-cpp-1.0.1": early,
            "yaml-cpp-1.2.0-rc1": {},
            "yaml-cpp-1.2.0": {"include/yaml-cpp/all.h": OLD},
            "1.3.1": {"include/yaml-cpp/all.h": OLD},
            "v2.0.0": {"include/yaml-cpp/all.h": NEW},  # the packages tell of it
        },
    )
    debian.main([str(archive), "--clones", str(clones), "--output", str(tmp_path)])
    rows = json.loads(zstandard.decompress((tmp_path / "changes_library_tags.json.zst").read_bytes()))["changes"]
    # `Holder` is there in a package later on.
    assert [(row["last_in"], row["removed_in"], row["names"]) for row in rows] == [
        ("1.0.1", "1.2.0", {"yaml-cpp/lost.h": ""}),
        ("1.0.1", "1.2.0", {"YAML::Ancient": ""}),
    ]
    packaged = json.loads(zstandard.decompress((tmp_path / "changes_debian.json.zst").read_bytes()))["changes"]
    assert packaged and all("Debian" in row["source"] for row in packaged)


def test_a_folder_in_which_nothing_was_read_is_refused(tmp_path, capsys):
    with pytest.raises(SystemExit):
        debian.main([str(tmp_path)])
    assert "--suite" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("version", "expected"),
    [
        ("7:5.1.9-0+deb12u1", "5.1.9"),
        ("2.1.0+really2.0.1+dfsg-1", "2.0.1"),
        ("4.5.1+dfsg-5", "4.5.1"),
        ("1.7-1", "1.7"),
    ],
)
def test_the_version_of_the_library_itself(version, expected):
    assert debian.extract_upstream_version(version) == expected


# -- what is shipped ---------------------------------------------------------------------------------------------------


def test_shipped_rows_name_the_interval_and_a_library_whose_version_platforms_tell():
    platforms = (DATA / "platform_versions.yaml").read_text()
    derived = [row for row in (*load_rows(), *load_uses().values()) if row.last_in]
    assert len(derived) > 300
    for row in derived:
        assert row.library and parse(row.last_in) < parse(row.removed_in) and is_at_least(row.removed_in, row.last_in)
        known = f"\n    {row.package}: {{version:" in platforms or load_libraries().list_versions(row.package)
        assert known, row.package
        # Rows of wheels name the library, and a reviewed row may have taken the versions from one.
        of_wheels = row.kind == "python-removed" and (row.new or row.source.startswith("wheels of "))
        assert of_wheels or (row.last_in in row.source and row.removed_in in row.source)


def test_what_people_reviewed_comes_before_what_was_derived():
    derived = {row.old for row in load_rows() if row.last_in}
    reviewed = {row.old for row in load_rows() if not row.last_in and row.library}
    assert not derived & reviewed


def test_the_evidence_gives_the_interval():
    row = next(row for row in load_rows() if row.last_in and row.kind == "api-removed")
    evidence = make_evidence(row, "removed")
    assert (evidence.last, evidence.first) == (row.last_in, row.removed_in)


@pytest.mark.parametrize(
    ("distro", "expected"),
    # OpenCV 4.5.4 lies between 4.5.1, whose detectMarkers takes eight arguments, and 4.6.0, whose does not.
    [("noetic", False), ("humble", None), ("jazzy", True)],
)
def test_of_a_version_between_two_packaged_ones_nothing_is_said(distro, expected):
    use = load_uses()["cv::aruco::detectMarkers with 8 arguments"]
    assert holds_on(make_evidence(use, "removed"), DistroTarget(distro), load_providers()) is expected


@pytest.mark.parametrize(
    ("distro", "name", "gone_in"),
    [
        # Ubuntu 22.04 has OMPL 1.5.2, and Humble its own, newer one.
        ("humble", "ompl::geometric::QuotientSpace", "1.7.0"),
        ("jazzy", "urdf::parsePose", ""),
        ("lyrical", "urdf::parsePose", "6.0.0"),
        # 4.6.0 has it, 4.10.0 has not.
        ("jazzy", "cv::aruco::PREDEFINED_DICTIONARY_NAME", ""),
        ("lyrical", "cv::aruco::PREDEFINED_DICTIONARY_NAME", "4.10.0"),
    ],
)
def test_the_version_that_a_target_builds_with_decides(distro, name, gone_in):
    target = DistroTarget(distro)
    found = [row for row, state in iterate_in_force(target) if row.old == name and state == "removed"]
    assert [find_row_version(row, target) for row in found] == ([gone_in] if gone_in else [])
