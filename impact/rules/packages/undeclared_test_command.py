"""undeclared-test-command: a command that makes tests comes from a package that nothing declared brings.

What it does
    Looks for commands of ament's test packages where neither find_package nor ament_lint_auto, which finds what is
    declared for tests, can have brought them.

Why it breaks
    CMake stops at an unknown command wherever tests are built, on a machine that has just what package.xml declares.

Severity
    error where only the option that builds tests stands around it, and all that is declared is known; warning
    otherwise.

Example
    ament_add_gtest(test_dock test/dock.cpp)    # and package.xml does not mention ament_cmake_gtest

Use instead
    <test_depend>ament_cmake_gtest</test_depend>

Not reported
    Commands whose package is found by name, or along with another one.
"""

from ...model.view import View
from ..evidence import present
from ..fix_actions import Declare
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text
from .clean_machine import is_grouped

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


@rule(
    scope="target",
    severity="error",
    group="undeclared-package",
    texts=Text(
        "`{command}` comes from `{subject}`, and nothing that `{package}` declares brings it",
        help="add `<test_depend>{subject}</test_depend>` to {manifest}, and find_package({subject} REQUIRED)",
    ),
)
def undeclared_test_command(view: View):
    for package in view:
        if not package.build_type.startswith("ament"):
            continue
        reported = set()
        for use in package.build.uses:
            name = _COMMANDS.get(use.name) if use.kind == "command" else None
            if name is None or name in reported or not view.active(use.conditions) or not present(view, name):
                continue
            reported.add(name)
            if name in view.closure(package) or name in view.spread(f.name for f in package.build.found):
                continue
            path = package.digest.manifest_path
            yield Diagnostic(
                use.at,
                name,
                package.name,
                {"command": use.name, "manifest": path},
                doubts=_doubts(view, package, name, use.conditions),
                fix=() if view.declared(package).get(name) else (Declare(path, name, "test_depend"),),
            )


def _doubts(view: View, package, name: str, conditions) -> tuple[Doubt, ...]:
    if is_grouped(package) or view.blind(package) or name in view.may_bring(package):
        return (Doubt.INCOMPLETE,)
    sure = conditions and all("TESTING" in c.text for c in conditions)
    return () if sure else (Doubt.CONDITIONAL,)
