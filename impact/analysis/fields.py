"""Which fields of the topics of a workspace are read and set: from a path to a report."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ..facts.interface import Section, extract
from ..facts.store import Store
from ..model.fields.report import FieldReport, TopicFields
from ..model.fields.topics import report_fields
from ..model.flow.graph import Graph
from ..model.flow.workspace import link_for_flow, make_graph
from ..model.wire import Encoding, LayoutError, WireField, build_layout, compute_size
from ..model.workspace import Workspace
from ..tree import Tree
from .message_files import ReleasedMessages
from .session import CheckError, load_settings, open_tree


class TopicSize(NamedTuple):
    """Bytes of a message on the wire, and of the fields in it that nobody reads."""

    full: int
    unread: int


class FieldAnswer(NamedTuple):
    """The report, and the sizes of messages by topic and type, of those whose definitions are known."""

    report: FieldReport
    sizes: dict[tuple[str, str], TopicSize]


class OpenedFields(NamedTuple):
    """A workspace whose topics are asked for their fields. asked: topics, or patterns of them, that the user named as
    closed; closed: these and those of rosimpact.toml, to which nobody else subscribes."""

    workspace: Workspace
    tree: Tree
    store: Store
    graph: Graph
    asked: tuple[str, ...]
    closed: tuple[str, ...]

    def close_topics(self, found: FieldReport, topics: Sequence[str]) -> FieldReport:
        """A report with those topics closed that nobody else subscribes to. topics: that are asked for by name. Raises
        CheckError where a name that the user gave is that of no topic."""
        names = {one.topic for one in found.topics} | {topic for topic, _ in found.unknown}
        for option, given in (("--topic", topics), ("--assume-closed", self.asked)):
            for name in given:
                if name not in names and (option == "--topic" or not select_topics([name], names)):
                    near = _find_near(name, names)
                    raise CheckError(f"{option} {name}: no such topic; {near or '`rosimpact fields` lists all'}")
        closed = self.select_closed(found)
        rows = tuple(_close(one) if one.topic in closed else one for one in found.topics)
        return FieldReport(rows, found.unknown, found.unnamed)

    def select_closed(self, found: FieldReport) -> frozenset[str]:
        """The topics of a report to which nobody else subscribes."""
        names = [*(one.topic for one in found.topics), *(topic for topic, _ in found.unknown)]
        return select_topics(self.closed, names)


@contextlib.contextmanager
def open_fields(
    path: Path, *, closed: Sequence[str] = (), rev: str = "", config: Path | None = None, jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None, follow_links: bool = False,
) -> Iterator[OpenedFields]:  # fmt: skip
    """The workspace at a path. closed: topics, or patterns of them, that nobody else subscribes to, as the user knows,
    besides those of rosimpact.toml. The others as for check. Raises CheckError, ConfigError and TreeError with a text
    for the user."""
    tree = open_tree(path, rev, follow_links=follow_links)
    settings = load_settings(path, tree, config, follow_links=follow_links)
    with Store() as store:
        workspace = link_for_flow(tree, store, jobs, progress)
        graph = make_graph(workspace, store, jobs=jobs or 1)
        yield OpenedFields(workspace, tree, store, graph, tuple(closed), (*closed, *settings.closed_topics))


def collect_fields(
    path: Path, *, topics: Sequence[str] = (), length: int = 10, jobs: int | None = None, **given: Any
) -> FieldAnswer:
    """The fields of the topics of the workspace at a path. topics: these alone, by name. length: of strings and arrays,
    for sizes. The others as for open_fields()."""
    with open_fields(path, jobs=jobs, **given) as opened:
        found = report_fields(opened.workspace, opened.graph, opened.store, jobs)
        definitions = KnownMessages(opened.workspace, opened.tree)
    found = opened.close_topics(found, topics)
    chosen = tuple(one for one in found.topics if not topics or one.topic in topics)
    unknown = tuple(row for row in found.unknown if not topics or row[0] in topics)
    sizes = {(one.topic, one.type): size for one in chosen if (size := definitions.measure(one, length)) is not None}
    return FieldAnswer(FieldReport(chosen, unknown, () if topics else found.unnamed), sizes)


def select_topics(patterns: Iterable[str], names: Iterable[str]) -> frozenset[str]:
    """Those of the topics that a user names: in full, or as the shell would have it, `/camera/*`."""
    asked = list(patterns)
    return frozenset(name for name in names if any(fnmatchcase(name, pattern) for pattern in asked))


def read_section(data: bytes | None) -> Section | None:
    """The fields of a message by the text of its definition, None where there is none."""
    facts = extract(data, "msg") if data is not None else None
    return facts.sections[0] if facts is not None and facts.sections else None


class KnownMessages:
    """The messages of a workspace and of released packages, as text."""

    def __init__(self, workspace: Workspace, tree: Tree):
        self._workspace, self._tree = workspace, tree
        self._released = ReleasedMessages(workspace.ros)
        self._sections: dict[str, Section | None] = {}

    def find(self, type_: str) -> bytes | None:
        """The text of the message `package/Name`, None where it is not known."""
        package, _, name = type_.partition("/")
        found = self._workspace.packages.get(package)
        if found is None:
            return self._released.find(type_)
        rows = (one.path for one in found.linked.interfaces if one.name == name and one.path.endswith(".msg"))
        path = next(rows, "")
        try:
            return self._tree.read(path) if path else None
        except OSError:
            return None

    def find_section(self, type_: str) -> Section | None:
        """The fields of the message `package/Name`, None where they are not known."""
        if type_ not in self._sections:
            self._sections[type_] = read_section(self.find(type_))
        return self._sections[type_]

    def measure(self, topic: TopicFields, length: int) -> TopicSize | None:
        """The size of a topic's messages with strings and arrays of a length, None where that is not known."""
        encoding: Encoding = "ros1" if self._workspace.ros == 1 else "cdr"
        try:
            layout = build_layout(self.find_section, topic.type, encoding)
        except LayoutError:
            return None
        full = compute_size(layout, {}, encoding, length)
        return TopicSize(full, full - compute_size(_drop(layout, frozenset(topic.unread)), {}, encoding, length))


def _drop(fields: tuple[WireField, ...], unread: frozenset[str]) -> tuple[WireField, ...]:
    """A layout without some fields; an array of messages goes with its last one."""
    kept: list[WireField] = []
    for field in fields:
        members = _drop(field.members, unread)
        if field.path not in unread and (members or not field.members):
            kept.append(field._replace(members=members))
    return tuple(kept)


def _close(topic: TopicFields) -> TopicFields:
    """A topic that nobody reads who is not seen here."""
    unread = tuple(leaf for leaf in topic.fields if all(leaf in one.unread for one in topic.subscribers))
    return msgspec.structs.replace(topic, unread=unread, open=())


def _find_near(name: str, names: set[str]) -> str:
    import difflib

    near = difflib.get_close_matches(name, sorted(names), 1)
    return f"`{near[0]}` is the nearest" if near else ""
