"""unexported-dependency: dependants of a package need a dependency that the manifest does not pass on to them.

What it does
    Reports packages that an installed header includes, and system libraries that an exported library links, which the
    manifest declares for building alone.

Why it breaks
    A dependant that includes the public header finds the header's own includes missing, or links a library that it does
    not have.

Example
    <build_depend>tf2_geometry_msgs</build_depend>      # and include/p/p.hpp includes its headers

Use instead
    <depend>tf2_geometry_msgs</depend>

Not reported
    What another dependency that is passed on brings.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule, translate_tag
from .dependency_kinds import FOR_RUN, fix_kind, list_wrong_kinds

_ONCE = (Together("not handed on"),)
_AS_DEPEND = "declare it as `<{tag}>`"


@rule(
    severity="warning",
    group="wrong-dependency-kind",
    texts={
        "public": Text("an installed header includes `{header}`, but dependants do not get `{subject}`", _AS_DEPEND),
        "linked": Text(
            "dependants link `{library}` along with the exported library, but do not get `{subject}`", _AS_DEPEND
        ),
    },
)
def unexported_dependency(view: TargetView, package: Package):
    tag = translate_tag("depend", package.manifest.format)[-1]
    yield from _list_linked(view, package, tag)
    for need, name, kinds, lacking in list_wrong_kinds(view, package):
        if lacking == "dependants":
            data = {"header": need.subject, "tag": tag}
            fix = fix_kind(view, package, name, "depend", kinds)
            yield Diagnostic(need.at, name, package.name, data, "public", (Doubt.DISTURBS,), fix=fix, together=_ONCE)


def _list_linked(view: TargetView, package: Package, tag: str):
    """System libraries that an exported library hands on to whoever links it, declared for building only."""
    declared = view.collect_declared(package)
    installed = package.build.installed_targets
    linked = {
        link.item: link
        for target in package.build.targets
        if target.name in installed and target.kind in ("library", "interface")
        for link in target.links
        if link.how == "link" and link.visibility != "PRIVATE" and view.applies(link.conditions)
    }
    exported = None
    for name, kinds in declared.items():
        if "build" not in kinds or kinds & {"build_export", "exec"}:
            continue
        item = next((i for i in linked if view.list_debs(name) & {f"lib{i}-dev", f"{i}-dev"}), None)
        if item is None:
            continue
        exported = (
            exported if exported is not None else view.list_transitive(n for n, k in declared.items() if k & FOR_RUN)
        )
        if name in exported:
            continue
        data = {"library": item, "tag": tag}
        fix = fix_kind(view, package, name, "depend", kinds)
        at = view.find_place(package, name)
        yield Diagnostic(at, name, package.name, data, "linked", (Doubt.DISTURBS,), fix=fix, together=_ONCE)
