"""What a package offers, and what changed between two versions of it, as text, JSON and Markdown."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import msgspec

from ...edges.console import escape, format_json
from ...impact.facts.surface import FUNCTIONS, format_declaration
from ...impact.report.columns import LinePart, lay_out
from ...impact.report.markdown_text import escape_markdown, format_cell, quote
from ...impact.report.style import Style, paint
from ...impact.targets.surface.python import SurfaceNames, write_signature
from ...impact.targets.surface.surface import Surface
from .version_change import VersionChange


class VersionSource(NamedTuple):
    """Where a version was read. asked: as the user wrote it. approximate: it is not there, and the revision stands for
    it."""

    asked: str
    version: str
    repository: str
    revision: str
    approximate: bool = False


class SurfaceDifference(NamedTuple):
    """A comparison of two versions of some packages of one repository."""

    old: VersionSource
    new: VersionSource
    changes: dict[str, tuple[VersionChange, ...]]


_GROUPS = ("breaks", "may break", "deprecated", "changed", "added")
_TITLES = {
    "breaks": "Breaking changes",
    "may break": "Possibly breaking changes",
    "deprecated": "Newly deprecated",
    "changed": "Compatible changes",
    "added": "New",
}
_ROLES = {"breaks": "error", "may break": "warning", "deprecated": "warning", "changed": "note", "added": "good"}


def select_group(change: VersionChange) -> str:
    """Which part of the report a change belongs to."""
    if change.breaks:
        return "breaks" if change.sure >= 0.6 else "may break"
    if change.kind == "deprecated":
        return "deprecated"
    return "added" if change.kind == "added" else "changed"


def render_diff_text(found: SurfaceDifference, style: Style, everything: bool) -> str:
    """The report for people. everything: what is new and what changed harmlessly one by one too, else as numbers."""
    lines: list[str] = []
    for package, changes in found.changes.items():
        lines += _render_heading(package, found, style)
        groups = {name: [c for c in changes if select_group(c) == name] for name in _GROUPS}
        for name in _GROUPS:
            if not groups[name]:
                continue
            title = f"{_TITLES[name]}: {len(groups[name])}"
            if name in ("changed", "added") and not everything:
                counts = Counter(c.what for c in groups[name])
                reported = ", ".join(f"{number} {_pluralize(what, number)}" for what, number in counts.most_common())
                lines += ["", *lay_out([LinePart(f"{title} ({reported})", "dim")], style, 0, 2)]
                continue
            lines += ["", paint(style, _ROLES[name], title)]
            at = ""
            for change in sorted(groups[name], key=lambda c: (c.side, c.where)):
                if change.where != at and change.where not in ("", change.name):
                    lines += lay_out([LinePart("in ", "dim", change.where)], style, 2, 4)
                at = change.where
                lines += _render_change(change, style)
        if not changes:
            lines += ["", "nothing changed"]
        lines.append("")
    if not everything and any(select_group(c) in ("changed", "added") for each in found.changes.values() for c in each):
        lines += [paint(style, "dim", "--all also lists additions and compatible changes"), ""]
    return "\n".join(lines[:-1]) + "\n"


def _render_heading(package: str, found: SurfaceDifference, style: Style) -> list[str]:
    arrow = style.symbols[3]
    lines = [paint(style, "bold", escape(f"package {package} {_shorten(found.old)} {arrow} {_shorten(found.new)}"))]
    for source in (found.old, found.new):
        lines += _render(source, style)
    return lines


def _shorten(source: VersionSource) -> str:
    return f"{source.version} ({source.asked})" if source.version not in ("", source.asked) else source.asked


def _explain_approximation(source: VersionSource) -> str:
    if source.revision == source.version:
        return "it was read at a branch"
    return f"{source.version} is not there"


def _render(source: VersionSource, style: Style) -> Iterator[str]:
    text = f"{source.asked}: {source.revision} of {source.repository}"
    if source.approximate:
        text += f"; {_explain_approximation(source)}, so this is approximate"
    yield from lay_out([LinePart(text, "warning" if source.approximate else "dim")], style, 2, 4)


def _render_change(change: VersionChange, style: Style) -> Iterator[str]:
    aspects = f" ({', '.join(change.aspects)})" if change.aspects and change.kind != "removed" else ""
    word = "overload removed" if change.kind == "removed" and "overload" in change.aspects else change.kind
    pieces = [LinePart(f"{word} {change.what}{aspects}"), LinePart(change.name, "bold")]
    if change.sure < 0.6:
        pieces.append(LinePart("not sure", "dim"))
    yield from lay_out(pieces, style, 2, 4)
    for mark, text in (("- ", change.old), ("+ ", change.now)):
        if text:
            yield from lay_out([LinePart(mark + text)], style, 4, 8)
    help_ = describe_remedy(change)
    if help_:
        yield from lay_out([LinePart(help_, "help")], style, 4, 6)


def add_hashes(change: VersionChange, old: Mapping[str, str], new: Mapping[str, str]) -> VersionChange:
    """A change of the serialized format, with the hashes of the interface where both are known. old, new: by
    `msg/Name`."""
    name = change.name.partition("/")[2]
    return msgspec.structs.replace(change, old=old[name], now=new[name]) if name in old and name in new else change


def describe_remedy(change: VersionChange) -> str:
    """What to do now, in a clause; empty where that is not known."""
    reported = []
    if change.instead:
        reported.append(f"perhaps `{change.instead}`" if change.kind == "removed" else f"now `{change.instead}`")
    if change.moved_to:
        reported.append(f"in package {change.moved_to}")
    return f"help: {', '.join(reported)}" if reported else ""


def _pluralize(what: str, number: int) -> str:
    if number == 1:
        return what
    noun, *rest = what.partition(" of ")
    plural = f"{noun[:-1]}ies" if noun.endswith("y") else f"{noun}es" if noun.endswith(("s", "sh")) else f"{noun}s"
    return "".join((plural, *rest))


def render_diff_markdown(found: SurfaceDifference) -> str:
    """The report as Markdown, for a pull request or a wiki."""
    lines: list[str] = []
    for package, changes in found.changes.items():
        lines += [
            f"## {escape_markdown(package)} {escape_markdown(_shorten(found.old))}"
            f" → {escape_markdown(_shorten(found.new))}",
            "",
        ]
        for source in (found.old, found.new):
            if source.approximate:
                lines += [
                    f"{quote(source.revision)} of {escape_markdown(source.repository)}: "
                    f"{escape_markdown(_explain_approximation(source))}.",
                    "",
                ]
        for name in _GROUPS:
            these = [c for c in changes if select_group(c) == name]
            if not these:
                continue
            lines += [f"### {_TITLES[name]}: {len(these)}", "", "| what | name | old | new |", "|---|---|---|---|"]
            for change in these:
                now = change.now or describe_remedy(change).removeprefix("help: ")
                cells = (f"{change.kind} {change.what}", _quote(change.name), _quote(change.old), _quote(now))
                lines.append(f"| {' | '.join(cells)} |")
            lines.append("")
        if not changes:
            lines += ["Nothing changed.", ""]
    return "\n".join(lines)


def _quote(text: str) -> str:
    return format_cell(quote(text)) if text else ""


def render_diff_json(found: SurfaceDifference, tool: str) -> str:
    """The report as JSON: `tool`, `old` and `new` (see Source), `changes` (see Change)."""
    changes = [change for each in found.changes.values() for change in each]
    return _dump_json({"tool": tool, "old": found.old._asdict(), "new": found.new._asdict(), "changes": changes})


def _dump_json(value: Any) -> str:
    return format_json(msgspec.to_builtins(value)) + "\n"


class OfferedItem(NamedTuple):
    """Something that a package offers. part: Interfaces, C++, Python, CMake or Programs. where: header or file.
    deprecated: None for what is not."""

    part: str
    what: str
    name: str
    declaration: str = ""
    where: str = ""
    deprecated: str | None = None


def iterate_items(surface: Surface, hashes: Mapping[str, str]) -> Iterator[OfferedItem]:
    """All that a package offers, part by part. hashes: of its interfaces, by `msg/Name`, as far as they are known."""
    for name, definition in surface.interfaces:
        full = f"{surface.package}/{name}"
        if name in hashes:
            yield OfferedItem("Interfaces", "hash", full, hashes[name])
        for section in definition.sections:
            part = "" if section.name == "message" else f"{section.name}."
            for field in section.fields:
                default = f" {field.default}" if field.default else ""
                written = f"{field.type}{field.array} {field.name}{default}"
                yield OfferedItem("Interfaces", "field", f"{full} {part}{field.name}", written)
            for one in section.constants:
                written = f"{one.type} {one.name}={one.value}"
                yield OfferedItem("Interfaces", "constant", f"{full} {part}{one.name}", written)
        if name not in hashes and not any(one.fields or one.constants for one in definition.sections):
            yield OfferedItem("Interfaces", "interface", full)
    known = dict(surface.headers)
    for header in surface.build.headers:
        if header.include not in known:
            yield OfferedItem("C++", "header", header.include, "generated")
    for path, header in surface.headers:
        yield OfferedItem("C++", "header", path, deprecated=header.deprecated)
        for one in header.entities:
            if one.kind != "using namespace" and not one.internal and one.access != "private":
                yield OfferedItem("C++", one.kind, one.name, format_declaration(one), path, one.deprecated)
    names = SurfaceNames(surface.python)
    for module in surface.python.modules:
        yield OfferedItem("Python", "module", module.name, where=module.path)
    for name, entry in sorted(names.offered.items()):
        shown = write_signature(entry.bound.parameters) if entry.bound and entry.kind in ("function", "method") else ""
        deprecated = (entry.bound.deprecated or None) if entry.bound else None
        yield OfferedItem("Python", entry.kind, name, shown, deprecated=deprecated)
        for member, inner in names.list_members(entry).items() if entry.kind == "class" and entry.where == name else ():
            shown = write_signature(inner.bound.parameters) if inner.bound and "method" in inner.kind else ""
            yield OfferedItem("Python", inner.kind, f"{name}.{member}", shown)
    build = surface.build
    yield from (OfferedItem("CMake", "cmake package", name) for name in build.cmake_names)
    yield from (OfferedItem("CMake", "target", target.name, target.kind) for target in build.targets)
    yield from (OfferedItem("CMake", "command", name) for name in build.commands)
    yield from (OfferedItem("CMake", "variable", name) for name in build.variables)
    yield from (OfferedItem("Programs", "executable", program.name, program.how) for program in build.programs)
    yield from (OfferedItem("Programs", "plugin", one.name, f"{one.type} ({one.base})") for one in build.plugins)
    for launch in build.launches:
        written = ", ".join(name if default is None else f"{name}:={default}" for name, default in launch.arguments)
        yield OfferedItem("Programs", "launch file", launch.path, written)
    yield from (OfferedItem("Programs", "parameter", name, default or "") for name, default in surface.parameters)


def show_text(
    surface: Surface, source: VersionSource, style: Style, everything: bool, hashes: Mapping[str, str] = {}
) -> str:
    """What a package offers, for people. everything: members of classes, constants and macros too. hashes: see
    items()."""
    build = surface.build
    lines = [paint(style, "bold", escape(f"package {surface.package} {_shorten(source)}")), *_render(source, style)]
    facts = [f"build type {build.build_type}"] if build.build_type else []
    if build.standard:
        facts.append(f"C++{build.standard}")
    if build.dependencies:
        facts.append(f"exports dependencies: {', '.join(build.dependencies)}")
    lines += lay_out([LinePart("; ".join(facts))], style, 2, 4) if facts else []
    if surface.guessed:
        lines += lay_out([LinePart("installed headers are unknown; those of include/ are listed",
                                 "warning")], style, 2, 4)  # fmt: skip
    last = ""
    for item in iterate_items(surface, hashes):
        if not everything and item.part != "Interfaces" and item.what in _DETAILS:
            continue
        if item.part != last:
            lines += ["", paint(style, "bold", item.part)]
            last = item.part
        inner = item.part == "C++" and item.what != "header"
        written = item.part == "C++" and item.what in _WRITTEN
        pieces = [LinePart(item.what, "dim"), LinePart(item.declaration if written else item.name)]
        if not written and item.declaration:
            pieces.append(LinePart(item.declaration, "dim"))
        if item.deprecated is not None:
            pieces.append(LinePart(f"deprecated: {item.deprecated}" if item.deprecated else "deprecated", "warning"))
        lines += lay_out(pieces, style, 4 if inner else 2, 8)
    if surface.build.unknown:
        lines += ["", paint(style, "bold", "Not known")]
        for part, why in surface.build.unknown:
            lines += lay_out([LinePart(f"{part}: {why}")], style, 2, 4)
    return "\n".join(lines) + "\n"


_DETAILS = frozenset(("method", "field", "constructor", "destructor", "conversion", "enumerator", "macro", "attribute",
                      "property", "classmethod", "staticmethod", "instance", "using"))  # fmt: skip
_WRITTEN = FUNCTIONS | {"class", "struct", "union", "enum", "alias", "variable", "macro"}


def show_json(surface: Surface, source: VersionSource, tool: str, hashes: Mapping[str, str]) -> str:
    """What a package offers as JSON: `tool`, `source` (see Source), `package`, `items` (see Item), `unknown`."""
    return _dump_json({
        "tool": tool,
        "source": source._asdict(),
        "package": surface.package,
        "build_type": surface.build.build_type,
        "standard": surface.build.standard,
        "passes_on": surface.build.dependencies,
        "items": [item._asdict() for item in iterate_items(surface, hashes)],
        "unknown": [{"part": part, "why": why} for part, why in surface.build.unknown],
    })  # fmt: skip


def show_markdown(surface: Surface, source: VersionSource, hashes: Mapping[str, str]) -> str:
    """What a package offers as a table."""
    lines = [f"## {escape_markdown(surface.package)} {escape_markdown(_shorten(source))}", ""]
    lines += ["| what | name | declaration |", "|---|---|---|"]
    lines += [f"| {i.what} | {_quote(i.name)} | {_quote(i.declaration)} |" for i in iterate_items(surface, hashes)]
    return "\n".join(lines) + "\n"
