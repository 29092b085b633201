"""Keys of our own code: what a module's outcome may depend on, so that nothing made by other code is ever read back.

A key digests the source of a module, of all modules of the project that it imports, directly or not, lazily too, and
the versions of the libraries that these import. Editing a module changes its key, and those of the modules that import
it; no number has to be raised. The keys are worked out once for every state of the source, which file sizes and times
tell, and are remembered in the cache folder.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import secrets
import sys
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, partial

import msgspec

from ..edges import files, limits
from ..edges.limits import format_limits
from ..edges.reach import Reach
from .cache import cache_folder

_HERE = os.path.dirname(__file__)
_ROOTS = {
    "impact": _HERE,
    "edges": os.path.dirname(limits.__file__),
    "databuild": os.path.join(os.path.dirname(_HERE), "databuild"),
}
_PROJECT = __name__.partition(".")[0] + "."
# Data have stamps of their own, see targets.snapshot.
_NO_SOURCE = frozenset(("__pycache__", "data"))
_SOURCES = (".py", ".pyc", ".toml")
_LARGEST = 4 << 20
_IMPORT = re.compile(
    rb"^[ \t]*(?:from[ \t]+(\.*)([\w.]*)[ \t]+import[ \t]+(?:\(([^)]*)\)|([^\n#]*))|import[ \t]+([\w., \t]+))",
    re.MULTILINE,
)
# What only type checkers import.
_FOR_TYPES = re.compile(rb"^if TYPE_CHECKING:\n(?:[ \t]+[^\n]*\n|\n)+", re.MULTILINE)
_NAME = re.compile(rb"\w+")
# The bytes of the digest that stands before what is remembered.
_SEAL = 20


class _Keys(msgspec.Struct, frozen=True, array_like=True):
    """What the cache folder holds: a state of the source and of the installed libraries, and the keys by module."""

    state: bytes
    keys: dict[str, str]


def compute_source_key(*modules: str) -> str:
    """Changes whenever the code behind one of these modules does. modules: their `__name__`s.

    Raises KeyError for a name that no module has."""
    keys = _load_keys()
    names = (module.removeprefix(_PROJECT) for module in modules)
    return _hash_parts(keys[f"{name}.__init__" if f"{name}.__init__" in keys else name] for name in names)


@cache
def compute_code_stamp() -> str:
    """Changes whenever any module of the checker does, and with the user's limits."""
    keys = {module: key for module, key in _load_keys().items() if not module.startswith("databuild.")}
    return _hash_parts(f"{module} {key}" for module, key in keys.items()) + format_limits()


def compute_keys(sources: Mapping[str, bytes], version: Callable[[str], str]) -> dict[str, str]:
    """The key of every module. sources: by module, `impact.facts.__init__` for a folder itself. version: gives that of
    a library by the name that is imported."""
    tables = [name for name in sources if "/" in name]
    imports = {module: _find_imports(module, source, sources, tables) for module, source in sources.items()}
    own = {module: hashlib.sha1(source).hexdigest() for module, source in sources.items()}
    own.update((name, version(name)) for name in set().union(*imports.values()) - sources.keys())
    python = "{}.{}".format(*sys.version_info)
    reach = Reach(lambda name: (imports.get(name, ()), ()))

    @cache
    def compute_key(reached: int) -> str:
        return _hash_parts((python, *(f"{name} {own[name]}" for name in sorted(reach.list_names(reached)))))

    return {module: compute_key(reach.collect_masks((module,))[0]) for module in sorted(sources)}


def _find_imports(module: str, source: bytes, sources: Mapping[str, bytes], tables: Iterable[str]) -> set[str]:
    """The modules and libraries that a source imports. What cannot be read so may import everything. tables: those of
    the sources that are no modules."""
    if b"\0" in source:  # compiled, without its text
        return set(sources)
    found = set()
    package = module.split(".") if f"{module}.__init__" in sources else module.split(".")[:-1]
    read = _FOR_TYPES.sub(b"", source) if b"TYPE_CHECKING" in source else source
    for dots, path, several, one, plain in _IMPORT.findall(read):
        if plain:
            found.update(name.split()[0].partition(".")[0] for name in plain.decode().split(",") if name.strip())
            continue
        if not dots:
            found.add(path.decode().partition(".")[0])
            continue
        base = package[: len(package) - len(dots) + 1] + (path.decode().split(".") if path else [])
        whole = ".".join(base)
        for name in _NAME.findall(several or one):
            inner = f"{whole}.{name.decode()}"
            found.add(next((one for one in (inner, f"{inner}.__init__", whole) if one in sources), f"{whole}.__init__"))
    # A table that lies beside the modules is read by whoever names it.
    near = module.rpartition(".")[0] + "/"
    found.update(name for name in tables if name.startswith(near) and name[len(near) :].encode() in source)
    found.discard(module)
    return {name for name in found if name in sources or name not in sys.stdlib_module_names}


@cache
def _load_keys() -> Mapping[str, str]:
    libraries = [path for path in sys.path if path.endswith("-packages")]
    try:
        state = _compute_state(libraries)
    except OSError:  # installed as something else than files: what is made now is never read back
        return defaultdict(partial(secrets.token_hex, 10), {"": secrets.token_hex(10)})
    about = f"{_ROOTS} {libraries}".encode("utf-8", "surrogateescape")
    place = os.path.join(cache_folder(), f"code-{hashlib.sha1(about).hexdigest()[:16]}")
    with contextlib.suppress(OSError, msgspec.MsgspecError, ValueError):
        data = files.read_file(place, _LARGEST)
        sealed, packed = data[:_SEAL], data[_SEAL:]
        if sealed == hashlib.sha1(packed).digest():  # else it was damaged, and modules may be missing
            known = msgspec.msgpack.decode(packed, type=_Keys)
            if known.state == state:
                return known.keys
    sources = {name: files.read_file(path, _LARGEST) for name, path, _ in _list_sources()}
    keys = compute_keys(sources, _find_version)
    if _compute_state(libraries) == state:  # else a file changed while all were read
        with contextlib.suppress(OSError, UnicodeEncodeError):
            os.makedirs(cache_folder(), exist_ok=True)
            packed = msgspec.msgpack.encode(_Keys(state, keys))
            files.write_file(place, hashlib.sha1(packed).digest() + packed)
    return keys


def _list_sources() -> Iterator[tuple[str, str, os.stat_result]]:
    """Module, path and status of each source file. A table is called by folder and name, `impact.model.flow/x.toml`.

    Raises OSError where the project is installed as anything but files."""
    for root, folder in _ROOTS.items():
        waiting = [(root, folder)]
        for package, place in waiting:
            with os.scandir(place) as entries:
                for entry in sorted(entries, key=lambda entry: entry.name):
                    stem, ending = os.path.splitext(entry.name)
                    if ending in _SOURCES:
                        name = f"{package}/{entry.name}" if ending == ".toml" else f"{package}.{stem}"
                        yield name, entry.path, entry.stat()
                    elif entry.name not in _NO_SOURCE and "." not in entry.name and entry.is_dir():
                        waiting.append((f"{package}.{entry.name}", entry.path))


def _compute_state(libraries: Iterable[str]) -> bytes:
    """What tells a state of the source, and of the folders that libraries are installed in, without reading it. A
    folder changes whenever something is installed there, removed or replaced."""
    digest = hashlib.sha1(sys.version.encode())

    def add(path: str, status: os.stat_result) -> None:
        # The time at which the entry changed counts too: packages may be made with one time for all files.
        row = f"{path} {status.st_size} {status.st_mtime_ns} {status.st_ctime_ns}\n"
        digest.update(row.encode("utf-8", "surrogateescape"))

    for _, path, status in _list_sources():
        add(path, status)
    for folder in libraries:
        with contextlib.suppress(OSError):
            add(folder, os.stat(folder))
    return digest.digest()


def _find_version(library: str) -> str:
    """The version of a library by the name that is imported; where it goes by another name, where and since when it is
    installed; empty where it is not."""
    from importlib.metadata import PackageNotFoundError, version
    from importlib.util import find_spec

    try:
        return version(library)
    except (PackageNotFoundError, ValueError):
        pass
    try:
        spec = find_spec(library)
        place = spec.origin if spec is not None else None
        status = os.stat(place) if place else None
    except (ImportError, ValueError, OSError):
        return ""
    return f"{place} {status.st_size} {status.st_mtime_ns}" if status is not None else ""


def _hash_parts(parts: Iterable[str]) -> str:
    return hashlib.sha1("\n".join(parts).encode()).hexdigest()[:20]
