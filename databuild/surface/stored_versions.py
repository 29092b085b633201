"""Versions of packages in a file of surfaces: which of them stands for what is asked for. No clone is needed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ...impact.facts.interface import Interface
from ...impact.targets.distro.distro import DistroTarget
from ...impact.targets.snapshot import Snapshot, load_snapshot
from ...impact.targets.surface.store import Surfaces
from .clones import VersionError, find_newest_distro, find_release
from .compare import RepositorySurfaces


class StoredVersion(NamedTuple):
    """version: as released. stored: the version in the file that stands for it. approximate: it is another one, or a
    branch stood for its tag when it was read. ros: the generation that it is of."""

    version: str
    stored: str
    approximate: bool
    ros: int


class StoredVersions:
    """What a file of surfaces has of versions (`28.1.0`) and distros (`jazzy`, `jazzy@2024-08-01`)."""

    def __init__(self, surfaces: Surfaces, data: Snapshot | None = None):
        self.surfaces, self._data = surfaces, data or load_snapshot()

    def find_newest(self, package: str) -> str:
        """The newest distro that has a package. Raises VersionError when none has it."""
        return find_newest_distro(package, self._data)

    def find(self, package: str, asked: str) -> StoredVersion:
        """What stands for a version or a distro's version: of the latter the newest one before it, when it is not
        there itself, at a tag; of a version that both ROS generations have, ROS 2's. Raises VersionError when there is
        none."""
        lines = self.surfaces.find_lines(package)
        stored = None
        if asked[:1].isdigit():
            version = asked
            ros = max((ros for ros, line in lines.items() if version in line.versions), default=0)
            stored = version if ros else None
        else:
            release = find_release(package, asked, self._data)
            version, ros = release.version, DistroTarget(release.distro, data=self._data).ros
            place = lines[ros].find_place(version) if ros in lines else None
            stored = lines[ros].versions[place] if place is not None else None
        if not lines:
            raise VersionError(f"surfaces of `{package}` are not shipped; read them from a clone: --repos DIR")
        if stored is None:
            having = [f"{line.versions[0]} to {line.versions[-1]}" for line in lines.values()]
            raise VersionError(
                f"`{package}` {version} is not shipped, others from {' and '.join(having)} are; read it from a clone:"
                " --repos DIR"
            )
        return StoredVersion(version, stored, stored in lines[ros].approximate or stored != version, ros)

    def find_surface(self, package: str, asked: str) -> tuple[StoredVersion, RepositorySurfaces]:
        """What stands for a version of a package, with the packages that its repository released along with it. Raises
        VersionError, see find()."""
        found = self.find(package, asked)
        surfaces = {}
        for name in (package, *self._list_packages_beside(package, found.stored)):
            history = self.surfaces.find_history(name, found.ros)
            surface = history.load_surface(found.stored) if history is not None else None
            if surface is not None:
                surfaces[name] = surface
        return found, RepositorySurfaces(surfaces)

    def find_message(self, distro: str, name: str) -> Interface | None:
        """What a distro (`jazzy`, `jazzy@2024-08-01`) has of a message, by `package/Name`; None where it has none, or
        it is not stored."""
        package, _, short = name.partition("/")
        try:
            found = self.find(package, distro)
        except VersionError:
            return None
        history = self.surfaces.find_history(package, found.ros)
        return history.load_interfaces(found.stored).get(f"msg/{short}") if history is not None else None

    def _list_packages_beside(self, package: str, version: str) -> Iterator[str]:
        """Other packages that were released with a version of a package."""
        reported = {package}
        for known, names in self._data.fetch(
            "SELECT DISTINCT r.version, n.names FROM release r JOIN packages n ON n.id = r.packages"
            " JOIN home h ON h.distro = r.distro AND h.repository = r.repository JOIN package p ON p.id = h.package"
            " WHERE p.name = ? AND r.version LIKE ?",
            (package, f"{version}%"),
        ):
            if known.partition("-")[0] == version and package in names.split(" "):
                yield from (name for name in names.split(" ") if name not in reported)
                reported.update(names.split(" "))
