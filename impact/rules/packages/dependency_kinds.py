"""Dependencies that are declared, and not for what they are used, as the rules on them ask for it."""

from collections.abc import Iterable, Set
from typing import NamedTuple

from ....edges.memory import cache_in_derived
from ...model.cmake.links import list_exported_targets, resolve_package
from ...targets.providers.libraries import load_libraries
from ..vocabulary import Declare, Need, Package, Remove, TargetView
from .clean_machine import TEST_HEADERS

# What is exported is installed for dependants; bloom's Build-Depends of the package itself lack it.
_FOR_BUILD = frozenset({"build", "buildtool"})
_FOR_DEPENDANTS = frozenset({"build_export", "exec", "buildtool_export"})
FOR_RUN = frozenset({"exec", "build_export"})
"""Kinds of dependencies that install what a program needs to run."""


class WrongKind(NamedTuple):
    """A need whose package is declared for something else alone. name: as declared. kinds: those declared. lacking:
    what it is not declared for: `build`, `run`, `linked` (to run, since an installed target is linked to it) or
    `dependants`."""

    need: Need
    name: str
    kinds: Set[str]
    lacking: str


@cache_in_derived
def list_wrong_kinds(view: TargetView, package: Package) -> Iterable[WrongKind]:
    """The first such need of each declared name, the weightiest first."""
    declared = view.collect_declared(package)
    linked = _list_linked(package)
    to_run: dict[str, WrongKind] = {}
    seen: set[str] = set()
    brought: dict[Set[str], frozenset[str]] = {}
    for need in view.sort_needs(package):
        own = [p.name for p in need.providers if p.name in declared]
        if not own or not need.certain or not need.required or any(name in seen for name in own):
            continue
        kinds = frozenset().union(*(declared[name] for name in own))
        lacking, fitting = _find_lacking(need, kinds)
        if not lacking:
            continue
        if lacking == "linked" and (need.subject not in linked or not _has_shared_library(view, need.subject)):
            continue
        if fitting not in brought:
            brought[fitting] = view.list_transitive(name for name, of_name in declared.items() if of_name & fitting)
        if not view.is_met(need.providers, brought[fitting]):
            # Of several that may bring it, the one that is named as it is (`gmock/gmock.h`: libgmock-dev, not gtest).
            head = need.subject.partition("/")[0]
            name = next((name for name in own if head in name), own[0])
            wrong = WrongKind(need, name, kinds, lacking)
            if lacking == "linked":  # unless more is lacking
                to_run.setdefault(name, wrong)
                continue
            seen.add(name)
            yield wrong
    yield from (wrong for name, wrong in to_run.items() if name not in seen)


def _find_lacking(need: Need, kinds: Set[str]) -> tuple[str, Set[str]]:
    """What a need is not declared for, empty where the kinds will do, and the kinds that would."""
    if need.role == "build" and need.how in ("find_package", "component", "include"):
        compiled = need.how != "include" or bool(need.targets)  # else it is for dependants alone
        if compiled and not kinds & _FOR_BUILD:
            return "build", _FOR_BUILD
        tests = need.subject.startswith(TEST_HEADERS)  # whoever includes what helps in tests makes tests
        if need.public and need.how == "include" and not tests and not kinds & {"build_export", "exec"}:
            return "dependants", _FOR_DEPENDANTS
        if need.how == "find_package" and not kinds & FOR_RUN:
            return "linked", FOR_RUN
    elif need.role == "run" and need.how in ("import", "launch") and not kinds & FOR_RUN:
        return "run", FOR_RUN
    return "", frozenset()


def _list_linked(package: Package) -> frozenset[str]:
    """The packages that installed programs and shared libraries are linked to themselves."""
    installed = package.build.installed_targets
    return frozenset(
        resolve_package(link.item)
        for target in package.build.targets
        if target.name in installed and not target.archive and target.kind in ("executable", "library", "module")
        for link in target.links
        if link.how in ("link", "ament")
    )


def _has_shared_library(view: TargetView, name: str) -> bool:
    """Whether a package, by the name that find_package() takes, is known to have a library that is loaded to run."""
    own = view.workspace.packages.get(name)
    if own is not None:
        return any(target.kind == "library" and not target.archive for target in list_exported_targets(own))
    offer = view.offers.find_package(name)
    if offer is not None:
        return any(target.kind == "library" for target in offer.build.targets)
    if view.is_package(name):
        return False
    libraries = load_libraries()
    for library in view.list_libraries(name):
        version = libraries.find_range(library, view.target.platform)[0]
        build = libraries.build(library, version) if version else None
        if build is not None and any(target.kind == "library" for target in build.targets):
            return True
    return False


def fix_kind(view: TargetView, package: Package, name: str, tag: str, kinds: Set[str]) -> tuple[Declare | Remove, ...]:
    """Declares a name for more than it is declared for. What is declared for tests alone is declared anew, since
    `depend` beside `test_depend` says one thing twice."""
    path = package.linked.manifest_path
    if view.is_circular(package, name):
        return ()
    if kinds == {"test"} and tag == "depend":
        return (Remove(path, name, "test_depend"), Declare(path, name, tag))
    return (Declare(path, name, tag),)
