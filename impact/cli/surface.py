"""rosimpact surface."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...edges.console import UserError, format_count, make_step_reporter, run_command
from ...edges.version import __version__
from .output import READ_SO_FAR, check_output, find_style, make_command, print_answer, say_notes


@make_command("text", "json", "markdown")
def surface_show(package: str, *, repos, all, format, output, jobs) -> str:
    """What a version of a package offers."""
    from ...databuild.surface import report
    from ...databuild.surface.lookup import find_surface, list_hashes

    with _open_store() as store:
        name, _, asked = package.partition("@")
        source, state = find_surface(name, asked, repos, store, jobs)
        surface, hashes = state.surfaces[name], list_hashes(name, source.asked, state)
        if format == "json":
            return report.show_json(surface, source, __version__, hashes)
        if format == "markdown":
            return report.show_markdown(surface, source, hashes)
        return report.show_text(surface, source, find_style(output), all, hashes)


@make_command("text", "json", "markdown")
def surface_diff(what: str, old: str, new: str, *, repos, packages, all, format, output, jobs) -> str:
    """What changed between two versions of a package, or of all packages of a clone."""
    from ...databuild.surface import report
    from ...databuild.surface.clones import Clone
    from ...databuild.surface.compare import RepositorySurfaces, compare, compare_states
    from ...databuild.surface.lookup import find_surface, list_hashes

    with _open_store() as store:
        if os.path.isdir(what) and repos is None:
            clone = Clone(Path(what))
            states = [RepositorySurfaces(clone.read_surfaces(revision, store, jobs)) for revision in (old, new)]
            changes = compare_states(*states)
            unknown = [name for name in packages if name not in changes]
            if unknown:
                raise UserError(f"--packages {unknown[0]}: {clone.name} has no such package at {old} or {new}")
            changes = {name: each for name, each in changes.items() if (name in packages if packages else each)}
            sources = [report.VersionSource(revision, "", clone.name, revision) for revision in (old, new)]
        elif os.sep in what and not os.path.isdir(what):
            raise UserError(f"{what}: no such folder; give a package, or the path of a clone")
        else:
            (first, before), (second, after) = (find_surface(what, asked, repos, store, jobs) for asked in (old, new))
            changes = {what: compare(before.surfaces[what], after.surfaces[what], before, after)}
            sources = [first, second]
            old_hashes, new_hashes = list_hashes(what, first.asked, before), list_hashes(what, second.asked, after)
            changes[what] = tuple(
                report.add_hashes(change, old_hashes, new_hashes) if change.kind == "wire" else change
                for change in changes[what]
            )
        found = report.SurfaceDifference(sources[0], sources[1], changes)
        if format == "json":
            return report.render_diff_json(found, __version__)
        if format == "markdown":
            return report.render_diff_markdown(found)
        return report.render_diff_text(found, find_style(output), all)


def surface_build(*, distro, repos, packages, all_versions, output, onto, jobs, dask, quiet) -> int:
    """Writes the surfaces of released packages to a file. Returns the exit status: 0, or 2 (failed)."""

    def build_surfaces() -> int:
        from ...databuild.surface.clones import Clones
        from ...databuild.surfaces import build, list_distros

        if not distro:
            raise UserError("--distro: missing; name the distros to read, such as --distro humble --distro jazzy")
        if dask is not None and jobs is not None:
            raise UserError("--jobs: has no effect with --dask, which uses a cluster; give only one of the two")
        check_output(output, "")
        report = None if quiet else make_step_reporter()
        versions = "all" if all_versions else "newest"
        names = list_distros(distro)
        built = build(Clones(repos), names, output, packages, jobs, report, versions=versions, dask=dask, onto=onto)
        if not built.packages:
            raise UserError(f"{repos}: no clone has a package asked for; clone repositories there, with their tags")
        say_notes(built.failed)
        told_of = f"{format_count(built.packages, 'package')}, {format_count(built.versions, 'version')}"
        print_answer(
            f"{output}: {told_of}, {output.stat().st_size:,} bytes; "
            f"{built.approximate} with a branch for a missing tag, {len(built.missing)} without a clone",
            "text",
        )
        return 0

    return run_command(build_surfaces, READ_SO_FAR, output)


@contextmanager
def _open_store() -> Iterator:
    """The store of facts, what went wrong with which is said at the end."""
    from ..facts.store import Store

    with Store() as store:
        yield store
        say_notes(store.notes)
