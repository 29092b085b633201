"""Python's standard library: which top-level modules a version has, by data/python_modules.json."""

import msgspec

from ..tables import find_table
from ..unpacked import read_table

FILE = "python_modules.json"


class Modules(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Names of modules. always: of all versions of Python 3 from 3.4 on, but for those that a later one removed. added:
    to the minor version of Python 3 that brought them. removed: by the minor version that lacks them first, each with
    what serves instead (`old=new`). python2: of Python 2.7, likewise with their homes in Python 3. not_in_2: of
    `always`, those that Python 2.7 lacks. private: of CPython itself."""

    source: str
    always: str
    added: dict[str, int]
    removed: dict[int, str]
    python2: str
    not_in_2: str
    private: str


_KNOWN = read_table(find_table(FILE), Modules)
_ALWAYS_3, _ADDED, _PRIVATE = frozenset(_KNOWN.always.split()), _KNOWN.added, frozenset(_KNOWN.private.split())
_NOT_IN_2 = frozenset(_KNOWN.not_in_2.split())
_SUCCESSORS = {
    word.partition("=")[0]: word.partition("=")[2]
    for words in (_KNOWN.python2, *_KNOWN.removed.values())
    for word in words.split()
}
_REMOVED_IN = {word.partition("=")[0]: minor for minor, words in _KNOWN.removed.items() for word in words.split()}
_TOP_2 = _SUCCESSORS.keys() - _REMOVED_IN.keys()


def is_in_stdlib(module: str, minor: int, major: int = 3) -> bool:
    """True when a module (its first dotted part counts) is in the standard library of Python major.minor.

    minor: 4 to 14 for Python 3; for Python 2 it does not matter, 2.7 stands. A version outside that range is answered
    as the nearest one.
    """
    name = module.partition(".")[0]
    if major == 2:
        return name in _TOP_2 or (name in _ALWAYS_3 and name not in _NOT_IN_2) or name in _REMOVED_IN
    if name in _REMOVED_IN:
        return minor < _REMOVED_IN[name]
    if name in _ADDED:
        return minor >= _ADDED[name]
    return name in _ALWAYS_3 or (name.startswith("_") and name in _PRIVATE)


def is_in_any_stdlib(module: str) -> bool:
    """Whether a top-level module is, or was, in the standard library of some version of Python 3 from 3.4 on."""
    return module in _ALWAYS_3 or module in _ADDED or module in _REMOVED_IN


def find_successor(module: str) -> str:
    """What serves instead of a module that Python 3 lacks; empty where nothing does."""
    return _SUCCESSORS.get(module.partition(".")[0], "")


def has_substitute(module: str) -> bool:
    """True for what a package that most machines have brings back: setuptools does with distutils."""
    return module.partition(".")[0] == "distutils"


def was_ever_in_stdlib(module: str) -> bool:
    """True when any version of Python, 2.7 included, has or had the module in its standard library."""
    name = module.partition(".")[0]
    return name in _ALWAYS_3 or name in _ADDED or name in _REMOVED_IN or name in _TOP_2 or name in _PRIVATE
