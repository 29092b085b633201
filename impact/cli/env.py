"""rosimpact env."""

from pathlib import Path

from ...edges.console import run_command, say
from ...edges.version import __version__
from .output import answers, check_output, deliver, style_of


def env_capture(output: Path | None) -> int:
    """Writes this machine as a target."""

    def work() -> int:
        from ..targets.capture import capture, to_json

        check_output(output, "")
        machine = capture()
        deliver(to_json(machine), output, "json")
        if not machine.distro:
            say("rosimpact: no ROS distro was found here; set `distro` in the file before you use it as a target")
        if output is not None:
            say(f"rosimpact: {output}: written; use it with --target {output}")
        return 0

    return run_command(work, "interrupted; nothing was written", "this machine")


@answers("text", "json")
def env_diff(first: str, second: str, path: Path | None, format: str, output: Path | None) -> str:
    """What differs between two targets; beside a workspace, what matters to it."""
    from ..analysis.machine_compare import machines
    from ..report import machines as report

    found = machines(first, second, path)
    return report.as_json(found, __version__) if format == "json" else report.text(found, style_of(output))
