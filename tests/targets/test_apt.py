"""The graph of apt packages and what CMake's find modules look for: how both are built and read."""

import pytest
from rosimpact.databuild.apt import build_graph, infer_packages, reduce_dependencies
from rosimpact.databuild.find_modules import find_requirements
from rosimpact.impact.targets.providers.apt import Apt, load_apt

BOOKWORM = {
    "libsled-dev": ("libsled1", "libdog-dev"),
    "libsled1": ("libice",),
    "libdog-dev": (),
    "libice": ("build-essential",),
    "build-essential": ("gcc",),
    "gcc": (),
}
TRIXIE = {**BOOKWORM, "libsled-dev": ("libsled1",)}
KEYS = frozenset({"libsled-dev", "libdog-dev", "libqt4-dev", "libpyside-dev"})


@pytest.mark.parametrize(
    ("wanted", "found"),
    [
        ({"libsled-dev", "libice"}, {"libsled-dev": {"libice"}, "libice": set()}),
        ({"libsled-dev", "libsled1", "libice"}, {"libsled-dev": {"libsled1"}, "libsled1": {"libice"}, "libice": set()}),
        ({"gone"}, {}),
    ],
)
def test_packages_in_between_are_left_out(wanted, found):
    assert reduce_dependencies(BOOKWORM, frozenset(wanted)) == found


def test_a_package_brings_another_when_all_of_its_names_come_along():
    names = [("libqt4-dev", "libpyside-dev"), ("libqt4-dev", "libpyside-dev", "libx"), ("libqt4-dev", "libpyside-dev")]
    assert infer_packages([*names, ("libx",), ("libx", "libqt4-dev")]) == {"libpyside-dev": {"libqt4-dev"}}


@pytest.mark.parametrize(
    ("platform", "package", "brought"),
    [
        ("debian bookworm", "libsled-dev", {"libsled-dev", "libdog-dev"}),
        ("debian trixie", "libsled-dev", {"libsled-dev"}),
        ("ubuntu jammy", "libsled-dev", {"libsled-dev", "libdog-dev"}),
        ("ubuntu xenial", "libpyside-dev", {"libpyside-dev", "libqt4-dev"}),
        ("debian bookworm", "libpyside-dev", {"libpyside-dev"}),
        ("ubuntu jammy", "python3-sled", {"python3-sled", "python3"}),
    ],
)
def test_a_platform_without_an_index_takes_what_any_suite_says(platform, package, brought):
    made = build_graph({"debian bookworm": BOOKWORM, "debian trixie": TRIXIE}, KEYS, {"libpyside-dev": {"libqt4-dev"}})
    assert Apt(made, platform).list_added(package) == brought


def test_what_builds_is_everywhere():
    made = build_graph({"debian bookworm": BOOKWORM}, KEYS, {})
    assert Apt(made, "debian bookworm").base == {"build-essential", "gcc"}
    assert {"g++", "make", "patch", "libc6-dev"} <= load_apt("ubuntu jammy").base
    assert not {"git", "pkg-config", "cmake"} & load_apt("ubuntu jammy").base


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("find_path(A_DIR a.h)\nfind_package_handle_standard_args(A REQUIRED_VARS A_DIR)", {"header": ["a.h"]}),
        ("find_path(A_DIR NAMES a.h b.h PATHS /opt DOC x)\nfind_package_handle_standard_args(A DEFAULT_MSG A_DIR)",
         {"header": ["a.h", "b.h"]}),
        ("set(names git)\nif(WIN32)\nset(names git.cmd)\nendif()\nfind_program(GIT NAMES ${names})\n"
         "find_package_handle_standard_args(Git REQUIRED_VARS GIT)", {"program": ["git"]}),
        ("set(required L)\nlist(APPEND required A_DIR)\nfind_path(A_DIR a.h PATH_SUFFIXES a)\n"
         "find_package_handle_standard_args(A REQUIRED_VARS ${required})", {"header": ["a.h"]}),
        ("find_path(A_DIR a.h)\nfind_package_handle_standard_args(A REQUIRED_VARS A_LIBRARY)", {}),
    ],
)  # fmt: skip
def test_what_a_find_module_requires(text, found):
    assert find_requirements(text.encode()) == found
