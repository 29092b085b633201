"""Uses of C++ and Python names of released packages that a target does not serve as they need."""

from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from ....edges.memory import cache_in_derived
from ...model.package import CppApiUse, PythonApiUse
from ...model.python.api import list_packages
from ...targets.changes import find_function
from ...targets.surface.overrides import extract_class, says_override
from ...targets.symbol import Availability, CppUseForm, Symbol
from ..python_files import list_python_doubts
from ..vocabulary import At, Doubt, Package, TargetView, list_place_doubts


class UnservedUse(NamedTuple):
    """A use, how the target stands to it, and what speaks against an error at its place. arguments: how many the call
    of a C++ function has, templated: and how many of a template; keywords: those of a Python call. sure: it surely
    means that name."""

    at: At
    name: str
    found: Availability
    doubts: tuple[Doubt, ...]
    arguments: int = -1
    keywords: tuple[str, ...] = ()
    sure: bool = True
    templated: int = -1


@cache_in_derived
def list_cpp_uses(view: TargetView, package: Package) -> Iterable[UnservedUse]:
    """Uses of C++ names, in the order of the digest. What the target does not compile, and what reviewed tables speak
    of is left out. What an update of the distro breaks is upcoming."""
    if not package.linked.cpp_api:
        return
    calls = {
        find_function(row.symbol.name, "cpp")
        for row in view.availabilities.iterate_reviewed_uses()
        if row.state != "upcoming" and view.offers.find_package(row.package) is None  # else its surfaces know more
    }
    near = view.build_environment(package)
    own = {name for one in view.workspace for name in one.linked.defined}
    unserved: list[tuple[CppApiUse, Availability]] = []
    overridden: set[tuple[str, str]] = set()
    for use in package.linked.cpp_api:
        if use.package not in near or use.name in own or not view.applies(use.conditions):
            continue
        if view.may_have(use.package):
            continue
        if _is_of_another(use.name.partition("::")[0], use.package, near):
            continue  # a name of that package, which this one took over for a while
        if use.name.rpartition("::")[2] in calls or _find_reviewed(view, "c++", _list_tails(use.name)) is not None:
            continue
        form = CppUseForm(use.how, use.arguments, use.given, use.templated)
        found = view.find_availability(Symbol("c++", use.name, (use.package,), form), use.conditions)
        if found.state != "present":
            unserved.append((use, found))
        if use.how == "override" and (found.state == "present" or says_override(use.given, use.arguments)):
            overridden.add((extract_class(use.given, use.arguments), use.name))
    for use, found in unserved:
        if found.form == "unmatched" and any(map(view.may_have, found.symbol.packages)):
            continue  # a base class may be another there
        if _is_silent(use, found) and (extract_class(use.given, use.arguments), use.name) in overridden:
            continue  # another of that name overrides, or is to
        doubts = _collect_cpp_doubts(view, use, found)
        yield UnservedUse(use.at, use.name, found, doubts, use.arguments, sure=use.sure, templated=use.templated)


def _is_of_another(space: str, package: str, near: Collection[str]) -> bool:
    """Whether a namespace is called after something else at hand than the package that has names in it: after that
    itself, or as the package of a library begins (`tl` of tl_expected, `boost` of libboost-dev)."""
    if space == package or space in near:
        return space != package
    starts = (f"{space}_", f"lib{space}")
    return not package.startswith(space) and any(name.startswith(starts) for name in near)


def _is_silent(use: CppApiUse, found: Availability) -> bool:
    """Whether a method that overrides nothing does not say that it does, so that it compiles."""
    return found.form in ("override", "gone") and not says_override(use.given, use.arguments)


def _collect_cpp_doubts(view: TargetView, use: CppApiUse, found: Availability) -> tuple[Doubt, ...]:
    doubts = list_place_doubts(view, use.role, use.conditions)
    if not use.sure or any(package in view.workspace.packages for package in use.through):
        doubts = (*doubts, Doubt.INCOMPLETE)
    if _is_silent(use, found):
        doubts = (*doubts, Doubt.DISTURBS)  # it compiles, and nobody calls it
    return doubts


@cache_in_derived
def list_python_uses(view: TargetView, package: Package) -> Iterable[UnservedUse]:
    """The same of Python; what the workspace provides is left out."""
    if not package.linked.python_api:
        return
    patterns = {
        (use.at.path, use.at.line)
        for use in package.linked.uses
        if use.language == "python" and _find_reviewed(view, "use", (use.text,)) is not None
    }
    # Where a name is written in full, removed-symbol tells what is known of it.
    written = {(use.at.path, use.at.line, use.text) for use in package.linked.names if use.language == "python"}
    for one in package.linked.python_api:
        use = one.use
        head = use.name.partition(".")[0]
        if head in view.own_modules or not use.alone or not view.is_sure(use.conditions):
            continue
        reviewed = _find_reviewed(view, "python", _list_heads(use.name))
        if reviewed is not None and (one.at.path, one.at.line, reviewed.symbol.name) in written:
            continue
        found = view.find_availability(Symbol("python", use.name, tuple(list_packages(head)), use), use.conditions)
        if found.state == "present":
            continue
        if reviewed is not None and found.symbol.name == reviewed.symbol.name and not found.replacement:
            found = found._replace(replacement=reviewed.replacement)
        keywords = use.given.keywords if use.given is not None else ()
        doubts = _collect_python_doubts(view, package, one, found)
        for at in (one.at, *(At(one.at.path, *place) for place in use.more)):
            if (at.path, at.line) not in patterns:
                yield UnservedUse(at, found.symbol.name, found, doubts, keywords=keywords)


def _find_reviewed(view: TargetView, kind: str, names: Iterable[str]) -> Availability | None:
    """What reviewed rows in force say of the first of these names that they speak of."""
    rows = (row for name in names for row in view.find_reviewed(kind, name))
    return next((row for row in rows if row.state != "upcoming"), None)


def _collect_python_doubts(
    view: TargetView, package: Package, one: PythonApiUse, found: Availability
) -> tuple[Doubt, ...]:
    doubts = list_python_doubts(view, package, one.role, one.at.path)
    if one.role == "test":
        doubts = (*doubts, Doubt.TEST)  # nobody waits for it, whatever the build makes of it
    if one.use.lazy:
        doubts = (*doubts, Doubt.LATE)
    return (*doubts, Doubt.DISTURBS) if found.form == "override" else doubts


def _list_tails(name: str) -> Iterator[str]:
    """`a::b::c`, `b::c`, `c`."""
    yield name
    while "::" in name:
        name = name.partition("::")[2]
        yield name


def _list_heads(name: str) -> Iterator[str]:
    """`a.b.c`, `a.b`, `a`."""
    while name:
        yield name
        name = name.rpartition(".")[0]
