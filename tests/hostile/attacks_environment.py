"""Streams that are closed or full, encodings, interrupts, limits, names of paths, and the search path of modules."""

from __future__ import annotations

import signal

from .attacks_output import folder_of_bytes, folders
from .harness import BEGUN, COMMANDS, ENTRY, FORMATS, NEEDS_GIT, STATUS, Attack, Ended, Place, write

GROUP = "environment"
CHECK = COMMANDS["check"]
ENCODINGS = {
    "LANG=C": ({"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, "utf-8"),
    "ascii": ({"PYTHONIOENCODING": "ascii"}, "ascii"),
    "latin-1": ({"PYTHONIOENCODING": "latin-1"}, "latin-1"),
    "ascii, strict": ({"PYTHONIOENCODING": "ascii:strict", "LANG": "C"}, "ascii"),
    "cp1252": ({"PYTHONIOENCODING": "cp1252"}, "cp1252"),
    "utf-16": ({"PYTHONIOENCODING": "utf-16-le"}, "utf-16-le"),
}
MODULES = (
    "typer",
    "msgspec",
    "yaml",
    "click",
    "rich",
    "json",
    "re",
    "rosimpact",
    "sqlite3",
    "pygit2",
    "numpy",
    "sitecustomize",
    "usercustomize",
)


def shadows(folder: str):
    def make(place: Place) -> None:
        code = f"open({str(place.marker)!r}, 'w').close()\nraise SystemExit(7)\n"
        write(place.ws, {f"{folder}{name}.py": code for name in MODULES})
        write(
            place.ws,
            {
                f"{folder}pyvenv.cfg": "home = /nowhere\n",
                f"{folder}rosimpact/__init__.py": code,
                f"{folder}.pth": f"import os; os.system('touch {place.marker}')\n",
            },
        )

    return make


def programs(place: Place) -> None:
    for name in (
        "git",
        "dpkg",
        "dpkg-query",
        "cmake",
        "python3",
        "python",
        "docker",
        "catkin",
        "lsb_release",
        "xacro",
        "ros2",
        "sh",
    ):
        path = place.ws / name
        path.write_text(f"#!/bin/sh\ntouch {place.marker}\n")
        path.chmod(0o755)


def payloads(place: Place) -> None:
    """Every file that some tool would execute."""
    touch = f"touch {place.marker}"
    python = f"import os\nos.system({touch!r})\n"
    write(
        place.ws,
        {
            "src/bad/setup.py": python,
            "src/bad/conftest.py": python,
            "src/bad/bad/__init__.py": python,
            "src/bad/launch/a.launch.py": python,
            "src/bad/CMakeLists.txt": f'project(bad)\nexecute_process(COMMAND sh -c "{touch}")\n',
            "src/bad/setup.sh": touch + "\n",
            "src/bad/config/a.yaml": f"!!python/object/apply:os.system ['{touch}']\n",
            "colcon.meta": f"!!python/object/apply:os.system ['{touch}']\n",
            "defaults.yaml": f"build: !!python/object/apply:os.system ['{touch}']\n",
            "src/bad/urdf/a.urdf.xacro": f"<robot xmlns:xacro='x'><a b=\"${{__import__('os').system('{touch}')"
            f'}}"/></robot>',
            "src/bad/launch/a.launch": f"<launch><arg name='a' value=\"$(eval __import__('os').system('{touch}'))"
            f'"/></launch>',
            "src/bad/launch/b.launch.xml": f"<launch><let name='a' value=\"$(command '{touch}')\"/><executable "
            f"cmd='{touch}'/></launch>",
            "src/bad/msg/Bad.msg": f"int32 A=__import__('os').system('{touch}')\n",
            "install/setup.bash": touch + "\n",
            "devel/_setup_util.py": python,
        },
    )


def rows() -> list[Attack]:
    found: list[Attack] = []
    for command, formats in FORMATS.items():
        for format in formats:
            arguments = (*COMMANDS[command], "-f", format)
            git = command in NEEDS_GIT
            found.append(
                Attack(
                    f"{command} {format}: /dev/full",
                    GROUP,
                    {},
                    arguments,
                    (2,),
                    found="",
                    git=git,
                    stdout="/dev/full",
                    after=short,
                )
            )
    for command in COMMANDS:
        git = command in NEEDS_GIT
        found += [
            Attack(
                f"{command}: stdout closed",
                GROUP,
                {},
                COMMANDS[command],
                (0, 1, 2),
                found="",
                git=git,
                stdout="closed",
                direct=True,
                after=short,
            ),
            Attack(
                f"{command}: nobody reads",
                GROUP,
                {},
                COMMANDS[command],
                (0, 1, 2, -13, 141),
                found="",
                git=git,
                stdout="broken",
                direct=True,
                after=short,
            ),
            Attack(
                f"{command}: stderr closed",
                GROUP,
                {},
                COMMANDS[command],
                (STATUS[command],),
                git=git,
                stderr="closed",
                direct=True,
            ),
            Attack(
                f"{command}: stderr full",
                GROUP,
                {},
                COMMANDS[command],
                (STATUS[command],),
                git=git,
                stderr="/dev/full",
                direct=True,
            ),
        ]
    for name, (environment, encoding) in ENCODINGS.items():
        for command, format in (
            ("check", "text"),
            ("check", "json"),
            ("check", "markdown"),
            ("graph", "text"),
            ("why", "text"),
            ("check", "html"),
        ):
            if name == "utf-16" and format in ("json", "html"):
                continue  # read as UTF-8 here
            found.append(
                Attack(
                    f"{command} {format}: names of all kinds, {name}",
                    GROUP,
                    folders() | folder_of_bytes(),
                    (*COMMANDS[command], "-f", format),
                    (STATUS[command],),
                    found="" if command == "why" or format == "markdown" else None,  # ten lines hold not all
                    environment=environment,
                    encoding=encoding,
                    direct=True,
                    snapshot=False,
                )
            )
        found.append(
            Attack(
                f"error with names of all kinds, {name}",
                GROUP,
                {},
                ("check", "{ws}/caf\u00e9\u4e2d\U0001f600"),
                (2,),
                found="",
                environment=environment,
                encoding=encoding,
                direct=True,
            )
        )
        if encoding != "utf-16-le":  # which the errors would be in, and the file not
            found.append(
                Attack(
                    f"output to a file, {name}",
                    GROUP,
                    folders() | folder_of_bytes(),
                    (*CHECK, "-o", "{out}/r.txt"),
                    (1,),
                    environment=environment,
                    encoding="utf-8",
                    direct=True,
                    snapshot=False,
                )
            )
    for seconds in (0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.5):
        found.append(
            Attack(
                f"interrupt after {seconds} s",
                GROUP,
                {},
                CHECK,
                (0, 1, 130, -2),
                found="",
                signal=(int(signal.SIGINT), seconds, "group", "{home}/begun"),
                program=("{python}", "-c", BEGUN),
                after=short,
            )
        )
    for seconds in (0.05, 0.2, 0.5):
        found.append(
            Attack(
                f"logic: interrupt after {seconds} s",
                GROUP,
                {},
                COMMANDS["logic"],
                (0, 130, -2),
                found="",
                git=True,
                signal=(int(signal.SIGINT), seconds, "group"),
                after=short,
            )
        )
        found.append(
            Attack(
                f"check of many files: interrupt after {seconds} s",
                GROUP,
                {f"src/bad/src/f{n}.cpp": "#include <a.h>\nint f();\n" * 200 for n in range(300)},
                (*CHECK, "-j", "2"),
                (1, 130, -2),
                found="",
                signal=(int(signal.SIGINT), seconds, "group"),
                after=short,
                snapshot=False,
            )
        )
        found.append(
            Attack(
                f"check: terminated after {seconds} s",
                GROUP,
                {},
                CHECK,
                (0, 1, 130, 143, -15),
                found="",
                signal=(int(signal.SIGTERM), seconds, "group"),
                after=short,
            )
        )
    for megabytes in (60, 100, 150, 200, 300, 400):
        found.append(
            Attack(
                f"{megabytes} MB of address space",
                GROUP,
                {},
                CHECK,
                (0, 1, 2, -9),
                found="",
                limits={"RLIMIT_AS": megabytes * 1_000_000},
                after=short,
            )
        )
    found.append(
        Attack(
            "300 MB of address space, a large file",
            GROUP,
            {"src/bad/src/a.cpp": "int a = f(1);\n" * 400_000},
            CHECK,
            (0, 1, 2),
            limits={"RLIMIT_AS": 300_000_000},
            after=short,
            found="",
        )
    )
    for files in (5, 8, 10, 12, 16, 24):
        found.append(
            Attack(
                f"{files} open files",
                GROUP,
                {},
                CHECK,
                (0, 1, 2),
                found="",
                limits={"RLIMIT_NOFILE": files},
                after=short,
            )
        )
        found.append(
            Attack(
                f"logic: {files} open files",
                GROUP,
                {},
                COMMANDS["logic"],
                (0, 1, 2),
                found="",
                git=True,
                limits={"RLIMIT_NOFILE": files},
                after=short,
            )
        )
    found.append(
        Attack(
            "no further process",
            GROUP,
            {f"src/bad/src/f{n}.cpp": "#include <a.h>\n" * 100 for n in range(300)},
            (*CHECK, "-j", "4"),
            (1,),
            limits={"RLIMIT_CPU": 60},
            snapshot=False,
        )
    )
    paths = {
        "~nobody": "~nobody/ws",
        "~unknown": "~nosuchuser/ws",
        "a null byte": "a\\x00b",
        "5,000 letters": "x" * 5_000,
        "5,000 folders": "x/" * 5_000,
        "empty": "",
        "-": "-",
        "a folder of a process": "/proc/self/cwd",
        "a folder of descriptors": "/proc/self/fd",
        "/dev": "/dev/fd/0",
        "bytes": "caf\udce9",
        "a dot dot": "{ws}/../../../../../../nowhere",
    }
    for name, path in paths.items():
        found.append(
            Attack(
                f"check of {name}",
                GROUP,
                {},
                ("check", path, "-t", "jazzy"),
                (0, 1, 2),
                found="",
                cwd="{home}",
                after=short,
                direct=name == "bytes",
            )
        )
        for option in ("--output", "--baseline", "--config", "--install"):
            found.append(
                Attack(
                    f"{option} of {name}",
                    GROUP,
                    {},
                    (*CHECK, option, path),
                    (0, 1, 2),
                    found="",
                    cwd="{out}",
                    after=short,
                    direct=name == "bytes",
                )
            )
    texts = {
        "a year over 9999": "humble@10000-01-01",
        "a year of 5,000 digits": "humble@" + "9" * 5_000,
        "month 13": "humble@2024-13-01",
        "day 0": "humble@2024-01-00",
        "a target of ~nobody": "~nobody/x.json",
        "digits of another script": "humble@\u0662\u0660\u0662\u0664-\u0660\u0661-\u0660\u0661",
        "a target of docker": "docker:" + "a/" * 3_000,
        "5,000 @": "humble" + "@" * 5_000,
        "a null byte": "humble\\x00",
    }
    for name, text in texts.items():
        for command in (
            ("check", "{ws}", "-t", text),
            ("upgrade", "{ws}", "--from", text, "--to", "jazzy"),
            ("why", "OpenCV", "{ws}", "-t", text),
        ):
            found.append(Attack(f"{command[0]}: {name}", GROUP, {}, command, (0, 1, 2), found="", after=short))
    numbers = {
        "dates in rosimpact.toml": "[targets.a]\ndistro = 'humble'\ndate = 9999-12-31\n",
        "a long number in rosimpact.toml": "[check]\nfail_on = " + "9" * 5_000 + "\n",
        "a year over 9999 in rosimpact.toml": "[targets.a]\ndistro = 'humble'\ndate = '10000-01-01'\n",
        "not a number in rosimpact.toml": "[check]\nfail_on = nan\n",
        "a date as a distro": "[targets.a]\ndistro = 2024-01-01\n",
        "a null byte as a file": '[targets.a]\nfile = "a\\u0000b"\n',
        "~nobody as a file": "[targets.a]\nfile = '~nobody/x.json'\n",
        "a null byte as an underlay": '[workspace]\nunderlays = ["a\\u0000b"]\n',
        "~nosuchuser as an underlay": "[workspace]\nunderlays = ['~nosuchuser/x']\n",
        "a null byte as repos": '[workspace]\nrepos = ["a\\u0000b"]\n',
        "a null byte as sources": '[workspace]\nrosdep_sources = ["a\\u0000b"]\n',
        "a null byte as index": '[workspace]\nindex = "a\\u0000b"\n',
    }
    for name, text in numbers.items():
        found.append(
            Attack(name, GROUP, {"rosimpact.toml": text}, ("check", "{ws}", "-q"), (0, 1, 2), found="", after=short)
        )
    deep = {
        "integers of 5,000 digits in a msg": (
            "src/bad/msg/Bad.msg",
            "int32 A=" + "9" * 5_000 + "\nint32[" + "9" * 5_000 + "] b\nfloat64 C=1e99999\n",
        ),
        "integers of 5,000 digits in CMake": (
            "src/bad/CMakeLists.txt",
            "project(bad VERSION "
            + "9" * 5_000
            + ")\nfind_package(OpenCV "
            + "9" * 5_000
            + ")\nmath(EXPR A "
            + "9" * 5_000
            + ")\n",
        ),
        "integers of 5,000 digits in a manifest": (
            "src/bad/package.xml",
            "<package format='"
            + "9" * 5_000
            + "'><name>bad</name><version>"
            + "9" * 5_000
            + ".0.0</version></package>",
        ),
        "integers of 5,000 digits in Python": (
            "src/bad/scripts/n.py",
            "import rclpy\nx = int('"
            + "9" * 5_000
            + "')\ny = "
            + "9" * 5_000
            + "\nn.create_publisher(M, f'{y}', "
            + "9" * 5_000
            + ")\n",
        ),
        "integers of 5,000 digits in C++": (
            "src/bad/src/n.cpp",
            "#if X > "
            + "9" * 5_000
            + '\n#endif\nvoid f(ros::NodeHandle n) { n.advertise<std_msgs::Int32>("a", '
            + "9" * 5_000
            + "); }\n",
        ),
        "integers of 5,000 digits in launch": (
            "src/bad/launch/a.launch.py",
            "from launch_ros.actions import Node\ndef generate_launch_description():\n"
            "    return Node(package='bad', executable=str(" + "9" * 5_000 + "))\n",
        ),
        "integers of 5,000 digits in YAML": (
            "src/bad/config/a.yaml",
            "a: " + "9" * 5_000 + "\nb: 99999-01-01\nc: 2024-13-45\nd: 0x" + "f" * 5_000 + "\n",
        ),
        "dates of YAML in defaults.yaml": (
            "defaults.yaml",
            "build:\n  packages-skip: [2024-13-45, 99999-01-01, 0000-00-00 25:61:61]\n",
        ),
    }
    for name, (path, text) in deep.items():
        found.append(Attack(name, GROUP, {path: text}, CHECK, (1,)))
        found.append(Attack(f"graph: {name}", GROUP, {path: text}, COMMANDS["graph"], (0,)))
    found += [
        Attack(
            "modules of the folder: the installed command",
            GROUP,
            shadows(""),
            CHECK,
            (1,),
            program=("{python}", "-I", "-c", ENTRY),
        ),
        Attack("modules of the folder: the script", GROUP, shadows(""), CHECK, (1,), program=("{script}",)),
        Attack(
            "modules of a package: the script",
            GROUP,
            shadows("src/bad/"),
            CHECK,
            (1,),
            program=("{script}",),
            cwd="{ws}/src/bad",
        ),
        Attack("modules of the folder: graph", GROUP, shadows(""), COMMANDS["graph"], (0,), program=("{script}",)),
        Attack("modules of the folder: upgrade", GROUP, shadows(""), COMMANDS["upgrade"], (1,), program=("{script}",)),
        Attack(
            "modules of the folder: logic", GROUP, shadows(""), COMMANDS["logic"], (0,), program=("{script}",), git=True
        ),
        Attack(
            "modules of the folder: triage",
            GROUP,
            shadows(""),
            ("triage", "it fails"),
            (0, 1),
            program=("{script}",),
            found="",
            seconds=8,
        ),
        Attack(
            "modules of the folder: many files",
            GROUP,
            many_and_shadows,
            (*CHECK, "-j", "2"),
            (1,),
            program=("{script}",),
            snapshot=False,
        ),
        Attack("programs of the folder", GROUP, programs, CHECK, (1,), git=True),
        Attack(
            "programs of the folder: base", GROUP, programs, (*CHECK, "--base", "HEAD~1"), (0, 1), git=True, found=""
        ),
        Attack("programs of the folder: logic", GROUP, programs, COMMANDS["logic"], (0,), git=True),
        Attack("env capture in a folder of programs", GROUP, programs, ("env", "capture"), (0, 2), found=""),
        Attack("everything that could be executed", GROUP, payloads, (*CHECK, "--notes", "--preview"), (1,)),
        Attack("everything that could be executed: graph", GROUP, payloads, COMMANDS["graph"], (0,)),
        Attack("everything that could be executed: upgrade", GROUP, payloads, COMMANDS["upgrade"], (1,)),
        Attack(
            "everything that could be executed: the launch file",
            GROUP,
            payloads,
            (*COMMANDS["graph"], "--launch", "b.launch.xml"),
            (0, 2),
            found="",
        ),
        Attack(
            "everything that could be executed: install space",
            GROUP,
            payloads,
            (*CHECK, "--install", "{ws}/install"),  # it holds no library
            (2,),
            found="",
        ),
        Attack(
            "limits that cannot be read",
            GROUP,
            {},
            CHECK,
            (2,),
            found="",
            environment={"ROSIMPACT_LIMITS": "cpp=many"},
            words=("ROSIMPACT_LIMITS",),
        ),
        Attack(
            "limits of a workspace have no effect",
            GROUP,
            {"rosimpact.toml": "[limits]\ncpp = 1\n"},
            CHECK,
            (1, 2),
            found="",
            after=short,
        ),
        Attack("HOME unset", GROUP, {}, CHECK, (1,), environment={"HOME": "UNSET"}),
        Attack(
            "TERM hostile",
            GROUP,
            {},
            CHECK,
            (1,),
            environment={"TERM": "\x1b[2J", "COLUMNS": "99999999999", "LINES": "-1"},
            direct=True,
        ),
        Attack(
            "COLUMNS of nothing",
            GROUP,
            {},
            CHECK,
            (1,),
            environment={"COLUMNS": "0", "FORCE_COLOR": "1"},
            colours=True,
            direct=True,
        ),
        Attack("TMPDIR of nowhere", GROUP, {}, CHECK, (1,), environment={"TMPDIR": "/nowhere"}),
        Attack(
            "the folder is gone",
            GROUP,
            {},
            ("check", ".", "-t", "jazzy"),
            (0, 1, 2),
            found="",
            program=("/bin/sh", "-c", 'mkdir x && cd x && rmdir ../x && exec {script} "$@"', "sh"),
            snapshot=False,
            after=short,
        ),
        Attack(
            "a folder with a name of bytes",
            GROUP,
            {"caf\udce9/src/x/package.xml": "x"},
            ("check", "{ws}", "-t", "jazzy"),
            (1,),
            direct=True,
        ),
    ]
    return found


def many_and_shadows(place: Place) -> None:
    shadows("")(place)
    write(place.ws, {f"src/bad/src/f{n}.cpp": "#include <a.h>\nint f();\n" * 100 for n in range(300)})


def short(place: Place, ended: Ended) -> list[str]:
    """What fails is said in a line or two."""
    lines = [line for line in ended.err.decode("utf-8", "replace").splitlines() if line.strip()]
    return [f"{len(lines)} lines on standard error"] if ended.status == 2 and len(lines) > 6 else []
