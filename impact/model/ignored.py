"""Which paths git ignores, by the patterns of .gitignore files."""

import re
from collections.abc import Iterable
from functools import lru_cache


def is_ignored(path: str, rules: Iterable[tuple[str, tuple[str, ...]]]) -> bool:
    """Whether git ignores a path, or a folder above it. rules: folder of each .gitignore file on the way to the path,
    outermost first, with its patterns. A path that may be a folder counts as one."""
    ignored = False
    for folder, patterns in rules:
        inside = path[len(folder) + 1 :] if folder else path
        parts = inside.split("/")
        above = ["/".join(parts[: count + 1]) for count in range(len(parts))]
        for pattern in patterns:
            negated = pattern.startswith("!")
            expression = _compile_pattern(pattern[negated:])
            if expression is not None and any(expression.fullmatch(one) for one in above):
                ignored = not negated
    return ignored


def holds_ignored(path: str, rules: Iterable[tuple[str, tuple[str, ...]]]) -> bool:
    """Whether a pattern names files below a folder; rules as of is_ignored()."""
    return any(
        f"{folder}/{pattern.lstrip('/')}".lstrip("/").startswith(f"{path}/")
        for folder, patterns in rules
        for pattern in patterns
        if not pattern.startswith("!")
    )


@lru_cache(maxsize=1000)
def _compile_pattern(pattern: str) -> re.Pattern[str] | None:
    """A pattern as an expression for paths relative to its file; one with a slash inside counts from there on."""
    text = pattern.rstrip("/").removeprefix("\\")
    anchored = "/" in text
    text = text.removeprefix("/")
    if not text or len(text) > 300:
        return None
    made = "" if anchored else "(?:.*/)?"
    for piece in re.split(r"(\*\*/|/\*\*|\*|\?|\[[^\]]+\])", text):
        if piece == "**/":
            made += "(?:.*/)?"
        elif piece == "/**":
            made += "/.*"
        elif piece in ("*", "?"):
            made += f"[^/]{piece if piece == '*' else ''}"
        elif piece.startswith("[") and piece.endswith("]") and len(piece) > 2:
            made += "[" + piece[1:-1].replace("\\", "\\\\").replace("[", "\\[").replace("!", "^", 1) + "]"
        else:
            made += re.escape(piece)
    try:
        return re.compile(made)
    except re.error:
        return None
