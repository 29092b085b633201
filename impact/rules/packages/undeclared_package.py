"""undeclared-package: something of another package is used and no dependency brings it.

What it does
    Reports packages and system libraries that CMake or pkg-config is asked for, sources include, Python imports, launch
    files or scripts start, programs that ExternalProject_Add or FetchContent start, and components with a package of
    their own, when neither the manifest nor anything it declares brings them, directly or in turn; or when they are
    there by chance: installed for another role (a test tool brings what a node imports), or by a package that does not
    hand them on (by its CMake exports or `build_export_depend`). What a rosdep key's packages depend on comes along.

Why it breaks
    The build works on the machine of whoever happens to have the package. On a machine that has just what the manifest
    declares (a build farm, a new colleague, the robot) the configuration, the compiler, or the node stops.

Severity
    error: an unconditional find_package(REQUIRED), component of it or of catkin, pkg_check_modules(REQUIRED), program,
    or include of compiled code (or of an installed header that another package here compiles) that is sure to miss its
    package on a clean machine of the target: nothing that is declared brings it, and where the target's manifest of
    something declared is not known, no version of that in any distro does. What CMake is asked for where tests are
    built counts, since it is asked whenever the package is configured, and so do tests of ROS 2, which are compiled
    along. Also what CMake needs and only dependencies to run bring, which the build farm does not install. warning:
    tests of ROS 1, imports, launch files, installed headers that nothing here compiles, what only comes along with
    another dependency, or where a dependency is known nowhere and may bring it (one called as interfaces are brings
    interfaces). note: conditional code, examples, documentation, files that nothing compiles, and all but the first few
    imports and launch references of a package.

Example
    find_package(tf2_eigen REQUIRED)            # and package.xml does not mention tf2_eigen

Use instead
    <depend>tf2_eigen</depend>

Not reported
    What a declared package exports; modules and nodes that come along with a declared package in the same role; code
    that is switched off on the target; nodes of other workspaces that start only under an argument; names that nobody
    is known to provide (they are counted as unresolved).
"""

from ...model.misspelling import folded, one_edit
from ...model.view import Need, View, weight
from ...model.workspace import Package
from ..evidence import circular, name_to_declare, present
from ..fix_actions import Declare
from ..rule import Diagnostic, rule
from ..severity import AT_RUN_TIME, Repeats
from ..text import Text
from .clean_machine import ASKED, TEST_HEADERS, doubts_of_chance, doubts_of_missing, is_chance

_COMPILED = (".cpp", ".cc", ".cxx", ".c", ".h", ".hpp", ".hh")
_HELP = "add `<{tag}>{subject}</{tag}>` to {manifest}"


@rule(
    scope="target",
    severity="error",
    texts={
        "missing": Text("{use}, and nothing that `{package}` declares brings `{subject}`", _HELP),
        "by chance": Text("{use}, and `{subject}` only comes along with {sources}", _HELP),
    },
)
def undeclared_package(view: View):
    for package in view:
        closure, declared = view.closure(package), view.declared(package)
        missing: dict[str, list[Need]] = {}
        borrowed: dict[str, list[Need]] = {}
        for need in view.needs(package):
            if view.answered(need.providers, declared) or (
                need.subject.startswith(TEST_HEADERS) and need.role == "test"
            ):
                continue
            name = name_to_declare(view, need)
            if name is None or name == package.name:
                continue
            (borrowed if view.answered(need.providers, closure) else missing).setdefault(name, []).append(need)
        yield from _borrowed(view, package, borrowed)
        # A package that leaves out many things it runs with is told of the first few.
        repeats = Repeats(AT_RUN_TIME)
        firsts = sorted(((min(needs, key=weight), name) for name, needs in missing.items()), key=lambda f: weight(f[0]))
        for first, name in firsts:
            doubts = doubts_of_missing(view, package, first, name)
            kind = "run" if first.how not in (*ASKED, "include") else first
            severity = repeats.severity(kind, *doubts)
            yield Diagnostic(
                first.at,
                name,
                package.name,
                _data(package, first),
                kind="missing",
                severity=severity,
                fix=_fix(view, package, first, name) if severity != "note" else (),
            )


def _borrowed(view: View, package: Package, borrowed: dict[str, list[Need]]):
    """What a package uses and does not declare, and what it declares brings by chance: installed along with it for
    another role, or by a package that does not hand it on."""
    declared = view.declared(package)
    for name, needs in borrowed.items():
        strong = [
            n for n in needs if n.certain and (n.required or n.how == "program") and is_chance(view, package, n, name)
        ]
        if not strong:
            continue
        first = min(strong, key=weight)
        sources = tuple(d for d in declared if view.answered(first.providers, view.spread([d])))
        yield Diagnostic(
            first.at,
            name,
            package.name,
            {**_data(package, first), "sources": sources},
            kind="by chance",
            doubts=doubts_of_chance(view, package, first),
            fix=_fix(view, package, first, name),
        )


def _data(package: Package, need: Need) -> dict[str, str]:
    return {
        "use": _describe_use(need),
        "tag": _tag(need, package.manifest.format),
        "manifest": package.digest.manifest_path,
    }


def _describe_use(need: Need) -> str:
    return {
        "find_package": f"CMake looks for `{need.subject}`",
        "part": f"CMake looks for the component `{need.subject}`",
        "component": f"CMake asks catkin for `{need.subject}`",
        "program": f"CMake runs `{need.subject}`",
        "pkg-config": f"pkg-config is asked for `{need.subject}`",
        "include": f"`{need.subject}` is included",
        "import": f"`{need.subject}` is imported",
        "launch": f"`{need.subject}` is "
        + ("looked up at run time" if need.at.path.endswith(_COMPILED) else "used when launching"),
        "plugin": f"a plugin of `{need.subject}` is loaded",
        "shell": f"`{need.subject}` is run by a script",
    }[need.how]


def _fix(view: View, package: Package, need: Need, name: str) -> tuple[Declare, ...]:
    """Nothing where the manifest has the name with a letter wrong, which another rule repairs."""
    if any((folded(d) == folded(name) or one_edit(d, name)) and not present(view, d) for d in view.declared(package)):
        return ()
    if circular(view, package, name):
        return ()
    return (Declare(package.digest.manifest_path, name, _tag(need, 2)),)


def _tag(need: Need, manifest_format: int) -> str:
    if need.role == "test":
        return "test_depend"
    if need.how in ("import", "launch", "plugin", "shell"):
        return "exec_depend" if manifest_format > 1 else "run_depend"
    return "depend" if manifest_format > 1 else "build_depend"
