"""A list of issues that changes between the requests of who reads it, by a seed: the clock, bots, people."""

from __future__ import annotations

import math
import random
from email.utils import formatdate
from typing import Any
from urllib.parse import parse_qs, urlsplit

from rosimpact.corpus.polite import Client, Clock, ServiceAnswer
from server import Asked, Services, issue, stamp

REPOSITORY = "ros2/rclcpp"
START = 1_700_000_000


class Moving(Clock):
    """Issues of which many share one time of update, and what happens to them while they are read.

    size: of a page. steps: how many requests see changes behind them. rows: what there is now.
    """

    def __init__(self, server: Services, seed: int, size: int, steps: int = 30):
        self._chance = random.Random(seed)
        self._server = server
        self._now = START + 1_000
        self._left = steps
        self._number = 0
        self.rows: list[dict[str, Any]] = []
        # times before now, each of none to five pages of issues
        for _ in range(self._chance.randint(1, 4)):
            moment = START + self._chance.randint(0, 900)
            for _ in range(self._chance.choice((1, size // 2, size, 2 * size, 3 * size + 1, 5 * size))):
                self.rows.append(self._new(moment))
        self._chance.shuffle(self.rows)
        server.issues[REPOSITORY] = self.rows
        server.after = self.happen
        server.date = self.now

    def now(self) -> float:
        return self._now

    def sleep(self, seconds: float) -> None:
        self._now += math.ceil(seconds)

    def rest(self) -> None:
        """Nothing changes from now on."""
        self._left = 0

    def _new(self, moment: int) -> dict[str, Any]:
        self._number += 1
        return issue(REPOSITORY, self._number, day=stamp(moment), body=f"first of {self._number}")

    def happen(self, asked: Asked) -> None:
        """What may happen after a request: nothing, or issues are edited, deleted, posted, or labelled by a bot."""
        self._now += self._chance.choice((0, 0, 1, 1, 2))
        if self._left <= 0:
            return
        self._left -= 1
        for _ in range(self._chance.choice((0, 1, 1, 2, 4))):
            what = self._chance.random()
            if what < 0.45 and self.rows:
                self._edit(self._chance.choice(self.rows))
            elif what < 0.65 and self.rows:
                self.rows.remove(self._chance.choice(self.rows))
            elif what < 0.9:
                self.rows.insert(self._chance.randint(0, len(self.rows)), self._new(self._now))
            else:
                for row in self._chance.sample(self.rows, min(len(self.rows), self._chance.choice((3, 12, 30)))):
                    self._edit(row)

    def _edit(self, row: dict[str, Any]) -> None:
        row |= {"body": f"edited at {self._now}, {self._chance.random()}", "updated_at": stamp(self._now)}

    def missing(self, found: dict[str, str]) -> list[str]:
        """Ids of which a store (id to body) lacks the newest text."""
        return [id for row in self.rows if found.get(id := f"{REPOSITORY}#{row['number']}") != row["body"]]


class Direct(Client):
    """A client that asks a server without a network, since a simulation asks thousands of times."""

    def __init__(self, server: Services, world: Moving):
        super().__init__("GitHub", clock=world)
        self._server = server

    def _once(self, url: str, headers: dict[str, str], target: Any) -> ServiceAnswer:
        parts = urlsplit(url)
        query = {name: values[-1] for name, values in parse_qs(parts.query).items()}
        asked = Asked(parts.path, query, {name.lower(): value for name, value in headers.items()})
        self._server.asked.append(asked)
        date = formatdate(self._server.date(), usegmt=True)
        status, sent, body = self._server.answer(asked)
        self._server.after(asked)
        return ServiceAnswer(status, url, {"date": date, **{name.lower(): value for name, value in sent.items()}}, body)
