"""Which rows of known changes a name is looked up in."""

from types import SimpleNamespace
from typing import cast

import pytest
from rosimpact.impact.model.cmake.build import At
from rosimpact.impact.model.package import NameUse
from rosimpact.impact.model.view import TargetView
from rosimpact.impact.rules.api.reviewed_names import ReviewedNames
from rosimpact.impact.targets.availability import Availabilities
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.surface.offers import Offers
from rosimpact.impact.targets.target import ChangeInForce, ChangeTable


def row(kind: str, package: str, old: str, new: str, state: str) -> ChangeInForce:
    return ChangeInForce(kind, package, old, new, state, "2.0.0", "2.0.0", "the change log")


ROWS = ChangeTable((
    row("api-removed", "arm", "lift", "", "removed"),
    row("api-renamed", "arm", "drop", "put", "removed"),
    row("api-removed", "arm", "shake", "", "deprecated"),
    row("api-renamed", "arm", "spin", "turn", "absent"),
    row("api-removed", "dock", "moor", "", "removed"),
    row("api-removed", "opencv", "CV_OLD", "", "removed"),
    row("python-removed", "arm", "arm.lift", "", "removed"),
    row("api-removed", "eigen3", "EIGEN_OLD", "", "removed")._replace(library=True),
))  # fmt: skip


class Workspace(SimpleNamespace):
    """A workspace of the package dock."""

    packages = ("dock",)

    def __iter__(self):
        return iter(())


MACHINE = SimpleNamespace(is_from_library=lambda header: header == "Eigen/src/Core/Dot.h")
REVIEWED = Availabilities(cast(DistroTarget, SimpleNamespace(known_changes=ROWS)), cast(Offers, object()), ahead=())
NAMES = ReviewedNames(
    cast(
        TargetView,
        SimpleNamespace(find_reviewed=REVIEWED.find_reviewed, workspace=Workspace(), machine=MACHINE),
    )
)


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
