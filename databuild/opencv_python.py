"""Builds data/uses_opencv.json: the classes of OpenCV of which Python makes no object by calling them.

    python -P -m rosimpact.databuild.opencv_python CV2 --output DATA

CV2 is the folder `cv2` of a wheel of opencv-contrib-python, whose stubs tell of each class: one without `__init__` is
made by its own `create`, or by a function that returns it. OpenCV 2 made such objects by a call of the class; since 3.0
("OpenCV 3.0 transition guide") what that gives has no algorithm behind it, and its methods raise.
"""

from __future__ import annotations

import argparse
import ast
import json
from pathlib import Path

from ..edges.files import write_file
from ..impact.targets.tables import DATA

FILE = "uses_opencv.json"
_SOURCE = "stubs of opencv-contrib-python; OpenCV 3.0 transition guide: functions make algorithms"


def find_makers(stub: str) -> dict[str, str]:
    """Classes that a call does not make, each with the function that does, by the text of a stub."""
    tree = ast.parse(stub)
    returned = {
        node.returns.id: node.name
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and node.name == f"create{_name(node.returns)}"
        and isinstance(node.returns, ast.Name)
    }  # fmt: skip
    found = {}
    for node in tree.body:
        if not isinstance(node, ast.ClassDef):
            continue
        methods = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
        if "__init__" in methods:
            continue
        if node.name in returned:
            found[node.name] = returned[node.name]
        elif "create" in methods:
            found[node.name] = f"{node.name}_create"
    return found


def _name(node: ast.expr | None) -> str:
    return node.id if isinstance(node, ast.Name) else ""


def make_group(makers: dict[str, str]) -> dict:
    """The group of uses, in the form of uses_libraries.json."""
    uses = {
        f"cv2.{name}()": {
            "word": name, "before": "\\bcv2\\.", "arguments": "0+", "help": f"use `cv2.{maker}`", "language": "python",
            "imports": ["cv2"],
        }
        for name, maker in sorted(makers.items())
    }  # fmt: skip
    return {"kind": "call-changed", "package": "opencv", "source": _SOURCE, "library": True, "removed_in": "3.0",
            "uses": uses}  # fmt: skip


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="CV2")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    makers = find_makers((given.folder / "__init__.pyi").read_text(encoding="utf-8"))
    text = json.dumps({"uses": [make_group(makers)]}, indent=1)
    write_file(given.output / FILE, f"{text}\n".encode())
    print(len(makers), "classes")


if __name__ == "__main__":
    main()
