"""Checks what `surface diff` reports against the sources themselves, by plain text search.

usage: surface_truth.py precision CLONES [--packages N] [--list N]
       surface_truth.py recall CLONES UPSTREAM_CHANGES.yaml [--list N]

precision: for packages with two released versions, every symbol that is reported as gone or changed is looked up at
both tags: its name must stand in the package at the old one; at the new one a removed header's file must be gone, the
name of a removed thing must not stand where it did (in what others see of its class, or in the headers or modules), and
the text of a changed declaration must not. The text is cut by regular expressions and braces, without the readers of
surfaces. recall: entries of the reviewed table that git verified are asked of the comparison of the two distros.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import NamedTuple

SOURCES = re.compile(r"\.(?:h|hpp|hh|hxx|h\+\+|ipp|tpp|tcc|inl|py|msg|srv|action|idl)(?:\.in|\.em)?$")
PYTHON = re.compile(r"\.py$")


class Text(NamedTuple):
    """The files of a package at a revision, comments taken out: text by path."""

    files: dict[str, str]

    def some(self, *endings: str) -> str:
        return "\n".join(text for path, text in self.files.items() if path.endswith(endings))


def git(repository: Path, *arguments: str) -> bytes:
    return subprocess.run(["git", "--git-dir", str(repository), *arguments], capture_output=True, check=True).stdout


def folders(repository: Path, revision: str) -> dict[str, str]:
    """Folder by the name of the package in it."""
    listing = git(repository, "ls-tree", "-r", "-z", "--name-only", revision).decode(errors="replace").split("\0")
    found = {}
    for path in listing:
        if path.rpartition("/")[2] == "package.xml":
            name = re.search(rb"<name>\s*([^<\s]+)", git(repository, "show", f"{revision}:{path}"))
            if name:
                found[name[1].decode()] = path.rpartition("/")[0]
    return found


def read(repository: Path, revision: str, folder: str) -> Text:
    """All sources below a folder."""
    listing = git(repository, "ls-tree", "-r", "-z", revision, "--", folder or ".").decode(errors="replace")
    files = {}
    for row in listing.split("\0"):
        meta, _, path = row.partition("\t")
        if SOURCES.search(path) and meta.split()[1] == "blob":
            data = git(repository, "cat-file", "blob", meta.split()[2]).decode(errors="replace")
            files[path[len(folder) + 1 if folder else 0 :]] = bare(data, python=bool(PYTHON.search(path)))
    return Text(files)


def bare(text: str, *, python: bool) -> str:
    """The text without comments (of C++: and without what stands in strings)."""
    if python:
        return re.sub(r"(?m)^\s*#.*$", "", text)
    return re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.DOTALL)


def bodies(text: str, name: str) -> list[str]:
    """What stands between the braces of each class, struct, union or enum of a name, private parts left out."""
    found = []
    marks = r"(?:[A-Z_0-9]+\s+|\[\[[^\]]*\]\]\s*|alignas\([^)]*\)\s*)*"
    end = r"\s*(?:<[^;{}]*>)?\s*(?:final\s*)?"
    head = rf"\b(class|struct|union|enum)\s+(?:class\s+|struct\s+)?{marks}{re.escape(name)}{end}"
    for match in re.finditer(rf"{head}(?::(?!:)[^;{{}}]*)?\{{", text):
        depth, place, kept = 1, match.end(), []
        start, hidden = place, match[1] == "class"
        while depth and place < len(text):
            depth += (text[place] == "{") - (text[place] == "}")
            label = depth == 1 and re.compile(r"(public|protected|private)(?:\s+\w+)?\s*:(?!:)").match(text, place)
            if label and not (text[place - 1].isalnum() or text[place - 1] == "_"):
                kept += [] if hidden else [text[start:place]]
                start, hidden = label.end(), label[1] == "private"
                place = label.end()
                continue
            place += 1
        found.append("\n".join([*kept, *([] if hidden else [text[start:place]])]))
    return found


def word(name: str, text: str) -> bool:
    return re.search(rf"(?<![\w~]){re.escape(name)}(?!\w)", text) is not None


def squeezed(text: str) -> str:
    return re.sub(r"\s+", "", text)


def confirmed(change, old: Text, new: Text) -> str:
    """`yes`, `no` or `open` where text cannot tell."""
    if change.side == "c++":
        return _header(change, old, new) if change.what == "header" else _cpp(change, old, new)
    if change.side == "python":
        return _python(change, old, new)
    if change.side == "message":
        return _message(change, old, new)
    return "open"


def _header(change, old: Text, new: Text) -> str:
    def there(text: Text) -> bool:
        end = f"/{change.name}"
        return any(f"/{path}".endswith((end, f"{end}.in", f"{end}.em")) for path in text.files)

    if change.kind not in ("removed", "moved"):
        return "open"
    return "yes" if there(old) and not there(new) else "no" if there(new) else "open"


_HEADERS = (".h", ".hpp", ".hh", ".hxx", ".h++", ".ipp", ".tpp", ".tcc", ".inl", ".in", ".em")


def _cpp(change, old: Text, new: Text) -> str:
    name = re.sub(r"<.*>$", "", change.name)
    owner, _, last = name.rpartition("::")
    last = re.sub(r"^operator\s*(?=\w)", "operator ", last)
    scope = owner.rpartition("::")[2]
    before, after = old.some(*_HEADERS), new.some(*_HEADERS)
    simple = last if not last.startswith(("operator", "~")) else ""
    if simple and not word(simple, before):
        return "no"
    old_bodies, new_bodies = (bodies(text, scope) if scope else [] for text in (before, after))
    inside = bool(old_bodies)
    if change.kind in ("removed", "moved") and "overload" not in change.aspects:
        if change.kind == "moved":
            return "yes" if simple and word(simple, before) else "open"
        if not simple:
            pieces = new_bodies if inside else [after]
            return "open" if any(squeezed(last) in squeezed(body) for body in pieces) else "yes"
        if change.where and not any(f"/{path}".endswith(f"/{change.where}") for path in new.files):
            header_gone = True
        else:
            header_gone = False
        if inside:
            if not new_bodies:
                return "yes"
            return "yes" if not any(_declares(body, simple, change.what) for body in new_bodies) else "no"
        if not word(simple, after):
            return "yes"
        text = "\n".join(t for p, t in new.files.items() if f"/{p}".endswith(f"/{change.where}"))
        if header_gone or not _declares(text, simple, change.what):
            return "yes" if not _declares(after, simple, change.what) else "open"
        return "no"
    if change.kind in (
        "signature",
        "removed",
        "default",
        "base",
        "type",
        "value",
        "deleted",
        "pure",
        "final",
        "access",
    ):
        return _text_changed(change, simple or last, old_bodies, new_bodies, before, after, inside)
    return "open"


def _declares(body: str, name: str, what: str) -> bool:
    """Whether a text declares the name rather than only uses it: by what stands around it."""
    end = {"macro": rf"#\s*define\s+{name}\b", "alias": rf"(?:using\s+{name}\b\s*=|typedef\b[^;]*\b{name}\s*;)"}.get(
        what
    )
    if what in ("class", "struct", "union", "enum"):
        end = rf"\b(?:class|struct|union|enum)\b[^;{{}}()=]*?\b{name}\b[^;{{}}()]*\{{|using\s+{name}\s*="
    elif what in ("function", "method", "constructor", "destructor", "conversion"):
        end = rf"(?:[\w>&*\]:]\s+|[&*]\s*|^\s*){name}\s*\([^;{{}}]*\)[^;{{}}()]*[;{{:]"
    elif end is None:
        end = rf"[\w>&*\]]\s*[&*\s]\s*{name}\s*(?:=|;|\[|\{{|:)|(?:^|[,{{])\s*{name}\s*(?:=|,|\}}|$)"
    return re.search(end, body, re.MULTILINE) is not None


def _text_changed(change, name, old_bodies, new_bodies, before, after, inside) -> str:
    """A changed declaration: the texts around the name must not be the same at both tags."""

    def spots(pieces: list[str]) -> Counter[str]:
        found: Counter[str] = Counter()
        for piece in pieces:
            sign = rf"operator\s*{re.escape(name[8:].strip())}" if name.startswith("operator") else re.escape(name)
            for match in re.finditer(rf"(?<![\w~]){sign}(?!\w)", piece):
                start = max(piece.rfind(mark, 0, match.start()) for mark in ";}{")
                stop = min((p for p in (piece.find(mark, match.end()) for mark in ";{") if p >= 0), default=len(piece))
                found[squeezed(piece[start + 1 : stop])] += 1
        return found

    old, new = spots(old_bodies if inside else [before]), spots(new_bodies if inside else [after])
    if not old:
        return "no"
    return "yes" if set(old) - set(new) else "no"


def _python(change, old: Text, new: Text) -> str:
    last = change.name.partition("(")[0].rpartition(".")[2]
    before, after = old.some(".py"), new.some(".py")
    if change.what == "module":

        def there(text: Text) -> bool:
            path = change.name.replace(".", "/")
            return any(f"/{p}".endswith((f"/{path}.py", f"/{path}/__init__.py")) for p in text.files)

        return "yes" if there(old) and not there(new) else "no"
    if not word(last, before):
        return "no" if not last.startswith("__") else "open"
    define = rf"(?m)^\s*(?:async\s+)?(?:def|class)\s+{last}\b|^\s*(?:self\.)?{last}\s*(?::[^=\n]+)?="
    if change.kind == "removed":
        if not word(last, after) or not re.search(define, after):
            return "yes"
        module = max((m for m in _modules(change.name) if _file(old, m)), key=len, default="")
        owner = change.name[len(module) + 1 :].split(".")[0] if module else ""
        mine = _file(new, module) or ""
        if owner and owner != last:
            block = re.search(rf"(?ms)^class\s+{owner}\b.*?(?=^\S|\Z)", mine)
            return "yes" if block is None or not re.search(define, block[0]) else "no"
        return "yes" if not re.search(define.replace(r"^\s*", "^"), mine) else "no"  # of the module: not indented
    if change.kind in ("signature", "default"):
        name = change.name.partition("(")[0].split(".")[-2] if last == "__init__" else last

        def heads(text: str) -> set[str]:
            return {
                squeezed(m[0])
                for m in re.finditer(rf"(?s)def\s+{last}\s*\(.*?\)\s*(?:->[^:]*)?:|(?m:^\s*{name}\s*[:=].*$)", text)
            }

        return "yes" if heads(before) != heads(after) else "no"
    return "open"


def _modules(name: str) -> list[str]:
    parts = name.split(".")
    return [".".join(parts[:length]) for length in range(1, len(parts) + 1)]


def _file(text: Text, module: str) -> str | None:
    path = module.replace(".", "/")
    return next((t for p, t in text.files.items() if f"/{p}".endswith((f"/{path}.py", f"/{path}/__init__.py"))), None)


def _message(change, old: Text, new: Text) -> str:
    inside, _, member = change.name.partition("/")[2].partition(".")
    name = inside.split(" ")[0].rpartition("/")[2]

    def lines(text: Text) -> list[str] | None:
        ends = tuple(f"/{name}.{end}" for end in ("msg", "srv", "action", "idl"))
        found = [t for p, t in text.files.items() if f"/{p}".endswith(ends)]
        return re.sub(r"#[^\n]*", "", found[0]).splitlines() if found else None

    before, after = lines(old), lines(new)
    if before is None:
        return "no"
    if change.what == "interface":
        if change.kind == "wire":
            return "yes" if after is not None and before != after else "no"
        return "yes" if after is None else "no"
    if after is None:
        return "no"
    mine = [" ".join(line.split()) for line in before if word(member, line)]
    theirs = [" ".join(line.split()) for line in after if word(member, line)]
    return "yes" if mine and mine != theirs else "no"


# -- precision ---------------------------------------------------------------------------------------------------------


def precision(folder: Path, count: int, listed: int) -> int:
    from rosimpact.databuild.surface.clones import Clones
    from rosimpact.databuild.surface.compare import RepositorySurfaces, compare
    from rosimpact.impact.facts.store import Store
    from rosimpact.impact.targets.version import parse

    clones = Clones(folder)
    totals: Counter[tuple[str, str]] = Counter()
    sure: Counter[str] = Counter()
    wrong: list[str] = []
    used = 0
    with Store() as store:
        for clone in sorted(clones.list_clones(), key=lambda c: c.name):
            versions = sorted(
                {v: names for each in clones.list_clone_releases(clone).values() for v, names in each.items()}.items(),
                key=lambda item: parse(item[0]),
            )
            tagged = [(v, names, tag) for v, names in versions if (tag := clone.tag(v)) is not None]
            if len(tagged) < 2 or used >= count:
                continue
            (_, names, first), (_, others, last) = tagged[len(tagged) // 3], tagged[-1]
            before, after = (RepositorySurfaces(clone.read_surfaces(tag, store)) for tag in (first, last))
            old_folders, new_folders = folders(clone.place, first), folders(clone.place, last)
            done = 0
            for package in sorted(names & others & before.surfaces.keys() & after.surfaces.keys()):
                changes = compare(before.surfaces[package], after.surfaces[package], before, after)
                asked = [c for c in changes if c.kind != "added" and c.side != "build" and c.kind != "deprecated"]
                if not asked or done >= 2 or package not in old_folders or package not in new_folders:
                    continue
                done += 1
                used += 1
                old, new = read(clone.place, first, old_folders[package]), read(clone.place, last, new_folders[package])
                own: Counter[str] = Counter()
                for change in asked:
                    answer = confirmed(change, old, new)
                    totals[f"{change.side} {change.kind}", answer] += 1
                    own[answer] += 1
                    if change.sure > 0.6:
                        sure[answer] += 1
                    if answer == "no":
                        spot = f"{package} {first[10:]} {last[10:]}: {change.side} {change.kind} {change.what}"
                        wrong.append(f"{spot} {change.name} | {change.old} | {change.now} | {change.where}")
                print(f"{package:32} {first[10:]:10} {last[10:]:10} {dict(own)}", flush=True)
    print()
    for kind in sorted({kind for kind, _ in totals}):
        print(f"{kind:24}", "  ".join(f"{answer} {totals[kind, answer]}" for answer in ("yes", "no", "open")))
    yes, no = (sum(n for (_, answer), n in totals.items() if answer == asked) for asked in ("yes", "no"))
    opened = sum(n for (_, answer), n in totals.items() if answer == "open")
    print(f"{used} packages: confirmed {yes}, not confirmed {no}, text cannot tell {opened}")
    share, share_sure = (n["yes"] / max(1, n["yes"] + n["no"]) for n in ({"yes": yes, "no": no}, sure))
    print(f"precision {share:.4f}; of those that are sure {share_sure:.4f}")
    for row in wrong[:listed]:
        print(row)
    return 0


# -- recall ------------------------------------------------------------------------------------------------------------


def recall(folder: Path, table: Path, listed: int) -> int:
    import yaml
    from rosimpact.databuild.surface.clones import Clone, VersionError
    from rosimpact.databuild.surface.compare import RepositorySurfaces, compare_states
    from rosimpact.impact.facts.store import Store
    from rosimpact.impact.tree import TreeError

    entries = [e for e in yaml.safe_load(table.read_text()) if str(e["verified"]).startswith("git")]
    answers: Counter[tuple[str, str]] = Counter()
    rows: list[str] = []
    states: dict[tuple[str, str], RepositorySurfaces | None] = {}
    known: dict[tuple[str, str, str], dict] = {}
    with Store() as store:

        def state(clone: Clone, revision: str) -> RepositorySurfaces | None:
            key = (clone.name, revision)
            if key not in states:
                try:
                    states[key] = RepositorySurfaces(clone.read_surfaces(revision, store))
                except TreeError:
                    states[key] = None
            return states[key]

        for entry in entries:
            spot = re.match(r"(\S+/\S+) \w+@([\w./-]+)\((\w+)\) vs \w+@([\w./-]+)\((\w+)\)", entry["source"])
            if spot is None:
                answers[entry["kind"], "no two revisions told"] += 1
                continue
            repository, _, old, _, new = spot.groups()
            place = folder / repository.replace("/", "+")
            try:
                clone = Clone(place, repository)
            except VersionError:
                answers[entry["kind"], "no clone here"] += 1
                continue
            before, after = state(clone, old), state(clone, new)
            if before is None or after is None:
                answers[entry["kind"], "commit not in the clone"] += 1
                continue
            if (clone.name, old, new) not in known:
                known[clone.name, old, new] = compare_states(before, after)
            found = _finds(entry, known[clone.name, old, new])
            answers[entry["kind"], "found" if found else "missed"] += 1
            if not found:
                rows.append(f"{entry['package']} {entry['kind']} {entry['old']} {old} {new}")
    for kind in sorted({kind for kind, _ in answers}):
        print(f"{kind:20}", {answer: n for (k, answer), n in answers.items() if k == kind})
    found, missed = (sum(n for (_, answer), n in answers.items() if answer == asked) for asked in ("found", "missed"))
    share = found / max(1, found + missed)
    print(f"{len(entries)} entries, {found + missed} can be asked here: found {found} ({share:.3f})")
    for row in rows[:listed]:
        print("missed", row)
    return 0


def _finds(entry: dict, changes: dict) -> bool:
    every = [c for each in changes.values() for c in each]
    old = entry["old"]
    gone = ("removed", "moved", "type")
    if entry["kind"].startswith("package"):
        return any(c.what == "package" and c.kind == "removed" and c.name == old for c in every)
    if entry["kind"].startswith("header"):
        return any(c.what == "header" and c.name == old and c.kind in (*gone, "deprecated") for c in every)
    if entry["kind"] == "msg-removed":
        name = re.sub(r"\.\w+$", "", old.rpartition("/")[2])
        return any(c.what == "interface" and c.kind in gone and c.name.endswith(f"/{name}") for c in every)
    if entry["kind"] == "msg-field-changed":
        match = re.match(r"(\w+)/(\w+)\.\w+#\d+: \S+ (\w+)", old)
        return match is not None and any(
            c.side == "message" and c.kind in gone and match[2] in c.name and c.name.endswith(f".{match[3]}")
            for c in every
        )
    return False


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="what", required=True)
    first = commands.add_parser("precision")
    first.add_argument("clones", type=Path)
    first.add_argument("--packages", type=int, default=30)
    second = commands.add_parser("recall")
    second.add_argument("clones", type=Path)
    second.add_argument("table", type=Path)
    for each in (first, second):
        each.add_argument("--list", type=int, default=0, metavar="N", help="print up to N that were not confirmed")
    given = parser.parse_args()
    if given.what == "precision":
        return precision(given.clones, given.packages, given.list)
    return recall(given.clones, given.table, given.list)


if __name__ == "__main__":
    sys.exit(main())
