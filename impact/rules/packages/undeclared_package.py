"""undeclared-package: something of another package is used and no dependency brings it.

What it does
    Reports packages and system libraries that CMake or pkg-config is asked for, sources include, Python imports, launch
    files or scripts start, when neither the manifest nor anything it declares brings them, directly or in turn; or when
    a single declared package happens to bring them. Reports what ament_auto is told to require under a name that the
    manifest does not have, commands that make tests and that no declared package brings, and the one package of its
    repository that a metapackage leaves out.

Why it breaks
    The build works on the machine of whoever happens to have the package. On a machine that has just what the manifest
    declares (a build farm, a new colleague, the robot) the configuration, the compiler, or the node stops.

Severity
    error: an unconditional find_package(REQUIRED), catkin component, pkg_check_modules(REQUIRED), include of compiled
    code (or of an installed header that another package here compiles) or test command that is sure to miss its package
    on a clean machine of the target: nothing that is declared brings it, and where the target's manifest of something
    declared is not known, no version of that in any distro does; and what ament_auto refuses. warning: tests, imports,
    launch files, installed headers that nothing here compiles, what only comes along with another dependency, or where
    a dependency is known nowhere and may bring it (one called as interfaces are brings interfaces). note: conditional
    code, examples, documentation, files that nothing compiles, and all but the first few imports, launch references and
    borrowed packages of a package.

Example
    find_package(tf2_eigen REQUIRED)            # and package.xml does not mention tf2_eigen

Use instead
    <depend>tf2_eigen</depend>

Not reported
    What several declared packages bring; client libraries and common system libraries that come through another
    declared package; code that is switched off on the target; nodes of other workspaces that start only under an
    argument; names that nobody is known to provide (they are counted as unresolved).
"""

import posixpath
import re

from ...model.cmake.build import At
from ...model.misspelling import folded, one_edit
from ...model.view import Need, View, weight
from ..evidence import circular, name_to_declare, present
from ..fix_actions import Declare
from ..rule import Hit, rule

# Tools that people start on their own desk.
_VIEWERS = (
    "rviz",
    "rqt",
    "image_view",
    "joint_state_publisher",
    "moveit_ros_benchmarks",
    "joint_state_publisher_gui",
    "plotjuggler",
    "teleop_",
    "joy",
    "moveit_setup_assistant",
    "urdf_tutorial",
    "turtlesim",
)
_ON_THE_DESK = frozenset(
    [
        "python3-matplotlib",
        "python-matplotlib",
        "python3-pytest",
        "python-pytest",
        "python-gtk2",
        "python3-tk",
        "python-tk",
    ]
)
_COMPILED = (".cpp", ".cc", ".cxx", ".c", ".h", ".hpp", ".hh")
LOUD = 2
# The macros that make tests bring these headers.
WITH_TESTS = ("gtest/", "gmock/")
# Whoever starts a launch file has these: the launch tool itself brings them.
_LAUNCHING = frozenset(
    {"launch", "launch_ros", "launch_xml", "launch_yaml", "roslaunch", "launch_testing", "launch_testing_ros"}
)


# Client libraries and what their own headers include: always there with them, and customarily not declared apart.
WITH_CLIENT = frozenset(
    [
        "roscpp",
        "rospy",
        "rosconsole",
        "rostime",
        "xmlrpcpp",
        "roslib",
        "cpp_common",
        "roscpp_traits",
        "roscpp_serialization",
        "class_loader",
        "pluginlib",
        "nodelet",
        "tf",
        "tf2",
        "tf2_ros",
        "tf2_msgs",
        "eigen_conversions",
        "tf_conversions",
        "message_filters",
        "rclcpp",
        "rclcpp_components",
        "rclcpp_lifecycle",
        "rclpy",
        "rcl",
        "rcutils",
        "builtin_interfaces",
        "std_msgs",
        "geometry_msgs",
        "sensor_msgs",
        "nav_msgs",
        "catkin",
        "actionlib",
        "dynamic_reconfigure",
        "message_generation",
        "message_runtime",
        "genmsg",
        "rcl_interfaces",
        "opencv2",
        "opencv3",
    ]
)
# Keys that most graphs of dependencies bring anyway.
_COMMON_KEYS = frozenset(
    {
        "boost",
        "libboost-dev",
        "libboost-all-dev",
        "libopencv-dev",
        "opencv2",
        "python3-dev",
        "python-dev",
        "eigen",
        "libpcl-all-dev",
        "python",
        "python3",
        "liborocos-kdl-dev",
    }
)


@rule(severity="error")
def undeclared_package(view: View):
    for package in view:
        closure = view.closure(package)
        declared = view.declared(package)
        missing: dict[str, list[Need]] = {}
        borrowed: dict[str, list[Need]] = {}
        for need in view.needs(package):
            direct = view.answered(need.providers, declared)
            if (direct and not _by_chance(view, need, declared, closure)) or (
                need.subject.startswith(WITH_TESTS) and need.role == "test"
            ):
                continue
            name = name_to_declare(view, need)
            if name is None or name == package.name:
                continue
            (borrowed if view.answered(need.providers, closure) else missing).setdefault(name, []).append(need)
        # Whichever member of a group is there can bring anything.
        grouped = any(d.kind == "group" for d in package.manifest.dependencies)
        blind = grouped or view.blind(package)
        yield from _refused(view, package)
        yield from _borrowed(view, package, borrowed)
        yield from _test_commands(view, package, blind)
        yield from _left_out(view, package)
        if not missing:
            continue
        spoken = 0
        firsts = sorted(((min(needs, key=weight), name) for name, needs in missing.items()), key=lambda f: weight(f[0]))
        for first, name in firsts:
            severity = _severity(view, package, first, name, grouped or (blind and view.blind(package, name)))
            if severity is None:
                continue
            if severity == "warning" and first.how in ("launch", "plugin", "shell", "import"):
                # A package that leaves out many is told so by the first few; the rest follow as notes.
                spoken += 1
                severity = "warning" if spoken <= LOUD else "note"
            yield Hit(
                at=first.at,
                subject=name,
                message=f"{_how(first)}, and nothing that `{package.name}` declares brings `{name}`",
                help=f"add `<{(tag := _tag(first, package.manifest.format))}>{name}</{tag}>` to "
                f"{package.digest.manifest_path}",
                package=package.name,
                severity=severity,
                fix=_cure(view, package, first, name) if severity != "note" else (),
            )


def _refused(view: View, package):
    """What ament_auto is told to require, and refuses: what package.xml does not name among the dependencies to build
    with. Another name for the same, such as its rosdep key, does not count. Source: ament_cmake_auto's
    ament_auto_find_build_dependencies.cmake, the same in all distros."""
    named = {d.name for d in package.manifest.dependencies if d.kind in ("build", "buildtool", "test")}
    for found in package.build.found:
        if found.how != "ament_auto" or not found.required or found.name in named or "$" in found.name:
            continue
        if view.active(found.conditions):
            yield Hit(
                found.at,
                found.name,
                f"`{found.name}` is REQUIRED of ament_auto, which refuses what `{package.name}` does not declare",
                f"declare `{found.name}` by this name, or find_package({found.name} REQUIRED) on its own",
                package.name,
                severity="error" if view.certain(found.conditions) else "warning",
            )


def _by_chance(view: View, need: Need, declared, closure) -> bool:
    """True where nothing brings the system library itself, only a key of another one that depends on it somewhere."""
    first = need.providers[0]
    if need.how not in ("find_package", "include") or first.kind != "system" or not first.name:
        return False
    itself = tuple(p for p in need.providers if p.kind == "ros" or first.package in (p.package, *view.debian(p.name)))
    if view.answered(itself, closure):
        return False
    # `geos` is libgeos++-dev's, whatever it installs here
    return not any(_bare(name) in _bare(first.name) for name in declared if view.answered(need.providers, {name: name}))


def _bare(key: str) -> str:
    return re.sub(r"^lib|-dev$|^python3?-|[\d.]+$", "", key)


def _borrowed(view: View, package, borrowed: dict[str, list[Need]]):
    """What a package uses and a single declared dependency happens to bring: it leaves when that one drops it. What two
    declared dependencies bring seldom does, and is told only where the configuration itself asks for it."""
    told = []
    declared = view.declared(package)
    brought_by = view.brought_by(package) if borrowed else {}
    for name, needs in borrowed.items():
        if name.startswith(("ament_", "rosidl_", "rmw")):
            continue
        strong = [n for n in needs if n.certain and n.required and _leans(view, n, name)]
        if not strong:
            continue
        first = min(strong, key=weight)
        sources = [d for d in declared if view.answered(first.providers, view.spread([d]))]
        if not 1 <= len(sources) <= _SOURCES[first.how]:
            continue
        if (
            first.how == "include"
            and name in view.workspace.packages
            and brought_by.get(name, "") in view.workspace.packages
            and view.target.ros == 1
        ):
            continue  # one repository, built in its order
        told.append((len(sources), weight(first), name, sources, first))
    for rank, (_, _, name, sources, first) in enumerate(sorted(told, key=lambda t: t[:3])):
        tag = _tag(first, package.manifest.format)
        yield Hit(
            first.at,
            name,
            f"{_how(first)}, and `{name}` only comes along with {' and '.join(f'`{s}`' for s in sources)}",
            f"add `<{tag}>{name}</{tag}>` to {package.digest.manifest_path}",
            package.name,
            severity="warning" if rank < LOUD else "note",
            fix=_cure(view, package, first, name) if rank < LOUD else (),
        )


# Commands that tests are made with, and the packages they come from (their CMake extras in ament_cmake, launch and
# ament_cmake_ros).
_COMMANDS = {
    "ament_add_gtest": "ament_cmake_gtest",
    "ament_add_gtest_executable": "ament_cmake_gtest",
    "ament_add_gmock": "ament_cmake_gmock",
    "ament_add_gmock_executable": "ament_cmake_gmock",
    "ament_add_pytest_test": "ament_cmake_pytest",
    "ament_add_google_benchmark": "ament_cmake_google_benchmark",
    "ament_add_nose_test": "ament_cmake_nose",
    "add_launch_test": "launch_testing_ament_cmake",
}


def _test_commands(view: View, package, blind: bool):
    """Commands that make tests, where neither find_package nor ament_lint_auto, which finds what is declared for tests,
    can have brought them."""
    if not package.build_type.startswith("ament"):
        return
    declared = view.declared(package)
    told = set()
    for use in package.build.uses:
        name = _COMMANDS.get(use.name) if use.kind == "command" else None
        if name is None or name in told or not view.active(use.conditions) or not present(view, name):
            continue
        told.add(name)
        sure = use.conditions and all("TESTING" in c.text for c in use.conditions)
        if name in view.closure(package) or name in view.spread(f.name for f in package.build.found):
            continue
        yield Hit(
            use.at,
            name,
            f"`{use.name}` comes from `{name}`, and nothing that `{package.name}` declares brings it",
            f"add `<test_depend>{name}</test_depend>` to {package.digest.manifest_path}, and "
            f"find_package({name} REQUIRED)",
            package.name,
            severity="error" if not blind and sure and name not in view.may_bring(package) else "warning",
            fix=() if declared.get(name) else (Declare(package.digest.manifest_path, name, "test_depend"),),
        )


def _left_out(view: View, package):
    """The one package of its repository that a metapackage forgets."""
    if not package.manifest.metapackage:
        return
    declared = view.declared(package)
    folder = posixpath.dirname(package.path)
    members = {p.name for p in view.everyone() if not p.manifest.metapackage and posixpath.dirname(p.path) == folder}
    missing = [name for name in members - declared.keys() if not _APART.search(name)]
    if len(missing) != 1 or len(members & declared.keys()) < _MEMBERS or missing[0] == package.name:
        return
    tag = "exec_depend" if package.manifest.format > 1 else "run_depend"
    yield Hit(
        At(package.digest.manifest_path, 1),
        missing[0],
        f"the metapackage `{package.name}` brings every package of its repository except `{missing[0]}`",
        f"add `<{tag}>{missing[0]}</{tag}>`, if that is not meant",
        package.name,
        severity="warning",
    )


# A metapackage that brings fewer packages says nothing of what it should.
_MEMBERS = 3
_APART = re.compile(
    r"(^|_)(tests?|testing|examples?|demos?|tutorials?|benchmarks?|experimental|data|dev|simulation|gazebo)(_|$)"
)


# By how many declared dependencies something may come along and still be told.
_SOURCES = {"include": 1, "import": 1, "find_package": 2, "component": 3, "pkg-config": 1}


def _leans(view: View, need: Need, name: str) -> bool:
    """True where losing what only comes along would stop the build, or an import of the workspace's own."""
    ours = name in view.workspace.packages
    ros = ours or view.target.version(name) is not None
    if need.how == "import":
        return ours and need.role == "run"
    if need.role != "build" or name in WITH_CLIENT or (not ros and name in _COMMON_KEYS):
        return False
    return need.how in ("find_package", "component", "pkg-config") or (need.how == "include" and bool(need.targets))


def _severity(view: View, package, need: Need, name: str, blind: bool) -> str | None:
    if need.role == "aside":
        return "note"
    if not present(view, name):
        return None  # unreleased-package says it
    asked = need.how in ("find_package", "component", "pkg-config")
    if asked and (not need.required or not any(p.sure for p in need.providers)):
        return "note"
    if need.how in ("launch", "plugin", "shell") or name in _LAUNCHING:
        # What starts only under an argument is started sooner or later, where it lies in the workspace itself.
        wanted = need.required or (need.how == "launch" and name in view.workspace.packages)
        loud = wanted and need.role == "run" and name not in _LAUNCHING and not name.startswith(_VIEWERS)
        return "warning" if loud else "note"
    if need.role == "test" or need.how == "import":
        return (
            "warning"
            if need.required and name not in _ON_THE_DESK and (need.role != "test" or name not in WITH_CLIENT)
            else "note"
        )
    if not need.certain:
        return "note"
    if need.how == "include" and not need.targets:
        # Nothing here compiles an installed header on its own; whoever includes it needs what it includes.
        passed_on = (
            need.public
            and need.providers[0].kind == "ros"
            and name not in WITH_CLIENT
            and not need.subject.startswith(WITH_TESTS)
        )
        if not passed_on or circular(view, package, name):
            return "note"
        return "error" if _stops_another(view, package, need) else "warning"
    if blind or view.answered(need.providers, view.may_bring(package)):
        return "warning"
    if need.how == "include" and not any(
        view.certain(target.conditions) for target in package.build.targets if target.name in need.targets
    ):
        return "warning"  # installed in any case, and compiled only under a condition
    first = need.providers[0]
    if first.kind == "system" and view.sealed(package):
        return "warning"
    # By its name alone it is theirs: a header that lies beside others, or one that the release is known to lack.
    guessed = need.how == "include" and not first.sure
    if guessed and first.kind == "system":
        return "warning"
    if guessed and not _generated(view, first.name, need.subject):
        return "warning" if view.has_released_header(first.name, need.subject) is False else "error"
    return "error"


# What a package that generates messages hands on to whoever uses them.
_RUNTIMES = frozenset({"message_runtime", "message_generation", "rosidl_default_runtime"})
_OF_INTERFACE = re.compile(r"[\w-]+/(?:[A-Z]\w*\.h|(?:msg|srv|action)/[a-z]\w*\.hpp)\Z")


def _generated(view: View, name: str, header: str) -> bool:
    """True for the header of an interface, which no tree of the released package shows."""
    return bool(_OF_INTERFACE.match(header)) and not _RUNTIMES.isdisjoint(view.installed_with(name))


def _stops_another(view: View, package, need: Need) -> bool:
    """True when another package of the workspace compiles the installed header, and nothing brings it what that
    includes either."""
    for other in view.everyone():
        if other.name == package.name:
            continue
        for include in other.digest.includes:
            if include.role != "build" or not include.targets or not view.certain(include.conditions):
                continue
            if need.subject not in view.outward((include.path,))[0] or view.blind(other):
                continue
            if not view.answered(need.providers, view.may_bring(other)):
                return True
    return False


def _how(need: Need) -> str:
    return {
        "find_package": f"CMake looks for `{need.subject}`",
        "component": f"CMake asks catkin for `{need.subject}`",
        "pkg-config": f"pkg-config is asked for `{need.subject}`",
        "include": f"`{need.subject}` is included",
        "import": f"`{need.subject}` is imported",
        "launch": f"`{need.subject}` is "
        + ("looked up at run time" if need.at.path.endswith(_COMPILED) else "used when launching"),
        "plugin": f"a plugin of `{need.subject}` is loaded",
        "shell": f"`{need.subject}` is run by a script",
    }[need.how]


def _cure(view: View, package, need: Need, name: str) -> tuple[Declare, ...]:
    """Nothing where the manifest has the name with a slip in it, which is another rule's to cure."""
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
