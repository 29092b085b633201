"""The message-flow graph of a workspace: nodes, what they publish and subscribe to, and under which guards.

Every entry names its place. What is not known is empty, and `reason` says why.
"""

from __future__ import annotations

from typing import Literal

import msgspec

Role = Literal["publisher", "subscriber", "server", "client", "action server", "action client"]
How = Literal["literal", "default", "launch", "given", "partly", "unresolved"]
"""How a name became known: written so in the source; the default of a parameter, which whoever starts the node may
change; set by the launch file; fixed by the framework (`/tf`, `/rosout`), or given on the command line; in part, with
brackets for what is not known (`/<$ROBOT>/scan`); or not at all."""


class Node(msgspec.Struct, frozen=True):
    """A node. id: its name where a launch file starts it, else `package/executable` or `package/Class`.

    name: with its namespace, as in a running system; the name that the source gives where no launch file says another.
    kind: `executable`, `component`, `nodelet`, `plugin`, `script`, or `library` for code that no executable of the
    workspace uses. plugin: the class, for what is loaded. started: `path:line` of the launch file, empty without one.
    uncertain: why the launch file may give it another name, or may not start it at all. launches: the launch files of
    the workspace that start it, by themselves or by what they include, where the graph is of all of them. loads: the
    plugins of the workspace that its code loads into it, as `package/Class`.
    """

    id: str
    name: str
    package: str
    kind: str
    executable: str = ""
    plugin: str = ""
    language: str = ""
    path: str = ""
    line: int = 0
    started: str = ""
    uncertain: tuple[str, ...] = ()
    launches: tuple[str, ...] = ()
    loads: tuple[str, ...] = ()


class Callback(msgspec.Struct, frozen=True):
    """What a message, request or goal is given to. name: as qualified as it is known."""

    name: str
    path: str
    line: int


class Qos(msgspec.Struct, frozen=True, omit_defaults=True):
    """Quality of service, as far as it is known; empty for what is not. depth -1: not known. deadline, lease: seconds.

    reliability: reliable, best_effort; durability: volatile, transient_local; history: keep_last, keep_all;
    liveliness: automatic, manual_by_topic. written: the expression. `system_default` and `best_available` stand for
    themselves.
    """

    reliability: str = ""
    durability: str = ""
    history: str = ""
    depth: int = -1
    deadline: float | None = None
    liveliness: str = ""
    lease: float | None = None
    written: str = ""


class Endpoint(msgspec.Struct, frozen=True):
    """One side of a topic, service or action.

    node: the id of its Node, empty when no node is known to run it. topic: the full name (also of a service or action),
    empty when it is not known. written: the name as the source has it; code_name: the name that the code gives to ROS,
    before namespaces and remappings, empty where that is not known. type: `package/Name`, empty when not known, `*`
    for any. function: in which it is made. variable: what it is kept in. implied: made by the framework or a helper of
    it (a transform listener, a diagnostic updater), not by a call that names the topic. only_if: on what it depends
    whether the node makes it, or makes it under this name: the condition of the preprocessor under which the code is
    compiled, a condition that does not hold as far as is known, that a function returns the one of its values, that
    something calls a function which nothing is seen to call, or that something unknown does not replace the name; empty
    for nothing of these.
    guards: those around the call that makes it, in its function, outermost first.
    """

    role: Role
    node: str
    topic: str
    type: str
    path: str
    line: int
    written: str = ""
    how: How = "literal"
    qos: Qos | None = None
    callback: Callback | None = None
    function: str = ""
    variable: str = ""
    reason: str = ""
    implied: bool = False
    framework: str = ""
    only_if: str = ""
    code_name: str = ""
    guards: tuple[GuardAt, ...] = ()


class GuardAt(msgspec.Struct, frozen=True):
    """A guard with its place; kind and text as in facts. of: the function it stands in, which is that of the publish
    statement or one that leads to it."""

    kind: str
    text: str
    path: str
    line: int
    of: str = ""


class Trigger(msgspec.Struct, frozen=True):
    """What makes a publish statement run. kind: `timer`, `subscriber`, `service`, `action`, `parameter`, `loop` (in
    main or a thread), `start`, or `unknown`. detail: the period, topic, service or function."""

    kind: str
    detail: str
    path: str
    line: int


class Way(msgspec.Struct, frozen=True):
    """One way to a publish statement: what starts it, and the guards met on it up to the statement, outermost first."""

    trigger: Trigger
    guards: tuple[GuardAt, ...] = ()


class Publish(msgspec.Struct, frozen=True):
    """A publish statement. expression: what is published, as written. guards: outermost first, those of the functions
    that lead to it included where there is but one way; `ways`: how many ways lead to it from a trigger, each in `by`.
    through: the function of the code's own, called `publish` too, that is called here and holds what sends."""

    node: str
    topic: str
    type: str
    path: str
    line: int
    function: str = ""
    expression: str = ""
    variable: str = ""
    guards: tuple[GuardAt, ...] = ()
    triggers: tuple[Trigger, ...] = ()
    ways: int = 1
    by: tuple[Way, ...] = ()
    reason: str = ""
    through: str = ""


class Timer(msgspec.Struct, frozen=True):
    """A timer. period: as written."""

    node: str
    period: str
    callback: Callback | None
    path: str
    line: int


class ParameterUse(msgspec.Struct, frozen=True):
    """A parameter that is declared or read. name: as the code gives it, in ROS 1 to the node handle, with brackets for
    what is not known of it (`<plugin_name>.speed`); default: as written, empty for none."""

    node: str
    name: str
    kind: Literal["declared", "read", "written"]
    path: str
    line: int
    default: str = ""


NOT_GIVEN = "has no default here"
"""How the reason ends why a name is not known that is the value of a parameter which nothing gives."""
LOST_INCLUDE = "included launch file"
"""What an include is, as Unresolved has it, that is not followed."""


COPIED = "package"
"""What a package is, as Unresolved has it, that is left out since another one has its name."""


class Unresolved(msgspec.Struct, frozen=True):
    """A call that was not resolved. what: `publisher topic`, `subscriber callback`, `publish`, ...; reason: why.
    pattern: of a name that is known in part what it matches, with `*` for any text (`/*/scan`); empty where nothing of
    it is known."""

    what: str
    reason: str
    path: str
    line: int
    written: str = ""
    pattern: str = ""


class PackageCoverage(msgspec.Struct, frozen=True):
    """Calls that a search of the text of a package finds, and how many of them were understood."""

    package: str
    found: int
    understood: int


class Coverage(msgspec.Struct, frozen=True):
    """calls: of the frameworks; resolved: those of which all is known that they name (topic, type, callback,
    publisher). by_default: of the resolved, those whose name is a parameter's default. unread: files with spans that
    did not parse. wrappers: calls inside functions that stand for the framework's own; their callers are counted.
    uncompiled: sources that are left out, since no target compiles them. by_text: what a search of the text finds of
    calls, by package; missed: those of them that were not understood. Both are of the whole code. in_part: of the
    calls that are not resolved those of whose name a whole segment is known."""

    calls: int
    resolved: int
    by_default: int
    files: int
    unread: tuple[str, ...] = ()
    unresolved: tuple[Unresolved, ...] = ()
    wrappers: tuple[Unresolved, ...] = ()
    uncompiled: tuple[str, ...] = ()
    by_text: tuple[PackageCoverage, ...] = ()
    missed: tuple[Unresolved, ...] = ()
    in_part: int = 0


class OutsideNode(msgspec.Struct, frozen=True):
    """What a launch file starts whose code is not in the workspace: a possible node, or more of them.

    name: with its namespace, in brackets where the launch file leaves it to the program; empty for a launch file.
    executable: the program, the class that is loaded, or the path of the launch file in its package. kind: `node`, or
    `launch file`, which may start any number. started: `path:line` that starts it. uncertain: on what it depends that
    it is started, or its name. names: those that the launch file remaps names of it to, as written.
    """

    name: str
    package: str
    executable: str
    kind: str
    started: str
    uncertain: tuple[str, ...] = ()
    names: tuple[str, ...] = ()


class Graph(msgspec.Struct, frozen=True):
    """The whole graph. root: the workspace as it was given; rev: the revision read, empty for files on disk. outside:
    what launch files start whose code is not here."""

    nodes: tuple[Node, ...]
    endpoints: tuple[Endpoint, ...]
    publishes: tuple[Publish, ...]
    timers: tuple[Timer, ...]
    parameters: tuple[ParameterUse, ...]
    coverage: Coverage
    root: str = ""
    rev: str = ""
    ros: int = 2
    outside: tuple[OutsideNode, ...] = ()
