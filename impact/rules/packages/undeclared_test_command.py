"""undeclared-test-command: a command that makes tests comes from a package that nothing declared brings.

What it does
    Looks for commands of ament's packages for tests and linters where neither find_package nor ament_lint_auto, which
    finds what is declared for tests, can have brought them.

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

from ....edges.memory import cache_in_derived
from ...targets.target import Provider
from ..vocabulary import Declare, Diagnostic, Doubt, Package, TargetView, Text, rule

# What the packages that make tests of some kind are made of.
_TESTS = "ament_cmake_test"


@rule(
    group="undeclared-package",
    texts=Text(
        "`{command}` comes from `{subject}`, but `{package}` does not depend on it",
        help="add `<test_depend>{subject}</test_depend>` to {manifest}, and find_package({subject} REQUIRED)",
    ),
)
def undeclared_test_command(view: TargetView, package: Package):
    if not package.build_type.startswith("ament"):
        return
    reported = set()
    for use in package.build.uses:
        name = find_test_commands(view).get(use.name) if use.kind == "command" else None
        if name in (None, package.name, *reported) or not view.is_available(name):
            continue
        reported.add(name)
        if name in view.build_environment(package) or name in view.list_transitive(f.name for f in package.build.found):
            continue
        path = package.linked.manifest_path
        yield Diagnostic(
            use.at,
            name,
            package.name,
            {"command": use.name, "manifest": path},
            doubts=_collect_doubts(view, package, name, use.conditions),
            fix=() if view.collect_declared(package).get(name) else (Declare(path, name, "test_depend"),),
        )


@cache_in_derived
def find_test_commands(view: TargetView) -> dict[str, str]:
    """Commands that make tests, and the packages they come from: those of ament's packages for CMake that are made of
    ament_cmake_test."""
    return {
        command: name
        for command, owners in view.providers.commands.get(view.target.ros, {}).items()
        for name in owners.split()
        if "ament_cmake" in name
        and any(d.name == _TESTS and d.kind != "test" for d in view.target.list_dependencies(name) or ())
    }


def _collect_doubts(view: TargetView, package: Package, name: str, conditions) -> tuple[Doubt, ...]:
    if view.unknown_contents.may_come_along(package, name, (Provider("ros", name),)):
        return (Doubt.INCOMPLETE,)
    sure = conditions and all("TESTING" in c.text for c in conditions)
    return () if sure else (Doubt.CONDITIONAL,)
