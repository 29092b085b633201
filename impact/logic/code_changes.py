"""Functions whose code differs between two states: comments, white space and what is only logged play no part."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from ..facts.flow import FlowFile, FlowFunction
from .guards import Language
from .match import normalize

_COMMON = r"\"\"\".*?\"\"\"|'''.*?'''|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*'|\w+|\n|[^\w\s]"
_TOKENS: dict[Language, re.Pattern[str]] = {
    "cpp": re.compile(rf"R\"(\w*)\(.*?\)\1\"|//[^\n]*|/\*.*?\*/|{_COMMON}", re.DOTALL),
    "python": re.compile(rf"\#[^\n]*|{_COMMON}", re.DOTALL),
}
_LOGS = re.compile(r"(?:RCLCPP|ROS|ROSCPP|RCUTILS)_(?:LOG_)?(?:DEBUG|INFO|WARN|ERROR|FATAL)\w*|MOOSTrace")
_PYTHON_LOGS = re.compile(
    r"^\s*(?:rospy\.log\w+|(?:[\w.]+\.)?(?:get_logger\(\)|_?logger|_?log)\.(?:debug|info|warn|warning|error|fatal)\w*"
    r"|print)\s*\("
)


class ChangedFunction(NamedTuple):
    """A function that is new or another. path: of its file now; known: the base has one of its name."""

    path: str
    name: str
    line: int
    owner: str
    known: bool


def find_changed_functions(
    path: str, before: FlowFile | None, old_text: str, after: FlowFile, new_text: str, words: Mapping[str, str]
) -> Iterator[ChangedFunction]:
    """Functions of a file that are new or differ from those of their name at the base, in their order.

    before: None where there was no file. words: identifiers of the old text that are called otherwise in the new one.
    """
    language: Language = "python" if after.language == "python" else "cpp"
    old_lines, new_lines = old_text.split("\n"), new_text.split("\n")
    was: dict[str, Counter[tuple[str, ...]]] = {}
    for name, _, tokens in _iterate_functions(before.functions if before is not None else (), old_lines, language):
        renamed = tuple(words.get(token, token) for token in tokens)
        now = re.sub(r"\w+", lambda match: words.get(match[0], match[0]), name)
        was.setdefault(now, Counter())[renamed] += 1
    for name, function, tokens in _iterate_functions(after.functions, new_lines, language):
        same = was.get(name)
        if same is None or not same[tokens]:
            yield ChangedFunction(path, function.name, function.line, function.owner, same is not None)
        else:
            same[tokens] -= 1


def _iterate_functions(
    functions: Iterable[FlowFunction], lines: list[str], language: Language
) -> Iterator[tuple[str, FlowFunction, tuple[str, ...]]]:
    """(name without places, function, its tokens without those of functions inside it)."""
    every = list(functions)
    for function in every:
        if not function.name:
            continue  # the body of a file
        inner = [
            one
            for one in every
            if one is not function and one.name and function.line <= one.line and one.end <= function.end
            and (one.line, -one.end) != (function.line, -function.end)
        ]  # fmt: skip
        hidden = {line for one in inner for line in range(one.line + 1, one.end)}
        own = [text for number, text in enumerate(lines[function.line - 1 : function.end], function.line)
               if number not in hidden]  # fmt: skip
        yield normalize(function.name), function, _tokenize(own, language)


def _tokenize(lines: list[str], language: Language) -> tuple[str, ...]:
    if language == "python":
        return _tokenize_python(lines)
    found = [
        match[0]
        for match in _TOKENS["cpp"].finditer("\n".join(lines))
        if match[0] != "\n" and not match[0].startswith(("//", "/*"))
    ]
    return tuple(_drop_log_statements(found))


def _drop_log_statements(tokens: list[str]) -> Iterator[str]:
    """The tokens of C++ without statements that log."""
    place = 0
    while place < len(tokens):
        if _LOGS.fullmatch(tokens[place]) and tokens[place + 1 : place + 2] == ["("]:
            depth = 0
            place += 1
            while place < len(tokens):
                depth += (tokens[place] == "(") - (tokens[place] == ")")
                place += 1
                if depth == 0:
                    break
            place += tokens[place : place + 1] == [";"]
            continue
        yield tokens[place]
        place += 1


def _tokenize_python(lines: list[str]) -> tuple[str, ...]:
    """The tokens of Python with the depth of each line that begins a statement; no comments, no texts that stand
    alone, no statements that log."""
    text = "\n".join(lines)
    found: list[str] = []
    line: list[str] = []
    depth = 0
    indent = 0

    def finish() -> None:
        alone = len(line) == 1 and line[0][:1] in "\"'"
        if line and not alone and not _PYTHON_LOGS.match("".join(line)):
            found.append(f"<{indent}>")
            found.extend(line)
        line.clear()

    widths: list[int] = []
    for match in _TOKENS["python"].finditer(text):
        token = match[0]
        if token == "\n":
            if depth <= 0:
                finish()
            continue
        if token.startswith("#"):
            continue
        if not line:
            start = text.rfind("\n", 0, match.start()) + 1
            width = len(text[start : match.start()].expandtabs())
            while widths and widths[-1] > width:
                widths.pop()
            if not widths or widths[-1] < width:
                widths.append(width)
            indent = len(widths)
        line.append(token)
        depth += (token in "([{") - (token in ")]}")
    finish()
    return tuple(found)
