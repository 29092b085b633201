"""Lists that services give in pages, in the order of time, while they change: read so that nothing falls between pages.

Each request asks for what is not older than the newest row of the one before, so a list whose rows move or go loses
nothing. Only where more rows than a page holds are of one moment, numbered pages are the way on, and there a row that
goes moves all later ones up, one of them from an unread page to one that was read. So after each further page the one
before it is read again: when it is the same, nothing went from what was read, and the further page followed it without
a gap; else what moved into it has now been read, and the further page is asked for once more.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from typing import Any, NamedTuple, TypeVar

from ..report import CorpusError

Row = dict[str, Any]
Moment = TypeVar("Moment", str, int)

_PATIENCE = 200
"""Requests without a step forward, after which a list is given up."""
_LATER = 5
"""How often a moment is waited for to end."""


class AnswerPage(NamedTuple):
    """One answer. onward: the place of the next page, None at the end. over: whether the moment that was asked for has
    passed, so that nothing new can be of it. about: the answer itself, for whoever asks."""

    rows: list[Row]
    onward: Any = None
    over: bool = True
    about: Any = None


class ReadStep(NamedTuple):
    """What a request brought. fresh: rows that are not as they were on the pages just before. since: where to go on
    when this is the last step of a run. whole: whether this was the only request of a list, from `since` to the end."""

    part: AnswerPage
    fresh: list[Row]
    since: Any
    finished: bool = False
    whole: bool = False


def read_in_order(
    ask: Callable[[Any, Any], AnswerPage],
    since: Moment,
    moment_of: Callable[[Row], Moment],
    name_of: Callable[[Row], Hashable],
    wait: Callable[[], None],
    service: str,
) -> Iterator[ReadStep]:
    """Reads a list from a moment to its end, each row at least once.

    ask: gives a page of the rows that are not older than its first argument; the second is the place of a further
    page, None for the first one. moment_of, name_of: of a row. wait: called when a moment is not over. Raises
    CorpusError when a list changes faster than it can be read, and whatever ask() and wait() raise.
    """
    known: dict[Hashable, Row] = {}

    def make_step(part: AnswerPage, before: AnswerPage | None, finished: bool = False, whole: bool = False) -> ReadStep:
        nonlocal known
        fresh = [row for row in part.rows if known.get(name_of(row)) != row]
        known = {name_of(row): row for each in (before, part) if each is not None for row in each.rows}
        return ReadStep(part, fresh, since, finished, whole)

    def find_newest(part: AnswerPage) -> Moment:
        return max((moment_of(row) for row in part.rows), default=since)

    def order(part: AnswerPage) -> list[tuple[Hashable, Moment]]:
        return [(name_of(row), moment_of(row)) for row in part.rows]

    while True:
        first = ask(since, None)
        if first.onward is None:
            yield make_step(first, None, finished=True, whole=True)
            return
        if find_newest(first) > since:
            since = find_newest(first)
            yield make_step(first, None)
            continue
        yield make_step(first, None)
        place, here = None, first  # the last page of which it is certain that all before it was read, too
        idle = waits = 0
        while here.onward is not None and find_newest(here) <= since:
            idle += 1
            if idle > _PATIENCE:
                raise CorpusError(f"{service}: the list changes faster than it can be read; try again later")
            if place is None and not here.over and waits < _LATER:
                waits += 1
                wait()
                here = ask(since, None)
                yield make_step(here, None)
                continue
            after = ask(since, here.onward)
            yield make_step(after, here)
            again = ask(since, place)
            yield make_step(again, after)
            if order(again) == order(here):
                place, here, idle = here.onward, after, 0
            elif again.rows and order(again)[0] in order(here):
                here = again  # rows moved up by less than a page: what came into this one is read
            else:
                place, here = None, ask(since, None)
                yield make_step(here, None)
        if find_newest(here) <= since:
            yield ReadStep(AnswerPage([], about=here.about), [], since, finished=True)
            return
        since = find_newest(here)
