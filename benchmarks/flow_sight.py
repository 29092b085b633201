"""The message-flow graph at first sight: endpoints and sites drawn from systems that nobody here had opened.

A set of systems is benchmarks/systems/NAME.systems.jsonl (repo, commit), what was drawn of them and how readers of the
sources judged it benchmarks/systems/NAME.drawn.jsonl. A record is a fact, never text of a source:
    endpoint   an endpoint of the graph: repo, path, line, role, node, name, type, how (as the graph says where the name
               is from), certain; verdict: `right`, `wrong name`, `wrong node`, `wrong type`, `none` (nothing such is
               there), `open` (the sources do not tell); why: one clause
    site       a place in C++ or Python code that a search of the text takes for an API call: repo, path, line, role;
               name, of those that were judged before: what a reader makes of it, before a launch file renames it;
               found: the graph has an endpoint, parameter or timer there, or names the place as not resolved, or leaves
               out its file or package and says so (`named`);
               verdict, of those that are not found, or were judged before: `call` or `none` (the text is no such call)
    known      an endpoint of a node whose program a reader read as a whole before there was a graph: repo, role, node,
               name, as a running system shows them; found: the graph has it, `certain` or not (`stated`), or not (``)

usage: flow_sight.py sites --set NAME --clones FOLDER [--number 20] [--seed 18]
       flow_sight.py draw --set NAME --clones FOLDER [--number 20] [--seed 18]
       flow_sight.py score --set NAME
       flow_sight.py recheck --set NAME --clones FOLDER
       flow_sight.py calls --set NAME --clones FOLDER

`sites` writes the sites alone, which need no graph: they can be judged before anybody runs `graph`. `draw` writes the
records without verdicts, and keeps what was said before of sites and of known endpoints; `score` prints the figures of
those that have one; `recheck` prints which endpoints that were judged right the graph of today still has, which wrong
ones it still states, and which sites it has. `calls` prints of each system the API calls of which all is known, those
whose name is known in part, as docs/graph.md says it under Coverage, and the others.
"""

from __future__ import annotations

import argparse
import json
import random
import re
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import graph as sites
import mining
from rosimpact.impact.analysis.session import open_tree

SETS = Path(__file__).parent / "systems"
ROLES = {
    "publishers": "publisher", "subscribers": "subscriber", "servers": "server", "clients": "client",
    "action_servers": "action server", "action_clients": "action client", "timers": "timer", "parameters": "parameter",
}  # fmt: skip
CERTAIN = frozenset(("literal", "given", "launch"))
_CPP = {
    "publisher": r"advertise|advertiseCamera|create(?:_generic|_camera)?_publisher",
    "subscriber": r"subscribe|subscribeCamera|create(?:_generic|_camera)?_subscription",
    "server": r"advertiseService|create_service",
    "client": r"serviceClient|create_client",
    "timer": r"createTimer|createWallTimer|create_wall_timer|create_timer",
    "parameter": r"declare_parameters?|get_parameter|getParam|param",
}
_PYTHON = {
    "publisher": r"Publisher|create_publisher",
    "subscriber": r"Subscriber|create_subscription",
    "server": r"(?<!Action)Service|create_service",
    "client": r"ServiceProxy|create_client",
    "action server": r"ActionServer|SimpleActionServer",
    "action client": r"ActionClient|SimpleActionClient",
    "timer": r"Timer|create_timer",
    "parameter": r"declare_parameters?|get_param|get_parameter",
}
_IN_PYTHON = {role: re.compile(rf"(?<!\w)(?:{names})\s*\(") for role, names in _PYTHON.items()}
_DEFINITION = re.compile(r"\s*(?:class|def|from|import)\b")
_COMMENT = re.compile(r"#.*")
_CODE = (".cpp", ".cc", ".cxx", ".hpp", ".h", ".hh")
_TESTS = re.compile(r"(?:^|/)(?:tests?|__pycache__)/|(?:^|/)test_[^/]*\Z|_test\.\w+\Z")


def list_sites(path: str, data: bytes) -> Iterator[tuple[str, int]]:
    """Role and line of what a search of the text takes for API calls."""
    text = data.decode("utf-8", "replace")
    if path.endswith(_CODE):
        for role, names in _CPP.items():
            yield from ((role, line) for line in sites.counted(text, names))
    elif path.endswith(".py") and "launch" not in path.rpartition("/")[2]:
        for number, line in enumerate(text.split("\n"), 1):
            code = _COMMENT.sub("", line)
            if not _DEFINITION.match(code):
                yield from ((role, number) for role, pattern in _IN_PYTHON.items() if pattern.search(code))


class GraphFailed(Exception):
    """`graph` printed no graph; the message names the system, the exit status and what `graph` said."""


def read_graph(clone: mining.Clone, commit: str) -> dict:
    """The graph of a commit, as `graph --format json` gives it. Raises GraphFailed where it gives none."""
    command = [sys.executable, "-m", "rosimpact.impact.cli", "graph", str(clone.folder), "--rev", commit, "-q"]
    done = subprocess.run([*command, "--format", "json", "--all"], capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout)
    except json.JSONDecodeError:
        last = "\n".join(done.stderr.strip().splitlines()[-5:]) or "nothing on standard error"
        raise GraphFailed(f"{clone.name} at {commit}: graph failed (exit status {done.returncode}): {last}") from None


class SeenPlaces:
    """Where a graph has something. A place counts up to two lines beside it."""

    def __init__(self, found: dict):
        self._have = defaultdict(set)
        for listed, role in ROLES.items():
            self._have[role].update((one["path"], one["line"]) for one in found[listed])
        self._named = {(one["path"], one["line"]) for one in found["coverage"]["unresolved"]}
        copies = (one["path"] for one in found["coverage"]["unresolved"] if one["what"] == "package")
        self._left_out = *found["coverage"]["uncompiled"], *(f"{path.rpartition('/')[0]}/" for path in copies)

    def has(self, role: str, path: str, line: int) -> bool:
        """Whether it has something of a role there."""
        return not self._have[role].isdisjoint(_list_near(path, line))

    def names(self, path: str, line: int) -> bool:
        """Whether it says that it does not understand the place, or leaves out the file, or its package."""
        return path.startswith(self._left_out) or not self._named.isdisjoint(_list_near(path, line))


def _list_near(path: str, line: int) -> set[tuple[str, int]]:
    return {(path, line + beside) for beside in range(-2, 3)}


def is_certain(endpoint: dict, names: dict[str, str]) -> bool:
    """Whether the graph states an endpoint without reserve: its name is known, a node of the workspace runs it, and the
    preprocessor does not leave it out. names: of the nodes, by id; empty for a library that no node runs."""
    return endpoint.get("how") in CERTAIN and bool(names.get(endpoint["node"])) and not endpoint.get("only_if")


def find_clone(clones: Path, repo: str) -> mining.Clone:
    """The clone of a system. Raises GraphFailed where there is none."""
    found = mining.find_clones(clones, [repo])
    if not found:
        raise GraphFailed(f"{repo}: no clone in {clones}")
    return found[0]


def draw(clone: mining.Clone, commit: str, number: int, seed: int, before: list[dict]) -> Iterator[dict]:
    """Records of a system: as many endpoints and sites, each chosen at random. before: what was written already."""
    chance = random.Random(f"{seed} {clone.name} {commit}")
    found = read_graph(clone, commit)
    about = {"repo": clone.name, "commit": commit}
    names = {node["id"]: node["name"] for node in found["nodes"]}
    endpoints = [
        {**about, "kind": "endpoint", "role": role, "path": one["path"], "line": one["line"],
         "node": names.get(one["node"], one["node"]), "name": one.get("topic", one.get("name", "")),
         "type": one.get("type", ""), "how": one.get("how", one.get("kind", "")),
         "certain": is_certain(one, names)}
        for listed, role in ROLES.items() if role not in ("timer", "parameter")
        for one in found[listed] if not one.get("implied") and one.get("topic")
    ]  # fmt: skip
    yield from chance.sample(endpoints, min(number, len(endpoints)))
    have = defaultdict(set)
    for listed, role in ROLES.items():
        for one in found[listed]:
            key = role, names.get(one["node"], one["node"]), one.get("topic")
            have[key].add("certain" if is_certain(one, names) else "stated")
    for one in before:
        if one["kind"] == "known":
            stated = have[one["role"], one["node"], one["name"]]
            yield {**one, "found": min(stated, default="")}
    seen = SeenPlaces(found)
    for one in [one for one in before if one["kind"] == "site"] or draw_sites(clone, commit, number, seed):
        place = one["path"], one["line"]
        yield {**one, "found": seen.has(one["role"], *place), "named": seen.names(*place)}


def draw_sites(clone: mining.Clone, commit: str, number: int, seed: int) -> Iterator[dict]:
    """Records of as many sites of a system, chosen at random; without what the graph has there."""
    chance = random.Random(f"{seed} {clone.name} {commit} sites")
    tree, found = open_tree(clone.folder, commit), []
    for entry in tree.list_entries():
        if entry.path.endswith((*_CODE, ".py")) and not _TESTS.search(entry.path):
            found += [(role, entry.path, line) for role, line in list_sites(entry.path, tree.read(entry.path))]
    for role, path, line in chance.sample(found, min(number, len(found))):
        yield {"repo": clone.name, "commit": commit, "kind": "site", "role": role, "path": path, "line": line}


def recheck(clones: Path, systems: list[dict], records: list[dict]) -> int:
    """Prints how many of the judged endpoints the graph of today has, by verdict, and names the right ones it lost and
    the wrong ones it kept; and the same of the sites that are calls, by role. Returns of how many systems there is no
    graph, or no clone; these are named too."""
    kept: dict[str, Counter[bool]] = defaultdict(Counter)
    sites_now: dict[str, Counter[str]] = defaultdict(Counter)
    failures = 0
    for system in systems:
        try:
            found = read_graph(find_clone(clones, system["repo"]), system["commit"])
        except GraphFailed as error:
            print(error, file=sys.stderr)
            failures += 1
            continue
        names = {node["id"]: node["name"] for node in found["nodes"]}
        have = {
            (role, one["path"], one["line"], names.get(one["node"], one["node"]), one.get("topic"), type_)
            for listed, role in ROLES.items() if role not in ("timer", "parameter")
            for one in found[listed] if is_certain(one, names) for type_ in (one.get("type"), "")
        }  # fmt: skip
        for one in records:
            if one["repo"] == system["repo"] and one["kind"] == "endpoint" and one.get("verdict"):
                key = tuple(one[part] for part in ("role", "path", "line", "node", "name", "type"))
                kept[one["verdict"]][key in have] += 1
                if (key in have) != (one["verdict"] == "right"):
                    said = f"{one['role']} {one['name']} of {one['node']}, {one['path']}:{one['line']}"
                    print(f"{one['repo']}: {one['verdict']}, {'still' if key in have else 'no longer'} there: {said}")
        seen = SeenPlaces(found)
        for one in records:
            if one["repo"] == system["repo"] and is_call(one):
                place = one["role"], one["path"], one["line"]
                state = "found" if seen.has(*place) else "named" if seen.names(*place[1:]) else "missed"
                sites_now[one["role"]][state] += 1
                sites_now[one["role"]]["drawn"] += one["found"]
                if state != "found":
                    print(f"{one['repo']}: {one['role']} {state}: {one['path']}:{one['line']}")
    for verdict, count in kept.items():
        print(f"{verdict}: {count[True]} of {sum(count.values())} still stated as certain")
    for role, states in sorted(sites_now.items()):
        calls = states["found"] + states["named"] + states["missed"]
        print(f"{role}: {states['found']} of {calls} found, {states['named']} more named; {states['drawn']} when drawn")
    return failures


def count_calls(clones: Path, systems: list[dict]) -> int:
    """Prints how many API calls of each system and of all are resolved, known in part, and neither. Returns of how many
    systems there is no graph, or no clone; these are named too."""
    total: Counter[str] = Counter()
    failures = 0
    for system in systems:
        try:
            found = read_graph(find_clone(clones, system["repo"]), system["commit"])["coverage"]
        except GraphFailed as error:
            print(error, file=sys.stderr)
            failures += 1
            continue
        lost = found["calls"] - found["resolved"] - found["in_part"]
        own = {"calls": found["calls"], "resolved": found["resolved"], "in part": found["in_part"], "neither": lost}
        total.update(own)
        print(system["repo"], ", ".join(f"{count} {what}" for what, count in own.items()))
    print("all", ", ".join(f"{count} {what}" for what, count in total.items()))
    return failures


def is_call(one: dict) -> bool:
    """Whether a record is of a site that is a call: what the graph has and a search of the text finds is one; readers
    judged the others."""
    return one["kind"] == "site" and one.get("verdict", "call" if one["found"] else "") == "call"


def score(records: list[dict]) -> None:
    """Prints how the endpoints that readers judged are right, and which sites the graph has."""
    endpoints = [one for one in records if one["kind"] == "endpoint" and one.get("verdict")]
    for title, chosen in (("certain", [e for e in endpoints if e["certain"]]),
                          ("not certain", [e for e in endpoints if not e["certain"]])):  # fmt: skip
        verdicts = Counter(one["verdict"] for one in chosen)
        told = sum(verdicts.values()) - verdicts["open"]
        print(f"{title}: {verdicts['right']} of {told} right; {dict(verdicts)}")
    sites_of_calls = [one for one in records if is_call(one)]
    for role in sorted({one["role"] for one in sites_of_calls}):
        calls = [one for one in sites_of_calls if one["role"] == role]
        found, named = sum(one["found"] for one in calls), sum(one["named"] and not one["found"] for one in calls)
        print(f"{role}: {found} of {len(calls)} found, {named} more named as not resolved")
    for role in sorted({one["role"] for one in records if one["kind"] == "known"}):
        states = Counter(one["found"] for one in records if one["kind"] == "known" and one["role"] == role)
        print(f"known {role}: {states['certain']} of {states.total()} certain, {states['stated']} more stated")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=("sites", "draw", "score", "recheck", "calls"))
    parser.add_argument("--set", required=True)
    parser.add_argument("--clones", type=Path)
    parser.add_argument("--number", type=int, default=20)
    parser.add_argument("--seed", type=int, default=18)
    options = parser.parse_args()
    drawn = SETS / f"{options.set}.drawn.jsonl"
    if options.command == "score":
        score([json.loads(line) for line in drawn.read_text().splitlines()])
        return
    systems = [json.loads(line) for line in (SETS / f"{options.set}.systems.jsonl").read_text().splitlines()]
    if options.command == "calls":
        sys.exit(count_calls(options.clones, systems) > 0)
    if options.command == "recheck":
        sys.exit(recheck(options.clones, systems, [json.loads(line) for line in drawn.read_text().splitlines()]) > 0)
    before = [json.loads(line) for line in drawn.read_text().splitlines()] if drawn.exists() else []
    failures = 0
    with drawn.open("w") as out:
        for system in systems:
            try:
                clone = find_clone(options.clones, system["repo"])
                about = clone, system["commit"], options.number, options.seed
                known = [one for one in before if one["repo"] == clone.name and one["kind"] != "endpoint"]
                records = list(draw_sites(*about) if options.command == "sites" else draw(*about, known))
            except GraphFailed as error:
                print(error, file=sys.stderr)
                failures += 1
                continue
            out.writelines(json.dumps(record) + "\n" for record in records)
            print(system["repo"], flush=True)
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
