"""Part of a message-flow graph: near a node or topic, of a package, without what every node has."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

from msgspec import structs

from ....edges.console import UserError
from ....edges.groups import group_pairs
from .graph import Endpoint, Graph, Node
from .outside import drop_known

HIDDEN = (
    "/rosout", "/rosout_agg", "/parameter_events", "/clock", "/diagnostics", "*/get_loggers", "*/set_logger_level",
    "*/parameter_descriptions", "*/parameter_updates", "*/set_parameters", "/tf", "/tf_static",
)  # fmt: skip
"""Names that most nodes have, and that tell little in a drawing."""


class Selection(NamedTuple):
    """Part of a graph. hidden: how many topics, services and actions were left out of it as HIDDEN; asked: whether
    something was asked for, so that it need not be the whole."""

    graph: Graph
    hidden: int
    asked: bool = False


class NothingSelected(UserError, ValueError):
    """No node or name fits; the text says which, and names like it."""


def is_standard(name: str) -> bool:
    """Whether most nodes have a topic or service of this name, see HIDDEN."""
    return _fits(name, HIDDEN, ("",))


def select_graph(
    graph: Graph, *, nodes: Sequence[str] = (), topics: Sequence[str] = (), packages: Sequence[str] = (),
    around: str = "", hops: int = 2, everything: bool = False,
) -> Selection:  # fmt: skip
    """Part of a graph: what fits all that is asked for.

    nodes, topics: names, `*` for any text, the leading slash may be left out. around: a node, topic, service or action;
    hops: how many steps from node to node. everything: keep HIDDEN names. Raises NothingSelected.
    """
    names = {endpoint.topic for endpoint in graph.endpoints} | {publish.topic for publish in graph.publishes}
    asked = bool(nodes or topics or packages or around)
    kept_nodes = _select_nodes(graph, nodes, packages)
    kept_names = set(names)
    if topics:
        fitting = {name for name in names if name and _fits(name, topics, ("", "/"))}
        if not fitting:
            raise NothingSelected(_explain("topic, service or action", topics, names))
        kept_names &= fitting
        kept_nodes &= _select_users(graph, fitting)
    if around:
        near_nodes, near_names = _find_near(graph, around, hops)
        kept_nodes &= near_nodes
        kept_names &= near_names
    if asked and not topics and not around:
        # Whom a node talks to belongs to it.
        kept_names = {e.topic for e in graph.endpoints if e.node in kept_nodes and e.topic}
        if nodes:
            kept_nodes = kept_nodes | _select_users(graph, {n for n in kept_names if not is_standard(n)})
    if not kept_nodes and asked:
        raise NothingSelected(_explain("node", (*nodes, *packages), [node.id for node in graph.nodes]))
    hidden = set() if everything or topics else {name for name in kept_names if is_standard(name)}
    if around:
        hidden -= {name for name in hidden if _fits(name, (around,), ("", "/"))}
    kept_names -= hidden
    if not asked:
        kept_nodes |= {""}
        kept_names |= {""}
    part = extract_part(graph, kept_nodes, kept_names)
    # Of these it is not known what they talk about.
    return Selection(structs.replace(part, outside=()) if asked else drop_known(part), len(hidden), asked)


def select_whole_nodes(graph: Graph, *, nodes: Sequence[str] = (), packages: Sequence[str] = ()) -> Graph:
    """The nodes of a graph that fit what is asked for, as for select_graph(), each with all that it has. Raises
    NothingSelected."""
    names = {each.topic for each in (*graph.endpoints, *graph.publishes)}
    return extract_part(graph, _select_nodes(graph, nodes, packages), names)


def _select_nodes(graph: Graph, nodes: Sequence[str], packages: Sequence[str]) -> set[str]:
    """The ids of the nodes that have a name and a package that is asked for. Raises NothingSelected."""
    kept = {node.id for node in graph.nodes}
    if packages:
        kept &= {node.id for node in graph.nodes if _fits(node.package, packages, ("",))}
        if not kept:
            raise NothingSelected(_explain("package with nodes", packages, [node.package for node in graph.nodes]))
    if nodes:
        named = _select_named(graph.nodes, nodes)
        if not named:
            raise NothingSelected(_explain("node", nodes, _list_names(graph.nodes)))
        kept &= named
    return kept


def check_names(
    graphs: Sequence[Graph], *, nodes: Sequence[str], topics: Sequence[str], packages: Sequence[str],
    known: Collection[str],
) -> None:  # fmt: skip
    """Raises NothingSelected where what is asked for, as for select_graph(), is in none of the graphs, or is no package
    of those known."""
    every = [node for graph in graphs for node in graph.nodes]
    names = {each.topic for graph in graphs for each in (*graph.endpoints, *graph.publishes)}
    if packages and not any(_fits(name, packages, ("",)) for name in known):
        raise NothingSelected(_explain("package", packages, known))
    if topics and not any(name and _fits(name, topics, ("", "/")) for name in names):
        raise NothingSelected(_explain("topic, service or action", topics, names))
    if nodes and not _select_named(every, nodes):
        raise NothingSelected(_explain("node", nodes, _list_names(every)))


def extract_part(graph: Graph, nodes: Collection[str], names: Collection[str]) -> Graph:
    """What a graph has of some nodes, by their ids, and of some names."""
    return structs.replace(
        graph,
        nodes=tuple(node for node in graph.nodes if node.id in nodes),
        endpoints=tuple(e for e in graph.endpoints if e.node in nodes and e.topic in names),
        publishes=tuple(p for p in graph.publishes if p.node in nodes and p.topic in names),
        timers=tuple(t for t in graph.timers if t.node in nodes),
        parameters=tuple(p for p in graph.parameters if p.node in nodes),
    )


def _fits(name: str, patterns: Collection[str], prefixes: Sequence[str]) -> bool:
    return any(fnmatchcase(name, prefix + pattern) for pattern in patterns for prefix in prefixes)


def _get_names(node: Node) -> tuple[str, ...]:
    return (node.id, node.name, node.name.lstrip("/"), node.name.rpartition("/")[2], node.executable, node.plugin)


def _list_names(nodes: Iterable[Node]) -> list[str]:
    return [name for node in nodes for name in _get_names(node)]


def _select_named(nodes: Iterable[Node], patterns: Sequence[str]) -> set[str]:
    """The ids of nodes of which a name fits."""
    return {node.id for node in nodes if any(name and _fits(name, patterns, ("",)) for name in _get_names(node))}


def _select_users(graph: Graph, names: Collection[str]) -> set[str]:
    return {endpoint.node for endpoint in graph.endpoints if endpoint.topic in names}


def _find_near(graph: Graph, around: str, hops: int) -> tuple[set[str], set[str]]:
    """Nodes and names within some steps of a node or a name."""
    begun = _select_named(graph.nodes, (around,))
    names = {e.topic for e in graph.endpoints if e.topic and _fits(e.topic, (around,), ("", "/"))}
    if not begun and not names:
        known = [node.id for node in graph.nodes] + [e.topic for e in graph.endpoints]
        raise NothingSelected(_explain("node or topic", (around,), known))
    reached = begun | _select_users(graph, names)
    of_node: dict[str, set[str]] = {}
    of_name: dict[str, set[str]] = {}
    for endpoint in graph.endpoints:
        if endpoint.topic and not is_standard(endpoint.topic):
            of_node.setdefault(endpoint.node, set()).add(endpoint.topic)
            of_name.setdefault(endpoint.topic, set()).add(endpoint.node)
    edge = reached
    for _ in range(hops):
        through = {name for node in edge for name in of_node.get(node, ())}
        edge = {node for name in through for node in of_name[name]} - reached
        names |= through
        reached = reached | edge
    return reached, names


def _explain(what: str, asked: Sequence[str], known: Collection[str]) -> str:
    from difflib import get_close_matches

    wanted = ", ".join(asked)
    close = get_close_matches(wanted.lstrip("/"), sorted({name.lstrip("/") for name in known if name}), 3, 0.5)
    near = f"; there is {', '.join(f'`{name}`' for name in close)}" if close else ""
    return f"`{wanted}`: no {what} of this name{near}"


def group_endpoints(graph: Graph) -> dict[tuple[str, str], list[Endpoint]]:
    """Endpoints by kind (`topic`, `service`, `action`) and name, sorted; those without a name are left out."""
    found = group_pairs(((get_kind(one), one.topic), one) for one in graph.endpoints if one.topic)
    return dict(sorted(found.items()))


def get_kind(endpoint: Endpoint) -> str:
    """`topic`, `service` or `action`."""
    role = endpoint.role
    return "action" if role.startswith("action") else "topic" if role in ("publisher", "subscriber") else "service"
