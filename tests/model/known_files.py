"""Files as a resolver knows them, made from a text as a join makes them from the store."""

from rosimpact.impact.facts import kinds
from rosimpact.impact.model.cpp.offered_headers import collect_words
from rosimpact.impact.model.cpp.resolver import KnownFile


def make_known(text: str) -> KnownFile:
    data = text.encode()
    facts = kinds.extract("cpp", data).facts

    def look(kind, table):
        made = kinds.search(kind, data, facts, table) if kind in kinds.SEARCHES else kinds.extract(kind, data)
        assert not made.facts.problems
        return kinds.decode(kind, kinds.encode(made)).facts

    return KnownFile(facts, collect_words(facts), look)
