"""A node of ROS 1 as it is started by hand: `rosrun package executable arguments...`."""

from __future__ import annotations

from collections.abc import Iterable

from rosimpact.impact.model.launch.result import Launched, LaunchParameter, Remap, ShareLine, Started
from rosimpact.impact.model.launch.text import wrap

_HERE = ShareLine("", "the command line", 0)


def rosrun(package: str, executable: str, arguments: Iterable[str] = ()) -> Launched:
    """The launch that one command is. arguments: those of the program, with `from:=to`, `_parameter:=value`,
    `__name:=name` and `__ns:=namespace` among them, which the program does not see."""
    name, namespace = "", "/"
    remaps: list[Remap] = []
    private: list[LaunchParameter] = []
    words: list[str] = []
    for argument in arguments:
        old, assigns, new = argument.partition(":=")
        if not assigns:
            words.append(argument)
        elif old == "__name":
            name = new
        elif old == "__ns":
            namespace = f"/{new.strip('/')}"
        elif old.startswith("_") and not old.startswith("__"):
            private.append(LaunchParameter(old[1:], wrap(new), _HERE))
        elif not old.startswith("__"):
            remaps.append(Remap(wrap(old), wrap(new), _HERE))
    started = Started(
        "node", 1, _HERE, (), package=wrap(package), executable=wrap(executable), name=wrap(name),
        namespace=wrap(namespace), remaps=tuple(remaps), settings=tuple(private), arguments=tuple(map(wrap, words)),
    )  # fmt: skip
    full = f"{namespace.rstrip('/')}/{name or executable}"
    server = {f"{full}/{setting.name}": setting._replace(name=f"{full}/{setting.name}") for setting in private}
    return Launched((started,), server, ())
