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
_BACKTICK = re.compile(r"`[^`\n]*`")
_TUPLE_PARAMETER = re.compile(r"\bdef[ \t]+\w+[ \t]*\((?:[\w \t\n,]*,)?\s*(\([\w \t\n,]*\))")
# Names that Python 3 made keywords; `async` and `await` only with 3.7.
_KEYWORD_NAME = re.compile(
    r"(?<=\.)(None|True|False|async|await)\b|(?<![\w.])(async|await)(?=[ \t]*(?:[.,)\]]|=(?!=)))"
    r"|(?:\bdef|\bimport|\bas)[ \t]+(async|await)\b(?![ \t]+\w)"
)


def mask(text: str) -> str:
    """The text with the inside of strings and comments blanked; quotes, newlines and offsets stay."""

    def blank(match: re.Match[str]) -> str:
        hidden = match.group()
        if hidden[0] == "#" or len(hidden) < 2:
            return " " * len(hidden)
        inside = _NOT_NEWLINE.sub(lambda line: " " * len(line.group()), hidden[1:-1])
        return hidden[0] + inside + ("\n" if hidden[-1] == "\n" else hidden[0])

    return _HIDDEN.sub(blank, text)


def without_tabs(text: str) -> str:
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

    def replace(start: int, end: int, by: str) -> None:
        edits.append((start, end, by.ljust(end - start)[: end - start]))

    for match in _PRINT.finditer(visible):
        hits.append((match.start(1), "print statement"))
        replace(match.start(1), match.end(1), "0,")
        if match.group(2):
            replace(match.start(2), match.end(2), "")
    for match in _EXCEPT.finditer(visible):
        hits.append((match.start(), f"`{' '.join(match.group().rstrip(': ').split())}`"))
        replace(match.start(1), match.end(1), "")
    for match in _EXEC.finditer(visible):
        hits.append((match.start(1), "exec statement"))
        replace(match.start(1), match.end(1), "0,")
    for match in _RAISE.finditer(visible):
        hits.append((match.start(1), '`raise E, "message"`'))
        replace(match.start(1), match.end(1), "0,")
    for match in _UNEQUAL.finditer(visible):
        hits.append((match.start(), "`<>`"))
        replace(match.start(), match.end(), "!=")
    for match in _OCTAL.finditer(visible):
        hits.append((match.start(), "octal number without 0o"))
        replace(match.start(1), match.end(1), "")
    for match in _LONG.finditer(visible):
        hits.append((match.start(), "long integer"))
        replace(match.start(1), match.end(1), "")
    for match in _UNICODE_RAW.finditer(visible):
        hits.append((match.start(), "ur string"))
        replace(match.start(1), match.end(1), "")
    for match in _BACKTICK.finditer(visible):
        hits.append((match.start(), "backticks"))
        replace(match.start(), match.start() + 1, "(")
        replace(match.end() - 1, match.end(), ")")
    for match in _TUPLE_PARAMETER.finditer(visible):
        hits.append((match.start(), "tuple parameter"))
        name = "_" * (match.end(1) - match.start(1))
        if "\n" not in match.group(1):
            replace(match.start(1), match.end(1), name)
    for match in _KEYWORD_NAME.finditer(visible):
        group = match.lastindex or 0
        hits.append((match.start(group), f"`{match.group(group)}` as a name"))
        replace(match.start(group), match.end(group), match.group(group)[:-1] + "_")

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
