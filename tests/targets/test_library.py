"""Which Boost headers need a compiled library, and which components a platform's version lacks."""

import pytest
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.providers.library import (
    check_version,
    find_compiled_component,
    find_gone_component,
    find_misspelled_version,
    find_versioned_folder,
)
from rosimpact.impact.targets.providers.providers import load_providers


@pytest.mark.parametrize(
    ("header", "boost", "component"),
    [
        ("boost/program_options.hpp", "1.83", "program_options"),
        ("boost/filesystem/path.hpp", "1.54", "filesystem"),
        ("boost/iostreams/filter/zlib.hpp", "1.71", "iostreams"),
        ("boost/iostreams/stream.hpp", "1.71", None),
        ("boost/archive/text_oarchive.hpp", "1.74", "serialization"),
        ("boost/serialization/singleton.hpp", "1.74", None),
        # Boost 1.76: Regex is headers alone; Boost 1.69: System is
        ("boost/regex.hpp", "1.74", "regex"),
        ("boost/regex.hpp", "1.83", None),
        ("boost/asio.hpp", "1.65", "system"),
        ("boost/asio.hpp", "1.71", None),
        ("boost/asio.hpp", "", None),
        ("boost/thread.hpp", "", "thread"),
        ("boost/thread/mutex.hpp", "1.65", "thread"),
        ("boost/thread/mutex.hpp", "1.71", None),
        ("boost/thread.hpp", "1.71", "thread"),
        ("boost/bind.hpp", "1.54", None),
        ("regex", "1.54", None),
    ],
)
def test_the_compiled_library_of_a_header(header, boost, component):
    assert find_compiled_component(header, boost) == component


@pytest.mark.parametrize(
    ("distro", "component", "gone"),
    [
        ("melodic", "signals", False),
        ("noetic", "signals", True),
        ("jazzy", "exception", False),  # Ubuntu still has its CMake configuration
        ("lyrical", "exception", False),
        ("jazzy", "system", False),
        ("lyrical", "system", True),
    ],
)
def test_a_component_that_is_gone(distro, component, gone):
    target = DistroTarget(distro)
    assert (find_gone_component(target, "Boost", component) is not None) is gone
    known = load_providers()
    if target.platform in known.list_cmake_platforms("boost_regex"):  # Boost brings configurations since 1.70
        assert (target.platform not in known.list_cmake_platforms(f"boost_{component}")) is gone


@pytest.mark.parametrize(
    ("distro", "path", "expected"),
    [
        ("humble", "opencv4/opencv2/core.hpp", ("opencv", True, "opencv2/core.hpp")),
        ("melodic", "opencv4/opencv2/core.hpp", ("opencv", False, "opencv2/core.hpp")),
        ("humble", "pcl-1.10/pcl/point_types.h", ("pcl", False, "pcl/point_types.h")),
        ("noetic", "pcl-1.10/pcl/point_types.h", ("pcl", True, "pcl/point_types.h")),
        # All versions from 2 on are included so; these folders have no version of their own.
        ("humble", "opencv2/core.hpp", None),
        ("humble", "eigen3/Eigen/Core", None),
        ("humble", "pcl/point_types.h", None),
    ],
)
def test_the_folder_of_a_version_in_a_path(distro, path, expected):
    folder = find_versioned_folder(DistroTarget(distro), path)
    assert (folder and (folder.library, folder.there, folder.path)) == expected


@pytest.mark.parametrize(
    ("distro", "name", "version"),
    [
        ("foxy", "ASSIMP", ""),
        ("humble", "ASSIMP", "5.2.2"),
        ("humble", "Assimp", "5.2.2"),
        ("humble", "assimp", ""),
        ("humble", "BOOST", ""),
    ],
)
def test_a_spelling_to_which_a_version_does_not_answer(distro, name, version):
    assert find_misspelled_version(DistroTarget(distro), name) == version


@pytest.mark.parametrize(
    ("platform", "request_", "holds"),
    [
        ("robostack", "1.9.7...<1.10.0", False),
        ("robostack", "1.9.7", True),
        ("conda-forge", "1.9.7...<1.10.0", False),
        (None, "1.9.7...<1.10.0", None),  # the distro's own release, whose rules are not known
    ],
)
def test_conda_builds_libraries_that_the_distro_releases_too(platform, request_, holds):
    answer = check_version(DistroTarget("jazzy", "2026-06-19", platform), "octomap", request_, False)
    assert (answer and answer.holds) is holds


@pytest.mark.parametrize(
    ("package", "request_", "exact", "holds"),
    [
        ("PythonLibs", "3.10", True, False),
        ("PythonLibs", "3.10", False, True),
        ("PythonLibs", "2.7", False, None),
        ("PythonInterp", "3.13", False, False),
        ("spdlog", "1.9", False, True),
        ("spdlog", "0.16", False, False),
        ("urdfdom_headers", "1.0.6", False, False),
        ("urdfdom_headers", "2.0", False, True),
    ],
)
def test_versions_that_configurations_accept(package, request_, exact, holds):
    answer = check_version(DistroTarget("humble", "2026-03-20", "robostack"), package, request_, exact)
    assert (answer and answer.holds) is holds
