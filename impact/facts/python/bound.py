"""Which names of a Python source nothing in it binds, and which ones others can import from it, as Python itself scopes
them."""

import builtins
import symtable

PYTHON2_BUILTINS = frozenset((
    "StandardError", "apply", "basestring", "buffer", "cmp", "coerce", "execfile", "file", "intern", "long",
    "raw_input", "reduce", "reload", "unichr", "unicode", "xrange",
))  # fmt: skip
"""Names that are there without an import in Python 2 alone. Source: the documentation of the standard library."""
PYTHON2_METHODS = frozenset(("has_key", "iteritems", "iterkeys", "itervalues", "viewitems", "viewkeys", "viewvalues"))
"""Methods of dictionaries in Python 2 alone. Source: "What's New In Python 3.0"."""
# What modules, classes and sessions have besides, and what only some versions or machines have. Source: as above.
_ALWAYS = frozenset(dir(builtins)) | {
    "__annotations__", "__builtins__", "__class__", "__dict__", "__file__", "__module__", "__path__", "__qualname__",
    "BaseExceptionGroup", "EncodingWarning", "ExceptionGroup", "PythonFinalizationError", "WindowsError", "_", "aiter",
    "anext", "display", "get_ipython", "profile", "reveal_type",
}  # fmt: skip
# What may bind names that no scope shows.
_DYNAMIC = frozenset(("__builtin__", "__builtins__", "__getattr__", "builtins", "exec", "execfile", "globals", "locals",
                      "vars"))  # fmt: skip


def find_scope_names(text: str) -> tuple[frozenset[str], frozenset[str]] | None:
    """Names that some scope looks up in the module and nothing gives, and names that the module binds; None where that
    cannot be told, star imports aside."""
    if "sys.modules" in text:
        return None
    try:
        top = symtable.symtable(text, "module", "exec")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    bound: set[str] = set()
    asked: set[str] = set()
    tables = [top]
    for table in tables:
        tables += table.get_children()
        for symbol in table.get_symbols():
            binds = symbol.is_assigned() or symbol.is_imported()
            if binds and (table is top or symbol.is_declared_global()):
                bound.add(symbol.get_name())
            elif symbol.is_referenced() and (table is top or symbol.is_global()):
                asked.add(symbol.get_name())
    return None if _DYNAMIC & (asked | bound) else (frozenset(asked - bound - _ALWAYS), frozenset(bound))
