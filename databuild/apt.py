"""Builds data/apt.json.zst: which Debian packages come along with those that rosdep keys install.

    python -P -m rosimpact.databuild.apt --suite "debian bookworm=LISTS" --output DATA

LISTS is a `Dir::State::lists` folder of an apt, with the Packages index of the suite; the option is given once for each
suite. Kept are the packages that a rosdep key installs on some Debian or Ubuntu: each with the others of them that its
dependencies lead to, through any number of packages in between; and what build-essential needs, which every machine has
that builds. Recommended packages,
alternatives but the first, and versions do not count.

Ubuntu's indices need not be at hand. What comes along there is inferred in two ways, and such an answer silences
findings and never makes one: from Debian's suites, of which Ubuntu's are copies; and from the lists of files of
Ubuntu's suites in data/providers.sqlite.zst, for packages that no Debian suite has any longer (Qt 4). There a package
brings another when everything that the other one has comes along with it.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

from ..impact.targets.providers.apt import INFERRED, AptGraph
from ..impact.targets.providers.providers import Providers
from ..impact.targets.snapshot import load_snapshot
from ..impact.targets.tables import DATA
from .providers import read_dependencies, read_keys
from .table_file import write_table

BASE = "build-essential"
"""What every machine that builds Debian packages has (Debian policy 4.2)."""
_ENOUGH = 3
"""Names that a package must have to itself for their company to tell what brings it."""


def reduce_dependencies(depends: Mapping[str, Iterable[str]], wanted: frozenset[str]) -> dict[str, set[str]]:
    """Each wanted package to the wanted ones that it leads to without another one between them."""
    found = {}
    for start in wanted & depends.keys():
        seen, waiting, reached = {start}, [start], set()
        while waiting:
            for name in depends.get(waiting.pop(), ()):
                if name not in seen:
                    seen.add(name)
                    (reached.add if name in wanted else waiting.append)(name)
        found[start] = reached
    return found


def collect_reachable(depends: Mapping[str, Iterable[str]], start: str) -> set[str]:
    """A package and everything that it depends on."""
    found, waiting = {start}, [start]
    while waiting:
        for name in depends.get(waiting.pop(), ()):
            if name not in found:
                found.add(name)
                waiting.append(name)
    return found


def infer_packages(providers: Iterable[tuple[str, ...]]) -> dict[str, set[str]]:
    """Each package to those whose names all come along with it. providers: for each name the packages that rosdep keys
    install and that bring it, the one that has it first."""
    companions: dict[str, set[str]] = {}
    count: dict[str, int] = defaultdict(int)
    for packages in providers:
        first = packages[0]
        count[first] += 1
        known = companions.get(first)
        companions[first] = set(packages) if known is None else known & set(packages)
    found: dict[str, set[str]] = defaultdict(set)
    for package, others in companions.items():
        if count[package] >= _ENOUGH:
            for other in others - {package}:
                found[other].add(package)
    return found


def build_graph(
    suites: Mapping[str, Mapping[str, Iterable[str]]], keys: frozenset[str], seen: Mapping[str, set[str]]
) -> AptGraph:
    """suites: platform to package to what it depends on. keys: packages of rosdep keys. seen: see infer_packages()."""
    base = sorted(set().union(*(collect_reachable(depends, BASE) for depends in suites.values())))
    wanted = keys - frozenset(base)
    edges: dict[str, dict[str, int]] = defaultdict(dict)
    for place, depends in enumerate(suites.values()):
        for name, reached in reduce_dependencies(depends, wanted).items():
            for other in reached:
                edges[name][other] = edges[name].get(other, 0) | 1 << place
    for name, reached in seen.items():
        for other in reached:
            if not any(other in depends for depends in suites.values()):
                edges[name][other] = edges[name].get(other, 0) | INFERRED
    names = sorted({*edges, *(other for found in edges.values() for other in found), *base})
    place_of = {name: place for place, name in enumerate(names)}
    brings = {
        place_of[name]: sorted((place_of[other], bits) for other, bits in found.items())
        for name, found in sorted(edges.items())
        if found
    }
    return AptGraph(tuple(suites), tuple(names), tuple(place_of[name] for name in base), brings)


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suite", action="append", default=[], help='"debian bookworm=LISTS"')
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    suites = {}
    for item in given.suite:
        platform, _, lists = item.partition("=")
        suites[platform] = read_dependencies(Path(lists))
        if not suites[platform]:
            parser.error(f"{lists}: no Packages index of {platform}; run apt-get update first")
        print(platform, len(suites[platform]), "packages", flush=True)
    keys = frozenset(name for names in read_keys(load_snapshot()).debian.values() for name in names)
    made = build_graph(suites, keys, infer_packages(Providers(given.output).list_provider_groups()))
    size = write_table(given.output / "apt.json.zst", made)
    print(len(made.packages), "packages,", sum(map(len, made.brings.values())), "relations,", size, "bytes")


if __name__ == "__main__":
    main()
