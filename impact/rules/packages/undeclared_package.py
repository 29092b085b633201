"""undeclared-package: something of another package is used and no dependency brings it.

What it does
    Reports packages and system libraries that CMake looks for, sources include, Python imports, launch files or scripts
    start, when neither the manifest nor anything it declares brings them, directly or in turn.

Why it breaks
    The build works on the machine of whoever happens to have the package. On a machine that has just what the manifest
    declares (a build farm, a new colleague, the robot) the configuration, the compiler, or the node stops.

Severity
    error: an unconditional find_package(REQUIRED), catkin component or include of compiled code that is sure to miss its
    package on the target. warning: tests, installed headers that the package itself does not compile, imports, launch files, conditional code, or where the manifests that would
    settle it are not known for the target. note: examples and documentation.

Example
    find_package(tf2_eigen REQUIRED)            # and package.xml does not mention tf2_eigen

Use instead
    <depend>tf2_eigen</depend>

Not reported
    What comes through another declared package, even though relying on that is unwise; code that is compiled nowhere;
    names that nobody is known to provide (they are counted as unresolved).
"""

from ...model.view import Need, View
from ..evidence import name_to_declare, present, weight
from ..rule import Hit, rule


# Tools that people start on their own desk.
_VIEWERS = ("rviz", "rqt", "image_view", "joint_state_publisher_gui", "plotjuggler", "teleop_", "joy", "moveit_setup_assistant",
            "urdf_tutorial", "turtlesim")  # fmt: skip
# The macros that make tests bring these headers.
_WITH_TESTS = ("gtest/", "gmock/")
# Whoever starts a launch file has these: the launch tool itself brings them.
_LAUNCHING = frozenset({"launch", "launch_ros", "launch_xml", "launch_yaml", "roslaunch", "launch_testing", "launch_testing_ros"})


@rule(severity="error")
def undeclared_package(view: View):
    for package in view:
        closure = view.closure(package)
        missing: dict[str, list[Need]] = {}
        for need in view.needs(package):
            if view.answered(need.providers, closure) or need.subject.startswith(_WITH_TESTS) and need.role == "test":
                continue
            name = name_to_declare(view, need)
            if name is not None:
                missing.setdefault(name, []).append(need)
        if not missing:
            continue
        blind = bool(view.blind(package))
        for name, needs in missing.items():
            needs.sort(key=lambda n: weight(n))
            first = needs[0]
            severity = _severity(view, first, name, blind)
            if severity is None:
                continue
            yield Hit(
                at=first.at,
                subject=name,
                message=f"{_how(first)}, and nothing that `{package.name}` declares brings `{name}`",
                help=f"add `<{_tag(first, package.manifest.format)}>{name}</{_tag(first, package.manifest.format)}>` to "
                f"{package.digest.manifest_path}",
                package=package.name,
                severity=severity,
            )


def _severity(view: View, need: Need, name: str, blind: bool) -> str | None:
    if need.role == "aside":
        return "note"
    if not present(view, name):
        return None  # unreleased-package says it
    if need.how in ("find_package", "component") and not need.required:
        return "note"
    if need.how in ("launch", "plugin", "shell") or name in _LAUNCHING:
        loud = need.required and need.role == "run" and name not in _LAUNCHING and not name.startswith(_VIEWERS)
        return "warning" if loud else "note"
    if need.role == "test" or need.how == "import":
        return "warning" if need.required else "note"
    if not need.certain:
        return "note"
    if blind or not view.target.knows_manifests or need.how == "include" and not need.targets:
        return "warning"
    ros = name in view.workspace.packages or view.target.version(name) is not None
    return "error" if ros or need.how == "find_package" else "warning"


def _how(need: Need) -> str:
    return {
        "find_package": f"CMake looks for `{need.subject}`",
        "component": f"CMake asks catkin for `{need.subject}`",
        "include": f"`{need.subject}` is included",
        "import": f"`{need.subject}` is imported",
        "launch": f"`{need.subject}` is used when launching",
        "plugin": f"a plugin of `{need.subject}` is loaded",
        "shell": f"`{need.subject}` is run by a script",
    }[need.how]


def _tag(need: Need, manifest_format: int) -> str:
    if need.role == "test":
        return "test_depend"
    if need.how in ("import", "launch", "plugin", "shell"):
        return "exec_depend" if manifest_format > 1 else "run_depend"
    return "depend" if manifest_format > 1 else "build_depend"
