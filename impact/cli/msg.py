"""rosimpact msg."""

import os
from pathlib import Path

from ...edges.console import UserError, escape, format_count, format_json
from ...edges.files import read_file
from ...edges.limits import get_limits
from .output import Answer, make_command, say_notes

_RULE = "=" * 80


@make_command("text", "json", about="file", folders=("text",))
def msg_light(file: Path, *, folders, keep, name, format, output) -> Answer:
    """A lighter definition, and those of its nested messages; each a file in the folder asked for."""
    from ..analysis.message_files import MessageFolders, locate_package
    from ..prune.light import lighten

    if file.suffix != ".msg":
        raise UserError(f"{escape(str(file))}: is no .msg file; only messages can be made lighter")
    package, home = locate_package(file)
    own = read_file(file, get_limits().interface)
    origin = f"{package}/{file.stem}"
    known = MessageFolders(folders or (home.parent if package else home,), os.environ)
    beside = {
        other.stem: read_file(other, get_limits().interface)
        for folder in {file.parent, *((output,) if output is not None and format == "text" else ())}
        for other in sorted(folder.glob("*.msg"))
        if not other.samefile(file)
    }

    def find_definition(full_name: str) -> bytes | None:
        if full_name == origin:
            return own
        if full_name.rpartition("/")[0] == package and (text := beside.get(full_name.rpartition("/")[2])) is not None:
            return text
        return known.find(full_name)

    made = lighten(find_definition, origin, keep, name, beside)
    files = {f"{each}.msg": one.text.decode("utf-8", "surrogateescape") for each, one in made.items()}
    if format == "json":
        return format_json([
            {"name": each, "file": f"{each}.msg", "origin": one.origin.lstrip("/"), "fields": list(one.fields),
             "dropped": list(one.dropped), "text": one.text.decode("utf-8", "replace")}
            for each, one in made.items()
        ])  # fmt: skip
    say_notes(_describe(made, package))
    if output is not None:
        return files
    first, *others = files.items()
    # As bags and `gendeps --cat` write a definition with those that it needs.
    return _end_line(first[1]) + "".join(
        f"{_RULE}\nMSG: {package or '?'}/{each.removesuffix('.msg')}\n{_end_line(text)}" for each, text in others
    )


def _end_line(text: str) -> str:
    return text if text.endswith("\n") else text + "\n"


def _describe(made, package: str):
    for each, one in made.items():
        origin = one.origin.lstrip("/")
        yield f"{each}.msg: {origin} without {', '.join(one.dropped) or 'nothing'}"
        if origin in ("std_msgs/Header", "roslib/Header"):
            yield f"{each}.msg: is no std_msgs/Header, which tf2 and tools look for; keep all of it for these"
    if len(made) > 1:
        count = format_count(len(made), "file")
        yield f"{count}, all for the msg folder of {package or 'one package'}; add them to its CMakeLists.txt"
