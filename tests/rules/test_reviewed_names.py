"""Which rows of known changes a name is looked up in."""

from types import SimpleNamespace
from typing import cast

import msgspec
import pytest
from rosimpact.impact.model.cmake.build import At
from rosimpact.impact.model.package import NameUse
from rosimpact.impact.model.view import TargetView
from rosimpact.impact.rules.api.reviewed_names import ReviewedNames
from rosimpact.impact.targets import availability
from rosimpact.impact.targets.availability import Availabilities
from rosimpact.impact.targets.changes import ChangeRow
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.surface.offers import Offers


def row(package: str, old: str, new: str = "", **bounds: str) -> ChangeRow:
    return ChangeRow(kind="api-renamed" if new else "api-removed", package=package, old=old, new=new,
                     source="the change log", **(bounds or {"removed_in": "2.0.0"}))  # fmt: skip


ROWS = (
    row("arm", "lift"),
    row("arm", "drop", "put"),
    row("arm", "shake", deprecated_in="2.0.0"),
    row("arm", "spin", "turn", new_since="3.0.0"),
    row("dock", "moor"),
    row("opencv", "CV_OLD"),
)
OLD = {
    **{("c++", one.old): [one] for one in ROWS},
    ("python", "arm.lift"): [msgspec.structs.replace(ROWS[0], kind="python-removed", old="arm.lift")],
    ("c++", "EIGEN_OLD"): [msgspec.structs.replace(row("eigen3", "EIGEN_OLD"), library=True)],
}
NEW = {("c++", one.new): [one] for one in ROWS if one.new}


class Target(DistroTarget):
    """Has everything in version 2.0.0."""

    def __init__(self):
        self.distro, self.ros = "jazzy", 2

    def find_version(self, package):
        return "2.0.0"

    find_library = find_version

class Workspace(SimpleNamespace):
    """A workspace of the package dock."""

    def __iter__(self):
        return iter(())


MACHINE = SimpleNamespace(is_from_library=lambda header: header == "Eigen/src/Core/Dot.h")
OFFERS = SimpleNamespace(find_package=lambda package: None, surfaces=SimpleNamespace(is_library=lambda package: False))
REVIEWED = Availabilities(Target(), cast(Offers, OFFERS), ahead=())
NAMES = ReviewedNames(
    cast(
        TargetView,
        SimpleNamespace(
            find_reviewed=REVIEWED.find_reviewed,
            workspace=Workspace(),
            machine=MACHINE,
            may_have=lambda name: name == "dock",
        ),
    )
)


@pytest.fixture(autouse=True)
def own_rows(monkeypatch):
    monkeypatch.setattr(availability, "index_rows", lambda: (OLD, NEW))


@pytest.mark.parametrize(
    ("name", "language", "found"),
    [
        ("lift", "cpp", ["arm"]),
        ("drop", "cpp", ["arm"]),
        ("put", "cpp", []),
        ("shake", "cpp", []),  # it is still there
        ("spin", "cpp", []),  # it is the new name that is not there yet
        ("turn", "cpp", []),
        ("moor", "cpp", []),  # as the workspace brings it
        ("cv::CV_OLD", "cpp", ["opencv"]),
        ("other::CV_OLD", "cpp", []),
        ("cv::inner::CV_OLD", "cpp", []),
        ("arm.lift", "python", ["arm"]),
        ("arm.lift", "cpp", []),
        ("lift", "python", []),
    ],
)
def test_rows_on_names_that_are_gone(name, language, found):
    use = NameUse(name, At("a.cpp", 1), "build", False, language)
    assert [one.package for one in NAMES.find(use)] == found


@pytest.mark.parametrize(("name", "found"), [("turn", ["arm"]), ("spin", []), ("lift", []), ("put", [])])
def test_rows_on_names_that_are_not_there_yet(name, found):
    assert [one.package for one in NAMES.list_rows("c++", name, "not yet")] == found


@pytest.mark.parametrize(
    ("path", "rows"), [("extern/eigen/Eigen/src/Core/Dot.h", 0), ("src/Core/Dot.h", 1), ("src/arm.cpp", 1)]
)
def test_a_librarys_copy_has_its_own_version(path, rows):
    use = NameUse("EIGEN_OLD", At(path, 1, 1), "build", True, "cpp", (), ())
    assert len(NAMES.find(use)) == rows
