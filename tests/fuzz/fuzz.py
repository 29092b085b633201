"""Fuzzes rosimpact's readers with libFuzzer: `python tests/fuzz/fuzz.py TARGET [-runs=N]` or `--all --runs N`.

A run goes on after a fault, which is kept in the work folder, shortened, beside others of the same place in the code.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import hashlib
import json
import os
import random
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

SECONDS, SECONDS_PER_KB = 0.5, 0.3
"""Processor time that one input may take, with the instrumented code, which is several times slower than the plain."""
LONGEST = 6000
TIMEOUT = 30


def main() -> int:
    options, rest = arguments()
    work = Path(options.work)
    if options.all:
        return fuzz_all(work, options)
    if options.list:
        from fuzz_targets import TARGETS

        print("\n".join(f"{name:22} {target.promise}" for name, target in TARGETS.items()))
        return 0
    if options.pump:
        return pump(options.target, options.only)
    if options.try_file:
        return try_file(options.target, Path(options.try_file))
    return fuzz(options.target, work, [f"-runs={options.runs}", *rest], options.plain)


def arguments() -> tuple[argparse.Namespace, list[str]]:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog="Options of libFuzzer, such as -seed=1, are passed on."
    )
    parser.add_argument("target", nargs="?", help="what to fuzz; --list says what there is")
    parser.add_argument("--list", action="store_true", help="list the targets and what each promises")
    parser.add_argument("--all", action="store_true", help="fuzz one target after the other")
    parser.add_argument("--only", default="", help="with --all: names of targets, separated by commas")
    parser.add_argument("--runs", "-runs", type=int, default=10_000, help="inputs for each target (%(default)s)")
    parser.add_argument("--seconds", type=int, default=600, help="with --all: time for each target (%(default)s)")
    parser.add_argument(
        "--work", default=os.path.join(tempfile.gettempdir(), "rosimpact-fuzz"), help="folder for what is found"
    )
    parser.add_argument("--plain", action="store_true", help="without coverage: faster, and blind")
    parser.add_argument(
        "--pump", action="store_true", help="repeat each word of the language: what takes more than linear time?"
    )
    parser.add_argument("--try-file", help="give the target one file and show what happens, and how long that takes")
    options, rest = parser.parse_known_args()
    if not (options.all or options.list or options.target or options.pump):
        parser.error("name a target, or give --all or --list")
    return options, rest


def fuzz_all(work: Path, options: argparse.Namespace) -> int:
    """Every target in a process of its own, forked once all is imported, and begun again where it ends too early."""
    targets, _ = imported(options.plain)
    names = [name for name in options.only.split(",") if name] or list(targets)
    work.mkdir(parents=True, exist_ok=True)
    gc.freeze()
    for name in names:
        left, until = options.runs, time.monotonic() + options.seconds
        while left > 0 and time.monotonic() < until:
            row = _one(name, work, left, max(1, int(until - time.monotonic())), options.plain)
            with (work / "log.jsonl").open("a") as rows:
                rows.write(json.dumps(row) + "\n")
            faults = len(row["faults"])
            print(
                f"{name}: {row['runs']} inputs, {row['seconds']} s, {faults} faults, status {row['status']}", flush=True
            )
            left -= max(row["runs"], 1)
            if row["status"] == 0 or not row["runs"]:
                break
    return 0


def _one(name: str, work: Path, runs: int, seconds: int, plain: bool) -> dict[str, Any]:
    """Fuzzes a target in a forked process; what became of it."""
    state = work / "state" / f"{name}.json"
    state.unlink(missing_ok=True)
    log = work / "logs" / f"{name}.log"
    log.parent.mkdir(exist_ok=True)
    started = time.monotonic()
    child = os.fork()
    if not child:
        with log.open("ab") as output:
            os.dup2(output.fileno(), 1)
            os.dup2(output.fileno(), 2)
        try:
            seed = random.SystemRandom().randrange(1, 1 << 31)
            fuzz(name, work, [f"-runs={runs}", f"-max_total_time={seconds}", f"-seed={seed}"], plain)
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            raise
        finally:
            os._exit(1)  # libFuzzer ends the process itself
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    found = json.loads(state.read_bytes()) if state.exists() else {"runs": 0, "faults": {}}
    return {"target": name, "status": status, "seconds": round(time.monotonic() - started, 1), **found}


def imported(plain: bool) -> tuple[Any, Any]:
    """(the targets, the words), with rosimpact's code instrumented so that libFuzzer sees what an input reaches."""
    import atheris

    with contextlib.nullcontext() if plain else _quiet(atheris.instrument_imports(include=["rosimpact"])):
        from fuzz_targets import TARGETS, WORDS
    return TARGETS, WORDS


def pump(name: str | None, only: str) -> int:
    """Gives every target, or one, each word of its language many times over, alone, behind the beginning of a seed, and
    joined with other words; names what takes far more time for four times as much. Returns 1 when something does."""
    from fuzz_targets import TARGETS, WORDS

    found = 0
    for each in [name] if name else [one for one in only.split(",") if one] or list(TARGETS):
        target = TARGETS[each]
        words = [word.encode("utf-8", "surrogatepass") for word in WORDS[target.language] if len(word) < 1000]
        seed = next(iter(target.seeds().values()), b"")[:300]
        chance = random.Random(each)
        units = [*words, b"a", b" ", b"1", *(chance.choice(words) + chance.choice(words) for _ in words)]
        for unit in dict.fromkeys(units):
            for start in (b"", seed, chance.choice(words)):
                if (times := _growth(target.check, start, unit)) is not None:
                    found = 1
                    print(
                        f"{each}: {start[-20:]!r} + n * {unit!r}: {', '.join(f'{one:.2f}' for one in times)} s",
                        flush=True,
                    )
                    break
    return found


def _growth(check: Callable[[bytes], None], start: bytes, unit: bytes) -> list[float] | None:
    """Seconds for 10 and 40 KB of a unit where the time grows much faster than the input; else None."""
    times = []
    for size in (10_000, 40_000):
        data = start + unit * (size // len(unit))
        begun = time.thread_time()
        with contextlib.suppress(Exception):
            check(data)
        times.append(time.thread_time() - begun)
        if times[-1] < (0.02, 0.2)[len(times) - 1]:
            return None
    return times if times[1] > 8 * times[0] else None


def try_file(name: str, path: Path) -> int:
    from fuzz_targets import TARGETS

    data = path.read_bytes()
    started = time.thread_time()
    try:
        TARGETS[name].check(data)
    finally:
        print(f"{len(data)} bytes, {time.thread_time() - started:.3f} s")
    return 0


def fuzz(name: str, work: Path, options: list[str], plain: bool) -> int:
    """One target in this process, which ends with libFuzzer's own exit."""
    import atheris

    targets, words = imported(plain)
    target = targets[name]
    seeds, corpus, crashes = (work / part / name for part in ("seeds", "corpus", "crashes"))
    for folder in (seeds, corpus, crashes, work / "state"):
        folder.mkdir(parents=True, exist_ok=True)
    for seed, data in target.seeds().items():
        (seeds / seed.replace("/", "-")).write_bytes(data)
        with contextlib.suppress(Exception):  # what is imported or built on first use is no fault of an input
            target.check(data)
    # A process that is ended by a signal or a time limit leaves its input there.
    options = [
        sys.argv[0], f"-max_len={LONGEST}", f"-timeout={TIMEOUT}", "-rss_limit_mb=1500", "-len_control=0",
        f"-artifact_prefix={crashes}/", "-print_final_stats=1", *options, str(corpus), str(seeds),
    ]  # fmt: skip
    recorder = Recorder(name, target.check, work)
    donors = [*target.seeds().values(), *(path.read_bytes() for path in sorted(corpus.iterdir()))]
    mutator = Mutator([word.encode("utf-8", "surrogatepass") for word in words[target.language]], donors, plain)
    atheris.Setup(options, recorder.take, custom_mutator=mutator.mutate)
    gc.freeze()
    atheris.Fuzz()
    return 0


@contextlib.contextmanager
def _quiet(hooks: Any):
    """Instrumented imports, without a line for each module."""
    kept = sys.stderr
    with open(os.devnull, "w") as nowhere, hooks:
        sys.stderr = nowhere
        try:
            yield
        finally:
            sys.stderr = kept


class Recorder:
    """Gives inputs to a target, and keeps the shortest for each fault, with its text beside it."""

    def __init__(self, name: str, check: Callable[[bytes], None], work: Path):
        self.name, self.check = name, check
        self.folder = work / "faults" / name
        self.state = work / "state" / f"{name}.json"
        self.runs = 0
        self.faults: dict[str, int] = {}
        self.shortest: dict[str, int] = {}
        self.slowest = (0.0, 0)
        self.written = time.monotonic()

    def take(self, data: bytes) -> None:
        self.runs += 1
        signature, seconds = self.judge(data)
        allowed = SECONDS + SECONDS_PER_KB * len(data) / 1024
        if not signature and seconds > allowed:
            again = self.judge(data)[1]
            if again > allowed:
                signature = "slow"
        if seconds > self.slowest[0]:
            self.slowest = (seconds, len(data))
            if seconds > 0.05:
                self.keep("slowest", data, f"{seconds:.3f} s for {len(data)} bytes")
        if signature:
            self.faults[signature] = self.faults.get(signature, 0) + 1
            if len(data) < self.shortest.get(signature, 1 << 30):
                self.shortest[signature] = len(data)
                self.keep(
                    signature, data, self.text if signature != "slow" else f"{seconds:.3f} s for {len(data)} bytes"
                )
        if self.runs % 100 == 0 or time.monotonic() - self.written > 2 or signature:
            self.save()

    def save(self) -> None:
        self.written = time.monotonic()
        found = {"runs": self.runs, "faults": self.faults, "slowest": self.slowest}
        self.state.write_text(json.dumps(found))

    def judge(self, data: bytes) -> tuple[str, float]:
        """(what is wrong, empty when nothing is; seconds of processor time)."""
        started = time.thread_time()
        try:
            self.check(data)
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            seconds = time.thread_time() - started
            self.text = "".join(traceback.format_exception(error))[-4000:]
            return signature_of(error), seconds
        return "", time.thread_time() - started

    def keep(self, signature: str, data: bytes, text: str) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        stem = hashlib.sha1(signature.encode()).hexdigest()[:10] if signature not in ("slow", "slowest") else signature
        (self.folder / f"{stem}.input").write_bytes(data)
        (self.folder / f"{stem}.txt").write_text(f"{signature}\n{text}", errors="backslashreplace")


def signature_of(error: BaseException) -> str:
    """What makes faults alike: the kind of exception and the innermost places of our own that it passed."""
    if type(error).__name__ == "Violated":
        return f"Violated: {error}"[:160]
    places = [
        f"{os.path.basename(frame.filename)}:{frame.name}"
        for frame in traceback.extract_tb(error.__traceback__)
        if "site-packages" not in frame.filename and "/lib/python" not in frame.filename
    ]
    return f"{type(error).__name__} in {' < '.join(reversed(places[-2:]))}"


class Mutator:
    """Mutations that keep to a language: words put in, lines and pieces repeated, moved, nested; and single bytes."""

    def __init__(self, words: list[bytes], donors: list[bytes], plain: bool):
        """plain: nothing tells libFuzzer what is worth keeping, so that every input begins with a donor."""
        self.words, self.donors, self.plain = words, donors, plain

    def mutate(self, data: bytes, max_size: int, seed: int) -> bytes:
        chance = random.Random(seed)
        data = chance.choice(self.donors) if self.plain else data
        for _ in range(chance.choice((1, 1, 1, 2, 4))):
            data = self.once(bytes(data), chance)
        return data[:max_size]

    def once(self, data: bytes, chance: random.Random) -> bytes:
        way = chance.randrange(12)
        at = chance.randrange(len(data) + 1)
        end = min(len(data), at + chance.choice((1, 2, 5, 12, 40, 200)))
        if way < 2:
            flipped = data[at] ^ (1 << chance.randrange(8)) if at < len(data) else 0
            new = chance.choice(
                (bytes([flipped]), bytes([chance.randrange(256)]), b"\0" * 4, b"\xff" * chance.choice((1, 2, 4, 8)))
            )
            return data[:at] + new + data[at + len(new) * chance.randrange(2) :]
        if way == 2:  # a number, as bytes or as digits
            size = chance.choice((1, 2, 4, 8))
            number = chance.choice((0, 1, 2, 16, 127, 128, 255, 1 << 15, 1 << 31, (1 << 63) - 1)) & (
                (1 << 8 * size) - 1
            )
            new = number.to_bytes(size, "little") if chance.random() < 0.5 else b"%d" % number
            return data[:at] + new + data[at + len(new) :]
        if way < 6:
            return data[:at] + chance.choice(self.words) + data[at if chance.random() < 0.7 else end :]
        if way == 6:  # a piece of a seed
            donor = chance.choice(self.donors)
            start = chance.randrange(len(donor) + 1)
            return data[:at] + donor[start : start + chance.choice((8, 30, 120))] + data[end:]
        if way == 7:  # without a piece
            return data[:at] + data[end:]
        if way == 8:  # a piece again and again
            return data[:end] + data[at:end] * chance.choice((1, 1, 2, 3, 8, 60)) + data[end:]
        if way == 9:  # a word again and again, as nesting does
            return data[:at] + chance.choice(self.words) * chance.choice((2, 2, 3, 10, 100)) + data[at:]
        lines = data.split(b"\n")
        first, second = chance.randrange(len(lines)), chance.randrange(len(lines))
        if way == 10:
            lines.insert(second, lines[first])
        else:
            lines[first], lines[second] = lines[second], lines[first]
        return b"\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
