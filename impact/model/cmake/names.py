"""Names that CMake itself knows: its commands, the commands of its modules, and platform variables.

The names are in names.toml, which databuild/cmake_names.py updates.
"""

import sys
from pathlib import Path

import msgspec

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # pyright: ignore[reportMissingImports]

TABLE = Path(__file__).with_name("names.toml")


def split_names(text: str) -> tuple[str, ...]:
    """Names written as one text, in their order."""
    return tuple(text.split())


def make_name_set(text: str) -> frozenset[str]:
    """Names written as one text, for asking whether one is among them."""
    return frozenset(text.split())


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What names.toml holds, names written as one text. commands, modules: of all versions of CMake. since: the version
    that brought a command, module or policy, for those that 3.0 lacks. only_new: the policies that a version has NEW
    alone, by that version. dropped: the policy that takes a command or module away where it is NEW. commands_of: what
    modules define. brings: the modules that another one includes."""

    commands: str
    modules: str
    since: dict[str, str]
    only_new: dict[str, str]
    dropped: dict[str, str]
    commands_of: dict[str, str]
    brings: dict[str, str]


def read_table() -> Table:
    """The table as it is shipped. Raises msgspec.ValidationError that names what is wrong in it."""
    return msgspec.convert(tomllib.loads(TABLE.read_text(encoding="utf-8")), Table)


_TABLE = read_table()
BUILTIN_COMMANDS = make_name_set(_TABLE.commands)

# Command -> the module that brings it. Where two do, the one that is included by name.
MODULE_OF: dict[str, str] = {
    command: module for module, commands in _TABLE.commands_of.items() for command in commands.split()
}

COMMANDS = BUILTIN_COMMANDS | frozenset(MODULE_OF)
MODULES = make_name_set(_TABLE.modules)

# What a module includes itself.
MODULES_WITH = {module: split_names(others) for module, others in _TABLE.brings.items()}

# Command, module or policy -> the version of CMake that brought it.
SINCE = _TABLE.since

# Policy -> the version of CMake from which on it cannot be OLD.
ONLY_NEW: dict[str, str] = {
    policy: version for version, policies in _TABLE.only_new.items() for policy in policies.split()
}

# Command or module -> the policy that takes it away where it is NEW.
DROPPED = _TABLE.dropped

# Defined and empty here: the target platforms are Linux with GCC.
FALSE_PLATFORMS = split_names(
    """
    WIN32 APPLE MSVC ANDROID MINGW CYGWIN MSYS IOS BORLAND WATCOM XCODE QNX CMAKE_HOST_WIN32 CMAKE_HOST_APPLE
    CMAKE_CL_64 MSVC_IDE MSVC10 MSVC11 MSVC12 MSVC14 MSVC90 MSVC80
    """
)

# Ends of variable names that a found package sets.
READ_SUFFIXES = split_names(
    """
    _INCLUDE_DIRS _INCLUDE_DIR _INCLUDES _INCLUDE_PATH _LIBRARIES _LIBRARY _LIBS _LIBRARY_DIRS _LIBRARY_DIR _DEFINITIONS
    _EXPORTED_TARGETS _TARGETS _LDFLAGS _CFLAGS _CXX_FLAGS _EXECUTABLE _USE_FILE _VERSION
    """
)
