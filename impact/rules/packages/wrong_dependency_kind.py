"""wrong-dependency-kind: a dependency is declared, and not as what it is used for.

What it does
    Reports packages that built code needs and the manifest declares only for tests or for running, packages that an
    installed header includes, or an exported library links, and the manifest does not pass on to dependants, packages
    needed at run time that are declared for building only, and keys that bring a library without the headers that are
    used.

Why it breaks
    A build without tests, or a machine that only builds, lacks the package. A dependant that includes the public header
    finds the header's own includes missing, or links a library that it does not have. An installed robot lacks what the
    node imports.

Severity
    error where nothing that is declared brings the headers that compiled code includes, and where the build farm, which
    installs no dependencies to run, lacks what CMake or the compiler needs; warning; note where rosdep
    installs the package all the same (declared for running, needed to build), and where what is needed to run is
    declared for tests.

Example
    <test_depend>moveit_ros_planning</test_depend>      # and CMakeLists.txt finds it outside BUILD_TESTING

Use instead
    <depend>moveit_ros_planning</depend>

Not reported
    What another declared dependency brings as the right kind.
"""

import re

from ...model.view import View
from ..evidence import circular
from ..fix_actions import Declare, Remove
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text
from .clean_machine import doubts_of_chance

_FOR_BUILD = frozenset({"build", "buildtool", "build_export", "buildtool_export"})
_FOR_RUN = frozenset({"exec", "build_export"})


_AS_DEPEND = "declare it as `<{tag}>`"


@rule(
    scope="target",
    severity="error",
    texts={
        "build, for tests": Text("`{subject}` is needed to build but is declared only for tests", _AS_DEPEND),
        "build, to run": Text("`{subject}` is needed to build but is declared only to run", _AS_DEPEND),
        "run, for tests": Text("`{subject}` is needed to run but is declared only for tests", _AS_DEPEND),
        "run, to build": Text("`{subject}` is needed to run but is declared only to build", _AS_DEPEND),
        "public": Text("an installed header includes `{header}`, but dependants do not get `{subject}`", _AS_DEPEND),
        "linked": Text(
            "dependants link `{library}` along with the exported library, but do not get `{subject}`", _AS_DEPEND
        ),
        "bare": Text(
            "`{declared}` brings no headers, but `{header}` needs those of `{subject}`", "declare `{subject}`"
        ),
        "public bare": Text(
            "an installed header includes `{header}`, but dependants get `{declared}`, which has no headers",
            "declare `{subject}` as `<{tag}>`",
        ),
    },
)
def wrong_dependency_kind(view: View):
    for package in view:
        declared = view.declared(package)
        build, exported, run = None, None, None
        seen, old = set(), package.manifest.format == 1
        yield from _linked_on(view, package, declared)
        yield from _without_headers(view, package, declared)
        for need in view.weighed(package):
            own = [p.name for p in need.providers if p.name in declared]
            if not own or not need.certain or not need.required or any(n in seen for n in own):
                continue
            kinds = set().union(*(declared[n] for n in own))
            name = own[0]
            if need.role == "build" and need.how in ("find_package", "component", "include"):
                if not kinds & _FOR_BUILD:
                    build = (
                        build if build is not None else view.spread(n for n, k in declared.items() if k & _FOR_BUILD)
                    )
                    if view.answered(need.providers, build):
                        continue
                    # rosdep installs run dependencies along, so only the order of a clean build suffers
                    comes = (old or kinds <= {"exec"}) and name not in view.workspace.packages and kinds != {"test"}
                    doubts = (Doubt.DISPENSABLE if comes else Doubt.LATE,)
                    if not doubts_of_chance(view, package, need):
                        doubts = ()  # the build farm does not install it
                    seen.add(name)
                    kind = "build, for tests" if kinds == {"test"} else "build, to run"
                    data = {"tag": "build_depend" if old else "depend"}
                    fix = _declare(view, package, name, "depend", kinds)
                    yield Diagnostic(need.at, name, package.name, data, kind, doubts, fix=fix)
                elif need.public and need.how == "include" and not kinds & {"build_export", "exec"}:
                    exported = (
                        exported
                        if exported is not None
                        else view.spread(
                            n for n, k in declared.items() if k & {"build_export", "exec", "buildtool_export"}
                        )
                    )
                    if view.answered(need.providers, exported):
                        continue
                    seen.add(name)
                    data = {"header": need.subject, "tag": "run_depend" if old else "depend"}
                    fix = _declare(view, package, name, "depend", kinds)
                    yield Diagnostic(need.at, name, package.name, data, "public", (Doubt.DISTURBS,), fix=fix)
            elif need.role == "run" and need.how in ("import", "launch") and not kinds & _FOR_RUN:
                run = run if run is not None else view.spread(n for n, k in declared.items() if k & _FOR_RUN)
                if view.answered(need.providers, run):
                    continue
                seen.add(name)
                kind, doubt = ("for tests", Doubt.DISPENSABLE) if kinds == {"test"} else ("to build", Doubt.LATE)
                data = {"tag": "run_depend" if old else "exec_depend"}
                fix = _declare(view, package, name, "exec_depend", kinds)
                yield Diagnostic(need.at, name, package.name, data, f"run, {kind}", (doubt,), fix=fix)


def _linked_on(view: View, package, declared):
    """System libraries that an exported library hands on to whoever links it, declared for building only."""
    installed = {item for rule_ in package.build.installs if rule_.kind == "targets" for item in rule_.items}
    linked = {
        link.item: link
        for target in package.build.targets
        if target.name in installed and target.kind in ("library", "interface")
        for link in target.links
        if link.how == "link" and link.visibility != "PRIVATE" and view.active((*target.conditions, *link.conditions))
    }
    exported = None
    for name, kinds in declared.items():
        if "build" not in kinds or kinds & {"build_export", "exec"}:
            continue
        item = next((i for i in linked if view.debian(name) & {f"lib{i}-dev", f"{i}-dev"}), None)
        if item is None:
            continue
        exported = exported if exported is not None else view.spread(n for n, k in declared.items() if k & _FOR_RUN)
        if name in exported:
            continue
        place = next(d for d in package.manifest.dependencies if d.name == name)
        data = {"library": item, "tag": "run_depend" if package.manifest.format == 1 else "depend"}
        fix = _declare(view, package, name, "depend", kinds)
        at = view.manifest_place(package, place)
        yield Diagnostic(at, name, package.name, data, "linked", (Doubt.DISTURBS,), fix=fix)


def _without_headers(view: View, package, declared):
    """Keys that install a library without its headers, where built code wants the headers."""
    bare = {
        name: debian
        for name in declared
        if name.startswith("lib") and (debian := view.debian(name)) and not any(d.endswith("-dev") for d in debian)
    }
    seen = set()
    for need in view.weighed(package) if bare else ():
        if need.how == "include" and need.public and need.certain:
            yield from _handed_on_bare(view, package, declared, bare, need, seen)
        if need.how not in ("find_package", "component", "include", "pkg-config") or need.role != "build":
            continue
        if not need.certain or view.answered(need.providers, declared) or need.providers[0].name in seen:
            continue
        wanted = {
            re.sub(r"(-all)?-dev\Z", "", debian)
            for provider in need.providers
            if provider.kind == "system"
            for debian in view.debian(provider.name)
            if debian.endswith("-dev")
        }
        name = next((n for n, debian in bare.items() if any(_same_library(d, w) for d in debian for w in wanted)), None)
        right = next((p.name for p in need.providers if view.available(p.name)), None)
        if name is None or right is None:
            continue
        seen.add(need.providers[0].name)
        place = next(d for d in package.manifest.dependencies if d.name == name)
        data, doubts = {"declared": name, "header": need.subject}, (_lacks(view, package, need) or Doubt.INCOMPLETE,)
        yield Diagnostic(view.manifest_place(package, place), right, package.name, data, "bare", doubts)


def _lacks(view: View, package, need) -> bool:
    """True when compiled code is sure not to find the headers: nothing that is declared brings them in turn."""
    if need.how == "include" and not need.targets:
        return False
    if not need.required or view.blind(package) or view.opaque_libraries(package):
        return False
    return not view.answered(need.providers, view.may_bring(package))


def _handed_on_bare(view: View, package, declared, bare, need, seen):
    """A library whose headers are declared for building, and without headers for whoever includes the public header."""
    right = next((p.name for p in need.providers if declared.get(p.name) == {"build"}), None)
    if right is None or right in seen:
        return
    stems = {re.sub(r"(-all)?-dev\Z", "", debian) for debian in view.debian(right)}
    name = next(
        (n for n, installed in bare.items() if any(_same_library(d, s) for d in installed for s in stems)), None
    )
    if name is None or name.startswith("libboost") or not declared[name] & _FOR_RUN:
        return
    seen.add(right)
    place = next(d for d in package.manifest.dependencies if d.name == name)
    tag = "run_depend" if package.manifest.format == 1 else "depend"
    data = {"declared": name, "header": need.subject, "tag": tag}
    fix = _declare(view, package, right, "depend", declared[right])
    at = view.manifest_place(package, place)
    yield Diagnostic(at, right, package.name, data, "public bare", (Doubt.DISTURBS,), fix=fix)


def _same_library(installed: str, stem: str) -> bool:
    """True when a package without headers belongs to the library: `libboost-thread1.71.0` to `libboost`."""
    rest = installed[len(stem) :]
    return len(stem) > 4 and installed.startswith(stem) and (not rest or rest[0] in "-0123456789.")


def _declare(view: View, package, name: str, tag: str, kinds: set[str]) -> tuple[Declare | Remove, ...]:
    """What is declared for tests alone is declared anew, since `depend` beside `test_depend` says one thing twice."""
    path = package.digest.manifest_path
    if circular(view, package, name):
        return ()
    if kinds == {"test"} and tag == "depend":
        return (Remove(path, name, "test_depend"), Declare(path, name, tag))
    return (Declare(path, name, tag),)
