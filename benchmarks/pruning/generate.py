"""Generates the code of messages with ROS 1's own generators, and runs nodes in Python; the Python of ROS runs this.

usage: generate.py messages CPP_FOLDER PYTHON_FOLDER PACKAGE=FOLDER ...
       generate.py run SCRIPT ...
"""

import runpy
import sys
from pathlib import Path


def generate_messages(cpp: Path, python: Path, packages: "dict[str, Path]") -> None:
    """The headers and modules of packages, by their folders with messages."""
    import genmsg.template_tools
    import genpy.generator
    from genpy.generate_initpy import write_modules

    path = {name: [str(folder)] for name, folder in packages.items()}
    path["std_msgs"] = ["/usr/share/std_msgs/msg"]
    flags = [f"-I{name}:{folder}" for name, folders in path.items() for folder in folders]
    generator = genpy.generator.MsgGenerator()
    for name, folder in packages.items():
        files = sorted(map(str, folder.glob("*.msg")))
        for file in files:
            out = cpp / name
            out.mkdir(parents=True, exist_ok=True)
            genmsg.template_tools.generate_from_command_line_options(
                ["gen_cpp.py", file, "-p", name, "-o", str(out), "-e", "/usr/share/gencpp", *flags],
                {"msg.h.template": "@NAME@.h"}, {},
            )  # fmt: skip
        out = python / name / "msg"
        out.mkdir(parents=True, exist_ok=True)
        if generator.generate_messages(name, files, str(out), path):
            raise SystemExit(f"{name}: genpy fails")
        write_modules(str(out))
        (python / name / "__init__.py").write_text("")


def run_nodes(scripts: "list[str]") -> None:
    """Runs scripts one after another in this process."""
    import rospy  # that of the folder `facade`

    for script in scripts:
        sys.path.insert(0, str(Path(script).parent))
        sys.argv = [script]
        runpy.run_path(script, run_name="__main__")
    rospy.report_sizes()


if __name__ == "__main__":
    if sys.argv[1] == "messages":
        pairs = (each.partition("=") for each in sys.argv[4:])
        generate_messages(Path(sys.argv[2]), Path(sys.argv[3]), {name: Path(folder) for name, _, folder in pairs})
    else:
        run_nodes(sys.argv[2:])
