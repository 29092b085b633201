"""What is kept of a header that a version of a package installs."""

import msgspec

from ...impact.conditions import Environment, evaluate_all
from ...impact.facts.cpp.lexical import Include
from ...impact.facts.surface import HeaderSurface, drop_inline

_NOTHING_KNOWN = Environment()


def keep_compiled_includes(header: HeaderSurface) -> HeaderSurface:
    """A header with those of its includes that some Linux compiles, so none under `#if 0` or `#ifdef _WIN32`; without
    lines, and without conditions that hold on all. Types that it announces are named as users write them."""
    kept = []
    for include in header.includes:
        holds = evaluate_all(include.conditions, _NOTHING_KNOWN)
        if holds is not False:
            kept.append(Include(include.path, include.angled, 0, 0, () if holds else include.conditions))
    announced = tuple(dict.fromkeys(drop_inline(name, header.inline) for name in header.announced))
    return msgspec.structs.replace(header, includes=tuple(kept), announced=announced)
