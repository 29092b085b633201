"""Triage: one report, or a stream of them, to a label, its reasons, reports like it, and the check to run."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

from ..corpus.distros import DISTROS, ROS2
from ..edges.console import escape, escape_json, write_json
from .model import ClassifierError, KnownReport, Model, ModelVerdict, Reason, load
from .reading import read

GITHUB_API = "ROSIMPACT_GITHUB_API"
STACK_API = "ROSIMPACT_STACK_EXCHANGE_API"
"""Environment variables that name other servers than the public ones."""

CHECKS: dict[str, tuple[str, ...]] = {
    "library-update": ("rosimpact check{targets}",),
    "dependency": ("rosimpact check{targets}",),
    "inconsistency": ("rosimpact graph", "rosimpact check{targets}"),
    "message-logic": ("rosimpact logic",),
    "other": (),
}
"""By label, the commands that look into such a report."""

_ISSUE = re.compile(r"/([\w.-]+)/(?!\.{1,2}/)([\w.-]+)/(?:issues|pull)/(\d{1,12})(?:/.*)?\Z", re.ASCII)
_QUESTION = re.compile(r"/(?:questions|q)/(\d{1,12})(?:/.*)?\Z", re.ASCII)
_SITE = re.compile(r"([a-z0-9-]+)\.stackexchange\.com\Z")
_LIKE = "https://github.com/OWNER/NAME/issues/1"
_LOOPBACK = ("localhost", "127.0.0.1", "::1")
_DISTRO = re.compile(rf"\b(?:{'|'.join(DISTROS)})\b", re.IGNORECASE)
_TARGETED = ("kinetic", "lunar", "melodic", "noetic", *ROS2)
_ADDRESS = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*://\S*\Z")
_BARE_ADDRESS = re.compile(r"(?:www\.)?(?:github\.com|[\w.]*stackexchange\.com|answers\.ros\.org)/\S+\Z")
# One word with a slash or with a short ending, as names of files have it: no report is that short.
_PATH = re.compile(r"\S*[/\\]\S*|~\S*|\.\S+|\S*[^\s.]\.[A-Za-z]\w{0,7}")
_TIMEOUT = 20.0
_PATIENCE = 15.0
_TRIES = 3


class Post(NamedTuple):
    """A report as it came in."""

    id: str
    title: str
    body: str


class Triage(NamedTuple):
    """What is said of a report. checks: commands to run next."""

    id: str
    verdict: ModelVerdict
    reasons: list[Reason]
    nearest: list[KnownReport]
    checks: list[str]


def triage(model: Model, post: Post) -> Triage:
    """Judges a report."""
    reading = read(post.title, post.body)
    verdict = model.judge(reading)
    return Triage(
        post.id,
        verdict,
        model.list_reasons(reading, verdict.label),
        model.find_nearest(reading),
        list_checks(verdict.label, post),
    )


def suggest(title: str, body: str) -> tuple[str, dict[str, float]]:
    """The likeliest label of a report and the probability of each, by the shipped model. Raises ClassifierError."""
    verdict = _load_shipped().judge(read(title, body))
    return verdict.label, verdict.probabilities


@cache
def _load_shipped() -> Model:
    return load()


def list_checks(label: str, post: Post) -> list[str]:
    """The commands that look into a report of this label, with the distros it names as targets."""
    named = dict.fromkeys(name.lower() for name in _DISTRO.findall(f"{post.title}\n{post.body}"))
    targets = "".join(f" --target {name}" for name in named if name in _TARGETED)
    return [call.format(targets=targets) for call in CHECKS.get(label, ())]


def render_json(found: Triage) -> str:
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


def render_triage(found: Triage) -> str:
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
    else:
        lines.append("no check looks into reports of this label")
    return "\n".join(map(escape, lines)) + "\n"


def format_row(model: Model, post: Post) -> str:
    """A line of the stream: id, label, probabilities, abstained."""
    verdict = model.judge(read(post.title, post.body))
    chances = {label: round(chance, 6) for label, chance in verdict.probabilities.items()}
    answer = {"id": post.id, "label": verdict.label, "probabilities": chances, "abstained": verdict.abstained}
    return json.dumps(answer, ensure_ascii=False)


def read_posts(lines: Iterable[str], name: str) -> Iterator[Post]:
    """The reports of JSON Lines with `id`, `title` and `body`. name: of the file. Raises ClassifierError, also when
    there is none."""
    found = False
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        found = True
        post = parse_post(line)
        if post is None:
            raise ClassifierError(f"{name}:{number}: is no JSON object with `title` or `body` as texts; mend the line")
        yield post
    if not found:
        raise ClassifierError(f"{name}: holds no report; give JSON Lines with `id`, `title` and `body`")


def parse_post(line: str) -> Post | None:
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


def make_post(text: str, id: str = "") -> Post:
    """A report from plain text: its first line is the title."""
    title, _, body = text.strip().partition("\n")
    return Post(id, title.lstrip("# ").strip(), body.strip())


def is_address(text: str) -> bool:
    """Whether an argument is the address of a page rather than a report or a file."""
    return bool(_ADDRESS.match(text))


def fetch(url: str) -> Post:
    """A GitHub issue or pull request, or a question of Stack Exchange. Nobody is asked but the API of the host that the
    address names: those of github.com and stackexchange.com, and the GitHub server of $ROSIMPACT_GITHUB_API. Raises
    ClassifierError."""
    from ..corpus.polite import Client
    from ..corpus.report import CorpusError
    from ..corpus.sources import github, stack_exchange
    from ..corpus.tokens import find_github_token, find_stack_exchange_key

    host, path, shown = _split_url(url)
    issue = _ISSUE.match(path)
    question = _QUESTION.match(path)
    site = _SITE.match(host)
    if host == "answers.ros.org":
        raise ClassifierError(
            f"{shown}: answers.ros.org is gone; give the question's address on robotics.stackexchange.com, or its text"
        )

    def make_client(service: str, secret: str) -> Client:
        return Client(service, patience=_PATIENCE, timeout=_TIMEOUT, tries=_TRIES, secrets=(secret,))

    try:
        api = _find_github_api(host, github.API)
        if not api and not site:
            raise ClassifierError(
                f"{shown}: is no issue, pull request or question of a host that is known; known are github.com and "
                f"stackexchange.com; for a GitHub Enterprise server set {GITHUB_API} to https://HOST/api/v3, or give "
                "the text itself"
            )
        if issue and api:
            owner, name, number = issue.groups()
            token = find_github_token(api)
            server = github.GitHub(make_client("GitHub", token), api, token)
            (asked,) = server.ask([(f"{owner}/{name}#{number}", "")])
        elif question and site:
            api = os.environ.get(STACK_API) or stack_exchange.API
            key = find_stack_exchange_key(api)
            exchange = stack_exchange.StackExchange(make_client("Stack Exchange", key), api, key, site[1])
            (asked,) = exchange.ask([(f"{site[1]}:{question[1]}", "")])
        else:
            raise ClassifierError(
                f"{shown}: is no issue, pull request or question that can be fetched; give one of GitHub or "
                "robotics.stackexchange.com, or the text itself"
            )
    except CorpusError as error:
        raise ClassifierError(
            f"{shown}: {str(error).partition(';')[0]}; try again later, or give the text itself"
        ) from None
    if asked.gathered is None:
        raise ClassifierError(
            f"{shown}: is not there, or not public; check the address, set GITHUB_TOKEN, or give the text itself"
        )
    report = asked.gathered.report
    return Post(report.id, report.title, report.body)


def _split_url(url: str) -> tuple[str, str, str]:
    """(host, path, the address without what may be secret) of a page. Raises ClassifierError for one that is none."""
    try:
        parts = urlsplit(url)
        plain = parts.port is None and parts.username is None and "\\" not in url
        known = parts.scheme.lower() in ("http", "https") and bool(parts.hostname)
    except ValueError:  # half of an IPv6 address, a port that is no number, signs that stand for `/`
        raise ClassifierError(f"the address cannot be read; give one like {_LIKE}") from None
    host = (parts.hostname or "").rstrip(".").removeprefix("www.")
    shown = f"{parts.scheme}://{parts.hostname or ''}{parts.path}"
    if not known or not plain:
        raise ClassifierError(
            f"{shown}: is no address of a page; give one like {_LIKE}, without user name and port"
        )
    return host, parts.path.rstrip("/"), shown


def _find_github_api(host: str, public: str) -> str:
    """The API that has the issues of a host; empty when it is no GitHub server that is known. A server of this machine
    may stand for github.com. Raises ClassifierError."""
    named = os.environ.get(GITHUB_API, "")
    try:
        own = (urlsplit(named).hostname or "").lower()
    except ValueError:
        raise ClassifierError(f"{GITHUB_API}: is no address; give one like {public}") from None
    if host == "github.com":
        return named if own in _LOOPBACK else public
    return named if own and own in (host, f"api.{host}") else ""


def interpret_argument(argument: str) -> Post | Path | None:
    """What an argument of the command line means: a report, a file to read, or None for standard input.

    An existing file is read. Otherwise one word that holds a slash or ends as names of files do is a path or an address
    that is none, which is an error; all else is a report's text. Raises ClassifierError.
    """
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
        there = bool(argument.strip()) and path.exists()
        folder = there and path.is_dir()
    except (OSError, ValueError):
        there = folder = False
    if folder:
        raise ClassifierError(f"{argument}: is a folder; give a file, an address or a text")
    if there:
        raise ClassifierError(f"{argument}: is not a regular file; give a file, or - for standard input")
    if _PATH.fullmatch(argument):
        raise ClassifierError(
            f"{argument}: there is no such file; give an existing one, an address or a text; one word that is a text "
            "goes through standard input, with -"
        )
    return make_post(argument)


def triage_all(model: Model, lines: Iterable[str], name: str) -> None:
    """JSON Lines to JSON Lines on standard output, each written as soon as it is known."""
    for post in read_posts(lines, name):
        write_json(escape_json(format_row(model, post)))
