"""rosdep rules over time, from the history of rosdistro's rosdep files."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import msgspec
import yaml

from .git import FileVersion

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_BLOCK = re.compile(rb"\n(?=[^\s#])")
_ALIAS = re.compile(rb": \*([\w-]+)[ \t]*$", re.MULTILINE)
_ANCHOR = re.compile(rb": &([\w-]+)")

FILES = ("rosdep/osx-homebrew.yaml", "rosdep/base.yaml", "rosdep/python.yaml", "rosdep/ruby.yaml")
"""Files of rosdep's default source list, in its order: the first that has a rule wins."""


class RuleEvent(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The rule of a key for an operating system from `ts` on, as JSON; None: dropped."""

    ts: int
    key: str
    os: str
    rule: str | None


def split_file(data: bytes) -> list[bytes]:
    """The blocks of a rosdep file, one for each key. One with YAML aliases gets their anchors' blocks in front."""
    blocks = _BLOCK.split(b"\n" + data)
    if b": *" not in data:
        return blocks
    anchored = {name: block for block in blocks if b": &" in block for name in _ANCHOR.findall(block)}
    return [
        b"\n".join([*(anchored[name] for name in _ALIAS.findall(block) if name in anchored), block])
        if b": *" in block
        else block
        for block in blocks
    ]


def parse_rules(block: bytes) -> dict[tuple[str, str], str] | None:
    """{(key, operating system): rule as JSON} of one block of a rosdep file, None when it is no YAML mapping."""
    try:
        parsed = yaml.load(block, Loader=_LOADER)
    except (yaml.YAMLError, ValueError):
        return None
    if parsed is None:
        return {}
    if not isinstance(parsed, dict):
        return None
    rules = {}
    for key, systems in parsed.items():
        if isinstance(systems, dict):
            for system, rule in systems.items():
                rules[str(key), str(system)] = _encode(rule)
    return rules


def _encode(rule: Any) -> str:
    """Canonical JSON; install scripts of old rules are left out: only package names are facts."""
    return msgspec.json.encode(_simplify(rule), order="sorted").decode()


def _simplify(value: Any) -> Any:
    if isinstance(value, dict):
        if "packages" in value:
            return {"packages": _simplify(value["packages"])}
        return {str(key): _simplify(item) for key, item in value.items() if str(key) not in ("script", "uri", "md5sum")}
    if isinstance(value, list):
        return [str(item) for item in value]
    if value is None:
        return None
    text = str(value)
    # A multi-line text is an install script of the first years.
    return text.split() if "\n" not in text.strip() else []


def read_rules(
    versions: Mapping[str, Sequence[FileVersion]],
    blob: Callable[[str], bytes],
    done: Callable[[int], None] | None = None,
) -> list[RuleEvent]:
    """All rule events of the files, by time. done is told how many file versions were read so far."""
    timelines: dict[tuple[str, str], list[tuple[int, int, str | None]]] = {}
    count = 0
    for rank, path in enumerate(versions):
        memo: dict[bytes, dict[tuple[str, str], str]] = {}
        state: dict[tuple[str, str], str] = {}
        before: set[bytes] = set()
        for version in versions[path]:
            count += 1
            if done and count % 100 == 0:
                done(count)
            blocks = set(split_file(blob(version.blob))) if version.blob else set()
            added = {}
            for block in blocks - before:
                rules = parse_rules(block)
                if rules is None:
                    break
                added[block] = rules
            else:
                memo.update(added)
                now: dict[tuple[str, str], str] = {}
                for block in blocks - added.keys():
                    now.update(memo[block])
                for rules in added.values():
                    now.update(rules)
                for pair in now.keys() | state.keys():
                    if now.get(pair) != state.get(pair):
                        timelines.setdefault(pair, []).append((version.ts, rank, now.get(pair)))
                for block in before - blocks:
                    memo.pop(block, None)
                state, before = now, blocks
    return sorted(
        (event for pair, timeline in timelines.items() for event in _merge_events(pair, timeline)),
        key=lambda event: (event.ts, event.key, event.os),
    )


def _merge_events(pair: tuple[str, str], timeline: list[tuple[int, int, str | None]]) -> list[RuleEvent]:
    """Events of one key and system over all files: the lowest-ranked file that has a rule wins."""
    timeline.sort(key=lambda item: item[:2])
    held: dict[int, str] = {}
    events: list[RuleEvent] = []
    said: str | None = None
    for place, (ts, rank, rule) in enumerate(timeline):
        if rule is None:
            held.pop(rank, None)
        else:
            held[rank] = rule
        if place + 1 < len(timeline) and timeline[place + 1][0] == ts:
            continue
        now = held[min(held)] if held else None
        if now != said:
            events.append(RuleEvent(ts, *pair, now))
            said = now
    return events
