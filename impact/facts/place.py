"""Where something stands in a file, and the comment that silences a rule there."""

import msgspec

from .condition import Condition


class Place(msgspec.Struct, frozen=True, array_like=True, gc=False, order=True):
    """A position in one file. Lines and columns count from 1; columns count characters, 0 means the whole line."""

    line: int
    column: int = 0


class Problem(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A part of a file that could not be read: where, and in one clause why. column: 0 where it is not known."""

    line: int
    message: str
    column: int = 0


class Allow(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A `rosimpact: allow(rule, rule)` comment. It holds for its own line and, alone on a line, for the next one."""

    line: int
    rules: tuple[str, ...]
    own_line: bool


class Reference(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A mention of another package, or of a file, executable or plugin in one.

    kind: `package` (`$(find p)`, get_package_share_directory), `executable` (node of a launch file, `rosrun`, `ros2
    run`), `file` (a launch or data file inside `package`), `sought` (a file whose name is looked for in all folders of
    `package`, as `ros2 launch` does), `place` (a file or folder that code opens or writes to, or the folder of a file
    whose name is not known), `plugin` (class name), `library` (of plugins, without `lib` and `.so`), `distro file` (a
    file that is named by the distro, which `{distro}` stands for), `tree node` (of a behaviour tree), `tree port` (a
    node, a blank and one of its ports), `macro` (a call of one of xacro), `command` (shell).
    package: its name, empty when only `name` is known. name: executable, file, class or command, empty for `package`.
    conditional: stands under if/unless/try, so it may never run. conditions: of those, where one tells about the
    machine, these and UNDECIDED for any other; so the mention surely counts where all hold.
    macro: the macro of xacro that it stands in, which counts where something calls it; empty outside of all.
    arguments: names of the launch arguments that an include of the file gives; None for what is no include, or where
    they cannot all be known.
    """

    kind: str
    package: str
    name: str
    line: int
    column: int = 0
    conditional: bool = False
    arguments: tuple[str, ...] | None = None
    conditions: tuple[Condition, ...] = ()
    macro: str = ""
