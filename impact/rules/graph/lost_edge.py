"""lost-edge: a publisher and a subscriber that were connected at the base are no longer connected.

What it does
    Compares the message flow with the base: that of the code, and that of each launch file that starts something
    otherwise, with its namespaces, remappings and parameters. Reports topics that had a publisher and a subscriber, and
    have only one of them now: the other was removed, or uses another name; and services and actions whose server was
    removed, or whose client asks under a name that nothing serves. The place is the line of the launch or parameter
    file where that is the cause.

Why it breaks
    The subscriber's callback no longer runs, or nothing receives the messages. ROS prints no warning.

Severity
    warning when the subscriber or client is left, or when the removed side now uses another name; note when the
    subscriber was removed and the publisher is left, when a publisher has a new name that nobody reads, when the
    subscriber reads another topic that something publishes, and in launches that also start programs of other packages,
    which may be the other side.

Example
    self.create_publisher(LaserScan, "scan_front", 10)           # was: scan; the planner still reads scan

Use instead
    self.create_publisher(LaserScan, "scan", 10)

Not reported
    Topics of which both sides were removed, or got the same new name; topics that an endpoint whose name is not known
    may use; endpoints whose name was not known at the base; launches whose programs of other packages changed as well;
    clients that were removed.
"""

from collections.abc import Iterator

from ...model.flow.edges import OTHER_SIDE, Flow, list_successors
from ...model.flow.graph import Endpoint
from ...model.flow.launch_changes import LaunchChange, NodeChange, compare_launches
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Doubt, Text, Workspace, rule


@rule(
    scope="flow_change",
    severity="warning",
    preview=True,
    texts={
        "no publisher": Text(
            "nothing publishes `{subject}` any more; `{node}` did at the base",
            help="publish `{subject}`, or remove the subscriber",
        ),
        "publisher renamed": Text(
            "nothing publishes `{subject}` any more; `{node}` did at the base, and now publishes `{replacement}`",
            help="subscribe to `{replacement}`",
        ),
        "no subscriber": Text(
            "nothing subscribes to `{subject}` any more; `{node}` did at the base",
            help="subscribe to `{subject}`, or remove the publisher",
        ),
        "subscriber renamed": Text(
            "nothing subscribes to `{subject}` any more; `{node}` did at the base, and now reads `{replacement}`",
            help="publish `{replacement}`",
        ),
        "no server": Text(
            "nothing serves `{subject}` any more; `{node}` did at the base",
            help="serve `{subject}`, or remove the client",
        ),
        "server renamed": Text(
            "nothing serves `{subject}` any more; `{node}` did at the base, and now serves `{replacement}`",
            help="ask for `{replacement}`",
        ),
        "client renamed": Text(
            "`{node}` asked for `{subject}` at the base, and now asks for `{replacement}`, which nothing serves",
            help="serve `{replacement}`",
        ),
    },
)
def lost_edge(workspace: Workspace, base: Workspace):
    now, before = (Flow(get_flow(each).graph, {}) for each in (workspace, base))
    found = {(one.kind, one.subject): one for one in _compare(workspace, now, before)}
    yield from found.values()
    for launch in compare_launches(workspace, base).launches:
        if not (launch.added or launch.removed or _changes_others(launch)):
            now, before = Flow(launch.now, {}), Flow(launch.before, {})
            for one in _compare(workspace, now, before, launch):
                if (one.kind, one.subject) not in found:
                    found[one.kind, one.subject] = one
                    yield one


def _changes_others(launch: LaunchChange) -> bool:
    """Whether a launch starts programs of other packages otherwise, which may be the other side now."""
    both = (one for pair in launch.nodes for one in (pair.before, pair.now))
    return any(one is not None and one.kind in ("node", "include") and not one.node for one in both)


def _compare(workspace: Workspace, now: Flow, before: Flow, launch: LaunchChange | None = None) -> Iterator[Diagnostic]:
    """The edges that are lost between two flows. launch: whose they are, None for those of the code."""
    pairs = {pair.before.node: pair for pair in launch.nodes if pair.before is not None} if launch is not None else {}
    for kind, name in sorted(before.known):
        every = now.known.get((kind, name), ())
        for role, gone in OTHER_SIDE.items():
            left = [one for one in every if one.role == role and not one.implied and _counts(now, one, launch)]
            had = [[one for one in before.known[kind, name] if one.role == each] for each in (role, gone)]
            lost = [one for one in had[1] if _counts(before, one, launch)]
            if not had[0] or not lost or not left or any(one.role == gone for one in every):
                continue
            if now.count_unknown(gone) > before.count_unknown(gone):
                continue
            old = lost[0]
            pair = pairs.get(old.node)
            if pair is not None and pair.now is None and pair.before and _is_started(workspace, pair.before.program):
                continue  # by another launch file, which may belong to the same system
            nodes = {old.node, pair.now.node} if pair is not None and pair.now is not None else {old.node}
            successors = sorted({one.topic for one in list_successors(now, before, old, nodes)})
            new = successors[0] if len(successors) == 1 else ""
            met = bool(new) and any(one.role == role for one in now.known.get((kind, new), ()))
            if role in ("server", "action server") and (not new or met):
                continue  # a client that is gone, or has another server
            uncertain = (role == "publisher" and (not successors or met)) or (launch is not None and launch.others)
            node = now.nodes[old.node].executable if new and old.node in now.nodes else ""
            node = old.node if launch is not None else node or old.node.rpartition("/")[2]
            at, package = _find_place(workspace, now, left[0], launch, pair, old.topic, new)
            yield Diagnostic(
                at,
                name,
                package,
                {"node": node or old.node, "replacement": new},
                kind=f"{gone.removeprefix('action ')} renamed" if new else f"no {gone.removeprefix('action ')}",
                doubts=(Doubt.CHANGED,) if uncertain else (),
            )


def _is_started(workspace: Workspace, program: str) -> bool:
    """Whether some launch file starts a program."""
    return any(start.program == program for launch in get_flow(workspace).launches for start in launch.starts)


def _counts(flow: Flow, one: Endpoint, launch: LaunchChange | None) -> bool:
    """Whether an endpoint is one to be sure of: in what a launch file starts, its name and its start are."""
    sure = one.how == "default" or flow.is_sure(one)  # no launch file sets another value
    return launch is None or (sure and one.node in flow.nodes and not flow.nodes[one.node].uncertain)


def _find_place(
    workspace: Workspace, now: Flow, left: Endpoint, launch: LaunchChange | None, pair: NodeChange | None, old: str,
    new: str,
) -> tuple[At, str]:  # fmt: skip
    """The line that is to blame, and its package: that of a launch or parameter file, else of the side that is left."""
    cause = pair.find_cause(old, new) if pair is not None else None
    path, line = (cause.path, cause.line) if cause is not None else (left.path, left.line)
    if launch is not None and pair is not None and pair.now is None:
        path, line = launch.path, 1
    if (path, line) == (left.path, left.line):
        return At(path, line), now.nodes[left.node].package if left.node in now.nodes else ""
    return At(path, line), workspace.find_owning_package(path)
