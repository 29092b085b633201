"""What packages of ROS lost at release tags: which versions are read, and which rows come of it."""

import subprocess

import pytest
from rosimpact.databuild.release_tags import ReadLine, list_groups, list_states
from rosimpact.databuild.surface.clones import Clone
from rosimpact.impact.facts.store import Store
from rosimpact.impact.targets.surface.changes import ChangeEvent, ComparedThing, Form, Line

VERSIONS = ("0.1.0", "0.2.0", "0.3.0")


def make_event(place, kind, **fields):
    has = fields.pop("has", None)
    return ChangeEvent(place, (ComparedThing(kind, "class", **fields),), None, has)


def list_rows(side, name, *events, package="arm", beside=()):
    """(kind, removed_in, deprecated_in, new) of each row that these events give."""
    line = Line(VERSIONS, {side: {name: events}})
    groups = list_groups("release tags of robots/arm", [ReadLine(package, 2, line), *beside])
    assert all(group["source"] == "release tags of robots/arm" and group["package"] == package for group in groups)
    return [
        (group["kind"], group.get("removed_in", ""), group.get("deprecated_in", ""), group["names"][name])
        for group in groups
    ]


@pytest.mark.parametrize(
    ("side", "name", "events", "rows"),
    [
        ("c++", "arm::Arm", [make_event(1, "removed")], [("api-removed", "0.2.0", "", "")]),
        (
            "c++",
            "arm::Arm",
            [make_event(2, "removed", instead="arm::Limb")],
            [("api-removed", "0.3.0", "", "arm::Limb")],
        ),
        (
            "header",
            "arm/arm.h",
            [make_event(1, "moved", instead="limb/arm.h", moved_to="limb")],
            [("header-renamed", "0.2.0", "", "limb/arm.h")],
        ),
        (
            "python",
            "arm.move",
            [make_event(1, "deprecated", instead="arm.go"), make_event(2, "removed")],
            [("python-removed", "0.3.0", "0.2.0", "arm.go")],
        ),
        # It comes back, or the comparison is not sure.
        ("c++", "arm::Arm", [make_event(1, "removed"), make_event(2, "added", has=Form((), None))], []),
        ("c++", "arm::Arm", [make_event(1, "removed", sure=0.5)], []),
        # Only one function of a name warns.
        ("c++", "arm::move", [make_event(1, "deprecated", has=Form(("()", "(int)"), None))], []),
        (
            "c++",
            "arm::move",
            [make_event(1, "deprecated", has=Form(("()",), "old"))],
            [("api-removed", "", "0.2.0", "")],
        ),
        # Nobody else uses these.
        ("c++", "arm::detail::Arm", [make_event(1, "removed")], []),
        ("c++", "arm::Arm::speed_", [make_event(1, "removed")], []),
        # Whose function that is, its name does not tell.
        ("c++", "move", [make_event(1, "removed")], []),
    ],
)
def test_rows_of_a_name(side, name, events, rows):
    assert list_rows(side, name, *events) == rows


def test_a_package_of_both_generations_says_which_is_meant():
    other = ReadLine("arm", 1, Line(("0.0.1",), {}))
    line = Line(VERSIONS, {"header": {"arm/arm.h": (make_event(1, "removed"),)}})
    assert [group["ros"] for group in list_groups("x", [ReadLine("arm", 2, line), other])] == [2]


def test_versions_that_are_not_stored_are_read_with_those_beside_them(tmp_path):
    folder = tmp_path / "robots+arm"
    folder.mkdir()

    def run(*arguments):
        identity = ("-c", "user.name=a", "-c", "user.email=a@example.org")
        subprocess.run(["git", *identity, *arguments], cwd=folder, check=True, capture_output=True)

    run("init")
    (folder / "package.xml").write_text("<package><name>arm</name><version>1.0.0</version></package>")
    run("add", ".")
    run("commit", "-m", "arm")
    for tag in ("0.1.0", "0.2.0", "v0.3.0", "0.4.0", "0.5.0", "nightly"):
        run("tag", tag)
    stored = frozenset(("0.2.0", "0.3.0", "0.4.0"))
    with Store() as store:
        states = list_states(Clone(folder), lambda package: stored if package == "arm" else frozenset(), store)
        assert [version for version, _ in states] == ["0.1.0", "0.2.0", "0.4.0", "0.5.0"]
        assert list_states(Clone(folder), lambda package: stored | {"0.1.0", "0.5.0"}, store) == []
