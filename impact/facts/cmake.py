"""CMake sources to commands, as cmake-language(7) defines them. Meaning is given by model/build.py."""

import re
from typing import NamedTuple

import msgspec

from .place import Problem


class CMakeArgument(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One argument: its raw text (references not expanded, escapes kept), how it was quoted, where it starts.

    quoting: `` for unquoted, `"` for quoted, `[` for bracket arguments.
    """

    text: str
    quoting: str
    line: int
    column: int


class Command(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One command invocation. name is in lower case, arguments in order; nested parentheses appear as `(` and `)`."""

    name: str
    arguments: tuple[CMakeArgument, ...]
    line: int
    column: int
    end_line: int


class CMakeFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """All commands of a file in order, flat; block structure is made by the interpreter."""

    commands: tuple[Command, ...]
    problems: tuple[Problem, ...] = ()


# One token per match, with the space and the line comments before it. Every alternative that can fail is followed by
# one that cannot, so nothing is ever tried twice. The shapes are those of CMake's own lexer (cmListFileLexer.in.l).
_TOKEN = re.compile(
    r"""
    (?:[ \t\r\n] | \#(?!\[=*\[)[^\n]*)*
    (?:
        (?P<unquoted>
            (?!\[=*\[) (?:[^\ \t\r\n()\#"\\$\0]+ | \\[^\n\0] | \$(?:\([A-Za-z0-9_]*\))?)
            (?:[^\ \t\r\n()\#"\\$\0]+ | \\[^\n\0] | \$(?:\([A-Za-z0-9_]*\))?
             | "(?:[^\s()\#"\\$]|[ \t]|\\[^\n\0]|\$(?:\([A-Za-z0-9_]*\))?)*")*
        )
      | (?P<open>\()
      | (?P<close>\))
      | "(?P<quoted>[^"\\]*(?:\\.[^"\\]*)*)"
      | (?P<bracket>\#?\[(?P<level>=*)\[\n?)
      | (?P<other>.)
      | (?P<end>\Z)
    )
    """,
    re.VERBOSE | re.DOTALL,
)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_COMMAND_LINE = re.compile(r"^[ \t]*([A-Za-z_][A-Za-z0-9_]*)[ \t]*\(", re.MULTILINE)
_LOGICAL = frozenset({"and", "or", "not"})

# A file that needs more repairs than this is not CMake; each repair reads the rest of the file again.
_REPAIRS = 20


class _Open(NamedTuple):
    """A command that is not closed yet."""

    name: str
    line: int
    column: int
    arguments: list[CMakeArgument]

    def build_command(self, end_line: int) -> Command:
        return Command(self.name, tuple(self.arguments), self.line, self.column, end_line)


def extract(data: bytes) -> CMakeFile:
    """Reads one CMake file. Never raises: whatever cannot be read is a problem and the rest is still parsed.

    Bytes that are not UTF-8 are replaced; a command or string that is never closed ends where the next line starts
    that looks like a command.
    """
    problems: list[Problem] = []
    text = _decode(data, problems)
    commands: list[Command] = []
    position = 0
    line = 1
    for _ in range(_REPAIRS):
        resume = _scan(text, position, line, commands, problems)
        if resume is None:
            break
        line += text.count("\n", position, resume)
        position = resume
    else:
        problems.append(Problem(line, "too many unclosed commands, the rest was not read"))
    return CMakeFile(tuple(commands), tuple(problems))


def _decode(data: bytes, problems: list[Problem]) -> str:
    if data.startswith(b"\xef\xbb\xbf"):
        data = data[3:]
    elif data.startswith((b"\xff\xfe", b"\xfe\xff")):
        problems.append(Problem(1, "the file is UTF-16, which CMake does not read"))
        return data.decode("utf-16", errors="replace").replace("\r\n", "\n")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        problems.append(Problem(data.count(b"\n", 0, error.start) + 1, "a byte that is not UTF-8"))
        text = data.decode("utf-8", errors="replace")
    return text.replace("\r\n", "\n") if "\r\n" in text else text


def _scan(text: str, position: int, line: int, commands: list[Command], problems: list[Problem]) -> int | None:
    """Reads commands from position on into `commands`. Returns where to go on after a repair, None when done."""
    match = _TOKEN.match
    counted = position  # the lines up to here are in `line`
    line_start = text.rfind("\n", 0, position) + 1
    depth = 0
    opened = _Open("", 0, 0, [])
    pending: _Open | None = None  # an identifier that wants its parenthesis
    last_command_line = 0
    while True:
        token = match(text, position)
        if token is None:  # cannot happen: the last alternative matches everywhere
            return None
        position = token.end()
        kind = token.lastgroup
        start = token.start(kind)  # type: ignore[arg-type]
        if kind == "quoted":
            start -= 1
        elif kind == "level":
            kind = "bracket"
            start = token.start("bracket")
        newlines = text.count("\n", counted, start)
        if newlines:
            line += newlines
            line_start = text.rfind("\n", 0, start) + 1
        counted = start
        column = start - line_start + 1

        if depth == 0:
            if pending is not None and kind != "open":
                lacking = f"`{_shorten(pending.name)}` is no command: no parenthesis follows"
                problems.append(Problem(pending.line, lacking))
                pending = None
            if kind == "unquoted":
                word = token.group("unquoted")
                if _NAME.match(word):
                    if last_command_line == line:
                        problems.append(Problem(line, f"`{_shorten(word)}` follows a command on the same line"))
                    pending = _Open(word, line, column, [])
                else:
                    problems.append(Problem(line, f"`{_shorten(word)}` is no command"))
            elif kind == "open" and pending is not None:
                opened, pending = pending._replace(name=pending.name.lower()), None
                depth = 1
            elif kind == "end":
                return None
            elif kind == "bracket" and token.group("bracket")[0] == "#":
                position = _read_bracket(text, token, line, problems)[1]
            else:
                problems.append(Problem(line, f"`{_shorten(token.group(kind))}` where a command was expected"))  # type: ignore[arg-type]
                end = text.find("\n", start)
                if end < 0:
                    return None
                position = end
            continue

        if kind == "unquoted":
            opened.arguments.append(CMakeArgument(token.group("unquoted"), "", line, column))
        elif kind == "quoted":
            opened.arguments.append(CMakeArgument(token.group("quoted"), '"', line, column))
        elif kind == "close":
            depth -= 1
            if depth:
                opened.arguments.append(CMakeArgument(")", "", line, column))
            else:
                commands.append(opened.build_command(line))
                last_command_line = line
        elif kind == "open":
            depth += 1
            opened.arguments.append(CMakeArgument("(", "", line, column))
        elif kind == "bracket":
            content, position = _read_bracket(text, token, line, problems)
            if token.group("bracket")[0] != "#":
                opened.arguments.append(CMakeArgument(content, "[", line, column))
        elif kind == "other" and token.group("other") != '"':
            problems.append(Problem(line, f"`{_shorten(token.group('other'))}` in the arguments of {opened.name}()"))
        elif kind == "other":
            problems.append(Problem(line, f"a string in {opened.name}() is never closed"))
            return _close_early(text, start, line, column, opened, commands)
        else:
            problems.append(Problem(opened.line, f"{opened.name}() is never closed"))
            return _cut(text, _find_next_line(text, opened.line, start), start, opened, commands)


def _read_bracket(text: str, token: re.Match[str], line: int, problems: list[Problem]) -> tuple[str, int]:
    """Content of a bracket argument or comment and where it ends. An unclosed one is its first line."""
    closing = "]" + token.group("level") + "]"
    begin = token.end()
    end = text.find(closing, begin)
    if end >= 0:
        return text[begin:end], end + len(closing)
    problems.append(Problem(line, f"`{token.group('bracket').strip()}` is never closed"))
    stop = text.find("\n", begin)
    stop = len(text) if stop < 0 else stop
    return text[begin:stop], stop


def _close_early(text: str, start: int, line: int, column: int, opened: _Open, commands: list[Command]) -> int:
    """Ends a string that no quote closes at its line's end, and its command with it."""
    end = text.find("\n", start)
    end = len(text) if end < 0 else end
    opened.arguments.append(CMakeArgument(text[start + 1 : end].rstrip().rstrip(")"), '"', line, column))
    commands.append(opened.build_command(line))
    following = _COMMAND_LINE.search(text, end)
    return following.start(1) if following else len(text)


def _find_next_line(text: str, line: int, end: int) -> int:
    """Offset of the line that follows line number `line`, or `end` when there is none."""
    position = -1
    for _ in range(line):
        position = text.find("\n", position + 1)
        if position < 0:
            return end
    return position + 1


def _cut(text: str, begin: int, end: int, opened: _Open, commands: list[Command]) -> int:
    """Ends a command that no parenthesis closes where the next line starts that looks like a command."""
    for following in _COMMAND_LINE.finditer(text, begin, end):
        if following.group(1).lower() in _LOGICAL:
            continue
        stop = following.start(1)
        last = text.count("\n", 0, stop) + 1
        kept = [argument for argument in opened.arguments if argument.line < last]
        commands.append(opened._replace(arguments=kept).build_command(last - 1))
        return stop
    commands.append(opened.build_command(text.count("\n", 0, end) + 1))
    return end


def _shorten(text: str) -> str:
    printable = "".join(letter if letter.isprintable() else "?" for letter in text[:30])
    return printable + ("…" if len(text) > 30 else "")
