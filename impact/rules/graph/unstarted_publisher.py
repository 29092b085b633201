"""unstarted-publisher: no launch file starts the publisher of a topic, but one that publishes nearly its name.

What it does
    Reports subscribers that launch files start, if only programs that no launch file starts publish on their topic, and
    a publisher that launch files do start has a name that differs in words (`map/point`, `map/point_class`) and is read
    by nothing that they start.

Why it breaks
    What is started never receives a message: mostly another program took the place of the publisher and uses other
    names.

Example
    <node pkg="porter" type="planner" name="planner"/>        <!-- reads map/tile_class, of tile_query -->
    <node pkg="porter" type="tile_loader" name="tiles"/>      <!-- publishes map/tile -->

Use instead
    Subscribe to the name that is published, or start the other publisher.

Not reported
    Topics that a publisher whose name is not known may publish; what the reader itself publishes; names that are close
    to several.
"""

from ...model.flow.edges import build_system_flow, get_label
from ...model.flow.misspelling import differs_in_words
from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=Text(
        "no launch file starts a publisher of `{subject}`, which `{node}` reads; `{publisher}` is started and "
        "publishes `{replacement}`, which nothing that is started reads",
        help="subscribe to `{replacement}`, or start `{other}` too",
    ),
)
def unstarted_publisher(workspace: Workspace):
    flow = build_system_flow(workspace)
    started = {node.id for node in flow.graph.nodes if node.started}
    unread = [
        one for one in flow.list_sure("publisher")
        if one.node.started and started.isdisjoint(each.node for each in flow.list_others(one.endpoint))
    ]  # fmt: skip
    reported = set()
    for taker in flow.list_sure("subscriber"):
        one, place = taker.endpoint, (taker.endpoint.path, taker.endpoint.line)
        givers = [each for each in flow.list_others(one) if each.node in flow.nodes]
        if not taker.node.started or one.implied or not givers or place in reported:
            continue
        if not started.isdisjoint(each.node for each in givers) or flow.may_have(
            "publisher", flow.find_type(one), one.topic, typed=True
        ):
            continue
        others = (each for each in unread if each.node.id != taker.node.id)
        near = {each.endpoint.topic: each for each in others if differs_in_words(one.topic, each.endpoint.topic)}
        if len(near) == 1:
            reported.add(place)
            (other,) = near.values()
            data = {
                "node": get_label(taker.node),
                "publisher": get_label(other.node),
                "replacement": other.endpoint.topic,
                "other": get_label(flow.nodes[givers[0].node]),
            }
            yield Diagnostic(At(*place), one.topic, taker.node.package, data)
