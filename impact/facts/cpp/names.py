"""Names and types of C++ as text: their parts."""

import re

_ARGUMENTS = re.compile(r"<[^<>]*>")


def cut_templates(text: str) -> str:
    """A text without the template arguments in it."""
    while "<" in text:
        shorter = _ARGUMENTS.sub("", text)
        if shorter == text:
            break
        text = shorter
    return text


def strip_templates(text: str) -> str:
    """A name without its template arguments and white space."""
    return "".join(cut_templates(text).split())


def join_scope(scope: str, name: str) -> str:
    """A name in a scope, each of which may be empty."""
    return f"{scope}::{name}" if scope and name else scope or name


def find_closing_angle(text: str, opened: int) -> int:
    """Where the `>` stands that closes the `<` at a place, -1 where none does."""
    depth = 0
    for at in range(opened, len(text)):
        if text[at] == "<":
            depth += 1
        elif text[at] == ">" and text[at - 1] != "-":
            depth -= 1
            if depth == 0:
                return at
    return -1


def split_at_commas(text: str) -> list[str]:
    """The parts of a list, split at commas outside of brackets of every kind, `<>` among them."""
    parts, depth, begins = [], 0, 0
    for at, character in enumerate(text):
        if character in "<({[":
            depth += 1
        elif character in ")}]" or (character == ">" and text[at - 1 : at] != "-"):
            depth -= 1
        elif character == "," and depth == 0:
            parts.append(text[begins:at].strip())
            begins = at + 1
    final = text[begins:].strip()
    return [*parts, final] if final or parts else []
