"""Names that were renamed between two revisions of a text, as far as that is beyond doubt."""

import re
from collections import Counter
from collections.abc import Callable, Iterable
from difflib import SequenceMatcher

from .guard_reading import Language

_TOKEN = r"""
    \"\"\".*?\"\"\"|'''.*?'''|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'
    |(?P<comment>COMMENT)|(?P<name>[^\W\d]\w*)|\d[\w.']*|(?P<end>[;{}\n])|::|->|[-+*/%<>=!&|^]=?|\S
"""
_TOKENS: dict[Language, re.Pattern[str]] = {
    "cpp": re.compile(_TOKEN.replace("COMMENT", r"//[^\n]*|/\*.*?\*/|\#[^\n]*"), re.DOTALL | re.VERBOSE),
    "python": re.compile(_TOKEN.replace("COMMENT", r"\#[^\n]*"), re.DOTALL | re.VERBOSE),
}
_KEYWORDS = frozenset((
    "and", "or", "not", "in", "is", "if", "elif", "else", "return", "while", "for", "case", "del", "raise", "yield",
    "await", "lambda", "from", "import", "as", "with", "global", "nonlocal", "new", "delete", "throw", "goto",
    "co_return", "co_await", "typename", "using", "namespace", "print", "assert",
))  # fmt: skip
_TYPE_ENDS = frozenset(("*", "&", ">"))
_MOST_STATEMENTS = 20000

Statement = tuple[tuple[str, bool], ...]
"""Tokens, each with whether it is a name."""


def propose_moves(old: str, new: str, language: Language) -> dict[str, str]:
    """Variables and members of one text that are members of an object in the next: `ready` to `state.ready`, in Python
    `this.ready` to `this.state.ready`. old, new and what is beyond doubt as for propose_renames; that the class of the
    object has a member of the old name is no use of it."""
    if old == new:
        return {}
    before, after = (
        [_join_paths(statement, language) for statement in _split_statements(text, language)] for text in (old, new)
    )
    used = [
        [tuple((token, is_name and not _is_declared(one, place)) for place, (token, is_name) in enumerate(one))
         for one in statements]
        for statements in (before, after)
    ]  # fmt: skip
    found = _pair_names(used[0], used[1], _is_assigned)
    first = 1 if language == "python" else 0
    return {
        name: successor
        for name, successor in found.items()
        if name.count(".") == first and successor.count(".") > first and name.startswith("this.") == bool(first)
    }


def _join_paths(statement: Statement, language: Language) -> Statement:
    """A statement with paths as one name: `a->b.c` is `a.b.c`. What a method itself is of is left out in C++, where it
    may be, and is `this` in Python."""
    result: list[tuple[str, bool]] = []
    joins = False
    for token, is_name in statement:
        if token in (".", "->") and result and result[-1][1]:
            joins = True
        elif joins and is_name:
            joins = False
            result[-1] = (token if result[-1][0] == "this" else f"{result[-1][0]}.{token}", True)
            if language == "python" and result[-1][0].startswith("self."):
                result[-1] = (f"this.{token}", True)
        else:
            if joins:
                result.append((".", False))
            joins = False
            result.append((token, is_name))
    return tuple(result)


def _is_declared(statement: Statement, place: int) -> bool:
    """Whether a name follows a type, and nothing is assigned to it there."""
    if place == 0:
        return False
    before, is_name = statement[place - 1]
    following = statement[place + 1][0] if place + 1 < len(statement) else ""
    return ((is_name and before not in _KEYWORDS) or before in _TYPE_ENDS) and following != "="


def _is_assigned(statement: Statement, place: int) -> bool:
    return place + 1 < len(statement) and statement[place + 1][0] in ("=", ":=")


def propose_renames(old: str, new: str, language: Language) -> dict[str, str]:
    """Identifiers of one text that are called otherwise in the next, old name to new name.

    old, new: the whole text of what is compared (all files that may know the names, one after the other). Proposed is
    a name that is gone from the text, when one that was not there before stands in its place in statements that are
    the same otherwise: always the same one, in most of its places, two at the least, and where it is declared or
    assigned among them. A name that only ever is asked for is not renamed: another one is asked.
    """
    if old == new:
        return {}
    return _pair_names(_split_statements(old, language), _split_statements(new, language), _is_made)


def _pair_names(
    before: list[Statement], after: list[Statement], is_made: Callable[[Statement, int], bool]
) -> dict[str, str]:
    """Names that are gone to those that stand in their places; see propose_renames."""
    if len(before) + len(after) > _MOST_STATEMENTS:
        return {}
    counted_before, counted_after = _count_names(before), _count_names(after)
    gone = counted_before.keys() - counted_after.keys()
    come = counted_after.keys() - counted_before.keys()
    if not gone or not come:
        return {}
    pairs: Counter[tuple[str, str]] = Counter()
    made: set[tuple[str, str]] = set()
    for one, other in _pair_statements(before, after, gone, come):
        for place, ((name, _), (successor, _)) in enumerate(zip(one, other, strict=True)):
            if name in gone and successor in come:
                pairs[name, successor] += 1
                if is_made(one, place):
                    made.add((name, successor))
    successors: dict[str, set[str]] = {}
    predecessors: dict[str, set[str]] = {}
    for name, successor in pairs:
        successors.setdefault(name, set()).add(successor)
        predecessors.setdefault(successor, set()).add(name)
    return {
        name: successor
        for (name, successor), times in sorted(pairs.items())
        if len(successors[name]) == len(predecessors[successor]) == 1
        and times >= 2
        and (name, successor) in made
        and 2 * times > max(counted_before[name], counted_after[successor])
    }


def _split_statements(text: str, language: Language) -> list[Statement]:
    """A text's statements: what stands between `;`, `{` and `}`, in Python also between the ends of lines."""
    result: list[Statement] = []
    tokens: list[tuple[str, bool]] = []
    for match in _TOKENS[language].finditer(text):
        if match["comment"]:
            continue
        if match["end"] == "\n" and language == "cpp":
            continue
        if match["end"]:
            if tokens:
                result.append(tuple(tokens))
                tokens = []
        else:
            tokens.append((match[0], bool(match["name"])))
    if tokens:
        result.append(tuple(tokens))
    return result


def _count_names(statements: list[Statement]) -> Counter[str]:
    return Counter(token for statement in statements for token, is_name in statement if is_name)


def _pair_statements(
    before: list[Statement], after: list[Statement], gone: set[str], come: set[str]
) -> Iterable[tuple[Statement, Statement]]:
    """Statements that are the same save for names that are gone and come."""
    shapes_before = [_mask_names(statement, gone) for statement in before]
    shapes_after = [_mask_names(statement, come) for statement in after]
    for first, second, length in SequenceMatcher(None, shapes_before, shapes_after, False).get_matching_blocks():
        yield from zip(before[first : first + length], after[second : second + length], strict=True)


def _mask_names(statement: Statement, names: set[str]) -> tuple[str, ...]:
    return tuple("" if is_name and token in names else token for token, is_name in statement)


def _is_made(statement: Statement, place: int) -> bool:
    """Whether the name at a place of a statement is declared, defined or assigned there."""
    following = statement[place + 1][0] if place + 1 < len(statement) else ""
    if following in ("=", ":=") or (following == ":" and place == 0):
        return True
    if place == 0:
        return False
    before, is_name = statement[place - 1]
    if before == "::":
        # The definition of a method, `void A::b(`; a call has no type before it.
        return place > 2 and statement[place - 3][1] and statement[place - 3][0] not in _KEYWORDS and following == "("
    return (is_name and before not in _KEYWORDS) or (
        before in _TYPE_ENDS and place > 1 and following in ("", ",", ")", "(")
    )
