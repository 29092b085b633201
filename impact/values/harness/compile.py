"""Harnesses to LLVM IR, to programs that replay and fuzz, and to a folder for KLEE.

Headers are looked for in this order: messages and facades of ours, the workspace, the machine's libraries; what is in
none of them is an empty header, and what it would declare is worked out of the compiler's errors (stubs.py).
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from ....edges.files import read_text, write_file, write_scratch_file
from ....edges.groups import group_pairs
from ..outcomes import Bounds
from .cuts import SourceCuts
from .facade import RUNTIME, find_facade, list_folders
from .interfaces import KnownInterfaces, write_headers
from .precompiled import Facade, find_includes, find_plain_includes, split_dependencies
from .sources import SourceUnit, is_optional_line
from .stubs import CompileError, StubTable, parse_errors
from .toolchain import (
    NO_CLANG,
    NO_COMPILER,
    NO_FUZZER,
    NO_SANITIZER,
    CompilerRun,
    CompilerTime,
    find_clang,
    find_fuzzer,
    find_header_folders,
    find_native_compiler,
)

_ROUNDS_OF_HEADERS = 8
_ROUNDS_OF_STUBS = 30
_HEADER_BYTES = 4_000_000
_SYSTEM = ("/usr/include", "/usr/local/include")
_HEADERS = (".h", ".hpp", ".hh", ".hxx", ".ipp", ".inl", ".tpp")
CHECKS = (
    "signed-integer-overflow,integer-divide-by-zero,float-cast-overflow,shift,bounds,null,return,unreachable,vla-bound"
)
"""The checks of UBSan that are crashes; the same for the executor and for replays."""
_IR_FLAGS = (
    "-O1", "-gline-tables-only", "-fno-vectorize", "-fno-slp-vectorize", "-fno-unroll-loops",
    "-fno-jump-tables",
    "-fno-threadsafe-statics", "-fno-discard-value-names", "-DRI_SYMBOLIC=1", "-D_GLIBCXX_EXTERN_TEMPLATE=0",
    f"-fsanitize={CHECKS}", "-fno-sanitize-recover=all",
)  # fmt: skip
_NATIVE_FLAGS = (
    "-O0", "-gline-tables-only", "-fno-omit-frame-pointer", f"-fsanitize=address,{CHECKS}",
    "-fno-sanitize-recover=all", "-fno-optimize-sibling-calls",
)  # fmt: skip
_NATIVE_FLAGS_OF_GCC = ("-O1", "-g", *_NATIVE_FLAGS[2:], "-Wno-psabi")


class CannotCompile(Exception):
    """A harness does not compile; the text is the first error, with its place."""


class HarnessFiles(NamedTuple):
    """What KLEE users are given. folder: where it was written; script: what compiles it."""

    folder: Path
    script: Path


class Workshop:
    """Compiles units of one workspace in a folder of its own. root: of the workspace; packages: folders of its
    packages, relative to it; is_own, list_bases: of its code, as StubTable has them."""

    def __init__(
        self,
        root: Path,
        folder: Path,
        definitions: KnownInterfaces,
        packages: Iterable[str],
        bounds: Bounds,
        is_own: Callable[[str, str], bool] = lambda scope, name: False,
        list_bases: Callable[[str], Sequence[str]] = lambda name: (),
    ):
        self.root, self.folder, self.definitions, self.bounds = root.resolve(), folder, definitions, bounds
        self.include = folder / "include"
        self.include.mkdir(parents=True, exist_ok=True)
        # Headers that stand for Boost's, for the units that use them.
        self.boost = folder / "boost"
        self._is_own, self._list_bases = is_own, list_bases
        self._folders: dict[str, None] = {}
        self._system: dict[str, None] = {}
        for package in packages:
            for inner in ("include", f"include/{package.rpartition('/')[2]}", "src", ""):
                at = self.root / package / inner
                if at.is_dir():
                    self._folders[str(at)] = None
        self._lines: dict[str, list[str]] = {}
        self._wanted: dict[tuple[str, bool], bool] = {}
        self._cuts: SourceCuts | None = None
        self.time = CompilerTime(bounds.compiling)
        # What units added to classes of the facades; later ones begin with it, and with a facade that has it.
        self._extras: dict[str, dict[str, str]] = {}
        # What was learnt of a header, for the next units that include it.
        self._lessons: dict[str, dict[CompileError, None]] = {}
        # What could not be built, with the reason.
        self._failed: dict[Path, str] = {}

    def start_time(self) -> None:
        """What is prepared from now on has a time limit of its own."""
        self.time = CompilerTime(self.bounds.compiling)

    def _run(self, command: Sequence[str], folder: Path) -> CompilerRun:
        """Runs a compiler. Raises CannotCompile where there is no time left."""
        if self.time.is_over:
            raise CannotCompile(self.time.describe())
        run = self.time.run(command, folder)
        if run.status != 0 and self.time.is_over:
            raise CannotCompile(self.time.describe())
        return run

    # Headers

    @cached_property
    def _facade(self) -> Facade:
        return Facade(self.definitions)

    @cached_property
    def _headers(self) -> dict[str, list[Path]]:
        """The headers of the workspace, by the last part of their path."""
        found = (
            path for path in sorted(self.root.rglob("*"))
            if path.suffix in _HEADERS and ".git" not in path.parts and path.is_file()
        )  # fmt: skip
        return group_pairs((path.name, path) for path in found)

    def _make_header(self, header: str, unit: SourceUnit) -> None:
        """Makes a header that is not found."""
        if header.startswith("/") or ".." in header.split("/"):
            unit.missing.append(header)
            return
        if (self.include / header).exists() or (unit.boost and (self.boost / header).exists()):
            return
        key = self.definitions.find_key_of_header(header)
        if key:
            self._write(write_headers(self.definitions, key))
            if (self.include / header).exists():
                return
        configuration = self.definitions.write_configuration(header)
        if configuration:
            self._write({header: configuration})
            return
        facade = find_facade(header, self.definitions.ros, unit.boost)
        if facade:
            folder = self.boost if facade.startswith("boost/") else self.include
            self._write({header: f"#pragma once\n#include <{facade}>\n"}, folder)
            return
        own = self._find_own(header)
        if own is not None:
            self._folders[str(own)] = None
            return
        for prefix in _SYSTEM:
            at = next(iter(sorted(Path(prefix).glob(f"*/{header}"))), None)
            if at is not None and self._is_library(at):
                self._system[str(at)[: -len(header) - 1]] = None
                return
        self._write({header: "#pragma once\n"})
        unit.missing.append(header)

    def _find_own(self, header: str) -> Path | None:
        """The folder of the workspace from which a header is found."""
        for path in self._headers.get(header.rpartition("/")[2], ()):
            if path.as_posix().endswith(f"/{header}"):
                return Path(str(path)[: -len(header) - 1])
        return None

    def _is_library(self, path: Path) -> bool:
        """Whether a header of the machine is of a library that ROS does not know."""
        first = next((path.relative_to(one).parts[0] for one in _SYSTEM if path.is_relative_to(one)), "")
        return not Path(f"/usr/share/{first}/package.xml").exists()

    def _write(self, files: Mapping[str, str], folder: Path | None = None) -> None:
        for path, text in files.items():
            at = (folder or self.include) / path
            if not at.exists():
                at.parent.mkdir(parents=True, exist_ok=True)
                write_scratch_file(at, text.encode())

    def _make_headers(self, unit: SourceUnit, path: Path) -> list[Path]:
        """Makes the headers that a unit and the workspace's headers include and that are not there, as far as their
        text tells: of messages and facades in any case, of others where no condition is around them. Gives the files
        that it read."""
        facades = list_folders(self.definitions.ros)
        waiting, seen = [path], {path: None}
        while waiting:
            at = waiting.pop()
            text = "\n".join(self._read_lines(str(at)))
            plain = find_plain_includes(text)
            for header in find_includes(text):
                folders = (at.parent, *facades, *map(Path, (*unit.folders, *self._folders)))
                found = next((each / header for each in folders if (each / header).is_file()), None)
                if found is None:
                    if header.startswith("/"):
                        continue
                    if not self._is_ours(header, unit) and (header not in plain or self._is_on_machine(header, unit)):
                        continue
                    self._make_header(header, unit)
                    folders = (self.boost, self.include, *map(Path, self._folders))
                    found = next((each / header for each in folders if (each / header).is_file()), None)
                    if found is None:
                        continue
                if found not in seen:
                    seen[found] = None
                    waiting.append(found)
        return list(seen)

    def _is_ours(self, header: str, unit: SourceUnit) -> bool:
        """Whether a header is one of a message, or a facade stands for it."""
        own = find_facade(header, self.definitions.ros, unit.boost)
        return bool(own or self.definitions.find_key_of_header(header))

    def _is_on_machine(self, header: str, unit: SourceUnit) -> bool:
        """Whether a compiler finds a header on the machine that none of ours stands for."""
        folders = (Path(each) for each in (*find_header_folders(find_clang()), *self._system))
        at = next((each / header for each in folders if (each / header).is_file()), None)
        return at is not None and not self._is_wanted(str(at), unit)

    def _has_wanted(self, unit: SourceUnit) -> bool:
        """Whether a unit was compiled with a header of the machine that ours stand for."""
        rule = read_text(self.folder / unit.name / "harness.d", _HEADER_BYTES, "replace")
        return any(self._is_wanted(each, unit) for each in split_dependencies(rule))

    def _find_headers(self, unit: SourceUnit, clang: str, path: Path) -> None:
        """Provides all headers that a unit includes and that are not there."""
        seen: set[str] = set()
        for _ in range(_ROUNDS_OF_HEADERS):
            run = self._run_clang(unit, clang, ("-M", "-MG", str(path)), path.parent)
            if run.status != 0 and not run.out:
                return
            wanted = [each for each in split_dependencies(run.out) if self._is_wanted(each, unit)]
            new = [each for each in map(self._shorten, wanted) if each not in seen]
            if not new:
                return
            for header in new:
                seen.add(header)
                self._make_header(header, unit)

    def _is_wanted(self, path: str, unit: SourceUnit) -> bool:
        """Whether a header is not there, or is one of ROS that is installed and stands in the way of ours."""
        key = path, unit.boost
        if key not in self._wanted:
            self._wanted[key] = self._decide_wanted(path, unit)
        return self._wanted[key]

    def _decide_wanted(self, path: str, unit: SourceUnit) -> bool:
        if not path.startswith("/"):
            return True
        at = next((Path(path).relative_to(one) for one in _SYSTEM if path.startswith(one + "/")), None)
        if path.startswith("/opt/ros/"):
            return True
        if at is None:
            return False
        if at.parts[0] == "boost":
            return unit.boost and bool(find_facade(str(at), self.definitions.ros))
        ours = find_facade(str(at), self.definitions.ros) or self.definitions.find_key_of_header(str(at))
        return bool(ours) or (len(at.parts) > 1 and not self._is_library(Path(path)))

    def _shorten(self, path: str) -> str:
        for prefix in _SYSTEM:
            if path.startswith(prefix + "/"):
                return path[len(prefix) + 1 :]
        found = re.match(r"/opt/ros/\w+/include/(.*)", path)
        if found is not None:
            first, _, rest = found[1].partition("/")
            return rest if rest.startswith(first + "/") else found[1]
        return path

    # Compiling

    def _list_flags(self, unit: SourceUnit) -> list[str]:
        folders = [*([str(self.boost)] if unit.boost else []), str(self.include)]
        folders += map(str, list_folders(self.definitions.ros))
        if unit.is_c:
            given = [each for each in self._list_macros(unit) if each.startswith(("-D", "-U", "-w"))]
            given += [f"-D{each}" for each in unit.definitions]
            folders += [*unit.folders, *self._folders]
            return ["-x", "c", "-std=gnu11", *given, *(f"-I{each}" for each in folders)]
        flags = ["-x", "c++", *self._list_macros(unit)]
        flags += [f"-D{each}" for each in unit.definitions]
        flags += sorted(unit.stubs.flags) if unit.stubs is not None else []
        flags += [f"-ivfsoverlay{unit.cuts.overlay}"] if unit.cuts else []
        flags += ["-include", str(self._find_stubs(unit))]
        flags += [f"-I{each}" for each in (*folders, *unit.folders, *self._folders)]
        return [*flags, *(each for one in self._system for each in ("-isystem", one))]

    def _list_macros(self, unit: SourceUnit) -> list[str]:
        """What all units of a standard are compiled with."""
        return [
            f"-std=gnu++{unit.standard}", "-w", "-fno-access-control", f"-DRI_ROS={self.definitions.ros}",
            f"-DRI_TEXT={self.bounds.text}", f"-DRI_ARRAY={self.bounds.array}", "-D_GLIBCXX_ASSERTIONS",
            "-D_GNU_SOURCE",
            "-U_FORTIFY_SOURCE", "-UNDEBUG",
        ]  # fmt: skip

    def _find_stubs(self, unit: SourceUnit) -> Path:
        return self.folder / unit.name / "ri_stubs.hpp"

    def _read_line(self, path: str, number: int) -> str:
        changed = self._cuts.read_lines(path) if self._cuts is not None else None
        if changed is not None:
            return changed[number - 1] if 0 < number <= len(changed) else ""
        lines = self._read_lines(path)
        return lines[number - 1] if 0 < number <= len(lines) else ""

    def _read_lines(self, path: str) -> list[str]:
        if path not in self._lines:
            try:
                self._lines[path] = read_text(Path(path), _HEADER_BYTES, "replace").split("\n")
            except OSError:
                self._lines[path] = []
        return self._lines[path]

    def prepare(self, unit: SourceUnit, write: Callable[[Collection[str]], SourceUnit] | None = None) -> Path:
        """Makes a unit compile: provides headers, stands for what these declare, and leaves parts out that do not
        compile. write: the unit without some of its parts. Gives its path. Raises CannotCompile."""
        clang = find_clang()
        if not clang:
            raise CannotCompile(NO_CLANG)
        folder = self.folder / unit.name
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "harness.cpp"
        if unit.is_c:
            return self._prepare_plain(unit, clang, path)
        unit.stubs = StubTable(self._read_line, self._is_own, self._list_bases, self._extras)
        unit.cuts = SourceCuts(self.root, folder)
        self._cuts = unit.cuts
        try:
            self._compile(unit, clang, path, write)
        finally:
            self._extras = unit.stubs.extras
            for each in unit.stubs.lessons:
                self._lessons.setdefault(each.path, {}).setdefault(each)
        return path

    def _compile(
        self, unit: SourceUnit, clang: str, path: Path, write: Callable[[Collection[str]], SourceUnit] | None
    ) -> None:
        """The rounds of prepare()."""
        assert unit.stubs is not None and unit.cuts is not None
        self._store(unit, path)
        read = self._make_headers(unit, path)
        unit.stubs.learn_again(each for one in read for each in self._lessons.get(str(one), ()))
        self._store(unit, path)
        first: CompileError | None = None
        is_searched = False
        for _ in range(_ROUNDS_OF_STUBS):
            run = self._check(unit, clang, path)
            if run.status == 0 and (is_searched or not self._has_wanted(unit)):
                return
            errors = parse_errors(run.errors)
            if not is_searched and (run.status == 0 or any(self._is_wanted(each.path, unit) for each in errors)):
                # Only now the preprocessor is asked, which follows what is included into headers of the machine.
                is_searched = True
                self._find_headers(unit, clang, path)
                continue
            if not errors:
                raise CannotCompile(run.errors.strip().split("\n")[0] or "the compiler failed")
            missing = [each for each in errors if each.text.endswith("file not found")]
            own = [each for each in errors if each.path == str(path)]
            first = next((each for each in errors if each.path != str(path)), errors[0])
            if missing:
                for each in missing:
                    self._make_header(each.text.split("'")[1], unit)
                self._find_headers(unit, clang, path)
                continue
            if unit.boost and any("/boost/" in each.path and not each.path.startswith(str(RUNTIME)) for each in errors):
                unit.boost = False
                self._find_headers(unit, clang, path)
                continue
            learned = unit.stubs.learn(errors) or unit.stubs.remove_names(errors)
            learned = learned or unit.cuts.cut(run.errors)
            if not learned and own and len(own) == len(errors) and write is not None:
                self._drop_parts(unit, own, write, path)
                continue
            if not learned:
                break
            self._store(unit, path)
        raise CannotCompile(self._describe(first) if first is not None else "does not compile")

    def _prepare_plain(self, unit: SourceUnit, clang: str, path: Path) -> Path:
        """A unit that is compiled as it is, with headers that are found in the workspace, or not at all."""
        self._store(unit, path)
        for _ in range(_ROUNDS_OF_HEADERS):
            run = self._check(unit, clang, path)
            if run.status == 0:
                return path
            errors = parse_errors(run.errors)
            missing = [each.text.split("'")[1] for each in errors if each.text.endswith("file not found")]
            if not missing or not all(self._find_own(each) for each in missing):
                raise CannotCompile(self._describe_run(run))
            for header in missing:
                self._make_header(header, unit)
        raise CannotCompile("its headers are not found")

    def _drop_parts(self, unit: SourceUnit, errors: Sequence[CompileError], write, path: Path) -> None:
        """Leaves the parts of a unit out that have errors: one line where that may be left out on its own."""
        lines = unit.text.split("\n")
        for each in errors:
            if each.line <= len(lines) and is_optional_line(lines[each.line - 1]):
                unit.dropped.setdefault(lines[each.line - 1].strip(), each.text)
                continue
            name = next((n for n, (a, b) in unit.blocks.items() if a <= each.line <= b), None)
            if name is None:
                raise CannotCompile(self._describe(each))
            unit.dropped.setdefault(name, each.text)
        made = write(unit.dropped)
        unit.text, unit.blocks = made.text, made.blocks
        self._store(unit, path)

    def _store(self, unit: SourceUnit, path: Path) -> None:
        write_scratch_file(path, unit.text.encode())
        write_scratch_file(self._find_stubs(unit), (unit.stubs or StubTable(self._read_line)).render().encode())
        self._lines.pop(str(path), None)

    def _check(self, unit: SourceUnit, clang: str, path: Path) -> CompilerRun:
        flags = ("-ferror-limit=0", "-fno-caret-diagnostics", "-fno-spell-checking", "-ftemplate-backtrace-limit=0")
        flags = (*flags, "-S", "-emit-llvm", "-MD", "-MF", "harness.d", str(path), "-o", "harness.ll")
        return self._run_clang(unit, clang, flags, path.parent)

    def _run_clang(self, unit: SourceUnit, clang: str, rest: Sequence[str], folder: Path) -> CompilerRun:
        """Runs clang as for IR, with the facade as it was compiled before where a unit has it as it is."""
        return self._run_with_facade(unit, clang, _IR_FLAGS, rest, folder)

    def _run_with_facade(
        self, unit: SourceUnit, clang: str, mode: Sequence[str], rest: Sequence[str], folder: Path
    ) -> CompilerRun:
        """Runs clang on a unit. mode: the flags that decide what is made, for which there is a facade of its own."""
        flags = self._list_flags(unit)
        made = self._find_precompiled(unit, clang, mode)
        if made is None:
            return self._run([clang, *flags, *mode, *rest], folder)
        at = flags.index("-include")
        # Its headers come first: the same ones elsewhere would define everything again.
        given = ("-include-pch", str(made), f"-I{made.parent / 'include'}")
        run = self._run([clang, *flags[:at], *given, *flags[at:], *mode, *rest], folder)
        if run.status > 0 and "precompiled header" in run.errors:
            # A macro of the package is another one in it.
            return self._run([clang, *flags, *mode, *rest], folder)
        if run.status < 0 or (run.status and (str(made) in run.errors or "PCH file" in run.errors)):
            self._facade.forget(made)
            return self._run([clang, *flags, *mode, *rest], folder)
        return run

    def _find_precompiled(self, unit: SourceUnit, clang: str, mode: Sequence[str]) -> Path | None:
        """The facade, compiled once for all units of a standard, whatever further macros these define, none of which it
        asks for; with the members that were added to its classes, once for all units that have the same ones, but not
        for replays, which compile a unit once."""
        if unit.stubs is None or not unit.boost:
            return None
        flags = [*self._list_macros(unit), *mode]
        extras = unit.stubs.render_extras()
        if not extras:
            return self._facade.find_precompiled(clang, flags)
        if mode is not _IR_FLAGS:
            return None
        return self._facade.find_extended(clang, flags, extras, self.folder / "facades", self._run)

    def _describe(self, error: CompileError) -> str:
        path = Path(error.path)
        if path.is_relative_to(self.root):
            return f"{path.relative_to(self.root)}:{error.line}: {error.text}"
        return f"{path.name}:{error.line}: {error.text}"

    def read_ir(self, unit: SourceUnit) -> str:
        """The IR of a unit that was prepared."""
        return read_text(self.folder / unit.name / "harness.ll", 400_000_000, "replace")

    def _describe_run(self, run: CompilerRun) -> str:
        errors = parse_errors(run.errors)
        return self._describe(errors[0]) if errors else (run.errors.strip().split("\n")[0] or "the compiler failed")

    def build_replay(self, units: Sequence[SourceUnit]) -> Path:
        """The program that replays witnesses of units that were prepared together. Raises CannotCompile."""
        is_cut = any(unit.cuts for unit in units)
        compiler = find_native_compiler(is_cut)
        if not compiler:
            raise CannotCompile(NO_SANITIZER if is_cut else NO_COMPILER)
        flags = _NATIVE_FLAGS if Path(compiler).name.startswith("clang") else _NATIVE_FLAGS_OF_GCC
        return self._build(units, compiler, flags, RUNTIME / "native.cpp", "replay")

    def build_fuzzer(self, units: Sequence[SourceUnit]) -> Path:
        """The program that libFuzzer drives. Raises CannotCompile."""
        compiler = find_fuzzer()
        if not compiler:
            raise CannotCompile(NO_FUZZER)
        flags = (
            "-O1",
            "-g",
            "-fno-omit-frame-pointer",
            f"-fsanitize=fuzzer,address,{CHECKS}",
            "-fno-sanitize-recover=all",
        )
        return self._build(units, compiler, flags, RUNTIME / "fuzz.cpp", "fuzz")

    def _build(
        self, units: Sequence[SourceUnit], compiler: str, flags: Sequence[str], runtime: Path, name: str
    ) -> Path:
        folder = self.folder / units[0].name
        program = folder / name
        if program.exists():
            return program
        if program not in self._failed:
            self.start_time()
            try:
                self._build_program(units, compiler, flags, runtime, program)
                return program
            except CannotCompile as error:
                self._failed[program] = str(error)
        raise CannotCompile(self._failed[program])

    def _build_program(
        self, units: Sequence[SourceUnit], compiler: str, flags: Sequence[str], runtime: Path, program: Path
    ) -> None:
        folder, name = program.parent, program.name
        objects = []
        for number, unit in enumerate(units):
            at = self.folder / unit.name / f"{name}.o"
            rest = ("-c", "harness.cpp", "-o", str(at))
            if compiler == find_clang():
                run = self._run_with_facade(unit, compiler, flags, rest, at.parent)
            else:
                run = self._run([compiler, *self._list_flags(unit), *flags, *rest], at.parent)
            if run.status == 0:
                objects.append(str(at))
            elif number == 0:
                raise CannotCompile(self._describe_run(run))
        made = self.folder / f"{name}_runtime.o"
        own = [each for each in flags if not each.startswith("-fsanitize=fuzzer")]
        if not made.exists():  # the same for all units
            command = [compiler, "-std=gnu++17", "-w", *own, f"-I{RUNTIME}", "-c", str(runtime), "-o", str(made)]
            run = self._run(command, folder)
            if run.status != 0:
                made.unlink(missing_ok=True)
                raise CannotCompile(self._describe_run(run))
        link = [compiler, *flags, *objects, str(made), "-o", str(program), "-pthread", "-Wl,--no-demangle"]
        run = self._run(link, folder)
        if run.status != 0:
            unknown = folder / f"{name}_unknown.o"
            self._write_unknown(folder, name, run.errors)
            command = [compiler, "-w", "-std=gnu++17", f"-I{RUNTIME}", "-c", f"{name}_unknown.cpp", "-o", str(unknown)]
            run = self._run(command, folder)
            run = self._run([*link, str(unknown)], folder) if run.status == 0 else run
        if run.status != 0:
            raise CannotCompile(f"does not link: {run.errors.strip().splitlines()[0] if run.errors.strip() else ''}")

    def _write_unknown(self, folder: Path, name: str, errors: str) -> None:
        """Functions and data that nothing defines: to use one ends a replay as unknown."""
        lines = ["#include <rosimpact_values.h>"]
        for number, symbol in enumerate(sorted(set(re.findall(r"undefined reference to [`']([^'\s]+)'", errors)))):
            if symbol.startswith(("_ZTV", "_ZTI", "_ZTS", "_ZGV")):
                lines.append(f'extern "C" void *ri_data_{number}[64] __asm__("{symbol}"); void *ri_data_{number}[64];')
            else:
                lines.append(f'extern "C" void ri_unknown_{number}() __asm__("{symbol}");')
                lines.append(f'extern "C" void ri_unknown_{number}() {{ ri_unknown("{symbol}"); }}')
        write_file(folder / f"{name}_unknown.cpp", "\n".join([*lines, ""]).encode())

    def emit_klee(self, unit: SourceUnit, entry: str, folder: Path) -> HarnessFiles:
        """Writes a folder from which KLEE is run as it is: the harness, its headers, a runtime and a script."""
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copytree(self.include, folder / "include", dirs_exist_ok=True)
        if unit.boost and self.boost.is_dir():
            shutil.copytree(self.boost, folder / "include", dirs_exist_ok=True)
        for one in reversed(list_folders(self.definitions.ros)):
            shutil.copytree(one, folder / "include", dirs_exist_ok=True)
        for name in ("harness.cpp", "ri_stubs.hpp"):
            shutil.copy(self.folder / unit.name / name, folder / name)
        shutil.copy(RUNTIME / "klee.cpp", folder / "klee_runtime.cpp")
        skipped = {f"-I{each}" for each in (self.boost, self.include, *list_folders(self.definitions.ros))}
        flags = [each for each in self._list_flags(unit) if each not in skipped and each != str(self._find_stubs(unit))]
        flags.remove("-include")
        if unit.cuts:
            kept = unit.cuts.write_into(folder)
            flags = [f"-ivfsoverlay{kept}" if each == f"-ivfsoverlay{unit.cuts.overlay}" else each for each in flags]
        quoted = " ".join(f"'{each}'" for each in flags)
        script = folder / "run_klee.sh"
        lines = [
            "#!/bin/sh", "# Compiles the harness to bitcode and runs KLEE on it.", "set -e", 'cd "$(dirname "$0")"',
            'CLANG=${CLANG:-clang++}', 'LINK=${LLVM_LINK:-llvm-link}', "KLEE=${KLEE:-klee}",
            f'FLAGS="-Iinclude {_escape(quoted)} -fno-threadsafe-statics -O1 -Xclang -disable-llvm-passes -g"',
            f"CHECKS='-fsanitize={CHECKS} -fno-sanitize-recover=all'",
            "eval $CLANG $FLAGS $CHECKS -include ri_stubs.hpp -emit-llvm -c harness.cpp -o harness.bc",
            f'FLAGS="$FLAGS -DRI_KLEE_ENTRY={entry} ${{KLEE_INCLUDE:+-I$KLEE_INCLUDE}}"',
            "eval $CLANG $FLAGS -emit-llvm -c klee_runtime.cpp -o klee_runtime.bc",
            "$LINK harness.bc klee_runtime.bc -o whole.bc",
            'exec $KLEE --libc=klee --ubsan-runtime --max-time="${SECONDS_AT_MOST:-60}" --emit-all-errors whole.bc', "",
        ]  # fmt: skip
        write_file(script, "\n".join(lines).encode())
        script.chmod(0o755)
        return HarnessFiles(folder, script)


def _escape(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("$", "\\$")
