"""Callbacks of a workspace, compiled and ready to be explored and replayed: the one entry of this folder."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from ....edges.groups import group_pairs
from ...model.flow.graph import Graph
from ...model.workspace import Workspace
from ..outcomes import NOWHERE, Bounds, Reaction, Witness
from .callbacks import ClassReader, CppCallback, list_cpp_callbacks
from .compile import CannotCompile, HarnessFiles, SourceUnit, Workshop
from .generate import Harness, HarnessEntry, HarnessWriter
from .interfaces import KnownInterfaces, list_constants
from .replay import SECONDS, Replayed, replay
from .toolchain import NO_CLANG, find_clang

_FURTHER = 10
_DECLARED = re.compile(r"^declare [^@\n]*@(\"?)([\w.$]+)\1\(", re.MULTILINE)
KINDS = ("subscriber",)
"""The kinds of callbacks that are prepared unless others are asked for."""


@dataclass
class PreparedCallback:
    """A callback with its harness. reason: why there is none; then entry and IR are empty.

    entry: the function to explore; way: `built` (the node is constructed) or `bare` (an object of zeros, whose members
    are any). others: further entries, to be taken where the first leads nowhere. ir_texts: the harness, then the
    sources that it calls into. stood_for: names of headers that are not on this machine. left_out: sources that do not
    compile, with the reason. compiled_in: seconds of the processor that compilers worked for the source of the callback
    and what it calls; rounds: how often they ran.
    """

    kind: str
    node: str
    topic: str
    callback: str
    message_type: str
    path: str
    line: int
    nodes: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()
    reason: str = ""
    entry: str = ""
    way: str = ""
    others: tuple[HarnessEntry, ...] = ()
    ir_texts: tuple[str, ...] = ()
    constants: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    stood_for: tuple[str, ...] = ()
    left_out: Mapping[str, str] = field(default_factory=dict)
    function_place: tuple[str, int] = ("", 0)
    units: tuple[SourceUnit, ...] = ()
    workshop: Workshop | None = None
    compiled_in: float = 0.0
    rounds: int = 0

    def is_workspace_file(self, path: str) -> bool:
        """Whether a path of the debug information is of the workspace."""
        return self.workshop is not None and path.startswith(f"{self.workshop.root}/")

    def replay(self, witnesses: Sequence[Witness], entry: str = "", seconds: int = SECONDS) -> list[Replayed]:
        """Runs witnesses natively, in a process of its own. Raises CannotCompile."""
        if self.workshop is None or not self.units:
            raise CannotCompile(self.reason or "there is no harness")
        program = self.workshop.build_replay(self.units)
        return replay(program, entry or self.entry, [one.values for one in witnesses], self.workshop.root, seconds)

    def choose_entry(self) -> str:
        """The first entry by which the callback is reached natively, with every input zero; the first of all where it
        is reached by none. Raises CannotCompile."""
        nothing = Witness({}, Reaction.UNKNOWN, None, NOWHERE)
        for name in (self.entry, *(one.name for one in self.others)):
            if self.replay([nothing], name)[0].begun:
                return name
        return self.entry

    def emit_klee(self, folder: Path, entry: str = "") -> HarnessFiles:
        """Writes the harness for KLEE into a folder. Raises CannotCompile."""
        if self.workshop is None or not self.units:
            raise CannotCompile(self.reason or "there is no harness")
        return self.workshop.emit_klee(self.units[0], entry or self.entry, folder)


class HarnessSession:
    """Harnesses of one workspace. root: its folder on disk; folder: for what is compiled, a temporary one without it,
    which is removed by close()."""

    def __init__(
        self, root: Path, workspace: Workspace, graph: Graph, bounds: Bounds | None = None, folder: Path | None = None
    ):
        self._stack = ExitStack()
        if folder is None:
            folder = Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="rosimpact-values-")))
        self.bounds = bounds or Bounds()
        self.definitions = KnownInterfaces(workspace)
        self.workspace, self.graph = workspace, graph
        packages = [package.path for package in workspace]
        self.workshop = Workshop(root, folder, self.definitions, packages, self.bounds, self._is_own, self._list_bases)
        self._further: dict[str, tuple[SourceUnit, str] | str] = {}
        self._units = self._tried = 0

    def _is_own(self, scope: str, name: str) -> bool:
        code = self.reader.code
        if not scope:
            return name in code.classes or name in code.by_tail
        found = (*code.classes.get(name, ()), *code.by_tail.get(name, ()))
        return any(_ends_like(each.name, f"{scope}::{name}", "::") for each in found)

    def _list_bases(self, name: str) -> list[str]:
        found = self.reader.code.classes.get(name.rpartition("::")[2], ())
        return [base for one in found if _ends_like(name, one.name, "::") for base in self.reader.list_bases(one)]

    def __enter__(self) -> HarnessSession:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Removes what was compiled."""
        self._stack.close()

    @cached_property
    def reader(self) -> ClassReader:
        return ClassReader(self.workspace)

    @cached_property
    def writer(self) -> HarnessWriter:
        return HarnessWriter(self.reader, str(self.workshop.root), self.workspace.ros, self.callbacks)

    @cached_property
    def callbacks(self) -> list[CppCallback]:
        """All callbacks of the workspace's C++ code, whether or not their harness compiles."""
        return list_cpp_callbacks(self.workspace, self.graph)

    def prepare(
        self, *, nodes: Collection[str] = (), topics: Collection[str] = (), callbacks: Collection[str] = (),
        kinds: Collection[str] = KINDS, places: Collection[tuple[str, int]] = (),
    ) -> Iterator[PreparedCallback]:  # fmt: skip
        """The callbacks that are asked for (all of the kinds where nothing is named), one source file after another.

        nodes: by id or its last part; topics: by name; callbacks: by name or its last parts; places: path
        and line of the calls that make them."""
        asked = [one for one in self.callbacks if is_asked(one, nodes, topics, callbacks, kinds, places)]
        yield from self.prepare_each(asked)

    def prepare_each(self, callbacks: Iterable[CppCallback]) -> Iterator[PreparedCallback]:
        """The same for some of `callbacks`."""
        for source, rows in group_pairs((self.writer.choose_source(one), one) for one in callbacks).items():
            self._units += 1
            yield from self._prepare_source(f"unit{self._units}", source, rows)

    def _prepare_source(self, name: str, source: str, rows: list[CppCallback]) -> Iterator[PreparedCallback]:
        if not find_clang():
            yield from (self._describe(one, NO_CLANG) for one in rows)
            return
        harness = self.writer.write(name, source, rows)

        def write(without: Collection[str]) -> SourceUnit:
            nonlocal harness
            harness = self.writer.write(name, source, rows, without)
            return harness.unit

        unit = harness.unit
        self.workshop.start_time()
        try:
            self.workshop.prepare(unit, write)
            text = self.workshop.read_ir(unit)
        except CannotCompile as error:
            for one in rows:
                found = self._describe(one, str(error))
                found.compiled_in, found.rounds = self.workshop.time.used, self.workshop.time.rounds
                yield found
            return
        units, texts, left_out = self._add_further(unit, text, source)
        time = self.workshop.time
        stood_for = tuple(each for one in units if one.stubs is not None for each in one.stubs.list_names())
        for number, one in enumerate(rows):
            entries = harness.entries.get(number, [])
            if not entries:
                yield self._describe(one, self._explain(one, number, unit))
                continue
            first, *others = entries
            found = self._describe(one, "")
            found.entry, found.way, found.others = first.name, first.way, tuple(others)
            found.ir_texts, found.units, found.workshop = tuple(texts), tuple(units), self.workshop
            found.stood_for, found.left_out = stood_for, left_out
            found.compiled_in, found.rounds = time.used, time.rounds
            yield found

    def _explain(self, callback: CppCallback, number: int, unit: SourceUnit) -> str:
        for name, text in unit.dropped.items():
            if name.endswith(f"_{number}"):
                return f"{callback.path}:{callback.line}: the node cannot be made: {text}"
        return f"{callback.path}:{callback.line}: the callback is not known"

    def _describe(self, one: CppCallback, reason: str) -> PreparedCallback:
        folder = {"service": "srv", "action": "action"}.get(one.kind, "msg")
        package, _, name = one.message_type.partition("/")
        constants = list_constants(self.definitions, f"{package}/{folder}/{name}") if name else {}
        place = (
            (one.function.source.path, one.function.facts.line) if one.function is not None else (one.path, one.line)
        )
        return PreparedCallback(
            one.kind, one.nodes[0] if one.nodes else "", one.topics[0] if one.topics else "", one.name,
            one.message_type, one.path, one.line, one.nodes, one.topics, reason, constants=constants,
            function_place=place, workshop=self.workshop,
        )  # fmt: skip

    def _add_further(
        self, unit: SourceUnit, text: str, source: str
    ) -> tuple[list[SourceUnit], list[str], dict[str, str]]:
        """The sources that a harness calls into, compiled."""
        units, texts, left_out = [unit], [text], {}
        seen, left = {source}, [text]
        while left and len(units) <= _FURTHER:
            symbols = {each[1] for each in _DECLARED.findall(left.pop())}
            for path in self.reader.list_defining(symbols, source):
                if path in seen or len(units) > _FURTHER:
                    continue
                seen.add(path)
                made = self._compile_further(path)
                if isinstance(made, str):
                    left_out[path] = made
                    continue
                units.append(made[0])
                texts.append(made[1])
                left.append(made[1])
        return units, texts, left_out

    def _compile_further(self, path: str) -> tuple[SourceUnit, str] | str:
        if path not in self._further:
            self._tried += 1
            unit = self.writer.write_further(f"further{self._tried}", path)
            used = self.workshop.time.used
            try:
                self.workshop.prepare(unit)
                self._further[path] = unit, self.workshop.read_ir(unit)
            except CannotCompile as error:
                if self.workshop.time.is_over and used > self.bounds.compiling / 2:
                    return str(error)  # what it calls besides took the time; with another source it may compile
                self._further[path] = str(error)
        return self._further[path]


def is_asked(
    one: CppCallback, nodes: Collection[str], topics: Collection[str], callbacks: Collection[str],
    kinds: Collection[str], places: Collection[tuple[str, int]] = (),
) -> bool:  # fmt: skip
    """Whether a callback is one of those that were asked for; see HarnessSession.prepare()."""
    if one.kind not in kinds or (places and (one.path, one.line) not in places):
        return False
    if nodes and not any(_ends_like(each, name, "/") for each in one.nodes for name in nodes):
        return False
    if topics and not any(each in topics or each.lstrip("/") in topics for each in one.topics):
        return False
    return not callbacks or any(_ends_like(one.name, name, mark) for name in callbacks for mark in ("::", "."))


def _ends_like(full: str, end: str, separator: str) -> bool:
    return full == end or full.endswith(separator + end)


def prepare_callbacks(
    root: Path, workspace: Workspace, graph: Graph, *, bounds: Bounds | None = None, folder: Path | None = None,
    nodes: Collection[str] = (), topics: Collection[str] = (), callbacks: Collection[str] = (),
    kinds: Collection[str] = KINDS,
) -> Iterator[PreparedCallback]:  # fmt: skip
    """The callbacks of a workspace's C++ code, as HarnessSession.prepare() gives them. What is compiled lies in folder,
    without one in a temporary folder that is removed when the iterator ends."""
    with HarnessSession(root, workspace, graph, bounds, folder) as session:
        yield from session.prepare(nodes=nodes, topics=topics, callbacks=callbacks, kinds=kinds)


__all__ = ["Harness", "HarnessSession", "PreparedCallback", "prepare_callbacks"]
