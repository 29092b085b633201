"""What launch files start otherwise than at a base: nodes, names, remappings and parameters, with the lines for it."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, lru_cache
from itertools import chain, islice
from typing import Literal, NamedTuple

from ....edges.groups import group_pairs
from ....edges.reach import walk
from ...facts.kinds import find_kind
from ..launch.result import Launched, LaunchParameter, SettingFile, ShareLine, Started
from ..launch.text import wrap
from ..package import find_folder_role
from ..workspace import Workspace
from .bridges import add_bridges
from .graph import Graph
from .join import Join, Running
from .launches import follow_launch_files, list_launch_files
from .names import normalise
from .started import InWorkspace, follow_workspace_launch, make_instance
from .system import ChosenLaunch, join_launched
from .workspace import get_flow

_SETTINGS = frozenset(("launch_xml", "launch_yaml", "params", "xacro"))
_SHARED = re.compile(r"\$\(find ([\w.-]+)\)/([\w./-]+)")
# As many new lines are searched for what makes a value what it is.
_MOST_LINES = 1_000
_BESIDE = re.compile(r"filename\s*=\s*[\x22\x27]([\w./-]+)[\x22\x27]")
_COMMENT = re.compile(r"(?m)^\s*#.*$")
_XML_COMMENT = re.compile(r"(?s)<!--.*?-->")
_What = Literal["name", "program", "condition", "arguments", "remapping", "parameter", "file"]


class StartValue(NamedTuple):
    """What a node is given, with the line of the launch or parameter file that gives it."""

    text: str
    path: str
    line: int


class StartedNode(NamedTuple):
    """A node as a launch file starts it, or what is given parameters like one.

    kind: `node`; `include`, of a launch file of another package; `inner`, a node that only a parameter file names, as
    the costmap within a server; `server`, what is set for all nodes on ROS 1's parameter server, without a name. node:
    its id in the graph of the launch, empty for all but a program of the workspace. remaps: by the old name,
    parameters: by name; files: texts that name files of the workspace, by the parameter that is made from them.
    """

    kind: Literal["node", "include", "inner", "server"]
    name: str
    node: str
    program: str
    condition: str
    arguments: str
    path: str
    line: int
    remaps: Mapping[str, StartValue]
    parameters: Mapping[str, StartValue]
    files: Mapping[str, str]


class StartDifference(NamedTuple):
    """What of a start differs. name: of the remapping or parameter; old, new: empty where there is none. path, line: of
    the line that says it now, or of what starts the node where none does."""

    what: _What
    name: str
    old: str
    new: str
    path: str
    line: int

    def may_cause(self, old: str, new: str) -> bool:
        """Whether it is a value from which a name comes."""
        if self.what not in ("remapping", "parameter"):
            return False
        values = [text.partition(" if ")[0].strip("~/") for text in (self.old, self.new)]
        return any(value and name.endswith(f"/{value}") for value, name in zip(values, (old, new), strict=True))


class NodeChange(NamedTuple):
    """A node that is started otherwise, or is started only now (before is None) or only at the base (now is None).
    made_of: files that differ, of which what it is given is made."""

    before: StartedNode | None
    now: StartedNode | None
    differences: tuple[StartDifference, ...]
    made_of: tuple[str, ...] = ()

    def list_files(self) -> Iterator[str]:
        """The files whose lines it is reported at."""
        yield from (difference.path for difference in self.differences)
        yield from (node.path for node in (self.before, self.now) if node is not None)
        yield from self.made_of

    def find_cause(self, old: str, new: str) -> StartDifference | None:
        """The difference that gives an endpoint of the node another name. old, new: its names, empty for none."""
        fitting = (one for one in self.differences if one.may_cause(old, new))
        named = (one for one in self.differences if one.what == "name")
        return next(chain(fitting, named, self.differences), None)


class LaunchChange(NamedTuple):
    """A launch file that starts something otherwise. path: now, at the base where it is gone; added, removed: it is
    there on one side alone. before, now: the graphs of what it starts. others: it starts programs of other packages."""

    path: str
    added: bool
    removed: bool
    before: Graph
    now: Graph
    nodes: tuple[NodeChange, ...]
    others: bool


class LaunchChanges(NamedTuple):
    """launches: those that start something otherwise. Of launch files, parameter files and robot descriptions that
    differ in more than comments and layout, unused: those that no launch file is known to use; without_effect: those
    that are used, though all that is known to be started is as it was."""

    launches: tuple[LaunchChange, ...]
    unused: tuple[str, ...]
    without_effect: tuple[str, ...]


NO_CHANGES = LaunchChanges((), (), ())


@lru_cache(maxsize=2)
def compare_launches(workspace: Workspace, base: Workspace) -> LaunchChanges:
    """What the launch files of a workspace start otherwise than at the base."""
    flow, old_flow = get_flow(workspace), get_flow(base)

    def find_old_code() -> Join:
        if flow.key == old_flow.key:
            old_flow.code = flow.code
        return old_flow.code

    sides = _Side(workspace, lambda: flow.code), _Side(base, find_old_code)
    ids = [side.settings for side in sides]
    changed = {path for path in ids[0].keys() | ids[1].keys() if ids[0].get(path) != ids[1].get(path)}
    return _Comparison(*sides, changed).compare() if changed else NO_CHANGES


class _Side:
    """A workspace as its launch files start it."""

    def __init__(self, workspace: Workspace, code: Callable[[], Join]):
        self.workspace, self.sources, self.find_code = workspace, InWorkspace(workspace), code
        self._descriptions: dict[str, frozenset[str]] = {}

    @cached_property
    def settings(self) -> dict[str, str]:
        """Contents of launch files, parameter files and robot descriptions, by path; those of tests are left out."""
        found = {path: "" for _, path, _ in list_launch_files(self.workspace)}
        found |= {helper: "" for path in tuple(found) for helper in self.sources.list_helpers(path)}
        for package in self.workspace:
            start = len(package.path) + 1 if package.path else 0
            for path in package.linked.files:
                if find_kind(path) in _SETTINGS and find_folder_role(path[start:]) != "test":
                    found[path] = ""
        main = self.workspace.extraction
        looks = (main, main.second) if main.second is not None else (main,)
        for path in found:
            found[path] = next((each.ids[path] for each in looks if path in each.ids), "")
        return found

    @cached_property
    def launches(self) -> dict[str, Launched]:
        """Launch files that no other includes."""
        return dict(follow_launch_files(self.workspace))

    def read(self, path: str) -> str | None:
        """The text of a launch file or the like; None where there is none."""
        return self.workspace.read(path).decode("utf-8", "replace") if path in self.settings else None

    def follow(self, path: str, undecided: bool) -> Launched | None:
        """What a launch file starts; None where there is none. undecided: as for follow()."""
        if undecided:
            return follow_workspace_launch(self.workspace, path, {}, undecided) if path in self.settings else None
        if path not in self.launches and path in self.settings:
            self.launches[path] = follow_workspace_launch(self.workspace, path, {})
        return self.launches.get(path)

    def follow_all(self, chosen: Sequence[ChosenLaunch]) -> Launched:
        """What launch files start together."""
        return join_launched([follow_workspace_launch(self.workspace, one.path, one.arguments) for one in chosen])

    def list_files(self, launched: Launched) -> Iterator[str]:
        """All files that decide what a launch starts."""
        for place in (*launched.files, *launched.parameter_files):
            path = self.sources.find_workspace_path(*place)
            yield path
            if place in launched.files:
                yield from self.sources.list_helpers(path)
        for started in (*launched.started, *launched.outside):
            for text in _list_texts(launched, started):
                yield from self.list_described(text)

    def list_described(self, text: str) -> Iterator[str]:
        """The files that a text of a launch names, and those that these include."""
        for package, inner in _SHARED.findall(text):
            path = self.sources.find_workspace_path(package, inner.rstrip("."))
            if path and path not in self._descriptions:
                self._descriptions[path] = frozenset(walk([path], self._list_included))
            yield from self._descriptions.get(path, ())

    def _list_included(self, path: str) -> list[str]:
        text = (self.read(path) or "") if find_kind(path) == "xacro" else ""
        folder = path.rpartition("/")[0]
        found = [posixpath.normpath(f"{folder}/{inner}") for inner in _BESIDE.findall(text)]
        found += [self.sources.find_workspace_path(*place) for place in _SHARED.findall(text)]
        return [each for each in found if each in self.settings]

    def start(self, launched: Launched | None) -> tuple[list[StartedNode], Graph]:
        """What a launch starts, and its graph."""
        launched = launched or Launched((), {}, ())
        graph = add_bridges(self.find_code().build(launch=launched), launched, self.sources)
        return list(self._list_starts(launched)), graph

    def _list_starts(self, launched: Launched) -> Iterator[StartedNode]:
        running, _ = self.find_code().find_started(launched)
        known = {id(one.instance.started): one for one in running if one.instance is not None}
        names: list[str] = []
        inner: dict[str, dict[str, LaunchParameter]] = {}
        read: set[int] = set()
        for started in (*launched.started, *launched.outside):
            if started.kind != "process" or id(started) in known:
                found = self._describe_start(launched, started, known.get(id(started)))
                names.append(found.name)
                yield found
                for name, given in _list_inner_parameters(started, read):
                    inner.setdefault(name, {}).update(given)
        for name in sorted(inner.keys() - set(names)):
            first = next(iter(inner[name].values()))
            at = self._locate("", first.source or first.at)
            given = self._describe_parameters(inner[name])
            yield StartedNode("inner", name, "", "", "", "", at.path, at.line, {}, *given)
        below = tuple(f"{name}/" for name in names)
        shared = {key: value for key, value in launched.server.items() if not key.startswith(below)}
        if shared:
            at = self._locate("", next(iter(shared.values())).at)
            yield StartedNode("server", "", "", "", "", "", at.path, at.line, {}, *self._describe_parameters(shared))

    def _describe_start(self, launched: Launched, started: Started, one: Running | None) -> StartedNode:
        what = started.plugin.shown or started.executable.shown
        own = what.replace("::", "/").rpartition("/")[2].removesuffix(".py")
        own = f"<{own}>" if started.kind == "include" else own
        instance = one.instance if one is not None else None
        instance = instance or make_instance(launched, own, started)
        remaps: dict[str, StartValue] = {}
        for remap in started.remaps if started.generation == 1 else reversed(started.remaps):
            condition = f" if {' and '.join(remap.conditions)}" if remap.conditions else ""
            remaps[remap.old.shown] = self._locate(remap.new.shown + condition, remap.at)
        given = launched.collect_parameters(started, instance.name)
        if started.kind == "include":
            given = {each.name: each for each in started.settings if isinstance(each, LaunchParameter)}
        parameters, files = self._describe_parameters(given)
        read = {each.file.value for each in started.settings if isinstance(each, SettingFile) and each.entries}
        files = {key: text for key, text in files.items() if text not in read}
        arguments = " ".join(argument.shown for argument in started.arguments)
        if _SHARED.search(arguments):
            files["arguments"] = arguments
        place = self._locate("", started.at)
        package = started.package.shown
        return StartedNode(
            "include" if started.kind == "include" else "node", instance.name, one.node.id if one is not None else "",
            f"{package}/{what}" if package else what, " and ".join(started.conditions), arguments, place.path,
            place.line, remaps, parameters, files,
        )  # fmt: skip

    def _describe_parameters(
        self, given: Mapping[str, LaunchParameter]
    ) -> tuple[dict[str, StartValue], dict[str, str]]:  # fmt: skip
        """The values of parameters, and the texts of those that name files."""
        values = {key: self._locate(value.text.shown, value.source or value.at) for key, value in given.items()}
        return values, {key: value.text for key, value in values.items() if _SHARED.search(value.text)}

    def _locate(self, text: str, at: ShareLine) -> StartValue:
        path = self.sources.find_workspace_path(at.package, at.path)
        return StartValue(text, path or f"{at.package}/{at.path}", at.line)


def _list_inner_parameters(started: Started, read: set[int]) -> Iterator[tuple[str, dict[str, LaunchParameter]]]:
    """Full names of nodes that the parameter files of a start name, and the parameters: they are for all nodes of the
    process. Names that are patterns are left out. read: the id() of entries that were read before, and now."""
    for setting in started.settings:
        if not isinstance(setting, SettingFile) or setting.plain or id(setting.entries) in read:
            continue
        read.add(id(setting.entries))
        found: dict[tuple[str, ...], dict[str, LaunchParameter]] = {}
        for entry in setting.entries or ():
            path = entry.path
            if "ros__parameters" in path:
                split = path.index("ros__parameters")
                key = ".".join(path[split + 1 :])
                source = ShareLine(*setting.source, entry.line) if setting.source is not None else None
                given = LaunchParameter(key, wrap(str(entry.value)), setting.at, (), source)
                found.setdefault(path[:split], {})[key] = given
        yield from (
            (normalise("/" + "/".join(keys)), given) for keys, given in found.items() if "*" not in "".join(keys)
        )


def _list_texts(launched: Launched, started: Started) -> Iterator[str]:
    """Texts in which a start may name files."""
    for argument in started.arguments:
        yield argument.shown
    for setting in started.settings:
        if isinstance(setting, LaunchParameter):
            yield setting.text.shown
    if started.generation == 1:
        yield from (setting.text.shown for setting in launched.server.values())


class _Comparison:
    def __init__(self, now: _Side, before: _Side, changed: set[str]):
        self.now, self.before, self.changed = now, before, changed
        self._new_lines: dict[str, dict[int, str]] = {}

    def compare(self) -> LaunchChanges:
        used: set[str] = set()
        pairs = list(self._pair_launches())
        found = [one for pair in pairs if (one := self._compare_launch(*pair, self.changed, used)) is not None]
        systems = [*self._compare_systems(used)]
        # What starts together is reported once, with all that it meets.
        whole = {path for paths, _ in systems for path in paths}
        found = [*(one for _, one in systems), *(one for one in found if one.path not in whole)]
        covered = {path for one in found for node in one.nodes for path in node.list_files()}
        left = set(filter(self._differs, self.changed - covered - self._find_moved()))
        if left:
            # What the defaults of arguments leave out.
            rest = (self._compare_launch(*pair, left, used, undecided=True) for pair in pairs)
            for one in filter(None, rest):
                nodes = tuple(node for node in one.nodes if not left.isdisjoint(node.list_files()))
                if nodes:
                    found.append(one._replace(nodes=nodes))
                    covered.update(path for node in nodes for path in node.list_files())
        return LaunchChanges(tuple(found), tuple(sorted(left - used)), tuple(sorted(left & used - covered)))

    def _find_moved(self) -> set[str]:
        """Files that only have another path."""
        now, before = self.now.settings, self.before.settings
        come = {path: content for path, content in now.items() if path not in before}
        gone = {path: content for path, content in before.items() if path not in now}
        both = set(come.values()) & set(gone.values())
        return {path for path, content in (*come.items(), *gone.items()) if content in both}

    def _differs(self, path: str) -> bool:
        """Whether a file differs in more than comments and layout, or is there on one side alone."""
        texts = [side.read(path) for side in (self.now, self.before)]
        if None in texts or not path.endswith((".yaml", ".yml")):
            return texts[0] is None or texts[1] is None or _strip(texts[0], path) != _strip(texts[1], path)
        looks = (side.workspace.extraction.look((path,), "flow_parameters") for side in (self.now, self.before))
        entries = [{one.path: one.value for one in facts[path].entries} if path in facts else {} for facts in looks]
        return entries[0] != entries[1]

    def _pair_launches(self) -> Iterator[tuple[str, str]]:
        """The paths of launch files now and at the base, the same but for those that were moved; empty for none."""
        now, before = self.now.settings, self.before.settings
        moved: dict[str, str] = {}
        gone = [path for path in self.before.launches if path not in now]
        come = [path for path in self.now.launches if path not in before]
        keys = (lambda settings, path: settings[path], lambda settings, path: path.rpartition("/")[2])
        for key in keys:
            old = group_pairs((key(before, path), path) for path in gone if path not in moved.values())
            new = group_pairs((key(now, path), path) for path in come if path not in moved)
            alone = (name for name, paths in new.items() if len(paths) == len(old.get(name, ())) == 1)
            moved |= {new[name][0]: old[name][0] for name in alone}
        for path in sorted(self.now.launches):
            yield path, moved.get(path, path if path in before else "")
        for path in sorted(self.before.launches.keys() - self.now.launches.keys() - set(moved.values())):
            yield path if path in now else "", path

    def _compare_systems(self, used: set[str]) -> Iterator[tuple[list[str], LaunchChange]]:
        """The launch files of each system that starts something otherwise, and what this is. used: as below."""
        for name, chosen in get_flow(self.now.workspace).systems.items():
            had = get_flow(self.before.workspace).systems.get(name)
            if had is not None:
                paths = [one.path for one in chosen]
                both = self.now.follow_all(chosen), self.before.follow_all(had)
                one = self._compare_started((paths[0], had[0].path), both, self.changed, used)
                if one is not None:
                    yield paths, one

    def _compare_launch(
        self, path: str, old_path: str, changed: set[str], used: set[str], undecided: bool = False
    ) -> LaunchChange | None:  # fmt: skip
        """What a launch file starts otherwise; None where it uses none of the files that changed, which are added to
        those used, or starts what it did. path, old_path: now and at the base."""
        both = self.now.follow(path, undecided), self.before.follow(old_path, undecided)
        return self._compare_started((path, old_path), both, changed, used)

    def _compare_started(
        self, paths: tuple[str, str], both: tuple[Launched | None, Launched | None], changed: set[str], used: set[str]
    ) -> LaunchChange | None:  # fmt: skip
        """The same of what is started. paths: of the first launch file; both: now and at the base."""
        (path, old_path), (now, before) = paths, both
        files = {*self.now.list_files(now)} if now is not None else set()
        files |= {*self.before.list_files(before)} if before is not None else set()
        here = files & changed
        used |= here
        if not here:
            return None
        order = [path, *(place for place in sorted(here) if place != path)]
        (old, old_graph), (new, graph) = self.before.start(before), self.now.start(now)
        nodes = [
            NodeChange(one, other, differences, tuple(self._list_all_made_of(other)))
            for one, other in _pair_starts(old, new)
            if (differences := tuple(self._list_differences(one, other, order))) or one is None or other is None
        ]
        if not nodes:
            return None
        others = any(one.kind in ("node", "include") and not one.node for one in (*old, *new))
        return LaunchChange(path or old_path, not before, not now, old_graph, graph, tuple(nodes), others)

    def _list_differences(
        self, old: StartedNode | None, new: StartedNode | None, files: Sequence[str]
    ) -> Iterator[StartDifference]:
        if old is None or new is None:
            return
        whole: tuple[tuple[_What, str, str], ...] = (
            ("name", old.name, new.name), ("program", old.program, new.program),
            ("condition", old.condition, new.condition), ("arguments", old.arguments, new.arguments),
        )  # fmt: skip
        for what, was, value in whole:
            if was != value:
                cause = self._find_cause(StartValue(value, new.path, new.line), was, files)
                yield StartDifference(what, "", was, value, *cause)
        tables: tuple[tuple[_What, Mapping[str, StartValue], Mapping[str, StartValue]], ...] = (
            ("remapping", old.remaps, new.remaps), ("parameter", old.parameters, new.parameters),
        )  # fmt: skip
        for what, before, now in tables:
            for name in {**before, **now}:
                was, value = before.get(name), now.get(name)
                if was is None or value is None or was.text != value.text:
                    old_text, text = was.text if was is not None else "", value.text if value is not None else ""
                    cause = self._find_cause(value or StartValue("", new.path, new.line), old_text, files)
                    yield StartDifference(what, name, old_text, text, *cause)
        for name, text in new.files.items():
            made_of = self._list_made_of(text)
            was = old.parameters.get(name)
            if made_of and (name not in new.parameters or (was is not None and new.parameters[name].text == was.text)):
                line = min(self._list_new(made_of[0]), default=1)
                yield StartDifference("file", name, "", ", ".join(made_of), made_of[0], line)

    def _list_all_made_of(self, node: StartedNode | None) -> Iterator[str]:
        for text in node.files.values() if node is not None else ():
            yield from self._list_made_of(text)

    def _list_made_of(self, text: str) -> list[str]:
        """The files that differ, of which what a text of a launch names is made; descriptions first."""
        found = self.changed.intersection(self.now.list_described(text))
        return sorted(found, key=lambda path: (find_kind(path) != "xacro", path))

    def _find_cause(self, place: StartValue, old: str, files: Iterable[str]) -> tuple[str, int]:
        """The line that makes a value what it is now: its own, or, where this is as it was, that of a changed file that
        says so. old: the value that it was."""
        if place.line in self._list_new(place.path):
            return place.path, place.line
        words = set(re.split(r"[^\w.-]+", place.text)) - set(re.split(r"[^\w.-]+", old))
        order = dict.fromkeys((place.path, *(path for path in files if find_kind(path) != "xacro")))
        lines = ((path, line, text) for path in order for line, text in self._list_new(path).items())
        first = None if place.path in self.changed else next(lines, None)
        again = (first,) if first is not None else ()
        for path, line, text in islice(chain(again, lines), _MOST_LINES) if words - {""} else ():
            if any(word in text for word in words if word):
                return path, line
        return first[:2] if first is not None else (place.path, place.line)

    def _list_new(self, path: str) -> dict[int, str]:
        """The lines of a file that it did not have at the base."""
        if path not in self._new_lines:
            old, new = ((side.read(path) or "").splitlines() for side in (self.before, self.now))
            had = {line.strip() for line in old}
            self._new_lines[path] = (
                {place: line for place, line in enumerate(new, 1) if line.strip() not in had}
                if path in self.changed
                else {}
            )
        return self._new_lines[path]


def _strip(text: str, path: str) -> list[str]:
    """The words of XML or Python without comments."""
    return (_COMMENT if path.endswith(".py") else _XML_COMMENT).sub(" ", text).split()


def _pair_starts(
    before: Iterable[StartedNode], now: Iterable[StartedNode]
) -> Iterator[tuple[StartedNode | None, StartedNode | None]]:
    """Nodes of two launches that are the same: of one name and program, of one name, or else of one program."""
    old, new = ({id(one): one for one in side} for side in (before, now))
    keys = (lambda one: (one.kind, one.name, one.program), lambda one: (one.kind, one.name), lambda one: one.program)
    for key in keys:
        waiting = group_pairs((key(one), one) for one in reversed(old.values()))
        for one in [*new.values()]:
            fitting = waiting.get(key(one)) if key(one) else None
            if fitting:
                first = fitting.pop()
                del old[id(first)], new[id(one)]
                yield first, one
    yield from ((one, None) for one in old.values())
    yield from ((None, one) for one in new.values())
