"""What a launch file starts: its includes followed, its substitutions filled in, its conditions decided.

What is not known stays unknown, with the reason; what rests on the default of a launch argument says so. Paths in the
share folder of a package are written `$(find PACKAGE)/path`, whatever the launch file wrote.

Sources: roslaunch's loader.py, xmlloader.py and substitution_args.py; launch's actions and substitutions; launch_ros'
node.py, load_composable_nodes.py and push_ros_namespace.py.
"""

import contextlib
import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ....edges.dispatch import collect_methods
from ...facts.launch.actions import Action, ActionCondition, find_literal, make_literal
from ...facts.launch.parameter_files import ParameterEntry
from ...facts.launch.parameter_files import extract as parameters
from ..flow.names import make_open_part, normalise, parse_ros2_rule
from .fill import OF_RUNNING, ActionScope, ChangedFiles, Filling
from .result import EMPTY, Launched, LaunchParameter, LaunchSources, Remap, SettingFile, ShareLine, Started
from .text import (
    LaunchText,
    list_either,
    make_either,
    make_unknown,
    parse_truth,
    resolve,
    show_condition,
    wrap,
)

DEEPEST = 30
MOST_ACTIONS = 20_000


def follow(
    package: str,
    path: str,
    sources: LaunchSources,
    arguments: Mapping[str, str] | None = None,
    environment: Mapping[str, str] | None = None,
    generation: int = 0,
    most: int = MOST_ACTIONS,
    changed: ChangedFiles | None = None,
    undecided: bool = False,
) -> Launched:
    """All that the launch file `$(find package)/path` starts.

    arguments: as given on the command line. environment: variables that are known. generation: of the workspace, for
    files that could be of either. most: how many actions are done. changed: shared by launches of the same sources.
    undecided: no condition is decided, so that what the defaults of arguments leave out is there too.
    """
    given = {name: wrap(value) for name, value in (arguments or {}).items()}
    variables = {name: wrap(value) for name, value in (environment or {}).items()}
    launch = _Launch(sources, given, variables, generation, most, changed or ChangedFiles(), undecided)
    with contextlib.suppress(RecursionError):  # what is nested too deeply is not followed
        launch.include((package, posixpath.normpath(path).lstrip("/")))
    files, done = tuple(dict.fromkeys(launch.files)), most - max(0, launch.budget)
    declared, settings = frozenset(launch.declared), tuple(launch.parameter_files)
    outside, unread = tuple(launch.outside), frozenset(launch.unread)
    return Launched(
        tuple(launch.started), launch.server, files, declared, done, settings, outside, launch.left_out, unread=unread
    )


class _Launch(Filling):
    """One launch under way."""

    def __init__(
        self,
        sources: LaunchSources,
        arguments: dict[str, LaunchText],
        environment: dict[str, LaunchText],
        generation: int,
        most: int,
        changed: ChangedFiles,
        undecided: bool,
    ):
        super().__init__(sources, ActionScope(arguments, environment, 0), generation or 2, changed)
        # The files whose includes lead to what is read.
        self.chain: list[tuple[str, str]] = []
        self.open: list[str] = []
        self.budget = most
        self.undecided = undecided
        self.started: list[Started] = []
        self.outside: list[Started] = []
        self.server: dict[str, LaunchParameter] = {}
        self.unread: set[str] = set()
        self.container = EMPTY
        self.files: list[tuple[str, str]] = []
        self.declared: set[str] = set()
        self.left_out = False

    def include(self, place: tuple[str, str], action: Action | None = None) -> None:
        """Follows a file that an action includes; without one the file that is launched."""
        file = self.sources.find_launch_file(*place)
        if file is None and action is not None and action.get("optional") is None:
            self.note_outside(wrap(place[0]), wrap(place[1]), action)
        if file is None or len(self.chain) > DEEPEST or self.chain[:-1].count(place) > 3:
            return
        before = self.scope, self.package, self.path, self.generation
        generation = file.generation or self.generation
        if action is not None and generation == 1:
            self.scope = self.make_ros1_scope(action)
        # What it sets is sure for all that it starts, though not for what follows it.
        uncertain = action is not None and generation == 2 and self.is_uncertain()
        if uncertain:
            self.scope = self.scope.make_inner(len(self.open))
        if action is not None and generation == 2:
            # One after the other: the value of one argument may name an argument given before it.
            for name, text in self.list_passed(action):
                self.scope.arguments[name] = text
                self.scope.maybe.pop(name, None)
        self.chain.append(place)
        self.files.append(place)
        self.package, self.path = place
        self.generation = generation
        self.run(file.actions)
        self.chain.pop()
        inner = self.scope
        self.scope, self.package, self.path, self.generation = before
        if uncertain:
            self.leave(inner)

    def leave(self, inner: ActionScope) -> None:
        """Goes on after actions that share this scope and may not have run at all. inner: what held after them."""
        scope, open_ = self.scope, tuple(self.open[self.scope.open :])
        for name, text in inner.arguments.items():
            if scope.arguments.get(name) != text:
                self.set(name, text)
        scope.environment = inner.environment
        self.push(inner.namespace)
        for one in inner.remaps[len(scope.remaps) :]:
            scope.remaps.append(one._replace(conditions=(*open_, *one.conditions)))
        for one in inner.settings[len(scope.settings) :]:
            scope.settings.append(one._replace(conditions=(*open_, *one.conditions)))

    def note_outside(self, package: LaunchText, path: LaunchText, action: Action) -> None:
        """Notes an include of a file that is not read, with what it is given. package: empty where the path is not that
        of a file in a share folder, or not known."""
        at, settings = self.locate_line(action.line), []
        for name, text in self.list_passed(action):
            settings.append(LaunchParameter(name, text, at))
            if text.value and text.value.endswith((".yaml", ".yml")):
                entries, source = self.read_entries(text.value), self.find_source(text.value)
                settings.append(SettingFile(text, entries, at, source=source))
        namespace = self.scope.namespace
        if self.generation == 1 and action.get("namespace") is not None:
            namespace = self.make_inner_namespace(self.read_field(action, "namespace"))
        self.outside.append(
            Started(
                "include",
                self.generation,
                at,
                tuple(self.open),
                package,
                path,
                namespace=namespace,
                remaps=tuple(self.scope.remaps),
                settings=tuple(settings),
            )
        )

    def run(self, actions: Iterable[Action]) -> None:
        for action in actions:
            self.budget -= 1
            if self.budget <= 0:
                return
            open_ = self.decide(action.conditions)
            if open_ is None:
                self.left_out |= action.kind in _STARTING
            else:
                mark = len(self.open)
                self.open += open_
                _DOING.get(action.kind.replace("-", "_"), _Launch.do_pass)(self, action)
                del self.open[mark:]

    def decide(self, conditions: Sequence[ActionCondition]) -> list[str] | None:
        """The conditions of which it is not known whether they hold; None where one does not."""
        open_: list[str] = []
        for condition in conditions:
            if condition.kind == "after":
                continue  # an event or a time
            asked = condition.kind != "each" and not self.undecided
            truth = parse_truth(self.fill(condition.value)) if asked else None
            if truth is None:
                open_.append(show_condition(condition))
            elif truth == (condition.kind == "unless"):
                return None
        return open_

    def is_uncertain(self) -> bool:
        """Whether what is set here may not be set at all, as seen by what follows."""
        return len(self.open) > self.scope.open

    def set(self, name: str, text: LaunchText) -> None:
        """An argument's new value; one set under an undecided condition is not known afterwards."""
        if self.is_uncertain():
            before = self.scope.arguments.get(name)
            if before is not None and before.value is not None and before.value == text.value:
                return
            if before is None:
                self.scope.maybe[name] = text
            reason = f"`{name}` is set only if {self.open[-1]}"
            text = make_unknown(text.shown, reason) if before is None else make_either(before.shown, text.shown, reason)
        else:
            self.scope.maybe.pop(name, None)
        self.scope.arguments[name] = text

    def read_name(self, action: Action) -> str | None:
        return self.read_field(action, "name").value

    def do_argument(self, action: Action) -> None:
        name = self.read_name(action)
        if name is None:
            return
        value, default = action.get("value"), action.get("default")
        if value is not None and self.generation == 1:
            self.set(name, self.fill(value))
        elif name not in self.scope.arguments:
            if default is None:
                reason = f"argument `{name}` has no default and is not given"
                self.scope.arguments[name] = make_unknown(f"{name}", reason)
            else:
                self.set(name, self.fill(default)._replace(chosen=True))
        elif default is not None and name in self.scope.maybe:
            before, text = self.scope.maybe.pop(name), self.fill(default)
            if before.value is None or before.value != text.value:
                reasons = (*before.reasons, *text.reasons, *self.scope.arguments[name].reasons)
                text = make_either(before.shown, text.shown, *reasons)
            self.scope.arguments[name] = text
        self.declared.add(name)

    def do_let(self, action: Action) -> None:
        name = self.read_name(action)
        if name is not None:
            self.set(name, self.read_field(action, "value"))

    def do_environment(self, action: Action) -> None:
        name = self.read_name(action)
        if name is not None:
            self.scope.environment[name] = self.read_field(action, "value")

    def do_group(self, action: Action) -> None:
        scoped = action.get("scoped")
        if self.generation == 2 and scoped is not None and parse_truth(self.fill(scoped)) is False:
            outer = self.scope
            if self.is_uncertain():
                self.scope = outer.make_inner(len(self.open))
            self.run(action.children)
            inner, self.scope = self.scope, outer
            if inner is not outer:
                self.leave(inner)
            return
        outer, self.scope = self.scope, self.scope.make_inner(len(self.open))
        forwarding = action.get("forwarding")
        if forwarding is not None and parse_truth(self.fill(forwarding)) is False:
            self.scope = ActionScope({}, {}, len(self.open))
        if action.get("namespace") is not None:
            self.scope.namespace = self.make_inner_namespace(self.read_field(action, "namespace"))
        self.clear(action, self.scope.namespace)
        self.run(action.children)
        self.scope = outer

    def make_inner_namespace(self, namespace: LaunchText) -> LaunchText:
        """A namespace below the one that holds here, absolute."""
        base = self.scope.namespace
        if namespace.value == "":
            return base
        return resolve(base if base.value != "" else wrap("/"), namespace)

    def do_namespace(self, action: Action) -> None:
        self.push(self.make_inner_namespace(self.read_field(action, "namespace")))

    def push(self, namespace: LaunchText) -> None:
        """Makes a namespace, which is absolute, the one that holds; one under an undecided condition is not known."""
        if self.is_uncertain() and namespace.value != self.scope.namespace.value:
            namespace = make_either(
                self.scope.namespace.shown or "/", namespace.shown, f"pushed only if {self.open[-1]}"
            )
        self.scope.namespace = namespace

    def do_remap(self, action: Action) -> None:
        self.scope.remaps.append(self.make_remap(action))

    def make_remap(self, action: Action) -> Remap:
        old, new = self.read_field(action, "from"), self.read_field(action, "to")
        return Remap(old, new, self.locate_line(action.line), tuple(self.open[self.scope.open :]))

    def do_include(self, action: Action) -> None:
        file = self.read_field(action, "file")
        place = self.split_share_path(file.value) if file.value is not None else None
        if place is not None:
            self.include(place, action)
        else:
            self.note_outside(EMPTY, file, action)

    def list_passed(self, action: Action) -> Iterator[tuple[str, LaunchText]]:
        """The arguments given to an include, in order, each filled in when it is asked for."""
        for child in action.children:
            open_ = self.decide(child.conditions) if child.kind == "pass" else None
            name = self.read_name(child)
            if open_ is None or name is None:
                continue
            value, default = child.get("value"), child.get("default")
            text = self.fill(value if value is not None else default if default is not None else make_literal(""))
            if open_:
                text = make_unknown(text.shown, f"`{name}` is given only if {open_[-1]}")
            yield name, text

    def make_ros1_scope(self, action: Action) -> ActionScope:
        """The scope of a file that roslaunch includes: namespace and remappings are passed on, arguments only as
        given."""
        scope = self.scope.make_inner(len(self.open))
        if action.get("namespace") is not None:
            scope.namespace = self.make_inner_namespace(self.read_field(action, "namespace"))
        self.clear(action, scope.namespace)
        all_ = action.get("pass-all")
        scope.arguments = dict(self.scope.arguments) if all_ is not None and parse_truth(self.fill(all_)) else {}
        scope.arguments.update(list(self.list_passed(action)))
        return scope

    def clear(self, action: Action, namespace: LaunchText) -> None:
        clear = action.get("clear")
        if clear is not None and namespace.value and parse_truth(self.fill(clear)):
            self.forget(namespace.value)

    def forget(self, name: str) -> None:
        """Removes parameters of the server below a name."""
        for key in [key for key in self.server if key == name or key.startswith(f"{name.rstrip('/')}/")]:
            del self.server[key]

    def do_pass(self, action: Action) -> None:
        """What has no place where it stands, or cannot be followed."""

    def do_parameter(self, action: Action) -> None:
        if self.generation == 1:
            name = self.read_field(action, "name")
            if name.value is not None and name.value[:1] == "~":
                self.scope.private.append(action)
                return
            self.serve(action, self.scope.namespace)
            return
        setting = self.make_setting(action)
        if setting is not None:
            self.scope.settings.append(setting)

    def do_parameter_file(self, action: Action) -> None:
        if self.generation == 1:
            self.serve_file(action, self.scope.namespace)
            return
        self.scope.settings.append(self.make_setting_file(action))

    def make_setting(self, action: Action) -> LaunchParameter | None:
        """A parameter of a ROS 2 node."""
        name = self.read_name(action)
        if name is None:
            return None
        text, at = self.read_field(action, "value"), self.locate_line(action.line)
        type_ = find_literal(action.get("type")) or ""
        return LaunchParameter(name, text, at, tuple(self.open[self.scope.open :]), type=type_)

    def make_setting_file(self, action: Action) -> SettingFile:
        """A parameter file of a ROS 2 node."""
        file = self.read_field(action, "file")
        at, conditions = self.locate_line(action.line), tuple(self.open[self.scope.open :])
        if not file.value:
            return SettingFile(file, None if file.value is None else (), at, conditions)
        entries, source = self.read_entries(file.value), self.find_source(file.value)
        if entries is not None and find_literal(action.get("substitute")) is not None:
            entries = self.substitute_entries(entries)
        below = [self.fill(key).value for key in action.list_values("below")]
        name = action.get("name")
        if not below and name is None:
            return SettingFile(file, entries, at, conditions, source=source)
        prefix = (self.fill(name).shown,) if name is not None else ()
        if entries is not None:
            entries = tuple(
                ParameterEntry((*prefix, *entry.path[len(below) :]), entry.value, entry.line)
                for entry in entries
                if list(entry.path[: len(below)]) == below
            )
        return SettingFile(file, entries, at, conditions, True, source)

    def serve(self, action: Action, namespace: LaunchText) -> None:
        """Puts a <param> of ROS 1 on the server, below a namespace."""
        name = self.read_field(action, "name")
        if name.value is not None and name.value[:1] == "~":
            name = wrap(name.value[1:])
        full = resolve(namespace if namespace.value != "" else wrap("/"), name)
        if name.value is None:
            return
        given = next((key for key in OF_RUNNING if action.get(key) is not None), "")
        type_ = find_literal(action.get("type")) or ""
        if not given:
            text = self.read_field(action, "value")
        else:
            text = make_unknown(self.read_field(action, given).shown, f"it is {OF_RUNNING[given]}")
        self.put(_fill_open(full), text, action.line, type_=type_)

    def put(
        self, name: str, text: LaunchText, line: int, source: ShareLine | None = None, type_: str = ""
    ) -> None:  # fmt: skip
        before = self.server.pop(name, None)
        if self.open and before is not None and before.text.value != text.value:
            text = make_either(before.text.shown, text.shown, f"set only if {self.open[-1]}")
        self.server[name] = LaunchParameter(name, text, self.locate_line(line), tuple(self.open), source, type_)

    def serve_file(self, action: Action, namespace: LaunchText) -> None:
        """Does a <rosparam>."""
        below = self.read_field(action, "name")
        base = namespace if namespace.value != "" else wrap("/")
        if below.value is not None and below.value[:1] == "~":
            below = wrap(below.value[1:].lstrip("/"))
        full = _fill_open(base if below.value == "" else resolve(base, below))
        if below.value is None:
            return
        command = find_literal(action.get("command")) or "load"
        if command == "delete":
            self.forget(full or "/")
        if command != "load":
            return
        substitute = action.get("substitute")
        fill = substitute is not None and parse_truth(self.fill(substitute)) is True
        file, content, place = action.get("file"), action.get("text"), None
        if file is not None:
            name = self.fill(file).value
            entries = self.read_entries(name) if name is not None else None
            place = self.find_source(name) if name is not None else None
            if entries is None:
                self.unread.add(full or "/")
        else:
            # What is filled in may be any piece of YAML, so that it comes before reading.
            entries, fill = parameters(self.fill(content or make_literal("")).shown).entries, False
        for entry in self.substitute_entries(entries or ()) if fill else entries or ():
            key = "/".join(part.strip("/") for part in (full or "/", *entry.path) if part.strip("/"))
            source = ShareLine(*place, entry.line) if place is not None else None
            type_ = "str" if isinstance(entry.value, str) else ""
            self.put(f"/{key}", wrap(str(entry.value)), action.line, source, type_)

    def do_node(self, action: Action) -> None:
        if self.generation == 1:
            self.start_ros1_node(action)
        else:
            self.start_ros2_node(action)

    do_lifecycle = do_test = do_container = do_node

    def start_ros2_node(self, action: Action) -> None:
        package, executable, plugin = (self.read_field(action, key) for key in ("package", "executable", "plugin"))
        name = self.read_field(action, "name")
        namespace = self.read_field(action, "namespace")
        full_namespace = self.scope.namespace if namespace.value == "" else self.make_inner_namespace(namespace)
        arguments = tuple(self.fill(value) for value in action.list_values("arguments"))
        outer = self.scope
        self.scope = outer.make_inner(len(self.open))
        first_remaps, first_settings, renamed, moved = self.parse_ros_arguments(arguments, action.line)
        self.run(child for child in action.children if child.kind in _OF_NODE)
        remaps, settings = self.scope.remaps, self.scope.settings
        self.scope = outer
        if moved is not None:
            full_namespace = resolve(wrap("/"), moved)
        if renamed is not None:
            name = renamed
        self.begin(
            action,
            action.kind,
            package=package,
            executable=executable,
            plugin=plugin,
            name=name,
            namespace=full_namespace,
            remaps=(*first_remaps, *remaps),
            settings=(*first_settings, *settings),
            arguments=arguments,
            container=self.container,
        )
        if action.kind == "container":
            self.load_into(resolve(full_namespace if full_namespace.value != "" else wrap("/"), name), action)

    def read_field(self, action: Action, key: str) -> LaunchText:
        return self.fill(action.get(key) or make_literal(""))

    def begin(self, action: Action, kind: str, **fields: Any) -> None:
        """Notes that an action starts something. fields: those of Started that are not empty, lists as tuples."""
        self.started.append(
            Started(kind, self.generation, self.locate_line(action.line), tuple(self.open), **fields)
        )

    def parse_ros_arguments(
        self, arguments: Sequence[LaunchText], line: int
    ) -> tuple[list[Remap], list[LaunchParameter | SettingFile], LaunchText | None, LaunchText | None]:
        """Remappings, parameters, name and namespace that ROS 2 arguments on a command line give."""
        remaps: list[Remap] = []
        settings: list[LaunchParameter | SettingFile] = []
        name: LaunchText | None = None
        namespace: LaunchText | None = None
        inside, option = False, ""
        for text in arguments:
            word = text.value
            if word == "--ros-args":
                inside, option = True, ""
            elif word == "--":
                inside = False
            elif not inside:
                continue
            elif word in ("-r", "--remap", "-p", "--param", "--params-file"):
                option = word
            elif option == "--params-file":
                entries = self.read_entries(word) if word is not None else None
                source = self.find_source(word) if word is not None else None
                settings.append(SettingFile(text, entries, self.locate_line(line), source=source))
                option = ""
            elif option:
                old, new = _split_rule(text)
                rule = parse_ros2_rule(f"{old}:={new.value or 'open'}") if old else None
                if option in ("-p", "--param"):
                    at = self.locate_line(line)
                    # Of one that is not known as a whole, what it sets is not known.
                    settings.append(LaunchParameter(old, new, at) if old else SettingFile(text, None, at))
                elif rule is not None and not rule.node and rule.match in ("__node", "__name"):
                    name = name or new
                elif rule is not None and not rule.node and rule.match == "__ns":
                    namespace = namespace or new
                elif rule is not None:
                    remaps.append(Remap(wrap(old), new, self.locate_line(line)))
                option = ""
        return remaps, settings, name, namespace

    def do_load(self, action: Action) -> None:
        named = self.read_field(action, "container-node")
        if named.value == "":
            self.load_into(resolve(wrap("/"), self.read_field(action, "container")), action)
            return
        self.load_into(resolve(self.scope.namespace if self.scope.namespace.value != "" else wrap("/"), named), action)

    def load_into(self, container: LaunchText, action: Action) -> None:
        """Starts the composable nodes below an action in a container, by its full name."""
        outer, self.scope = self.scope, self.scope.make_inner(len(self.open))
        around, self.container = self.container, container
        self.run(child for child in action.children if child.kind == "composable")
        self.scope, self.container = outer, around

    do_composable = start_ros2_node

    def do_process(self, action: Action) -> None:
        words = tuple(word for value in action.list_values("command") for word in _split_words(self.fill(value)))
        package = executable = EMPTY
        rest = words
        if [w.value for w in words[:2]] == ["ros2", "run"] and len(words) >= 4:
            package, executable, rest = words[2], words[3], words[4:]
        elif words:
            installed = _INSTALLED.match(words[0].value or "")
            executable, rest = words[0], words[1:]
            if installed is not None:
                package, executable = map(wrap, installed.groups())
        remaps, settings, name, namespace = self.parse_ros_arguments(rest, action.line)
        self.begin(
            action,
            "process",
            package=package,
            executable=executable,
            name=name or EMPTY,
            namespace=namespace or EMPTY,
            remaps=tuple(remaps),
            settings=tuple(settings),
            arguments=rest,
        )

    def start_ros1_node(self, action: Action) -> None:
        package, executable, name = (self.read_field(action, key) for key in ("package", "executable", "name"))
        base = self.scope.namespace if self.scope.namespace.value != "" else wrap("/")
        namespace = resolve(base, self.read_field(action, "namespace")) if action.get("namespace") is not None else base
        words = [word for value in action.list_values("arguments") for word in self.split(self.fill(value))]
        for text in words:
            if text.value is not None and text.value.startswith("__name:="):
                name = wrap(text.value[8:])
            elif text.value is not None and text.value.startswith("__ns:="):
                namespace = resolve(wrap("/"), wrap(text.value[6:]))
        full = resolve(namespace, name)
        if full.value is not None:
            self.clear(action, full)
        outer, self.scope = self.scope, self.scope.make_inner(len(self.open))
        self.scope.remaps = []
        own: list[Remap] = []
        given: list[tuple[Action, list[str]]] = [(action, []) for action in self.scope.private]
        for child in action.children:
            open_ = self.decide(child.conditions)
            if open_ is None:
                continue
            self.open += open_
            if child.kind == "remap":
                own.append(self.make_remap(child))
            elif child.kind == "parameter":
                given.append((child, open_))
            elif child.kind == "parameter-file" and full.value is not None:
                self.serve_file(child, full)
            del self.open[len(self.open) - len(open_) :]
        self.scope = outer
        # Files are loaded as they are met, then come the private parameters of the scope, then the node's own.
        for child, open_ in given if full.value is not None else ():
            self.open += open_
            self.serve(child, full)
            del self.open[len(self.open) - len(open_) :]
        remaps = _drop_earlier([*self.scope.remaps, *own])
        for text in words:
            old, new = _split_rule(text)
            if not old or old.startswith("__"):
                continue
            if old.startswith("_"):
                if full.value is not None:
                    self.put(f"{full.value}/{old[1:]}", new, action.line)
            else:
                remaps.append(Remap(wrap(old), new, self.locate_line(action.line)))
        kind, plugin, container = ("test" if action.kind == "test" else "node"), EMPTY, EMPTY
        if package.value == "nodelet" and words:
            command = words[0].value
            if command == "manager":
                kind = "container"
            elif command in ("load", "standalone") and len(words) > 1:
                plugin = words[1]
                kind = "composable" if command == "load" else "node"
                if command == "load":
                    container = resolve(namespace, words[2]) if len(words) > 2 else make_unknown("manager")
        self.begin(
            action,
            kind,
            package=package,
            executable=executable,
            plugin=plugin,
            name=name,
            namespace=namespace,
            remaps=tuple(remaps),
            arguments=tuple(words),
            container=container,
        )

    def split(self, text: LaunchText) -> list[LaunchText]:
        """The words of one argument, which a substitution may have brought several of."""
        if text.value is None:
            return [text]
        return [wrap(word) for word in text.value.split()] if " " in text.value else [text]


_INSTALLED = re.compile(r"\$\(prefix ([\w.-]+)\)/lib/\1/([^/]+)\Z")
_STARTING = frozenset(
    ("node", "lifecycle", "test", "container", "composable", "load", "include", "group")
)  # fmt: skip
_OF_NODE = frozenset(("remap", "parameter", "parameter-file"))
_DOING = collect_methods(_Launch, "do_")


def _split_words(text: LaunchText) -> list[LaunchText]:
    """The words of a part of a command, of which a shell may be given several as one."""
    return [wrap(word) for word in text.value.split()] if text.value is not None else [text]


def _split_rule(text: LaunchText) -> tuple[str, LaunchText]:
    """What a rule `old:=new` is for, and what it gives; the former is empty for what is none, or where it is not known.
    Of one that is one of several rules for the same, what it gives is one of theirs."""
    every = [text.value] if text.value is not None else list_either(text.shown)
    pairs = [one.partition(":=") for one in every]
    old = pairs[0][0]
    if "<" in old or any(not given or other != old for other, given, _ in pairs):
        return "", text
    if text.value is not None:
        return old, wrap(pairs[0][2])
    new = LaunchText(None, pairs[0][2], text.reasons)
    for _, _, other in pairs[1:]:
        new = make_either(new.shown, other, *text.reasons)
    return old, new


def _fill_open(name: LaunchText) -> str:
    """A name; what is not known of it stands in brackets, as in the names of nodes."""
    return name.value if name.value is not None else make_open_part(name.shown)


def _drop_earlier(remaps: list[Remap]) -> list[Remap]:
    """Remappings less those for whose name there is a later one, as roslaunch keeps them."""
    kept: list[Remap] = []
    for remap in remaps:
        if remap.old.value is not None and not remap.conditions:
            kept = [k for k in kept if k.old.value is None or normalise(k.old.value) != normalise(remap.old.value)]
        kept.append(remap)
    return kept
