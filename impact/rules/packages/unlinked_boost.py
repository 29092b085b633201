"""unlinked-boost: a component of Boost is used and not linked, or linked and not asked for.

What it does
    Reports targets that include a header of Boost whose use needs a compiled component, and that nothing they are given
    links the component to, and targets that link `Boost::x` where find_package(Boost) is not given the component.

Why it breaks
    The linker reports undefined references, or CMake stops at a target that is not defined.

Severity
    For a header of a compiled component: error in an executable, warning in a library, where a dependency may bring the
    component, and where much of it lies in headers alone (filesystem, thread and others), note in tests and, in ROS 1,
    in libraries; error for a component that no exported Boost of ROS 1 has. warning when `Boost::x` is linked and not
    asked for.

Example
    find_package(Boost REQUIRED)
    add_executable(logger src/logger.cpp)       # which includes boost/filesystem.hpp

Use instead
    find_package(Boost REQUIRED COMPONENTS filesystem)
    target_link_libraries(logger Boost::filesystem)

Not reported
    Headers that need no library in the target's version, or of which the package uses nothing; targets that are given
    something that cannot be seen; components that are not asked for where a part of the package's CMake cannot be read.
"""

from collections.abc import Iterator, Set

from ...model.cmake.boost import LinkedBoost, find_linked_boost, lacks_boost, list_asked_components
from ...targets.providers.library import BOOST_COMPILED, find_compiled_component
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_MESSAGE = "`{target}` includes `{header}` but does not link the Boost component `{component}`"


@rule(
    group="library-component",
    texts={
        "boost": Text(_MESSAGE, "find_package(Boost REQUIRED COMPONENTS {component}) and link it"),
        "boost, asked for": Text(_MESSAGE, "link `{subject}` to `{target}`"),
        "not asked for": Text(
            "`{subject}` is linked, but the component `{component}` is not asked for",
            "add `{component}` to find_package(Boost COMPONENTS ...)",
        ),
    },
)
def unlinked_boost(view: TargetView, package: Package):
    asked = list_asked_components(package)
    if asked is not None and not package.build.unresolved:  # what cannot be read may ask for more
        yield from _list_not_asked_for(view, package, asked)
    yield from _list_unlinked(view, package, asked or frozenset())


def _list_not_asked_for(view: TargetView, package: Package, asked: Set[str]) -> Iterator[Diagnostic]:
    """Imported targets of Boost whose component find_package() is not given."""
    seen = set(asked)
    for link in package.build.target_links:
        head, _, component = link.item.partition("::")
        if head != "Boost" or component in seen or component not in BOOST_COMPILED or not view.applies(link.conditions):
            continue
        seen.add(component)
        doubts = (Doubt.INCOMPLETE,)
        yield Diagnostic(link.at, link.item, package.name, {"component": component}, "not asked for", doubts)


def _list_unlinked(view: TargetView, package: Package, asked: Set[str]) -> Iterator[Diagnostic]:
    """Headers of compiled Boost libraries in targets that nothing given to them links the component to."""
    boost = view.target.find_library("boost") or ""
    targets = {t.name: t for t in package.build.targets}
    seen = set()
    for include in package.linked.includes:
        component = find_compiled_component(include.path, boost)
        if component is None or component in seen or include.role == "aside" or not view.is_sure(include.conditions):
            continue
        if include.idle:
            continue
        for name in include.targets:
            if name not in targets or not view.is_sure(targets[name].conditions):
                continue
            known = find_linked_boost(view, package, name, asked)
            if known is None or component in known.linked:
                continue
            own = include.role == "build" and include.at.path in targets[name].sources
            lacking = own and lacks_boost(view, package, targets[name], component)
            if component in known.components and not lacking:
                continue
            seen.add(component)
            asked_for = component in asked
            data = {"target": name, "header": include.path, "component": component}
            kind = "boost, asked for" if asked_for else "boost"
            doubts = () if lacking else _list_doubts(view, include, targets[name], known, component)
            at = targets[name].at if asked_for else include.at
            yield Diagnostic(at, f"Boost::{component}", package.name, data, kind, doubts)
            break


def _list_doubts(
    view: TargetView, include, target, known: LinkedBoost, component: str
) -> tuple[Doubt, ...]:
    sure = not known.more and target.kind == "executable" and component not in _PARTLY_COMPILED
    # Who links a catkin library has Boost from roscpp.
    if include.role != "build" or (view.target.ros == 1 and not sure):
        return (Doubt.DISPENSABLE,)
    return () if sure else (Doubt.INCOMPLETE,)


# Components of which much lies in headers alone, such as `boost::shared_mutex`, and all of some since a version: who
# includes them need not use what is compiled.
_PARTLY_COMPILED = frozenset(
    [
        *("atomic", "chrono", "container", "context", "coroutine", "date_time", "exception", "filesystem", "graph"),
        *("math", "random", "regex", "system", "thread"),
    ]
)
