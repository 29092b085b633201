"""The fields of every topic of a workspace: the graph joined with what callbacks read and publishers set."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Sequence
from functools import cached_property

import msgspec

from ....edges.groups import group_pairs
from ....edges.memory import cache_in_derived
from ...facts.extract import ExtractedFacts, extract_all
from ...facts.field_uses import FieldFile
from ...facts.store import Store, recall
from ..flow.code import Fn, Variable, get_tail
from ..flow.definitions import describe_interfaces
from ..flow.endpoints import Site, Statement
from ..flow.file_selection import get_facts
from ..flow.graph import LOST_INCLUDE, Endpoint, Graph, Publish, Unresolved
from ..flow.join import Join
from ..flow.workspace import get_flow, list_code
from ..workspace import Workspace
from .places import Uses
from .reading import Escape, FieldReader, Holder, ReadAt, Reading, select_parameters
from .report import EscapedField, FieldAt, FieldReport, PublisherFields, SubscriberFields, TopicFields
from .shapes import Path, Shapes, show
from .writing import Writing, find_writes

_KINDS = {"cpp": "fields_cpp", "python": "fields_python"}
# Functions of roscpp, rospy and rclcpp that subscribe for a moment.
_WAITS = frozenset(("waitForMessage", "wait_for_message"))
_UNSURE = frozenset(("unresolved", "partly"))


def report_fields(workspace: Workspace, graph: Graph, store: Store | None, jobs: int | None = None) -> FieldReport:
    """The fields of all topics of a workspace. graph: of its code, or of what launch files start. store: remembers the
    report by the content that it was made from."""
    flow = get_flow(workspace)
    key = flow.key + _make_graph_key(graph, list_foreign(workspace))

    def make() -> FieldReport:
        return TopicReader(workspace, flow.code, graph, extract_uses(workspace, jobs)).report()

    return recall(store, "fields", key, FieldReport, make)


@cache_in_derived
def list_topic_fields(workspace: Workspace) -> tuple[TopicFields, ...]:
    """The fields of all topics of a workspace as launch files start it, which is worked out once."""
    return report_fields(workspace, get_flow(workspace).system, workspace.extraction.store, 1).topics


def list_unset_fields(workspace: Workspace, topic: TopicFields) -> Iterator[tuple[str, FieldAt]]:
    """The fields that a subscriber of a topic reads and no publisher sets, each with the place that reads it; nothing
    where somebody else may set them."""
    flow = get_flow(workspace)
    ends = [one for one in flow.system.endpoints if one.role == "publisher"]
    own = [one for one in ends if one.topic == topic.topic]
    unsure = any(one.how in _UNSURE or one.implied for one in own) or any(
        one.type in (topic.type, "") and one.how in _UNSURE and _may_be(one.topic, topic.topic) for one in ends
    )
    lost = any(one.what.startswith(("publisher", "publish")) for one in flow.system.coverage.unresolved)
    lost = lost or bool(list_foreign(workspace))
    if not topic.publishers or unsure or lost or any(one.unknown for one in topic.publishers):
        return
    stated = {(one.path, one.line) for one in topic.publishers}
    if len(stated) < len({(one.path, one.line) for one in own}):
        return  # a publisher whose statements are not known
    done = [each.field for one in topic.publishers for each in one.sets]
    for read in sorted({each for one in topic.subscribers for each in one.reads}, key=_get_place):
        above = any(read.field == field or read.field.startswith((f"{field}.", f"{field}[]")) for field in done)
        below = any(field.startswith((f"{read.field}.", f"{read.field}[]")) for field in done)
        if not above and not below and read.field.rpartition(".")[2] != "seq":
            done.append(read.field)
            yield read.field, read


@cache_in_derived
def list_foreign(workspace: Workspace) -> tuple[Unresolved, ...]:
    """What launch files start or include whose code is not here, and which may publish and subscribe to anything."""
    flow = get_flow(workspace)
    graphs = [graph for one in flow.launches for graph in (one.graph, one.possible) if graph is not None]
    rows = (row for graph in (flow.system, *graphs) for row in graph.coverage.unresolved)
    return tuple(dict.fromkeys(row for row in rows if row.what.startswith(("started ", LOST_INCLUDE))))


def _get_place(one: FieldAt) -> tuple[str, int, str]:
    return one.path, one.line, one.field


def _make_graph_key(graph: Graph, foreign: tuple[Unresolved, ...]) -> bytes:
    return hashlib.sha1(msgspec.msgpack.encode((graph.endpoints, graph.publishes, graph.nodes, foreign))).digest()


def extract_uses(workspace: Workspace, jobs: int | None = None) -> dict[str, FieldFile]:
    """The field facts of a workspace's code, by path."""
    main, second = workspace.extraction, get_facts(workspace)
    kinds: dict[str, str] = {}
    for path in list_code(workspace):
        facts = second.get_facts(path).facts
        if facts is not None:
            kinds[path] = _KINDS[facts.language]
    found: ExtractedFacts = extract_all(main.tree, main.store, jobs=jobs, kind_of=kinds.get)
    found.preload(kinds)
    files = {path: found.get_facts(path).facts for path in kinds if path in found.kinds}
    return {path: file for path, file in files.items() if file is not None}


class TopicReader:
    """Reads the topics of a graph. files: field facts by path."""

    def __init__(self, workspace: Workspace, join: Join, graph: Graph, files: dict[str, FieldFile]):
        self.join, self.graph, self.foreign = join, graph, list_foreign(workspace)
        types = {one.type for one in graph.endpoints if "/" in one.type}
        shapes = Shapes(describe_interfaces(workspace, sorted(("topic", type_) for type_ in types)))
        self.shapes = shapes
        self.reader = FieldReader(join.code, Uses(join.code, files), shapes)
        self._readings: dict[tuple[tuple[str, ...], str, tuple[int, int] | None], Reading] = {}
        for one in graph.endpoints:
            for fn in self.list_callbacks(one) if one.role == "subscriber" and one.type else ():
                names = select_parameters(fn, one.type, join.code)
                self.reader.uses.messages.update(Variable("local", fn.place, name) for name in names)

    def report(self) -> FieldReport:
        """All topics that the code itself sends or reads, sorted by name."""
        subscribers, publishers = self._group("subscriber"), self._group("publisher")
        found: list[TopicFields] = []
        unknown: list[tuple[str, str]] = []
        for topic, type_ in sorted({*subscribers, *publishers}):
            key = topic, type_
            if all(one.implied for one in (*subscribers.get(key, ()), *publishers.get(key, ()))):
                continue
            if not self.shapes.is_known(type_):
                unknown.append(key)
                continue
            found.append(self._make_topic(topic, type_, subscribers.get(key, []), publishers.get(key, [])))
        return FieldReport(tuple(found), tuple(unknown), tuple(self._list_unnamed()))

    def _list_unnamed(self) -> Iterator[TopicFields]:
        """What subscribers read whose topic is not known, by type."""
        ends = [one for one in self.graph.endpoints if one.role == "subscriber" and not one.topic and not one.implied]
        for type_, rows in sorted(group_pairs((one.type, one) for one in ends if "/" in one.type).items()):
            if self.shapes.is_known(type_):
                leaves = self.shapes.list_leaves(type_)
                read = tuple(self._make_subscriber(one, type_, leaves) for one in rows)
                yield TopicFields("", type_, tuple(map(show, leaves)), read, (), (), ("its name is not known",))

    def _group(self, role: str) -> dict[tuple[str, str], list[Endpoint]]:
        rows = (one for one in self.graph.endpoints if one.role == role and one.topic and "/" in one.type)
        return group_pairs(((one.topic, one.type), one) for one in rows)

    def _make_topic(
        self, topic: str, type_: str, subscribers: Sequence[Endpoint], publishers: Sequence[Endpoint]
    ) -> TopicFields:
        leaves = self.shapes.list_leaves(type_)
        rows = [self._make_subscriber(one, type_, leaves) for one in subscribers]
        sent = [self._make_publisher(one, type_) for one in self._publishes.get((topic, type_), ())]
        why = tuple(dict.fromkeys(self._list_open(topic, type_, rows)))
        unread: tuple[str, ...] = ()
        if not why and rows:
            unread = tuple(leaf for leaf in map(show, leaves) if all(leaf in one.unread for one in rows))
        return TopicFields(topic, type_, tuple(map(show, leaves)), tuple(rows), tuple(sent), unread, why)

    def _list_open(self, topic: str, type_: str, rows: Sequence[SubscriberFields]) -> Iterator[str]:
        """Why somebody who is not seen may read a topic."""
        if not rows:
            yield "nobody here subscribes to it, so somebody elsewhere may"
        for one in self.graph.endpoints:
            if one.role != "subscriber" or one.type not in (type_, "", "*"):
                continue
            if one.type == "*" and one.topic in (topic, ""):
                yield f"{one.path}:{one.line} subscribes to any type"
            elif one.how in _UNSURE and one.topic != topic and _may_be(one.topic, topic):
                yield f"the name that {one.path}:{one.line} subscribes to is not certain"
        for place, named in self._waits:
            if not named or get_tail(type_.replace("/", ".")) in named:
                yield f"{place} waits for a message, which is not followed"
        for lost in self.graph.coverage.unresolved:
            if lost.what in ("subscriber name", "subscriber topic", "subscriber type"):
                yield f"the name or type that {lost.path}:{lost.line} subscribes to is not known"
        own = (one for one in self.graph.coverage.unresolved if one.what.startswith(("started ", LOST_INCLUDE)))
        for lost in dict.fromkeys((*own, *self.foreign)):
            if lost.what.startswith("started "):
                yield f"{lost.path}:{lost.line} starts `{lost.written or 'a node'}`, whose code is not here"
            else:
                yield f"{lost.path}:{lost.line} includes `{lost.written or 'a launch file'}`, which is not here"

    @cached_property
    def _waits(self) -> list[tuple[str, frozenset[str]]]:
        """Where the code waits for a single message, with the last names of types that the call names; none where it
        names none."""
        found: list[tuple[str, frozenset[str]]] = []
        for fn, call in self.join.code.list_calls_named(_WAITS):
            given = [one for one in call.arguments if one.kind == "name"]
            words = {get_tail(one.text) for one in given}
            words |= {get_tail(self.join.code.resolve_type(one, fn).name) for one in given}
            words |= {get_tail(part) for part in re.findall(r"[\w:]+", call.types)}
            found.append((f"{fn.source.path}:{call.line}", frozenset(word for word in words if word[:1].isupper())))
        return found

    @cached_property
    def sites(self) -> dict[tuple[str, int], list[Site]]:
        """Where the code makes endpoints, by path and line."""
        return group_pairs(
            ((site.use.fn.source.path, site.use.call.line), site) for site in self.join.sites.endpoints
        )

    def list_callbacks(self, endpoint: Endpoint) -> list[Fn]:
        """The bodies that a subscriber calls."""
        sites = self.sites.get((endpoint.path, endpoint.line), ())
        found = [fn for site in sites if site.role == endpoint.role for fn in site.callbacks]
        return list(dict.fromkeys(found))

    def _make_subscriber(self, endpoint: Endpoint, type_: str, leaves: Sequence[Path]) -> SubscriberFields:
        callbacks = self.list_callbacks(endpoint)
        reading = self.read(callbacks, endpoint, type_)
        escaped = [escape.field for escape in reading.escapes]
        read = reading.reads
        # As many elements have to be sent; where some of what is in them is read, the rest need not be.
        used = [*read, *escaped]
        escaped += [size for size in reading.sizes if not any(each[: len(size)] == size for each in used)]
        unread = [
            leaf
            for leaf in leaves
            if leaf not in read and not any(leaf[: len(path)] == path for path in escaped)
        ]
        name = callbacks[0].name if callbacks else ""
        return SubscriberFields(
            endpoint.node, endpoint.path, endpoint.line, name, _list_places(reading.reads), tuple(map(show, unread)),
            tuple(EscapedField(show(one.field), one.why, one.path, one.line) for one in reading.escapes),
            _list_places(reading.sizes),
        )  # fmt: skip

    def read(self, callbacks: Sequence[Fn], endpoint: Endpoint, type_: str) -> Reading:
        """What callbacks read of a message `package/Name`. endpoint: the subscriber that calls them."""
        if not callbacks:
            why = endpoint.reason or ("the framework reads it" if endpoint.implied else "its callback is not known")
            return Reading({}, {}, (Escape((), why, endpoint.path, endpoint.line),))
        position = self._find_position(endpoint)
        key = tuple(fn.place for fn in callbacks), type_, position
        known = self._readings.get(key)
        if known is None:
            known = self._readings[key] = self._merge(
                [self._read_callback(fn, type_, position) for fn in callbacks]
            )
        return known._replace(escapes=(*known.escapes, *self._list_filtered(endpoint, type_)))

    def _list_filtered(self, endpoint: Endpoint, type_: str) -> Iterator[Escape]:
        """What filters look at before they call back: messages are matched by their stamps, and transforms waited for
        by stamp and frame.

        Source: the headers of message_filters (message_traits::TimeStamp), of tf2_ros (message_filter.h), and of
        image_transport (camera_subscriber.cpp, which has a TimeSynchronizer)."""
        rows = [one.use.row for one in self.sites.get((endpoint.path, endpoint.line), ()) if one.role == endpoint.role]
        filtered = any(row.framework == "message_filters" for row in rows)
        if not filtered and not any(row.camera_info for row in rows):
            return
        for name in ("stamp", "frame_id") if filtered and self._waits_for_transforms else ("stamp",):
            field = ("header", name)
            if self.shapes.list_below(type_, field):
                yield Escape(field, "a message filter looks at it", endpoint.path, endpoint.line)

    @cached_property
    def _waits_for_transforms(self) -> bool:
        """Whether code includes the filters that wait for transforms."""
        return any(
            header.endswith(("/message_filter.h", "/message_filter.hpp"))
            for source in self.join.code.sources
            for header in source.facts.includes
        )

    def _find_position(self, endpoint: Endpoint) -> tuple[int, int] | None:
        """Which of the messages that a synchronizer gives to its callbacks is a subscriber's, and of how many."""
        rows = [one for one in self.sites.get((endpoint.path, endpoint.line), ()) if one.role == endpoint.role]
        filtered = len(rows) == 1 and rows[0].use.row.framework == "message_filters"
        return self.join.sites.find_position(rows[0]) if filtered else None

    def _read_callback(self, fn: Fn, type_: str, position: tuple[int, int] | None = None) -> Reading:
        names = select_parameters(fn, type_, self.join.code)
        given = [one.name for one in fn.facts.parameters]
        if position is not None and position[1] == len(given) and given[position[0]] in names:
            names = [given[position[0]]]
        if names:
            return self.reader.read_parameter(fn, names, type_)
        if not fn.facts.parameters or all(not one.name for one in fn.facts.parameters):
            return Reading({}, {}, ())
        why = "none of the callback's parameters is seen to be it"
        return Reading({}, {}, (Escape((), why, fn.source.path, fn.facts.line),))

    def _merge(self, readings: Sequence[Reading]) -> Reading:
        if len(readings) == 1:
            return readings[0]
        reads = {path: place for one in reversed(readings) for path, place in one.reads.items()}
        sizes = {path: place for one in reversed(readings) for path, place in one.sizes.items()}
        escapes = tuple(dict.fromkeys(escape for one in readings for escape in one.escapes))
        holders = frozenset[Holder]().union(*(one.holders for one in readings))
        named = frozenset[Path]().union(*(one.named for one in readings))
        typed = {path: place for one in reversed(readings) for path, place in one.typed.items()}
        return Reading(reads, sizes, escapes, holders, named, typed)

    # Publishers

    @cached_property
    def _publishes(self) -> dict[tuple[str, str], list[Publish]]:
        return group_pairs(((one.topic, one.type), one) for one in self.graph.publishes if one.topic)

    @cached_property
    def _statements(self) -> dict[tuple[str, int], Statement]:
        return {(one.use.fn.source.path, one.use.call.line): one for one in self.join.sites.statements}

    def _make_publisher(self, publish: Publish, type_: str) -> PublisherFields:
        statement = self._statements.get((publish.path, publish.line))
        writing = Writing({}, "its statement is not known", {})
        if statement is not None and not publish.through:
            use = statement.use
            arguments = use.call.arguments
            writing = find_writes(self.reader, arguments[0] if arguments else None, use.fn, use.call.line, type_)
        lengths = tuple((show(path), length) for path, length in sorted(writing.lengths.items()))
        sets = _list_places(writing.sets)
        return PublisherFields(publish.node, publish.path, publish.line, sets, writing.unknown, lengths)


def _list_places(found: dict[Path, ReadAt]) -> tuple[FieldAt, ...]:
    return tuple(FieldAt(show(path), place.path, place.line) for path, place in sorted(found.items()))


def _may_be(pattern: str, topic: str) -> bool:
    """Whether a name that is known in part, with brackets for what is not, may be a topic."""
    if not pattern:
        return True
    pieces = re.split(r"<[^<>]*>", pattern)
    return re.fullmatch(".*".join(map(re.escape, pieces)), topic) is not None


