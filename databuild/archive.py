"""Builds data/archive.json.zst: which archive has which of the packages that rosdep keys install.

    python -P -m rosimpact.databuild.archive --suite "debian bookworm=LISTS" --output DATA

LISTS is a `Dir::State::lists` folder of an apt, with the Packages indices of a suite, of all its components; the option
is given once for each suite. A package that others provide counts as there, and packages of ROS itself are left out:
its own archive has them too. Of Ubuntu the lists of files in data/providers.sqlite.zst tell what a release lacks: a
package that alone has files in another release, none of which this one has. Only names are kept.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from ..impact.targets.providers.archive import FILE, ArchiveTable
from ..impact.targets.providers.providers import Providers
from ..impact.targets.snapshot import load_snapshot
from ..impact.targets.tables import DATA
from .providers import list_ros_packages, read_keys, read_names
from .table_file import write_table


def build_table(
    suites: Mapping[str, Collection[str]], wanted: Iterable[str], lacking: Mapping[str, Collection[str]]
) -> ArchiveTable:
    """The shipped table. suites: platform to all names in its archive. wanted: names that rosdep keys install. lacking:
    platforms whose lists of files alone are known, with the packages of which they have nothing."""
    known = sorted({name for name in wanted if any(name in names for names in suites.values())})
    return ArchiveTable(
        tuple(suites), _group_by_bits(known, suites), tuple(lacking), _group_by_bits(known, lacking, least=1)
    )


def _group_by_bits(names: Iterable[str], sets: Mapping[str, Collection[str]], least: int = 0) -> dict[int, str]:
    found: dict[int, list[str]] = {}
    for name in names:
        bits = sum(1 << place for place, each in enumerate(sets.values()) if name in each)
        if bits >= least:
            found.setdefault(bits, []).append(name)
    return {bits: " ".join(each) for bits, each in sorted(found.items())}


def find_lacking(providers: Providers) -> dict[str, set[str]]:
    """Platforms of Ubuntu with the packages of which their lists of files have nothing, though those of another one
    have something that no other package has."""
    platforms = {place: name for place, name in enumerate(providers.platforms) if name.startswith("ubuntu ")}
    mask = sum(1 << place for place in platforms)
    seen: dict[str, int] = defaultdict(int)
    for packages, bits in providers.list_packages_of_names():
        if len(packages) == 1:
            seen[packages[0]] |= bits & mask
    return {
        platform: {name for name, bits in seen.items() if bits and not bits >> place & 1}
        for place, platform in platforms.items()
    }


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suite", action="append", default=[], help='"debian bookworm=LISTS"')
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    suites, of_ros = {}, set()
    for item in given.suite:
        platform, _, lists = item.partition("=")
        suites[platform] = read_names(Path(lists))
        of_ros.update(list_ros_packages(Path(lists)))
        print(platform, len(suites[platform]), "names", flush=True)
    wanted = {name for names in read_keys(load_snapshot()).debian.values() for name in names}
    wanted -= of_ros
    made = build_table(suites, wanted, find_lacking(Providers(given.output)))
    size = write_table(given.output / FILE, made)
    print(sum(len(names.split()) for names in made.packages.values()), "packages of", len(wanted), size, "bytes")


if __name__ == "__main__":
    main()
