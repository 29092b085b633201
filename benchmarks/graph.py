"""Counts the sites that the message-flow graph finds beside those of a regular expression, and times the graph.

usage: graph.py [--list] REPOSITORY[@REV] ...

The regular expression looks for calls by their names in C++ sources whose comments and literals are blanked, and leaves
out what has a type or a class before it as a declaration has; it knows nothing of receivers. `found` are its sites at
whose line (or two beside it) the graph has one; `extra` are the graph's own that it has not, other than what a
framework makes by itself (/rosout, /tf). With --list, the sites that the graph lacks and its extra ones are printed, to
be read by a person.
Cold: `rosimpact graph` as a process of its own, imports included, when no facts are known; warm: again; beside both a
bare tree-sitter parse of all C++ files of the tree, tests too, in one process. Each is the best of three: wall time,
and in brackets the processor time of it and its children.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator

from check import best, run, timed

NAMES = {
    "publisher": "advertise|advertiseCamera|create(?:_generic|_camera)?_publisher",
    "subscriber": "subscribe|subscribeCamera|create(?:_generic|_camera)?_subscription",
    "publish": "publish|sendTransform",
}
_HIDDEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
_TYPE_BEFORE = re.compile(r"[\w>&*]\Z")
_NO_TYPE = re.compile(r"(?:->|\breturn|\belse|\bdo)\Z")
_BODY_BEHIND = re.compile(r"(?:\s|const|override|noexcept)*[:{]")


def counted(text: str, names: str) -> Iterator[int]:
    """Lines of the calls of some names."""
    text = _HIDDEN.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)
    for match in re.finditer(rf"(?<!\w)(?:{names})\b\s*", text):
        at = match.end()
        if text[at : at + 1] == "<":
            at = _closed(text, at, "<", ">")
            at += len(text[at:]) - len(text[at:].lstrip())
        if text[at : at + 1] != "(":
            continue
        before = text[: match.start()].rstrip()
        if _TYPE_BEFORE.search(before) and not _NO_TYPE.search(before):
            continue
        if before.endswith("::") and _BODY_BEHIND.match(text, _closed(text, at, "(", ")")):
            continue
        yield text.count("\n", 0, match.start()) + 1


def _closed(text: str, at: int, opening: str, closing: str) -> int:
    """The place behind the bracket that closes the one at a place."""
    depth = 0
    while at < len(text):
        depth += (text[at] == opening) - (text[at] == closing and text[at - 1] != "-")
        at += 1
        if depth == 0:
            break
    return at


def measured(repository: str, listed: bool) -> Counter[str]:
    """Prints a repository's line and returns its counts."""
    from rosimpact.impact.analysis.session import open_tree
    from rosimpact.impact.facts.kinds import find_kind
    from rosimpact.impact.facts.store import Store
    from rosimpact.impact.model.flow.workspace import get_facts, link_for_flow, list_code, make_graph

    path, _, revision = repository.partition("@")
    with tempfile.TemporaryDirectory() as cache:
        cold, warm = _command(path, revision, pathlib.Path(cache))
        tree = open_tree(pathlib.Path(path), revision)
        with Store(pathlib.Path(cache)) as store:
            workspace = link_for_flow(tree, store)
            graph = make_graph(workspace, store)
        kinds = get_facts(workspace).kinds
        sources = [each for each in list_code(workspace) if kinds[each] == "flow_cpp"]
    data = {each: tree.read(each) for each in sources}
    whole = [tree.read(entry.path) for entry in tree.list_entries() if find_kind(entry.path) == "cpp"]
    bare = _bare(whole)
    have = {"publisher": Counter(), "subscriber": Counter(), "publish": Counter()}
    for endpoint in graph.endpoints:
        if endpoint.role in have:
            have[endpoint.role][endpoint.path, endpoint.line] += 1
    implied = Counter((each.path, each.line) for each in graph.endpoints if each.implied)
    have["publish"].update((each.path, each.line) for each in graph.publishes)
    for wrapper in graph.coverage.wrappers:
        have.get(wrapper.what, Counter())[wrapper.path, wrapper.line] += 1
    total: Counter[str] = Counter()
    for what, names in NAMES.items():
        told = set()
        for each, content in data.items():
            for line in counted(content.decode("utf-8", "replace"), names):
                told.update((each, line + beside) for beside in range(-2, 3))
                total[what] += 1
                if any((each, line + beside) in have[what] for beside in range(-2, 3)):
                    total[f"{what} found"] += 1
                elif listed:
                    print(f"  not found: {what} {each}:{line}")
        for each, line in sorted(place for place in have[what] - implied if place[0] in data and place not in told):
            total[f"{what} extra"] += 1
            if listed:
                print(f"  extra: {what} {each}:{line}")
    subscribers = [e for e in graph.endpoints if e.role == "subscriber" and not e.implied]
    places = {(e.path, e.line): bool(e.callback) for e in subscribers}
    total.update({
        "subscribers": len(places), "with callback": sum(places.values()), "calls": graph.coverage.calls,
        "resolved": graph.coverage.resolved, "by default": graph.coverage.by_default,
        "no name": sum("name" in one.what for one in graph.coverage.unresolved),
        "no type": sum("type" in one.what for one in graph.coverage.unresolved),
    })  # fmt: skip
    name = pathlib.Path(path).parent.name if pathlib.Path(path).name == "repo" else pathlib.Path(path).name
    _line(name, total)
    beside = ", ".join(
        f"{label} {wall:.2f} ({own:.2f}) s, {wall / bare[0]:.2f} ({own / bare[1]:.2f}) x bare parse"
        for label, (wall, own) in (("cold", cold), ("warm", warm))
    )
    print(f"  {beside}; bare parse {bare[0]:.2f} ({bare[1]:.2f}) s of {len(whole):,} files", flush=True)
    return total


def _command(path: str, revision: str, cache: pathlib.Path) -> tuple[tuple[float, float], tuple[float, float]]:
    """Wall and processor seconds that `rosimpact graph` takes with no facts known, and again."""
    command = [sys.executable, "-m", "rosimpact.impact.cli", "graph", path, *(["--rev", revision] if revision else [])]
    # An installed package is compiled; compiling it anew in every run is not what is measured here.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["ROSIMPACT_CACHE"] = str(cache)

    def forget() -> None:
        for facts in cache.glob("facts.sqlite*"):
            facts.unlink()

    run(command, environment)
    return best(3, forget, command, environment)[:2], best(3, lambda: None, command, environment)[:2]


def _bare(contents: list[bytes]) -> tuple[float, float]:
    import tree_sitter
    import tree_sitter_cpp

    parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language()))
    return timed(lambda: [parser.parse(content) for content in contents], 3)


def _line(name: str, total: Counter[str]) -> None:
    sites = ", ".join(
        f"{what} {total[f'{what} found']}/{total[what]} and {total[f'{what} extra']} extra" for what in NAMES
    )
    print(
        f"{name}: {sites}; callbacks {total['with callback']}/{total['subscribers']}; resolved {total['resolved']}/"
        f"{total['calls']} ({total['by default']} by a parameter's default), without a name {total['no name']}, "
        f"without a type {total['no type']}"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repositories", nargs="+")
    parser.add_argument("--list", action="store_true", help="print the sites that are not found, and the extra ones")
    options = parser.parse_args()
    everything: Counter[str] = Counter()
    for repository in options.repositories:
        everything.update(measured(repository, options.list))
    _line("together", everything)
    return 0


if __name__ == "__main__":
    sys.exit(main())
