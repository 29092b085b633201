"""The names that rules look out for, collected from the tables of known changes."""

import hashlib
import re
from functools import cache

import msgspec

from ..facts.usage import Pattern
from ..targets.changes import compute_uses_stamp, index_uses, load_rows, load_transitive, load_uses
from ..targets.providers.compiled import compute_compiled_stamp, load_compiled
from ..targets.providers.includes import load_offered
from ..targets.providers.library import OPENCV_FUNCTIONS
from ..targets.providers.standard import index_headers
from ..targets.surface.fields import load_fields
from ..targets.surface.store import load_shipped
from .package import Watched

_KINDS = frozenset({"api-removed", "api-renamed", "api-changed", "python-removed", "python-api"})
_WORD = re.compile(r"[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*\Z")
_DOTTED = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*\Z")


@cache
def load_watched() -> Watched:
    """All names that some known change is about, with a version that changes when the tables do."""
    words, qualified, python, headers = set(), set(OPENCV_FUNCTIONS), set(), {}
    for row in load_rows():
        if row.kind not in _KINDS or not row.old:
            continue
        if row.kind.startswith("python"):
            if _DOTTED.match(row.old):
                python.add(row.old)
        elif _WORD.match(row.old):
            if "::" in row.old:
                qualified.add(row.old)
            elif not row.ambiguous and len(row.old) > 3:
                words.add(row.old)
            # A new name of which an old one is told may be used where it is not there yet.
            if row.new_since and len(row.new) > 7 and _WORD.match(row.new) and not row.ambiguous:
                (qualified if "::" in row.new else words).add(row.new)
    headers.update({name: found for name, found in load_offered().items() if name not in headers})
    headers.update({name: tuple(h for h in found if "bits/" not in h) for name, found in index_headers().items()})
    for include in load_transitive():
        headers[include.name] = tuple(dict.fromkeys((*include.headers, *headers.get(include.name, ()))))
    modules: dict[str, list[tuple[str, Pattern]]] = {}
    for label, row in load_uses().items():
        if row.pattern is not None and row.pattern.language == "python":
            for module in row.pattern.imports or (row.package,):
                modules.setdefault(module, []).append((label, _strip_pattern(row.pattern)))
    parameters = []
    for label, row in load_uses("behaviour").items():
        if row.pattern is None:
            continue
        if row.pattern.language == "yaml":
            parameters.append((label, _strip_pattern(row.pattern)))
        for module in row.pattern.imports:
            modules.setdefault(module, []).append((label, _strip_pattern(row.pattern)))
    fields = load_fields()
    version = hashlib.sha1(
        repr(
            (
                sorted(words),
                sorted(qualified),
                sorted(python),
                sorted(headers.items()),
                modules,
                parameters,
                compute_uses_stamp(),
                fields.version,
                load_shipped().stamp,
                compute_compiled_stamp(),
            )
        ).encode()
    ).hexdigest()
    return Watched(
        *(frozenset(words), frozenset(qualified), frozenset(python), headers, modules, version, fields, load_shipped()),
        compiled=load_compiled,
        parameters=parameters,
        uses=index_uses,
    )


def _strip_pattern(pattern: Pattern) -> Pattern:
    """How a use looks, without what its table says besides, so that it can be remembered and read back."""
    return msgspec.convert(pattern, Pattern, from_attributes=True)
