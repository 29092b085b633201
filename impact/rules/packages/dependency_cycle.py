"""dependency-cycle: packages of the workspace depend on each other in a circle.

What it does
    Reports every cycle among build, build tool, build export and run dependencies of the workspace's packages.

Why it breaks
    catkin and colcon sort packages by all these kinds: neither builds a workspace with a cycle.

Severity
    error: the build tool stops before it builds anything. A cycle that only test dependencies close is a note, since
    colcon leaves test dependencies out where they would close one.

Example
    turtlebot_bringup needs turtlebot_capabilities, which needs turtlebot_bringup

Use instead
    One direction only; what both need goes into a third package.
"""

from ...model.view import View
from ..rule import Hit, rule


@rule(severity="error")
def dependency_cycle(view: View):
    import networkx

    graph = networkx.DiGraph()
    for package in view:
        for name, kinds in view.declared(package).items():
            if name in view.workspace.packages and name != package.name and kinds - {"test", "doc"}:
                graph.add_edge(package.name, name)
    for circle in networkx.strongly_connected_components(graph):
        if len(circle) < 2:
            continue
        cycle = networkx.find_cycle(graph.subgraph(circle))
        names = [a for a, _ in cycle]
        first = min(names)
        names = names[names.index(first) :] + names[: names.index(first)]
        package = view.workspace.packages[first]
        dependency = next(d for d in package.manifest.dependencies if d.name == names[1])
        yield Hit(view.manifest_place(package, dependency), names[1], "dependency cycle: " + " → ".join([*names, first]),
                  "cut one of these dependencies", first)  # fmt: skip
