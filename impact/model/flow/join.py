"""Facts of nodes joined into the message-flow graph: sites bound to nodes, with guards and triggers."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from msgspec import structs

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ....edges.reach import walk
from ...facts.flow import FlowCall, FlowExpr, FlowFile, Guard
from ..launch.result import EMPTY, Launched, ShareLine, Started
from ..launch.text import LaunchText, make_unknown, wrap
from . import nodes as programs_of
from .build_constants import BuildConstants
from .called import CalledFunctions
from .calls import FOREIGN, Calls, FrameworkCall
from .code import CodeFile, FlowCode, Fn, find_argument, find_parameter, get_tail, list_made
from .defined import DefinedInterfaces
from .documents import Documents
from .endpoints import Site, Sites, Statement, unparse
from .frameworks import Frameworks, load_frameworks
from .graph import (
    LOST_INCLUDE,
    Callback,
    Coverage,
    Endpoint,
    Graph,
    GuardAt,
    How,
    Node,
    ParameterUse,
    Publish,
    Qos,
    Timer,
    Trigger,
    Unresolved,
    Way,
)
from .loads import Loaded, list_loaded
from .names import (
    NameRefused,
    RemappingRule,
    has_known_segment,
    is_open,
    join_name,
    make_open_part,
    normalise,
    remap_ros2_name,
    resolve_ros1_name,
    resolve_ros2_name,
)
from .nodes import BuiltPackage, CodeReach, StartableProgram
from .objects import NodeObject, NodeObjects, make_key
from .outside import list_outside
from .plugin_hosts import PluginHosts, select_own
from .qos import apply_overrides, find_qos, list_overridable
from .started import Instance, make_instance
from .types import Cls, FlowType, parse_flow_type
from .values import ASKING, TOO_MANY, FlowValue, FlowValues, Work, spell_condition, spell_pattern

_WORD = re.compile(r"[A-Za-z_]\w*")
_OVERRIDES = re.compile(r"qos_overrides\.").match
# The condition of a name that code gives which a node does not run.
_PASSED = "something that runs passes the name"
_LOADED = "what loads it is in no namespace"
_MOST_WAYS = 16
_DEEPEST = 10
_DEEPEST_GIVEN = 3
_TRIGGERS = {
    "subscriber": "subscriber", "server": "service", "action server": "action", "client": "service",
    "action client": "action", "publisher": "unknown",
}  # fmt: skip


class CallWay(Way, frozen=True):
    """A way to a function. steps: the functions that it runs through before it, outermost first, each with the call
    that leads on (None for what only stands in the function); of several ways with the same guards that give the same
    for what guards ask of parameters, those of one. times: how many ways these are."""

    steps: tuple[tuple[Fn, FlowCall | None], ...] = ()
    times: int = 1

    @property
    def functions(self) -> tuple[str, ...]:
        """The names of the functions."""
        return tuple(fn.name for fn, _ in self.steps)


class Running(NamedTuple):
    """A program with the node it is, and what of the code it reaches. instance: how a launch starts it; values: what
    expressions are worth there; classes: by key. loaded: how the node loads this program, which is a nodelet then.
    objects: of a program that is several nodes the keys of those that this is, as NodeObject has them, None where it is
    one; others: those of its other nodes alone, where this is the first of them, which has all that no key is about.
    fixed: what a launch does not change of its name, remaps: its own remappings, as NodeObject has them. within: of a
    plugin in the node that loads it, what that runs too; only_if: the condition under which it loads it."""

    program: StartableProgram
    node: Node
    functions: set[Fn]
    classes: set[str]
    values: FlowValues
    instance: Instance | None = None
    loaded: Loaded | None = None
    objects: frozenset[str] | None = None
    others: frozenset[str] | None = None
    fixed: frozenset[str] = frozenset()
    remaps: tuple[RemappingRule, ...] = ()
    within: set[Fn] | None = None
    only_if: str = ""

    def limit_values(self) -> FlowValues:
        """What expressions are worth in what it runs."""
        return self.values.run(self.functions if self.within is None else self.within)


Owner = Running | Node | None
"""What runs a piece of code: a program, a library, or nothing that is known."""


class Join:
    """One body of code joined. files: facts by path; package_of: the package a path belongs to; built: what is built of
    it; ros: the generation where a framework does not tell; defined: knows which interfaces there are; before: as for
    Code; find_file: the workspace path of a file in a package's share folder, empty for what is not there; uncompiled:
    the sources that were left out of the files, since nothing compiles them; constants: what the builds define;
    documents: the files that it reads by itself."""

    def __init__(
        self,
        files: Mapping[str, FlowFile],
        package_of: Callable[[str], str],
        built: Iterable[BuiltPackage] = (),
        ros: int = 2,
        table: Frameworks | None = None,
        defined: DefinedInterfaces | None = None,
        before: FlowCode | None = None,
        find_file: Callable[[str, str], str] = lambda package, path: "",
        uncompiled: Iterable[str] = (),
        constants: BuildConstants | None = None,
        documents: Documents | None = None,
    ):
        self.ros, self.built, self._find_file = ros, list(built), find_file
        self._uncompiled = tuple(sorted(uncompiled))
        self.plugins = {name: cls for package in self.built for name, cls in package.plugins.items()}
        sources = (CodeFile(path, package_of(path), facts) for path, facts in sorted(files.items()))
        self.code = FlowCode(sources, before, constants)
        self.calls = Calls(self.code, table or load_frameworks())
        self.values = FlowValues(self.calls)
        self.values.documents = documents or self.values.documents
        self.sites = Sites(self.code, self.calls, self.values, defined or DefinedInterfaces())
        self.reach = CodeReach(self.sites)
        self.objects = NodeObjects(self.calls, self.values, ros)
        self.hosts = PluginHosts(self.calls, self.plugins)
        self.triggers = group_pairs(self._list_triggers())
        self.called = CalledFunctions(self.code)
        # Of a use it is the same in every node that runs it.
        self._qos: dict[int, Qos | None] = {}
        self._asked: dict[int, list[FlowValue]] = {}
        # Of the last launch, which is asked for more than once.
        self._started: tuple[Launched, tuple[list[Running], list[Unresolved]]] | None = None
        # By the use: who runs it, whether another may share it who runs other functions, on what it rests, and what it
        # is then. Who runs it keeps the ids in the key from being reused.
        self._sites_of: dict[tuple, list[tuple[Running, bool, Work, Site]]] = {}
        # By the id() of the functions that a node reaches, which are kept for that: those of them that are called.
        self._called_of: dict[int, tuple[set[Fn], frozenset[Fn]]] = {}
        # Of a function it is the same in all nodes that run the same of what leads to it.
        self._ways: dict[tuple[Fn, frozenset[Fn]], list[CallWay]] = {}

    def list_running(self) -> list[Running]:
        """All programs that talk, with their nodes, sorted."""
        return list(self._running)

    @cached_property
    def reached(self) -> frozenset[Fn]:
        """The functions that a program is seen to reach."""
        return frozenset(fn for one in self._running for fn in one.functions)

    @cached_property
    def _running(self) -> list[Running]:
        found: list[Running] = []
        for program in programs_of.list_programs(self.code, self.built, self._find_kinds):
            functions, classes = self._find_reached(program)
            if program.kind == "plugin":
                functions, classes = self._leave_out_nodes(program, functions, classes)
            named = [use for use in self.calls.select_uses("node") if use.fn in functions]
            node, use = self._make_node(program, named, self.values.run(functions))
            one = Running(program, node, functions, classes, self.values)
            several = program.kind in ("executable", "script", "component", "plugin")
            found += self._split_by_object(one, use) if several else [one]
        return found

    def _find_reached(self, program: StartableProgram, cut: Mapping[Fn, Fn] = {}) -> tuple[set[Fn], set[str]]:
        """The functions and classes (by key) that a program reaches. cut: as for CodeReach.find_reached()."""
        if program.kind in ("executable", "script"):
            others = programs_of.collect_sources_of_others(program, self.built)
            others |= programs_of.collect_replaced_sources(program, self.code) | self.code.unused_headers
            functions, classes = self.reach.find_reached(program.roots, (), others, cut)
            if not program.roots:
                functions = {fn for fn in self.code.functions if fn.source.path in program.files}
            return functions | self._find_imported(functions), classes
        named = self.code.classes.get(get_tail(program.plugin), ())
        cls = next((one for one in named if one.source.path == program.path), None)
        return self.reach.find_reached(program.roots, [cls] if cls is not None else [], cut=cut)

    def _find_imported(self, functions: set[Fn]) -> set[Fn]:
        """The bodies of modules of Python that make endpoints where what runs imports them, by itself or through other
        modules."""
        if not self._making_bodies:
            return set()
        queue = list({fn.source.path: fn.source for fn in functions if fn.source.facts.language == "python"}.values())
        seen = {source.path for source in queue}
        while queue:
            for module in self.code.modules.list_imported(queue.pop()):
                if module.path not in seen:
                    seen.add(module.path)
                    queue.append(module)
        return {fn for path in seen for fn in self._making_bodies.get(path, ())} - functions

    @cached_property
    def _making_bodies(self) -> dict[str, list[Fn]]:
        """The bodies of modules of Python that make endpoints, by file, without those of programs: what names a node,
        or does something only where it is started itself."""
        uses = [site.use for site in self.sites.endpoints if not site.implied and not site.use.fn.name]
        bodies = dict.fromkeys(use.fn for use in uses if use.fn.source.facts.language == "python")
        naming = {use.fn for use in self.calls.select_uses("node")}
        kept = (fn for fn in bodies if not any("__name__" in guard.text for guard in fn.facts.guards))
        return group_pairs((fn.source.path, fn) for fn in kept if fn not in naming)

    def _leave_out_nodes(
        self, program: StartableProgram, functions: set[Fn], classes: set[str]
    ) -> tuple[set[Fn], set[str]]:  # fmt: skip
        """What a plugin reaches without what it asks of nodes that it is given: the program that makes them runs that.
        classes: that it makes objects of, by key."""
        given = {
            fn: Fn(fn.source, structs.replace(fn.facts, calls=(), assignments=()))
            for fn in functions
            if (cls := self.code.find_owner(fn)) is not None
            and cls.key not in classes
            and "node" in self._find_kinds(cls)
        }
        if not given:
            return functions, classes
        left, classes = self._find_reached(program, given)
        return left - given.keys(), classes

    def _select_open(self, parts: list[Running]) -> list[Running]:
        """Of the nodes that a program is those that it makes where the launch closes branches; the first where it makes
        none, since it is started all the same."""
        every = [self._drop_closed(part) for part in parts]
        found = [one for one, is_made in every if is_made]
        if not found or every[0][1] or parts[0].others is None:
            return found or [one for one, _ in every[:1]]
        # What no key is about is in the first that is made.
        first = found[0]
        others = parts[0].others.union(parts[0].objects or ()) - (first.objects or frozenset())
        return [first._replace(others=others), *found[1:]]

    def _drop_closed(self, running: Running) -> tuple[Running, bool]:
        """A node without what it reaches through branches alone that the launch closes, and without objects that it
        makes in these alone; and whether it is made itself."""
        values = running.limit_values()
        cut: dict[Fn, Fn] = {}
        shut_lines: set[str] = set()
        for fn in running.functions & self._asking.keys() if values.settings else ():
            closed = {place for place in self._asking[fn] if self._is_shut(running, values, fn, place)}
            if closed:
                facts = fn.facts
                shut = {row for row in range(len(facts.guards)) if not closed.isdisjoint(fn.list_guards_around(row))}
                calls = tuple(call for call in facts.calls if call.guard not in shut)
                assignments = tuple(each for each in facts.assignments if each.guard not in shut)
                cut[fn] = Fn(fn.source, structs.replace(facts, calls=calls, assignments=assignments))
                open_lines = {row.line for row in (*calls, *assignments)}
                rows = (row for row in (*facts.calls, *facts.assignments) if row.line not in open_lines)
                shut_lines.update(make_key(fn, row.line) for row in rows)
        if not cut:
            return running, True
        functions, classes = self._find_reached(running.program, cut)
        lost = running.classes - classes
        left = {fn for fn in functions if (cls := self.code.find_owner(fn)) is None or cls.key not in lost}
        is_made = not self._is_lost(running, lost, shut_lines)
        return running._replace(functions=running.functions & left, classes=classes), is_made

    def _is_lost(self, running: Running, lost: set[str], shut_lines: set[str]) -> bool:
        """Whether a node, of a program that is several, is not made. lost: classes that no object is made of;
        shut_lines: keys of the places where nothing is made."""
        if running.objects is None:
            return False
        own = running.objects & (running.classes | shut_lines)
        gone = own & (lost | shut_lines)
        makers = ([make_key(maker, line) for maker, _, line in rows] for rows in running.values.made.values() if rows)
        return (bool(gone) if running.others is None else bool(own) and gone == own) or any(
            shut_lines.issuperset(keys) for keys in makers
        )

    @cached_property
    def _asking(self) -> dict[Fn, list[int]]:
        """The guards, by their places, that may ask for a parameter by what stands in them, and under which nodes or
        objects of the code are made or functions called that lead to an endpoint; by the function."""
        uses = self.calls.select_uses("parameter")
        words = self.values.parameter_words.union(get_tail(use.call.callee) for use in uses)
        making = {fn for site in self.sites.endpoints for fn in (site.use.fn, *self._find_leading(site.use.fn))}
        nodes = group_pairs((use.fn, use.call.guard) for use in self.calls.select_uses("node"))
        found: dict[Fn, list[int]] = {}
        for fn in self.code.functions:
            asking = {place for place, guard in enumerate(fn.facts.guards) if guard.kind in ASKING}
            asking = {place for place in asking if not words.isdisjoint(_WORD.findall(fn.facts.guards[place].text))}
            calls = [call for call in fn.facts.calls if call.guard >= 0] if asking else ()
            leading = {call.guard for call in calls if not making.isdisjoint(self.code.list_targets(call.callee, fn))}
            lines = {line for name, _, line in list_made(fn, self.code) if get_tail(name) in self.code.classes}
            rows = (*fn.facts.calls, *fn.facts.assignments) if asking else ()
            leading |= {row.guard for row in rows if row.guard >= 0 and row.line in lines}
            leading.update(nodes.get(fn, ()))
            around = {place for guard in leading for place in fn.list_guards_around(guard)}
            if not asking.isdisjoint(around):
                found[fn] = sorted(asking & around)
        return found

    def _split_by_object(self, running: Running, use: FrameworkCall | None) -> Iterator[Running]:
        """A program, and a node more for each further node object with a name of its own: in ROS 2 every one is a node
        by itself, and talks in its own name. use: that names the first."""
        loaded = next(map(self.code.find_owner, running.program.roots), None) if running.program.plugin else None
        objects = self.objects.list_objects(running.functions, loaded)
        if running.program.kind == "plugin":
            is_node = loaded is None or self.objects.is_node(loaded)
            yield from [running] if is_node or running.node.name else self._split_from_plugin(running, objects)
            return
        first = [one for one in objects if one.name == running.node.name or use in one.uses]
        first = [one for one in first if one.name == running.node.name] or first
        if first and not is_open(first[0].name):
            # Another constructor of their class gives a name that no object has.
            first = [one for one in first if one.name == first[0].name]
        further = [one for one in objects if one not in first] if first else []
        told = first[0] if len(first) == 1 else None
        if told is not None and not is_open(told.name) and running.node.name:
            # What its class is made with says more than what its code may give to any.
            running = running._replace(node=structs.replace(running.node, name=told.name))
        if not further:
            yield running if told is None else running._replace(fixed=told.fixed, remaps=told.remaps)
            return
        count = Counter(key for one in objects for key in one.keys)
        # Which of several nodes any object of a class is, is not known: it counts for the first.
        shared = {key for key in count if count[key] > 1 and key.startswith("any ")}
        own = shared.union(*(one.keys for one in first))
        others = frozenset().union(*(one.keys for one in further)) - own
        values = told.values if told is not None else running.values
        fixed, remaps = (told.fixed, told.remaps) if told is not None else (frozenset(), ())
        yield running._replace(objects=own, others=others, values=values, fixed=fixed, remaps=remaps)
        for one in further:
            node = structs.replace(running.node, id=f"{running.node.id}{one.name}", name=one.name)
            yield running._replace(
                node=node, objects=one.keys - shared, values=one.values, fixed=one.fixed, remaps=one.remaps
            )

    @staticmethod
    def _split_from_plugin(running: Running, objects: Sequence[NodeObject]) -> Iterator[Running]:
        """A plugin that is no node, and the nodes that it makes, as far as their names are known."""
        named = [one for one in objects if not is_open(one.name)]
        made = frozenset().union(*(one.keys for one in named))
        yield running._replace(objects=frozenset(), others=made) if named else running
        for one in named:
            node = structs.replace(running.node, id=f"{running.node.id}{one.name}", name=one.name)
            yield running._replace(node=node, objects=one.keys, values=one.values, fixed=one.fixed, remaps=one.remaps)

    def runs(self, running: Running, use: FrameworkCall, through: Sequence[FrameworkCall] = ()) -> bool:
        """Whether a node runs a use in one of its functions. through: the uses that make what it is called on, where it
        does not tell itself on which node it is made."""
        if running.objects is None:
            return True
        keys: frozenset[str] = frozenset()
        for one in through:
            keys |= self.objects.find_keys(one, running.functions)
        keys = keys or self.objects.find_keys(use, running.functions)
        return self._is_on(keys, running)

    @staticmethod
    def _is_on(keys: frozenset[str], running: Running) -> bool:
        """Whether what keys tell is made on a node of a program."""
        objects, others = running.objects or frozenset(), running.others
        return bool(keys & objects) or (others is not None and not keys & others)

    def find_started(self, launch: Launched) -> tuple[list[Running], list[Unresolved]]:
        """The nodes that a launch starts, under the names it gives them; and the starts that the code does not have."""
        if self._started is None or self._started[0] is not launch:
            self._started = launch, self._start(launch)
        return self._started[1]

    def _start(self, launch: Launched) -> tuple[list[Running], list[Unresolved]]:
        found: list[Running] = []
        containers = {full: one for one in launch.started if (full := _find_container_name(one))}
        missing = [self._explain_outside(include) for include in launch.outside]
        for start in launch.started:
            at = self._locate(start.at)
            if start.kind == "process" and not (start.package.value and self._select_fitting(start)):
                missing.append(Unresolved("started command", "it may be a node", *at, start.executable.shown))
                continue
            what = start.plugin.value or start.executable.value
            if what is None:
                written = start.plugin.shown or start.executable.shown
                reasons = "; ".join((*start.executable.reasons, *start.plugin.reasons))
                missing.append(Unresolved("started node", reasons or "its executable is not known", *at, written))
                continue
            fitting = self._select_fitting(start)
            if not fitting:
                reason = f"no code of `{start.package.shown}` here is `{what}`"
                if start.kind != "container":
                    missing.append(Unresolved("started node", reason, *at, what))
                continue
            one = next((each for each in fitting if each.program.roots), fitting[0])
            arguments = tuple(argument.value for argument in start.arguments if argument.value is not None)
            known = arguments if len(arguments) == len(start.arguments) else None
            # In ROS 2 a program may be several nodes, and the name that a launch file gives is for all of them.
            parts: list[Running] = []
            for part in (each for each in fitting if each.program == one.program):
                namespace, _, own = part.node.name.rpartition("/")
                own = own or f"<{one.program.executable or get_tail(one.program.plugin)}>"
                given = start
                if start.kind == "composable" and start.generation != 1 and not self._takes_options(part):
                    given = _give_container(start, containers)
                if part.fixed:
                    given, namespace = _keep_fixed(given, part.fixed, namespace, start.namespace)
                instance = make_instance(launch, own, given, namespace)
                if start.kind == "composable" and start.generation == 1:
                    manager = containers.get(start.container.value or "") or _give_container(start, {})
                    instance = instance._replace(process=make_instance(launch, "", manager))
                node = structs.replace(
                    part.node, id=instance.name, name=instance.name, started=f"{at[0]}:{at[1]}",
                    uncertain=instance.uncertain,
                )  # fmt: skip
                name = instance.name if start.generation == 1 else ""
                values = part.values.apply_launch(instance.settings, known, name)
                parts.append(part._replace(node=node, instance=instance, values=values))
            found += self._select_open(parts)
        return found, missing

    def _takes_options(self, part: Running) -> bool:
        """Whether a node of a component takes what a container hands to it; another is one of the process of the
        container like any."""
        if part.objects is not None and part.others is None:
            return "handed" in part.fixed
        loaded = next(map(self.code.find_owner, part.program.roots), None)
        return loaded is None or not self._leaves_options(loaded)

    @cache_method
    def _leaves_options(self, loaded: Cls) -> bool:
        return self.objects.leaves_options(loaded)

    def _locate(self, at: ShareLine) -> tuple[str, int]:
        """The workspace path and line of a line in a package's share folder."""
        return self._find_file(at.package, at.path) or f"{at.package}/{at.path}".lstrip("/"), at.line

    def _explain_outside(self, include: Started) -> Unresolved:
        """Why what a launch file includes is not followed."""
        package, path, at = include.package.value, include.executable, self._locate(include.at)
        if not path.value:
            return Unresolved(LOST_INCLUDE, "; ".join(path.reasons) or "its path is not known", *at, path.shown)
        if not package:
            return Unresolved(LOST_INCLUDE, "it is not in the share folder of a package", *at, path.shown)
        written = f"$(find {package})/{path.value}"
        if all(one.package != package for one in self.built):
            return Unresolved(f"{LOST_INCLUDE} of another package", f"`{package}` is not here", *at, written)
        here = self._find_file(package, path.value)
        reason = f"`{here}` is no launch file that can be read" if here else f"`{package}` has no such file"
        return Unresolved(LOST_INCLUDE, reason, *at, written)

    def add_loaded(self, running: Iterable[Running]) -> Iterator[Running]:
        """Nodes, each followed by the nodelets that its program loads into it."""
        programs = [one for one in self.list_running() if one.program.plugin]
        every = list(running)
        hosted = {id(one): list(self._list_hosted(one)) for one in every}
        loaded = {part.program for parts in hosted.values() for part in parts if not part.only_if}
        for one in every:
            if one.program in loaded and not one.node.name:
                continue  # it is in the nodes that load it
            yield one._replace(node=_note_loaded(one.node, hosted[id(one)]))
            yield from hosted[id(one)]
            for loaded in list_loaded(self.calls, one.functions, one.values, one.node.name):
                part = next((p for p in programs if self._is_plugin(p.program, loaded.plugin)), None)
                if part is not None:
                    values = one.values.rename(loaded.name)
                    yield part._replace(node=one.node, values=values, instance=one.instance, loaded=loaded)

    def _list_hosted(self, one: Running) -> Iterator[Running]:
        """The plugins that a node loads into itself."""
        if one.program.kind not in ("executable", "component", "nodelet") or not self.plugins:
            return
        settings = one.instance.settings if one.instance is not None else {}
        if one.values.node:
            below = f"{one.node.name}/"
            settings = {name[len(below) :]: text for name, text in settings.items() if name.startswith(below)}
        for load in self.hosts.list_hosted(one.functions, one.values, settings):
            for part in self._loadable:
                is_it = self._is_derived(part, load.name) if load.is_base else self._is_plugin(part.program, load.name)
                if not is_it or part.objects:
                    continue  # a node that it makes itself is none of those that load it

                def is_named(name: str, program: StartableProgram = part.program) -> bool:
                    return self._is_plugin(program, name)

                within = one.functions | part.functions
                values = one.values.apply_launch(
                    select_own(one.values.settings, is_named), one.values.arguments, one.values.node
                )
                for way in self.hosts.list_ways(one.functions, one.values.run(within), part.functions, is_named):
                    yield part._replace(
                        node=one.node, values=values.limit_to_calls({**values.way, **way}), instance=one.instance,
                        within=within, only_if=load.only_if,
                    )  # fmt: skip

    @cached_property
    def _loadable(self) -> list[Running]:
        """The plugins that a program may load into itself."""
        return [part for part in self.list_running() if part.program.kind == "plugin" and part.functions]

    def _is_derived(self, one: Running, base: str) -> bool:
        """Whether the class of a plugin derives from one of a name."""
        named = self.code.classes.get(get_tail(one.program.plugin), ())
        return any(get_tail(name) == base for cls in named for name in self.code.list_base_names(cls))

    def _is_plugin(self, program: StartableProgram, name: str) -> bool:
        """Whether a program is what pluginlib knows by a name."""
        wanted = self.plugins.get(name)
        if wanted is None:
            package, slash, _ = name.rpartition("/")
            wanted = name.replace("/", "::")
            same = not slash or program.package == package
            return program.plugin == wanted or (same and get_tail(program.plugin) == get_tail(wanted))
        return program.plugin.removeprefix("::") == wanted.removeprefix("::")

    @cached_property
    def _by_package(self) -> dict[str | None, list[Running]]:
        return group_pairs((one.program.package, one) for one in self._running)

    def _select_fitting(self, start: Started) -> list[Running]:
        """The programs that a launch may mean."""
        package, plugin = start.package.value, start.plugin.value
        # pluginlib knows nodelets of all packages, and a launch file names that of the loader beside them.
        anywhere = package is None or (bool(plugin) and package == "nodelet")
        programs = self._running if anywhere else self._by_package.get(package, [])
        if plugin:
            return [one for one in programs if one.program.plugin and self._is_plugin(one.program, plugin)]
        named = ((one, one.program.executable) for one in programs if one.program.executable)
        return [one for one, name in named if start.executable.value in (name, name.removesuffix(".py"))]

    def _find_kinds(self, cls) -> frozenset[str]:
        return self.calls.find_kinds(
            FlowType(cls.name, (), cls), next(iter(self.code.list_functions(cls)), _make_nobody(cls.source))
        )

    def _make_node(
        self, program: StartableProgram, named: list[FrameworkCall], running: FlowValues
    ) -> tuple[Node, FrameworkCall | None]:  # fmt: skip
        """The node that a program is, or the first of those, and the use that names it. running: what expressions are
        worth in what it runs."""
        own = self._list_plugin_names(program.plugin, named) if program.plugin else []
        in_main = [use for use in named if use.fn in program.roots]
        # Of the classes that name nodes, those that are made first where the program begins; helpers' nodes come later.
        made = [get_tail(name.partition("<")[0]) for root in program.roots for name, _, _ in list_made(root, self.code)]
        ranks = {name: place for place, name in reversed(list(enumerate(made)))}

        def rank(use: FrameworkCall) -> tuple[int, bool]:
            written = self.calls.find_argument(use, use.row.topic)
            return ranks.get(get_tail(use.fn.facts.owner), len(ranks)), written is None or written.kind != "text"

        others = sorted(named, key=rank) if program.kind in ("executable", "script") else []
        name, use = "", None
        for candidate in [*own, *in_main, *others]:
            written = self.calls.find_argument(candidate, candidate.row.topic)
            values = running.evaluate(written, candidate.fn, candidate.call.line)
            # `_` stands for a name that options give.
            texts = dict.fromkeys(value.text for value in values if value.text and value.text != "_")
            # Which of several it is, is not known.
            found = next(iter(texts), "") if len(texts) < 2 else ""
            given = self.objects.find_own_name(candidate, running)
            found = found if given is None else given
            if use is None or found:
                name, use = found or "", candidate
            if found and "{" not in found:
                break
        default = f"<{program.executable or _convert_to_snake(get_tail(parse_flow_type(program.plugin).name))}>"
        if use is not None and (written := self.calls.find_argument(use, use.row.topic)) is not None:
            default = programs_of.spell_unknown_name(written) or default
        # What loads a plugin is another program, which gives it a node, or a nodelet its name; who makes the node of a
        # program that makes none is not known either.
        unknown = program.kind in ("plugin", "nodelet") or not (named or self.ros == 2)
        if use is not None and not name:
            written = self.calls.find_argument(use, use.row.topic)
            if written is not None and written.kind != "text" and not self.calls.is_node(written, use.fn):
                default = _spell_open(written)  # what the code gives is not known
        if use is not None and name and self._is_anonymous(use, running):
            name += make_open_part("_<anonymous>")
        full = "" if unknown else normalise("/" + (name or default).lstrip("/"))
        if use is not None and full:
            full = self.objects.join_namespace(use, full.lstrip("/"), running)
        language = "python" if program.kind == "script" else "cpp"
        id = f"{program.package}/{program.executable or program.plugin}".lstrip("/")
        node = Node(
            id, full, program.package, program.kind, program.executable, program.plugin, language, program.path,
            program.line,
        )  # fmt: skip
        return node, use

    def _is_anonymous(self, use: FrameworkCall, running: FlowValues) -> bool:
        """Whether the name that a use gives may end in what is made up at every start of the program. running: what
        expressions are worth in it."""
        asked = self.calls.find_argument(use, use.row.anonymous) if use.row.anonymous else None
        if asked is None:
            return False
        if use.fn.source.facts.language == "cpp":
            return "AnonymousName" in unparse(asked)
        return any(value.text != "False" for value in running.evaluate(asked, use.fn, use.call.line))

    def _list_plugin_names(self, plugin: str, named: list[FrameworkCall]) -> list[FrameworkCall]:
        """The uses that name the nodes of the class of a plugin, its own before those of its bases."""
        ranks: dict[str, int] = {get_tail(plugin): 0}
        for cls in self.code.classes.get(get_tail(plugin), ()):
            for place, base in enumerate(self.code.list_bases(cls)):
                ranks.setdefault(get_tail(base.name), place)
        found = [use for use in named if get_tail(use.fn.facts.owner) in ranks]
        return sorted(found, key=lambda use: ranks[get_tail(use.fn.facts.owner)])

    def list_guards(self, fn: Fn, index: int) -> tuple[GuardAt, ...]:
        """The guards at a place of a function, outermost first."""
        found: list[Guard] = []
        rows = fn.facts.guards
        while 0 <= index < len(rows) and len(found) < 64:
            found.append(rows[index])
            index = rows[index].outer
        return tuple(GuardAt(g.kind, g.text, fn.source.path, g.line, fn.name) for g in reversed(found))

    def _list_triggers(self) -> Iterator[tuple[Fn, Trigger]]:
        """The functions that are triggered, with what does it."""
        for site in self.sites.endpoints:
            names = sorted({value.text for value in site.names if value.text}) or [site.written]
            for fn in site.callbacks:
                trigger = Trigger(_TRIGGERS[site.role], " or ".join(names), site.use.fn.source.path, site.use.call.line)
                yield fn, trigger
        for timer in self.sites.timers:
            for fn in timer.callbacks:
                use = timer.use
                yield fn, Trigger("timer", timer.period, use.fn.source.path, use.call.line)

    def list_ways(self, fn: Fn, functions: set[Fn] | None = None) -> list[CallWay]:
        """The ways that lead to a function from whatever triggers it. functions: those that run, all when None."""
        leading = self._find_leading(fn)
        key = (fn, leading if functions is None else leading & functions)
        known = self._ways.get(key)
        if known is None:
            known = self._ways[key] = self._walk_callers(fn, functions, 0, ())
        return known

    @cache_method
    def _find_leading(self, fn: Fn) -> frozenset[Fn]:
        """The functions from which a function may be reached."""

        def list_above(one: Fn) -> list[Fn]:
            around = self.code.find_enclosing(one)
            callers = [caller for caller, _ in self.code.callers.get(one, ())]
            return callers if around is None else [*callers, around]

        return frozenset(walk(list_above(fn), list_above))

    def _walk_callers(self, fn: Fn, functions: set[Fn] | None, depth: int, seen: tuple[Fn, ...]) -> list[CallWay]:
        found = [CallWay(trigger) for trigger in self.triggers.get(fn, ())]
        if fn in seen:
            return found
        here = (*seen, fn)
        goes_round = False
        for caller, call in self.code.callers.get(fn, ()) if depth <= _DEEPEST else ():
            if functions is not None and caller not in functions:
                continue
            own = self.list_guards(caller, call.guard)
            led = self._walk_callers(caller, functions, depth + 1, here)
            goes_round = goes_round or not led
            for way in led:
                found.append(CallWay(way.trigger, (*way.guards, *own), (*way.steps, (caller, call)), way.times))
                if len(found) >= _MOST_WAYS:
                    return found
        if not found and goes_round and seen:
            return found  # a call that only its own callee leads to is no further way
        if not found:
            around = self.code.find_enclosing(fn)
            if around is not None:
                ways = self._walk_callers(around, functions, depth + 1, here)
                return [CallWay(way.trigger, way.guards, (*way.steps, (around, None)), way.times) for way in ways]
            owner = get_tail(fn.facts.owner)
            starts = fn.name in ("main", "") or (owner and get_tail(fn.name) in (owner, "__init__"))
            kind = "start" if starts else "unknown"
            found.append(CallWay(Trigger(kind, get_tail(fn.name), fn.source.path, fn.facts.line)))
        same = group_pairs(((way.trigger, way.guards, self._list_given(way, fn)), way) for way in found)
        return [structs.replace(ways[0], times=sum(way.times for way in ways)) for ways in same.values()]

    def _list_given(self, way: CallWay, fn: Fn) -> tuple[FlowExpr | None, ...]:
        """What the calls of a way give for parameters that guards ask for."""
        called = [*(one for one, _ in way.steps[1:]), fn]
        return tuple(
            find_argument(call.arguments, place, name)
            for (_, call), callee in zip(way.steps, called, strict=False)
            if call is not None
            for place, name in self.list_asked_parameters(callee)
        )

    @cache_method
    def list_asked_parameters(self, fn: Fn, depth: int = 0) -> tuple[tuple[int, str], ...]:
        """The parameters, with their places, that may be asked for in the guards of a function, or of one that it hands
        them to."""
        rows = fn.facts.guards
        words = {word for row in rows for word in _WORD.findall(row.text)}
        if rows:
            words.update(word for row in fn.facts.assignments for word in _WORD.findall(row.value.text))
        named = [(place, one.name) for place, one in enumerate(fn.facts.parameters)]
        handed = {one.text for call in fn.facts.calls for one in call.arguments if one.kind == "name"}
        if depth < _DEEPEST_GIVEN and any(name in handed and name not in words for _, name in named):
            for call in fn.facts.calls:
                for target in self.code.list_targets(call.callee, fn):
                    asked = self.list_asked_parameters(target, depth + 1) if target is not fn else ()
                    given = (find_argument(call.arguments, place, name) for place, name in asked)
                    words.update(one.text for one in given if one is not None and one.kind == "name")
        return tuple((place, name) for place, name in named if name in words)

    def build(self, root: str = "", rev: str = "", unread: Iterable[str] = (), launch: Launched | None = None) -> Graph:
        """The graph of all programs, or of what a launch starts. Without one, code that no program runs belongs to
        `library` nodes, or to none."""
        running, missing = (self.list_running(), []) if launch is None else self.find_started(launch)
        owners = _Owners(self, list(self.add_loaded(running)), launch is not None)
        count = _Count(list(missing))
        endpoints = dict.fromkeys(self._list_endpoints(owners, count))
        self._count_foreign(owners, count)
        publishes = dict.fromkeys(self._list_publishes(owners, count))
        timers = dict.fromkeys(self._list_timers(owners))
        parameters = dict.fromkeys(self._list_parameters(owners, count))
        coverage = Coverage(
            count.calls, count.resolved, count.by_default, len(self.code.sources), tuple(sorted(unread)),
            tuple(sorted(count.unresolved, key=lambda one: (one.path, one.line, one.what))),
            tuple(Unresolved(use.row.does, f"inside `{use.fn.name}`", *_get_place(use)) for use in self.sites.wrapped),
            self._uncompiled, in_part=count.in_part,
        )  # fmt: skip
        known = [one.instance.started for one in running if one.instance is not None]
        outside = tuple(dict.fromkeys(list_outside(launch, known, self._locate))) if launch is not None else ()
        return Graph(
            owners.list_nodes(), tuple(endpoints), tuple(publishes), tuple(timers), tuple(parameters), coverage, root,
            rev, self.ros, outside,
        )  # fmt: skip

    def _list_endpoints(self, owners: _Owners, count: _Count) -> Iterator[Endpoint]:
        for site in self.sites.endpoints:
            those = owners.list_owners(site.use)
            if not those:
                continue
            if owners.launched:
                site = self._adapt_site(site, those[0])
            coming = [owner for owner in those if not self._is_left_out(site.use, owner)]
            adapted = [(owner, self._select_names_on(self._adapt_site(site, owner), owner)) for owner in coming]
            if not site.implied:
                # Of nodes that run the same code, one may have a name that is not known.
                every = ((those[0], site), *adapted)
                found = (self._find_missing(one) or self._find_refused(one, owner) for owner, one in every)
                lacking = next(filter(None, found), None)
                lost = None
                if lacking is not None:
                    pattern = spell_pattern(value for _, one in every for value in one.names)
                    lost = Unresolved(*lacking, *_get_place(site.use), site.written, pattern)
                count.call(lost, (site,))
            for owner, here in adapted:
                owners.use(owner)
                for value in here.names:
                    for type_ in _select_types(here, owner):
                        yield self._make_endpoint(here, value, type_, owner)

    def _count_foreign(self, owners: _Owners, count: _Count) -> None:
        """Counts calls that look like a framework's, on objects of classes that are not in the code."""
        for use in self.calls.select_uses(FOREIGN):
            if not self.is_of_other_ros(use) and owners.list_owners(use):
                reason = f"whether it is called on an object of {use.row.framework} is not known"
                count.call(Unresolved("call", reason, *_get_place(use), use.call.callee), ())

    def is_of_other_ros(self, use: FrameworkCall) -> bool:
        """Whether a call on an object of a class that is not in the code would be of ROS 1, in a workspace of ROS 2."""
        return use.row.does == FOREIGN and use.row.framework == "roscpp" and self.ros == 2

    def _list_publishes(self, owners: _Owners, count: _Count) -> Iterator[Publish]:
        for statement in self.sites.statements:
            those = owners.list_owners(statement.use, [site.use for site in statement.sites])
            if not those:
                continue
            if not statement.through:  # else counted where it sends
                sites = [self._adapt_site(site, those[0]) if owners.launched else site for site in statement.sites]
                reason = statement.reason or next((n.reason for s in sites for n in s.names if n.text is None), "")
                receiver = self.calls.get_receiver(statement.use)
                lost = None
                if reason:
                    pattern = "" if statement.reason else spell_pattern(value for one in sites for value in one.names)
                    lost = Unresolved("publish", reason, *_get_place(statement.use), receiver, pattern)
                count.call(lost, statement.sites)
            for owner in those:
                owners.use(owner)
                yield from self._make_publishes(statement, owner)

    def _list_timers(self, owners: _Owners) -> Iterator[Timer]:
        for timer in self.sites.timers:
            for owner in owners.list_owners(timer.use):
                if self._is_left_out(timer.use, owner):
                    continue
                owners.use(owner)
                node = _get_node(owner)
                yield Timer(
                    node.id if node else "", timer.period, _make_callback(timer.callbacks), *_get_place(timer.use)
                )

    def _list_parameters(self, owners: _Owners, count: _Count) -> Iterator[ParameterUse]:
        for use in self.calls.select_uses("parameter"):
            places = self._list_askers(use)
            running = [owners.list_owners(place, () if place is use else (use,)) for place in places]
            if not any(running):
                continue
            for place, values, those in zip(places, self._list_asked(use), running, strict=True):
                made = list(self._make_parameters(use, place, values, those))
                for owner in those if made else ():
                    owners.use(owner)
                if those and not any(value.text for value in values):
                    reasons = [value.reason for value in values]
                    reason = reasons[0] if reasons else "no name is given"
                    written = unparse(self.calls.find_argument(use, use.row.topic))
                    count.unresolved.append(Unresolved("parameter name", reason, *_get_place(place), written))
                yield from made

    @cache_method
    def _list_askers(self, use: FrameworkCall) -> list[FrameworkCall]:
        """Where the parameter of a use is asked for: by those that call a function which is called like the
        framework's, where these calls are no uses themselves; else where the use stands."""
        if not self.sites.wraps(use.fn, "parameter") or not self._is_asked_by_callers(use):
            return [use]
        found: list[FrameworkCall] = []
        for caller, call in self.code.callers.get(use.fn, ()):
            own = self.calls.find_use(caller, call)
            if caller is not use.fn and (own is None or own.row.does != "parameter"):
                found.append(use._replace(fn=caller, call=call))
        return found

    @cache_method
    def _list_asked(self, use: FrameworkCall) -> list[list[FlowValue]]:
        """The names of the parameter of a use in each place where it is asked for; the same in every node."""
        argument = self.calls.find_argument(use, use.row.topic)
        # By what is known of who makes the objects, which is the same for all methods of a class.
        lost: dict[int, list[FlowValue]] = {}
        names: list[list[FlowValue]] = []
        for place in self._list_askers(use):
            if place is use:
                names.append(self.list_parameter_names(use))
                continue
            held = self.values.limit_to_held(place.call, place.fn)
            objects = id(held.made) if held.made else 0
            found = lost.get(objects) or held.limit_to_calls({use.fn: place.call}).evaluate(
                argument, use.fn, use.call.line
            )
            if any(one.reason == TOO_MANY for one in found):
                lost[objects] = found  # nor is it known for others in these objects, at the same cost each
            names.append(found)
        return names

    def _is_asked_by_callers(self, use: FrameworkCall) -> bool:
        """Whether what a function called like the framework's reads is what its callers name: for one without a class,
        where it hands on the name it is given beside a node handle."""
        return bool(use.fn.facts.owner) or self.calls.is_name_handed_on(use.fn)

    def find_library(self, fn: Fn) -> Node | None:
        """The library that a function belongs to, as a node; None outside of packages."""
        package, path = fn.source.package, fn.source.path
        if not package:
            return None
        own = (one.libraries.items() for one in self.built if one.package == package)
        name = next((name for libraries in own for name, sources in libraries if path in sources), "")
        id = f"{package}/{name or path.rpartition('/')[2]}"
        return Node(id, "", package, "library", executable=name, language=fn.source.facts.language, path=path)

    def _find_missing(self, site: Site) -> tuple[str, str] | None:
        unknown = [value for value in site.names if value.text is None]
        if unknown or not site.names:
            return f"{site.role} name", unknown[0].reason if unknown else "no name is given"
        if not site.type and not site.types:
            name = self.sites.find_template_parameter(site.use)
            reason = f"nothing here fixes the parameter `{name}` of the template" if name else ""
            return f"{site.role} type", reason or "the type is not known where it is made"
        if site.reason:
            return f"{site.role} callback", site.reason
        return None

    def _find_refused(self, site: Site, owner: Owner) -> tuple[str, str] | None:
        """What of a site is not known since ROS refuses its name."""
        found = [self.resolve_name(site, value, owner) for value in site.names]
        return next(((f"{site.role} name", reason) for name, _, reason in found if not name), None)

    def _adapt_site(self, site: Site, owner: Owner) -> Site:
        """A site as it is for whoever runs it: with the parameters and the arguments that a launch gives."""
        if not isinstance(owner, Running) or site.implied or (owner.values is self.values and self._is_written(site)):
            return site
        values = owner.limit_values()
        known = self._sites_of.setdefault((id(site.use), bool(values.node)), [])
        for one, is_shared, rests, found in known:
            if (is_shared or one.functions is owner.functions) and values.is_same(rests):
                return found
        # What code that the node does not run passes to its functions is none of its names.
        (prefix, names), rests = values.record(lambda: self.sites.find_names(site.use, values))
        beside: list[Work] = []
        if all(name.text is None for name in names) and any(name.unpassed for name in names):
            # It comes from code that the node does not run, as far as is known.
            (_, elsewhere), work = owner.values.record(lambda: self.sites.find_names(site.use, owner.values))
            beside.append(work)
            names = tuple(
                name if name.text is None else name._replace(only_if=_join_conditions(name.only_if, _PASSED))
                for name in elsewhere
            )
        type_ = site.type
        if not type_:
            type_, work = owner.values.record(lambda: self.sites.find_type(site.use, owner.values))
            beside.append(work)
        for work in beside:
            rests.note_given(work)
        found = site._replace(names=names, prefix=prefix, type=type_)
        known.append((owner, not beside, rests, found))
        return found

    def _select_names_on(self, site: Site, owner: Owner) -> Site:
        """A site with those of its names that it has on a node, of several that a program is: each node that code is
        given has what it is given with it."""
        if not isinstance(owner, Running) or owner.objects is None or site.implied or len(site.names) < 2:
            return site
        use, values = site.use, owner.limit_values()
        ways = self.sites.contexts.list_contexts(use.fn, use.call.guard, values)
        if len(ways) < 2:
            return site
        known = [(self.objects.find_keys_on_way(use, owner.functions, way), way) for way in ways]
        found = [self.sites.find_names(use, way) for keys, way in known if self._is_on(keys, owner)]
        names = tuple(dict.fromkeys(name for _, names in found for name in names))
        same = bool(names) and {prefix for prefix, _ in found} == {site.prefix}
        return site._replace(names=names) if same and len(found) < len(ways) else site

    def _is_written(self, site: Site) -> bool:
        """Whether a site's only name is written where it is made."""
        named = self.calls.find_argument(site.use, site.use.row.topic)
        return len(site.names) < 2 and (named is None or named.kind == "text")

    def _make_endpoint(self, site: Site, value: FlowValue, type_: str, owner: Owner) -> Endpoint:
        use = site.use
        node = _get_node(owner)
        topic, how, reason = self.resolve_name(site, value, owner)
        if id(use) not in self._qos:
            self._qos[id(use)] = find_qos(self.calls, self.values, use)
        qos = self._qos[id(use)]
        if qos is not None and topic and isinstance(owner, Running) and use.row.qos:
            policies = list_overridable(use) if any(map(_OVERRIDES, owner.values.settings)) else ()
            qos = apply_overrides(qos, topic, site.role, policies, owner.values.settings) if policies else qos
        replaced = "the name is not replaced" if value.how == "partly" else ""
        loads = owner.only_if if isinstance(owner, Running) else ""
        condition = "" if site.implied else self._describe_condition(use, owner)
        only_if = _join_conditions(loads, _describe_loading(value, owner), condition, value.only_if, replaced)
        ran = owner.functions if isinstance(owner, Running) else ()
        # A class that several nodes use is given the callback of each.
        callbacks = tuple(fn for fn in site.callbacks if fn in ran) or site.callbacks
        return Endpoint(
            site.role, node.id if node else "", topic, type_, *_get_place(use), site.written, how, qos,
            _make_callback(callbacks), use.fn.name, use.call.target, reason or site.reason, site.implied,
            use.row.framework, only_if, _make_code_name(site, value.text or "") if topic else "",
            self.list_guards(use.fn, use.call.guard),
        )  # fmt: skip

    def _describe_condition(self, use: FrameworkCall, owner: Owner) -> str:
        """On what it depends that a node comes to a call, as Endpoint.only_if has it."""
        if isinstance(owner, Running) and not self._is_called(use.fn, owner):
            return f"something calls `{use.fn.name or 'it'}`"
        guards = self.list_guards(use.fn, use.call.guard)
        texts = [guard.text for guard in guards if guard.kind == "cpp"]
        texts += [f"something runs {guard.text}" for guard in guards if guard.kind == "never"]
        closed = tuple(self._list_closed(use.fn, use.call.guard, owner)) or (self._describe_made(use.fn, owner, ()),)
        return " && ".join(filter(None, (*texts, *closed)))

    def _describe_made(self, fn: Fn, owner: Owner, seen: tuple[Fn, ...]) -> str:
        """The conditions under which alone a node comes to a function: those where the objects of its class are made,
        or where it is called, if the code alone calls it. Empty where one may hold as far as is known, or where not all
        is known that leads there. seen: the functions that were asked already."""
        if fn in seen or len(seen) > _DEEPEST_GIVEN or not isinstance(owner, Running) or fn in owner.program.roots:
            return ""
        cls = self.code.find_owner(fn)
        rows: list[tuple[Fn, int]] = []
        if cls is not None and not any(self.code.find_owner(root) == cls for root in owner.program.roots):
            kinds = (cls, *self.code.derived.get(cls.key, ()))
            made = (row for one in kinds for row in self.code.constructions.get(one.key, ()))
            rows = [(maker, guard) for maker, _, line in made for guard in maker.collect_guards(line) or (-1,)]
        found = self._join_closed(rows, owner, (*seen, fn))
        if not found and self.called.is_called_by_code(fn) and fn not in self._handed_on:
            rows = [(caller, call.guard) for caller, call in self.code.callers.get(fn, ())]
            found = self._join_closed(rows, owner, (*seen, fn))
        return found

    def _join_closed(self, rows: Iterable[tuple[Fn, int]], owner: Running, seen: tuple[Fn, ...]) -> str:
        """The conditions of places in functions that a node runs, each the one of a guard, where none of them holds as
        far as is known; empty where one may."""
        found: dict[str, None] = {}
        for fn, guard in rows:
            if fn in owner.functions:
                closed = " && ".join(self._list_closed(fn, guard, owner)) or self._describe_made(fn, owner, seen)
                if not closed:
                    return ""
                found[closed] = None
        return " || ".join(found)

    @cached_property
    def _handed_on(self) -> frozenset[Fn]:
        """The functions that are given to others, as callbacks are."""
        given = (fn for site in self.sites.endpoints for fn in site.callbacks)
        timed = (fn for timer in self.sites.timers for fn in timer.callbacks)
        return frozenset((*given, *timed, *self.code.bound))

    def _is_called(self, fn: Fn, running: Running) -> bool:
        """Whether something that a node runs may call a function."""
        if fn not in running.functions:
            return False
        # What another program calls, or finds by name, is not seen from a plugin alone.
        if running.program.kind not in ("executable", "script", "component") or not running.program.roots:
            return self.code.may_be_called(fn)
        if not self.called.is_called_by_code(fn):
            return True
        known = self._called_of.get(id(running.functions))
        if known is None:
            begins = running.program.roots if running.program.kind != "component" else ()
            called = self.called.find_called(begins, running.functions)
            known = self._called_of[id(running.functions)] = running.functions, called
        return fn in known[1]

    def _list_closed(self, fn: Fn, place: int, owner: Owner) -> Iterator[str]:
        """The conditions around a place in a function, a guard's, that do not hold in a node as far as is known, or of
        which that is not known though they ask for what a launch gives, or may give in a file that is not known."""
        values = owner.limit_values() if isinstance(owner, Running) else self.values
        is_unread = isinstance(owner, Running) and owner.instance is not None and owner.instance.is_unread
        for guard, decided in reversed(list(values.decide_guards(fn, place))):
            asks_open = decided.asks_open or (is_unread and "default" in decided.hows)
            asks_open = asks_open and (guard.kind != "unless" or self._has_other_branch(fn, guard))
            if decided.holds is False or asks_open or (decided.holds is None and decided.is_given):
                yield spell_condition(guard.kind, guard.text)

    @cache_method
    def _has_other_branch(self, fn: Fn, guard: Guard) -> bool:
        """Whether something is made where the condition of a guard holds; else that only ends the function, or the
        program, for a value that is refused."""
        other = structs.replace(guard, kind="if")
        made = (use.call.guard for use in self._uses_in.get(fn, ()) if use.row.does in _TRIGGERS)
        return any(fn.facts.guards[place] == other for one in made for place in fn.list_guards_around(one))

    @cached_property
    def _uses_in(self) -> dict[Fn, list[FrameworkCall]]:
        return group_pairs((use.fn, use) for use in self.calls.uses)

    def _is_left_out(self, use: FrameworkCall, owner: Owner) -> bool:
        """Whether a node does not come to a call, by what the launch gives that starts it."""
        if not isinstance(owner, Running) or owner.instance is None or use.call.guard < 0:
            return False
        values, fn = owner.limit_values(), use.fn
        return any(self._is_shut(owner, values, fn, place) for place in fn.list_guards_around(use.call.guard))

    @staticmethod
    def _is_shut(running: Running, values: FlowValues, fn: Fn, guard: int) -> bool:
        """Whether a guard does not hold by what a launch gives, whoever starts it. values: in the node."""
        (_, decided), rests = values.record(lambda: next(values.decide_guards(fn, guard)))
        if decided.holds is not False or not decided.is_given:
            return False
        chosen = running.instance.chosen if running.instance is not None else frozenset[str]()
        asked = (name for name, value in rests.settings.items() if value is not None) if chosen else ()
        return not any(values.find_setting_key(name) in chosen for name in asked)

    def resolve_name(self, site: Site, value: FlowValue, owner: Owner) -> tuple[str, How, str]:
        """The full name that a site has in a node, how it is known, and why not."""
        node = _get_node(owner)
        instance = owner.instance if isinstance(owner, Running) else None
        text = value.text if value.text is not None else value.shown
        if value.text is None and text[:1] in ("", "<"):
            return "", "unresolved", value.reason  # what begins with something unknown may be in any namespace
        loaded = owner.loaded if isinstance(owner, Running) else None
        unknown = f"/<{(node.executable or get_tail(node.plugin)) if node else 'node'}>"
        full = loaded.name if loaded is not None else (node and node.name) or unknown
        namespace, _, own = full.rpartition("/")
        generation = self.calls.table.generations.get(site.use.row.framework, self.ros)
        if not generation:
            return text, value.how, ""
        one = generation == 1
        try:
            process = self._find_process(site, owner) if one else None
            if process is not None:
                instance, full = process, process.name
                namespace, _, own = full.rpartition("/")
            if one:
                if site.prefix and text[:1] not in ("/", "~", "{"):
                    text = f"~{text}" if site.prefix == "~" else f"{site.prefix}/{text}"
                text = text.replace("{node}", full).replace("{ns}", namespace or "/")
                plain = name = resolve_ros1_name(text, full)
                if loaded is not None:
                    plain = name = loaded.remap_name(text)
                # What the nodelet's own remappings give is not remapped again.
                if instance is not None and name == resolve_ros1_name(text, full):
                    name = instance.remap_name(name, 1)
            else:
                text = _make_code_name(site, text)
                plain = resolve_ros2_name(text, own, namespace or "/")
                kind = "topic" if site.role in ("publisher", "subscriber") else "service"
                rules = owner.remaps if isinstance(owner, Running) else ()
                name = remap_ros2_name(text, own, namespace or "/", rules, kind) if rules else plain
                # Those of the node itself come before those that a launch gives.
                if instance is not None and name == plain:
                    name = instance.remap_name(text, 2, kind)
                elif name != plain:
                    plain = name
        except NameRefused as error:
            return "", "unresolved", str(error)
        if is_open(name) or value.how == "partly":
            return name, "partly", value.reason
        if name != plain:
            return name, "launch", ""
        return name, "given" if site.implied and value.how == "literal" else value.how, ""

    def _find_process(self, site: Site, owner: Owner) -> Instance | None:
        """The node whose process a nodelet is in, where the handle of a site is that of the process; None for all
        else."""
        process = owner.instance.process if isinstance(owner, Running) and owner.instance is not None else None
        if process is None or not isinstance(owner, Running):
            return None
        return process if self.sites.handles.is_of_process(site.use, owner.limit_values()) else None

    def _make_publishes(self, statement: Statement, owner: Owner) -> Iterator[Publish]:
        use = statement.use
        node = _get_node(owner)
        functions = owner.functions if isinstance(owner, Running) else None
        own = self.list_guards(use.fn, use.call.guard)
        led = (Way(way.trigger, (*way.guards, *own)) for way in self.list_ways(use.fn, functions))
        ways = list(dict.fromkeys(led))
        guards = ways[0].guards if len(ways) == 1 else own
        triggers = tuple(dict.fromkeys(way.trigger for way in ways))
        common = {
            "path": use.fn.source.path, "line": use.call.line, "function": use.fn.name,
            "expression": statement.expression, "variable": self.calls.get_receiver(use), "guards": guards,
            "triggers": triggers, "ways": len(ways), "by": tuple(ways), "node": node.id if node else "",
            "through": statement.through,
        }  # fmt: skip
        if not statement.sites:
            yield Publish(topic="", type=statement.type, reason=statement.reason, **common)
        for site in statement.sites:
            if self._is_left_out(site.use, owner):
                continue
            here = self._select_names_on(self._adapt_site(site, owner), owner)
            for value in here.names:
                topic, _, reason = self.resolve_name(here, value, owner)
                for type_ in _select_types(here, owner):
                    yield Publish(topic=topic, type=type_, reason=reason, **common)

    def list_parameter_names(self, use: FrameworkCall) -> list[FlowValue]:
        """The names of a parameter that is declared or read; the same in every node."""
        known = self._asked.get(id(use))
        if known is None:
            known = self.values.evaluate(self.calls.find_argument(use, use.row.topic), use.fn, use.call.line)
            self._asked[id(use)] = known
        return known

    def _make_parameters(
        self, use: FrameworkCall, place: FrameworkCall, values: list[FlowValue], owners: list[Owner]
    ) -> Iterator[ParameterUse]:
        """The parameters of a use. place: where they are asked for; values: their names."""
        if not owners:
            return
        given = self.calls.find_argument(use, use.row.default) if use.row.default else None
        default = unparse(given if place is use else self._find_passed(given, use.fn, place.call))
        kind = "declared" if use.row.declares else "read"
        nodes = {node.id if node else "": None for node in (_get_node(owner) for owner in owners)}
        names = [value.text for value in values if value.text] or [self._spell_parameter_in_part(use)]
        for name in filter(None, names):
            for node in nodes:
                yield ParameterUse(node, name, kind, *_get_place(place), default)

    @staticmethod
    def _find_passed(value: FlowExpr | None, fn: Fn, call: FlowCall) -> FlowExpr | None:
        """What a call of a function gives for a value in it, where that is one of its parameters, as such or within an
        object; else the value."""
        held = value is not None and value.kind in ("make", "call") and len(value.parts) == 1
        inner = value.parts[0] if value is not None and held else value
        found = find_parameter(fn, inner.text) if inner is not None and inner.kind == "name" else None
        return find_argument(call.arguments, found[0], found[1].name) if found is not None else value

    @cache_method
    def _spell_parameter_in_part(self, use: FrameworkCall) -> str:
        """The name of a parameter with brackets for what is not known of it; empty where none of it is known."""
        written = self.calls.find_argument(use, use.row.topic)
        if written is None or written.kind != "join" or written.text not in ("", "+"):
            return ""
        known = [self.values.evaluate(part, use.fn, use.call.line) for part in written.parts]
        pieces = [found[0].text if len(found) == 1 else None for found in known]
        if not any(piece and _WORD.search(piece) for piece in pieces):
            return ""
        rows = zip(written.parts, pieces, strict=True)
        return "".join(_spell_open(part) if piece is None else piece for part, piece in rows)


class _Owners:
    """Who runs a piece of code, among programs that run. launched: by a launch; what it does not start is left out."""

    def __init__(self, join: Join, running: list[Running], launched: bool):
        self.join, self.running, self.launched = join, running, launched
        self._libraries: dict[str, Node] = {}
        self._used: set[str] = set()
        self._by_function = group_pairs((number, one) for one in running for number in one.functions)

    def list_owners(self, use: FrameworkCall, through: Sequence[FrameworkCall] = ()) -> list[Owner]:
        """Who runs a use: nodes that reach it; where no program is seen to, those that are built from its file, else
        its library, or none. through: as for Join.runs()."""
        found = self._by_function.get(use.fn, [])
        if found or (self.launched and use.fn in self.join.reached):
            return [one for one in found if self.join.runs(one, use, through)]
        here = (one for one in self.running if use.fn.source.path in one.program.files)
        built = [one for one in here if self.join.runs(one, use, through)]
        if built or self.launched:
            return [*built]
        node = self.join.find_library(use.fn)
        return [self._libraries.setdefault(node.id, node) if node is not None else None]

    def use(self, owner: Owner) -> None:
        """Notes that an owner has an entry in the graph."""
        node = _get_node(owner)
        if node is not None:
            self._used.add(node.id)

    def list_nodes(self) -> tuple[Node, ...]:
        """Those that have an entry, and all that a launch starts; sorted. Of those of one name the first."""
        running = (one.node for one in self.running if self.launched or one.node.id in self._used)
        libraries = (node for node in self._libraries.values() if node.id in self._used)
        found = {node.id: node for node in reversed([*running, *libraries])}
        return tuple(node for _, node in sorted(found.items()))


class _Count:
    """Calls of the frameworks, counted."""

    def __init__(self, unresolved: list[Unresolved]):
        self.calls = self.resolved = self.by_default = self.in_part = 0
        self.unresolved = unresolved

    def call(self, lost: Unresolved | None, sites: Iterable[Site]) -> None:
        """Counts a call. lost: what of it is not resolved, None for nothing."""
        self.calls += 1
        if lost is not None:
            self.unresolved.append(lost)
            self.in_part += has_known_segment(lost.pattern)
        else:
            self.resolved += 1
            self.by_default += all(value.how == "default" for site in sites for value in site.names)


def _describe_loading(value: FlowValue, owner: Owner) -> str:
    """On what a name depends that a plugin gives in a node which it makes itself: in the program that loads it, that is
    in the namespace of all nodes."""
    if not isinstance(owner, Running) or owner.program.kind != "plugin" or owner.objects is None:
        return ""
    relative = value.text is not None and value.text[:1] != "/"
    return _LOADED if relative and owner.node.name and "namespace" not in owner.fixed else ""


def _note_loaded(node: Node, parts: Iterable[Running]) -> Node:
    """A node with the plugins that it loads."""
    loads = tuple(sorted({f"{part.program.package}/{part.program.plugin}" for part in parts}))
    return structs.replace(node, loads=loads) if loads else node


def _strip_given(start: Started) -> Started:
    """A start without what it gives to the node."""
    return start._replace(name=EMPTY, namespace=EMPTY, remaps=(), settings=())


def _keep_fixed(
    start: Started, fixed: frozenset[str], namespace: str, around: LaunchText
) -> tuple[Started, str]:  # fmt: skip
    """A start without what the options of the node give it all the same, and its namespace in the code. around: the
    namespace that the launch gives the program."""
    if "all" in fixed:
        start = _strip_given(start)
    if "name" in fixed:
        start = start._replace(name=EMPTY)
    if "namespace" in fixed:
        start = start._replace(namespace=EMPTY)
    if "below" in fixed:
        above = around.value if around.value is not None else make_open_part(around.shown)
        namespace = join_name("/" + above.strip("/"), namespace.lstrip("/"))
    return start, namespace


def _find_container_name(start: Started) -> str:
    """The full name of what other nodes may be loaded into; empty for others, and where it is not known."""
    name, space = start.name.value, start.namespace.value
    if start.plugin is not EMPTY or start.kind == "process" or not name or space is None:
        return ""
    return join_name("/" + space.lstrip("/"), name)


def _give_container(start: Started, containers: Mapping[str, Started]) -> Started:
    """The start of a component as if it was given what its container is given, as any node in the process of that is.
    containers: by their full names; of one that is started elsewhere nothing but its name is known."""
    full = start.container.value
    around = containers.get(full) if full else None
    if around is not None:
        return start._replace(
            name=around.name, namespace=around.namespace, remaps=around.remaps, settings=around.settings
        )
    own = start._replace(remaps=(), settings=())
    if full is None:
        return own._replace(name=make_unknown("container"), namespace=make_unknown("namespace"))
    space, _, name = full.rpartition("/")
    return own._replace(name=wrap(name), namespace=wrap(space))


def _select_types(site: Site, owner: Owner) -> tuple[str, ...]:
    """The types that a site has for whoever runs it: several where a template is used with several. Which of several
    names has which of them is not known."""
    if site.type or not site.types:
        return (site.type,)
    here = site.types
    if isinstance(owner, Running):
        here = [one for one in here if one.cls in owner.classes or one.fn in owner.functions]
    found = tuple(dict.fromkeys(one.type for one in here)) or ("",)
    return found if len(found) == 1 or len(site.names) < 2 else ("",)


def _make_code_name(site: Site, text: str) -> str:
    """The name that an endpoint's code gives to ROS: private where its node handle is."""
    if text.startswith("~") and not text.startswith("~/") and len(text) > 1:
        return f"~/{text[1:]}"
    if not site.prefix or not text or text[0] in "/~{":
        return text
    return f"~/{text}" if site.prefix == "~" else f"{site.prefix.rstrip('/')}/{text}"


def _join_conditions(*conditions: str) -> str:
    """Conditions that all have to hold, empty ones left out."""
    return " && ".join(dict.fromkeys(filter(None, conditions)))


def _spell_open(name: FlowExpr) -> str:
    """The name that an expression gives a node, with brackets for what is not known."""
    parts = name.parts if name.kind == "join" else (name,)
    return "".join(part.text if part.kind == "text" else make_open_part(f"<{unparse(part)}>") for part in parts)


def _get_node(owner: Owner) -> Node | None:
    return owner.node if isinstance(owner, Running) else owner


def _get_place(use: FrameworkCall) -> tuple[str, int]:
    return use.fn.source.path, use.call.line


def _make_callback(found: tuple[Fn, ...]) -> Callback | None:
    return Callback(found[0].name, found[0].source.path, found[0].facts.line) if found else None


def _convert_to_snake(name: str) -> str:
    from ...targets.surface.fields import make_snake_case

    return make_snake_case(name)


def _make_nobody(source: CodeFile) -> Fn:
    from ...facts.flow import FlowFunction

    return Fn(source, FlowFunction("", "", (), 0, 0))
