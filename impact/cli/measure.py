"""rosimpact measure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...edges.console import UserError, format_count, run_command, say
from .output import check_output, print_answer, validate_choice

if TYPE_CHECKING:
    from ..measure.bench import Messages
    from ..measure.plan import NetworkPlan
    from ..measure.results import ResultsFile

_KEEP = 5


def measure_network(*, loopback: bool, link: str, **given: Any) -> int:
    """Both sides on this machine."""
    from ..measure.plan import choose_network
    from ..measure.run import run_network

    def measure(plan: NetworkPlan, messages: Messages) -> ResultsFile:
        return run_network(plan, messages, given["output"], _make_progress(given["quiet"]))

    return _run(given, lambda: choose_network(loopback, link), measure)


def measure_subscriber(*, master: str, address: str, **given: Any) -> int:
    """The subscriber, with publishers on another machine."""

    def measure(plan: NetworkPlan, messages: Messages) -> ResultsFile:
        from ..measure.machines import run_subscriber

        if plan.conditions.nodes == "dds":
            raise UserError("--nodes dds: is measured on one machine alone; give roscpp or rospy")
        return run_subscriber(plan, messages, master, address, given["output"], _make_progress(given["quiet"]))

    return _run(given, lambda: {"network": "machines", "link": 0}, measure)


def measure_publisher(
    *, path: Path, nodes: str, master: str, address: str, port: int, message: str, keep: str, length: Sequence[str],
    bag: Path | None, quiet: bool,
) -> int:  # fmt: skip
    """Publishers for a subscriber on another machine, until Ctrl-C."""

    def serve() -> int:
        from ..measure.contents import compute_digest
        from ..measure.machines import ServedMessage, serve_publishers

        validate_choice("--nodes", nodes, ("roscpp", "rospy"))
        known = None
        if message:
            messages = _make_messages(path, nodes, message, keep, length, bag)
            known = ServedMessage(message.replace("/msg/", "/"), messages, compute_digest(messages))
        serve_publishers(nodes, master, address, port, known, _make_progress(quiet))
        return 0

    return run_command(serve, "interrupted; the publishing side is closed", path)


def measure_show(results: Path, format: str) -> int:
    """The cells of a file of results."""

    def show() -> int:
        from ..measure.results import load_results

        _print(format, *load_results(results))
        return 0

    return run_command(show, "interrupted", results)


def _make_progress(quiet: bool) -> Any:
    return (lambda _: None) if quiet else say


def _run(given: dict[str, Any], get_network: Any, measure: Any) -> int:
    """Makes the plan, measures it, prints the cells and writes what else was asked for."""
    output, parquet = given["output"], given["parquet"]

    def work() -> int:
        from ..measure.plan import check_plan
        from ..measure.results import need_parquet, write_parquet

        validate_choice("--format", given["format"], ("text", "json"))
        for file in (output, parquet):
            check_output(file, given["path"])
        if parquet is not None:
            need_parquet(parquet)
        plan = _make_plan(given, get_network())
        check_plan(plan)
        plan, messages = _add_messages(plan, given)
        file = measure(plan, messages)
        if parquet is not None:
            write_parquet(parquet, file.results, plan.conditions)
        from ..measure.results import load_results

        _print(given["format"], *load_results(output))
        return 0

    told = f"interrupted; what was measured is kept in {output}, and the same command continues from there"
    return run_command(work, told, given["path"])


def _make_plan(given: dict[str, Any], network: dict[str, Any]) -> NetworkPlan:
    from ..measure.plan import NODES, Conditions, NetworkPlan, check_number, parse_numbers

    validate_choice("--nodes", given["nodes"], NODES)
    numbers = {
        "queue": int(check_number("queue", given["queue"], 1)),
        "seconds": check_number("seconds", given["seconds"], 0.1),
        "warm_up": check_number("warm-up", given["warm_up"], 0),
        "callback_ms": check_number("callback-ms", given["callback_ms"], 0),
        "field_bytes": int(check_number("field-bytes", given["field_bytes"], 1)),
        "keep": _parse_keep(given["keep"]) if not given["message"] else 0,
    }
    conditions = Conditions(nodes=given["nodes"], **numbers, **network)
    lists = {
        name: parse_numbers(name, given[name], whole=name != "rates")
        for name in ("publishers", "fields", "rates") if given[name]
    }  # fmt: skip
    return NetworkPlan(conditions=conditions, repeat=int(check_number("repeat", given["repeat"], 1)), **lists)  # pyright: ignore[reportArgumentType]


def _parse_keep(keep: str) -> int:
    if not keep:
        return _KEEP
    if not keep.isdecimal():
        raise UserError(f"--keep {keep}: is how many fields stay; the names of fields go with --message")
    return int(keep)


def _add_messages(plan: NetworkPlan, given: dict[str, Any]) -> tuple[NetworkPlan, Messages]:
    import msgspec

    from ..measure.contents import add_contents, make_synthetic_messages

    if not given["message"]:
        if given["length"] or given["bag"] is not None:
            raise UserError("--length, --bag: fill a message of the workspace; name it with --message package/Type")
        return plan, make_synthetic_messages(plan)
    if given["fields"]:
        raise UserError("--fields: is the size of synthetic messages; leave out --fields or --message")
    wanted = (given[name] for name in ("path", "nodes", "message", "keep", "length", "bag"))
    messages = _make_messages(*wanted)
    kept = _split(given["keep"])
    conditions = add_contents(plan.conditions, given["message"], kept, messages)
    return msgspec.structs.replace(plan, conditions=conditions, fields=()), messages


def _make_messages(
    path: Path, nodes: str, message: str, keep: str, lengths: Sequence[str], bag: Path | None
) -> Messages:  # fmt: skip
    from ..measure.contents import MessageFilling, make_real_messages
    from ..measure.gains import list_publishers

    publishers = list_publishers(path, message.replace("/msg/", "/")) if bag is None else ()
    filling = MessageFilling(_parse_lengths(lengths), bag, publishers=publishers)
    found = make_real_messages(message, _split(keep), path, filling, 2 if nodes == "dds" else 1)
    for note in found.notes:
        say(f"rosimpact: {message}: {note}")
    return found.messages


def _split(names: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))


def _parse_lengths(texts: Sequence[str]) -> dict[str, int]:
    found = {}
    for text in texts:
        name, equals, number = text.partition("=")
        if not equals or not number.isdecimal() or len(number) > 9:
            raise UserError(f"--length {text}: write FIELD=NUMBER, such as ranges=720")
        found[name.strip()] = int(number)
    return found


def _print(format: str, header: Any, results: Any) -> None:
    from ..measure.intervals import summarize
    from ..report.measure import render_json, render_text

    if not results:
        raise UserError(f"nothing was measured: {format_count(0, 'result')}; run `rosimpact measure network`")
    print_answer((render_json if format == "json" else render_text)(header, summarize(results)), format)
