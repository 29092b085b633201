"""Function-like macros of a file that make endpoints or parameters, or put names together: expanded where the same file
uses them. No line moves. What a macro of another file stands for is not known here."""

import re
from bisect import bisect_right
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from .lexical import decode_source, scan

_DEFINE = re.compile(
    r"^[ \t]*#[ \t]*define[ \t]+(?P<name>\w+)\((?P<parameters>[\w \t,.]*)\)"
    r"(?P<body>(?:[^\n\\]|\\\n|\\[^\n])*)",
    re.MULTILINE,
)
_LIKE_FUNCTION = re.compile(rb"#[ \t]*define[ \t]+\w+\(")
_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\\n|\\[^\n])*", re.MULTILINE)
_UNDEFINED = re.compile(r"^[ \t]*#[ \t]*undef[ \t]+(\w+)", re.MULTILINE)
# Methods that make what the graph shows, as a macro calls them.
_MAKES = re.compile(
    r"\b(?:advertise\w*|subscribe\w*|serviceClient|create_\w*|declare_parameter\w*|get_parameter\w*|param|getParam)"
    r"\s*[<(]"
)
# A text that is put together: literals, parameters, and what joins them.
_TEXT = re.compile(r'(?:"(?:[^"\\\n]|\\.)*"|\b\w+\b|::|[\s()+#])+')
_TOKEN = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'|\s*##\s*|#\s*(?=[A-Za-z_])|[A-Za-z_]\w*')
_LITERAL = re.compile(r'"(?:[^"\\\n]|\\.)*"')
_WORD = re.compile(r"[A-Za-z_]\w*")
_MOST_DEEP = 4
_LONGEST = 1 << 20
_LONGEST_USE, _MOST_OPEN = 10_000, 20
_VARIADIC = "__VA_ARGS__"


class _Macro(NamedTuple):
    parameters: tuple[str, ...]
    body: str


def expand_macros(data: bytes) -> bytes:
    """A source with the uses of such macros replaced by what they stand for; the source itself where it has none."""
    if _LIKE_FUNCTION.search(data) is None:
        return data
    text = decode_source(data)
    macros = _find_macros(text)
    if not macros:
        return data
    visible = scan(data).visible
    if len(visible) != len(text):
        return data
    expansion = _Expansion()
    whole = expansion.expand_inside(text, visible, macros, _MOST_DEEP)
    return data if whole == text or expansion.left < 0 else whole.encode()


def _find_macros(text: str) -> dict[str, _Macro]:
    """The macros that are defined in one way."""
    found: dict[str, _Macro | None] = dict.fromkeys(_UNDEFINED.findall(text))
    for match in _DEFINE.finditer(text):
        parameters = tuple(one.strip() for one in match["parameters"].split(",")) if match["parameters"].strip() else ()
        if parameters[-1:] == ("...",):
            parameters = (*parameters[:-1], _VARIADIC)
        body = match["body"].replace("\\\n", " ").strip()
        macro = _Macro(parameters, body)
        same = match["name"] not in found or found[match["name"]] == macro
        found[match["name"]] = macro if same and parameters else None
    known = {name: one for name, one in found.items() if one is not None}
    followed: dict[str, _Macro] = {}
    for _ in range(_MOST_DEEP):  # those that use others of these
        before = len(followed)
        followed.update((name, one) for name, one in known.items() if _is_followed(one, followed))
        if len(followed) == before:
            break
    return followed


def _is_followed(macro: _Macro, followed: Mapping[str, _Macro]) -> bool:
    """Whether a macro makes something, or puts a text together. followed: others that do."""
    if _MAKES.search(macro.body.replace("##", "")) or not followed.keys().isdisjoint(_WORD.findall(macro.body)):
        return "//" not in macro.body and "/*" not in macro.body
    if _TEXT.fullmatch(macro.body) is None or ('"' not in macro.body and "#" not in macro.body):
        return False
    words = (one for one in _TOKEN.findall(macro.body) if one[:1] not in "\"'#" and one.strip() != "##")
    return all(one in macro.parameters or one in ("std", "string") for one in words)


def _list_uses(
    text: str, visible: str, macros: dict[str, _Macro]
) -> Iterator[tuple[int, int, str, list[str]]]:  # fmt: skip
    """Start, end, name and arguments of the uses of macros outside of directives, none inside another."""
    directives = [match.span() for match in _DIRECTIVE.finditer(text)]
    starts = [start for start, _ in directives]
    behind = open_uses = 0
    for match in re.finditer(rf"\b(?:{'|'.join(map(re.escape, macros))})[ \t]*\(", visible):
        start = match.start()
        before = bisect_right(starts, start) - 1
        if start < behind or (before >= 0 and start < directives[before][1]):
            continue
        name = match[0].rstrip("( \t")
        end, arguments = _read_arguments(text, visible, match.end())
        if end:
            behind = end
            yield start, end, name, arguments
        else:
            open_uses += 1
        if open_uses > _MOST_OPEN:
            return  # each is looked through for its end


def _read_arguments(text: str, visible: str, at: int) -> tuple[int, list[str]]:
    """Where the bracket that opens before a place is closed, 0 where it is not, and what stands between its commas."""
    depth, begun = 0, at
    arguments: list[str] = []
    for place in range(at, min(len(visible), at + _LONGEST_USE)):
        mark = visible[place]
        if mark in "([{":
            depth += 1
        elif mark in ")]}" and depth:
            depth -= 1
        elif mark == ")" or (mark == "," and not depth):
            arguments.append(" ".join(text[begun:place].split("\n")).strip())
            begun = place + 1
            if mark == ")":
                return place + 1, arguments
    return 0, []


class _Expansion:
    """The expansion of the macros of a file."""

    def __init__(self) -> None:
        # Characters that may still come of it.
        self.left = _LONGEST

    def expand_inside(self, text: str, visible: str, macros: dict[str, _Macro], deep: int) -> str:
        """A text with the uses of macros in it expanded. visible: the same without literals."""
        pieces: list[str] = []
        at = 0
        for start, end, name, arguments in _list_uses(text, visible, macros):
            whole = self._expand(name, arguments, macros, deep)
            if whole is not None:
                pieces += (text[at:start], whole, "\n" * text.count("\n", start, end))
                at = end
            if self.left < 0:
                break
        return "".join((*pieces, text[at:]))

    def _expand(self, name: str, arguments: list[str], macros: dict[str, _Macro], deep: int) -> str | None:
        """What a use of a macro stands for; None where it has another number of arguments."""
        macro = macros[name]
        if macro.parameters[-1] == _VARIADIC and len(arguments) >= len(macro.parameters):
            last = len(macro.parameters) - 1
            arguments = [*arguments[:last], ", ".join(arguments[last:])]
        if len(arguments) != len(macro.parameters) or any("//" in one or "/*" in one for one in arguments):
            return None
        whole = _substitute(macro.body, dict(zip(macro.parameters, arguments, strict=True)))
        self.left -= len(whole)
        others = {other: one for other, one in macros.items() if other != name}
        if not others or not deep or self.left < 0:
            return whole
        visible = _LITERAL.sub(lambda match: '"' + " " * (len(match[0]) - 2) + '"', whole)
        return self.expand_inside(whole, visible, others, deep - 1)


def _substitute(body: str, given: dict[str, str]) -> str:
    """The body of a macro with what it is given for its parameters."""
    pieces: list[str] = []
    at = 0
    quoted = False
    for match in _TOKEN.finditer(body):
        pieces.append(body[at : match.start()])
        at = match.end()
        word = match[0]
        if word.strip() == "##":
            continue
        if word.strip() == "#":
            quoted = True
            continue
        value = given.get(word, word)
        if quoted:
            value = '"{}"'.format(value.replace("\\", "\\\\").replace('"', '\\"')) if word in given else f"#{word}"
        pieces.append(value)
        quoted = False
    return "".join((*pieces, body[at:]))
