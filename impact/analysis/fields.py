"""Which fields of the topics of a workspace are read and set: from a path to a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec

from ..facts.store import Store
from ..model.fields.report import FieldReport, TopicFields
from ..model.fields.topics import report_fields
from ..model.flow.workspace import link_for_flow, make_graph
from .session import CheckError, load_settings, open_tree


class FieldAnswer(NamedTuple):
    """The report, and how many topics there are of which it is a choice."""

    report: FieldReport
    topics: int


def collect_fields(
    path: Path, *, topics: Sequence[str] = (), closed: Sequence[str] = (), rev: str = "", config: Path | None = None,
    jobs: int | None = None, progress: Callable[[int, int], None] | None = None, follow_links: bool = False,
) -> FieldAnswer:  # fmt: skip
    """The fields of the topics of the workspace at a path. topics: these alone, by name; closed: topics that nobody
    else subscribes to, as the user knows, besides those of rosimpact.toml. The others as for check. Raises CheckError,
    ConfigError and TreeError with a text for the user."""
    tree = open_tree(path, rev, follow_links=follow_links)
    settings = load_settings(path, tree, config, follow_links=follow_links)
    with Store() as store:
        workspace = link_for_flow(tree, store, jobs, progress)
        found = report_fields(workspace, make_graph(workspace, store, jobs=jobs or 1), store, jobs)
    names = {one.topic for one in found.topics} | {topic for topic, _ in found.unknown}
    for option, asked in (("--topic", topics), ("--assume-closed", closed)):
        for name in asked:
            if name not in names:
                near = _find_near(name, names)
                raise CheckError(f"{option} {name}: no such topic; {near or 'list them without --topic'}")
    known = frozenset((*closed, *settings.closed_topics))
    chosen = [close(one) if one.topic in known else one for one in found.topics if not topics or one.topic in topics]
    unknown = tuple(row for row in found.unknown if not topics or row[0] in topics)
    return FieldAnswer(FieldReport(tuple(chosen), unknown), len(names))


def close(topic: TopicFields) -> TopicFields:
    """A topic that nobody reads who is not seen here."""
    unread = tuple(leaf for leaf in topic.fields if all(leaf in one.unread for one in topic.subscribers))
    return msgspec.structs.replace(topic, unread=unread, open=())


def _find_near(name: str, names: set[str]) -> str:
    import difflib

    near = difflib.get_close_matches(name, sorted(names), 1)
    return f"`{near[0]}` is the nearest" if near else ""
