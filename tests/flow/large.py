"""A made-up system for the page: 200 nodes in 20 packages and 10 namespaces, 400 topics, three launch files."""

from rosimpact.impact.model.flow.graph import Coverage, Endpoint, Graph, Node, Publish, Qos, Trigger, Way

NODES, TOPICS = 200, 400
LAUNCHES = tuple(f"bringup/launch/{name}.launch.py" for name in ("robot", "navigation", "tools"))
TYPES = ("sensor_msgs/LaserScan", "nav_msgs/Path", "geometry_msgs/Twist", "std_msgs/String")


def name_topic(number: int) -> str:
    return f"/space_{number // 2 % 10}/topic_{number}"


def build_large_graph(size: int = NODES) -> Graph:
    """Each node says two topics and hears up to four; each tenth topic nobody hears. size: the number of nodes."""
    nodes, ends, publishes = [], [], []
    for n in range(size):
        package, name = f"package_{n % 20}", f"/space_{n % 10}/node_number_{n}"
        uncertain = ("IfCondition(LaunchConfiguration('sim'))",) if n % 25 == 3 else ()
        launches = (LAUNCHES[n % 3], LAUNCHES[0]) if n % 10 == 1 else (LAUNCHES[n % 3],)
        started = f"{LAUNCHES[n % 3]}:{n + 10}"
        nodes.append(Node(
            name, name, package, "executable", f"node_{n}", "", "cpp", f"src/{package}/src/node_{n}.cpp", 20, started,
            uncertain, tuple(dict.fromkeys(launches)),
        ))  # fmt: skip
        at = {"node": name, "path": f"src/{package}/src/node_{n}.cpp"}
        said = [2 * n, 2 * n + 1]
        # A quarter of the nodes hears what the quarter before it says, and here and there what a later one says.
        before = n // 50 * 100 - 100
        heard = [before + (n * k + j) % 100 for k, j in ((2, 0), (3, 7), (7, 4))][: n % 4] if n >= 50 else []
        heard += [(13 * n + 5) % (2 * size)] if n % 10 == 0 else []
        for k, topic in enumerate(said):
            how = "default" if topic % 20 == 7 else "literal"
            qos = Qos("best_effort" if topic % 3 else "reliable", "volatile", "keep_last", 5 + n % 2)
            kind = TYPES[topic % 4]
            ends.append(Endpoint("publisher", topic=name_topic(topic), type=kind, line=30 + k, how=how, qos=qos, **at))
            way = Way(Trigger("timer", f"{20 + topic % 80}ms", at["path"], 50))
            publishes.append(Publish(
                topic=name_topic(topic), type=kind, line=60 + k, triggers=(way.trigger,), by=(way,), **at,
            ))  # fmt: skip
        for k, topic in enumerate(t for t in heard if t % 10 != 9):
            only = "USE_GPU" if topic % 50 == 11 else ""
            ends.append(Endpoint(
                "subscriber", topic=name_topic(topic), type=TYPES[topic % 4], line=40 + k, only_if=only, **at,
            ))  # fmt: skip
        ends.append(Endpoint("publisher", topic="/rosout", type="rcl_interfaces/Log", line=20, implied=True, **at))
    return Graph(
        tuple(nodes), tuple(ends), tuple(publishes), (), (), Coverage(len(ends), len(ends), 0, size), root="large"
    )
