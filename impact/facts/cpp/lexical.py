"""C and C++ sources to facts: includes with their preprocessor conditions, and the names that are used.

Reading is lexical. Comments and literals are blanked without moving an offset, conditional directives cut the rest
into segments, and names are collected per segment. Nothing is expanded: what a macro hides is hidden here too.
"""

import hashlib
import re
import sys
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import accumulate, chain, count, islice
from operator import add
from typing import NamedTuple

import msgspec

from ..condition import Condition
from ..place import Problem, Reference
from .tree_nodes import RegisteredNode, TreeNodes, list_node_classes, list_tree_nodes

_SLASHES = re.compile("/+")


class Include(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An #include. path as written between the delimiters, but with one slash for several; angled True for <...>."""

    path: str
    angled: bool
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()


class NameUseInFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The first use of a name outside comments, strings and #include lines, per distinct set of conditions.

    text: a qualified name as written without spaces (`std::min`, `cv::imread`, `tf2_ros::Buffer`), or a bare word.
    """

    text: str
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()


class CppFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """includes in order; qualified: distinct qualified names; words: distinct bare identifiers (not keywords) with at
    least four characters, space-joined and sorted (positions are found again in the bytes when a finding needs them);
    short: the shorter ones, sorted; defined: macros and include guards the file defines; using: full names in lines
    `using a::b`; opened: namespaces of lines `using namespace`; spaces: (name, namespace) of other names of namespaces.
    exports: classes given to macros of pluginlib, rclcpp_components and Gazebo, as written without spaces; references:
    packages and files named by literals (`package://`, getPath, get_package_share_directory).
    namespaces: those that it adds to. type_names: last parts of the types that it seems to define, aliases among
    them; announced: of those that it only declares; aliased: of the qualified names in typedefs, which need no more
    than an announcement. variables: qualified types of which some line declares a variable or member itself, not a
    pointer or reference. made: classes of which it makes objects by `new`, make_shared() or make_unique(). parents:
    derived classes and aliases of types, with the words of their bases or of what they stand for. initializes: a
    constructor may initialize members, or a container makes elements (`emplace_back`). code: a digest of all but
    comments, literals, includes and blanks. tree_nodes: what tree_nodes.py finds; None for nothing. errors: #error
    lines under conditions, with their messages.
    """

    includes: tuple[Include, ...]
    qualified: tuple[NameUseInFile, ...]
    words: str
    short: str = ""
    defined: tuple[str, ...] = ()
    using: tuple[str, ...] = ()
    opened: tuple[str, ...] = ()
    spaces: tuple[tuple[str, str], ...] = ()
    problems: tuple[Problem, ...] = ()
    exports: tuple[str, ...] = ()
    references: tuple[Reference, ...] = ()
    namespaces: tuple[str, ...] = ()
    type_names: tuple[str, ...] = ()
    announced: tuple[str, ...] = ()
    aliased: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()
    made: tuple[str, ...] = ()
    parents: tuple[tuple[str, str], ...] = ()
    initializes: bool = False
    code: str = ""
    tree_nodes: TreeNodes | None = None
    errors: tuple[NameUseInFile, ...] = ()

    @property
    def types(self) -> tuple[str, ...]:
        """The types that it defines in namespaces, with each of these, since which encloses which is not followed."""
        found = (f"{space}::{name}" for space in self.namespaces for name in self.type_names)
        return tuple(islice(found, _MOST_TYPES))


# Conditions beyond these are one unknown condition: hostile input must not cost quadratic memory.
DEEPEST = 48
MOST_BRANCHES = 48
UNTOLD = Condition("cpp", "<too many conditions>")
IN_MACRO = Condition("cpp", "<where the macro is used>")

_KEYWORD_TEXT = """
    alignas alignof asm auto bool break case catch char char8_t char16_t char32_t class co_await co_return co_yield
    concept const const_cast consteval constexpr constinit continue decltype default delete do double dynamic_cast else
    enum explicit export extern false float for friend goto if inline int long mutable namespace new noexcept nullptr
    operator private protected public register reinterpret_cast requires restrict return short signed sizeof static
    static_assert static_cast struct switch template this thread_local throw true try typedef typeid typename union
    unsigned using virtual void volatile wchar_t while define undef final override
"""
KEYWORDS = frozenset(_KEYWORD_TEXT.split())

# Every alternative starts with a literal, so that the search skips plain code at the speed of a character set.
_HIDDEN = re.compile(
    r"""
      //[^\n]*(?:(?:(?<=\\)\n|\n[ ]*//)[^\n]*)*                           # comments; a backslash continues one
    | /\*[^*]*(?:\*(?!/)[^*]*)*(?P<end>\*/)?                              # comment; no end is a problem
    | "(?<=R")(?:(?<![A-Za-z0-9_]R")|(?<=[uUL8]R"))(?P<raw>[^\s()\\"]{0,16})\((?s:.*?)(?:\)(?P=raw)"|\Z)
    | "(?:[^"\\\n]+|\\[\s\S])*"?
    | '(?:(?<=[0-9a-fA-F]')(?<!u8')(?<!case')(?=[0-9a-fA-F])              # digit separator
        | (?:[^'\\\n]+|\\[\s\S])*'?)
    | \#[ \t]*(?:include(?:_next)?|import)\b(?:[ \t]|\\\n|/\*[^*\n]*\*/)*
        (?:<(?P<angled>[^>\n]{0,1000})>|"(?P<quoted>[^"\n]{0,1000})"|(?P<computed>[A-Za-z_]\w*))
    | \#[ \t]*(?:error\b(?P<error>[^\n]*(?:(?<=\\)\n[^\n]*)*))
    | \#[ \t]*(?:warning|pragma|line|ident)\b[^\n]*(?:(?<=\\)\n[^\n]*)*
    """,
    re.VERBOSE,
)
_DIRECTIVE = re.compile(
    r"#[ \t]*(ifdef|ifndef|if|elifdef|elifndef|elif|else|endif|define)\b([^\n]*(?:(?<=\\)\n[^\n]*)*)"
)
COMMENT = re.compile(r"//[^\n]*|/\*.*?(?:\*/|\Z)", re.DOTALL)
"""A comment, one that is not ended too."""
_IDENTIFIER = re.compile(r"[^\W\d]\w*")
_WORDS = re.compile(r"\w+(?:\s*::\s*\w+)*")
# White space to an expression, but not to bytes.split().
_TIE = "\x1f"
_SPREAD = re.compile(r"::(?:\s|(?<=\s::))")
_AHEAD = re.compile(r"::\s+(?=\w)")
_LONGEST_PIECE = 50_000
_NOT_IN_TOKEN = re.compile(r"[^\w:\x1f]")
_NO_TOKEN = re.compile(r"[^\w\x00-\x7f]")
_IN_TOKEN = re.compile(r"[\w:\x1f]")
_ONLY_TOKENS = bytes(at if at > 127 or chr(at).isalnum() or chr(at) in "_:\x1f" else 32 for at in range(256))
_KEYWORD_BYTES = frozenset(word.encode() for word in KEYWORDS)
_AFTER_NUMBERS = b":"
# What a lookahead has matched is not tried again in shorter forms.
_VARIABLE = re.compile(r"::(?=\s*([^\W\d]\w*(?:::[^\W\d]\w*)*))\s*\1[ \t]+\w+[ \t]*[;={]")
_BEFORE_VARIABLE = re.compile(r"[ \t]*(?:(?:static|const|mutable)[ \t]+)*(?:([^\W\d]\w*)([ \t]*))?")
_TAIL = re.compile(r"::\s*([^\W\d]\w*)((?:\s*::\s*[^\W\d]\w*)*)")
_SIMPLE_NAME = re.compile(r"([^\W\d]\w*)(?:::[^\W\d]\w*)+")
_HEAD_BACKWARDS = re.compile(r"\s*(\w*[^\W\d])(?!\w)")
_USING = re.compile(r"using\s+(?:(namespace)\s+|typename\s+)?(?:::\s*)?([^\W\d]\w*(?:\s*::\s*[^\W\d]\w*)*)\s*;")
_SPACE_NAME = re.compile(r"namespace\s+(\w+)\s*=\s*(?:::\s*)?(\w[\w:\s]{0,300}?)\s{0,20};")
_EXPORT = re.compile(
    r"(?P<macro>PLUGINLIB_(?:EXPORT|REGISTER|DECLARE)_CLASS(?:_\w+)?|RCLCPP_COMPONENTS_REGISTER_NODE(?:_\w+)?"
    r"|CLASS_LOADER_REGISTER_CLASS(?:_\w+)?|RCLCPP_COMPONENTS_REGISTER_NODES"
    r"|GZ_REGISTER_\w+_PLUGIN|(?:GZ|IGNITION)_ADD_PLUGIN)\s*\((?P<arguments>[^;{}]{0,500}?)\)"
)
EXPORTING = ("PLUGINLIB_", "RCLCPP_COMPONENTS_", "CLASS_LOADER_REGISTER")
_EXPORTING = (*EXPORTING, "GZ_REGISTER_", "GZ_ADD_PLUGIN", "IGNITION_ADD_PLUGIN")
_BEGIN_EXPORTS = tuple(map(re.compile, _EXPORTING))
_PACKAGE_URL = re.compile(r'"package://([A-Za-z]\w*)(?:/([^"\n]*))?"')
_PACKAGE_CALL = re.compile(
    r"(?:package::getPath|get_package_share_directory|get_package_prefix|get_package_share_path)\s*\(\s*(\")"
)
_PACKAGE_LITERAL = re.compile(r'"([A-Za-z]\w*)"\s*[,)]')
_SPACE = re.compile(r"\s+")


def decode_source(data: bytes) -> str:
    """The text of a source, one line break form, undecodable bytes as one replacement character each or so."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16", "replace")
    else:
        text = data.decode("utf-8-sig", "replace")
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    return text


def find_line_starts(text: str) -> list[int]:
    """The offset at which each line of a text begins, and that of its end."""
    return [0, *map(add, accumulate(map(len, text.split("\n"))), count(1))]


_NOT_NEWLINE = re.compile(r"[^\n]+")


def blank_stretches(text: str, gone: Iterable[tuple[int, int]]) -> str:
    """A text with some stretches blanked, its lines as they are. gone: sorted, where each begins and ends."""
    pieces: list[str] = []
    position = 0
    for start, end in gone:
        if end > position:
            start = max(start, position)
            pieces += [text[position:start], _NOT_NEWLINE.sub(make_blanks, text[start:end])]
            position = end
    return "".join(pieces) + text[position:]


def make_blanks(match: re.Match[str]) -> str:
    """As many blanks as what was found has characters."""
    return " " * len(match[0])


# Where a directive begins and ends, its word, and what follows that.
Directive = tuple[int, int, str, str]


def list_conditional_blocks(directives: Iterable[Directive]) -> Iterator[list[Directive]]:
    """The directives of every #if that is closed, from it to its #endif; inner ones first."""
    opened: list[list[Directive]] = []
    for directive in directives:
        if directive[2] in ("if", "ifdef", "ifndef"):
            opened.append([directive])
        elif opened and directive[2] in ("elif", "elifdef", "elifndef", "else"):
            opened[-1].append(directive)
        elif opened and directive[2] == "endif":
            yield [*opened.pop(), directive]


class _Blocks:
    """The stack of open #if blocks; gives the conditions in force."""

    def __init__(self) -> None:
        self.open: list[tuple[list[Condition], Condition | None]] = []
        self.kept: dict[tuple[Condition, ...], tuple[Condition, ...]] = {}

    def list_conditions(self) -> tuple[Condition, ...]:
        result: list[Condition] = []
        for earlier, own in self.open[:DEEPEST]:
            if len(earlier) > MOST_BRANCHES:
                result.append(UNTOLD)
            else:
                result += earlier
            if own is not None:
                result.append(own)
        if len(self.open) > DEEPEST:
            result.append(UNTOLD)
        key = tuple(result)
        return self.kept.setdefault(key, key)

    def turn(self, own: Condition | None) -> None:
        """Into the next branch: the one left is negated. own is None for #else."""
        earlier, last = self.open.pop()
        if last is not None and len(earlier) <= MOST_BRANCHES:
            earlier.append(Condition("cpp", last.text, not last.negated))
        self.open.append((earlier, own))


def _make_condition(keyword: str, text: str) -> Condition:
    text = sys.intern(text)
    if keyword in ("ifdef", "elifdef", "ifndef", "elifndef"):
        name = _IDENTIFIER.match(text)
        text = sys.intern(f"defined({name.group() if name else text})")
        return Condition("cpp", text, keyword in ("ifndef", "elifndef"))
    return Condition("cpp", text)


def _guard(directives: list[Directive], visible: str) -> tuple[int, int] | None:
    """Indices of the #ifndef and #endif of a guard around the whole file, None when there is none."""
    first = next((index for index, directive in enumerate(directives) if directive[2] != "define"), None)
    if first is None or first + 1 >= len(directives):
        return None
    _, _, keyword, text = directives[first]
    if keyword == "ifndef":
        name = _IDENTIFIER.match(text)
    elif keyword == "if":
        name = re.fullmatch(r"!\s*defined\s*\(?\s*([^\W\d]\w*)\s*\)?", text)
    else:
        return None
    defined = _IDENTIFIER.match(directives[first + 1][3]) if directives[first + 1][2] == "define" else None
    if name is None or defined is None or name.group(name.lastindex or 0) != defined.group():
        return None
    depth = 0
    for index in range(first, len(directives)):
        keyword = directives[index][2]
        if keyword in ("if", "ifdef", "ifndef"):
            depth += 1
        elif keyword == "endif":
            depth -= 1
            if depth == 0:
                return (first, index) if not visible[directives[index][1] :].strip() else None
        elif keyword != "define" and depth == 1:
            return None
    return None


class _Piece(NamedTuple):
    """Where a piece of a file begins, its conditions, its text, the same as bytes with blanks for what belongs to no
    token, and the tokens: words, a qualified name as one."""

    start: int
    conditions: tuple[Condition, ...]
    text: str
    apart: bytes
    tokens: set[bytes]

    def find(self, token: bytes) -> int:
        """Where a token first stands by itself, -1 without such a place."""
        at = self.apart.find(b" " + token + b" ")
        if at > 0 and not self.text.isascii():
            return len(self.apart[1 : at + 1].decode())
        return at

    def find_beginning(self, token: str) -> int:
        """The same for one that begins with colons, which belong to nothing before them. They do in
        `vector<int>::iterator`."""
        at = self.text.find(token)
        while at >= 0:
            if not _IN_TOKEN.match(self.text, at + len(token)):
                before = self.text[at - 1 : at]
                if not _IN_TOKEN.match(before) and before not in (">", ")"):
                    break
            at = self.text.find(token, at + 1)
        return at


@dataclass(eq=False)
class Scan:
    """A file with comments, literals and includes blanked out, cut into stretches that stand under equal conditions."""

    text: str
    visible: str
    locate: Callable[[int], tuple[int, int]]
    segments: list[tuple[int, int, tuple[Condition, ...]]]
    found: list[tuple[int, bool, str]]
    errors: list[tuple[int, str]]
    defined: dict[str, None]
    problems: list[Problem]
    ends: list[int]
    directives: list[Directive]

    def find_segment(self, offset: int) -> tuple[int, int, tuple[Condition, ...]]:
        """The stretch around an offset; inside a directive the one that follows."""
        return self.segments[min(bisect_right(self.ends, offset), len(self.segments) - 1)]

    def list_tree_nodes(self) -> Iterator[RegisteredNode]:
        """The nodes of behaviour trees that the file registers."""
        return list_tree_nodes(self.text, self.visible, lambda offset: self.find_segment(offset)[2])

    def read_tree_nodes(self) -> TreeNodes | None:
        """The nodes of behaviour trees that the file registers, and the classes and functions that tell their ports;
        None where it has none."""
        classes, functions = list_node_classes(self.text, self.visible)
        nodes = {msgspec.structs.replace(node, conditions=()): None for node in self.list_tree_nodes()}
        found = TreeNodes(tuple(sorted(nodes, key=repr)), classes, functions)
        return found if nodes or classes or functions else None

    def find_conditions(self, offset: int) -> tuple[Condition, ...] | None:
        """The conditions around an offset, None inside a directive."""
        start, _, conditions = self.find_segment(offset)
        return conditions if start <= offset else None

    @cached_property
    def macro_lines(self) -> frozenset[int]:
        """The lines that macros are defined on."""
        defined = ((start, end) for start, end, keyword, _ in self.directives if keyword == "define")
        spans = (range(self.locate(start)[0], self.locate(end)[0] + 1) for start, end in defined)
        return frozenset(chain.from_iterable(spans))

    @cached_property
    def pieces(self) -> list[_Piece]:
        """The stretches; long ones are in several pieces, since each name is looked for from the start."""
        tied = _tie(self.visible)
        pieces: list[_Piece] = []
        for start, end, conditions in self.segments:
            while start < end:
                gap = _NOT_IN_TOKEN.search(tied, start + _LONGEST_PIECE, end) if end - start > _LONGEST_PIECE else None
                stop = gap.start() if gap is not None else end
                text = tied[start:stop]
                apart = f" {text} ".encode().translate(_ONLY_TOKENS)
                pieces.append(_Piece(start, conditions, text, apart, set(apart.split())))
                start = stop
        return pieces

    @cached_property
    def tokens(self) -> set[bytes]:
        """All tokens outside of conditions of directives."""
        first, *others = [piece.tokens for piece in self.pieces] or [set[bytes]()]
        return first.union(*others) if others else first

    @cached_property
    def tokens_text(self) -> str:
        """The tokens: what is in none of them need not be looked for in the text, which is far longer."""
        return b" ".join(self.tokens).decode()


def _make_locator(text: str) -> Callable[[int], tuple[int, int]]:
    """Gives line and column of offsets, from 1. Each is counted from the one before, which is most often near."""
    line, begin, last = 1, 0, 0

    def locate(offset: int) -> tuple[int, int]:
        nonlocal line, begin, last
        if offset >= last:
            passed = text.count("\n", last, offset)
            if passed:
                line += passed
                begin = text.rfind("\n", last, offset) + 1
        else:
            passed = text.count("\n", offset, last)
            if passed:
                line -= passed
                begin = text.rfind("\n", 0, offset) + 1
        last = offset
        return line, offset - begin + 1

    return locate


# What a macro of deprecation is given as its advice, a sentence that it makes a literal of: four words and more.
_ADVICE = re.compile(r"(?:(?<=DEPRECATED\()|(?<=DEPRECATED_MSG\())\s*[\w:]+(?:[ \t]+[\w:]+){3,}\s*(?=\))")


@lru_cache(maxsize=4)
def scan(data: bytes) -> Scan:
    """Reads a file as far as all that looks into it needs."""
    text = decode_source(data)
    problems: list[Problem] = []
    locate = _make_locator(text)
    found: list[tuple[int, bool, str]] = []
    errors: list[tuple[int, str]] = []

    def blank_match(match: re.Match[str]) -> str:
        hidden = match.group()
        first = hidden[0]
        if first == "#":
            group = match.lastgroup
            if group == "angled" or group == "quoted":
                found.append((match.start(group), group == "angled", match.group(group)))
            elif group == "error":
                errors.append((match.start(), match.group(group)))
            elif group == "computed":
                problems.append(Problem(locate(match.start())[0], f"`#include {match.group(group)}` names a macro"))
        elif first == '"':
            # Quotes stay, so that a literal can be told from a comment.
            if "\n" not in hidden and len(hidden) > 1:
                return '"' + " " * (len(hidden) - 2) + '"'
        elif first == "'":
            if hidden == "'":
                return hidden
        elif hidden[1] == "*" and match.lastgroup is None:
            problems.append(Problem(locate(match.start())[0], "comment without an end"))
        if "\n" in hidden:
            return "\n".join([" " * len(line) for line in hidden.split("\n")])
        return " " * len(hidden)

    visible = _HIDDEN.sub(blank_match, text)
    if "DEPRECATED" in visible:
        visible = _ADVICE.sub(lambda match: _NOT_NEWLINE.sub(make_blanks, match[0]), visible)

    directives: list[Directive] = []
    for match in _DIRECTIVE.finditer(visible):
        start = match.start()
        line_start = visible.rfind("\n", 0, start) + 1
        if visible[line_start:start].strip():
            continue
        body = match.group(2)
        if '"' in body:
            body = COMMENT.sub(" ", text[match.start(2) : match.end(2)])
        directives.append((start, match.end(), match.group(1), " ".join(body.replace("\\\n", " ").split())))

    guard = _guard(directives, visible)
    blocks = _Blocks()
    segments: list[tuple[int, int, tuple[Condition, ...]]] = []
    defined: dict[str, None] = {}
    position = 0
    conditions: tuple[Condition, ...] = ()
    for index, (start, end, keyword, body) in enumerate(directives):
        if keyword == "define":
            name = _IDENTIFIER.match(body)
            if name:
                defined[sys.intern(name.group())] = None
            if "::" in body:  # what a macro stands for is used where the macro is, which may be nowhere
                segments += ((position, start, conditions), (start, end, (*conditions, IN_MACRO)))
                position = end
            continue
        segments.append((position, start, conditions))
        position = end
        if guard and index in guard:
            continue
        if keyword in ("if", "ifdef", "ifndef"):
            blocks.open.append(([], _make_condition(keyword, body)))
        elif not blocks.open:
            problems.append(Problem(locate(start)[0], f"`#{keyword}` without `#if`"))
        elif keyword == "endif":
            blocks.open.pop()
        else:
            blocks.turn(None if keyword == "else" else _make_condition(keyword, body))
        conditions = blocks.list_conditions()
    segments.append((position, len(visible), conditions))
    if blocks.open:
        problems.append(Problem(text.count("\n") + 1, f"{len(blocks.open)} `#if` without `#endif`"))
    ends = [end for _, end, _ in segments]
    return Scan(text, visible, locate, segments, found, errors, defined, problems, ends, directives)


def find_at_line_starts(pattern: re.Pattern[str], text: str) -> Iterator[re.Match[str]]:
    """The matches that begin a line, blanks before them aside. An expression that says so itself is slower by far than
    one that starts with a literal."""
    for match in pattern.finditer(text):
        at = match.start()
        if not text[text.rfind("\n", 0, at) + 1 : at].strip(" \t"):
            yield match


def find_words(name: str, text: str, begin: int = 0, stop: int = sys.maxsize) -> Iterator[int]:
    """Where a name stands as a whole word, between two places; nowhere where it is empty."""
    at = text.find(name, begin, stop) if name else -1
    while at >= 0:
        end = at + len(name)
        after, before = text[end : end + 1], text[at - 1] if at else ""
        if not (after.isalnum() or after == "_" or before.isalnum() or before == "_"):
            yield at
        at = text.find(name, end, stop)


def find_word_uses(data: bytes, word: str) -> Iterator[tuple[int, int, tuple[Condition, ...]]]:
    """Line, column and preprocessor conditions of every use of a bare identifier outside comments and literals."""
    scanned = scan(data)
    for at in find_words(word, scanned.visible):
        conditions = scanned.find_conditions(at)
        if conditions is not None:
            yield (*scanned.locate(at), conditions)


def extract(data: bytes) -> CppFile:
    """The facts of one C or C++ file. Never raises; what could not be read is in `problems`.

    Undecodable bytes become replacement characters, so columns are those of an editor that shows them so.
    """
    scanned = scan(data)
    visible, locate, tokens_text = scanned.visible, scanned.locate, scanned.tokens_text
    if visible.count("(") != visible.count(")") and (at := _find_unmatched(scanned)) is not None:
        calls = [name for name in _CALLED.findall(visible, max(0, at - 1000), at + 1) if name not in KEYWORDS]
        scanned.problems.append(Problem(locate(at)[0], UNMATCHED + (calls[-1] if calls else "this") + "()"))
    words: set[bytes] = set()
    with_colons: set[bytes] = set()
    qualified: list[NameUseInFile] = []
    seen: dict[tuple[Condition, ...], set[str]] = {}
    for piece in scanned.pieces:
        joined = [token for token in piece.tokens if b":" in token]
        with_colons.update(joined)
        known = seen.setdefault(piece.conditions, set())
        found: list[tuple[int, str]] = []
        for token in joined:
            names, bare = _split_names(token)
            words.update(bare)
            for offset, name, begins in names:
                if name not in known:
                    at = piece.find_beginning(token.decode()) if begins else piece.find(token)
                    if at >= 0:
                        found.append((piece.start + at + offset, name))
        found.sort()
        for at, name in found:
            if name not in known:
                known.add(name)
                qualified.append(NameUseInFile(name, *locate(at), piece.conditions))

    words |= scanned.tokens
    words -= with_colons
    words -= _KEYWORD_BYTES
    ordered = sorted(words)
    ordered = ordered[bisect_right(ordered, _AFTER_NUMBERS) :]
    long_words = [word for word in ordered if len(word) > 3 and (word.isascii() or len(word.decode()) > 3)]
    using, opened = _list_using_names(visible) if "using" in tokens_text else ((), ())
    has_namespace = "namespace" in tokens_text
    type_names, announced, aliased, parents = _list_types(visible, tokens_text)
    return CppFile(
        includes=collect_includes(scanned),
        qualified=tuple(qualified),
        words=b" ".join(long_words).decode(),
        short=b" ".join([word for word in ordered if len(word) <= 3]).decode(),
        defined=tuple(scanned.defined),
        using=using,
        opened=opened,
        spaces=_list_space_names(visible) if has_namespace else (),
        problems=tuple(sorted(scanned.problems, key=_get_line)),
        exports=list_exports(visible) if any(word in tokens_text for word in _EXPORTING) else (),
        references=_find_references(scanned.text, visible, locate),
        namespaces=_list_namespaces(visible) if has_namespace else (),
        type_names=type_names,
        announced=announced,
        aliased=aliased,
        variables=_list_variable_types(visible),
        made=_list_made_classes(visible, tokens_text),
        parents=parents,
        initializes="emplace" in tokens_text or _INITIALIZES.search(visible) is not None,
        code=hashlib.sha1(visible.encode().translate(None, b" \t\r\n")).hexdigest()[:16],
        tree_nodes=scanned.read_tree_nodes(),
        errors=_list_errors(scanned),
    )


UNMATCHED = "a parenthesis has no counterpart in a call of "
_CALLED = re.compile(r"([^\W\d]\w*)\s*\(")
_BRACKET = re.compile(r"[(){}]")


def _find_unmatched(scanned: Scan) -> int | None:
    """The first parenthesis without a counterpart; None where it may depend on conditions which one has it."""
    parts = [(start, scanned.visible[start:end], conditions) for start, end, conditions in scanned.segments]
    written = (match.group() for match in _DIRECTIVE.finditer(scanned.visible))
    if any(text.count("(") != text.count(")") for text in written):
        return None  # a macro may have what the code lacks
    if any(conditions and part.count("(") != part.count(")") for _, part, conditions in parts):
        return None
    opened: list[tuple[str, int]] = []
    for start, part, conditions in parts:
        for match in () if conditions else _BRACKET.finditer(part):
            bracket, at = match.group(), start + match.start()
            if bracket in "({":
                opened.append((bracket, at))
            elif bracket == ")" and (not opened or opened[-1][0] == "{"):
                return at
            elif bracket == "}" and opened and opened[-1][0] == "(":
                return opened[-1][1]
            elif opened:
                opened.pop()
    return next((at for bracket, at in opened if bracket == "("), None)


def _list_using_names(visible: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The names that `using a::b` makes known, and the namespaces that are opened."""
    names: dict[str, None] = {}
    opened: dict[str, None] = {}
    for match in find_at_line_starts(_USING, visible):
        (opened if match.group(1) else names)[sys.intern(_SPACE.sub("", match.group(2)))] = None
    return tuple(names), tuple(opened)


def _list_space_names(visible: str) -> tuple[tuple[str, str], ...]:
    return tuple((match.group(1), _SPACE.sub("", match.group(2))) for match in _SPACE_NAME.finditer(visible))


def _tie(visible: str) -> str:
    """A text in which the blanks around `::` between two words are _TIE, so that a qualified name is one token."""
    tied = visible.replace(_TIE, " ")
    if _SPREAD.search(tied) is not None:
        tied = _AHEAD.sub(_tie_match, _AHEAD.sub(_tie_match, tied)[::-1])[::-1]
    return tied if tied.isascii() else _NO_TOKEN.sub(" ", tied)


def _tie_match(match: re.Match[str]) -> str:
    return "::" + _TIE * (len(match.group()) - 2)


@lru_cache(maxsize=20_000)
def _split_names(token: bytes) -> tuple[tuple[tuple[int, str, bool], ...], tuple[bytes, ...]]:
    """The qualified names in a token that has a colon by where they begin, with whether the token begins with the
    colons of one that has no first part; and its bare words."""
    text = token.decode()
    simple = _SIMPLE_NAME.fullmatch(text)
    if simple is not None and simple.group(1) not in KEYWORDS:
        return ((0, sys.intern(text), False),), ()
    bare = [word for word in _WORDS.findall(text) if ":" not in word]
    names: list[tuple[int, str, bool]] = []
    backwards, length = text[::-1], len(text)
    for tail in _TAIL.finditer(text):
        at = tail.start()
        head = _HEAD_BACKWARDS.match(backwards, length - at)
        name_at, name = tail.start(1), tail.group(1) + tail.group(2)
        if head is not None:
            spelt = head.group(1)[::-1]
            # `return ::close(fd)`, `API ::ns::Type f()`: the colons start the name.
            apart = head.start(1) > head.start() and text[at + 2] != _TIE
            if spelt not in KEYWORDS and not (apart and spelt.isupper()):
                name_at, name = length - head.end(1), spelt + "::" + name
            elif not tail.group(2):
                bare.append(name)
        if "::" in name:
            names.append((name_at, sys.intern(_SPACE.sub("", name)), not at))
    return tuple(names), tuple(word.encode() for word in bare)


def _list_variable_types(visible: str) -> tuple[str, ...]:
    """The qualified types of variables that begin a line."""
    variables: dict[str, None] = {}
    for match in _VARIABLE.finditer(visible):
        at = match.start()
        before = _BEFORE_VARIABLE.fullmatch(visible, visible.rfind("\n", 0, at) + 1, at)
        if before is not None:
            head, blank = before.groups("")
            name = f"{head}::{match.group(1)}" if head else match.group(1)
            if head not in KEYWORDS and not (blank and head.isupper()) and "::" in name and name.isascii():
                variables[sys.intern(name)] = None
    return tuple(variables)


# An expression that starts with a literal skips plain code; what stands before it is looked at after.
_NAMESPACE = re.compile(r"namespace(?<!\wnamespace)\s+([^\W\d]\w*(?:\s*::\s*[^\W\d]\w*)*)\s*\{")
_TYPE = re.compile(
    r"(?:(?:struct|class|union|enum(?:\s+class|\s+struct)?)\s{1,20}"
    r"(?:[A-Za-z_]\w{0,60}(?:\([^(){};\n]{0,80}\))?\s{1,20}){0,3}?(?:\w{1,60}::){0,4}(?P<type>[^\W\d]\w*)\s{0,20}"
    r"(?P<special><(?:[^;{}():]|::){1,200}>\s{0,20})?(?:final\s{0,20})?"
    r"(?::(?P<bases>[^:;{}()][^;{}()]{0,1000})[{(]|\{)"
    r"|(?:struct|class|enum)\s+(?P<announced>[A-Za-z_]\w*)(?:\s*:\s*\w+)?\s*;"
    r"|using\s{1,20}(?P<alias>[^\W\d]\w*)\s{0,20}=(?P<meant>[^;{}()]{0,400})"
    r"|typedef\s(?P<typedef>[^;{}]{1,400}?)\b(?P<defined>[^\W\d]\w*)\s{0,20};"
    # The macro of ros/message_forward.h that announces a message.
    r"|ROS_DECLARE_MESSAGE\s*\(\s*(?P<message>[^\W\d]\w*)"
    r"|typedef\s{1,20}(?=(?:struct|class|union|enum)[^;{}]{0,100}\{[^{}]{0,4000}\}\s*(?P<struct>[^\W\d]\w*)))"
)
_TYPE_WORDS = ("struct", "class", "union", "enum", "using", "typedef", "ROS_DECLARE_MESSAGE")
_BEGIN_TYPES = {word: re.compile(rf"{word}(?<!\w{word})") for word in _TYPE_WORDS}
_MOST_TYPES = 400
_LAST_PART = re.compile(r"::\s*([A-Za-z_]\w*)(?!\w|\s*::)")
_INITIALIZES = re.compile(r"\)\s*(?:noexcept\s*)?:\s*[A-Za-z_]")
_MADE = [
    re.compile(rf"{word}(?<!\w{word}){between}(?:::)?([A-Za-z_]\w*(?:::\w+)*)\s*[>(;{{,)]")
    for word, between in (("new", r"\s+"), ("make_shared", r"\s*<\s*"), ("make_unique", r"\s*<\s*"))
]


def _list_namespaces(visible: str) -> tuple[str, ...]:
    return tuple(sys.intern(name) for name in dict.fromkeys(_SPACE.sub("", m) for m in _NAMESPACE.findall(visible)))


def _list_types(visible: str, tokens_text: str):
    """What a file says of types: type_names, announced, aliased and parents of CppFile. tokens_text: all its words."""
    names, announced, aliased, parents = [], [], [], []
    begins = [begin for word, begin in _BEGIN_TYPES.items() if word in tokens_text]
    for match in _matches(_TYPE, begins, visible):
        if match["announced"]:
            announced.append(match["announced"])
            continue
        name = match["type"] or match["alias"] or match["defined"] or match["message"] or match["struct"]
        if not match["special"]:
            names.append(name)
        if match["typedef"]:
            aliased += _LAST_PART.findall(match[0])
        meant = match["bases"] or match["meant"] or match["typedef"]
        if meant and "(" not in meant:
            parents.append((sys.intern(name), " ".join(_IDENTIFIER.findall(meant))))
    names, announced, aliased = (tuple(dict.fromkeys(map(sys.intern, each))) for each in (names, announced, aliased))
    return names, announced, aliased, tuple(dict.fromkeys(parents))


def _list_made_classes(visible: str, tokens_text: str) -> tuple[str, ...]:
    """The classes of which a file makes objects on the heap."""
    if "new" not in tokens_text and "make_" not in tokens_text:
        return ()
    return tuple(dict.fromkeys(sys.intern(name) for pattern in _MADE for name in pattern.findall(visible)))


def _matches(pattern: re.Pattern[str], begins: Iterable[re.Pattern[str]], text: str) -> Iterator[re.Match[str]]:
    """The matches of an expression, each of which begins with one of some words; these are found first, since a search
    for one word is far faster than that for several."""
    position = 0
    for at in sorted([found.start() for begin in begins for found in begin.finditer(text)]):
        if at >= position and (match := pattern.match(text, at)) is not None:
            position = match.end()
            yield match


def _get_line(item: Problem | Reference) -> int:
    return item.line


_LONGEST_MESSAGE = 80


def _list_errors(scanned: Scan) -> tuple[NameUseInFile, ...]:
    """The #error lines that stand under conditions."""
    found = []
    for offset, text in scanned.errors:
        conditions = scanned.find_segment(offset)[2]
        if conditions:
            message = " ".join(text.replace("\\\n", " ").split())[:_LONGEST_MESSAGE]
            found.append(NameUseInFile(message, *scanned.locate(offset), conditions))
    return tuple(found)


def collect_includes(scanned: Scan) -> tuple[Include, ...]:
    """The #include lines of a file, in its order."""
    includes: list[Include] = []
    for offset, angled, path in scanned.found:
        line, column = scanned.locate(offset)
        path = _SLASHES.sub("/", path.strip())
        includes.append(Include(sys.intern(path), angled, line, column - 1, scanned.find_segment(offset)[2]))
    return tuple(includes)


def list_exports(visible: str) -> tuple[str, ...]:
    """Classes registered as plugins, those of Gazebo too, or components: the first argument, or the later one of ROS
    1's old macros."""
    exports: dict[str, None] = {}
    for match in _matches(_EXPORT, _BEGIN_EXPORTS, visible):
        line_start = visible.rfind("\n", 0, match.start()) + 1
        if visible[line_start : match.start()].lstrip().startswith("#"):
            continue
        arguments = [_SPACE.sub("", argument) for argument in match.group("arguments").split(",")]
        macro = match.group("macro")
        index = 2 if macro.startswith("PLUGINLIB_DECLARE") else 1 if macro.startswith("PLUGINLIB_REGISTER") else 0
        if index < len(arguments) and arguments[index].strip("()"):
            exports[arguments[index].strip("()").removeprefix("::")] = None
    return tuple(exports)


# What is joined to the folder of a package: literals, and whether something else follows.
_JOINED = re.compile(r"""\s*\)*\s*((?:[+/]\s*"[^"\n]*"\s*)+)([+/])?""")


def _find_name_below(after: str) -> str:
    """The path that literals join to the folder of a package, without a last name that goes on with a variable."""
    joined = _JOINED.match(after)
    if joined is None:
        return ""
    path = "/".join(re.findall(r'"([^"]*)"', joined.group(1)))
    parts = [part for part in (path.rpartition("/")[0] if joined.group(2) else path).split("/") if part]
    return "" if ".." in parts else "/".join(parts)


def _find_references(text: str, visible: str, locate) -> tuple[Reference, ...]:
    references: list[Reference] = []
    for match in _PACKAGE_URL.finditer(text) if '"package://' in text else ():
        if visible[match.start()] == '"':
            kind = "file" if match.group(2) else "package"
            references.append(Reference(kind, match.group(1), match.group(2) or "", *locate(match.start(1))))
    for match in _PACKAGE_CALL.finditer(visible) if "::getPath" in visible or "get_package_" in visible else ():
        literal = _PACKAGE_LITERAL.match(text, match.start(1))
        if literal:
            name = _find_name_below(text[literal.end() : literal.end() + 200])
            kind = "place" if name else "package"
            references.append(Reference(kind, literal.group(1), name, *locate(literal.start(1))))
    return tuple(sorted(references, key=_get_line))
