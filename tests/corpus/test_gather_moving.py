"""Gathering a list that changes between its pages, and of which many share one time of update, loses nothing."""

from __future__ import annotations

import random

import pytest
from moving import REPOSITORY, Direct, Moving
from rosimpact.corpus.gather import gather
from rosimpact.corpus.sources import github
from rosimpact.corpus.sources.github import GitHub, Listed
from rosimpact.corpus.store import CorpusStore
from server import Services

RUNS = 30
"""Of each kind, every one another history. A reader that trusts numbered pages loses issues in half of them."""


@pytest.fixture
def server():
    services = Services()
    yield services
    services.close()


def gathered(server: Services, world: Moving, tmp_path, stop_after: float) -> dict[str, str]:
    """The bodies in the store after a gathering, stopped and resumed with a chance after each page, and one more."""
    chance = random.Random(7)
    path = tmp_path / "corpus.sqlite"

    def tell(progress) -> None:
        if chance.random() < stop_after:
            raise KeyboardInterrupt

    def source() -> Listed:
        return Listed(GitHub(Direct(server, world), server.url), REPOSITORY)

    for _ in range(100):
        with CorpusStore(path) as store:
            try:
                gather(source(), store, tell)
                break
            except KeyboardInterrupt:
                continue
    world.rest()
    with CorpusStore(path) as store:
        gather(source(), store)
        return {report.id: report.body for report in store.iterate_reports()}


@pytest.mark.parametrize("stop_after", [0.0, 0.2])
@pytest.mark.parametrize("seed", range(RUNS))
def test_nothing_is_lost(server, tmp_path, monkeypatch, seed, stop_after):
    monkeypatch.setattr(github, "PER_PAGE", 10)
    world = Moving(server, seed, 10)
    assert world.missing(gathered(server, world, tmp_path, stop_after)) == []


def test_a_list_that_changes_with_every_request_is_given_up(server, tmp_path, monkeypatch):
    monkeypatch.setattr(github, "PER_PAGE", 10)
    world = Moving(server, 0, 10, steps=0)
    for row in world.rows:
        row["updated_at"] = "2023-11-14T22:15:00Z"
    world.rows *= 30
    shuffle = random.Random(1).shuffle
    server.after = lambda asked: shuffle(world.rows)
    with CorpusStore(
        tmp_path / "corpus.sqlite"
    ) as store, pytest.raises(github.CorpusError, match="changes faster than"):
        gather(Listed(GitHub(Direct(server, world), server.url), REPOSITORY), store)
