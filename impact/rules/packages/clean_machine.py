"""What speaks against an error where something is used that a package does not declare.

The question is whether the build or the program is sure to stop on a machine that has just what the manifest brings:
the build farm, which builds packages one by one, or a fresh container after rosdep install, which has what all packages
of the workspace bring.
"""

import posixpath
import re

from ...model.package import find_folder_role, is_called_example
from ..vocabulary import Doubt, Need, Package, TargetView
from .data_files import list_copied
from .dependants import list_compiled_elsewhere
from .install_rules import LAUNCH_FILE, is_installed, list_references, may_stay_behind, read_installs

ASKED = frozenset(("find_package", "part", "component", "pkg-config", "program", "environment"))
"""How CMake asks for something, so that the configuration stops without it."""
_STARTED = frozenset(("launch", "plugin", "shell", "setting"))
TEST_HEADERS = ("gtest/", "gmock/")
"""How the headers begin that macros which make tests bring along."""
# Debian packages of libraries: `libgazebo11-dev`, `libqt5core5a`.
_LIBRARY = re.compile(r"lib|.*-dev\Z")


def collect_missing_doubts(view: TargetView, package: Package, need: Need, name: str) -> tuple[Doubt, ...]:
    """Of a need that nothing which the package declares answers. name: what would answer it, and can be had."""
    if need.role == "aside":
        return (Doubt.EXAMPLE,)
    if need.how in _STARTED or need.how == "import":
        return _collect_run_time_doubts(view, package, need, name)
    if need.how in ASKED and need.how != "program" and not (need.required and any(p.sure for p in need.providers)):
        return (Doubt.DISPENSABLE,)
    if not need.certain:
        return (Doubt.DISPENSABLE,)
    if need.how in ("tool", "environment"):
        return (Doubt.LUCKY,)
    if need.how == "include":
        return _collect_include_doubts(view, package, need, name)
    doubts = _collect_unknown_doubts(view, package, need, name)
    if need.how == "find_package" and not view.is_available(name) and not view.is_surely_package(package, name):
        doubts = (*doubts, Doubt.INCOMPLETE)
    return doubts if need.required else (*doubts, Doubt.CONDITIONAL)


def collect_chance_doubts(view: TargetView, package: Package, need: Need) -> tuple[Doubt, ...]:
    """Of a need that is answered by what happens to be installed along: none where the build farm, which builds the
    package's releases, installs no such thing, as it does not what is declared to run."""
    made = need.role == "build" or (need.role == "test" and need.how in ASKED and view.roles.farm_makes_tests)
    stops = made and (need.how in ASKED or need.targets)
    installed = view.roles.list_on_build_farm(package)
    if not stops or not view.target.was_ever_released(package.name) or view.is_met(need.providers, installed):
        return (Doubt.LUCKY,)
    unknown = view.unknown_contents
    return (Doubt.INCOMPLETE,) if unknown.may_come_along(package) or unknown.list_unknown(installed) else ()


def collect_compile_doubts(view: TargetView, package: Package, need: Need) -> tuple[Doubt, ...]:
    """Of an include that a target compiles, where the compiler is sure to stop at it."""
    doubts = () if view.is_built(need.role) else (Doubt.TEST,)
    if any(view.is_sure(target.conditions) for target in package.build.targets if target.name in need.targets):
        return doubts
    return (*doubts, Doubt.CONDITIONAL)


def is_chance(view: TargetView, package: Package, need: Need, name: str) -> bool:
    """True where what a need rests on is installed for another role than the need's, or is handed on by nobody. name:
    what answers it. Whoever starts launch files has what their command brings, and what is declared for tests brings
    what tests include and import."""
    if need.role == "aside" or (need.how == "include" and not need.targets):
        return False
    if need.role == "run" and view.roles.comes_with_launch(name, need.at.path):
        return False
    used = need.role == "test" and need.how in ("include", "import")
    if used and view.is_met(need.providers, view.roles.list_at_hand(package, "tests alone")):
        return False
    if need.subject == package.build_type:
        return not view.roles.has_build_tool(package, need.subject)
    if not view.is_met(need.providers, view.roles.list_at_hand(package, need.role)):
        return True
    # Modules and nodes are not handed on: whoever has them can use them.
    if need.how not in ASKED and need.how != "include":
        return False
    if comes_from_elsewhere(view, package, need):
        return True
    return not view.is_met(need.providers, view.roles.list_handed_on(package, need.role, need.how != "include"))


def comes_from_elsewhere(view: TargetView, package: Package, need: Need) -> bool:
    """True where, as far as is known, only what the target does not have brings a package of ROS."""
    return need.providers[0].kind == "ros" and not view.is_met(need.providers, view.build_known_environment(package))


def _collect_run_time_doubts(view: TargetView, package: Package, need: Need, name: str) -> tuple[Doubt, ...]:
    """Of modules, and of what launch files and scripts start. What depends on the package itself cannot be declared,
    and who wants both has it; who tries an example out sees what it lacks."""
    if is_called_example(need.at.path):
        return (Doubt.EXAMPLE,)
    if need.how == "import" and need.role == "run" and may_stay_behind(view, package, need.at.path):
        return (Doubt.UNINSTALLED,)
    # A launch file that is called like a test, and does not lie among tests, may be started by hand.
    folder = package.strip_path(need.at.path).rpartition("/")[0]
    by_hand = need.role == "run" or (need.role == "test" and find_folder_role(f"{folder}/") is None)
    if by_hand and view.roles.comes_with_launch(name, need.at.path):
        return (Doubt.DISPENSABLE,)
    if view.is_circular(package, name):
        return (Doubt.DISPENSABLE,)
    # Settings and models are made for what loads them, which may lie in another package.
    if need.how == "setting" and view.is_met(need.providers, view.brought_to_workspace):
        return (Doubt.DISPENSABLE,)
    # What starts only under an argument is started sooner or later, where it lies in the workspace itself.
    wanted = need.required or (need.how == "launch" and name in view.workspace.packages)
    # Of what lies beside tests, the tests themselves are started.
    started = need.role == "run" or (need.role == "test" and need.at.path.endswith((".py", ".test")))
    if not wanted or (need.how in _STARTED and not started):
        return (Doubt.DISPENSABLE,)
    if view.target.ros == 1 or not view.is_available(name) or not _is_reached(view, package, need):
        return (Doubt.LATE,)
    # A fresh container has what all packages of the workspace bring, and whoever starts something its command.
    if view.is_met(need.providers, view.brought_to_workspace) or name in view.list_transitive(["ros2run"]):
        return (Doubt.LUCKY,)
    return _collect_unknown_doubts(view, package, need, name)


def _is_reached(view: TargetView, package: Package, need: Need) -> bool:
    """Whether a need is met whenever something that the package installs is started: an installed launch file that
    starts it in any case, or a program in Python that imports it in any case."""
    path = need.at.path
    if need.role != "run" or not need.required or need.how not in ("import", "launch"):
        return False
    installs = read_installs(view, package)
    installs = (list_copied(package) if installs is None else installs) or []
    if need.how == "launch":
        installed = is_installed(installs, path) and not may_stay_behind(view, package, path)
        return installed and LAUNCH_FILE.search(path) is not None
    of_programs = (rule for rule in installs if rule.kind == "programs" or rule.destination.startswith("lib/"))
    return (
        posixpath.basename(path) in list_references(view, package, "executable")
        or (is_installed(of_programs, path) and not may_stay_behind(view, package, path))
        or any(
            path in file.list_module_paths(posixpath.dirname(setup), module)
            for setup, file in package.linked.setup
            for _, module, *_ in file.entry_points
        )
    )


def _collect_include_doubts(view: TargetView, package: Package, need: Need, name: str) -> tuple[Doubt, ...]:
    first = need.providers[0]
    if not need.targets:
        # Nothing here compiles an installed header on its own; whoever includes it needs what it includes.
        passed_on = need.public and first.kind == "ros" and not need.subject.startswith(TEST_HEADERS)
        if need.role == "test":
            return (Doubt.TEST,)
        if not passed_on or view.is_circular(package, name):
            return (Doubt.UNCOMPILED,)
        return () if _stops_another(view, package, need) else (Doubt.DISTURBS,)
    doubts = (*_collect_unknown_doubts(view, package, need, name), *collect_compile_doubts(view, package, need))
    if _may_fetch_headers(package):
        doubts = (*doubts, Doubt.INCOMPLETE)
    # One in no folder of headers is called so by chance, where a library has its headers without a folder.
    bare = "/" not in need.subject and need.subject not in view.workspace.rooted_headers
    if bare and first.name in view.workspace.packages:
        return (*doubts, Doubt.AMBIGUOUS)
    # By its name alone it is theirs: a header that lies beside others, or one that the release is known to lack.
    if not first.sure and first.kind == "system":
        return (*doubts, Doubt.AMBIGUOUS)
    if not first.sure and not view.generates_header(first.name, need.subject):
        return doubts if view.has_released_header(first.name, need.subject) is not False else (*doubts, Doubt.AMBIGUOUS)
    return doubts


def _may_fetch_headers(package: Package) -> bool:
    """Whether configuring runs programs, which may bring a folder of the package that is searched and not there."""
    build = package.build
    inside = (posixpath.normpath(path) for path, _ in build.include_dirs if path and path[0] not in "/$~.<")
    return bool(build.starts) and any(path not in package.folders for path in inside)


def _collect_unknown_doubts(view: TargetView, package: Package, need: Need, name: str) -> tuple[Doubt, ...]:
    """What speaks against an error where something that comes along has dependencies or contents that are not known,
    so that it may bring what is needed."""
    opaque = view.unknown_contents.list_opaque(package) if need.providers[0].kind == "system" else ()
    # A key that installs no library itself is there for what it brings along.
    if any(debian and not any(map(_LIBRARY.search, debian)) for debian in map(view.list_debs, opaque)):
        return (Doubt.DISPENSABLE,)
    include = need.how == "include" and need.providers[0].kind == "system"
    bundling = view.unknown_contents.list_unread(package) if include else ()
    if opaque or bundling or view.unknown_contents.may_come_along(package, name, need.providers):
        # Nearly every package of ROS 1 that compiles something brings its client library and what comes along with it.
        likely = view.target.ros == 1 and need.providers[0].kind == "ros" and view.roles.comes_with_client_library(name)
        return (Doubt.INCOMPLETE, Doubt.DISPENSABLE) if likely else (Doubt.INCOMPLETE,)
    together = need.role == "test" and not view.roles.farm_makes_tests
    return (Doubt.LUCKY,) if together and view.is_met(need.providers, view.brought_to_workspace) else ()


def _stops_another(view: TargetView, package: Package, need: Need) -> bool:
    """True when another package of the workspace compiles the installed header, and nothing brings it what that
    includes either."""
    return any(
        need.subject in view.find_outward((path,))[0]
        and not view.unknown_contents.may_come_along(other, need.subject, need.providers)
        for other, path in list_compiled_elsewhere(view, package)
    )
