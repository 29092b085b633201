"""Small bodies of code, joined."""

from pathlib import Path
from textwrap import dedent

from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.cpp import flow as flow_cpp
from rosimpact.impact.facts.python import flow as flow_python
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.defined import DefinedInterfaces
from rosimpact.impact.model.flow.frameworks import Frameworks
from rosimpact.impact.model.flow.graph import Graph
from rosimpact.impact.model.flow.join import Join
from rosimpact.impact.model.flow.nodes import BuiltPackage
from rosimpact.impact.model.flow.system import ChosenLaunch
from rosimpact.impact.model.flow.workspace import link_for_flow, make_graph


def joined(
    files: dict[str, str], ros: int = 2, built: tuple[BuiltPackage, ...] = (), table: Frameworks | None = None,
    defined: DefinedInterfaces | None = None,
) -> Join:  # fmt: skip
    """Sources by path, the first folder being the package; every file with a main is an executable of its own, every
    Python file a script, unless told otherwise."""
    facts = {}
    for path, text in files.items():
        data = dedent(text).encode()
        facts[path] = flow_python.extract(data) if path.endswith(".py") else flow_cpp.extract(data)
    if not built:
        packages = dict.fromkeys(path.split("/")[0] for path in files)
        built = tuple(_built(package, facts) for package in packages)
    return Join(facts, lambda path: path.split("/")[0], built, ros, table, defined)


def _built(package: str, facts) -> BuiltPackage:
    inside = {path: file for path, file in facts.items() if path.startswith(f"{package}/")}
    mains = {
        path.rpartition("/")[2].partition(".")[0]: (path,)
        for path, file in inside.items()
        if any(function.name == "main" for function in file.functions) and file.language == "cpp"
    }
    scripts = {path.rpartition("/")[2]: path for path, file in inside.items() if file.language == "python"}
    return BuiltPackage(package, mains, {}, {}, scripts, {})


def graph(files: dict[str, str], ros: int = 2, **more) -> Graph:
    """The graph of such sources."""
    return joined(files, ros, **more).build()


def ends(found: Graph, role: str) -> set[tuple[str, str, str]]:
    """(node, topic or `?`, type) of the endpoints of a role, implied ones left out."""
    return {(e.node, e.topic or "?", e.type) for e in found.endpoints if e.role == role and not e.implied}


def write(root: Path, files: dict[str, str]) -> None:
    """Writes the files of a workspace to a folder."""
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dedent(text).lstrip())


def graph_on_disk(root: Path, files: dict[str, str], launch: str = "") -> Graph:
    """The graph of a workspace that is written to a folder, or of what one of its launch files starts."""
    write(root, files)
    with Store(root / ".cache") as store:
        chosen = [ChosenLaunch(launch)] if launch else None
        return make_graph(link_for_flow(open_tree(root, ""), store), None, chosen=chosen)


def manifest(name: str, build: str) -> str:
    """A manifest of a package. build: `catkin`, `ament_cmake` or `ament_python`."""
    return (
        f'<?xml version="1.0"?><package format="3"><name>{name}</name><version>1.0.0</version>'
        '<description>x</description><maintainer email="a@b.org">a</maintainer><license>MIT</license>'
        f"<buildtool_depend>{build}</buildtool_depend><export><build_type>{build}</build_type></export></package>"
    )
