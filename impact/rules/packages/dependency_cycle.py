"""dependency-cycle: packages of the workspace depend on each other in a cycle.

What it does
    Reports every cycle among build, build tool, build export and run dependencies of the workspace's packages.

Why it breaks
    catkin and colcon sort packages by all these kinds: neither builds a workspace with a cycle.

Severity
    error: the build tool stops before it builds anything.

Example
    turtlebot_bringup needs turtlebot_capabilities, which needs turtlebot_bringup

Use instead
    One direction only; what both need goes into a third package.

Not reported
    Cycles that only exist with test or documentation dependencies: colcon ignores those that would close a cycle.
"""

from ..vocabulary import Diagnostic, Doubt, TargetView, Text, rule

# Every cycle that is found is cut, and the rest searched again. A workspace in which all packages need each other has
# about as many cycles as dependencies; the first ones are enough.
_MOST_CYCLES = 100
_MOST_EDGES = 2_000_000


@rule(
    scope="target",
    texts={
        "cycle": Text("dependency cycle: {cycle}", help="remove one of these dependencies"),
        "more": Text(
            "there are more than {most} dependency cycles; the others are not listed",
            help="first remove the listed cycles",
        ),
    },
)
def dependency_cycle(view: TargetView):
    from graphlib import CycleError, TopologicalSorter

    needs: dict[str, set[str]] = {}
    for package in view.list_built():
        needs[package.name] = {
            name
            for name, kinds in view.collect_declared(package).items()
            if name in view.workspace.packages and name != package.name and kinds - {"test", "doc"}
        }
    edges = sum(map(len, needs.values()))
    most = max(1, min(_MOST_CYCLES, _MOST_EDGES // max(1, edges)))
    for number in range(most + 1):
        try:
            TopologicalSorter(needs).prepare()
            return
        except CycleError as error:
            # graphlib gives each name before those that need it.
            names = list(reversed(error.args[1]))[:-1]
        first = min(names)
        names = names[names.index(first) :] + names[: names.index(first)]
        package = view.workspace.packages[first]
        at = view.find_place(package, names[1])
        if number == most:
            if view.reports_on(first):
                yield Diagnostic(at, "further cycles", first, {"most": most}, "more", (Doubt.UNCHECKED,))
            return
        if view.reports_on(first):
            yield Diagnostic(at, names[1], first, {"cycle": " → ".join([*names, first])}, kind="cycle")
        needs[first].discard(names[1])
