"""The command line: options and help; each command imports what it needs when it runs."""

# Typer reads what options are from the defaults of arguments.
# ruff: noqa: B008

import gc
import io
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from copy import copy
from functools import cache, wraps
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import typer

from ...classifier.cli import app as classifier_app
from ...classifier.cli import suggest_label, triage
from ...corpus.cli import app as corpus_app
from ...corpus.cli import set_suggester
from ...edges.console import UserError, escape, hold_streams, report_output_failure, say, write
from .dev import app as dev_app

app = typer.Typer(
    name="rosimpact",
    help="Know what a change breaks in a ROS workspace, and for whom, before you merge it.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _group(name: str, help: str) -> typer.Typer:
    """A group of commands, which those below are added to."""
    group = typer.Typer(help=help, no_args_is_help=True, rich_markup_mode=None)
    app.add_typer(group, name=name)
    return group


env_app = _group("env", "Machines: capture this machine as a target, compare two machines.")
surface_app = _group("surface", "What versions of packages offer, and what changed between them.")
msg_app = _group("msg", "Message definitions: write lighter ones.")
data_app = _group("data", "The shipped distro data: show its date, rebuild it, update it.")
app.add_typer(corpus_app, name="corpus")
set_suggester(suggest_label)
app.add_typer(classifier_app, name="classifier")
app.command()(triage)
measure_app = _group("measure", "Experiments on running nodes: what messages cost on a link.")
study_app = _group("study", "The study: its notebooks, run anew.")
app.add_typer(dev_app, name="dev", hidden=True)


def _make_option(help: str, *names: str, default: Any = None, **further: Any) -> Any:
    """An option of a command. names: as they are typed, where that is not the name of the argument."""
    return typer.Option(default, *names, help=help, **further)


def _make_argument(help: str, *, default: Any = None, **further: Any) -> Any:
    """An argument of a command."""
    return typer.Argument(default, help=help, **further)


def _make_schema_option(report: str) -> Any:
    """The option that prints the JSON schema of a report. report: its module."""

    def show(value: bool) -> None:
        if value:
            from .output import print_answer

            print_answer(import_module(f"...report.{report}", __name__).render_schema(), "json")
            raise typer.Exit()

    return _make_option(
        "Print the JSON schema of --format json.", "--schema", default=False, callback=show, is_eager=True
    )


def _refuse_empty(context: typer.Context, parameter: typer.CallbackParam, value: Any) -> Any:
    """The value of an option for a revision. One that is empty was a variable without a value, and would be taken for
    an option that was not given. Raises BadParameter."""
    source = context.get_parameter_source(parameter.name or "")
    if source is not None and source.name == "COMMANDLINE" and not all([value] if isinstance(value, str) else value):
        raise typer.BadParameter("is empty; give a revision, or leave the option out")
    return value


_Workspace = Annotated[Path, typer.Argument(help="Workspace, package or git repository.")]
_Revision = Annotated[
    str, typer.Option(help="Read this git revision instead of the files on disk.", callback=_refuse_empty)
]
_Output = Annotated[Path | None, typer.Option("--output", "-o", help="Write the report to this file.")]
_Config = Annotated[Path | None, typer.Option(help="Another rosimpact.toml.")]
_FollowLinks = Annotated[
    bool,
    typer.Option(
        "--follow-links",
        help="Follow links that lead out of the workspace. Do not use it on workspaces that you do not trust.",
    ),
]
_FailOn = Annotated[
    str, typer.Option(help="Lowest severity that gives exit status 1: error (the default), warning, note, never.")
]
_Jobs = Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="Number of processes for parsing.")]
_Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")]
_AssumeClosed = Annotated[
    list[str],
    typer.Option(
        "--assume-closed",
        help="Nobody outside of this workspace subscribes to this topic; `*` matches any text. May be repeated.",
    ),
]
_SizeLength = Annotated[
    int, typer.Option("--length", min=0, help="Elements of strings and arrays, for the sizes that are shown.")
]

# Options whose values may hold commas; others that may be repeated take several names at once.
_WITH_COMMAS = frozenset(("target", "base", "set_", "names", "launch"))


def _add_command(group: typer.Typer, name: str | None = None) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Registers a command, whose function holds its options and help alone. What they are given goes to the function of
    the same name in the module of the command, or of its group, which is imported when it runs."""

    def register(options: Callable[..., None]) -> Callable[..., None]:
        @wraps(options)
        def run(**given: Any) -> None:
            given.pop("schema", None)
            for key, kind in get_type_hints(options).items():
                if kind == list[str]:
                    given[key] = tuple(given[key] or ()) if key in _WITH_COMMAS else _split_names(given[key])
            module = import_module(f".{options.__name__.partition('_')[0]}", __package__)
            raise typer.Exit(getattr(module, options.__name__)(**given))

        return group.command(name)(run)

    return register


@_add_command(app)
def check(
    path: _Workspace = Path("."),
    target: list[str] = _make_option(
        "jazzy, humble@2024-03-01, envs/laptop.json, a name of rosimpact.toml, robot.dpkg.txt, "
        "docker:ros:humble. May be repeated.",
        "--target",
        "-t",
    ),
    format: str = _make_option("One of text, json, sarif, github, markdown, html.", "--format", "-f", default="text"),
    output: _Output = None,
    rev: str = _make_option(
        "Check this git revision instead of the files on disk.", default="", callback=_refuse_empty
    ),
    base: list[str] = _make_option(
        "Compare with the merge base of this revision (PATH=REV for one repository, or a pinned .repos file): only "
        "new findings fail.",
        callback=_refuse_empty,
    ),
    install: Path | None = _make_option(
        "Also check the built files of this install space (or devel space, or prefix of a package) for shared "
        "libraries that are missing, here or on a target."
    ),
    select: list[str] = _make_option("Only these rules or families. May be repeated or comma-separated."),
    ignore: list[str] = _make_option("Skip these rules or families."),
    fail_on: _FailOn = "",
    notes: bool = _make_option("Also show notes in the text report.", "--notes", default=False),
    preview: bool = _make_option("Also run rules whose precision is not measured yet.", "--preview", default=False),
    baseline: Path | None = _make_option("Leave out findings that this file contains."),
    write_baseline: Path | None = _make_option("Write all current findings to this file, and exit with 0."),
    prune_baseline: bool = _make_option(
        "Remove fixed findings from the file given with --baseline; ask for the targets that it was written with.",
        "--prune-baseline",
        default=False,
    ),
    fix: bool = _make_option(
        "Apply fixes that are correct on all targets, and report what remains.", "--fix", default=False
    ),
    diff: bool = _make_option("Print what --fix would change; change nothing.", "--diff", default=False),
    config: _Config = None,
    follow_links: _FollowLinks = False,
    jobs: _Jobs = None,
    quiet: _Quiet = False,
    schema: bool = _make_schema_option("json"),
) -> None:
    """Report what breaks, on which machine, where, and what to do.

    Exit status: 0 nothing at or above --fail-on, 1 findings, 2 the tool failed or analysed nothing.
    """


@_add_command(app)
def upgrade(
    from_: str = _make_option("The current target, in any form that --target accepts.", "--from", default=...),
    to: str = _make_option("The new target.", "--to", default=...),
    path: _Workspace = Path("."),
    packages: list[str] = _make_option("Only these packages."),
    rev: _Revision = "",
    config: _Config = None,
    follow_links: _FollowLinks = False,
    format: str = _make_option("One of text, json, html.", "--format", "-f", default="text"),
    output: _Output = None,
    fail_on: _FailOn = "",
    schema: bool = _make_schema_option("upgrade"),
    jobs: _Jobs = None,
    quiet: _Quiet = False,
) -> None:
    """List what breaks when you move from one target to another, package by package in build order.

    Exit status: 0 no new finding at or above --fail-on, 1 something breaks, 2 the tool failed.
    """


@_add_command(app)
def why(
    name: str = _make_argument("A header, package, rosdep key, CMake name, Python module or executable.", default=...),
    path: Path | None = _make_argument(
        "Workspace whose uses are shown; default: the current folder, if it is a workspace.", show_default=False
    ),
    target: list[str] = _make_option("As for check.", "--target", "-t"),
    follow_links: _FollowLinks = False,
    format: str = _make_option("text or json.", "--format", "-f", default="text"),
) -> None:
    """Show which package provides a name on a target, since when, and what uses it in the workspace."""


@_add_command(app)
def graph(
    path: _Workspace = Path("."),
    launch: list[str] = _make_option(
        "Only what this launch file starts, with the names that it assigns; its arguments may follow in the same "
        "quotes: 'robot.launch.py sim:=true'. May be repeated: then what all of them start together."
    ),
    set_: list[str] = _make_option(
        "An argument of all launch files that declare it, NAME:=VALUE. May be repeated.", "--set"
    ),
    system: str = _make_option("Only what the launch files of [systems.NAME] in rosimpact.toml start.", default=""),
    code: bool = _make_option(
        "All programs, with the names that the code gives them, as if no launch file started them.",
        "--code",
        default=False,
    ),
    node: list[str] = _make_option("Only this node and its neighbours; `*` matches any text."),
    topic: list[str] = _make_option("Only this topic, service or action, and the nodes that use it."),
    package: list[str] = _make_option("Only nodes of this package."),
    around: str = _make_option("Only what is near this node or topic.", default=""),
    hops: int = _make_option("With --around: the number of steps from node to node.", default=2, min=1),
    rev: _Revision = "",
    base: list[str] = _make_option(
        "Mark what was added, removed and changed since this revision, as for check.", callback=_refuse_empty
    ),
    strict: bool = _make_option(
        "Exit with 1 where names or types are not known, or names in part only; their places go to standard error.",
        "--strict",
        default=False,
    ),
    config: _Config = None,
    observed: Path | None = _make_option(
        "Compare a running system with the sources: the output of `ros2 node info` or `rosnode info`, a dump in JSON "
        "or YAML, or a bag (.bag, .mcap, .db3, metadata.yaml)."
    ),
    follow_links: _FollowLinks = False,
    format: str = _make_option(
        "One of text, json, graphml, dot, mermaid, html, nodl (the interface of each node, as .nodl.yaml).",
        "--format",
        "-f",
        default="text",
    ),
    output: Path | None = _make_option(
        "Write the graph to this file; with nodl, PACKAGE/PROGRAM.nodl.yaml for each node to this folder.",
        "--output",
        "-o",
    ),
    all: bool = _make_option(
        "Also show hidden names, whole conditions and everything that was not resolved.", "--all", default=False
    ),
    editor: str = _make_option(
        "With --format html: the address that opens a place in the editor, with {path} and {line}; `off` for no links.",
        default="vscode://file/{path}:{line}",
    ),
    schema: bool = _make_schema_option("graph.json"),
    jobs: _Jobs = None,
    quiet: _Quiet = False,
) -> None:
    """Show which nodes are connected by topics, services and actions, without building or running anything.

    Exit status: 0 done, 1 with --strict where not all names are known, or with --observed if the system differs from
    the sources, 2 the tool failed.
    """


@_add_command(app)
def impact(
    path: _Workspace = Path("."),
    base: list[str] = _make_option(
        "What changed since the merge base of this revision (PATH=REV for one repository, or a pinned .repos file).",
        callback=_refuse_empty,
    ),
    rev: _Revision = "",
    package: list[str] = _make_option("Only changes in this package. May be repeated."),
    topic: list[str] = _make_option("Only what goes through this topic; `*` matches any text."),
    node: list[str] = _make_option("Only changes in this node, or that affect it; `*` matches any text."),
    follow_links: _FollowLinks = False,
    format: str = _make_option("One of text, json, markdown.", "--format", "-f", default="text"),
    output: _Output = None,
    all: bool = _make_option("List every affected node and all unresolved calls.", "--all", default=False),
    schema: bool = _make_schema_option("impact"),
    jobs: _Jobs = None,
    quiet: _Quiet = False,
) -> None:
    """Show which nodes are affected by changes since a base: of messages, topics, publish conditions, callbacks, launch
    files and parameters."""


@_add_command(app)
def logic(
    repository: Path = _make_argument("Git repository, bare or not, or a folder in one.", default=Path(".")),
    range: str = _make_option("Commits A..B, or all up to B; default: all up to HEAD.", default=""),
    commits: int | None = _make_option("Only this many of the newest commits.", min=1),
    since: str = _make_option("Only commits since this day, such as 2024-03-01.", default=""),
    package: list[str] = _make_option("Only this package. May be repeated."),
    topic: list[str] = _make_option("Only this topic. May be repeated."),
    all: bool = _make_option("Also list conditions that were only reworded.", "--all", default=False),
    format: str = _make_option("text, json or html (a timeline).", "--format", "-f", default="text"),
    output: _Output = None,
    jobs: int | None = _make_option("Number of processes.", "--jobs", "-j", min=1),
    quiet: _Quiet = False,
) -> None:
    """List the commits that changed when messages are published: which condition or trigger, and whom it affects."""


@_add_command(app)
def fields(
    path: Path | None = _make_argument(
        "Workspace; default: the current folder. With --bag, its message definitions are used where the bag has none.",
        show_default=False,
    ),
    bag: Path | None = _make_option(
        "Read this recording: a .bag file of ROS 1; a folder, .mcap or .db3 file of ROS 2. Needs `rosimpact[bags]`."
    ),
    topic: list[str] = _make_option("Only this topic; `*` matches any text. May be repeated or comma-separated."),
    limit: int | None = _make_option("With --bag: only so many messages, the first ones.", min=1),
    assume_closed: _AssumeClosed = [],  # noqa: B006
    length: _SizeLength = 10,
    rev: _Revision = "",
    config: _Config = None,
    follow_links: _FollowLinks = False,
    format: str = _make_option("text or json.", "--format", "-f", default="text"),
    output: _Output = None,
    all: bool = _make_option("Name every field with its place, and every reason.", "--all", default=False),
    jobs: _Jobs = None,
    quiet: _Quiet = False,
) -> None:
    """Show which fields of each topic its subscribers read and its publishers set, by reading the sources; with --bag,
    the size and rate of the messages of a recording instead, and what each field takes of it."""


@_add_command(app)
def values(
    path: _Workspace = Path("."),
    file: Path | None = _make_argument("With `replay` as the workspace: a file of witnesses.", show_default=False),
    node: list[str] = _make_option("Only callbacks of this node. May be repeated."),
    topic: list[str] = _make_option("Only callbacks of this topic. May be repeated."),
    callback: list[str] = _make_option("Only this callback, by its name or the end of it. May be repeated."),
    kind: list[str] = _make_option(
        "Kinds of callbacks: subscriber, service, timer, action, main [default: subscriber]. May be repeated."
    ),
    text: int = _make_option("Bytes of a text at most.", default=8, min=0, max=64),
    array: int = _make_option("Elements of an array at most.", default=3, min=0, max=64),
    loops: int = _make_option("Rounds of a loop at most.", default=8, min=1),
    seconds: float = _make_option("Time for each callback.", default=20.0, min=0.1),
    compiling: float = _make_option(
        "Seconds of the processor for compiling a C++ source with all that it calls.", default=60.0, min=1.0
    ),
    replay: bool = _make_option(
        "Run every example for real: compiles and runs code of the workspace, in processes of their own with limits.",
        "--replay",
        default=False,
    ),
    fuzz: float = _make_option("Seconds for which each C++ callback is fuzzed besides.", default=0.0, min=0.0),
    emit: str = _make_option("Write to --out: klee, tests, yaml (commands that send) or witnesses.", default=""),
    out: Path | None = _make_option("Folder for --emit."),
    workspace: Path = _make_option("With `values replay FILE`: the workspace.", default=Path(".")),
    publishers: bool = _make_option(
        "Explore also what publishes the messages, and compare.", "--publishers/--no-publishers", default=True
    ),
    base: list[str] = _make_option(
        "What is handled, ignored, crashes or is sent otherwise than at the merge base of this revision (PATH=REV for "
        "one repository, or a pinned .repos file).",
    ),
    follow_links: _FollowLinks = False,
    format: str = _make_option("text or json.", "--format", "-f", default="text"),
    output: _Output = None,
    all: bool = _make_option("Show every field, example and reason.", "--all", default=False),
    jobs: _Jobs = None,
    quiet: _Quiet = False,
) -> None:
    """Show for which values of a message callbacks act, do nothing, only log or crash, each with an example, and which
    of these values publishers send. C++ callbacks need clang 15 or newer; nothing of the workspace runs without
    --replay or --fuzz."""


@_add_command(app)
def prune(
    path: _Workspace = Path("."),
    topic: list[str] = _make_option("Only this topic. May be repeated."),
    assume_closed: _AssumeClosed = [],  # noqa: B006
    apply: bool = _make_option("Write the changes to the workspace.", "--apply", default=False),
    out: Path | None = _make_option("Write a changed copy of the workspace to this folder."),
    undo: bool = _make_option("Take back what --apply wrote.", "--undo", default=False),
    verify: bool = _make_option(
        "Build the workspace as it is and pruned, and with --run compare what both do (ROS 1 with catkin).",
        "--verify",
        default=False,
    ),
    run: list[str] = _make_option(
        "With --verify: start this, 'PACKAGE/PROGRAM ARGUMENTS' or a command of the shell such as 'rosbag play a.bag' "
        "or 'roslaunch a.launch'. May be repeated."
    ),
    seconds: float = _make_option(
        "With --verify: how long both run. With --measure: measured seconds of each run.", default=10.0, min=1.0
    ),
    keep_builds: Path | None = _make_option("With --verify: a folder for both versions.", "--keep-builds"),
    measure: bool = _make_option(
        "Send each topic's whole and lighter message over a link, as `measure network` does, and say what the plan "
        "gains.",
        "--measure",
        default=False,
    ),
    bag: Path | None = _make_option(
        "Say what the plan saves in a second in this bag. With --measure: send its messages; without one they are "
        "filled as the publishers fill them."
    ),
    rate: float | None = _make_option(
        "Messages per second, for what the plan saves. Default: as in the bag; with --measure, else 50.", min=0.001
    ),
    repeat: int | None = _make_option("With --measure: repetitions; intervals are over them [default: 3].", min=1),
    nodes: str = _make_option(
        "With --measure: roscpp, rospy or dds; default: roscpp for ROS 1, dds for ROS 2.", default=""
    ),
    link: str = _make_option("With --measure: rate of each link, such as 54mbit [default: 100mbit].", default=""),
    loopback: bool = _make_option("With --measure: no link, which needs no root.", "--loopback", default=False),
    results: Path | None = _make_option("With --measure: a folder for the results, which a later run continues."),
    length: _SizeLength = 10,
    config: _Config = None,
    follow_links: _FollowLinks = False,
    format: str = _make_option("One of text, json, patch.", "--format", "-f", default="text"),
    output: _Output = None,
    all: bool = _make_option("Name every field that is dropped.", "--all", default=False),
    jobs: _Jobs = None,
    quiet: _Quiet = False,
) -> None:
    """Give topics lighter messages, without the fields that nobody reads: show the plan, or write it.

    Exit status: 0 done, 1 with --verify where both versions differ, 2 the tool failed.
    """


@_add_command(app)
def explain(
    rule: str | None = _make_argument("Name of a rule, group or family; default: list all rules."),
) -> None:
    """Explain what a rule does, why it matters, and how to fix its findings."""


@_add_command(env_app, "capture")
def env_capture(
    output: Path | None = _make_option("File to write; default: standard output.", "--output", "-o"),
) -> None:
    """Write this machine as a target."""


@_add_command(env_app, "diff")
def env_diff(
    first: str = _make_argument("A target, in any form that --target accepts.", default=...),
    second: str = _make_argument("Another target.", default=...),
    path: Path | None = _make_argument("A workspace: show which differences matter to it."),
    format: str = _make_option("text or json.", "--format", "-f", default="text"),
    output: Path | None = _make_option("Write to this file.", "--output", "-o"),
    schema: bool = _make_schema_option("machines"),
) -> None:
    """Show the differences between two machines; with a workspace, also what breaks on only one of them."""


_REPOS_HELP = "Folder of git clones with their tags, called OWNER+NAME or NAME."
_REPOS_OR_SHIPPED = f"{_REPOS_HELP} Default: the shipped data."


@_add_command(surface_app, "show")
def surface_show(
    package: str = _make_argument(
        "PACKAGE, PACKAGE@28.1.0, PACKAGE@jazzy, PACKAGE@jazzy@2024-08-01 or PACKAGE@/opt/ros/jazzy.", default=...
    ),
    repos: Path | None = _make_option(_REPOS_OR_SHIPPED),
    all: bool = _make_option("Also show members of classes, constants and macros.", "--all", default=False),
    format: str = _make_option("One of text, json, markdown.", "--format", "-f", default="text"),
    output: Path | None = _make_option("Write to this file.", "--output", "-o"),
    jobs: _Jobs = None,
) -> None:
    """Show what a version of a package offers: headers, names, messages, targets, programs."""


@_add_command(surface_app, "diff")
def surface_diff(
    what: str = _make_argument("A package, or the path of a clone (then without --repos).", default=...),
    old: str = _make_argument(
        "A version, a distro, an installed prefix or a .deb; for a clone, a revision.", default=...
    ),
    new: str = _make_argument("The version to compare with, in the same forms.", default=...),
    repos: Path | None = _make_option(_REPOS_OR_SHIPPED),
    packages: list[str] = _make_option("For a clone: only these packages."),
    all: bool = _make_option("Also list additions, and changes that do not break builds.", "--all", default=False),
    format: str = _make_option("One of text, json, markdown.", "--format", "-f", default="text"),
    output: Path | None = _make_option("Write to this file.", "--output", "-o"),
    jobs: _Jobs = None,
) -> None:
    """Show what changed between two versions: removed, moved and deprecated names, and changed signatures."""


@_add_command(surface_app, "build")
def surface_build(
    distro: list[str] = _make_option("Read the packages of this distro. May be repeated.", default=...),
    output: Path = _make_option("File to write, such as surfaces.sqlite.", "--output", "-o", default=...),
    repos: Path = _make_option(_REPOS_HELP, default=Path(".")),
    packages: list[str] = _make_option("Only these packages."),
    all_versions: bool = _make_option(
        "Read all versions that the distros ever had, not only the current ones.", "--all-versions", default=False
    ),
    onto: Path | None = _make_option("Also write what this file has of packages, where clones have no more versions."),
    jobs: int | None = _make_option("Number of processes.", "--jobs", "-j", min=1),
    dask: str | None = _make_option("Use the cluster of this Dask scheduler, such as tcp://host:8786."),
    quiet: _Quiet = False,
) -> None:
    """Write what the released versions of packages offer to a file. A stopped run continues the next time."""


@_add_command(msg_app, "light")
def msg_light(
    file: Path = _make_argument("The definition, a .msg file.", default=...),
    folders: list[Path] = _make_argument(
        "Folders with the definitions of nested messages: a workspace, or the share folder of an installation. "
        "Default: the folder around the package of FILE, and the sourced environment."
    ),
    keep: list[str] = _make_option(
        "Fields to keep, such as header.stamp,pose.pose.position; of an array of messages, points.x keeps x of each "
        "element. May be repeated or comma-separated.",
        default=...,
    ),
    name: str = _make_option("Name of the lighter message; default: that of FILE with `Light` behind it.", default=""),
    format: str = _make_option("text (the files themselves) or json.", "--format", "-f", default="text"),
    output: Path | None = _make_option(
        "Write a file for each definition to this folder; with json, the report to this file.", "--output", "-o"
    ),
) -> None:
    """Write a lighter message definition that has only some of the fields; nested messages become lighter ones too."""


@_add_command(data_app, "status")
def data_status(
    format: str = _make_option("text or json.", "--format", "-f", default="text"),
) -> None:
    """Show the age and the sources of the distro data."""


@_add_command(data_app, "build")
def data_build(
    sources: Path = _make_argument(
        "TOML file that names the sources of all tables; or a clone of rosdistro, for the snapshot alone.",
        default=...,
    ),
    output: Path = _make_option("Data folder to write to.", "--output", "-o", default=...),
    work: Path | None = _make_option("Folder for intermediate results; the next run continues from it."),
    meta_ros: Path | None = _make_option("Beside a clone of rosdistro: one of ros/meta-ros, for dependencies."),
    step: list[str] = _make_option("Build this table alone; can be given several times."),
    again: list[str] = _make_option("Build this table though it was built already."),
) -> None:
    """Rebuild the shipped data from git repositories, package indices and compilers.

    Exit status: 0 built, 2 a table could not be built.
    """


@_add_command(data_app, "update")
def data_update(
    from_: str = _make_option(
        "Take all tables from here: a folder that `data build` made, an archive of one (.tar.zst, .tar.gz, .zip), or "
        "its http(s) address.",
        "--from",
        default="",
    ),
    shipped: bool = _make_option("Remove what updates made, and use the shipped data.", "--shipped", default=False),
) -> None:
    """Update the snapshot over the network, with the rosdistro library; or all tables, with --from.

    Exit status: 0 updated, 2 not updated; the data in use stay.
    """


_Publishers = Annotated[list[str], typer.Option(help="Numbers of publishers of one topic [default: 1,5].")]
_Fields = Annotated[list[str], typer.Option(help="Numbers of fields of the whole message [default: 25,50,100].")]
_Rates = Annotated[list[str], typer.Option(help="Messages per second of each publisher [default: 50,100,200].")]
_FieldBytes = Annotated[int, typer.Option(help="Characters in each field.")]
_Keep = Annotated[
    str,
    typer.Option(
        help="What the pruned message keeps: a number of fields, 0 for no pruned message [default: 5]; with --message, "
        "names of fields, such as header,pose.position."
    ),
]
_Queue = Annotated[int, typer.Option(help="Length of the queues of publishers and subscriber.")]
_Seconds = Annotated[float, typer.Option(help="Measured seconds of each run of a cell.")]
_WarmUp = Annotated[float, typer.Option("--warm-up", help="Seconds before them that are not counted.")]
_Repeat = Annotated[int, typer.Option(help="Repetitions of all cells; intervals are over them.")]
_CallbackMs = Annotated[float, typer.Option("--callback-ms", help="How long each callback of the subscriber takes.")]
_Message = Annotated[str, typer.Option(help="Measure this message (package/Type) of the workspace or a release.")]
_Length = Annotated[
    list[str],
    typer.Option(help="With --message: the length of an array or text, FIELD=NUMBER. May be repeated."),
]
_Bag = Annotated[Path | None, typer.Option(help="With --message: send the messages of this bag.")]
_Results = Annotated[
    Path, typer.Option("--output", "-o", help="Results, JSON Lines; what is in it already is not measured again.")
]
_Parquet = Annotated[Path | None, typer.Option(help="Also write the results to this Parquet file.")]
_CellsFormat = Annotated[str, typer.Option("--format", "-f", help="How cells are printed: text or json.")]


@_add_command(measure_app, "network")
def measure_network(
    path: _Workspace = Path("."),
    publishers: _Publishers = [],  # noqa: B006
    fields: _Fields = [],  # noqa: B006
    rates: _Rates = [],  # noqa: B006
    field_bytes: _FieldBytes = 1000,
    keep: _Keep = "",
    link: str = _make_option("Rate of each link, such as 54mbit, or none [default: 100mbit].", default=""),
    queue: _Queue = 10,
    seconds: _Seconds = 10,
    warm_up: _WarmUp = 1,
    repeat: _Repeat = 3,
    nodes: str = _make_option("Nodes to run: roscpp, rospy, dds (ROS 2's Cyclone DDS, in Python).", default="roscpp"),
    callback_ms: _CallbackMs = 0,
    loopback: bool = _make_option("No namespaces and no link: needs no root.", "--loopback", default=False),
    message: _Message = "",
    length: _Length = [],  # noqa: B006
    bag: _Bag = None,
    output: _Results = Path("network.jsonl"),
    parquet: _Parquet = None,
    format: _CellsFormat = "text",
    quiet: _Quiet = False,
) -> None:
    """Measure latency and dropped messages over size and rate, whole and pruned, between real nodes on one machine.

    Publisher, router and subscriber are three network namespaces (root); --loopback needs none. A stopped run continues
    the next time. Exit status: 0 measured, 2 the tool failed, 130 interrupted.
    """


@_add_command(measure_app, "publisher")
def measure_publisher(
    path: _Workspace = Path("."),
    nodes: str = _make_option("Nodes to run: roscpp or rospy.", default="roscpp"),
    master: str = _make_option("ROS master; default: one that is started here.", default=""),
    address: str = _make_option("Address of this machine, as the other one sees it.", default=""),
    port: int = _make_option("Port of the master that is started here.", default=11311, min=1, max=65535),
    message: _Message = "",
    keep: _Keep = "",
    length: _Length = [],  # noqa: B006
    bag: _Bag = None,
    quiet: _Quiet = False,
) -> None:
    """Serve publishers to `measure subscriber` on another machine, until Ctrl-C.

    Whoever reaches this machine can have it publish: use it in a network that you trust.
    """


@_add_command(measure_app, "subscriber")
def measure_subscriber(
    path: _Workspace = Path("."),
    master: str = _make_option("ROS master that `measure publisher` names.", default=...),
    publishers: _Publishers = [],  # noqa: B006
    fields: _Fields = [],  # noqa: B006
    rates: _Rates = [],  # noqa: B006
    field_bytes: _FieldBytes = 1000,
    keep: _Keep = "",
    queue: _Queue = 10,
    seconds: _Seconds = 10,
    warm_up: _WarmUp = 1,
    repeat: _Repeat = 3,
    nodes: str = _make_option("Nodes to run: roscpp or rospy.", default="roscpp"),
    callback_ms: _CallbackMs = 0,
    address: str = _make_option("Address of this machine, as the other one sees it.", default=""),
    message: _Message = "",
    length: _Length = [],  # noqa: B006
    bag: _Bag = None,
    output: _Results = Path("network.jsonl"),
    parquet: _Parquet = None,
    format: _CellsFormat = "text",
    quiet: _Quiet = False,
) -> None:
    """Measure as `measure network` does, with publishers on another machine."""


@_add_command(measure_app, "show")
def measure_show(
    results: Path = _make_argument("A file of results.", default=...),
    format: _CellsFormat = "text",
) -> None:
    """Print the cells of a file of results."""


@_add_command(study_app, "run")
def study_run(
    names: list[str] = _make_argument("Notebooks, such as 03_updates or 03; all by default."),
    full: bool = _make_option("From the reports' texts and all distros, not the small form.", "--full", default=False),
    reports: Path | None = _make_option("The reports' texts, JSON Lines; what reads reports needs them with --full."),
    output: Path = _make_option(
        "Folder for the executed notebooks, figures and tables.", "--output", "-o", default=Path("study")
    ),
    notebooks: Path | None = _make_option("Folder of the notebooks, outside a checkout."),
    quiet: _Quiet = False,
) -> None:
    """Run the notebooks and write their figures and tables.

    Exit status: 0 all were made, 1 a notebook failed or made not all of its figures, 2 the tool failed.
    """


@_add_command(study_app, "predict")
def study_predict(
    reports: Path = _make_option("The reports' texts, JSON Lines.", default=...),
    output: Path | None = _make_option("Folder for both files; that of the notebooks by default.", "--output", "-o"),
    quiet: _Quiet = False,
) -> None:
    """Judge every labelled report by a model that has not seen its repository, for 02_triage; ids and numbers only.

    Writes triage_predictions.jsonl and triage_beside.json. It takes some minutes.
    """


def _print_version(value: bool) -> None:
    if value:
        from ...edges.version import __version__

        write(f"rosimpact {__version__}")
        raise typer.Exit()


@app.callback()
def root(
    version: bool = _make_option(
        "Print the version.", "--version", default=False, callback=_print_version, is_eager=True
    ),
) -> None:
    pass


def _split_names(values: list[str] | None) -> tuple[str, ...]:
    return tuple(name.strip() for value in values or () for name in value.split(",") if name.strip())


_UsageError: Any = typer.BadParameter.__mro__[2]
"""What is wrong with the arguments; where it is to be imported from differs between versions of typer."""


def _print_usage_error(error: Any) -> None:
    """Prints what is wrong with the arguments, which are shown on one line: in CI they may hold names of branches."""
    context = getattr(error, "ctx", None)
    if context is None or error.message != context.get_help():
        error.message = escape(error.message)
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
    gc.set_threshold(1_000_000, 20, 100)
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
        raise SystemExit(report_output_failure(error)) from None
