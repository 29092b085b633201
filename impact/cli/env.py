"""rosimpact env."""

from pathlib import Path

from ...edges.console import run_command, say
from ...edges.version import __version__
from .output import check_output, deliver, find_style, make_command


def env_capture(output: Path | None) -> int:
    """Writes this machine as a target."""

    def capture_machine() -> int:
        from ..targets.capture import capture, dump_capture

        check_output(output, "")
        machine = capture()
        deliver(dump_capture(machine), output, "json")
        if not machine.distro:
            say("rosimpact: no ROS distro was found here; set `distro` in the file before you use it as a target")
        if output is not None:
            say(f"rosimpact: {output}: written; use it with --target {output}")
        return 0

    return run_command(capture_machine, "interrupted; nothing was written", "this machine")


@make_command("text", "json")
def env_diff(first: str, second: str, path: Path | None, format: str, output: Path | None) -> str:
    """What differs between two targets; beside a workspace, what matters to it."""
    from ..analysis.machine_compare import compare_machines
    from ..report import machines as report

    found = compare_machines(first, second, path)
    return report.render_json(found, __version__) if format == "json" else report.render_text(found, find_style(output))
