"""What a whole check reported, remembered by everything that it rests on: content, data, settings and our own code.

A second run on unchanged files links nothing, runs no rule and does not even load them. The key is made of content ids
where they are known, and of the state of a file where nothing has read it.
"""

import contextlib
import hashlib
import os
import time

import msgspec

from ...edges.version import __version__
from ..config import Config
from ..facts.store import Store, encode_rows
from ..rules.rule import Finding, load_rules
from ..source_keys import compute_code_stamp
from ..targets.tables import compute_data_stamp, find_updated_folder
from ..tree import WorkingTree
from ..tree.paths import compute_blob_id
from .report import AnalysisCoverage, Checked, Report, ReportedPackage, SourceLines, report_target
from .session import Options, Read, make_reader, select_rules


class _Kept(msgspec.Struct, frozen=True, array_like=True):
    """A report as stored. rules: names of those that could speak. originals: files that fixes change, with the ids of
    their content."""

    findings: tuple[Finding, ...]
    suppressed: tuple[Finding, ...]
    known: tuple[Finding, ...]
    coverage: AnalysisCoverage
    packages: tuple[ReportedPackage, ...]
    rules: tuple[str, ...]
    originals: tuple[tuple[str, str], ...]


def asks_flow(config: Config, store: Store, options: Options) -> bool:
    """Whether some of the rules to run read the message flow; remembered, since telling takes all rules. Raises as
    select_rules() does."""
    if not (options.select or options.ignore or config.select or config.ignore):
        return options.preview  # all rules on the message flow are previews
    asked = (compute_code_stamp(), options.select, options.ignore, options.preview, config.select, config.ignore)
    key = hashlib.sha1(repr(asked).encode("utf-8", "surrogateescape")).digest()
    known = store.find_memo("asks flow", key)
    if known is None:
        known = b"1" if any(rule.reads_flow for rule in select_rules(options, config).values()) else b""
        store.remember("asks flow", [(key, known)])
    return bool(known)


def report_key(read: Read, options: Options) -> bytes | None:
    """The key of a check's report; None where it may rest on more than what is told here: revisions, installed files,
    files outside of the workspace that its settings name, and files that were written just now."""
    tree, config = read.tree, read.config
    outside = (config.underlays, config.repos, config.rosdep_sources, config.index, options.install, options.base)
    if any(outside) or not isinstance(tree, WorkingTree):
        return None
    asked = (options.select, options.ignore, options.preview, options.follow_links, options.baseline)
    targets = [(chosen.target.compute_identity(), chosen.target.name, chosen.reason) for chosen in read.targets]
    found = hashlib.sha1()

    def add(*parts: object) -> None:
        found.update(repr(parts).encode("utf-8", "backslashreplace"))

    add(compute_code_stamp(), compute_data_stamp(), _list_updated_data(), asked, config, read.ros, targets, tree.root)
    if options.select or config.select:
        from ..values.harness.toolchain import find_clang

        add(find_clang())  # without which rules over values see no C++
    add(tree.problems, tree.skipped, tree.aliases, tree.repositories, read.extraction.problems)
    add(read.discovered.packages, read.discovered.ignored, read.discovered.problems)
    ids = read.extraction.ids
    kinds = read.extraction.kinds
    for entry in tree.list_entries():
        content = ids.get(entry.path)
        state = content or tree.find_state(entry.path)
        if state is None:
            return None
        add(entry.path, kinds.get(entry.path), state)
    return found.digest()


def _list_updated_data() -> list[tuple[str, int, int]]:
    """The state of the data that a user has updated."""
    with contextlib.suppress(OSError), os.scandir(find_updated_folder()) as entries:
        return sorted((entry.name, (status := entry.stat()).st_size, status.st_mtime_ns) for entry in entries)
    return []


def load_report(path: str | os.PathLike[str], read: Read, key: bytes, started: float) -> Checked | None:
    """The check of an earlier run that rests on the same; None when there is none. key: a report_key(). started: when
    the work began, by time.perf_counter()."""
    data = read.store.find_memo("report", key)
    if data is None:
        return None
    try:
        kept = msgspec.msgpack.decode(data, type=_Kept)
        originals = {file: read.tree.read(file) for file, _ in kept.originals}
    except (msgspec.MsgspecError, UnicodeDecodeError, OSError):
        return None
    if any(compute_blob_id(originals[file]) != content for file, content in kept.originals):
        return None  # it has just been written to
    notes, targets = read.store.notes, read.targets
    report = Report(
        version=__version__,
        data=targets[0].target.data_date if targets else "",
        targets=tuple(report_target(chosen, notes if i == 0 else ()) for i, chosen in enumerate(targets)),
        findings=kept.findings,
        coverage=kept.coverage,
        packages=kept.packages,
        suppressed=kept.suppressed,
        known=kept.known,
        rules=lambda: [load_rules()[name] for name in kept.rules],
        seconds=time.perf_counter() - started,
        excerpt=SourceLines(make_reader(read.tree)).read_excerpt,
        root=os.fspath(path),
    )
    return Checked(report, read.config, read.tree, originals)


def store_report(read: Read, key: bytes, checked: Checked) -> None:
    """Keeps a report for later runs. key: the report_key() of what it was made from."""
    report = checked.report
    kept = _Kept(
        tuple(report.findings),
        tuple(report.suppressed),
        tuple(report.known),
        report.coverage,
        report.packages,
        tuple(rule.name for rule in report.rules()),
        tuple((file, compute_blob_id(data)) for file, data in checked.originals.items()),
    )
    read.store.remember("report", encode_rows([(key, kept)]))
