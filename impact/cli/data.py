"""rosimpact data."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...edges.console import UserError, escape_json, format_count, make_step_reporter, run_command, say
from .output import READ_SO_FAR, make_command, print_answer

if TYPE_CHECKING:
    from ...databuild.snapshot import TablesStatus


@make_command("text", "json")
def data_status(format: str) -> str:
    """Date, origin and contents of the distro data in use."""
    from ...databuild.snapshot import read_status

    found = read_status()
    if format == "json":
        import json

        answer = {**found._asdict(), "tables": found.tables._asdict()}
        return escape_json(json.dumps(answer, indent=1, default=str, ensure_ascii=False))
    origin = "updated" if found.updated else "shipped with rosimpact"
    lines = [f"distro data of {found.date}, {origin}, {found.packed / 1e6:.1f} MB, in {found.folder}"]
    lines += [f"from {name} {commit}" for name, commit in found.sources.items()]
    if found.last_syncs:
        newest = ", ".join(f"{name} {day}" for name, day in sorted(found.last_syncs.items()))
        lines.append(f"newest syncs: {newest}")
    lines.append(f"tables {_describe_tables(found.tables)}")
    kept = found.surfaces
    told_of = f"{format_count(kept['packages'], 'package')}, {format_count(kept['versions'], 'version')}"
    lines.append(f"surfaces of {told_of}, as of {kept['date']}, of {kept['distros']}")
    return "\n".join(lines)


def _describe_tables(tables: TablesStatus) -> str:
    date = f"of {tables.date}" if tables.date else "without a date"
    if tables.updated:
        return f"{date}, updated: {', '.join(tables.updated)}"
    unused = f"; fetched ones are not used: {tables.unused}" if tables.unused else ""
    return f"{date}, as shipped with rosimpact{unused}"


def data_build(
    sources: Path, output: Path, work: Path | None, meta_ros: Path | None, step: list[str], again: list[str]
) -> int:
    """Builds the data that a TOML file names the sources of; the snapshot alone from a git repository."""

    def build_it() -> int:
        from ..cache import cache_folder

        kept = work or cache_folder() / "build"
        if sources.suffix == ".toml" and not sources.is_dir():
            if meta_ros is not None:
                raise UserError("--meta-ros: has no effect with a file of sources; name it there, as meta_ros")
            return _build_everything(sources, output, kept, step, again)
        if step or again:
            raise UserError(f"{'--step' if step else '--again'}: needs a file of sources (.toml) that names them")
        return _build_snapshot(sources, output, kept, meta_ros)

    return run_command(build_it, READ_SO_FAR, sources)


def _build_everything(sources: Path, output: Path, work: Path, step: list[str], again: list[str]) -> int:
    from ...databuild.everything import LOGS, build_everything

    status = 0
    for built in build_everything(sources, output, work, step, again, make_step_reporter()):
        told = f": {'; '.join(built.said)}" if built.said else ""
        took = f" in {built.seconds:.0f} s" if built.outcome == "made" else ""
        print_answer(f"{built.step}: {_OUTCOMES[built.outcome]}{took}{told}", "text")
        if built.outcome == "failed":
            status = 2
            say(f"rosimpact: {built.step} failed; all that it printed is in {work / LOGS / built.step}.txt")
    return status


_OUTCOMES = {
    "made": "built", "kept": "built by an earlier run", "left": "left as it is, since no sources are named",
    "failed": "failed, and left as it is", "unreached": "left as it is",
}  # fmt: skip


def _build_snapshot(rosdistro: Path, output: Path, work: Path, meta_ros: Path | None) -> int:
    from ...databuild.snapshot import build
    from ...databuild.table_manifest import write_manifest

    built = build(rosdistro, output, work, meta_ros, make_step_reporter())
    write_manifest(output)
    print_answer(
        f"data of {built.date} in {output}: {format_count(built.releases, 'release')}, "
        f"{format_count(built.manifests, 'manifest')}, {format_count(built.rules, 'rosdep rule')}, "
        f"{built.packed / 1e6:.1f} MB ({built.unpacked / 1e6:.1f} MB unpacked)",
        "text",
    )
    for name, count in built.unreadable.items():
        say(f"rosimpact: {name}: {format_count(count, 'version')} of its distribution file could not be read")
    return 0


def data_update(from_: str, shipped: bool) -> int:
    """Refreshes the snapshot over the network; takes all tables from a source, or goes back to the shipped ones."""

    def update_data() -> int:
        if from_ and shipped:
            raise UserError("--shipped: has no effect with --from; give one of them")
        if shipped:
            return _reset_tables()
        if from_:
            return _update_tables(from_)
        from ...databuild.snapshot import update

        found = update(report=make_step_reporter())
        for failure in found.failures:
            say(f"rosimpact: not updated: {failure}")
        print_answer(
            f"data of {found.date} in {found.folder}: {format_count(len(found.syncs), 'new sync')}, "
            f"{format_count(found.releases, 'release')}, {format_count(found.manifests, 'manifest')}, "
            f"{format_count(found.rules, 'rosdep rule')}",
            "text",
        )
        return 0

    return run_command(update_data, "interrupted; the data in use stays", "the distro data")


def _update_tables(source: str) -> int:
    from ...databuild.table_update import update_tables

    found = update_tables(source, make_step_reporter())
    print_answer(
        f"tables of {found.date} in {found.folder}: {len(found.fetched)} fetched, "
        f"{len(found.changed)} not as shipped{': ' if found.changed else ''}{', '.join(found.changed)}",
        "text",
    )
    return 0


def _reset_tables() -> int:
    from ...databuild.table_update import reset_tables

    print_answer("back to the shipped data" if reset_tables() else "the shipped data are in use", "text")
    return 0
