"""What a node is called that a launch starts."""

from rosimpact.impact.model.flow.names import join_name
from rosimpact.impact.model.launch.text import LaunchText, resolve, wrap


def full_name(started):
    """Namespace and name together; unknown where either is, or where the name is left to the program."""
    if started.name.value == "":
        shown = join_name(started.namespace.shown or "/", "<its own>")
        return LaunchText(None, shown, ("the name is left to the program",))
    full = resolve(started.namespace if started.namespace.value != "" else wrap("/"), started.name)
    if full.value is not None and full.value[:1] != "/":
        return LaunchText(None, full.shown, (f"`{full.value}` is no name of a node",))
    return full
