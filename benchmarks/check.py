"""Times `rosimpact check` on a workspace beside its anchors, in one run, and prints ratios.

usage: check.py WORKSPACE [--ros1 WORKSPACE] [--target jazzy] [--repeat 3]

Every figure is the best of the repeats: wall time of a whole process on this machine, imports included, and in brackets
the processor time of it and its children, which other work on the machine changes less. The memory is that of the
largest of these processes.
    cold       no facts are known (an empty cache folder; the distro data is unpacked already)
    warm       nothing has changed since
    previews   no facts are known, and preview rules are asked too: those on the message flow need more facts of code
    again      the same, when nothing has changed since
    header     a comment in a shared header was changed (the one that most packages of the workspace include)
    include    an include was added to that header, so that the packages that have to do with it are judged anew
    macro      a comment in a CMake file that packages give their dependants was changed
    call       a find_package was added to its first macro, so that who calls it is joined and everything judged anew
Anchors: reading the C++ and CMake bytes, parsing them with tree-sitter (if tree_sitter and tree_sitter_cpp are
installed), and catkin_lint on the ROS 1 workspace (if it is installed), which reads CMake and manifests only.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MACRO = re.compile(r"(?im)^(\s*(?:macro|function)\s*\([^)]*\))")
SOURCES = (".cpp", ".hpp", ".h", ".cc", ".c", ".cxx", ".hh", ".cmake", "CMakeLists.txt")


def sources(root: Path) -> list[Path]:
    return [p for p in sorted(root.rglob("*")) if p.name.endswith(SOURCES) and p.is_file()]


def run(command: list[str], environment: dict[str, str]) -> tuple[float, float, int]:
    """Wall seconds of a process, processor seconds of it and its children, and the peak memory in MB of the largest."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    _, status, usage = os.wait4(process.pid, 0)
    took = time.perf_counter() - start
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        raise SystemExit(f"{' '.join(command)} failed with status {os.waitstatus_to_exitcode(status)}")
    return took, usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024


def best(repeat: int, before, command: list[str], environment: dict[str, str]) -> tuple[float, float, int]:
    figures = []
    for _ in range(repeat):
        before()
        figures.append(run(command, environment))
    return min(f[0] for f in figures), min(f[1] for f in figures), max(f[2] for f in figures)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("workspace", type=Path)
    parser.add_argument("--ros1", type=Path)
    parser.add_argument("--target", default="jazzy")
    parser.add_argument("--repeat", type=int, default=3)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        cache, copy = Path(scratch, "cache"), Path(scratch, "ws")
        shutil.copytree(args.workspace, copy, symlinks=True)
        environment = {**os.environ, "ROSIMPACT_CACHE": str(cache)}
        # An installed package is compiled; compiling it anew in every run is not what is measured here.
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        command = [sys.executable, "-m", "rosimpact.impact.cli", "check", str(copy), "--target", args.target, "--quiet"]
        files = sources(copy)
        size = sum(p.stat().st_size for p in files)
        print(
            f"{args.workspace}: {len(files)} C++ and CMake files, {size / 1e6:.1f} MB; target {args.target}; "
            f"{os.cpu_count()} cores; best of {args.repeat}"
        )
        run(command, environment)

        def forget() -> None:
            for path in cache.glob("facts.sqlite*"):
                path.unlink()

        header = most_included(copy)
        macro = next((p for p in sorted(copy.rglob("cmake/*.cmake")) if "Find" not in p.name), None)

        def call() -> None:
            if macro is None:
                return
            text = macro.read_text()
            macro.write_text(MACRO.sub(rf"\1\nfind_package(Of{time.time_ns()})", text, count=1))

        def change(path: Path | None, line: str):
            def touch() -> None:
                if path is not None:
                    with path.open("a") as file:
                        file.write(line.format(time.time_ns()) + "\n")

            return touch

        rows = [
            ("cold", *best(args.repeat, forget, command, environment)),
            ("warm", *best(args.repeat + 2, lambda: None, command, environment)),
        ]
        previews = [*command, "--preview"]
        rows.append(("previews", *best(args.repeat, forget, previews, environment)))
        rows.append(("again", *best(args.repeat + 2, lambda: None, previews, environment)))
        rows.append(("header", *best(args.repeat, change(header, "// {}"), command, environment)))
        rows.append(
            ("include", *best(args.repeat, change(header, "#include <rclcpp/of_{}.hpp>"), command, environment))
        )
        if macro is not None:
            rows.append(("macro", *best(args.repeat, change(macro, "# {}"), command, environment)))
            rows.append(("call", *best(args.repeat, call, command, environment)))
        rows.append(
            (
                "--help",
                *best(args.repeat, lambda: None, [sys.executable, "-m", "rosimpact.impact.cli", "--help"], environment),
            )
        )
        # Last, since a child's peak memory counts what its parent held when it was forked.
        anchors = anchor_figures(files, args.repeat)
        for name, seconds, processor, memory in rows:
            beside = ", ".join(
                f"{seconds / wall:.2f} ({processor / own:.2f}) x {label}" for label, wall, own in anchors
            )
            print(f"  {name:8s} {seconds:6.2f} ({processor:.2f}) s  {memory:4d} MB  {beside}")
        for label, wall, own in anchors:
            print(f"  {label}: {wall:.2f} ({own:.2f}) s")
        if args.ros1:
            lint(args, environment)


def anchor_figures(files: list[Path], repeat: int) -> list[tuple[str, float, float]]:
    """(label, wall seconds, processor seconds) of what cannot be done without: reading the bytes, and a plain parse of
    them."""
    figures = [("reading", *timed(lambda: [p.read_bytes() for p in files], repeat))]
    try:
        import tree_sitter_cpp
        from tree_sitter import Language, Parser
    except ImportError:
        return figures
    parser = Parser(Language(tree_sitter_cpp.language()))
    cpp = [p for p in files if not p.name.endswith((".cmake", ".txt"))]
    figures.append(("tree-sitter parse", *timed(lambda: [parser.parse(p.read_bytes()) for p in cpp], repeat)))
    return figures


def timed(work, repeat: int) -> tuple[float, float]:
    """The least wall seconds and processor seconds of some work."""
    figures = []
    for _ in range(repeat):
        start, own = time.perf_counter(), time.process_time()
        work()
        figures.append((time.perf_counter() - start, time.process_time() - own))
    return min(wall for wall, _ in figures), min(own for _, own in figures)


def most_included(root: Path) -> Path | None:
    """The header below include/ whose name most files of the workspace include."""
    counts: dict[str, int] = {}
    for path in sources(root):
        for line in path.read_bytes().split(b"\n"):
            if line.startswith(b"#include"):
                name = line.rpartition(b"/")[2].strip(b'">\r ').decode("utf-8", "replace")
                counts[name] = counts.get(name, 0) + 1
    headers = {p.name: p for p in root.rglob("include/**/*.h*")}
    known = [name for name in counts if name in headers]
    return headers[max(known, key=lambda name: counts[name])] if known else None


def lint(args, environment: dict[str, str]) -> None:
    """The ROS 1 workspace, by rosimpact and by catkin_lint."""
    command = [sys.executable, "-m", "rosimpact.impact.cli", "check", str(args.ros1), "--target", "noetic", "--quiet"]
    run(command, environment)
    ours, _, _ = best(args.repeat, lambda: None, command, environment)
    print(f"{args.ros1}: rosimpact, warm {ours:.2f} s")
    tool = shutil.which(
        "catkin_lint", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    )
    if tool is None:
        print("  catkin_lint is not installed: pip install catkin_lint")
        return
    theirs, _, _ = best(
        args.repeat, lambda: None, [tool, "--offline", "-W2", str(args.ros1)], {**environment, "ROS_DISTRO": "noetic"}
    )
    print(f"  catkin_lint {theirs:.2f} s; {ours / theirs:.2f} x catkin_lint")


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    main()
