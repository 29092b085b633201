"""Small bodies of code, joined."""

from textwrap import dedent

from rosimpact.impact.facts import flow_cpp, flow_python
from rosimpact.impact.model.flow.frameworks import Frameworks
from rosimpact.impact.model.flow.graph import Graph
from rosimpact.impact.model.flow.join import Join
from rosimpact.impact.model.flow.nodes import Built


def joined(files: dict[str, str], ros: int = 2, built: tuple[Built, ...] = (), table: Frameworks | None = None) -> Join:
    """Sources by path, the first folder being the package; every file with a main is an executable of its own, every
    Python file a script, unless told otherwise."""
    facts = {}
    for path, text in files.items():
        data = dedent(text).encode()
        facts[path] = flow_python.extract(data) if path.endswith(".py") else flow_cpp.extract(data)
    if not built:
        packages = dict.fromkeys(path.split("/")[0] for path in files)
        built = tuple(_built(package, facts) for package in packages)
    return Join(facts, lambda path: path.split("/")[0], built, ros, table)


def _built(package: str, facts) -> Built:
    inside = {path: file for path, file in facts.items() if path.startswith(f"{package}/")}
    mains = {
        path.rpartition("/")[2].partition(".")[0]: (path,)
        for path, file in inside.items()
        if any(function.name == "main" for function in file.functions) and file.language == "cpp"
    }
    scripts = {path.rpartition("/")[2]: path for path, file in inside.items() if file.language == "python"}
    return Built(package, mains, {}, {}, scripts, {})


def graph(files: dict[str, str], ros: int = 2, **more) -> Graph:
    """The graph of such sources."""
    return joined(files, ros, **more).graph()


def ends(found: Graph, role: str) -> set[tuple[str, str, str]]:
    """(node, topic or `?`, type) of the endpoints of a role, implied ones left out."""
    return {(e.node, e.topic or "?", e.type) for e in found.endpoints if e.role == role and not e.implied}
