"""What a change reaches: changed messages, topics, publish conditions, callbacks and launches, and what lies
downstream."""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from functools import cached_property, lru_cache
from itertools import product
from pathlib import Path
from typing import NamedTuple

import msgspec

from ...edges import processes
from ...edges.memory import cache_method
from ..facts.extract import ExtractedFacts
from ..facts.flow import FlowFile
from ..facts.store import Store
from ..logic.code_changes import ChangedFunction, find_changed_functions
from ..logic.history import PackageFile
from ..logic.states import find_renamed_words
from ..logic.two_states import Differing, compare_publishing, extract_flow_facts, find_differences, read_bytes
from ..model.flow.callers import Led
from ..model.flow.connections import Edge, list_edges
from ..model.flow.graph import Endpoint, Graph, Node, Publish
from ..model.flow.launch_changes import NO_CHANGES, LaunchChanges, compare_launches
from ..model.flow.launches import is_launch
from ..model.flow.reach import EVERYWHERE, DownstreamSearch, Step
from ..model.flow.select import check_names, get_kind
from ..model.flow.workspace import get_flow, link_for_flow
from ..model.workspace import Workspace
from .effects import (
    ASKS,
    KINDS,
    NOTHING,
    RECEIVING,
    DownstreamLister,
    Effect,
    Hop,
    Impact,
    Outgoing,
    group_by_name,
    list_left_alone,
    merge_effects,
)
from .launch_effects import LaunchEffects
from .message_changes import find_containing_types, list_message_changes
from .session import link_flow, load_settings, open_tree

EVENTS = frozenset(("subscriber", "service", "action", "timer", "parameter"))


@lru_cache(maxsize=2)
def compute_impact(workspace: Workspace, base: Workspace) -> Impact:
    """What the changes since the base reach, message by message, topic by topic, statement by statement."""
    reading = _Reading(workspace, base)
    return reading.build_impact() if reading.has_flow_changes() else NOTHING


def use_processes(workspaces: Iterable[Workspace], jobs: int | None) -> None:
    """Lets as many processes make the graphs of workspaces, one for each processor where jobs is None."""
    for workspace in workspaces:
        get_flow(workspace).jobs = jobs or processes.count_cores()


class _Reading:
    def __init__(self, workspace: Workspace, base: Workspace):
        self.workspace, self.base = workspace, base
        self.differing: Differing = find_differences(workspace, base)
        self.silent = 0

    def has_flow_changes(self) -> bool:
        """Whether anything differs that message flow can follow; asked before the graphs are made, which are dear."""
        found = self.differing
        if self.launches != NO_CHANGES or any(True for _ in list_message_changes(self.workspace, self.base)):
            return True
        names = {found.renamed.get(state.locate(file.path), state.locate(file.path)) for state in found.old
                 for file in state.files}  # fmt: skip
        if not found.old and not found.new:
            return False
        changed = list(found.iterate_changed_files())
        kept = {state.locate(file.path) for state in found.new for file in state.files}
        builds = any(file.kind not in ("cpp", "python") for _, _, file in changed)
        return builds or bool(names ^ kept) or bool(self.functions) or any(map(self.changes_declarations, changed))

    def changes_declarations(self, changed: tuple[str, PackageFile | None, PackageFile]) -> bool:
        """Whether a file's members, constants or exported classes differ."""
        path, before, _ = changed
        new = _find_facts(self.facts[1], path)
        old = _find_facts(self.facts[0], self.was[id(before)]) if before is not None else None
        return _list_declarations(old) != _list_declarations(new)

    @cached_property
    def launches(self) -> LaunchChanges:
        return compare_launches(self.workspace, self.base)

    @cached_property
    def now(self) -> Graph:
        return get_flow(self.workspace).system

    @cached_property
    def before(self) -> Graph:
        return get_flow(self.base).system

    @cache_method
    def get_side(self, gone: bool) -> tuple[Graph, DownstreamSearch]:
        """The graph, and what lies downstream in it; gone: that of the base."""
        graph = self.before if gone else self.now
        return graph, DownstreamSearch(graph)

    @cached_property
    def nodes(self) -> dict[str, Node]:
        """All nodes by id, those of the base and of changed launches too."""
        graphs = [graph for launch in self.launches.launches for graph in (launch.before, launch.now)]
        return {node.id: node for graph in (*graphs, self.before, self.now) for node in graph.nodes}

    @cached_property
    def packages(self) -> dict[str, str]:
        return {node.id: node.package for node in self.nodes.values()}

    @cached_property
    def named(self) -> list[dict[str, list[Endpoint]]]:
        """Endpoints of the base and now, by name."""
        return [group_by_name(self.before), group_by_name(self.now)]

    @cached_property
    def downstream(self) -> DownstreamLister:
        return DownstreamLister(self.packages)

    @cached_property
    def facts(self) -> tuple[ExtractedFacts, ExtractedFacts]:
        """The flow facts of what differs, of the base and now."""
        return extract_flow_facts(self.base, self.differing.old), extract_flow_facts(self.workspace, self.differing.new)

    @cached_property
    def was(self) -> dict[int, str]:
        """Paths at the base of its files."""
        return {id(file): state.locate(file.path) for state in self.differing.old for file in state.files}

    def build_impact(self) -> Impact:
        found = [*self.compare_messages(), *self.compare_logic()]
        found += self.compare_topics(found)
        found += self.compare_callbacks()
        found += merge_effects(self.describe_launches())
        ordered = sorted(found, key=lambda one: (KINDS.index(one.kind), one.package, one.path, one.line, one.subject))
        effects = tuple(dict.fromkeys(ordered))
        used = {id for effect in effects for id in (*effect.nodes, *(hop.node for hop in effect.reaches))}
        kept = tuple(node for id, node in sorted(self.nodes.items()) if id in used)
        return Impact(effects, kept, len(self.now.nodes), self.silent, self.now.coverage)

    def compare_messages(self) -> Iterator[Effect]:
        for change in list_message_changes(self.workspace, self.base):
            gone = change.change == "removed"
            graph, reach = self.get_side(gone)
            types = find_containing_types(self.base if gone else self.workspace, change.name)
            using = [one for one in graph.endpoints if one.type in types and one.topic and one.node]
            first = [
                self.downstream.make_hop(Step(get_kind(one), one.topic, one.node, one.path, one.line))
                for one in sorted(using, key=lambda one: one.role in ("publisher", "client", "action client"))
            ]
            out = [
                Outgoing(one.node, tuple(reach.list_sent_on(one.node, one.path, one.line, True)))
                for one in using
                if one.role in RECEIVING
            ]
            topics = tuple(sorted({one.topic for one in using}))
            reached = self.downstream.list_downstream((), out, reach, first)
            yield Effect(
                "message", change.change, change.name, change.package, change.path, change.line, (), topics,
                change.why, reached,
            )  # fmt: skip

    def compare_logic(self) -> Iterator[Effect]:
        for change in compare_publishing(self.workspace, self.base):
            gone = change.kind == "gone"
            graph, reach = self.get_side(gone)
            at = (change.path, change.line)
            here = [
                one
                for one in (*graph.publishes, *(e for e in graph.endpoints if e.role == "publisher"))
                if (one.path, one.line) == at
            ]
            nodes = tuple(sorted({one.node for one in here if one.node})) or tuple(
                node for node in change.node.split(", ") if node
            )
            topics = {name for topic in change.topics for name in self.find_started_names(topic, change.path)}
            topics = tuple(sorted({one.topic for one in here if one.topic} | topics))
            sent = tuple((topic, "publisher") for topic in topics)
            yield Effect(
                "trigger" if change.kind == "trigger changed" else "condition", change.kind,
                ", ".join(topics) or change.topic, change.package, change.path, change.line, nodes, topics, change.why,
                self.downstream.list_downstream(nodes, [Outgoing(node, sent) for node in nodes or ("",)], reach),
                tuple(one for one in list_left_alone(self.named, topics) if one.node not in nodes),
            )  # fmt: skip

    @cache_method
    def find_started_names(self, topic: str, path: str) -> set[str]:
        """What a topic that the code of a file names is called where launch files start the code."""
        found: set[str] = set()
        for workspace, graph in ((self.base, self.before), (self.workspace, self.now)):
            code = get_flow(workspace).graph
            places = {one.line for one in code.endpoints if one.topic == topic and one.path == path}
            found |= {one.topic for one in graph.endpoints if one.path == path and one.line in places and one.topic}
        return found or {topic}

    def compare_topics(self, reported: Sequence[Effect]) -> Iterator[Effect]:
        """What is new, gone or of another type or quality at either end of a topic, save what was told already."""
        places = {(effect.path, effect.line) for effect in reported}
        named = {
            (node, topic)
            for effect in reported
            if effect.kind != "message"
            for node in effect.nodes
            for topic in effect.topics
        }
        found = [edge for edge in list_edges(self.now, self.before) if edge.mark]
        renamed = self.find_renamed_nodes(found)
        if self.launches.launches:
            # What differs in the code too; the rest is the launch files' doing.
            code = list_edges(get_flow(self.workspace).graph, get_flow(self.base).graph)
            changed = {(one.role, one.path, one.line) for edge in code if edge.mark for one in edge.endpoints}
            found = [edge for edge in found if any((e.role, e.path, e.line) in changed for e in edge.endpoints)]
        for edge in found:
            why = ", ".join(clause for clause in edge.why.split(", ") if clause in ("type", "QoS"))
            endpoint = edge.endpoints[0]
            if edge.name in EVERYWHERE or all(one.implied for one in edge.endpoints) or edge.node in renamed:
                continue
            if edge.mark == "changed" and (not why or (endpoint.path, endpoint.line) in places):
                continue
            if edge.mark != "changed" and (self.may_be_unnamed(edge) or (edge.role == "publisher" and
                                                                 (edge.node, edge.name) in named)):  # fmt: skip
                continue
            yield self.make_topic_effect(edge, endpoint, why.replace("type", _describe_type(edge)))

    def make_topic_effect(self, edge: Edge, endpoint: Endpoint, why: str) -> Effect:
        gone = edge.mark == "removed"
        graph, reach = self.get_side(gone)
        first: list[Hop] = []
        if edge.role in RECEIVING:
            sent = tuple(reach.list_sent_on(edge.node, endpoint.path, endpoint.line, True))
            asking = ASKS.get(edge.role)
            first = [
                self.downstream.make_hop(Step(edge.kind, edge.name, one.node, one.path, one.line))
                for one in graph.endpoints
                if one.role == asking and one.topic == edge.name and one.node
            ]
        else:
            sent = ((edge.name, edge.role),)
        says = {"added": "a new {}", "removed": "no {} any more", "changed": f"the {{}} has another {why}"}[edge.mark]
        return Effect(
            "topic", edge.mark, edge.name, self.packages.get(edge.node, ""), endpoint.path, endpoint.line,
            (edge.node,) if edge.node else (), (edge.name,), says.format(edge.role),
            self.downstream.list_downstream((edge.node,), [Outgoing(edge.node, sent)], reach, first),
            tuple(list_left_alone(self.named, {edge.name})) if gone else (),
        )  # fmt: skip

    def describe_launches(self) -> Iterator[Effect]:
        """What launch files start otherwise."""
        for launch in self.launches.launches:
            yield from LaunchEffects(launch, self.downstream, self.find_package).describe()
        for path in (*self.launches.unused, *self.launches.without_effect):
            had, has = (any(path in one.linked.files for one in each) for each in (self.base, self.workspace))
            change = "changed" if had and has else "added" if has else "removed"
            why = "no launch file of the workspace is known to use it"
            if path in self.launches.without_effect:
                why = "what launch files are known to start is as it was"
            elif is_launch(path):
                why = "nothing is known that it starts"
            yield Effect("launch", change, path, self.find_package(path), path, 1, (), (), why)

    def find_renamed_nodes(self, found: Sequence[Edge]) -> set[str]:
        """Nodes that are merely called otherwise: all that one of them had, another one has now."""
        before, after = {node.id for node in self.before.nodes}, {node.id for node in self.now.nodes}
        has: dict[str, set[tuple[str, str]]] = {}
        for edge in found:
            if edge.node in before ^ after:
                has.setdefault(edge.node, set()).add((edge.name, edge.role))
        pairs = product((before - after) & has.keys(), after - before)
        return {node for old, new in pairs if has[old] == has.get(new) for node in (old, new)}

    def may_be_unnamed(self, edge: Edge) -> bool:
        """Whether what is new or gone may be what the other side has under a name that is not known."""
        other = self.now if edge.mark == "removed" else self.before
        lines = {(one.function, one.variable) for one in edge.endpoints}
        return any(
            one.role == edge.role and not one.topic and one.node == edge.node and (one.function, one.variable) in lines
            for one in other.endpoints
        )

    def compare_callbacks(self) -> Iterator[Effect]:
        _, reach = self.get_side(False)
        publishes: dict[tuple[str, str], list[Publish]] = {}
        for publish in self.now.publishes:
            publishes.setdefault((publish.path, publish.function), []).append(publish)
        owners: dict[tuple[str, int], set[str]] = {}
        running: dict[str, set[str]] = {}
        for one in (*self.now.endpoints, *self.now.timers, *self.now.publishes):
            if one.node:
                owners.setdefault((one.path, one.line), set()).add(one.node)
                running.setdefault(one.path, set()).add(one.node)
        reported: dict[tuple[str, str], set[str]] = {}
        for change in compare_publishing(self.workspace, self.base):
            names = (name for topic in change.topics for name in self.find_started_names(topic, change.path))
            reported.setdefault((change.path, change.function), set()).update((change.topic, *names))
        for function in self.functions:
            place = (function.path, function.name, function.line)
            led = [one for one in get_flow(self.workspace).callers.list_triggers(*place) if one.trigger.kind in EVENTS]
            if is_launch(function.path):
                continue
            if not function.known and not (led and led[0].steps == 0):
                continue  # who calls what is new is another function too
            sent: dict[str, dict[tuple[str, str], None]] = {}
            own = {node for one in led for node in owners.get((one.trigger.path, one.trigger.line), ())}
            own |= running.get(function.path, set())
            for called in get_flow(self.workspace).callers.list_called(*place):
                for publish in publishes.get((called.path, called.name), ()):
                    if publish.topic and (publish.node in own or not own):
                        sent.setdefault(publish.node, {})[publish.topic, "publisher"] = None
            for one in led:
                at = (one.trigger.path, one.trigger.line)
                # What is stored is sent on later; that something far away in the calls is stored is not supposed.
                near = one.trigger.kind == "subscriber" and one.steps <= 1
                for node in sorted(owners.get(at, ())):
                    found = reach.list_sent_on(node, *at, near)
                    sent.setdefault(node, {}).update(dict.fromkeys(found))
            topics = {topic for each in sent.values() for topic, _ in each} - EVERYWHERE
            if not topics:
                self.silent += 1
                continue
            if topics <= reported.get((function.path, function.name), set()):
                continue
            nodes = tuple(sorted(node for node, each in sent.items() if each and node))
            out = [Outgoing(node, tuple(each)) for node, each in sent.items()]
            yield Effect(
                "callback", "changed" if function.known else "added", function.name, self.find_package(function.path),
                function.path, function.line, nodes, tuple(sorted(topics)), _describe_trigger(led),
                self.downstream.list_downstream(nodes, out, reach),
            )  # fmt: skip

    @cached_property
    def functions(self) -> list[ChangedFunction]:
        """Functions of the packages whose code is another."""
        found, was = self.differing, self.was
        old, new = self.facts
        result: list[ChangedFunction] = []
        texts = {
            file.id: read_bytes(self.base, was[id(file)])
            for _, file, _ in found.iterate_changed_files()
            if file is not None
        }
        texts |= {file.id: read_bytes(self.workspace, path) for path, _, file in found.iterate_changed_files()}
        words = find_renamed_words(found.old, found.new, found.renamed, lambda file: texts.get(file.id, b""))
        for path, before, after in found.iterate_changed_files():
            facts = _find_facts(new, path)
            if facts is None:
                continue
            old_facts = _find_facts(old, was[id(before)]) if before is not None else None
            old_text, text = (
                texts[file.id].decode("utf-8", "replace") if file is not None else "" for file in (before, after)
            )
            result += find_changed_functions(path, old_facts, old_text, facts, text, words)
        return result

    def find_package(self, path: str) -> str:
        owner = [one for one in self.workspace if not one.path or path.startswith(f"{one.path}/")]
        return max(owner, key=lambda one: len(one.path)).name if owner else ""


def _describe_type(edge: Edge) -> str:
    """`type (`a/Now` instead of `a/Before`)`, as far as both are known."""
    before = edge.before.types if edge.before is not None else ()
    old, new = (" or ".join(f"`{each}`" for each in types) for types in (before, edge.types))
    return f"type ({new} instead of {old})" if old and new else "type"


def _describe_trigger(led: Sequence[Led]) -> str:
    """What makes a function run, in a clause."""
    if not led:
        return "publishes, or what it calls does"
    one = led[0]
    detail = f" `{one.trigger.detail}`" if one.trigger.detail else ""
    of = {"subscriber": "messages of", "timer": "timer"}.get(one.trigger.kind, one.trigger.kind)
    more = f", and {len(led) - 1} more" if len(led) > 1 else ""
    if one.steps == 0:
        return f"the callback of {of}{detail}{more}"
    return f"called from `{one.callback.name}`, the callback of {of}{detail}{more}"


def _find_facts(extraction: ExtractedFacts, path: str) -> FlowFile | None:
    facts = extraction.get_facts(path).facts if path in extraction.kinds else None
    return facts if isinstance(facts, FlowFile) else None


def _list_declarations(facts: FlowFile | None) -> object:
    """What a file declares, without places."""
    if facts is None:
        return None
    members = [(cls.name, cls.bases, [(m.name, m.type, m.value) for m in cls.members]) for cls in facts.classes]
    return members, [(one.name, one.type, one.value) for one in facts.constants], facts.exports, facts.aliases


def select_effects(
    impact: Impact, packages: Sequence[str] = (), topics: Sequence[str] = (), nodes: Sequence[str] = ()
) -> Impact:
    """The changes of some packages, what goes through some topics, what some nodes have or are reached by; all when
    none are given. `*` stands for any text, the leading slash may be left out."""

    def fits(name: str, patterns: Sequence[str]) -> bool:
        return any(fnmatchcase(name, prefix + pattern) for pattern in patterns for prefix in ("", "/"))

    called = {node.id: (node.id, node.name, node.executable, node.plugin) for node in impact.nodes}

    def list_node_names(effect: Effect) -> Iterator[str]:
        for id in (*effect.nodes, *(hop.node for hop in effect.reaches)):
            yield from called.get(id, (id,))

    effects = tuple(
        effect
        for effect in impact.effects
        if (not packages or fits(effect.package, packages))
        and (not topics or any(fits(name, topics) for name in (*effect.topics, *(h.name for h in effect.reaches))))
        and (not nodes or any(name and fits(name, nodes) for name in list_node_names(effect)))
    )
    return msgspec.structs.replace(impact, effects=effects)


class ImpactResult(NamedTuple):
    """What was found; what the workspace and its base are called; and what to know about the base."""

    impact: Impact
    root: str
    rev: str
    base: str
    notes: tuple[str, ...]


def analyze_impact(
    path: Path, base: Sequence[str], *, rev: str = "", jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None, follow_links: bool = False, packages: Sequence[str] = (),
    topics: Sequence[str] = (), nodes: Sequence[str] = (),
) -> ImpactResult:  # fmt: skip
    """What the changes since the base reach in the workspace at a path.

    base, rev, jobs, follow_links: as for check. progress: called with (done, total) bytes while files are
    parsed. packages, topics, nodes: as for select_effects(). Raises CheckError, TreeError and BaseError with a text for
    the user, and NothingSelected where neither the workspace nor its base has what is asked for.
    """
    from .revision_compare import open_base_tree

    tree = open_tree(path, rev, follow_links=follow_links)
    with Store() as store:
        old_tree, notes = open_base_tree(tree, tuple(base))
        now = link_flow(path, tree, store, jobs, progress)
        before = link_for_flow(old_tree, store, jobs)
        use_processes((now, before), jobs)
        systems = load_settings(path, tree, None, follow_links=follow_links).systems
        if systems:
            from .systems import choose_systems

            notes = [*notes, *choose_systems(path, systems, ((now, tree), (before, old_tree)))]
        if packages or topics or nodes:
            graphs = [get_flow(workspace).system for workspace in (now, before)]
            known = now.packages.keys() | before.packages.keys()
            check_names(graphs, nodes=nodes, topics=topics, packages=packages, known=known)
        impact = select_effects(compute_impact(now, before), packages, topics, nodes)
        return ImpactResult(impact, os.fspath(path), rev, " ".join(base), (*notes, *store.notes))
