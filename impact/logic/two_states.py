"""A workspace beside its base: the packages whose code differs, and what happened to publishing in them.

It is the comparison that `logic` makes of a commit and its parent, on workspaces instead of commits.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from typing import NamedTuple

from ...edges import processes
from ..facts.extract import ExtractedFacts, extract_all
from ..facts.kinds import FLOW
from ..model.package import find_folder_role
from ..model.workspace import Package, Workspace
from .changes import LogicChange, Side
from .history import PackageFile, PackageState, compute_key
from .statements import PackageStatements, find_facts_kind
from .states import Digests, compare_sides, make_digest_row, make_unread_digest

_KINDS = {flow: plain for plain, flow in FLOW.items()} | {name: name for name in (*FLOW, "cmake", "setup_py")}
"""What a file is called here, by its kind of facts, whether it was extracted for message flow or for other ends."""
# Starting processes costs about as much as joining packages with this many files here.
_ALONE_FILES = 150


class Differing(NamedTuple):
    """The packages whose code or build differs, as the base and as the workspace has them, and which files are called
    otherwise. Paths are relative to the workspaces' roots."""

    old: tuple[PackageState, ...]
    new: tuple[PackageState, ...]
    renamed: Mapping[str, str]

    def iterate_changed_files(self) -> Iterator[tuple[str, PackageFile | None, PackageFile]]:
        """Path, the file at the base (None where there was none) and now, of all whose content differs."""
        was = {state.locate(file.path): file for state in self.old for file in state.files}
        predecessors = {new: old for old, new in self.renamed.items()}
        for state in self.new:
            for file in state.files:
                path = state.locate(file.path)
                before = was.get(predecessors.get(path, path))
                if before is None or before.id != file.id:
                    yield path, before, file


@lru_cache(maxsize=2)
def find_differences(workspace: Workspace, base: Workspace) -> Differing:
    """What of the code of two workspaces differs, told by the names and contents of files alone."""
    listed = [{package.name: _list_files(package, each) for package in each} for each in (base, workspace)]
    names = [name for name in {**listed[0], **listed[1]} if listed[0].get(name) != listed[1].get(name)]
    old, new = (
        tuple(_make_state(each, each.packages[name], files[name]) for name in names if files.get(name))
        for each, files in zip((base, workspace), listed, strict=True)
    )
    return Differing(old, new, _find_renamed_files(old, new))


@lru_cache(maxsize=2)
def compare_publishing(workspace: Workspace, base: Workspace) -> tuple[LogicChange, ...]:
    """What happened to the logic of publishing since the base, by path and line; rewordings are left out."""
    found = find_differences(workspace, base)
    if not found.old and not found.new:
        return ()
    old = Side([*zip(found.old, _load_digests(base, found.old), strict=True)])
    new = Side([*zip(found.new, _load_digests(workspace, found.new), strict=True)])
    places = {
        file.id: (each, state.locate(file.path))
        for each, states in ((base, found.old), (workspace, found.new))
        for state in states
        for file in state.files
    }

    def read(file: PackageFile) -> bytes:
        return read_bytes(*places[file.id])

    return tuple(c for c in compare_sides(old, new, lambda: found.renamed, read) if c.kind != "equivalent")


def read_bytes(workspace: Workspace, path: str) -> bytes:
    """The bytes of a file, none where it cannot be read."""
    with suppress(OSError):
        return workspace.read(path)
    return b""


def _list_files(package: Package, workspace: Workspace) -> tuple[tuple[str, str, str], ...]:
    """Path in the package, content and kind of files that tell of the flow of messages, tests left out."""
    main = workspace.extraction
    sources = [main] if main.second is None else [main.second, main]
    start = len(package.path) + 1 if package.path else 0
    found: list[tuple[str, str, str]] = []
    for path in package.linked.files:
        extraction = next((each for each in sources if each.kinds.get(path) in _KINDS), None)
        if extraction is not None and find_folder_role(path[start:]) != "test":
            found.append((path[start:], extraction.ids.get(path, ""), _KINDS[extraction.kinds[path]]))
    return tuple(found)


def _make_state(workspace: Workspace, package: Package, listed: Iterable[tuple[str, str, str]]) -> PackageState:
    """A package as `logic` knows it: its key is the same there for the same content."""
    ros = 2 if package.build_type.startswith("ament") else 1
    files: list[PackageFile] = []
    for path, content, kind in listed:
        if kind == "script":
            if path.endswith(".cfg") or not _is_python(workspace, f"{package.path}/{path}".lstrip("/")):
                continue
            kind = "python"
        files.append(PackageFile(path, content, kind))
    return PackageState(package.name, package.path, ros, tuple(files), compute_key(package.name, ros, files))


def _is_python(workspace: Workspace, path: str) -> bool:
    looks = (workspace.extraction.second, workspace.extraction)
    return any(
        each is not None and path in each.kinds and each.get_facts(path).kind.endswith("python") for each in looks
    )


def _find_renamed_files(old: Sequence[PackageState], new: Sequence[PackageState]) -> dict[str, str]:
    """Files that are called otherwise now: of the same content, or the only ones of a name."""
    was = {state.locate(file.path): file for state in old for file in state.files}
    is_now = {state.locate(file.path): file for state in new for file in state.files}
    gone = {path: file for path, file in was.items() if path not in is_now}
    come = {path: file for path, file in is_now.items() if path not in was}
    found: dict[str, str] = {}
    keys: tuple[Callable[[str, PackageFile], str], ...] = (
        lambda _, file: file.id,
        lambda path, _: path.rpartition("/")[2],
    )
    for key in keys:
        before, after = _group_paths(key, gone, set(found)), _group_paths(key, come, set(found.values()))
        for name, paths in before.items():
            others = after.get(name, [])
            if len(paths) == len(others) == 1:
                found[paths[0]] = others[0]
    return found


def _group_paths(
    key: Callable[[str, PackageFile], str], files: Mapping[str, PackageFile], done: set[str]
) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for path, file in files.items():
        if path not in done:
            found.setdefault(key(path, file), []).append(path)
    return found


def _load_digests(workspace: Workspace, states: Sequence[PackageState]) -> list[PackageStatements]:
    """The digests of some packages, in their order; those that are not known are made and kept."""
    digests = Digests(workspace.extraction.store)
    known = digests.load(state.key for state in states)
    missing = [state for state in states if state.key not in known]
    if missing:
        made = list(_make_digests(workspace, extract_flow_facts(workspace, missing), missing))
        lost = set(map(make_unread_digest, missing))
        digests.add([row for row in made if row not in lost], lost.intersection(made))
    return [digests.decode_state(state.key) for state in states]


def extract_flow_facts(workspace: Workspace, states: Sequence[PackageState]) -> ExtractedFacts:
    """The flow facts of some packages alone."""
    main = workspace.extraction
    if main.second is not None or not states:
        return main.second or main
    wanted = {state.locate(file.path): find_facts_kind(file) for state in states for file in state.files}
    return extract_all(main.tree, main.store, kind_of=lambda path: wanted[path] if wanted.get(path) in _CODE else None)


_CODE = frozenset(FLOW.values())


def _make_digests(
    workspace: Workspace, extraction: ExtractedFacts, states: Sequence[PackageState]
) -> Iterator[tuple[bytes, bytes]]:
    jobs = processes.count_cores()
    if jobs < 2 or sum(len(state.files) for state in states) < _ALONE_FILES or not processes.may_fork():
        for state in states:
            yield _make_digest(workspace, extraction, state)
        return
    workspace.extraction.store.close()  # no other process may go on with a connection of this one
    large_first = sorted(states, key=lambda state: -len(state.files))
    for state, made in processes.run_forked(_make_digest, large_first, jobs, workspace, extraction):
        yield make_unread_digest(state) if isinstance(made, processes.Died) else made


def _make_digest(workspace: Workspace, extraction: ExtractedFacts, state: PackageState) -> tuple[bytes, bytes]:
    """The key of a state, and its digest, packed."""
    whole = {file.path: state.locate(file.path) for file in state.files}
    extraction.preload(whole.values())
    facts = {}
    for file in state.files:
        path = whole[file.path]
        source = extraction if find_facts_kind(file) in _CODE else workspace.extraction
        facts[file.path] = source.get_facts(path).facts if path in source.kinds else None
    extraction.forget(whole.values())
    return make_digest_row(state, facts)
