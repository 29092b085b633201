"""missing-catkin-depends: CATKIN_DEPENDS of catkin_package() lacks a package that messages or headers need.

What it does
    Reports packages of whose messages those of a catkin package are made and that it does not name in CATKIN_DEPENDS,
    message_runtime where messages are generated, packages that its exported headers include and that it finds but does
    not name there, and catkin packages that name none at all though their exported headers include those of others.

Why it breaks
    The package builds, and dependants do not get what its messages and headers include, unless they find it themselves.

Severity
    warning; note for messages and headers of packages that the distro brings, since all of them lie in one folder, for
    messages of packages that come along with roscpp, and for `message_runtime` where the distro has ended.

Example
    generate_messages(DEPENDENCIES geometry_msgs)
    catkin_package(CATKIN_DEPENDS message_runtime)

Use instead
    catkin_package(CATKIN_DEPENDS geometry_msgs message_runtime)

Not reported
    What a package in CATKIN_DEPENDS or DEPENDS brings in turn.
"""

from collections.abc import Collection, Iterator

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, list_ended_doubts, rule
from .unlisted_field_package import find_field_owner

# What the generated headers of a package include.
_RUNTIME = "message_runtime"
_ONCE = (Together("not exported"),)
_RUNTIME_ONCE = (*_ONCE, Together(f"{_RUNTIME} is not exported", everywhere=True))


@rule(
    severity="warning",
    group="missing-export",
    texts={
        "headers": Text(
            "an exported header includes `{header}`, but catkin_package() has no CATKIN_DEPENDS",
            "name the packages that the headers and libraries need",
        ),
        "header": Text(
            "an exported header includes `{header}`, but `{subject}` is not in CATKIN_DEPENDS",
            "add `{subject}` to CATKIN_DEPENDS of catkin_package()",
        ),
        "runtime": Text(
            "messages are generated, but `{subject}` is not in CATKIN_DEPENDS",
            "add `{subject}` to CATKIN_DEPENDS of catkin_package()",
        ),
        "messages": Text(
            "the messages use those of `{subject}`, but `{subject}` is not in CATKIN_DEPENDS",
            "add `{subject}` to CATKIN_DEPENDS of catkin_package()",
        ),
    },
)
def missing_catkin_depends(view: TargetView, package: Package):
    if package.build.catkin_package is not None and not package.build.finds_declared:
        yield from _list_of_messages(view, package)
        yield from _list_of_headers(view, package)


def _list_of_messages(view: TargetView, package: Package):
    """Packages of messages that the package's own are made of, and that catkin_package() does not hand on."""
    named = {e.item for e in package.build.exports if e.how in ("catkin_depends", "system_depends")}
    if any("$" in name for name in named):
        return
    reach = view.roles.list_found_with(named)
    made = next((g for g in package.build.generated if g.how == "catkin" and g.offered and g.files), None)
    if made is not None and _RUNTIME not in reach and view.is_sure(made.conditions):
        at, doubts = package.build.catkin_package, list_ended_doubts(view)
        yield Diagnostic(at, _RUNTIME, package.name, kind="runtime", doubts=doubts, together=_RUNTIME_ONCE)
    for made in package.build.generated:
        if made.how != "catkin" or not made.offered or not view.is_sure(made.conditions):
            continue
        owners = _find_field_owners(package, made.files)
        for name, at in made.dependencies:
            if "$" not in name and name not in reach and name in owners:
                reach |= {name}
                apart = name in view.workspace.packages and not view.roles.comes_with_client_library(name)
                doubts = (apart or Doubt.DISPENSABLE,)
                yield Diagnostic(at, name, package.name, kind="messages", doubts=doubts, together=_ONCE)


def _find_field_owners(package: Package, files: Collection[str]) -> set[str]:
    """The other packages of whose messages the fields in these files are, and those of actions are made."""
    owners = {
        find_field_owner(package, field.type)
        for interface in package.linked.interfaces
        if interface.path in files
        for section in interface.definition.sections
        for field in section.fields
    }
    implied = {"actionlib_msgs", "std_msgs"} if any(file.endswith(".action") for file in files) else set()
    return (owners | implied) - {"", package.name}


def _list_of_headers(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """A package of catkin that does not hand on packages whose headers are in what it exports."""
    hows = {e.how for e in package.build.exports}
    if "include_dirs" not in hows or "cfg_extras" in hows:
        return
    if "catkin_depends" in hows:
        yield from _list_unnamed(view, package)
        return
    if "libraries" not in hows:
        return
    found = package.build.catkin_components
    for need in view.sort_needs(package):
        if need.how == "include" and need.public and need.certain and any(p.name in found for p in need.providers):
            at, data = package.build.catkin_package, {"header": need.subject}
            yield Diagnostic(at, "CATKIN_DEPENDS", package.name, data, "headers")
            return


def _list_unnamed(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Packages that an exported header includes, of a package that hands on others."""
    named = {e.item for e in package.build.exports if e.how in ("catkin_depends", "system_depends")}
    if any("$" in name for name in named):
        return
    reach, found = set(view.roles.list_found_with(named)), package.build.catkin_components
    for need in view.sort_needs(package):
        if need.how != "include" or not need.public or not need.certain or view.is_met(need.providers, reach):
            continue
        name = next((p.name for p in need.providers if p.name in found), "")
        if not name or name == package.name or need.providers[0].kind != "ros":
            continue
        reach.add(name)
        # What the distro brings lies in one folder, which whoever finds any package of catkin searches.
        apart = name in view.workspace.packages and package.name in view.workspace.includers
        data = {"header": need.subject}
        yield Diagnostic(need.at, name, package.name, data, "header", (apart or Doubt.DISPENSABLE,), together=_ONCE)
