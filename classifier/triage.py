"""Triage: one report, or a stream of them, to a label, its reasons, reports like it, and the check to run."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

from ..corpus.distros import DISTROS, ROS2
from ..edges.console import escape_json, visible, write_json
from .model import ClassifierError, Known, Model, Reason, Verdict, load
from .reading import read

GITHUB_API = "ROSIMPACT_GITHUB_API"
STACK_API = "ROSIMPACT_STACK_EXCHANGE_API"
"""Environment variables that name other servers than the public ones."""

CHECKS: dict[str, tuple[tuple[str, str], ...]] = {
    "library-update": (("check", "rosimpact check{targets}"),),
    "dependency": (("check", "rosimpact check{targets}"),),
    "inconsistency": (("values", "rosimpact values"), ("graph", "rosimpact graph")),
    "message-logic": (("logic", "rosimpact logic"),),
    "other": (),
}
"""By label, what looks into such a report: the command it needs, and how it is called. Only what exists is named."""

_ISSUE = re.compile(r"/([\w.-]+)/([\w.-]+)/(?:issues|pull)/(\d+)(?:/.*)?\Z")
_QUESTION = re.compile(r"/(?:questions|q)/(\d+)(?:/.*)?\Z")
_DISTRO = re.compile(rf"\b(?:{'|'.join(DISTROS)})\b", re.IGNORECASE)
_TARGETED = ("kinetic", "lunar", "melodic", "noetic", *ROS2)
_ADDRESS = re.compile(r"https?://\S+\Z")
_BARE_ADDRESS = re.compile(r"(?:www\.)?(?:github\.com|[\w.]*stackexchange\.com|answers\.ros\.org)/\S+\Z")
_TIMEOUT = 20.0
_PATIENCE = 15.0
_TRIES = 3


class Post(NamedTuple):
    """A report as it came in."""

    id: str
    title: str
    body: str


class Triage(NamedTuple):
    """What is said of a report. checks: commands to run next, those that exist."""

    id: str
    verdict: Verdict
    reasons: list[Reason]
    nearest: list[Known]
    checks: list[str]


def triage(model: Model, post: Post, commands: Collection[str]) -> Triage:
    """Judges a report. commands: those that the command line has."""
    reading = read(post.title, post.body)
    verdict = model.verdict(reading)
    return Triage(
        post.id,
        verdict,
        model.reasons(reading, verdict.label),
        model.nearest(reading),
        checks(verdict.label, post, commands),
    )


def suggest(title: str, body: str) -> tuple[str, dict[str, float]]:
    """The likeliest label of a report and the probability of each, by the shipped model. Raises ClassifierError."""
    verdict = _shipped().verdict(read(title, body))
    return verdict.label, verdict.probabilities


@cache
def _shipped() -> Model:
    return load()


def checks(label: str, post: Post, commands: Collection[str]) -> list[str]:
    """The commands that look into a report of this label, with the distros it names as targets."""
    named = dict.fromkeys(name.lower() for name in _DISTRO.findall(f"{post.title}\n{post.body}"))
    targets = "".join(f" --target {name}" for name in named if name in _TARGETED)
    return [call.format(targets=targets) for command, call in CHECKS.get(label, ()) if command in commands]


def as_json(found: Triage) -> str:
    """One JSON object with all there is to say."""
    verdict = found.verdict
    return json.dumps(
        {
            "id": found.id,
            "label": verdict.label,
            "probabilities": {label: round(chance, 6) for label, chance in verdict.probabilities.items()},
            "abstained": verdict.abstained,
            "reasons": [reason._replace(weight=round(reason.weight, 4))._asdict() for reason in found.reasons],
            "nearest": [known._replace(likeness=round(known.likeness, 4))._asdict() for known in found.nearest],
            "run": found.checks,
        },
        ensure_ascii=False,
    )


def as_text(found: Triage) -> str:
    """The same for people."""
    verdict = found.verdict
    sure = f"{100 * verdict.probabilities[verdict.label]:.0f} %"
    if verdict.abstained:
        lines = [f"unsure: {verdict.label} at {sure} is the likeliest; a person should read it"]
    else:
        lines = [f"{verdict.label} ({sure})"]
    order = sorted(verdict.probabilities.items(), key=lambda item: -item[1])
    lines.append("  " + ", ".join(f"{label} {100 * chance:.0f} %" for label, chance in order))
    if found.reasons:
        lines += ["", f"what spoke for {verdict.label}:"]
        lines += [f"  {reason.where:5s} {reason.what}  +{reason.weight:.2f}" for reason in found.reasons]
    if found.nearest:
        lines += ["", "known reports like it:"]
        lines += [f"  {known.likeness:.2f} {known.label:15s} {known.url or known.id}" for known in found.nearest]
    lines.append("")
    if found.checks:
        lines += ["run next:", *(f"  {call}" for call in found.checks)]
    elif verdict.label == "other":
        lines.append("no check looks into reports of this label")
    else:
        lines.append(f"no command of this version looks into reports of the label {verdict.label} yet")
    return "\n".join(map(visible, lines)) + "\n"


def row(model: Model, post: Post) -> str:
    """A line of the stream: id, label, probabilities, abstained."""
    verdict = model.verdict(read(post.title, post.body))
    chances = {label: round(chance, 6) for label, chance in verdict.probabilities.items()}
    answer = {"id": post.id, "label": verdict.label, "probabilities": chances, "abstained": verdict.abstained}
    return json.dumps(answer, ensure_ascii=False)


def posts(lines: Iterable[str], name: str) -> Iterator[Post]:
    """The reports of JSON Lines with `id`, `title` and `body`. name: of the file. Raises ClassifierError."""
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        post = post_of(line)
        if post is None:
            raise ClassifierError(f"{name}:{number}: is no JSON object with `title` or `body` as texts; mend the line")
        yield post


def post_of(line: str) -> Post | None:
    """A report from a line of JSON; None when it is none."""
    try:
        value = json.loads(line)
    except (ValueError, RecursionError):
        return None
    if not isinstance(value, dict) or not ({"title", "body"} & value.keys()):
        return None
    title, body, id = value.get("title"), value.get("body"), value.get("id", "")
    if not isinstance(title, str | None) or not isinstance(body, str | None) or not isinstance(id, str | int):
        return None
    return Post(str(id), title or "", body or "")


def from_text(text: str, id: str = "") -> Post:
    """A report from plain text: its first line is the title."""
    title, _, body = text.strip().partition("\n")
    return Post(id, title.lstrip("# ").strip(), body.strip())


def is_address(text: str) -> bool:
    """Whether an argument is the address of a page rather than a report or a file."""
    return bool(_ADDRESS.match(text))


def fetch(url: str) -> Post:
    """A GitHub issue or pull request, or a question of Stack Exchange. Raises ClassifierError."""
    from ..corpus.polite import Client
    from ..corpus.report import CorpusError
    from ..corpus.sources import github, stack_exchange
    from ..corpus.tokens import github_token, stack_exchange_key

    place = urlsplit(url)
    host = (place.hostname or "").removeprefix("www.")
    issue = _ISSUE.match(place.path.rstrip("/"))
    question = _QUESTION.match(place.path.rstrip("/"))
    if host == "answers.ros.org":
        raise ClassifierError(
            f"{url}: answers.ros.org is gone; give the question's address on robotics.stackexchange.com, or its text"
        )

    def client(service: str, secret: str) -> Client:
        return Client(service, patience=_PATIENCE, timeout=_TIMEOUT, tries=_TRIES, secrets=(secret,))

    try:
        if issue and "stackexchange" not in host:
            owner, name, number = issue.groups()
            api = os.environ.get(GITHUB_API) or github.API
            token = github_token(api)
            server = github.GitHub(client("GitHub", token), api, token)
            (asked,) = server.ask([(f"{owner}/{name}#{number}", "")])
        elif question and host.endswith(".stackexchange.com"):
            api = os.environ.get(STACK_API) or stack_exchange.API
            key = stack_exchange_key(api)
            site = host.split(".")[0]
            server = stack_exchange.StackExchange(client("Stack Exchange", key), api, key, site)
            (asked,) = server.ask([(f"{site}:{question.group(1)}", "")])
        else:
            raise ClassifierError(
                f"{url}: is no issue, pull request or question that can be fetched; give one of GitHub or "
                "robotics.stackexchange.com, or the text itself"
            )
    except CorpusError as error:
        raise ClassifierError(
            f"{url}: {str(error).partition(';')[0]}; try again later, or give the text itself"
        ) from None
    if asked.gathered is None:
        raise ClassifierError(
            f"{url}: is not there, or not public; check the address, set GITHUB_TOKEN, or give the text itself"
        )
    report = asked.gathered.report
    return Post(report.id, report.title, report.body)


def from_argument(argument: str) -> Post | Path | None:
    """What an argument of the command line means: a report, a file to read, or None for standard input."""
    if argument == "-":
        return None
    if is_address(argument):
        return fetch(argument)
    if _BARE_ADDRESS.match(argument):
        return fetch(f"https://{argument}")
    try:
        path = Path(argument)
        if path.is_file():
            return path
        folder = bool(argument.strip()) and path.is_dir()
    except (OSError, ValueError):
        folder = False
    if folder:
        raise ClassifierError(f"{argument}: is a folder; give a file, an address or a text")
    if re.fullmatch(r"\S+\.(?:jsonl?|md|txt)", argument):
        raise ClassifierError(f"{argument}: there is no such file; give an existing one, an address or a text")
    return from_text(argument)


def triage_all(model: Model, lines: Iterable[str], name: str) -> None:
    """JSON Lines to JSON Lines on standard output, each written as soon as it is known."""
    for post in posts(lines, name):
        write_json(escape_json(row(model, post)))
