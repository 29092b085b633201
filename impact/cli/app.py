"""The command line: options and help; each command imports what it needs when it runs."""

import gc
import io
import sys
import warnings
from contextlib import suppress
from copy import copy
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer

from ...classifier.cli import app as classifier_app
from ...classifier.cli import suggest_label, triage
from ...corpus.cli import app as corpus_app
from ...corpus.cli import set_suggester
from ...edges.console import UserError, hold_streams, output_failed, say, visible, write
from .dev import app as dev_app
from .study import app as study_app

app = typer.Typer(
    name="rosimpact",
    help="Know what a change breaks in a ROS workspace, and for whom, before you merge it.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
env_app = typer.Typer(
    help="Machines: capture this machine as a target, compare two machines.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
data_app = typer.Typer(
    help="The shipped distro data: show its date, rebuild it, update it.", no_args_is_help=True, rich_markup_mode=None
)
surface_app = typer.Typer(
    help="What versions of packages offer, and what changed between them.", no_args_is_help=True, rich_markup_mode=None
)
app.add_typer(env_app, name="env")
app.add_typer(surface_app, name="surface")
app.add_typer(data_app, name="data")
app.add_typer(corpus_app, name="corpus")
set_suggester(suggest_label)
app.add_typer(classifier_app, name="classifier")
app.command()(triage)
app.add_typer(study_app, name="study")
app.add_typer(dev_app, name="dev", hidden=True)


def _schema_option(report: str) -> Any:
    """The option that prints the JSON schema of a report. report: its module."""

    def show(value: bool) -> None:
        if value:
            from .output import print_answer

            print_answer(import_module(f"...report.{report}", __name__).schema(), "json")
            raise typer.Exit()

    return typer.Option("--schema", callback=show, is_eager=True, help="Print the JSON schema of --format json.")


_FOLLOW_LINKS = "Follow links that lead out of the workspace. Do not use it on workspaces that you do not trust."

_FAIL_ON = "Lowest severity that gives exit status 1: error (the default), warning, note, never."


@app.command()
def check(
    path: Annotated[Path, typer.Argument(help="Workspace, package or git repository.")] = Path("."),
    target: Annotated[
        list[str] | None,
        typer.Option(
            "--target",
            "-t",
            help="jazzy, humble@2024-03-01, envs/laptop.json, a name of rosimpact.toml, robot.dpkg.txt, "
            "docker:ros:humble. May be repeated.",
        ),
    ] = None,
    format: Annotated[
        str, typer.Option("--format", "-f", help="One of text, json, sarif, github, markdown, html.")
    ] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the report to this file.")] = None,
    rev: Annotated[str, typer.Option(help="Check this git revision instead of the files on disk.")] = "",
    base: Annotated[
        list[str] | None,
        typer.Option(
            help="Compare with the merge base of this revision (PATH=REV for one repository, or a pinned .repos "
            "file): only new findings fail."
        ),
    ] = None,
    install: Annotated[
        Path | None,
        typer.Option(
            help="Also check the built files of this install space (or devel space, or prefix of a package) for shared "
            "libraries that are missing, here or on a target."
        ),
    ] = None,
    select: Annotated[
        list[str] | None, typer.Option(help="Only these rules or families. May be repeated or comma-separated.")
    ] = None,
    ignore: Annotated[list[str] | None, typer.Option(help="Skip these rules or families.")] = None,
    fail_on: Annotated[str, typer.Option(help=_FAIL_ON)] = "",
    notes: Annotated[bool, typer.Option("--notes", help="Also show notes in the text report.")] = False,
    preview: Annotated[
        bool, typer.Option("--preview", help="Also run rules whose precision is not measured yet.")
    ] = False,
    baseline: Annotated[Path | None, typer.Option(help="Leave out findings that this file contains.")] = None,
    write_baseline: Annotated[
        Path | None, typer.Option(help="Write all current findings to this file, and exit with 0.")
    ] = None,
    prune_baseline: Annotated[
        bool, typer.Option("--prune-baseline", help="Remove fixed findings from the file given with --baseline.")
    ] = False,
    fix: Annotated[
        bool,
        typer.Option("--fix", help="Apply fixes that are correct on all targets, and report what remains."),
    ] = False,
    diff: Annotated[bool, typer.Option("--diff", help="Print what --fix would change; change nothing.")] = False,
    config: Annotated[Path | None, typer.Option(help="Another rosimpact.toml.")] = None,
    follow_links: Annotated[bool, typer.Option("--follow-links", help=_FOLLOW_LINKS)] = False,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes for parsing.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
    schema: Annotated[bool, _schema_option("json")] = False,
) -> None:
    """Report what breaks, on which machine, where, and what to do.

    Exit status: 0 nothing at or above --fail-on, 1 findings, 2 the tool failed or analysed nothing.
    """
    from . import check as command

    raise typer.Exit(
        command.check(
            path, targets=tuple(target or ()), format=format, output=output, rev=rev, base=tuple(base or ()),
            select=_names(select), ignore=_names(ignore), fail_on=fail_on, notes=notes, preview=preview,
            baseline=baseline, write_baseline=write_baseline, prune_baseline=prune_baseline, fix=fix, diff=diff,
            config=config, jobs=jobs, quiet=quiet, install=install, follow_links=follow_links,
        )
    )  # fmt: skip


@app.command()
def upgrade(
    from_: Annotated[str, typer.Option("--from", help="The current target, in any form that --target accepts.")],
    to: Annotated[str, typer.Option("--to", help="The new target.")],
    path: Annotated[Path, typer.Argument(help="Workspace, package or git repository.")] = Path("."),
    packages: Annotated[list[str] | None, typer.Option(help="Only these packages.")] = None,
    rev: Annotated[str, typer.Option(help="Read this git revision instead of the files on disk.")] = "",
    config: Annotated[Path | None, typer.Option(help="Another rosimpact.toml.")] = None,
    follow_links: Annotated[bool, typer.Option("--follow-links", help=_FOLLOW_LINKS)] = False,
    format: Annotated[str, typer.Option("--format", "-f", help="One of text, json, html.")] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the report to this file.")] = None,
    fail_on: Annotated[str, typer.Option(help=_FAIL_ON)] = "",
    schema: Annotated[bool, _schema_option("upgrade")] = False,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes for parsing.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
) -> None:
    """List what breaks when you move from one target to another, package by package in build order.

    Exit status: 0 no new finding at or above --fail-on, 1 something breaks, 2 the tool failed.
    """
    from . import upgrade as command

    raise typer.Exit(
        command.upgrade(
            path, from_, to, packages=_names(packages), rev=rev, config=config, format=format, output=output,
            fail_on=fail_on, jobs=jobs, quiet=quiet, follow_links=follow_links,
        )
    )  # fmt: skip


@app.command()
def why(
    name: Annotated[
        str, typer.Argument(help="A header, package, rosdep key, CMake name, Python module or executable.")
    ],
    path: Annotated[
        Path | None,
        typer.Argument(
            help="Workspace whose uses are shown; default: the current folder, if it is a workspace.",
            show_default=False,
        ),
    ] = None,
    target: Annotated[list[str] | None, typer.Option("--target", "-t", help="As for check.")] = None,
    follow_links: Annotated[bool, typer.Option("--follow-links", help=_FOLLOW_LINKS)] = False,
    format: Annotated[str, typer.Option("--format", "-f", help="text or json.")] = "text",
) -> None:
    """Show which package provides a name on a target, since when, and what uses it in the workspace."""
    from . import why as command

    raise typer.Exit(command.why(name, path, tuple(target or ()), format, follow_links=follow_links))


@app.command()
def graph(
    path: Annotated[Path, typer.Argument(help="Workspace, package or git repository.")] = Path("."),
    launch: Annotated[
        str, typer.Option(help="Only what this launch file starts, with the names that it assigns.")
    ] = "",
    set_: Annotated[
        list[str] | None, typer.Option("--set", help="An argument of the launch file, NAME:=VALUE. May be repeated.")
    ] = None,
    node: Annotated[
        list[str] | None, typer.Option(help="Only this node and its neighbours; `*` matches any text.")
    ] = None,
    topic: Annotated[
        list[str] | None, typer.Option(help="Only this topic, service or action, and the nodes that use it.")
    ] = None,
    package: Annotated[list[str] | None, typer.Option(help="Only nodes of this package.")] = None,
    around: Annotated[str, typer.Option(help="Only what is near this node or topic.")] = "",
    hops: Annotated[int, typer.Option(min=1, help="With --around: the number of steps from node to node.")] = 2,
    rev: Annotated[str, typer.Option(help="Read this git revision instead of the files on disk.")] = "",
    base: Annotated[
        list[str] | None,
        typer.Option(help="Mark what was added, removed and changed since this revision, as for check."),
    ] = None,
    follow_links: Annotated[bool, typer.Option("--follow-links", help=_FOLLOW_LINKS)] = False,
    format: Annotated[
        str, typer.Option("--format", "-f", help="One of text, json, graphml, dot, mermaid, html.")
    ] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the graph to this file.")] = None,
    all: Annotated[
        bool, typer.Option("--all", help="Also show hidden names and everything that was not resolved.")
    ] = False,
    schema: Annotated[bool, _schema_option("graph.json")] = False,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes for parsing.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
) -> None:
    """Show which nodes are connected by topics, services and actions, without building or running anything."""
    from . import graph as command

    raise typer.Exit(
        command.graph(
            path, launch=launch, arguments=tuple(set_ or ()), nodes=_names(node), topics=_names(topic),
            packages=_names(package), around=around, hops=hops, rev=rev, base=tuple(base or ()), format=format,
            output=output, everything=all, jobs=jobs, quiet=quiet, follow_links=follow_links,
        )
    )  # fmt: skip


@app.command()
def impact(
    path: Annotated[Path, typer.Argument(help="Workspace, package or git repository.")] = Path("."),
    base: Annotated[
        list[str] | None,
        typer.Option(
            help="What changed since the merge base of this revision (PATH=REV for one repository, or a pinned "
            ".repos file)."
        ),
    ] = None,
    rev: Annotated[str, typer.Option(help="Read this git revision instead of the files on disk.")] = "",
    package: Annotated[list[str] | None, typer.Option(help="Only changes in this package. May be repeated.")] = None,
    topic: Annotated[
        list[str] | None, typer.Option(help="Only what goes through this topic; `*` matches any text.")
    ] = None,
    node: Annotated[
        list[str] | None, typer.Option(help="Only changes in this node, or that affect it; `*` matches any text.")
    ] = None,
    follow_links: Annotated[bool, typer.Option("--follow-links", help=_FOLLOW_LINKS)] = False,
    format: Annotated[str, typer.Option("--format", "-f", help="One of text, json, markdown.")] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the report to this file.")] = None,
    all: Annotated[bool, typer.Option("--all", help="List every affected node and all unresolved calls.")] = False,
    schema: Annotated[bool, _schema_option("impact")] = False,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes for parsing.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
) -> None:
    """Show which nodes are affected by changes since a base: of messages, topics, publish conditions and callbacks."""
    from . import impact as command

    raise typer.Exit(
        command.impact(
            path, base=tuple(base or ()), rev=rev, packages=_names(package), topics=_names(topic), nodes=_names(node),
            format=format, output=output, everything=all, jobs=jobs, quiet=quiet, follow_links=follow_links,
        )
    )  # fmt: skip


@app.command()
def logic(
    repository: Annotated[Path, typer.Argument(help="Git repository, bare or not, or a folder in one.")] = Path("."),
    range: Annotated[str, typer.Option(help="Commits A..B, or all up to B; default: all up to HEAD.")] = "",
    commits: Annotated[int | None, typer.Option(min=1, help="Only this many of the newest commits.")] = None,
    since: Annotated[str, typer.Option(help="Only commits since this day, such as 2024-03-01.")] = "",
    package: Annotated[list[str] | None, typer.Option(help="Only this package. May be repeated.")] = None,
    topic: Annotated[list[str] | None, typer.Option(help="Only this topic. May be repeated.")] = None,
    all: Annotated[bool, typer.Option("--all", help="Also list conditions that were only reworded.")] = False,
    format: Annotated[str, typer.Option("--format", "-f", help="text, json or html (a timeline).")] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the report to this file.")] = None,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
) -> None:
    """List the commits that changed when messages are published: which condition or trigger, and whom it affects."""
    from . import logic as command

    raise typer.Exit(
        command.logic(
            repository, range=range, number=commits, since=since, packages=_names(package), topics=_names(topic),
            everything=all, format=format, output=output, jobs=jobs, quiet=quiet,
        )
    )  # fmt: skip


@app.command()
def explain(
    rule: Annotated[str | None, typer.Argument(help="Name of a rule or group; default: list all rules.")] = None,
) -> None:
    """Explain what a rule does, why it matters, and how to fix its findings."""
    from . import explain as command

    raise typer.Exit(command.explain(rule))


@env_app.command("capture")
def env_capture(
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="File to write; default: standard output.")
    ] = None,
) -> None:
    """Write this machine as a target."""
    from . import env as command

    raise typer.Exit(command.env_capture(output))


@env_app.command("diff")
def env_diff(
    first: Annotated[str, typer.Argument(help="A target, in any form that --target accepts.")],
    second: Annotated[str, typer.Argument(help="Another target.")],
    path: Annotated[Path | None, typer.Argument(help="A workspace: show which differences matter to it.")] = None,
    format: Annotated[str, typer.Option("--format", "-f", help="text or json.")] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file.")] = None,
    schema: Annotated[bool, _schema_option("machines")] = False,
) -> None:
    """Show the differences between two machines; with a workspace, also what breaks on only one of them."""
    from . import env as command

    raise typer.Exit(command.env_diff(first, second, path, format, output))


_REPOS_HELP = "Folder of git clones with their tags, called OWNER+NAME or NAME."
_REPOS_OR_SHIPPED = f"{_REPOS_HELP} Default: the shipped data."


@surface_app.command("show")
def surface_show(
    package: Annotated[
        str,
        typer.Argument(
            help="PACKAGE, PACKAGE@28.1.0, PACKAGE@jazzy, PACKAGE@jazzy@2024-08-01 or PACKAGE@/opt/ros/jazzy."
        ),
    ],
    repos: Annotated[Path | None, typer.Option(help=_REPOS_OR_SHIPPED)] = None,
    all: Annotated[bool, typer.Option("--all", help="Also show members of classes, constants and macros.")] = False,
    format: Annotated[str, typer.Option("--format", "-f", help="One of text, json, markdown.")] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file.")] = None,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes for parsing.")] = None,
) -> None:
    """Show what a version of a package offers: headers, names, messages, targets, programs."""
    from . import surface as command

    raise typer.Exit(command.surface_show(package, repos=repos, all_of_it=all, format=format, output=output, jobs=jobs))


@surface_app.command("diff")
def surface_diff(
    what: Annotated[str, typer.Argument(help="A package, or the path of a clone (then without --repos).")],
    old: Annotated[
        str, typer.Argument(help="A version, a distro, an installed prefix or a .deb; for a clone, a revision.")
    ],
    new: Annotated[str, typer.Argument(help="The version to compare with, in the same forms.")],
    repos: Annotated[Path | None, typer.Option(help=_REPOS_OR_SHIPPED)] = None,
    packages: Annotated[list[str] | None, typer.Option(help="For a clone: only these packages.")] = None,
    all: Annotated[
        bool, typer.Option("--all", help="Also list additions, and changes that do not break builds.")
    ] = False,
    format: Annotated[str, typer.Option("--format", "-f", help="One of text, json, markdown.")] = "text",
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file.")] = None,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes for parsing.")] = None,
) -> None:
    """Show what changed between two versions: removed, moved and deprecated names, and changed signatures."""
    from . import surface as command

    raise typer.Exit(
        command.surface_diff(
            what, old, new, repos=repos, packages=_names(packages), all_of_it=all, format=format, output=output,
            jobs=jobs,
        )
    )  # fmt: skip


@surface_app.command("build")
def surface_build(
    distro: Annotated[list[str], typer.Option(help="Read the packages of this distro. May be repeated.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write, such as surfaces.sqlite.")],
    repos: Annotated[Path, typer.Option(help=_REPOS_HELP)] = Path("."),
    packages: Annotated[list[str] | None, typer.Option(help="Only these packages.")] = None,
    all_versions: Annotated[
        bool,
        typer.Option("--all-versions", help="Read all versions that the distros ever had, not only the current ones."),
    ] = False,
    onto: Annotated[
        Path | None, typer.Option(help="Also write what this file has of packages, where clones have no more versions.")
    ] = None,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes.")] = None,
    dask: Annotated[
        str | None, typer.Option(help="Use the cluster of this Dask scheduler, such as tcp://host:8786.")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
) -> None:
    """Write what the released versions of packages offer to a file. A stopped run continues the next time."""
    from . import surface as command

    raise typer.Exit(
        command.surface_build(
            distros=_names(distro), repos=repos, packages=_names(packages), all_versions=all_versions, output=output,
            onto=onto, jobs=jobs, dask=dask, quiet=quiet,
        )
    )  # fmt: skip


@data_app.command("status")
def data_status(
    format: Annotated[str, typer.Option("--format", "-f", help="text or json.")] = "text",
) -> None:
    """Show the age and the sources of the distro data."""
    from . import data as command

    raise typer.Exit(command.data_status(format))


@data_app.command("build")
def data_build(
    rosdistro: Annotated[
        Path, typer.Argument(help="Clone of the rosdistro git repository with its tags, bare or not.")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder to write the snapshot to.")],
    work: Annotated[
        Path | None, typer.Option(help="Folder for intermediate results; the next run continues from it.")
    ] = None,
    meta_ros: Annotated[
        Path | None, typer.Option(help="Clone of ros/meta-ros, for the dependencies of released packages.")
    ] = None,
) -> None:
    """Rebuild the snapshot from git repositories."""
    from . import data as command

    raise typer.Exit(command.data_build(rosdistro, output, work, meta_ros))


@data_app.command("update")
def data_update() -> None:
    """Update the snapshot over the network, with the rosdistro library."""
    from . import data as command

    raise typer.Exit(command.data_update())


def _version(value: bool) -> None:
    if value:
        from ...edges.version import __version__

        write(f"rosimpact {__version__}")
        raise typer.Exit()


@app.callback()
def root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


def _names(values: list[str] | None) -> tuple[str, ...]:
    return tuple(name.strip() for value in values or () for name in value.split(",") if name.strip())


_UsageError: Any = typer.BadParameter.__mro__[2]
"""What is wrong with the arguments; where it is to be imported from differs between versions of typer."""


def _print_usage_error(error: Any) -> None:
    """Prints what is wrong with the arguments, which are shown on one line: in CI they may hold names of branches."""
    context = getattr(error, "ctx", None)
    if context is None or error.message != context.get_help():
        error.message = visible(error.message)
    text = io.StringIO()
    error.show(file=text)
    if sys.stderr is not None:
        with suppress(UserError, OSError):
            write(text.getvalue(), sys.stderr)


@cache
def _select_command(name: str) -> typer.Typer:
    """The app with nothing but the command or group of this name, all of it where there is none: Typer builds whatever
    it is given, and building everything takes longer than many a command."""
    selected = copy(app)
    selected.registered_commands = [c for c in app.registered_commands if c.callback and c.callback.__name__ == name]
    selected.registered_groups = [group for group in app.registered_groups if group.name == name]
    return selected if selected.registered_commands or selected.registered_groups else app


def main() -> None:
    """Entry point."""
    hold_streams()
    if not sys.warnoptions:
        # Those of Python quote what it parses, which is the workspace's.
        warnings.simplefilter("ignore")
    for argument in sys.argv[1:]:
        if "\0" in argument:
            # No shell can pass one; who calls from Python can, and the system's calls would end in a ValueError.
            say(f"rosimpact: {argument!r}: contains a null byte, which no path or name can contain; remove it")
            raise SystemExit(2)
    # What a command reads it keeps, and there are no cycles in it: looking for some often costs a tenth of the time.
    gc.set_threshold(200_000, 20, 100)
    try:
        raise SystemExit(_select_command("".join(sys.argv[1:2]))(standalone_mode=False))
    except _UsageError as error:
        _print_usage_error(error)
        raise SystemExit(error.exit_code) from None
    except typer.Abort:
        say("rosimpact: aborted")
        raise SystemExit(1) from None
    except BrokenPipeError:
        # Whoever read has read enough.
        raise SystemExit(0) from None
    except UserError as error:
        say(f"rosimpact: {error}")
        raise SystemExit(2) from None
    except OSError as error:
        # The commands tell of their own; what is left is help that cannot be printed.
        raise SystemExit(output_failed(error)) from None
