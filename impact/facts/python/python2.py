"""Python 2 syntax: found in text that Python 3 refuses, and rewritten in place so that the rest can still be read.

Sources: the lists of syntax changes in "What's New In Python 3.0" and 3.7; PEP 492, 3105, 3109, 3110, 3113, 3127.
"""

import re

from ..place import Problem

# Strings and comments, blanked before anything is looked for. A prefix stays, so that ur"" is seen.
_HIDDEN = re.compile(
    r'"""(?:[^"\\]+|\\[\s\S]|"(?!""))*(?:""")?'
    r"|'''(?:[^'\\]+|\\[\s\S]|'(?!''))*(?:''')?"
    r'|"(?:[^"\\\n]+|\\[\s\S])*"?'
    r"|'(?:[^'\\\n]+|\\[\s\S])*'?"
    r"|#[^\n]*"
)
_INDENTATION = re.compile(r"^[ \t]*\t[ \t]*", re.MULTILINE)
_NOT_NEWLINE = re.compile(r"[^\n]+")
_STATEMENT = r"(?:(?<=\n)|(?<=;)|(?<=:)|\A)[ \t]*"

_PRINT = re.compile(
    _STATEMENT + r"(print)(?:[ \t]*(>>)|[ \t]*(?=[\"'`])|[ \t]+(?!(?:in|is|and|or|if|not|for)\b)(?=[A-Za-z_0-9{\[]))"
    r"(?![ \t]*\w+[ \t]*=[^=])"
)
_EXCEPT = re.compile(
    r"except[ \t]+(?:[\w.]+(?:\([^()\n]*\))?|\([^()]*\))[ \t]*(,[ \t]*(?:[\w.\[\]]+|\([\w, \t]*\)))[ \t]*:"
)
_EXEC = re.compile(_STATEMENT + r"(exec)(?:[ \t]*(?=[\"'])|[ \t]+(?=[A-Za-z_0-9]))")
_RAISE = re.compile(_STATEMENT + r"(raise)[ \t]+[\w.]+(?:\([^()\n]*\))?[ \t]*,")
_UNEQUAL = re.compile(r"<>")
_OCTAL = re.compile(r"(?<![\w.])(0+)(?=[1-9][0-9]*(?![\w.]))")
_LONG = re.compile(r"(?<![\w.])(?:0[xX][0-9a-fA-F]+|[0-9]+)([lL])\b")
_UNICODE_RAW = re.compile(r"\b([uU])[rR](?=[\"'])")
_BACKTICK = re.compile(r"(`)[^`\n]*(`)")
_TUPLE_PARAMETER = re.compile(r"\bdef[ \t]+\w+[ \t]*\((?:[\w \t\n,]*,)?\s*(\([\w \t\n,]*\))")
# What to look for, what it is called (empty: what was found), and what to write for its groups (0: for all of it).
_REWRITES: tuple[tuple[re.Pattern[str], str, dict[int, str]], ...] = (
    (_PRINT, "print statement", {1: "0,", 2: ""}),
    (_EXCEPT, "", {1: ""}),
    (_EXEC, "exec statement", {1: "0,"}),
    (_RAISE, '`raise E, "message"`', {1: "0,"}),
    (_UNEQUAL, "`<>`", {0: "!="}),
    (_OCTAL, "octal number without 0o", {1: ""}),
    (_LONG, "long integer", {1: ""}),
    (_UNICODE_RAW, "ur string", {1: ""}),
    (_BACKTICK, "backticks", {1: "(", 2: ")"}),
    (_TUPLE_PARAMETER, "tuple parameter", {1: "_" * 1000}),
)
# Names that Python 3 made keywords; `async` and `await` only with 3.7.
_KEYWORD_NAME = re.compile(
    r"(?<=\.)(None|True|False|async|await)\b|(?<![\w.])(async|await)(?=[ \t]*(?:[.,)\]]|=(?!=)))"
    r"|(?:\bdef|\bimport|\bas)[ \t]+(async|await)\b(?![ \t]+\w)"
)


def mask(text: str) -> str:
    """The text with the inside of strings and comments blanked; quotes, newlines and offsets stay."""

    def blank_match(match: re.Match[str]) -> str:
        hidden = match.group()
        if hidden[0] == "#" or len(hidden) < 2:
            return " " * len(hidden)
        inside = _NOT_NEWLINE.sub(lambda line: " " * len(line.group()), hidden[1:-1])
        return hidden[0] + inside + ("\n" if hidden[-1] == "\n" else hidden[0])

    return _HIDDEN.sub(blank_match, text)


def expand_tabs(text: str) -> str:
    """The text with its indentation in spaces, as Python 2 reads it: a tab goes on to the next multiple of eight."""
    return _INDENTATION.sub(lambda match: match.group().expandtabs(8), text)


def find(text: str) -> tuple[tuple[Problem, ...], str]:
    """Syntax that only Python 2 accepts, one Problem per kind and line, and the text rewritten for Python 3.

    Only meaningful for text that Python 3 has refused: some of it could be read otherwise. The rewritten text has the
    same length and the same lines, and need not mean the same; it is there to be parsed for imports and names.
    """
    visible = mask(text)
    edits: list[tuple[int, int, str]] = []
    hits: list[tuple[int, str]] = []

    def replace(match: re.Match[str], group: int, by: str) -> None:
        start, end = match.span(group)
        if start >= 0 and "\n" not in match.group(group):  # lines stay
            edits.append((start, end, by.ljust(end - start)[: end - start]))

    for pattern, what, groups in _REWRITES:
        for match in pattern.finditer(visible):
            hits.append((match.start(), what or f"`{' '.join(match.group().rstrip(': ').split())}`"))
            for group, by in groups.items():
                replace(match, group, by)
    for match in _KEYWORD_NAME.finditer(visible):
        group = match.lastindex or 0
        hits.append((match.start(group), f"`{match.group(group)}` as a name"))
        replace(match, group, match.group(group)[:-1] + "_")

    pieces: list[str] = []
    position = 0
    for start, end, by in sorted(edits):
        if start >= position:
            pieces += (text[position:start], by)
            position = end
    pieces.append(text[position:])

    problems: dict[tuple[int, str], None] = {}
    line, at = 1, 0
    for start, what in sorted(hits):
        line += text.count("\n", at, start)
        at = start
        problems[line, what] = None
    return tuple(Problem(line, what) for line, what in problems), "".join(pieces)
