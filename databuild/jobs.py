"""One job of building surfaces: the clones that have versions of the same packages, and what reading them gives."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..impact.facts.store import Store
from ..impact.targets.surface.surface import Surface
from ..impact.tree import TreeError
from .surface.clones import Clone
from .surface.compare import RepositorySurfaces
from .surface.package import build_surfaces
from .surface_changes import Lines
from .surface_file import IncludesPacker, Packed, Packer, Stored


class CloneState(NamedTuple):
    """A state of a clone. packages: those whose version it stands for. generations: of ROS that have it there."""

    version: str
    place: str
    clone: str
    revision: str
    approximate: bool
    packages: tuple[str, ...]
    generations: tuple[int, ...]


class Job(NamedTuple):
    """What one worker does: all states of some packages, oldest version first, and no other job's packages. Everything
    in it can be sent to another machine that sees the same clones. name: of the clone that most of them are in."""

    name: str
    states: tuple[CloneState, ...]
    trees: tuple[str, ...]

    def compute_key(self) -> str:
        """Changes with all that the result depends on."""
        from ..edges.limits import format_limits
        from ..impact.source_keys import compute_source_key

        about = (self.name, self.states, self.trees, compute_source_key(__name__), format_limits())
        return hashlib.sha1(repr(about).encode()).hexdigest()


class Result(NamedTuple):
    """packages: packed versions by package and ROS generation. failed: what could not be read, a line each."""

    packages: dict[tuple[str, int], Packed]
    failed: tuple[str, ...]


class Packing:
    """Packs the versions of packages as they come, oldest first."""

    def __init__(self) -> None:
        self._packers: dict[tuple[str, int], Packer] = {}
        self._including: dict[tuple[str, int], IncludesPacker] = {}
        self._lines = Lines()

    def add(
        self,
        package: str,
        version: str,
        generations: Sequence[int],
        state: RepositorySurfaces,
        approximate: bool = False,
    ) -> None:
        """The next version of a package, and the state that it belongs to. generations: of ROS that have it, 1, 2 or
        both. approximate: a branch stands for it."""
        surface = state.surfaces[package]
        for ros in generations:
            key = package, ros
            self._packers.setdefault(key, Packer()).add(Stored(version, approximate, surface))
            self._including.setdefault(key, IncludesPacker()).add(version, surface.headers, approximate)
        self._lines.add(package, version, generations, state, approximate)

    def pack_packages(self) -> dict[tuple[str, int], Packed]:
        """The packages of each ROS generation as they are stored."""
        changes = self._lines.pack_lines()
        return {
            key: Packed(packer.pack_versions(), changes[key], self._including[key].pack_versions())
            for key, packer in self._packers.items()
        }


def run(job: Job) -> Result:
    """Does a job, in whatever process: reads each state once and packs the versions of each package."""
    clones = {state.clone: Clone(Path(state.place), state.clone) for state in job.states}
    packing = Packing()
    failed: list[str] = []
    read: dict[str, RepositorySurfaces] = {}
    with Store() as store:
        for state, tree in zip(job.states, job.trees, strict=True):
            if tree not in read:
                read.clear()  # one state at a time is enough
                try:
                    read[tree] = RepositorySurfaces(
                        build_surfaces(clones[state.clone].read_tree(state.revision), store, 1)
                    )
                except (TreeError, OSError) as error:
                    failed.append(f"{state.clone} {state.version}: {error}")
                    continue
            for package in state.packages:
                if package in read[tree].surfaces:
                    whose = _select_generations(read[tree].surfaces[package], state.generations)
                    packing.add(package, state.version, whose, read[tree], state.approximate)
                    if whose != state.generations:
                        failed.append(f"{package} {state.version}: {state.clone} has a ROS 1 package at its tag")
                elif not state.approximate:
                    failed.append(f"{package} {state.version}: not in {state.clone} at its tag")
    return Result(packing.pack_packages(), tuple(failed))


def _select_generations(surface: Surface, generations: tuple[int, ...]) -> tuple[int, ...]:
    """Those of some ROS generations that a package as it was read can be of: one that only catkin builds is none of
    ROS 2, whatever its tag is called."""
    return tuple(ros for ros in generations if ros == 1 or surface.build.build_type != "catkin")
