"""The launch files of a workspace that no other includes, and what each of them starts."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from typing import Any, TypeVar

import msgspec

from ....edges import processes
from ....edges.memory import cache_in_derived
from ...facts.kinds import FLOW, find_kind
from ...facts.launch.python_walk import ENTRIES
from ...facts.store import recall
from ..launch.fill import ChangedFiles
from ..launch.follow import MOST_ACTIONS, follow
from ..launch.result import Launched, LaunchParameter, SettingFile, Started, select_file_values
from ..launch.text import parse_ros1_value, parse_yaml_value
from ..package import find_folder_role
from ..parameter_library import find_terms, list_libraries, list_open
from ..parameter_values import GivenValue, ParameterTerms, find_broken_limit, fits_type, make_given_value
from ..workspace import Workspace
from .bridges import add_bridges
from .endpoints import LOST
from .escape_analysis import EscapeAnalysis, UnknownReasons
from .file_selection import compute_stamp, get_facts
from .graph import Graph
from .join import Join, Running
from .names import NameRefused, normalise, parse_ros2_rule, resolve_ros1_name, resolve_ros2_name
from .parameter_terms import list_reconfigurable, list_terms
from .started import Instance, InWorkspace, classify_launch_file

_Row = TypeVar("_Row")

_MOST = 300
# Starting processes costs about as much as following this many launch files.
_ALONE = 8
# With fewer processes than these the launch files are started in this one: what is the same in many of them is worked
# out once then, not in each process, which saves about as much as two processes at a time.
_SHARING = 4
# A launch file may take as much time as a file of this size.
_FILE_BYTES = 1 << 20
_MOST_ACTIONS = 5 * MOST_ACTIONS  # of all launch files together


class GivenRemapping(msgspec.Struct, frozen=True):
    """A remapping that a node is given. old: the full name it is about; written: as the launch file has it."""

    old: str
    written: str
    path: str
    line: int


class GivenParameter(msgspec.Struct, frozen=True):
    """A parameter that a node is given, by its name within the node."""

    name: str
    path: str
    line: int


class RefusedValue(msgspec.Struct, frozen=True):
    """A value that a node is given, and that its parameter does not take. broken: the limit that it breaks, empty where
    its type is wrong. clamped: the server of dynamic_reconfigure changes it and goes on."""

    given: GivenValue
    terms: ParameterTerms
    broken: str = ""
    clamped: bool = False

    @property
    def is_type(self) -> bool:
        """Whether the type is wrong."""
        return not self.broken

    @property
    def path(self) -> str:
        """The file that sets it."""
        return self.given.path

    @property
    def line(self) -> int:
        """The line that sets it."""
        return self.given.line


class LaunchedNode(msgspec.Struct, frozen=True):
    """A node as a launch file starts it. node: its id in the graph of that launch. names: the full names that its code
    uses, before remapping; parameters: those it declares or reads, in ROS 1 by their full names, or as `*/name` where
    the code does not tell the namespace. hidden, hidden_parameters: why these are not all known, and so left empty.
    uncertain: why it may have another name, or may not be started at all. refused: values that it is given and that its
    parameters do not take. reads_files: it may read its parameter files by itself, too. values: those that it is given,
    by the names of its parameters; without a type where they are not known.
    """

    node: str
    program: str
    package: str
    names: tuple[str, ...]
    parameters: tuple[str, ...]
    renamed: tuple[GivenRemapping, ...]
    given: tuple[GivenParameter, ...]
    hidden: str
    hidden_parameters: str
    uncertain: tuple[str, ...]
    refused: tuple[RefusedValue, ...] = ()
    values: tuple[GivenValue, ...] = ()
    reads_files: bool = False


class Launch(msgspec.Struct, frozen=True):
    """What a launch file starts. path: in the workspace. graph: of all that it starts. missing: it starts programs too
    whose code is not in the workspace, or that are not known, or it includes what is not followed; elsewhere: the
    lines, as `path:line`, of the remappings and parameters that those programs are given, and told: the texts of these
    and of their arguments. possible: the graph of what
    it starts only if conditions hold that do not with the defaults of its arguments, of programs that no launch file
    starts with these; None for nothing."""

    path: str
    graph: Graph
    starts: tuple[LaunchedNode, ...]
    missing: bool
    elsewhere: tuple[str, ...] = ()
    possible: Graph | None = None
    told: tuple[str, ...] = ()


_Followed = tuple[str, Launched]
"""The path of a launch file and what it starts."""


def list_launches(workspace: Workspace, code: Callable[[], Join], jobs: int = 1) -> tuple[Launch, ...]:
    """What the launch files that no other includes start, with the defaults of their arguments. Remembered by the
    content of all that it rests on. code: gives the code of the workspace, joined; not called where nothing is
    started. jobs: processes to use."""
    store, key = workspace.extraction.store, compute_stamp(workspace)
    return recall(store, "launches", key, tuple[Launch, ...], lambda: tuple(_find_launches(workspace, code, jobs)))


@cache_in_derived
def follow_launch_files(workspace: Workspace) -> list[tuple[str, Launched]]:
    """Path and what it starts of each launch file that no other includes, with the defaults of its arguments."""
    return _follow(workspace, _list_first_files(workspace))


def _list_first_files(workspace: Workspace) -> list[tuple[str, str, str]]:
    return list(islice(list_launch_files(workspace), _MOST))


def _find_launches(workspace: Workspace, code: Callable[[], Join], jobs: int) -> Iterator[Launch]:
    files = _list_first_files(workspace)
    if jobs < 2 or len(files) < _ALONE or not processes.may_fork():
        followed = _select_working(follow_launch_files(workspace))
        yield from _start(workspace, code(), followed) if followed else ()
        return
    workspace.extraction.store.close()  # another process opens it for itself
    with processes.Workers(_run_within_limits, 1, _follow, workspace) as workers:
        workers.give(files)
        join = code()
        ((_, followed),) = workers.wait_for_finished()
    if isinstance(followed, processes.Died):
        followed = _follow(workspace, files)
    # Others ask for it too, see follow_launch_files().
    workspace.derived[follow_launch_files.__wrapped__,] = followed  # type: ignore[attr-defined]
    followed = _select_working(followed)
    if jobs < _SHARING:
        yield from _start(workspace, join, followed)
        return
    _ = join.list_running(), join.sites.statements  # made once, not in every process
    parts = [part for at in range(jobs) if (part := followed[at::jobs])]
    found: dict[str, Launch] = {}
    for part, made in processes.run_forked_rows(_run_within_limits, parts, jobs, _start, workspace, join):
        for row, launch in zip(part, made, strict=True):
            # What ends another process may end this one.
            found[row[0]] = launch or next(_start(workspace, join, [row]))
    yield from (found[path] for path, _ in followed)


def _select_working(followed: Iterable[_Followed]) -> list[_Followed]:
    return [row for row in followed if row[1].started or row[1].outside or row[1].possible]


def _run_within_limits(task: Callable[..., Iterable[_Row]], *given: Any) -> list[_Row]:
    """What a process of its own does: a task on some launch files, the last of what it is given."""
    processes.begin_part(0, len(given[-1]) * _FILE_BYTES)
    return list(task(*given))


def _start(workspace: Workspace, join: Join, followed: Sequence[_Followed]) -> Iterator[Launch]:
    """What launch files start."""
    sources, escapes = InWorkspace(workspace), EscapeAnalysis(workspace, join)
    unknown: dict[str, UnknownReasons] = {}
    declared = _Declared(join, sources)
    for path, launch in followed:
        running, missing = join.find_started(launch)
        graph = add_bridges(join.build(launch=launch), launch, sources)
        starts = []
        for one in running:
            program = f"{one.program.package}/{one.program.executable or one.program.plugin}"
            if program not in unknown:
                unknown[program] = escapes.find_unknown_reasons(one)
            starts.append(_start_node(join, launch, sources, one, program, unknown[program], declared))
        here = {id(one.instance.started) for one in running if one.instance is not None}
        others = [started for started in launch.started if id(started) not in here]
        elsewhere = {
            f"{sources.find_workspace_path(given.at.package, given.at.path)}:{given.at.line}"
            for started in others
            for given in (*started.remaps, *started.settings)
        }
        possible = launch.possible and add_bridges(join.build(launch=launch.possible), launch.possible, sources)
        told = sorted({text for one in (*others, *launch.outside) for text in _list_told(one)})
        yield Launch(
            path, graph, tuple(starts), bool(others or missing), tuple(sorted(elsewhere)), possible, tuple(told)
        )


def _list_told(started: Started) -> Iterator[str]:
    """What a program is told by its arguments, remappings and parameters, those of its parameter files included."""
    yield from (argument.shown for argument in started.arguments)
    for remap in started.remaps:
        yield from (remap.old.shown, remap.new.shown)
    for setting in started.settings:
        if isinstance(setting, SettingFile):
            yield from (str(entry.value) for entry in setting.entries or ())
        else:
            yield setting.text.shown


def _follow(workspace: Workspace, files: Sequence[tuple[str, str, str]]) -> list[_Followed]:
    """Each launch file that no other includes, followed, with what it may start of programs that none of them does.
    files: as list_launch_files() gives them."""
    sources, changed = InWorkspace(workspace), ChangedFiles()
    found: list[_Followed] = []
    included: set[str] = set()
    left = _MOST_ACTIONS
    for package, path, inner in files:
        most = min(MOST_ACTIONS, left)
        launch = follow(package, inner, sources, {}, generation=workspace.ros, most=most, changed=changed)
        left = max(1, left - launch.actions)
        found.append((path, launch))
        own, *others = launch.files or (("", ""),)
        included.update(sources.find_workspace_path(*other) for other in others if other != own)
    rows = [row for row in found if row[0] not in included]
    started = {_identify(one) for _, launch in rows for one in launch.started}
    given: set[tuple[str | None, str, str, str]] = set()
    for at, (path, launch) in enumerate(rows):
        if launch.left_out and left > 1:
            (package, inner), most = launch.files[0], min(MOST_ACTIONS, left)
            every = follow(
                package, inner, sources, {}, generation=workspace.ros, most=most, changed=changed, undecided=True
            )
            left = max(1, left - every.actions)
            # Of a program that several files may start under one name, the first start.
            fresh = {
                (*_identify(one), one.name.shown, one.namespace.shown): one
                for one in reversed(every.started)
                if _identify(one) not in started
            }
            rest = tuple(one for key, one in reversed(fresh.items()) if key not in given)
            given.update(fresh)
            if rest:
                rows[at] = path, launch._replace(possible=every._replace(started=rest, outside=()))
    return rows


def _identify(started: Started) -> tuple[str | None, str]:
    """The program that is started, as the launch file names it."""
    return started.package.value, (started.plugin.shown or started.executable.shown).removesuffix(".py")


def list_launch_files(workspace: Workspace) -> Iterator[tuple[str, str, str]]:
    """(package, path, path within the package) of launch files; last those in XML and YAML outside of all packages.
    Those of tests are left out."""
    for package in workspace:
        start = len(package.path) + 1 if package.path else 0
        for path in sorted(package.linked.files):
            inner = path[start:]
            if find_folder_role(inner) != "test" and (is_launch(inner) or _describes_launch(workspace, path)):
                yield package.name, path, inner
    for entry in workspace.extraction.tree.list_entries():
        path = entry.path
        launches = find_kind(path) in ("launch_xml", "launch_yaml") and is_launch(path)
        if launches and find_folder_role(path) != "test" and workspace.discovered.find_owner(path) is None:
            yield "", path, path


def _describes_launch(workspace: Workspace, path: str) -> bool:
    """Whether a file is a launch file by what it defines, wherever its package keeps it and installs it from."""
    extraction = get_facts(workspace)
    if extraction.kinds.get(path) != FLOW["python"]:
        return False
    facts = extraction.get_facts(path)
    return facts.facts is not None and any(function.name in ENTRIES for function in facts.facts.functions)


def is_launch(path: str) -> bool:
    """Whether a path within a package is that of a launch file, by its name and folder."""
    folder, name = posixpath.split(path.lower())
    if not classify_launch_file(path) or name.endswith(".test") or name.startswith("__"):
        return False
    stem, _, ending = name.rpartition(".")
    return ending == "launch" or stem.endswith((".launch", "_launch")) or "launch" in folder.split("/")


def _start_node(
    join: Join, launch: Launched, sources: InWorkspace, one: Running, program: str, reasons: UnknownReasons,
    declared: _Declared,
) -> LaunchedNode:  # fmt: skip
    instance = one.instance
    assert instance is not None
    renamed = tuple(_list_given_remappings(sources, instance, join.ros))
    given = tuple(_list_given(sources, launch, instance.started, instance))
    names = {name for name in _list_names(join, one, instance) if name} if renamed and not reasons.names else ()
    asked = _collect_parameters(join, one, instance) if (given or renamed) and not reasons.parameters else ()
    return LaunchedNode(
        one.node.id, program, one.program.package, tuple(sorted(names)), tuple(sorted(asked)), renamed, given,
        reasons.names, reasons.parameters, instance.uncertain,
        tuple(_list_refused(join, launch, sources, one, instance, declared)),
        tuple(_list_values(launch, sources, instance)), reasons.reads,
    )  # fmt: skip


def _list_values(launch: Launched, sources: InWorkspace, instance: Instance) -> Iterator[GivenValue]:
    """The values that a node is given."""
    if instance.started.generation != 1:
        yield from _collect_values(sources, instance.started, instance.name).values()
        return
    own = launch.collect_parameters(instance.started, instance.name)
    for name in dict.fromkeys(name.rpartition("/")[2] for name in launch.server):
        if name not in own:  # of a namespace around it, or of another node: which of both is not told here
            yield GivenValue(name, "", 0, "", "")
    for name, setting in own.items():
        at = setting.source or setting.at
        place = sources.find_workspace_path(at.package, at.path)
        text = setting.text.value
        if text is None or not place or setting.conditions:
            yield GivenValue(name, place, at.line, "", "")
            continue
        value = text if setting.type in ("str", "string") else parse_ros1_value(text)
        yield make_given_value(name, place, at.line, value)


class _Declared:
    """What values the parameters of programs take, asked for once of a program that runs the same functions."""

    def __init__(self, join: Join, sources: InWorkspace):
        self._join, self._sources = join, sources
        # With who runs them, so that nothing else comes by the same id().
        self._known: dict[tuple, tuple[Running, dict[str, ParameterTerms], list[tuple[list[str], ParameterTerms]]]] = {}

    def list_terms(self, one: Running) -> tuple[dict[str, ParameterTerms], list[tuple[list[str], ParameterTerms]]]:
        """The parameters that a program declares, as list_terms() says, and those of them that stand for several."""
        parts = (None if part is None else frozenset(part) for part in (one.objects, one.others))
        key = id(one.functions), *parts
        if key not in self._known:
            every = list_terms(self._join, one, list_libraries(self._sources.workspace))
            self._known[key] = one, every, list_open(every)
        return self._known[key][1:]


def _list_refused(
    join: Join, launch: Launched, sources: InWorkspace, one: Running, instance: Instance, declared: _Declared
) -> Iterator[RefusedValue]:
    """The values that a node is given and does not take."""
    if instance.started.generation == 1:
        yield from _list_clamped(join, launch, sources, one, instance)
        return
    if not instance.started.settings:
        return
    every, several = declared.list_terms(one)
    for given in _collect_values(sources, instance.started, instance.name).values() if every else ():
        terms = find_terms(every, given.name, several)
        if terms is not None:
            yield from find_refused(given, terms)


def _list_clamped(
    join: Join, launch: Launched, sources: InWorkspace, one: Running, instance: Instance
) -> Iterator[RefusedValue]:
    """The values of ROS 1 that a server of dynamic_reconfigure changes, or leaves for its default."""
    given = launch.collect_parameters(instance.started, instance.name)
    terms = list_reconfigurable(join, one, sources.workspace) if given else {}
    for name, setting in given.items():
        declared = terms.get(name)
        at = setting.source or setting.at
        path = sources.find_workspace_path(at.package, at.path)
        if declared is None or not path or setting.conditions or setting.text.value is None:
            continue
        text = setting.text.value
        value = text if setting.type in ("str", "string") else parse_ros1_value(text)
        if not isinstance(value, str) or setting.type in ("", "str", "string"):
            refused = next(find_refused(make_given_value(name, path, at.line, value), declared), None)
            if refused is not None and not (refused.is_type and _is_converted(refused)):
                yield msgspec.structs.replace(refused, clamped=True)


def _is_converted(refused: RefusedValue) -> bool:
    """Whether ROS 1 makes a number of one type into the other, or the value is no plain one."""
    given, declared = refused.given.type, refused.terms.type
    return {given, declared} <= {"integer", "double"} or refused.given.text[:1] in ("[", "{", "")


def find_refused(given: GivenValue, terms: ParameterTerms) -> Iterator[RefusedValue]:
    """Why a parameter does not take a value, if it does not."""
    if not fits_type(given, terms):
        yield RefusedValue(given, terms)
    elif broken := find_broken_limit(given, terms):
        yield RefusedValue(given, terms, broken)


def _collect_values(sources: InWorkspace, start: Started, full: str) -> dict[str, GivenValue]:
    """The values that hold for a node, by the names of the parameters: the last that it is given for each."""
    found: dict[str, GivenValue] = {}
    for setting in start.settings:
        if isinstance(setting, SettingFile):
            place = sources.find_workspace_path(*setting.source) if setting.source is not None else ""
            own = (setting.file.value or "").startswith("$(find ")  # one that is changed first is not what it says
            for name, entry in select_file_values(setting, full).items():
                value = make_given_value(normalise(name), place, entry.line, entry.value)
                found[normalise(name)] = value if place and own and not setting.conditions else _make_unknown(value)
            continue
        place = sources.find_workspace_path(setting.at.package, setting.at.path)
        value = _read_value(setting, place)
        found[setting.name] = value if place and not setting.conditions else _make_unknown(value)
    return found


def _make_unknown(value: GivenValue) -> GivenValue:
    return GivenValue(value.name, value.path, value.line, "", "")


# Types of launch files as ROS names them.
_GIVEN_TYPES = {
    "str": "string", "string": "string", "bool": "bool", "boolean": "bool", "int": "integer", "double": "double",
    "float": "double",
}  # fmt: skip
# What PyYAML, which launch reads values with, takes for a text.
_NO_NUMBER = re.compile(r"[-+]?[0-9]+[eE]")


def _read_value(setting: LaunchParameter, path: str) -> GivenValue:
    """The value of a parameter that a launch file of ROS 2 gives."""
    text = setting.text.value
    value = parse_yaml_value(text) if text is not None else None
    type_ = _GIVEN_TYPES.get(setting.type, "")
    is_text = type_ == "string" and not isinstance(value, str)  # launch may read a text as YAML once more
    lost = text is None or is_text or _NO_NUMBER.match(text) or (setting.type and not type_ and setting.type != "list")
    if lost or not _fits(value, type_):
        return GivenValue(setting.name, path, setting.at.line, "", "")
    return make_given_value(setting.name, path, setting.at.line, value, type_)


def _fits(value: object, type_: str) -> bool:
    """Whether a text can be made into a type."""
    numeric = type_ in ("integer", "double")
    return not numeric or (isinstance(value, (int, float)) and not isinstance(value, bool))


def _list_names(join: Join, one: Running, instance: Instance) -> Iterator[str]:
    """The full names that a node's code uses, before remapping."""
    bare = one._replace(instance=instance._replace(remaps=()))
    for site in join.sites.endpoints:
        if site.use.fn in one.functions and join.runs(one, site.use):
            values = site.names
            if not site.implied:
                prefix, values = join.sites.find_names(site.use, one.values)
                site = site._replace(prefix=prefix)
            for value in values:
                yield join.resolve_name(site, value, bare)[0]


def _collect_parameters(join: Join, one: Running, instance: Instance) -> set[str]:
    """The parameters that a program asks for; of ROS 1 by their full names, or `*/name` where the node handle does not
    tell its namespace."""
    found: set[str] = set()
    for use in join.calls.select_uses("parameter"):
        if use.fn in one.functions and join.runs(one, use):
            names = {value.text for value in join.list_parameter_names(use) if value.text}
            if instance.started.generation != 1:
                found |= names
                continue
            prefix = LOST if one.loaded is not None else join.sites.find_prefix(use, one.values)
            found.update(_resolve_parameter(name, prefix, instance) for name in names)
    return found


def _resolve_parameter(name: str, prefix: str, instance: Instance) -> str:
    """The full name of a parameter of ROS 1. prefix: the namespace of the node handle."""
    namespace = instance.name.rpartition("/")[0] or "/"
    text = name.replace("{node}", instance.name).replace("{ns}", namespace)
    if text[0] not in "/~":
        if prefix.startswith(LOST):
            return f"*/{text}"
        text = f"{prefix}/{text}".replace("~/", "~") if prefix else text
    try:
        return instance.remap_name(text, 1)
    except NameRefused:
        return f"*/{text}"


def _list_given_remappings(sources: InWorkspace, instance: Instance, ros: int) -> Iterator[GivenRemapping]:
    generation = instance.started.generation or ros
    namespace, _, own = instance.name.rpartition("/")
    for remap in instance.remaps:
        written, new = remap.old.value, remap.new.value
        path = sources.find_workspace_path(remap.at.package, remap.at.path)
        if not written or new is None or remap.conditions or not path or written.startswith("__"):
            continue
        if generation == 1:
            old = resolve_ros1_name(written, instance.name)
        else:
            rule = parse_ros2_rule(f"{written}:={new}")
            if rule is None or rule.match.startswith("__") or rule.node not in ("", own):
                continue
            try:
                old = resolve_ros2_name(rule.match, own, namespace or "/")
            except NameRefused:
                continue
        yield GivenRemapping(old, written, path, remap.at.line)


def _list_given(sources: InWorkspace, launch: Launched, start: Started, instance: Instance) -> Iterator[GivenParameter]:
    """The parameters that a node is given for itself: not those of a file's `/**`, which are for any node."""
    if start.generation == 1:
        below = f"{instance.name}/"
        for name, setting in launch.server.items():
            # By the line of a parameter file, which several programs may load for themselves.
            at = setting.source or setting.at
            place = sources.find_workspace_path(at.package, at.path)
            if name.startswith(below) and place and not setting.conditions:
                yield GivenParameter(name[len(below) :], place, at.line)
        return
    for setting in start.settings:
        if setting.conditions:
            continue
        if isinstance(setting, SettingFile):
            yield from _list_file_parameters(sources, setting, instance.name)
            continue
        place = sources.find_workspace_path(setting.at.package, setting.at.path)
        if place:
            yield GivenParameter(setting.name, place, setting.at.line)


def _list_file_parameters(sources: InWorkspace, setting: SettingFile, full: str) -> Iterator[GivenParameter]:
    head, _, inner = (setting.file.value or "").partition("/")
    found = head.startswith("$(find ")
    place = sources.find_workspace_path(head.removeprefix("$(find ").rstrip(")"), inner) if found else ""
    if not place:
        return
    for_all = select_file_values(setting, "")
    for name, entry in select_file_values(setting, full).items():
        if for_all.get(name) != entry:
            yield GivenParameter(normalise(name), place, entry.line)
