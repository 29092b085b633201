"""Components of platform libraries: which are compiled, and which are gone in which version."""

import re
from typing import NamedTuple

from ..distro.distro import DistroTarget
from ..version import at_least, parts
from .libraries import system_libraries

# Boost libraries that are linked against. Source: Boost's "Getting Started", section "Header-Only Libraries".
BOOST_COMPILED = frozenset({
    "atomic", "chrono", "container", "context", "contract", "coroutine", "date_time", "exception", "fiber",
    "filesystem", "graph", "iostreams", "json", "locale", "log", "math", "mpi", "nowide", "program_options",
    "python", "random", "regex", "serialization", "signals", "stacktrace", "system", "test", "thread", "timer",
    "type_erasure", "unit_test_framework", "url", "wave",
})  # fmt: skip

# Boost libraries that come with another one, as CMake's own knowledge of them says (FindBoost.cmake).
BOOST_BROUGHT = {
    "thread": {"system", "chrono", "date_time", "atomic"},
    "filesystem": {"system", "atomic"},
    "chrono": {"system"},
    "iostreams": {"regex"},
    "log": {"log_setup", "date_time", "filesystem", "thread", "regex", "chrono", "atomic", "system"},
    "timer": {"chrono", "system"},
    "locale": {"system"},
    "coroutine": {"context", "system"},
    "wave": {"filesystem", "serialization", "thread", "chrono", "date_time", "atomic", "system"},
    "mpi": {"serialization"},
}
# Boost libraries in catkin_LIBRARIES wherever roscpp is found. Source: catkin_package(DEPENDS Boost) of roscpp,
# rosconsole, rostime and cpp_common.
BOOST_OF_ROSCPP = frozenset({"system", "thread", "filesystem", "regex", "date_time", "chrono", "atomic", "signals"})

# Headers whose use needs a compiled library, by how their path begins. Source: the libraries' documentation.
_COMPILED_HEADERS = (
    ("boost/filesystem.hpp", "filesystem", ""),
    ("boost/filesystem/", "filesystem", ""),
    ("boost/program_options", "program_options", ""),
    ("boost/regex.hpp", "regex", "1.76"),
    ("boost/regex/", "regex", "1.76"),
    ("boost/iostreams/device/mapped_file.hpp", "iostreams", ""),
    ("boost/iostreams/device/file_descriptor.hpp", "iostreams", ""),
    ("boost/iostreams/filter/gzip.hpp", "iostreams", ""),
    ("boost/iostreams/filter/zlib.hpp", "iostreams", ""),
    ("boost/iostreams/filter/bzip2.hpp", "iostreams", ""),
    ("boost/archive/text_", "serialization", ""),
    ("boost/archive/binary_", "serialization", ""),
    ("boost/archive/xml_", "serialization", ""),
    ("boost/archive/polymorphic_", "serialization", ""),
    ("boost/thread.hpp", "thread", ""),
    ("boost/thread/thread.hpp", "thread", ""),
    ("boost/thread/mutex.hpp", "thread", "1.69"),
    ("boost/thread/recursive_mutex.hpp", "thread", "1.69"),
    ("boost/thread/shared_mutex.hpp", "thread", "1.69"),
    ("boost/thread/condition", "thread", "1.69"),
    ("boost/log/", "log", ""),
    ("boost/locale.hpp", "locale", ""),
    ("boost/timer/timer.hpp", "timer", ""),
    ("boost/random/random_device.hpp", "random", ""),
    ("boost/asio.hpp", "system", "1.69"),
    ("boost/asio/", "system", "1.69"),
)


def compiled_component(header: str, version: str) -> str | None:
    """The compiled Boost library that code with this include needs to be linked to in a Boost version, None when it is
    headers alone or not known. version: empty where it is not known, which counts as the newest."""
    if not header.startswith("boost/"):
        return None
    for start, component, until in _COMPILED_HEADERS:
        if header.startswith(start):
            return None if until and (not version or at_least(version, until)) else component
    return None


# Functions of OpenCV, by the library they are compiled into, of those libraries that cv_bridge does not hand on since
# Kinetic (it does core, imgproc and imgcodecs). The same in OpenCV 3 and 4. Sources: OpenCV's headers; cv_bridge's
# CMakeLists.txt at its tags.
OPENCV_FUNCTIONS = {
    f"cv::{name}": library
    for library, names in (
        (
            "calib3d",
            "Rodrigues solvePnP solvePnPRansac calibrateCamera stereoCalibrate stereoRectify findChessboardCorners "
            "drawChessboardCorners projectPoints findHomography findFundamentalMat findEssentialMat recoverPose "
            "triangulatePoints reprojectImageTo3D decomposeProjectionMatrix",
        ),
        (
            "highgui",
            "imshow namedWindow waitKey destroyWindow destroyAllWindows setMouseCallback createTrackbar resizeWindow "
            "moveWindow startWindowThread",
        ),
        ("features2d", "drawKeypoints drawMatches"),
        ("video", "calcOpticalFlowPyrLK calcOpticalFlowFarneback buildOpticalFlowPyramid"),
    )
    for name in names.split()
}


class Gone(NamedTuple):
    """A component that a library's version lacks, and what to do."""

    version: str
    help: str


class _Row(NamedTuple):
    package: str
    component: str
    library: str
    gone_in: str
    help: str
    source: str


_GONE = (
    _Row(
        "Boost",
        "signals",
        "boost",
        "1.69",
        "drop the component and use boost/signals2 (header-only)",
        "Boost 1.69 release notes",
    ),
    _Row("Boost", "coroutine2", "boost", "1.60", "use `coroutine` or `context`", "Boost.Coroutine2 is header-only"),
    _Row(
        "Boost",
        "system",
        "boost",
        "1.89",
        "drop the component: Boost.System is header-only since 1.69",
        "Boost 1.89 release notes",
    ),
    _Row("OpenCV", "nonfree", "opencv", "3.0", "use `xfeatures2d` of opencv_contrib", "OpenCV 3.0 transition guide"),
    _Row("OpenCV", "legacy", "opencv", "3.0", "the module was removed", "OpenCV 3.0 transition guide"),
    _Row("OpenCV", "contrib", "opencv", "3.0", "name the modules of opencv_contrib", "OpenCV 3.0 transition guide"),
    _Row("OpenCV", "gpu", "opencv", "3.0", "use the `cuda*` modules", "OpenCV 3.0 transition guide"),
    _Row("OpenCV", "ocl", "opencv", "3.0", "use UMat", "OpenCV 3.0 transition guide"),
    _Row("OpenCV", "viz", "opencv", "5.0", "", "OpenCV 5 change log"),
)


def gone_component(target: DistroTarget, package: str, component: str) -> Gone | None:
    """What a target's version of a CMake package lacks of its components, None when it is there or not known."""
    for row in _GONE:
        if row.package == package and row.component == component:
            version = target.library(row.library)
            if version and at_least(version, row.gone_in):
                return Gone(version, row.help)
    # The configuration of Boost finds one for each component, `boost_json`.
    library = _LIBRARY_OF.get(package, "")
    found = system_libraries().configuration(library, f"{library}_{component}", target.platform, target.library)
    return Gone(target.library(library) or found.version, "") if found is not None and found.here is False else None


class VersionAnswer(NamedTuple):
    """Whether a version request holds, and the version that is there."""

    holds: bool
    version: str


# CMake package name to the library's name in platform_versions.yaml. Others are looked up in lower case, with `-`.
_LIBRARY_OF = {
    "OpenCV": "opencv",
    "Boost": "boost",
    "Eigen3": "eigen3",
    "PCL": "pcl",
    "Qt5": "qt5",
    "Qt6": "qt6",
    "Ceres": "ceres",
    "yaml-cpp": "yaml-cpp",
    "VTK": "vtk",
    "Protobuf": "protobuf",
    "fmt": "fmt",
    "Bullet": "bullet",
    "assimp": "assimp",
    "spdlog": "spdlog",
    "nlohmann_json": "nlohmann-json",
    "CMake": "cmake",
}
# Packages whose version file accepts only the same major version (SameMajorVersion). Others accept anything newer.
# Sources: OpenCVConfig-version.cmake.in, Eigen3ConfigVersion.cmake, PCLConfigVersion.cmake (newer or equal),
# BoostConfig.
_SAME_MAJOR = frozenset({"OpenCV", "Eigen3", "Qt5", "Qt6", "VTK", "Protobuf"})


def satisfies(target: DistroTarget, package: str, request: str, exact: bool) -> VersionAnswer | None:
    """Whether find_package(package request [EXACT]) holds by the platform's version; None when that is not known."""
    if package not in _LIBRARY_OF and target.version(package) is not None:
        return None  # a released package's own
    version = target.library(_LIBRARY_OF.get(package) or package.lower().replace("_", "-"))
    if not version:
        return None
    if package == "OpenCV" and target.ros == 1 and target.distro == "kinetic":
        return None  # ROS kinetic brings OpenCV 3 beside the platform's 2
    low, _, high = request.partition("...")
    if exact:
        return VersionAnswer(parts(version)[: len(parts(low))] == parts(low), version)
    holds = at_least(version, low)
    if holds and high:
        bound = high.lstrip("<")
        holds = (
            not at_least(version, bound)
            if high.startswith("<")
            else not at_least(version, bound) or parts(version)[: len(parts(bound))] == parts(bound)
        )
    elif holds and package in _SAME_MAJOR:
        holds = parts(version)[:1] == parts(low)[:1]
    return VersionAnswer(holds, version)


class NeededStandard(NamedTuple):
    """A C++ standard that a header needs: 11, 14, 17 ...; of which package, which version; sure when all users do.

    version: empty where the package is not released on the target, and every release for its distro needs it.
    """

    standard: int
    package: str
    version: str
    sure: bool


class _StandardRow(NamedTuple):
    prefix: str
    package: str
    library: bool
    since: str
    standard: int
    source: str
    sure: bool = True
    distros: frozenset[str] = frozenset()


# Headers that do not compile below a standard, by the start of their path. Newest first. distros: where every release
# of the package needs it, so that one built from source does too.
_STANDARDS = (
    _StandardRow("rclcpp/", "rclcpp", False, "9.0.0", 17, "rclcpp 9: any_subscription_callback.hpp includes <variant>"),
    _StandardRow("rclcpp/", "rclcpp", False, "0.5.0", 14, "REP-2000: Crystal and newer target C++14"),
    _StandardRow("rclcpp_action/", "rclcpp", False, "9.0.0", 17, "rclcpp_action includes rclcpp's headers"),
    _StandardRow("rclcpp_lifecycle/", "rclcpp", False, "9.0.0", 17, "rclcpp_lifecycle includes rclcpp's headers"),
    _StandardRow("rclcpp_components/", "rclcpp", False, "9.0.0", 17, "rclcpp_components includes rclcpp's headers"),
    _StandardRow("pcl/", "pcl", True, "1.10", 14, "PCL 1.10 change log: C++14 is required"),
    _StandardRow("pcl/", "pcl", True, "1.9", 11, "PCL 1.9 change log"),
    _StandardRow("opencv2/", "opencv", True, "4.0", 11, "OpenCV 4.0 change log: a C++11 library"),
    # Not sure: its targets ask CMake for the standard themselves.
    _StandardRow("gazebo/", "gazebo-classic", True, "11.0", 17, "gazebo 11 migration guide", False),
    _StandardRow("gazebo/", "gazebo-classic", True, "6.0", 11, "gazebo 6 migration guide"),
    _StandardRow("moveit/", "moveit_core", False, "0.9.0", 11, "MoveIt change log, kinetic", True,
                 frozenset({"kinetic"})),
    _StandardRow("ceres/", "ceres", True, "2.2", 17, "Ceres Solver 2.2 release notes: C++17 is required"),
    _StandardRow("ceres/", "ceres", True, "2.0", 14, "Ceres Solver 2.0 release notes: C++14 is required"),
    _StandardRow("Eigen/", "eigen3", True, "3.4.90", 14, "Eigen 5.0 release notes: C++14 is required"),
    _StandardRow("gtest/", "gtest", True, "1.17", 17, "GoogleTest 1.17 release notes"),
    _StandardRow("gtest/", "gtest", True, "1.13", 14, "GoogleTest 1.13 release notes"),
    _StandardRow("gtest/", "gtest", True, "1.8.1", 11, "GoogleTest 1.10 release notes"),
)  # fmt: skip


def needed_standard(target: DistroTarget, include: str) -> NeededStandard | None:
    """The C++ standard that an include path needs on a target, None when nothing is known."""
    for row in _STANDARDS:
        if include.startswith(row.prefix):
            version = target.library(row.package) if row.library else target.version(row.package)
            if at_least(version, row.since) if version else target.distro in row.distros:
                return NeededStandard(row.standard, row.package, version or "", row.sure)
    return None


def default_standard(target: DistroTarget) -> int | None:
    """Year of the C++ standard that the target's compiler takes by default (1998, 2014, 2017), None when not known.

    Source: GCC's documentation of -std: gnu++98 before 6, gnu++14 from 6, gnu++17 from 11.
    """
    gcc = target.library("gcc")
    if not gcc:
        return None
    return 2017 if at_least(gcc, "11") else 2014 if at_least(gcc, "6") else 1998


def standard_year(number: int) -> int:
    """The year of a C++ standard as flags and CMake write it: 98 and 3 come before 11."""
    return 1998 if number in (98, 3) else 2000 + number % 100


class _Exact(NamedTuple):
    name: str
    library: str
    since: str
    source: str


# Packages whose `x-config.cmake`, which answers to X in any case, became `xConfig.cmake`, which does to `x` alone.
_EXACT = (
    _Exact(
        "assimp",
        "assimp",
        "5.1.0",
        "assimp's CMakeLists.txt at v5.0.1 and v5.1.0; files of Debian's libassimp-dev 5.0.1 and 5.2.5",
    ),
)


def not_answering(target: DistroTarget, package: str) -> str:
    """The target's version of a library whose CMake package does not answer to this spelling of its name; empty where
    it does, or nothing is known."""
    for row in _EXACT:
        if package.lower() == row.name and package != row.name:
            version = target.library(row.library) or ""
            return version if version and at_least(version, row.since) else ""
    return ""


def _set_by(stem: str, *endings: str) -> frozenset[str]:
    return frozenset(f"{stem}_{ending}" for ending in (*endings, "FOUND", "VERSION"))


# Variables that find_package(X) sets, where their spelling is not X's own. Sources: the packages' configuration files
# and CMake's find modules.
_VARIABLES = {
    "Eigen3": _set_by("EIGEN3", "INCLUDE_DIR", "INCLUDE_DIRS", "DEFINITIONS")
    | {"Eigen3_FOUND", "Eigen3_VERSION", "Eigen3_DIR"},
    "Eigen": _set_by("Eigen", "INCLUDE_DIRS") | _set_by("EIGEN", "INCLUDE_DIRS") | {"Eigen_FOUND"},
    "Boost": _set_by("Boost", "INCLUDE_DIRS", "INCLUDE_DIR", "LIBRARIES", "LIBRARY_DIRS", "LIBRARY_DIR", "LIB_VERSION"),
    "OpenCV": _set_by("OpenCV", "INCLUDE_DIRS", "LIBS", "LIBRARIES", "LIB_COMPONENTS", "INCLUDE_DIR"),
    "PCL": _set_by("PCL", "INCLUDE_DIRS", "LIBRARIES", "LIBRARY_DIRS", "DEFINITIONS"),
    "octomap": _set_by("OCTOMAP", "INCLUDE_DIRS", "LIBRARIES", "LIBRARY_DIRS") | {"octomap_FOUND", "octomap_VERSION"},
    "yaml-cpp": _set_by("YAML_CPP", "INCLUDE_DIR", "INCLUDE_DIRS", "LIBRARIES"),
    "Bullet": _set_by("BULLET", "INCLUDE_DIRS", "INCLUDE_DIR", "LIBRARIES", "LIBRARY_DIRS"),
    "assimp": _set_by("ASSIMP", "INCLUDE_DIRS", "LIBRARIES", "LIBRARY_DIRS")
    | _set_by("assimp", "INCLUDE_DIRS", "LIBRARIES"),
    "fcl": _set_by("FCL", "INCLUDE_DIRS", "LIBRARIES", "LIBRARY_DIRS"),
    "Ceres": _set_by("CERES", "INCLUDE_DIRS", "LIBRARIES") | _set_by("Ceres", "INCLUDE_DIRS", "LIBRARIES"),
    "gazebo": _set_by("GAZEBO", "INCLUDE_DIRS", "LIBRARIES", "LIBRARY_DIRS", "CXX_FLAGS"),
}


def variables(package: str) -> frozenset[str] | None:
    """Variables that find_package(package) sets, None where they are not known."""
    return _VARIABLES.get(package)


# Folders in which Debian and Ubuntu put the headers of one version of a library beside those of others: the library and
# its version. Source: lists of files of Debian's packages libopencv-core-dev, libpcl-dev and libompl-dev.
# `opencv2/` is how all versions from 2 on are included.
_FOLDER = re.compile(r"(?:opencv(?P<opencv>[3-9])|pcl-(?P<pcl>\d+\.\d+)|ompl-(?P<ompl>\d+\.\d+))/")


class Folder(NamedTuple):
    """The folder of one version of a library in an include path. there: whether a target has that version. path: as
    the library's own headers and its documentation write it."""

    library: str
    version: str
    there: bool
    path: str


def versioned_folder(target: DistroTarget, path: str) -> Folder | None:
    """The folder of a version in an include path; None where there is none, or the library's version is not known."""
    found = _FOLDER.match(path)
    if found is None or found.lastgroup is None:
        return None
    version = target.library(found.lastgroup)
    if not version:
        return None
    meant = parts(found[found.lastgroup])
    return Folder(found.lastgroup, version, parts(version)[: len(meant)] == meant, path[found.end() :])


# First part of the include paths of a platform library, by its name in platform_versions.yaml.
_ROOTS = {
    "opencv": ("opencv2/", "opencv/", "cv.h", "highgui.h", "cv_bridge/"),
    "boost": ("boost/",),
    "pcl": ("pcl/", "pcl_"),
    "ffmpeg-libavcodec": ("libav", "libsws"),
    "ffmpeg": ("libav", "libsws"),
    "libav": ("libav", "libsws"),
    "libavcodec": ("libav", "libsws"),
    "libavformat": ("libav", "libsws"),
    "libavutil": ("libav", "libsws"),
    "yaml-cpp": ("yaml-cpp/",),
    "eigen3": ("Eigen/", "eigen3/", "unsupported/Eigen"),
    "gazebo": ("gazebo/",),
    "gazebo-classic": ("gazebo/",),
    "qt5": ("Q",),
    "qt6": ("Q",),
    "qt4": ("Q",),
    "assimp": ("assimp/",),
    "fcl": ("fcl/",),
    "fmt": ("fmt/",),
    "tinyxml": ("tinyxml",),
    "tinyxml2": ("tinyxml2",),
    "ogre": ("Ogre", "OGRE/"),
    "octomap": ("octomap/",),
    "protobuf": ("google/protobuf/",),
    "vtk": ("vtk",),
    "python3": ("Python.h",),
    "python": ("Python.h", "boost/python", "numpy/", "pybind11/"),
    "numpy": ("numpy/",),
    "bullet": ("bullet/", "btBullet", "LinearMath/"),
    "console-bridge": ("console_bridge/",),
    "urdfdom-headers": ("urdf_model", "urdf_", "urdf/"),
    "openssl": ("openssl/",),
    "ompl": ("ompl/",),
    "tbb": ("tbb/",),
    "jsoncpp": ("json/", "jsoncpp/"),
    "orocos-kdl": ("kdl/",),
    "geographiclib": ("GeographicLib/",),
    "glog": ("glog/",),
    "ceres": ("ceres/",),
    "spdlog": ("spdlog/",),
}


def include_roots(name: str) -> tuple[str, ...]:
    """How include paths of a library or package begin, empty where that is not known."""
    return _ROOTS.get(name, ())
