"""Names that differ by a slip of the keyboard."""

import re
from collections.abc import Iterable
from functools import cached_property

from ...edges.groups import group_pairs


def fold_name(name: str) -> str:
    """A name without what people mix up: case, dashes, underscores, a trailing digit, a python or lib prefix."""
    name = re.sub(r"[-_.\s]", "", name.lower())
    return re.sub(r"^(?:python3?|lib|ros)(?=\w{3})|(?:dev|\d)$", "", name)


def is_one_edit(a: str, b: str) -> bool:
    """True when one insertion, deletion, replacement or swap of neighbours turns a into b."""
    if a == b or abs(len(a) - len(b)) > 1:
        return False
    if len(a) > len(b):
        a, b = b, a
    start = 0
    while start < len(a) and a[start] == b[start]:
        start += 1
    if len(a) == len(b):
        return a[start + 1 :] == b[start + 1 :] or (
            a[start : start + 2] == b[start : start + 2][::-1] and a[start + 2 :] == b[start + 2 :]
        )
    return a[start:] == b[start + 1 :]


def is_slip(one: str, other: str) -> bool:
    """True when one edit turns a name into another and their digits are the same: those tell versions apart."""
    return is_one_edit(one, other) and re.findall(r"\d", one) == re.findall(r"\d", other)


class SpellingIndex:
    """An index of known names that answers which of them a misspelt one means."""

    def __init__(self, names: Iterable[str]):
        self.names = frozenset(names)

    @cached_property
    def _folded(self) -> dict[str, list[str]]:
        return group_pairs((fold_name(name), name) for name in sorted(self.names))

    @cached_property
    def _by_length(self) -> dict[tuple[int, str], list[str]]:
        return group_pairs(((len(name), name[:1].lower()), name) for name in sorted(self.names))

    def find_nearest(self, name: str) -> str | None:
        """The known name that differs only in case, separators or prefix, else the only one a single edit away."""
        same = self._folded.get(fold_name(name), [])
        if same:
            return min(same, key=lambda n: (abs(len(n) - len(name)), n))
        if len(name) < 5:
            return None
        near = [
            n
            for size in (-1, 0, 1)
            for n in self._by_length.get((len(name) + size, name[:1].lower()), ())
            if is_one_edit(name, n)
        ]
        return near[0] if len(near) == 1 else None
