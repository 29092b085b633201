"""undeclared-through-header: a header of a dependency includes a header of a package that nothing declared brings.

What it does
    Follows the includes of released headers, in the target's versions, to the first headers of other packages.

Why it breaks
    The compiler stops inside somebody else's header on a machine that has only what package.xml declares; elsewhere it
    works by what else happens to be installed.

Severity
    error where a target that is built in any case compiles the include; warning for tests of ROS 1 and for targets that
    are built under a condition.

Example
    #include <tf2/utils.h>      // includes tf2_geometry_msgs, which tf2 does not depend on; package.xml has only tf2

Use instead
    <depend>tf2_geometry_msgs</depend>

Not reported
    Headers whose version on the target was not read, and includes of theirs under a condition; packages that the target
    does not have; code that is not built.
"""

from ....edges.memory import cache_in_derived
from ...targets.target import Provider
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .clean_machine import collect_compile_doubts


@rule(
    texts=Text(
        "`{include}` includes `{header}`, but `{package}` does not depend on `{subject}`",
        help="add `<depend>{subject}</depend>` to {manifest}",
    ),
)
def undeclared_through_header(view: TargetView, package: Package):
    if not package.linked.includes or view.unknown_contents.may_come_along(package):
        return
    closure = view.may_bring(package)
    reported: set[str] = {package.name}
    for need in view.sort_needs(package):
        if need.how != "include" or not need.certain or not view.is_built(need.role) or not need.targets:
            continue
        if not view.is_met(need.providers, closure):
            continue  # undeclared-package reports that
        for name, header in _follow(view, need.subject, need.providers[0]):
            if name in reported or view.is_met(view.find_header(header), closure):
                continue
            reported.add(name)
            yield Diagnostic(
                need.at,
                name,
                package.name,
                {"include": need.subject, "header": header, "manifest": package.linked.manifest_path},
                doubts=collect_compile_doubts(view, package, need),
            )


@cache_in_derived
def _follow(view: TargetView, start: str, owner: Provider) -> list[tuple[str, str]]:
    """The packages of ROS that a released header of a package leads to, besides its own, each with the first header of
    it."""
    found: dict[str, str] = {}
    seen, waiting = {start}, [start] if owner.kind == "ros" else []
    while waiting:
        for header, name in _list_owned(view, waiting.pop()):
            if header in seen:
                continue
            seen.add(header)
            if name == owner.name:
                waiting.append(header)
            elif view.target.find_version(name):
                found.setdefault(name, header)
    return list(found.items())


@cache_in_derived
def _list_owned(view: TargetView, header: str) -> list[tuple[str, str]]:
    """What a released header always includes of packages of ROS, each with the one package that has it."""
    asked = ((path, view.find_header(path)) for path in view.machine.list_always_included(header) if "/" in path)
    return [(path, has[0].name) for path, has in asked if len(has) == 1 and has[0].kind == "ros" and has[0].sure]
