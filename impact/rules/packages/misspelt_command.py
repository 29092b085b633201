"""misspelt-command: a CMake command is one letter off a known one.

What it does
    Reports calls of commands that neither CMake, nor a known package, nor the package itself defines, and whose name is
    one letter off exactly one known command.

Why it breaks
    CMake stops: "Unknown CMake command".

Severity
    error; warning where CMake may not reach the place, and where a package that is found may define the command.

Example
    target_link_librares(node tracker)

Use instead
    target_link_libraries(node tracker)

Not reported
    Names of fewer than eight letters, which are alike by chance.
"""

from ...model.cmake.interpreter import HANDLERS, WRAPPERS
from ...model.cmake.names import COMMANDS
from ...model.misspelling import is_slip
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule

_SHORTEST = 8


@rule(
    group="refused-cmake-name",
    texts=Text("`{subject}` is not a command of CMake or of a known package", "did you mean `{replacement}`?"),
)
def misspelt_command(view: TargetView, package: Package):
    build, known = package.build, (COMMANDS, HANDLERS, WRAPPERS, view.providers.commands.get(view.target.ros, {}))
    seen = set()
    for use in build.uses:
        if use.kind != "command" or use.name in seen:
            continue
        if any(name in commands for commands in known for name in (use.name, use.name.removeprefix("_"))):
            continue  # with an underscore: what a command was before the tree defined it anew
        seen.add(use.name)
        meant = {name for commands in known for name in commands if is_slip(use.name, name)}
        if len(use.name) >= _SHORTEST and len(meant) == 1:
            complete = not build.unresolved and not view.unknown_contents.list_unknown_found(package)
            doubts = (*list_place_doubts(view, "build", use.conditions), complete or Doubt.INCOMPLETE)
            yield Diagnostic(use.at, use.name, package.name, {"replacement": meant.pop()}, doubts=doubts)
