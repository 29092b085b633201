"""Which publish statement of one revision is which of the next: they move, and what they stand in is renamed."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from difflib import SequenceMatcher
from typing import NamedTuple, TypeVar

from ..model.flow.code import get_outer, get_tail
from .statements import Outlet, PackageStatements, PublishStatement

_WORD = re.compile(r"[A-Za-z_]\w*")
_PIECE = re.compile(r"\w+|[^\w\s]")
_ENOUGH = 9
_LONGEST = 400
_T = TypeVar("_T")


class StatementPlace(NamedTuple):
    """A statement with where it is: its package, the package's digest, and its path in the repository."""

    package: str
    digest: PackageStatements
    statement: PublishStatement
    path: str

    @property
    def outlets(self) -> list[Outlet]:
        """The publishers that it may use."""
        return [self.digest.outlets[place] for place in self.statement.outlets]

    @property
    def topics(self) -> frozenset[str]:
        """As the node knows them."""
        return frozenset(outlet.topic for outlet in self.outlets if outlet.topic)


class OutletAt(NamedTuple):
    """A publisher with where it is. content: the id of the file's content."""

    package: str
    outlet: Outlet
    path: str
    content: str


class Renames(NamedTuple):
    """What is called otherwise in the new revision. words: identifiers; files: paths of the repository."""

    words: Mapping[str, str] = {}
    files: Mapping[str, str] = {}

    def map_text(self, text: str) -> str:
        """A text of the old revision in the words of the new one."""
        words = self.words
        return _WORD.sub(lambda match: words.get(match[0], match[0]), text) if words else text

    def map_path(self, path: str) -> str:
        """A path of the old revision in the new one."""
        return self.files.get(path, path)


SAME = Renames()


def match_statements(
    old: Sequence[StatementPlace], new: Sequence[StatementPlace], names: Renames
) -> tuple[list[tuple[StatementPlace, StatementPlace]], list[StatementPlace], list[StatementPlace]]:
    """(pairs, gone, come). Statements that stand where they stood, as they did, are matched first; then those that have
    most in common, unless that is too little."""
    keys = _make_exact_key, _make_near_key

    def rate_distance(one: StatementPlace, other: StatementPlace) -> tuple[int, int]:
        return -_rate_likeness(one, other, names), abs(one.statement.line - other.statement.line)

    return _match(old, new, names, keys, _score, rate_distance)


def match_outlets(old: Sequence[OutletAt], new: Sequence[OutletAt], names: Renames) -> list[tuple[OutletAt, OutletAt]]:
    """Pairs of publishers that are the same one; those that are new or gone are in none."""
    return _match(old, new, names, (_make_outlet_key, _make_outlet_place_key), _score_outlets, lambda *_: (0, 0))[0]


def _match(
    old: Sequence[_T],
    new: Sequence[_T],
    names: Renames,
    keys: Iterable[Callable[[_T, Renames], tuple]],
    score: Callable[[_T, _T, Renames], int],
    apart: Callable[[_T, _T], tuple[int, int]],
) -> tuple[list[tuple[_T, _T]], list[_T], list[_T]]:
    """Pairs that have a key in common, one key after the other; of the rest those that are most alike, of equals the
    least apart. And what is left of both."""
    pairs: list[tuple[_T, _T]] = []
    for key in keys:
        found, old, new = _pair_equal(old, new, key, names)
        pairs += found
    scored = sorted(
        (-points, apart(one, other), first, second)
        for first, one in enumerate(old)
        for second, other in enumerate(new)
        if (points := score(one, other, names)) >= _ENOUGH
    )
    taken_old: set[int] = set()
    taken_new: set[int] = set()
    for _, _, first, second in scored:
        if first not in taken_old and second not in taken_new:
            taken_old.add(first)
            taken_new.add(second)
            pairs.append((old[first], new[second]))
    gone = [one for place, one in enumerate(old) if place not in taken_old]
    come = [one for place, one in enumerate(new) if place not in taken_new]
    return pairs, gone, come


def _pair_equal(
    old: Sequence[_T], new: Sequence[_T], key: Callable[[_T, Renames], tuple], names: Renames
) -> tuple[list[tuple[_T, _T]], list[_T], list[_T]]:
    """Pairs of one key, in their order; and what is left of both."""
    waiting: dict[tuple, list[_T]] = {}
    for one in new:
        waiting.setdefault(key(one, SAME), []).append(one)
    pairs: list[tuple[_T, _T]] = []
    left: list[_T] = []
    for one in old:
        same = waiting.get(key(one, names))
        if same:
            pairs.append((one, same.pop(0)))
        else:
            left.append(one)
    unmatched = {id(one) for same in waiting.values() for one in same}
    return pairs, left, [one for one in new if id(one) in unmatched]


def collect_conditions(statement: PublishStatement, names: Renames = SAME) -> frozenset[tuple]:
    """All that decides when a statement runs, as written, in the words of the new revision."""
    return frozenset(
        (
            way.start.kind,
            names.map_text(way.start.detail),
            tuple((gate.kind, names.map_text(gate.text)) for gate in way.gates),
        )
        for way in statement.ways
    )


def _make_place_key(at: StatementPlace, names: Renames) -> tuple:
    statement = at.statement
    return (
        names.map_path(at.path),
        names.map_text(normalize(statement.function)),
        names.map_text(get_tail(statement.variable)),
    )


def _make_exact_key(at: StatementPlace, names: Renames) -> tuple:
    return (*_make_near_key(at, names), collect_conditions(at.statement, names))


def _make_near_key(at: StatementPlace, names: Renames) -> tuple:
    return (*_make_place_key(at, names), at.topics, names.map_text(at.statement.expression))


def _score(one: StatementPlace, other: StatementPlace, names: Renames) -> int:
    """How much two statements have in common; too little where they publish on topics that are known to differ, unless
    they stand in one place."""
    first, second = one.statement, other.statement
    if first.language != second.language:
        return 0
    file, function, variable = _make_place_key(one, names)
    other_file, other_function, other_variable = _make_place_key(other, SAME)
    score = 0
    same_variable = variable == other_variable and bool(variable)
    same_function = function == other_function
    one_topics, other_topics = one.topics, other.topics
    if one_topics and other_topics:
        if one_topics & other_topics:
            score += 6
        elif not (same_variable and same_function):
            return 0
    if first.type and second.type:
        score += 1 if first.type == second.type else -3
    score += 4 * same_variable + 3 * (file == other_file) + 2 * same_function
    score += 2 * (not same_function and get_tail(function) == get_tail(other_function))
    score += get_outer(function) == get_outer(other_function)
    expression = names.map_text(first.expression)
    score += 3 * (expression == second.expression and bool(expression))
    score += 3 * bool(collect_conditions(first, names) & collect_conditions(second))
    return score


def _rate_likeness(one: StatementPlace, other: StatementPlace, names: Renames) -> int:
    """How alike the conditions of two statements are, in tenths, whatever starts them."""
    sides = [
        [
            word
            for way in at.statement.ways[:1]
            for gate in way.gates
            for word in _PIECE.findall(here.map_text(gate.text))
        ]
        for at, here in ((one, names), (other, SAME))
    ]
    if max(map(len, sides)) > _LONGEST:
        return 0
    return round(10 * SequenceMatcher(None, sides[0], sides[1], False).ratio())


def normalize(function: str) -> str:
    """A function's name, lambdas by what they stand in: their places move."""
    return re.sub(r"lambda@[\d:]+", "lambda", function)


def _make_outlet_key(at: OutletAt, names: Renames) -> tuple:
    return (*_make_outlet_place_key(at, names), at.outlet.topic, at.outlet.type)


def _make_outlet_place_key(at: OutletAt, names: Renames) -> tuple:
    outlet = at.outlet
    return (
        names.map_path(at.path),
        names.map_text(normalize(outlet.function)),
        names.map_text(get_tail(outlet.variable)) or outlet.topic,
    )


def _score_outlets(one: OutletAt, other: OutletAt, names: Renames) -> int:
    first, second = one.outlet, other.outlet
    variable = names.map_text(get_tail(first.variable))
    score = 6 * (first.topic == second.topic and bool(first.topic))
    score += 5 * (variable == get_tail(second.variable) and bool(variable))
    score += 3 * (names.map_path(one.path) == other.path) + 2 * (first.type == second.type and bool(first.type))
    # A variable of its name in another class is another one, unless it has the same topic.
    moved = get_outer(names.map_text(first.function)) != get_outer(second.function)
    return score - 3 * (moved and first.topic != second.topic)
