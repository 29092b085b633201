"""Include paths that nobody has: what they were meant to be, and whether that can be known."""

from __future__ import annotations

import posixpath
import re

from ...edges.memory import cache_in_derived
from ..targets.surface.fields import load_fields
from ..targets.symbol import Availability
from .cmake.interpreter import calls_unmodelled
from .misspelling import is_slip
from .package import IncludeUse
from .view import TargetView
from .workspace import Package

INTERFACE_FOLDERS = ("msg", "srv", "action")
"""Where a package of ROS 2 has the headers that are generated from its interfaces."""
# Letters of a file's name: shorter ones are alike by chance.
_SHORTEST = 8
_ENDING = re.compile(r"\.(?:h|hh|hpp|hxx)\Z")
_OF_RECONFIGURE = re.compile(r"(?P<package>\w+)/\w+Config\.h\Z")


def find_misspelt(view: TargetView, package: Package, path: str, includer: str = "") -> str | None:
    """The header of the package that an include path means: it misses it by one letter, by case or ending, or names a
    generated one below what is no package. includer: the file that has the include, where a path such as `../a.h`
    starts. None where somebody has what it names."""
    if path.startswith("."):
        return _find_other_ending(package, path, includer)
    answered = any(provider.sure or provider.name != package.name for provider in view.find_header(path))
    if answered or len(path.rpartition("/")[2]) < _SHORTEST:
        return None
    bare = "/" not in path
    for header in package.linked.headers:
        if header == includer:
            continue  # no header means itself: it is called after what it wraps
        own = header.rpartition("/")[2] if bare else f"/{header}".rpartition("/include/")[2]
        if is_slip(path, own) or _ENDING.sub("", path).lower() == _ENDING.sub("", own).lower():
            return own
    generated = _OF_RECONFIGURE.match(path)
    if generated is None or not any(made.how == "reconfigure" for made in package.build.generated):
        return None
    known = view.is_package(generated["package"]) or generated["package"] in view.collect_declared(package)
    return None if known else f"{package.name}/{path.rpartition('/')[2]}"


def find_standard_header(view: TargetView, path: str) -> str | None:
    """The header of the standard libraries that an include of another name means: `cmath` for `math`."""
    if not path.isidentifier() or view.find_header(path) or path in _list_file_names(view):
        return None
    return next((one for one in (f"c{path}", f"{path}.h") if view.is_standard(one)), None)


def is_answered(view: TargetView, path: str) -> bool:
    """Whether somebody may have a header; a package of the workspace has no more than is known of it, nor has a
    release."""
    found = view.find_header_availability(path)
    if found is not None and found.form == "never":
        return False
    return any(p.sure or p.name not in view.workspace.packages for p in view.find_header(path))


def find_never_installed(view: TargetView, package: Package, include: IncludeUse) -> Availability | None:
    """How the target stands to an included header that no version of the released package which it is called after
    has, or that misses one of its headers by a letter; None where something else may have it."""
    path = include.path
    found = view.find_header_availability(path, include.conditions)
    if found is None or view.underlaid or view.is_private(found.package):
        return None
    if found.alike and is_slip(path, found.alike):
        name = path.rpartition("/")[2]
        made = name in _list_file_names(view) or view.workspace.unread or is_made(package, name)
        return None if made else found
    return found if found.form == "never" and is_nowhere(view, package, include) else None


def is_nowhere(view: TargetView, package: Package, include: IncludeUse) -> bool:
    """Whether an include names what no file of the workspace is called, no build here makes and nobody is known to
    have."""
    path, build = include.path, package.build
    if not include.targets or not view.is_sure(include.conditions) or build.unresolved:
        return False
    # What does not lie where a relative path leads is looked for in the folders that are searched.
    searched_for = path.lstrip("./")
    if is_answered(view, searched_for):
        return False
    name = path.rpartition("/")[2]
    if not re.fullmatch(r"[\w./+-]+\.(?:h|hh|hpp|hxx|H)", path) or name in _list_file_names(view):
        return False
    if may_be_made(package, name) or view.workspace.unread:
        return False
    searched = (*(item for item, _ in build.include_dirs), *(link.item for link in build.target_links))
    if any(item.startswith(("/", "~", "$ENV{")) for item in searched):
        return False  # a folder of the machine
    if view.unknown_contents.may_hold(package, searched_for):
        return False
    passed = (link.item for link in build.target_links if link.how == "ament")
    direct = {*view.collect_declared(package), *(one.name for one in build.found), *passed}
    if path.startswith("."):
        return True
    own = (view.workspace.packages[one] for one in direct if one in view.workspace.packages)
    if any(may_be_made(one, name) for one in own):
        return False
    # A header that lies deeper than the exported folders of most packages is known by the surface of its own alone.
    brought = view.build_environment(package).union(direct)
    return all(_has_known_headers(view, one) for one in direct) and not view.offers.list_packages_with(path, brought)


def may_be_made(package: Package, name: str) -> bool:
    """Whether configuring or building may write a file of this name."""
    return bool(package.build.starts) or calls_unmodelled(package.build) or is_made(package, name)


def is_made(package: Package, name: str) -> bool:
    """Whether what is known of configuring and building may write a file of this name."""
    build = package.build
    if any(made.rstrip("/").endswith(name) or made.endswith("/") for made in build.made):
        return True
    return any(target.kind in ("custom", "external", "fetched", "unknown") for target in build.targets)


def _has_known_headers(view: TargetView, name: str) -> bool:
    """Whether all headers of what has a name are known: a package of the workspace or a released one that a surface is
    stored of, a library of the platform."""
    if (own := view.workspace.packages.get(name)) is not None:
        return not (own.build.unresolved or own.build.builds_others or name.endswith("_vendor"))
    if name in view.preinstalled or name.startswith("python"):
        return True
    if view.is_package(name):
        return view.offers.find_package(name) is not None and not view.unknown_contents.is_carried_library(name)
    keys = (name, *view.list_debs(name), *(p.package or p.name for p in view.find_cmake(name)))
    return view.providers.knows_system(keys)


@cache_in_derived
def _list_file_names(view: TargetView) -> frozenset[str]:
    """The names of all files of the workspace, and those that they are installed as."""
    files = (path for package in view.workspace for path in package.linked.files)
    names = {path.rpartition("/")[2] for path in files}
    return frozenset(names.union(rule.rename for package in view.workspace for rule in package.build.installs))


def _find_other_ending(package: Package, path: str, includer: str) -> str | None:
    """The path of the header that lies where a relative path leads, with another ending."""
    place = posixpath.normpath(posixpath.join(posixpath.dirname(includer), path))
    last = path.lstrip("./")
    if place in package.files or any(f"/{header}".endswith(f"/{last}") for header in package.linked.files):
        return None
    stem = _ENDING.sub("", place)
    for header in package.linked.headers:
        if header != place and _ENDING.sub("", header) == stem:
            return posixpath.join(posixpath.dirname(path), posixpath.basename(header))
    return None


def is_bridge(view: TargetView, package: Package) -> bool:
    """Whether a package is built for both generations of ROS, or with packages of ROS 1 that ros1_bridge finds, and
    therefore includes headers of both."""
    if view.target.ros != 2:
        return False
    bridged = "ros1_bridge" in view.collect_declared(package)
    return bridged or any(include.path.startswith("ros/") for include in package.linked.includes)


# What the C++ files of a generation of ROS include.
_CLIENT_LIBRARIES = {1: "ros/", 2: "rclcpp/"}


def list_files_of_other_generation(view: TargetView, package: Package) -> frozenset[str]:
    """The C++ files of a package for both generations that are for the one which the target is not of."""
    own, other = (_CLIENT_LIBRARIES[ros] for ros in (view.target.ros, 3 - view.target.ros))
    including = {
        client: frozenset(i.at.path for i in package.linked.includes if i.path.startswith(client))
        for client in (own, other)
    }
    return including[other] - including[own] if including[own] else frozenset()


def is_nobody(view: TargetView, name: str) -> bool:
    """Whether no package is known by a name, and none of the workspace declares one."""
    return not (
        view.is_package(name)
        or view.is_private(name)
        or any(name in view.collect_declared(p) for p in view.list_built())
    )


def find_interface_folder(view: TargetView, head: str, stem: str) -> str:
    """The folder of the only generated header of a package with this stem; empty where the package has such a header
    beside the folders."""
    if head in view.workspace.packages:
        made = {one for one in INTERFACE_FOLDERS if view.workspace.is_interface_header(head, f"{one}/{stem}.hpp")}
    elif view.providers.list_known_releases(head) and not view.providers.list_header_spans(head, f"{head}/{stem}.hpp"):
        history = load_fields().find_history(head, view.target.ros)
        made = {one for one in INTERFACE_FOLDERS if history is not None and f"{one}/{stem}" in history.by_header}
    else:
        return ""
    return made.pop() if len(made) == 1 else ""


def generates_interfaces(view: TargetView, name: str) -> bool:
    """True for packages that make headers from messages, services or actions, as far as their name tells it."""
    package = view.workspace.packages.get(name)
    if package is not None:
        return package.is_interface_package
    return name.endswith(("_msgs", "_interfaces", "_srvs", "_actions")) and view.target.find_version(name) is not None
