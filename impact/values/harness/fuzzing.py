"""libFuzzer as a fast front end for crashes: what it finds becomes witnesses, which replays confirm.

It runs, like replays, in a process of its own with limits, without network where the system allows that.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import NamedTuple

from ....edges.files import read_text
from ..outcomes import Reaction, Witness
from ..sandbox import find_isolation
from .compile import CannotCompile
from .replay import Replayed, replay, run_limited
from .session import PreparedCallback

_ROUNDS = 8
_WITNESS_BYTES = 10_000_000


class FuzzedCrash(NamedTuple):
    """A crash that a fuzzer found and a replay showed again."""

    witness: Witness
    replayed: Replayed


def run_fuzzer(callback: PreparedCallback, seconds: float, entry: str = "") -> list[FuzzedCrash]:
    """Fuzzes a callback for some time; gives a crash for each kind and line. Raises CannotCompile."""
    if callback.workshop is None or not callback.units:
        raise CannotCompile(callback.reason or "there is no harness")
    program = callback.workshop.build_fuzzer(callback.units)
    native = callback.workshop.build_replay(callback.units)
    entry = entry or callback.entry
    found: dict[tuple[object, ...], FuzzedCrash] = {}
    with tempfile.TemporaryDirectory(prefix="rosimpact-fuzz-") as name:
        folder = Path(name)
        for turn in range(_ROUNDS):
            values = _run_once(program, folder, seconds / _ROUNDS if found else seconds, turn, entry)
            if values is None:
                break
            for shown in replay(native, entry, [values], callback.workshop.root):
                if shown.result is Reaction.CRASH:
                    witness = Witness(values, Reaction.CRASH, shown.crash, shown.place)
                    found.setdefault((shown.crash, shown.place), FuzzedCrash(witness, shown))
    return list(found.values())


def _run_once(program: Path, folder: Path, seconds: float, turn: int, entry: str) -> dict[str, int] | None:
    """One run up to a crash: the inputs that led to it, None where there was none."""
    whole = max(1, round(seconds))
    corpus = folder / "corpus"
    corpus.mkdir(exist_ok=True)
    prefix = f"{folder}/crash{turn}-"
    command = [
        *find_isolation(), str(program), f"-max_total_time={whole}", f"-artifact_prefix={prefix}", "-timeout=2",
        "-rss_limit_mb=1500", "-detect_leaks=0", f"-seed={turn + 1}", "-max_len=4096", "-len_control=0", str(corpus),
    ]  # fmt: skip
    run_limited(command, folder, whole + 10, {"RI_ENTRY": entry})
    for path in sorted(folder.glob(f"crash{turn}-*")):
        if "oom-" in path.name:
            continue
        record = folder / f"witness{turn}"
        run_limited([str(program), str(path)], folder, 10, {"RI_ENTRY": entry, "RI_WITNESS": str(record)})
        try:
            text = read_text(record, _WITNESS_BYTES, "replace")
        except OSError:
            continue
        rows = (line.rpartition("=") for line in text.splitlines() if "=" in line)
        return {key: int(bits) for key, _, bits in rows if bits.isdigit()}
    return None
