"""dependency-by-chance: something of another package is used, and only comes along with another dependency.

What it does
    Reports what undeclared-package looks for, where something that the manifest declares brings it by chance: installed
    for another role (a test tool brings what a node imports), by a package that does not hand it on (by its CMake
    exports or `build_export_depend`), or by what the target lacks, of which only versions for other distros are known.

Why it breaks
    It is there until the other package drops it. The build farm, which installs no dependencies to run, lacks it today.

Severity
    error for what CMake or the compiler needs and only dependencies to run bring, which the build farm does not
    install; warning otherwise; note where the distro has ended, so that what it brings stays.

Example
    find_package(angles REQUIRED)               # and package.xml declares robot_localization, which uses angles

Use instead
    <depend>angles</depend>

Not reported
    What a declared package exports (indirect-dependency names it); modules and nodes that come along with a declared
    package in the same role; what whoever starts launch files has; conditional code.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Together, list_ended_doubts, make_sort_key, rule
from .clean_machine import collect_chance_doubts, comes_from_elsewhere, is_chance
from .undeclared_needs import declare_need, describe_need, find_kind, find_undeclared, list_sources, make_texts

_ELSEWHERE = ", elsewhere"


@rule(
    group="undeclared-package",
    texts={
        **make_texts("`{subject}` is not declared and comes only through {sources}"),
        **make_texts(
            "`{subject}` is not declared and comes only through {sources}, which {distro} does not have",
            kind=_ELSEWHERE,
        ),
    },
)
def dependency_by_chance(view: TargetView, package: Package):
    for name, needs in find_undeclared(view, package).borrowed.items():
        strong = (need for need in needs if need.certain and (need.required or need.how == "program"))
        first = next((need for need in sorted(strong, key=make_sort_key) if is_chance(view, package, need, name)), None)
        if first is not None:
            sources = list_sources(view, package, first)
            elsewhere = comes_from_elsewhere(view, package, first)
            if elsewhere:
                sources = tuple(source for source in sources if not view.is_available(source)) or sources
            yield Diagnostic(
                first.at,
                name,
                package.name,
                {**describe_need(package, first), "sources": sources, "distro": view.target.distro},
                find_kind(first, _ELSEWHERE if elsewhere else ""),
                doubts=(*collect_chance_doubts(view, package, first), *(() if elsewhere else list_ended_doubts(view))),
                fix=declare_need(view, package, first, name),
                together=(Together("by chance"), Together(f"`{name}` comes by chance", everywhere=True)),
            )
