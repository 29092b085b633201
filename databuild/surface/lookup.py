"""Where the surface of a version is found: in clones, in an installed prefix or .deb, else in what is shipped."""

from pathlib import Path

from ...impact.facts.store import Store
from ...impact.targets.surface.store import load_shipped
from .clones import Clones
from .compare import RepositorySurfaces
from .hashes import compute_hash
from .installed import is_installed, read_surface
from .report import VersionSource
from .stored_versions import StoredVersions


def find_surface(
    package: str, asked: str, repos: Path | None, store: Store, jobs: int | None
) -> tuple[VersionSource, RepositorySurfaces]:
    """Where a version of a package was found, and its state: in clones, else in what is shipped."""
    if is_installed(asked):
        surface, state = read_surface(package, asked)
        return VersionSource(asked, surface.version, asked, "installed"), state
    if repos is None:
        versions = StoredVersions(load_shipped())
        asked = asked or versions.find_newest(package)
        stored, state = versions.find_surface(package, asked)
        return VersionSource(asked, stored.version, "the shipped surfaces", stored.stored, stored.approximate), state
    clones = Clones(repos)
    asked = asked or clones.find_newest(package)
    found, state = clones.find_surface(package, asked, store, jobs)
    revision = found.revision.removeprefix("refs/").partition("/")[2] or found.revision
    return VersionSource(asked, found.version, found.clone.name, revision, found.approximate), state


def list_hashes(package: str, asked: str, state: RepositorySurfaces) -> dict[str, str]:
    """The hashes of a package's interfaces, by `msg/Name`, as far as all that is in them is known: in the state of its
    repository, or of other packages of the distro that was asked for."""
    others = None if asked[:1].isdigit() or is_installed(asked) else StoredVersions(load_shipped())

    def find(name: str):
        owner, _, short = name.partition("/")
        if owner in state.surfaces:
            return dict(state.surfaces[owner].interfaces).get(f"msg/{short}")
        return others.find_message(asked, name) if others is not None else None

    surface = state.surfaces[package]
    ros = 2 if surface.build.build_type.startswith("ament") else 1
    known = ((name, compute_hash(f"{package}/{name}", ros, reported, find)) for name, reported in surface.interfaces)
    return {name: reported for name, reported in known if reported is not None}
