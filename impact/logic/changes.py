"""What happened to publishing between a commit and its parent: statement by statement, publisher by publisher."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Literal, NamedTuple

import msgspec

from ..model.flow.code import get_tail
from ..model.flow.graph import GuardAt
from . import guards
from .guards import Ways
from .history import PackageFile, PackageState
from .match import (
    SAME,
    OutletAt,
    Renames,
    StatementPlace,
    collect_conditions,
    match_outlets,
    match_statements,
    normalize,
)
from .meaning import PARAMETER, put_given
from .periods import parse_period
from .statements import Gate, Outlet, PackageStatements, Path, PublishStatement, StatementStart, strip_spelling

Kind = Literal["tightened", "widened", "equivalent", "changed", "new", "gone", "trigger changed"]
KINDS: tuple[Kind, ...] = ("tightened", "widened", "equivalent", "changed", "new", "gone", "trigger changed")
_MOST_WAYS = 16
"""As many ways as the join follows; where there are so many, some may be missing."""
_UNSAID = frozenset(("unknown", "start"))
_UNLED = frozenset(("unknown", "thread"))
"""What leads to the statement is not known."""
_LONGEST = 4000
_ABOUT = re.compile(r"(?<![\w.])[A-Za-z_][\w:]*(?:\s*\()?|[<>=!]=?|&&|\|\|")
_WORDS = re.compile(r"[A-Za-z_]\w*")
_DENIED = re.compile(r"(?:!\s*|not )([\w.:]+(?:->[\w.]+)*(?:\([\w.,: ]*\))?)")


class ReachedSubscriber(msgspec.Struct, frozen=True):
    """A subscriber that a change reaches."""

    package: str
    node: str
    topic: str
    callback: str
    path: str
    line: int


class LogicChange(msgspec.Struct, frozen=True):
    """A change of the logic of publishing.

    path, line: of the publish statement (or the publisher, where its queue or topic changed) in the commit; in its
    parent where it is gone. node: that runs it, several joined by `, `. topic: as the node's code knows it, the
    publisher's name where that is not known. topics: its full names, before and after. old, new: what it was and is
    published under, None where there is no statement; empty for no condition. why: what differs, in one clause.
    reaches: subscribers at the commit. unreachable: nothing leads to the statement any more, and something did.
    """

    kind: Kind
    package: str
    path: str
    line: int
    function: str
    node: str
    topic: str
    topics: tuple[str, ...]
    type: str
    old: str | None
    new: str | None
    why: str
    reaches: tuple[ReachedSubscriber, ...] = ()
    unreachable: bool = False


class Side(NamedTuple):
    """The packages of a revision that differ from the other one's, with their digests."""

    packages: Sequence[tuple[PackageState, PackageStatements]]
    read: Callable[[PackageFile], bytes] | None = None

    def list_statements(self) -> list[StatementPlace]:
        """All publish statements."""
        return [StatementPlace(
            s.name, d, statement, s.locate(statement.path)
        ) for s, d in self.packages for statement in d.statements]

    def list_swallowed(self) -> frozenset[str]:
        """The functions that may raise what is caught, and the code goes on."""
        return frozenset(name for _, one in self.packages for name in one.swallowed)

    def has_calls(self, calls: Iterable[str]) -> bool:
        """Whether the sources have all of some calls, written as in Gate.tried."""
        if self.read is None:
            return False
        files = [file for state, _ in self.packages for file in state.files if file.kind in ("cpp", "python")]
        text = "\n".join(strip_spelling(self.read(file).decode("utf-8", "replace")) for file in files)
        return all(re.search(rf"(?<!\w){re.escape(call)}", text) for call in calls)

    def list_unread(self) -> frozenset[str]:
        """The files that were not read in full."""
        return frozenset(state.locate(path) for state, one in self.packages for path in one.unread)

    def list_outlets(self) -> list[OutletAt]:
        """All publishers."""
        found: list[OutletAt] = []
        for state, one in self.packages:
            contents = {file.path: file.id for file in state.files}
            for outlet in one.outlets:
                found.append(OutletAt(state.name, outlet, state.locate(outlet.path), contents.get(outlet.path, "")))
        return found


def is_unchanged(old: Side, new: Side) -> bool:
    """Whether the statements and publishers of both sides are the same, word by word."""
    return _list_stamps(old) == _list_stamps(new)


def _list_stamps(side: Side) -> tuple[list[str], list[str]]:
    statements, outlets = [], []
    for at in side.list_statements():
        statement = at.statement
        ways = sorted(
            repr((way.start, way.times, [(g.kind, g.text, g.meaning, g.given) for g in way.gates]))
            for way in statement.ways
        )
        topics, kinds = sorted(at.topics), statement.type
        statements.append(
            repr((at.path, statement.function, statement.variable, topics, statement.expression, kinds, ways))
        )
    for at in side.list_outlets():
        one = at.outlet
        outlets.append(repr((at.path, one.function, one.variable, one.topic, one.type, one.offers)))
    return sorted(statements), sorted(outlets)


def changes(old: Side, new: Side, names: Renames = SAME) -> Iterator[LogicChange]:
    """All changes, rewordings included. names: what is called otherwise."""
    before, after = old.list_statements(), new.list_statements()
    pairs, gone, come = match_statements(before, after, names)
    pairs = [(_pass_uncaught(one, other, new), _pass_uncaught(other, one, old)) for one, other in pairs]
    outlets = match_outlets(old.list_outlets(), new.list_outlets(), names)
    successors = {id(one.outlet): other.outlet for one, other in outlets}
    said = [list(_compare_statements(one, other, names, successors)) for one, other in pairs]
    for place, (one, other) in enumerate(pairs):
        if any(change.kind != "equivalent" for change in said[place]):
            merged = _find_merged(one, other, gone, come, names, successors)
            if merged:
                gone = [at for at in gone if at not in merged]
                come = [at for at in come if at not in merged]
                said[place] = []
    gone, come = _drop_repeated(pairs, gone, 0), _drop_repeated(pairs, come, 1)
    for found in said:
        yield from found
    lost, gained = old.list_unread(), new.list_unread()
    gone = [at for at in gone if at.path in lost or names.map_path(at.path) not in gained]
    come = [at for at in come if at.path in gained or at.path not in {names.map_path(path) for path in lost}]
    gone = [at for at in gone if not _has_unclear_call(at, names, new)]
    come = [at for at in come if not _has_unclear_call(at, SAME, old, names)]
    left, known = ({state.name for state, _ in side.packages} for side in (new, old))
    for at in gone:
        was = _describe_trigger("was published", at.statement)
        was = was if at.package in left else f"{was}; no package `{at.package}` is built any more"
        yield _make_change("gone", at, at.outlets, _format_ways(at.statement.ways, at.statement), None, was)
    for at in come:
        is_now = _describe_trigger("is published", at.statement)
        is_now = is_now if at.package in known else f"{is_now}; there was no package `{at.package}`"
        yield _make_change("new", at, at.outlets, None, _format_ways(at.statement.ways, at.statement), is_now)
    published = {id(outlet): at for at in after for outlet in at.outlets}
    for one, other in outlets:
        at = published.get(id(other.outlet))
        if at is not None:
            yield from _compare_outlets(one, other, at)


def _pass_uncaught(at: StatementPlace, other: StatementPlace, theirs: Side) -> StatementPlace:
    """A statement without the conditions that nothing was raised, where the other side has the same calls and does not
    catch what they raise: that ends it there too."""
    known = {gate.text for way in other.statement.ways for gate in way.gates if gate.tried}
    asked = {gate for way in at.statement.ways for gate in way.gates if gate.tried and gate.text not in known}
    swallowed = theirs.list_swallowed() if asked else frozenset()
    passed = {
        gate
        for gate in asked
        if swallowed.isdisjoint(call.partition("(")[0] for call in gate.tried) and theirs.has_calls(gate.tried)
    }
    if not passed:
        return at
    ways = tuple(
        msgspec.structs.replace(way, gates=tuple(
            msgspec.structs.replace(gate, kind="passed") if gate in passed else gate for gate in way.gates
        ))
        for way in at.statement.ways
    )  # fmt: skip
    return at._replace(statement=msgspec.structs.replace(at.statement, ways=ways))


def _find_merged(
    one: StatementPlace,
    other: StatementPlace,
    gone: Sequence[StatementPlace],
    come: Sequence[StatementPlace],
    names: Renames,
    successors: Mapping[int, Outlet],
) -> list[StatementPlace]:
    """The statements that became part of the new one, or were parts of the old one: of its publisher, and together with
    them it runs when it ran before. Empty where there are none."""

    def is_same(first: StatementPlace, second: StatementPlace) -> bool:
        return all(change.kind == "equivalent" for change in _compare_statements(first, second, names, successors))

    parts = [at for at in gone if _share_publisher(at, one)]
    for some in (parts, *([at] for at in parts if len(parts) > 1)):
        if some and is_same(_join_statements(one, some), other):
            return some
    parts = [at for at in come if _share_publisher(at, other)]
    for some in (parts, *([at] for at in parts if len(parts) > 1)):
        if some and is_same(one, _join_statements(other, some)):
            return some
    return []


def _drop_repeated(
    pairs: Sequence[tuple[StatementPlace, StatementPlace]], left: Sequence[StatementPlace], side: int
) -> list[StatementPlace]:
    """Statements of one side without those that a function of the other side, which is called once for each, has taken
    up: they publish as often as before, under the same conditions. side: 0 for those that are gone."""
    kept = list(left)
    for pair in pairs:
        ours, theirs = pair[side].statement, pair[1 - side].statement
        more = sum(way.times for way in theirs.ways) - sum(way.times for way in ours.ways)
        gates = _list_gates(ours)
        alike = [at for at in kept if _share_publisher(at, pair[side]) and _list_gates(at.statement) == gates]
        if len(theirs.ways) == len(ours.ways) and 0 < len(alike) * len(ours.ways) <= more:
            kept = [at for at in kept if at not in alike]
    return kept


def _list_gates(statement: PublishStatement) -> frozenset[tuple]:
    return frozenset((way.start, *((gate.kind, gate.text) for gate in way.gates)) for way in statement.ways)


def _share_publisher(one: StatementPlace, other: StatementPlace) -> bool:
    """Whether two statements of one revision publish through the same publisher."""
    if one.package != other.package or one.statement.language != other.statement.language:
        return False
    if one.statement.outlets or other.statement.outlets:
        return one.statement.outlets == other.statement.outlets
    return one.path == other.path and one.statement.variable == other.statement.variable


def _join_statements(one: StatementPlace, others: Iterable[StatementPlace]) -> StatementPlace:
    """A statement that runs when one of these does."""
    ways = dict.fromkeys(way for at in (one, *others) for way in at.statement.ways)
    return one._replace(statement=msgspec.structs.replace(one.statement, ways=tuple(ways)))


def _has_unclear_call(at: StatementPlace, names: Renames, other: Side, backwards: Renames = SAME) -> bool:
    """Whether the other side has the call where the statement stood, and only does not tell that it publishes."""
    variable = get_tail(names.map_text(at.statement.variable))
    return any(
        variable == get_tail(backwards.map_text(callee.rpartition(".")[0]))
        and (backwards.map_path(state.locate(path)) == names.map_path(at.path) or function == at.statement.function)
        for state, one in other.packages
        for path, function, callee in one.unclear
    )


def _make_change(
    kind: Kind, at: StatementPlace, outlets: Iterable[Outlet], old: str | None, new: str | None, why: str
) -> LogicChange:
    statement = at.statement
    topics = tuple(dict.fromkeys(topic for outlet in outlets for topic in outlet.full))
    near = ", ".join(sorted(at.topics)) or statement.variable
    return LogicChange(
        kind, at.package, at.path, statement.line, statement.function, ", ".join(statement.nodes), near, topics,
        statement.type, old, new, why,
    )  # fmt: skip


def _compare_statements(
    one: StatementPlace, other: StatementPlace, names: Renames, successors: Mapping[int, Outlet]
) -> Iterator[LogicChange]:
    outlets = [*other.outlets, *one.outlets]
    heirs = {id(successors[id(outlet)]) for outlet in one.outlets if id(outlet) in successors}
    moved = one.topics and other.topics and not one.topics & other.topics
    if moved and not heirs & {id(outlet) for outlet in other.outlets}:
        was, is_now = ", ".join(sorted(one.topics)), ", ".join(sorted(other.topics))
        yield _make_change("changed", other, outlets, was, is_now, f"published on `{is_now}`, was `{was}`")
    first, second = _drop_impossible(one.statement), _drop_impossible(other.statement)
    names = _add_publisher(first, second, names)
    old_shown, new_shown = _format_ways(first.ways, first), _format_ways(second.ways, second)
    if collect_conditions(first, names) != collect_conditions(second):
        was, why = _explain_never_runs(first), _explain_never_runs(second)
        if why and not was:
            found = _make_change("tightened", other, outlets, old_shown, new_shown, f"never runs, {why}")
            yield msgspec.structs.replace(found, unreachable=True)
            return
        if was and not why:
            yield _make_change("widened", other, outlets, old_shown, new_shown, f"never ran before: {was}")
            return
    whole = not _cut_off(first) and not _cut_off(second)
    unseen = _find_unseen(first, second, names) if whole else frozenset()
    if unseen or not whole:
        old_ways, new_ways = _select_own_way(first), _select_own_way(second)
        if unseen:
            old_ways, new_ways = _select_behind(unseen, first, second, names)
        if not old_ways or not new_ways:
            return
        kind, why = _compare_guards(old_ways, new_ways, names, second.language)
        if kind != "equivalent":
            yield _make_change(kind, other, outlets, old_shown, new_shown, why)
        return
    kinds: list[guards.Kind] = []
    whys: list[str] = []
    starts: list[str] = []
    for was, is_now in _pair_starts(first, second, names):
        old_ways = [way for way in first.ways if way.start in was]
        new_ways = [way for way in second.ways if way.start in is_now]
        if not old_ways or not new_ways:
            start = (new_ways or old_ways)[0].start
            if start.kind not in _UNSAID:
                starts.append(f"{'also' if new_ways else 'no longer'} on {_describe_start(start)}")
            else:
                kinds.append("widened" if new_ways else "tightened")
                whys.append(f"{'also' if new_ways else 'no longer'} from {_describe_caller(new_ways or old_ways)}")
            continue
        kind, why = _compare_guards(old_ways, new_ways, names, second.language)
        if kind != "equivalent" and _has_unknown_start(old_ways) != _has_unknown_start(new_ways):
            kind = "changed"  # how often what is not seen makes it run is not known
        difference = _start_differs(old_ways, new_ways, names)
        if difference:
            starts.append(difference)
        kinds.append(kind)
        if why:
            whys.append(why)
    kind = _combine_kinds(kinds)
    why = "; ".join(dict.fromkeys(whys))
    if starts:
        clauses = [*dict.fromkeys(starts), *([why] if why else [])]
        yield _make_change("trigger changed", other, outlets, old_shown, new_shown, "; ".join(clauses))
    elif kind != "equivalent":
        yield _make_change(kind, other, outlets, old_shown, new_shown, why)
    elif collect_conditions(first, names) != collect_conditions(second):
        yield _make_change("equivalent", other, outlets, old_shown, new_shown, "says the same in other words")


def _add_publisher(first: PublishStatement, second: PublishStatement, names: Renames) -> Renames:
    """Names with that of the publisher, where it is called otherwise now."""
    was, is_now = get_tail(first.variable), get_tail(second.variable)
    if not was or was == is_now or was in names.words or not was.isidentifier() or not is_now.isidentifier():
        return names
    return names._replace(words={**names.words, was: is_now})


def _drop_impossible(statement: PublishStatement) -> PublishStatement:
    """A statement without ways on which a parameter is given what its guard does not let through, if others are left.
    """
    speech: guards.Language = "python" if statement.language == "python" else "cpp"
    left = tuple(way for way in statement.ways if not any(_is_shut(gate, speech) for gate in way.gates))
    return msgspec.structs.replace(statement, ways=left) if left and left != statement.ways else statement


@lru_cache(4096)
def _is_shut(gate: Gate, speech: guards.Language) -> bool:
    given = [value for _, value in gate.given if PARAMETER not in value]
    return bool(given) and guards.is_unlikely(GuardAt(gate.kind, _write_at(gate, 2), "", 0, gate.of), speech)


def _explain_never_runs(statement: PublishStatement) -> str:
    """Why a statement never runs, as far as that is sure; empty where it may."""
    speech: guards.Language = "python" if statement.language == "python" else "cpp"
    whys: list[str] = []
    for way in statement.ways:
        why = next((f"it stands {gate.text}" for gate in way.gates if gate.kind == "never"), "")
        if not why:
            sides = [[gate] for gate in way.gates if gate.kind in ("if", "unless", "cpp")]
            functions = dict.fromkeys(gate.of for gate in way.gates)
            sides += [[gate for gate in way.gates if gate.fixed and gate.of == of] for of in functions]
            at_once = next((side for side in sides if side and _contradicts(side, speech)), None)
            if at_once is None:
                return ""
            for gate in list(at_once):
                fewer = [one for one in at_once if one is not gate]
                at_once = fewer if fewer and _contradicts(fewer, speech) else at_once
            texts = " and ".join(dict.fromkeys(f"`{_write_gate(gate, speech == 'python')}`" for gate in at_once))
            why = f"{texts} cannot hold"
        whys.append(why)
    return "" if _cut_off(statement) else "; ".join(dict.fromkeys(whys))


def _contradicts(gates: Sequence[Gate], speech: guards.Language) -> bool:
    return guards.is_impossible(_build_guard_ways([Path(StatementStart("unknown"), tuple(gates))])[0], speech)


def _cut_off(statement: PublishStatement) -> bool:
    return len(statement.ways) >= _MOST_WAYS


def _select_own_way(statement: PublishStatement) -> list[Path]:
    """The one way through a statement's own function."""
    gates = tuple(gate for gate in statement.ways[0].gates if gate.of == statement.function)
    return [Path(StatementStart("unknown"), gates)]


def _list_roots(statement: PublishStatement, names: Renames, own: str) -> frozenset[str]:
    """The functions that nothing leads to in which ways begin, in the words of the new revision. own: what the function
    of the statement itself is called."""
    roots = (way.root for way in statement.ways if way.root)
    return frozenset(own if root == statement.function else _map_function(root, names) for root in roots)


def _list_functions(statement: PublishStatement, names: Renames, own: str) -> frozenset[str]:
    """The functions that are seen to lead to a statement, as for _list_roots."""
    named = {name for way in statement.ways for name in way.functions}
    return frozenset((own, *(own if name == statement.function else _map_function(name, names) for name in named)))


def _map_function(name: str, names: Renames) -> str:
    return names.map_text(normalize(name))


def _find_unseen(first: PublishStatement, second: PublishStatement, names: Renames) -> frozenset[str]:
    """The functions of which it is seen on one side alone what leads to them, as they are called now. It may lead to
    them on the other side too: only what they and those behind them ask tells of a change."""
    own = normalize(second.function)
    old_roots, new_roots = _list_roots(first, names, own), _list_roots(second, SAME, own)
    lost, gained = old_roots - new_roots, new_roots - old_roots
    found = lost & _list_functions(second, SAME, own) | gained & _list_functions(first, names, own)
    if not found and any(way.start.kind == "unknown" for way in first.ways if way.root):
        # What led to it and is not seen may be what leads to it now.
        led = _group_starts(second, SAME).keys() - _group_starts(first, names).keys()
        found = frozenset((own,)) if lost and any(kind not in _UNLED for kind, _ in led) else found
    return frozenset((own,)) if own in found else found


def _select_behind(
    functions: frozenset[str], first: PublishStatement, second: PublishStatement, names: Renames
) -> tuple[list[Path], list[Path]]:
    """The ways of both sides that are seen to run through some functions, from there on."""
    own = normalize(second.function)
    sides: list[list[Path]] = []
    for one, here in ((first, names), (second, SAME)):
        ways: dict[tuple[Gate, ...], None] = {}
        for way in one.ways:
            names_of = (own if name == one.function else _map_function(name, here) for name in way.functions)
            start = next((place for place, name in enumerate((*names_of, own)) if name in functions), None)
            if start is not None:
                behind = {*way.functions[start:], one.function}
                ways[tuple(gate for gate in way.gates if gate.of in behind)] = None
        sides.append([Path(StatementStart("unknown"), gates) for gates in ways])
    return sides[0], sides[1]


def _combine_kinds(kinds: Iterable[guards.Kind]) -> guards.Kind:
    found = set(kinds) - {"equivalent"}
    if not found:
        return "equivalent"
    return found.pop() if len(found) == 1 else "changed"


def _compare_guards(old: Sequence[Path], new: Sequence[Path], names: Renames, language: str) -> tuple[guards.Kind, str]:
    """What happened to the guards of some ways, and the clause that says it. Names for conditions are put back into the
    conditions first; where that is more than can be compared, what is written decides."""
    speech: guards.Language = "python" if language == "python" else "cpp"
    reading = guards.NameReading(names.words, speech)
    written, meant, known = ((_build_guard_ways(old, depth), _build_guard_ways(new, depth)) for depth in (0, 1, 2))
    kind = guards.compare_ways(*known, reading)
    if kind == "equivalent":
        return kind, ""
    kinds: dict[tuple[Ways, Ways], guards.Kind] = {
        pair: guards.compare_ways(*pair, reading) for pair in (written, meant, known)
    }
    if kinds[written] == "equivalent":
        same = _collect_condition_names(known[0], names) == _collect_condition_names(known[1], SAME)
        if (kind == "changed" and same) or _has_more_names(old, new) or _has_more_names(new, old):
            return "equivalent", ""  # what is asked is called otherwise, of the same things; or is known on one side
    if kind == "changed" and kinds[written] != "equivalent" and _means_same(old, new):
        kind = kinds[written]
    if _count_loops(old) != _count_loops(new):
        kind = "changed"  # a loop that comes or goes is a matter of how often, too
    clauses = [guards.explain_ways(*pair, reading) for pair in (written, meant) if kinds[pair] != "equivalent"]
    return kind, min(clauses, key=len) if clauses else guards.explain_ways(*known, reading)


def _has_more_names(ways: Sequence[Path], others: Sequence[Path]) -> bool:
    """Whether a name that is put back on some ways stands there as it is on others, in guards that are written alike.
    """
    meant = {gate.text: gate for way in ways for gate in way.gates}
    return any(
        not {*meant[gate.text].names}.difference(gate.names).isdisjoint(_WORDS.findall(gate.meaning or gate.text))
        for way in others
        for gate in way.gates
        if gate.text in meant
    )


def _means_same(old: Sequence[Path], new: Sequence[Path]) -> bool:
    """Whether what is written on both sides means the same on both."""
    sides = ({gate.text: (gate.meaning, gate.given) for way in ways for gate in way.gates} for ways in (old, new))
    before, after = sides
    return all(after.get(text, meaning) == meaning for text, meaning in before.items())


def _count_loops(ways: Sequence[Path]) -> set[int]:
    """How many loops there are on ways, each of which may run what is in it several times."""
    return {sum(gate.kind in ("while", "for", "do") for gate in way.gates) for way in ways}


def _build_guard_ways(ways: Iterable[Path], depth: int = 0) -> Ways:
    """The guards of ways. depth: 0 as written, 1 with names put back, 2 with parameters as what they are, too."""
    return tuple(
        tuple(GuardAt(gate.kind, _write_at(gate, depth), "", 0, gate.of) for gate in way.gates) for way in ways
    )


def _write_at(gate: Gate, depth: int) -> str:
    text = (depth and gate.meaning) or gate.text
    marked = tuple(one for one in gate.given if depth == 2 or PARAMETER in one[1])
    return put_given(text, marked if depth else ()) if marked else text


def _collect_condition_names(ways: Ways, names: Renames) -> set[tuple[str, ...]]:
    """What the conditions of some ways are about: variables and operators, without what is called of them."""
    return {
        tuple(
            found
            for guard in way
            for found in _ABOUT.findall(names.map_text(guard.text.replace("->", ".")))
            if not found.endswith("(")
        )
        for way in ways
    }


# What makes it run


def _pair_starts(
    first: PublishStatement, second: PublishStatement, names: Renames
) -> Iterator[tuple[frozenset[StatementStart], frozenset[StatementStart]]]:
    """What makes a statement run, before and after, as far as one took the other's place; empty where nothing did."""
    if all(way.start.kind in _UNLED for way in first.ways) != all(way.start.kind in _UNLED for way in second.ways):
        # What leads to it is seen on one side alone: then it is not compared.
        yield frozenset(way.start for way in first.ways), frozenset(way.start for way in second.ways)
        return
    old = _group_starts(first, names)
    new = _group_starts(second, SAME)
    for key in [key for key in old if key in new]:
        yield frozenset(old.pop(key)), frozenset(new.pop(key))
    for same in (True, False):
        for key in list(old):
            fitting = [other for other in new if other[0] == key[0] or not same]
            alone = same or (len(old) == len(new) == 1)
            if fitting and alone and len([one for one in old if one[0] == key[0] or not same]) == len(fitting):
                other = fitting[0]
                yield frozenset(old.pop(key)), frozenset(new.pop(other))
    for kind in {kind for kind, _ in old} & {kind for kind, _ in new}:
        # A topic that is not known may be any of those that are left.
        if any(start.open for side in (old, new) for key in side if key[0] == kind for start in side[key]):
            sides = [[start for key in [key for key in side if key[0] == kind] for start in side.pop(key)]
                     for side in (old, new)]  # fmt: skip
            yield frozenset(sides[0]), frozenset(sides[1])
    for starts in old.values():
        yield frozenset(starts), frozenset()
    for starts in new.values():
        yield frozenset(), frozenset(starts)


def _group_starts(statement: PublishStatement, names: Renames) -> dict[tuple[str, str], set[StatementStart]]:
    found: dict[tuple[str, str], set[StatementStart]] = {}
    for way in statement.ways:
        kind = "unknown" if way.start.kind in _UNSAID else way.start.kind
        found.setdefault((kind, _normalize_detail(names.map_text(way.start.detail))), set()).add(way.start)
    return found


def _normalize_detail(detail: str) -> str:
    """A period or name without what spelling alone decides."""
    word, _, paced = detail.partition(" ")
    period = parse_period(paced if word in ("every", "rate") else detail)
    if period is not None:
        return f"{word} {period}" if word in ("every", "rate") else f"{period}"
    text = "".join(detail.split()).replace("this->", "").replace("this.", "")
    return text.strip("/") if "/" in text else text


def _describe_caller(ways: Sequence[Path]) -> str:
    of = next((gate.of for way in ways for gate in way.gates), "")
    return f"`{of}`" if of else "another caller"


def _has_unknown_start(ways: Sequence[Path]) -> bool:
    return all(way.start.kind == "unknown" for way in ways)


def _start_differs(old_ways: Sequence[Path], new_ways: Sequence[Path], names: Renames) -> str:
    old, new = old_ways[0].start, new_ways[0].start
    if old.kind == new.kind and any(way.start.open for way in (*old_ways, *new_ways)):
        return ""  # whether it is another topic is not known
    if old.kind == new.kind:
        if old.kind in _UNSAID or _normalize_detail(names.map_text(old.detail)) == _normalize_detail(new.detail):
            return ""
        if not old.detail or not new.detail:
            if new.detail:
                return f"{_describe_start(new)}, was without pace"
            return f"{new.kind} without pace, was `{old.detail}`"
        return f"{_describe_start(new)}, was `{old.detail}`"
    if "unknown" in (old.kind, new.kind):
        return ""
    if "thread" in (old.kind, new.kind) and {old.kind, new.kind} <= {"thread", "start", "loop"}:
        return ""
    was, is_now = (", ".join(sorted({_describe_start(way.start) for way in ways})) for ways in (old_ways, new_ways))
    return f"on {is_now}, was on {was}"


def _describe_start(start: StatementStart) -> str:
    kind = {"start": "the start", "subscriber": "messages of", "thread": "loop"}.get(start.kind, start.kind)
    return f"{kind} `{start.detail}`" if start.detail else kind


def _compare_outlets(one: OutletAt, other: OutletAt, at: StatementPlace) -> Iterator[LogicChange]:
    old, new = one.outlet, other.outlet
    both = [new, old]

    def change(kind: Kind, was: str, is_now: str, why: str) -> LogicChange:
        found = _make_change(kind, at, both, was, is_now, why)
        return msgspec.structs.replace(found, path=other.path, line=new.line, function=new.function)

    # The namespace of a handle that was passed in is known by who passes it, and that may be any of several.
    untouched = one.content == other.content and old.topic.rpartition("/")[2] == new.topic.rpartition("/")[2]
    if old.topic and new.topic and old.topic.lstrip("/") != new.topic.lstrip("/") and not untouched:
        yield change("changed", old.topic, new.topic, f"published on `{new.topic}`, was `{old.topic}`")
    if old.type and new.type and old.type != new.type:
        yield change("changed", old.type, new.type, f"type `{new.type}` was `{old.type}`")
    before, after = dict(old.offers), dict(new.offers)
    of_ros1 = "reliability" not in before and "reliability" not in after
    clauses: list[str] = []
    for name in dict.fromkeys((*before, *after)):
        # What the system chooses is not known either.
        was, is_now = (
            "" if setting == "system_default" else setting for setting in (before.get(name, ""), after.get(name, ""))
        )
        # A latch that is not set is no latch; any other setting that is not set is unknown.
        if was != is_now and ((was and is_now) or (name == "durability" and of_ros1)):
            label = "queue" if name == "depth" else name
            clauses.append(f"{label} `{is_now or 'volatile'}` was `{was or 'volatile'}`")
    if clauses:
        yield change("trigger changed", _format_offers(old), _format_offers(new), "; ".join(clauses))


def _format_offers(outlet: Outlet) -> str:
    return ", ".join(f"{name} {setting}" for name, setting in outlet.offers) or outlet.written


def _describe_trigger(verb: str, statement: PublishStatement) -> str:
    starts = sorted({_describe_start(way.start) for way in statement.ways if way.start.kind not in _UNSAID})
    return f"{verb} on {', '.join(starts)}" if starts else verb


def _format_ways(ways: Sequence[Path], statement: PublishStatement) -> str:
    """The condition that a statement runs under, as one expression; what starts it before that where it is known."""
    python = statement.language == "python"
    by_start: dict[str, list[str]] = {}
    for way in ways[:_MOST_WAYS]:
        start = _describe_start(way.start) if way.start.kind not in _UNSAID else ""
        condition = (" and " if python else " && ").join(dict.fromkeys(_write_gate(gate, python) for gate in way.gates))
        by_start.setdefault(start, []).append(condition)
    reported: list[str] = []
    for start, conditions in by_start.items():
        alternatives = list(dict.fromkeys(conditions))
        text = "" if "" in alternatives else f" {'or' if python else '||'} ".join(alternatives)
        reported.append(f"{start}: {text}" if start and text else start or text)
    text = "; ".join(one for one in dict.fromkeys(reported) if one)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def _write_gate(gate: Gate, python: bool) -> str:
    text = gate.text
    if gate.kind in ("unless", "passed"):
        denied = _DENIED.fullmatch(text)
        if denied:
            return denied[1]
        return f"not ({text})" if python else f"!({text})"
    if gate.kind in ("if", "while"):
        needs = (" or " in text) if python else ("||" in text)
        return f"({text})" if needs else text
    if gate.kind == "never":
        return f"[never: {text}]"
    if gate.kind in ("for", "do", "catch", "with", "macro", "cpp"):
        return f"[{'#if' if gate.kind == 'cpp' else gate.kind} {text}]"
    return text
