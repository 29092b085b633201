"""Declared dependencies that are no package on a target, as the rules on them ask for them."""

import posixpath
import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ....edges.memory import cache_in_derived
from ...facts.python.uses import KINDS
from ...targets.changes import DISTROS
from ...targets.providers.stdlib import was_ever_in_stdlib
from ...targets.target import Resolution
from ..vocabulary import At, Doubt, Package, Remove, Replace, TargetView
from .used_names import shows_uses


class UnresolvedName(NamedTuple):
    """A declared name that is no package. at: its place in the manifest. resolution: what rosdep installs for it on the
    target, None for nothing."""

    name: str
    at: At
    resolution: Resolution | None


class IntendedName(NamedTuple):
    """What was meant by a name that is neither a package nor a key. kind: `standard library` (a module of it that the
    package imports), `installing` (a key that installs what the name stands for), `target` (a target of the package
    that declares it), `near` (a slip of a known name), `repository` (packages that are called after it), `related` (the
    one name that it may stand for, or a package of the workspace with another ending or, in a metapackage, with a word
    besides)."""

    kind: str
    names: tuple[str, ...]


@cache_in_derived
def list_unresolved(view: TargetView, package: Package) -> Iterable[UnresolvedName]:
    """The names that a package declares and that are packages neither of the workspace nor of the target."""
    seen = set()
    for dependency in view.list_dependencies(package):
        name = dependency.name
        if name in seen or name in view.workspace.packages or view.target.find_version(name) is not None:
            continue
        seen.add(name)
        if not view.is_private(name):
            resolution = None if view.may_be_unread(name) else view.target.resolve(name)
            yield UnresolvedName(name, view.find_place(package, dependency), resolution)


def list_unknown(view: TargetView, package: Package) -> Iterator[UnresolvedName]:
    """Those of which neither rosdep nor any distro knows the name."""
    target = view.target
    for one in list_unresolved(view, package):
        if one.resolution is None and not target.was_ever_released(one.name) and not target.knows_key(one.name):
            yield one


def list_name_doubts(view: TargetView, package: Package, name: str) -> tuple[Doubt, ...]:
    """What speaks against an error where a declared name is not known: of what only the documentation is made with,
    `rosdep install` asks nothing unless it is told to."""
    kinds = {dependency.kind for dependency in view.list_dependencies(package) if dependency.name == name}
    return (Doubt.DISTURBS,) if kinds == {"doc"} else ()


_MADE = frozenset(("executable", "library", "interface", "module"))


@cache_in_derived
def find_intended(view: TargetView, package: Package, name: str) -> IntendedName | None:
    """What was meant by a name that nobody knows; None where that is not known."""
    if view.may_be_unread(name):
        return None
    if was_ever_in_stdlib(name) and any(item.module.partition(".")[0] == name for item in package.linked.imports):
        return IntendedName("standard library", (name,))
    if installing := find_installing(view, package, name):
        return IntendedName("installing", (installing,))
    if any(made.name == name and made.kind in _MADE for made in package.build.targets):
        return IntendedName("target", (name,))
    near = view.known_names.find_nearest(name)
    if near and view.is_available(near) and not is_used_too(view, package, name):
        return IntendedName("near", (near,))
    if longer := _find_parts(view, name):
        return IntendedName("repository", tuple(longer))
    related = (
        _find_namesake(view, package, name) or _find_reworded(view, name) or _find_lengthened(view, package, name)
    )
    return IntendedName("related", (related,)) if related else None


def is_used_too(view: TargetView, package: Package, name: str) -> bool:
    """Whether the sources of a package use interfaces of a name, or launch files of the workspace its programs: such a
    package is somewhere, and its name not misspelt."""
    folders = tuple(f"{name}/{kind}/" for kind in sorted(KINDS))
    if any(use.path.startswith(folders) for use in package.linked.includes):
        return True
    if any(use.module.partition(".")[0] == name for use in package.linked.imports):
        return True
    return any(use.reference.package == name for one in view.workspace for use in one.linked.references)


def find_installing(view: TargetView, package: Package, name: str) -> str:
    """The key that installs what a name stands for elsewhere: a package of the platform, else a library that
    find_package() or pkg-config finds; empty where there is none, or where a module of Python may be meant."""
    if keys := view.target.find_keys(name):
        return min(keys, key=lambda key: len(view.list_debs(key)))
    if of_ros := find_packaged(view, name):
        return of_ros
    if not package.build.targets and _find_namesake(view, package, name):
        return ""
    providers = (*view.find_cmake(name), *view.providers.find_pkgconfig(name))
    return next((p.name for p in providers if p.kind == "system" and p.sure and view.target.resolve(p.name)), "")


_PACKAGED = re.compile(r"ros-([a-z]+)-([a-z0-9-]+)")


def find_packaged(view: TargetView, name: str) -> str:
    """The package of ROS that a name stands for where that is the one of its Debian package; empty for others."""
    found = _PACKAGED.fullmatch(name)
    package = found[2].replace("-", "_") if found and found[1] in DISTROS else ""
    return package if package and view.is_available(package) else ""


def _find_namesake(view: TargetView, package: Package, name: str) -> str:
    """The one package or key that a library's bare name, with or without its version, may stand for, by what those of
    ROS and Debian are called: the library for what is compiled, else the module. Empty where there is none, or
    several."""
    name = name.rstrip(".0123456789")
    key = f"lib{name}-dev" if package.build.targets else f"python3-{name}"
    found = [f"{name}_vendor", f"ros_{name}", key] if len(name) > 3 else []
    found = [known for known in found if view.is_available(known)]
    return found[0] if len(found) == 1 else ""


_STEM = 5
"""Letters that two forms of a word begin with (simulator, simulation)."""


def _find_reworded(view: TargetView, name: str) -> str:
    """The package of the workspace that differs from a name in the ending of one of several words alone; empty where
    there is none, or several."""
    words, found = name.split("_"), []
    for other in view.workspace.packages:
        pairs = [pair for pair in zip(words, other.split("_"), strict=False) if pair[0] != pair[1]]
        alike = len(words) > 1 and other.count("_") == len(words) - 1 and len(pairs) == 1
        if alike and posixpath.commonprefix(pairs[0])[_STEM - 1 :]:
            found.append(other)
    return found[0] if len(found) == 1 else ""


_MEMBERS = 2
"""Packages of its workspace that a package without uses declares where it is there to bring them."""


def _find_lengthened(view: TargetView, package: Package, name: str) -> str:
    """The package of the workspace that has all words of a name, in order, and one besides, where what declares the
    name is there to bring packages of the workspace, and does not declare that one; empty where there is none, or
    several."""
    declared, words = view.collect_declared(package), name.split("_")
    own = view.workspace.packages
    if len(words) < 2 or shows_uses(package) or package.build.targets or len(own.keys() & declared) < _MEMBERS:
        return ""
    others = {other: other.split("_") for other in own if other != package.name and other not in declared}
    found = [
        other
        for other, longer in others.items()
        if len(longer) == len(words) + 1 and any(longer[:i] + longer[i + 1 :] == words for i in range(len(longer)))
    ]
    return found[0] if len(found) == 1 else ""


def _find_parts(view: TargetView, name: str) -> list[str]:
    """Released packages that are called after a name, two at least, where all are of one repository, or its name is
    that."""
    if len(name) < 4:
        return []
    alike = [n for n in sorted(view.target.list_released()) if n.startswith(f"{name}_") and view.is_available(n)]
    homes = {n: _find_repository_stem(view, n) for n in alike}
    found = [n for n in alike if homes[n] == name] if len(set(homes.values())) > 1 else alike
    return found if len(found) > 1 else []


def _find_repository_stem(view: TargetView, package: str) -> str:
    """The name of the repository that releases a package, without what only tells the generation (`moveit2`)."""
    repository = view.target.find_repository(package)
    return re.sub(r"[-_]*(?:ros)?\d?\Z", "", repository[0]).replace("-", "_") if repository is not None else ""


def replace_name(view: TargetView, package: Package, name: str, guess: str) -> tuple[Replace | Remove, ...]:
    """Writes another name, or takes the wrong one out where that is declared beside it."""
    path = package.linked.manifest_path
    declared = view.collect_declared(package)
    if guess in declared:
        return (Remove(path, name),) if declared[name] <= declared[guess] else ()
    places = dict.fromkeys((d.line, d.column) for d in package.manifest.dependencies if d.name == name)
    return tuple(Replace(path, line, column, name, guess) for line, column in places)
