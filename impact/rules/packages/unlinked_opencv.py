"""unlinked-opencv: a program calls functions of OpenCV that lie in libraries which nothing it is linked to hands on.

What it does
    Reports programs that call functions of OpenCV's calib3d, highgui, features2d or video and get OpenCV from nobody;
    in ROS 1 also those that get it from cv_bridge alone, which hands on core, imgproc and imgcodecs since Kinetic.

Why it breaks
    The linker reports undefined references.

Example
    target_link_libraries(viewer ${catkin_LIBRARIES})       # of cv_bridge, and viewer.cpp calls cv::imshow

Use instead
    find_package(OpenCV REQUIRED)
    target_link_libraries(viewer ${catkin_LIBRARIES} ${OpenCV_LIBRARIES})

Not reported
    Programs that are linked to something of which it cannot be seen what it brings; in ROS 2 those that are given a
    package which depends on OpenCV.
"""

from collections.abc import Iterator

from ...model.cmake.build import is_for_tests
from ...model.cmake.catkin_links import list_bringing, list_linked
from ...model.package import NameUse
from ...targets.providers.library import OPENCV_FUNCTIONS
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .unlinked_library import is_brought

# Distros whose cv_bridge hands on every library of OpenCV.
_WITH_ALL_OF_OPENCV = frozenset({"groovy", "hydro", "indigo", "jade"})


@rule(
    group="library-component",
    texts=Text(
        "`{target}` uses `{function}` but does not link `opencv_{library}`",
        "find_package(OpenCV REQUIRED) and target_link_libraries({target} ${{OpenCV_LIBRARIES}})",
    ),
)
def unlinked_opencv(view: TargetView, package: Package):
    build = package.build
    if package.build_type != ("catkin" if view.target.ros == 1 else "ament_cmake") or build.unresolved:
        return
    calls = [
        use
        for use in package.linked.names
        if use.text in OPENCV_FUNCTIONS and use.role == "build" and view.is_sure(use.conditions)
    ]
    if not calls or any("$" in f.name for f in build.found):
        return
    if view.target.ros == 2 and any(
        not view.is_package(found.name) and not view.find_cmake(found.name) for found in build.found
    ):
        return  # targets of what is not known may be called as any library
    for target in build.targets:
        if target.kind != "executable" or is_for_tests(target.conditions) or not view.is_sure(target.conditions):
            continue
        linked = list_linked(package, target.name)
        if linked is None or any("opencv" in item.lower() for item in linked):
            continue
        call = next((use for use in calls if use.at.path in target.sources), None)
        if call is not None and view.target.ros == 2:
            if not is_brought(view, package, target.name, "opencv2/core.hpp", ("opencv",), mistaken=False):
                yield from _diagnose(package, target.name, call)
                return
            continue
        bringing = list_bringing(view, package, linked, "opencv") if call is not None else None
        if call is None or bringing is None or not bringing <= {"cv_bridge", "OpenCV"}:
            continue
        if "cv_bridge" in bringing and view.target.distro in _WITH_ALL_OF_OPENCV:
            continue
        yield from _diagnose(package, target.name, call)
        return


def _diagnose(package: Package, target: str, call: NameUse) -> Iterator[Diagnostic]:
    data = {"target": target, "function": call.text, "library": OPENCV_FUNCTIONS[call.text]}
    yield Diagnostic(call.at, "OpenCV", package.name, data)
