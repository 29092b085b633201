"""Names that speak to CI systems, terminals, Markdown, pages and drawings, in every command and format."""

from __future__ import annotations

import json
from collections.abc import Callable
from xml.sax.saxutils import escape, quoteattr

import pygit2

from .harness import COMMANDS, FORMATS, NEEDS_GIT, NODE, STATUS, Attack, Place, cmake, manifest, write
from .kinds import KINDS

GROUP = "output"

# Each holds `evil`, by which it is known again.
SPEECH = {
    "workflow command": "::error file=evil::evil",
    "mask": "::add-mask::evil",
    "stop": "::stop-commands::evil",
    "spaces and command": "  ::error::evil",
    "wide space and command": "\u3000::error::evil",
    "group": "##[group]evil",
    "azure": "##vso[task.setvariable variable=evil]evil",
    "teamcity": "##teamcity[evil]",
    "line feed": "evil\n::error::evil",
    "carriage return": "evil\r::error::evil",
    "escape": "evil\x1b[2J\x1b]0;evil\x07",
    "C1": "evil\x9b31m\x85::error::evil",
    "direction": "evil\u202egnp\u2066\u2069\u200f",
    "line separator": "evil\u2028::error::evil\u2029",
    "link": "[evil](https://evil.example/x)",
    "image": "![evil](https://evil.example/i.png)",
    "mention": "@evil-team hello",
    "backticks": "`evil` @evil `` <img src=x> ```evil",
    "markup": "<img src=x onerror=evil()>",
    "script": "</script><script>evil()</script>",
    "comment": "--><img src=evil><!--]]>",
    "table": "evil | evil | <b>evil",
    "dot": 'evil"]; evil [URL="https://evil.example/"',
    "backslash": 'evil\\"; evil\\',
    "mermaid": 'evil"]\nclick evil "https://evil.example/"',
    "attribute": 'evil" onmouseover="evil()',
    "bytes": "evil\udcff\udcfe",
    "percent": "evil%0A::error::evil,file=evil",
}
BYTES = SPEECH["bytes"]
TEXTS = {name: text for name, text in SPEECH.items() if name != "bytes"}  # a text of XML or TOML is Unicode
NAMES = {name: text for name, text in TEXTS.items() if "/" not in text}  # a folder's name holds no slash


def xml_text(text: str) -> str:
    """XML 1.0 cannot say control characters at all."""
    return escape("".join(letter for letter in text if letter in "\n\r\t" or ord(letter) >= 32).replace("\r", "&#13;"))


def xml_value(text: str) -> str:
    plain = "".join(letter for letter in text if letter in "\n\r\t" or ord(letter) >= 32)
    return quoteattr(plain, {"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


def quoted(text: str) -> str:
    """A literal of C++, CMake (but for its own escapes), Python, TOML and JSON."""
    return json.dumps(text, ensure_ascii=False).replace("\\u000", "\\u000")


def cpp_literal(text: str) -> str:
    return '"' + "".join(_cpp(letter) for letter in text) + '"'


def _cpp(letter: str) -> str:
    if letter in '"\\':
        return "\\" + letter
    return {"\n": "\\n", "\r": "\\r", "\x1b": "\\033", "\x07": "\\007"}.get(letter, letter)


def cmake_literal(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "\\r") + '"'


def each(texts: dict[str, str], make: Callable[[int, str], dict[str, str | bytes]]) -> dict[str, str | bytes]:
    found: dict[str, str | bytes] = {}
    for number, text in enumerate(texts.values()):
        found |= make(number, text)
    return found


def a_package(name: str, number: int, more: str = "", *depends: str) -> dict[str, str | bytes]:
    return {
        f"src/{name}/package.xml": manifest(f"p{number}", *depends),
        f"src/{name}/CMakeLists.txt": cmake(f"p{number}", more),
    }


OLD = (
    "find_package(OpenCV 8 REQUIRED)\nadd_executable(n src/n.cpp)\ntarget_link_libraries(n x)\ninstall(TARGETS "
    "n DESTINATION lib/x)"
)


def node(number: int, name: str = "", topic: str = "") -> str:
    text = NODE.format(Class=f"N{number}", node="NAME", topic="TOPIC", bound=3)
    text = text.replace('"NAME"', cpp_literal(name or f"n{number}"))
    return text.replace('"TOPIC"', cpp_literal(topic or f"t{number}"))


def folders() -> dict[str, str | bytes]:
    return each(NAMES, lambda n, text: {**a_package(text, n, OLD, "rclcpp"), f"src/{text}/src/n.cpp": node(n)})


def folder_of_bytes() -> dict[str, str | bytes]:
    return {**a_package(BYTES, 0, OLD, "rclcpp"), f"src/{BYTES}/src/n.cpp": node(0)}


def files_of_bytes() -> dict[str, str | bytes]:
    found: dict[str, str | bytes] = {
        f"src/bad/src/{BYTES}.cpp": node(0),
        f"src/bad/include/{BYTES}/a.hpp": "int a();\n",
    }
    found |= {f"src/bad/{folder}/{BYTES}.{folder}": "int32\n" for folder in ("msg", "srv", "action")}
    found |= {f"src/bad/launch/{BYTES}.launch.{kind}": "(" for kind in ("py", "xml", "yaml")}
    found["src/bad/CMakeLists.txt"] = cmake("bad", f"add_executable(n src/{BYTES}.cpp)\nadd_subdirectory({BYTES})")
    return found


def package_names() -> dict[str, str | bytes]:
    return each(
        TEXTS,
        lambda n, text: {
            f"src/p{n}/package.xml": manifest(xml_text(text), "libopencv-dev"),
            f"src/p{n}/CMakeLists.txt": cmake("x", OLD),
            f"src/p{n}/src/n.cpp": node(n),
        },
    )


def dependencies() -> dict[str, str | bytes]:
    return {"src/bad/package.xml": manifest("bad", *map(xml_text, TEXTS.values()))}


def manifests() -> dict[str, str | bytes]:
    """All the other texts of a manifest."""
    return each(
        TEXTS,
        lambda n, text: {
            f"src/p{n}/package.xml": f"<package format='3'><name>p{n}</name><version>{xml_text(text)}</version>"
            f"<description>{xml_text(text)}</description><maintainer email={xml_value(text)}>{xml_text(text)}<"
            f"/maintainer>"
            f"<license>{xml_text(text)}</license><depend condition={xml_value(text)} "
            f"version_gte={xml_value(text)}>rclcpp</depend>"
            f"<export><build_type>{xml_text(text)}</build_type><{'x'} y={xml_value(text)}/></export></package>",
        },
    )


def malformed() -> dict[str, str | bytes]:
    """Errors of parsers quote what they did not understand."""
    return each(
        TEXTS,
        lambda n, text: {
            f"src/p{n}/package.xml": manifest(f"p{n}"),
            f"src/p{n}/setup.cfg": f"[metadata\n{text}\n= x\n",
            f"src/p{n}/pyproject.toml": f"[{text}\n",
            f"src/p{n}/colcon.pkg": f"{{a: [{text}",
            f"src/p{n}/msg/M.msg": f"{text}\n",
            f"src/p{n}/setup.py": f"def {text}(:\n",
            f"src/p{n}/launch/a.launch.xml": f"<launch><{text}></launch>",
            f"src/p{n}/CMakeLists.txt": f"project(p{n})\n{text}(\n{text}\n",
            f"src/p{n}/config/a.yaml": f"{text}: [\n&{text} *{text}\n",
        },
    )


def cmake_names() -> dict[str, str | bytes]:
    more = "".join(
        f"find_package({cmake_literal(text)} REQUIRED)\nfind_package(OpenCV {cmake_literal(text)} REQUIRED)\n"
        f"add_library({cmake_literal(text)} {cmake_literal(text)}.cpp)\n"
        f"target_link_libraries({cmake_literal(text)} {cmake_literal(text)}::x)\n"
        f"include({cmake_literal(text)})\nadd_subdirectory({cmake_literal(text)})\n"
        for text in TEXTS.values()
    )
    return {"src/bad/CMakeLists.txt": cmake("bad", more)}


def quoted_lines() -> dict[str, str | bytes]:
    """What is quoted of a file stands beside what is found in it."""
    lines = "".join(f"find_package(OpenCV 8 REQUIRED)  #{text}\n" for text in TEXTS.values() if "\n" not in text)
    return {"src/bad/CMakeLists.txt": cmake("bad", lines + "find_package(OpenCV 8 REQUIRED) #\x1b[2Jevil\n")}


def file_names() -> dict[str, str | bytes]:
    beside = next(kind.beside for kind in KINDS if kind.name == "cpp")
    found: dict[str, str | bytes] = {**beside}
    for text in NAMES.values():
        name = f"src/bad/src/{text[:40]}.cpp"
        found[name] = "#include <tf2_geometry_msgs/tf2_geometry_msgs.h>\n"
    sources = "".join(cmake_literal(text[:40]).replace('"', '"src/', 1)[:-1] + '.cpp" ' for text in NAMES.values())
    found["src/bad/CMakeLists.txt"] = str(found["src/bad/CMakeLists.txt"]).replace(
        "src/node.cpp", f"src/node.cpp {sources}"
    )
    found["src/bad/src/node.cpp"] = "int main() {}\n"
    for text in NAMES.values():
        found[f"src/bad/msg/{text[:40]}.msg"] = "int32\n"
        found[f"src/bad/launch/{text[:40]}.launch.py"] = "def (:\n"
    return found


def topics() -> dict[str, str | bytes]:
    sources = " ".join(f"src/n{n}.cpp" for n in range(len(SPEECH)))
    more = "find_package(rclcpp REQUIRED)\nfind_package(std_msgs REQUIRED)\n" + "".join(
        f"add_executable(n{n} src/n{n}.cpp)\nament_target_dependencies(n{n} rclcpp std_msgs)\n"
        for n in range(len(SPEECH))
    )
    found: dict[str, str | bytes] = {
        "src/bad/package.xml": manifest("bad", "rclcpp", "std_msgs"),
        "src/bad/CMakeLists.txt": cmake("bad", more + f"# {sources}"),
    }
    return found | each(SPEECH, lambda n, text: {f"src/bad/src/n{n}.cpp": node(n, text, text)})


def guards() -> dict[str, str | bytes]:
    """Conditions and timers that are quoted."""
    return {
        **topics(),
        **each(
            TEXTS,
            lambda n, text: {
                f"src/bad/src/n{n}.cpp": node(n).replace("count_ > 3", f"count_ > 3 && name_ != {cpp_literal(text)}"),
            },
        ),
    }


def python_topics() -> dict[str, str | bytes]:
    found: dict[str, str | bytes] = {"src/bad/package.xml": manifest("bad", "rclpy", "std_msgs")}
    for n, text in enumerate(TEXTS.values()):
        found[f"src/bad/scripts/n{n}.py"] = (
            "import rclpy\nfrom rclpy.node import Node\nfrom std_msgs.msg import Int32\n\n\nclass N(Node):\n"
            f"    def __init__(self):\n        super().__init__({text!r})\n        self.p = "
            f"self.create_publisher(Int32, {text!r}, 1)\n"
            f"        self.declare_parameter({text!r}, {text!r})\n\n    def f(self, a):\n        if a == "
            f"{text!r}:\n            self.p.publish(Int32())\n"
        )
    return found


def messages() -> dict[str, str | bytes]:
    kind = next(kind for kind in KINDS if kind.name == "msg")
    fields = "".join(f"{text} {text}\nint32 {text}\nstring s{n} {text!r}\n" for n, text in enumerate(TEXTS.values()))
    return {**kind.beside, "src/bad/msg/Bad.msg": fields}


def launches() -> dict[str, str | bytes]:
    inner = "".join(
        f"<arg name={xml_value(text)} default={xml_value(text)} description={xml_value(text)}/>"
        f"<node pkg='healthy' exec='healthy_node' name={xml_value(text)} namespace={xml_value(text)}>"
        f"<remap from={xml_value(text)} to={xml_value(text)}/><param name={xml_value(text)} "
        f"value={xml_value(text)}/></node>"
        f"<node pkg={xml_value(text)} exec={xml_value(text)}/><include file={xml_value(text)}/>"
        for text in TEXTS.values()
    )
    return {"src/bad/launch/a.launch.xml": f"<launch><node pkg='healthy' exec='healthy_node'/>{inner}</launch>"}


def launch_pythons() -> dict[str, str | bytes]:
    inner = ",".join(
        f"DeclareLaunchArgument({text!r}, default_value={text!r}), Node(package='healthy', "
        f"executable='healthy_node', name={text!r}, "
        f"namespace={text!r}, remappings=[({text!r}, {text!r})]), Node(package={text!r}, executable={text!r})"
        for text in TEXTS.values()
    )
    head = (
        "from launch import LaunchDescription\nfrom launch.actions import DeclareLaunchArgument\n"
        "from launch_ros.actions import Node\n"
    )
    return {
        "src/bad/launch/a.launch.py": head + "def generate_launch_description():\n    return LaunchDescription(["
        f"Node(package='healthy', executable='healthy_node'), {inner}])\n"
    }


def includes() -> dict[str, str | bytes]:
    beside = next(kind.beside for kind in KINDS if kind.name == "cpp")
    lines = "".join(
        f'#include <{text}>\n#include "{text}"\n#include <tf2_geometry_msgs/tf2_geometry_msgs.h> // {text}\n'
        for text in TEXTS.values()
    )
    return {**beside, "src/bad/src/node.cpp": lines}


def imports() -> dict[str, str | bytes]:
    lines = "".join(
        f"from launch_ros.actions import x{n}  # {text}\n"
        for n, text in enumerate(TEXTS.values())
        if "\n" not in text and "\r" not in text
    )
    return {"src/bad/scripts/n.py": lines}


def submodules() -> dict[str, str | bytes]:
    return {
        ".gitmodules": "".join(
            f"[submodule {quoted(text)}]\n\tpath = {quoted(text)}\n\turl = {quoted(text)}\n" for text in TEXTS.values()
        )
    }


def settings() -> dict[str, str | bytes]:
    """Targets by the names of rosimpact.toml."""
    targets = "".join(
        f"[targets.{quoted(text)}]\ndistro = 'jazzy'\n".replace("\x7f", "")
        .replace("\x9b", "\\u009b")
        .replace("\x85", "\\u0085")
        for text in TEXTS.values()
    )
    return {
        "rosimpact.toml": targets + f"[workspace]\nprivate = [{', '.join(quoted(text) for text in TEXTS.values())}]\n"
    }


def colcon_settings() -> dict[str, str | bytes]:
    names = ", ".join(quoted(text) for text in TEXTS.values())
    return {
        "defaults.yaml": f"build:\n  packages-skip: [{names}]\n  metas: [{names}]\n  base-paths: ['.', {names}]\n",
        "colcon.meta": "names:\n"
        + "".join(
            f"  {quoted(text)}: {{dependencies: [{quoted(text)}], type: {quoted(text)}}}\n" for text in TEXTS.values()
        ),
    }


def suppressions() -> dict[str, str | bytes]:
    lines = "".join(f"set(A b)  # rosimpact: ignore[{text}]\n" for text in TEXTS.values() if "\n" not in text)
    return {"src/bad/CMakeLists.txt": cmake("bad", lines)}


PLACES: dict[str, Callable[[], dict[str, str | bytes]]] = {
    "folders": folders,
    "package names": package_names,
    "dependencies": dependencies,
    "texts of manifests": manifests,
    "malformed files": malformed,
    "CMake names": cmake_names,
    "quoted lines": quoted_lines,
    "file names": file_names,
    "topics and nodes": topics,
    "conditions": guards,
    "topics in Python": python_topics,
    "message fields": messages,
    "launch files": launches,
    "launch files in Python": launch_pythons,
    "includes": includes,
    "imports": imports,
    "submodules": submodules,
    "targets of rosimpact.toml": settings,
    "settings of colcon": colcon_settings,
    "suppressions": suppressions,
    "folder of bytes": folder_of_bytes,
    "files of bytes": files_of_bytes,
}
FITTING = {
    "graph": (
        "folders",
        "package names",
        "file names",
        "folder of bytes",
        "files of bytes",
        "topics and nodes",
        "conditions",
        "topics in Python",
        "message fields",
        "launch files",
        "launch files in Python",
        "malformed files",
    ),
    "impact": (
        "folders",
        "package names",
        "file names",
        "folder of bytes",
        "files of bytes",
        "topics and nodes",
        "conditions",
        "topics in Python",
        "message fields",
        "launch files",
        "malformed files",
    ),
    "logic": (
        "folders",
        "topics and nodes",
        "conditions",
        "topics in Python",
        "file names",
        "folder of bytes",
        "files of bytes",
        "package names",
    ),
    "upgrade": (
        "folders",
        "package names",
        "dependencies",
        "texts of manifests",
        "malformed files",
        "CMake names",
        "file names",
        "folder of bytes",
        "files of bytes",
        "quoted lines",
        "submodules",
    ),
    "why": (
        "folders",
        "package names",
        "file names",
        "folder of bytes",
        "files of bytes",
        "CMake names",
        "malformed files",
        "quoted lines",
    ),
    "env": (
        "folders",
        "package names",
        "dependencies",
        "file names",
        "folder of bytes",
        "files of bytes",
        "malformed files",
        "quoted lines",
    ),
}


def rows() -> list[Attack]:
    found: list[Attack] = []
    for command, formats in FORMATS.items():
        for format in formats:
            for place in FITTING.get(command, PLACES):
                found.append(row(command, format, place))
    for command, format in (("check", "text"), ("check", "markdown"), ("graph", "html"), ("upgrade", "text")):
        found.append(
            Attack(
                f"{command} {format}: bundle of all in a file",
                GROUP,
                everywhere(NAMES),
                (*COMMANDS[command], "-f", format, "-o", "{out}/report"),
                (STATUS[command],),
                found="" if format == "markdown" else None,
                snapshot=False,
            )
        )
    found.append(
        Attack(
            "check: folders, coloured",
            GROUP,
            folders(),
            COMMANDS["check"],
            environment={"FORCE_COLOR": "1", "CLICOLOR_FORCE": "1"},
            colours=True,
        )
    )
    found.append(Attack("installed command: folders", GROUP, folders(), COMMANDS["check"], direct=True))
    found.append(
        Attack("check --diff: file names", GROUP, file_names(), (*COMMANDS["check"], "--diff"), (0, 1, 2), found="")
    )
    found.append(
        Attack("check --diff: quoted lines", GROUP, fixable(), (*COMMANDS["check"], "--diff"), (0, 1, 2), found="")
    )
    found.append(Attack("check with progress: folders", GROUP, folders(), ("check", "{ws}", "-t", "jazzy")))
    found.append(
        Attack("upgrade --packages: folders", GROUP, folders(), (*COMMANDS["upgrade"], "--packages", "healthy"))
    )
    found += arguments() + toml_errors() + git_names() + others()
    return found


def row(command: str, format: str, place: str) -> Attack:
    arguments = (*COMMANDS[command], "-f", format)
    if command == "check":
        arguments += ("--notes", "--preview")
    if place == "targets of rosimpact.toml":
        arguments = ("check", "{ws}", "-q", "--notes", "-f", format)
    if command == "graph" and "launch" in place:
        arguments += ("--launch", "a.launch.py" if "Python" in place else "a.launch.xml")
    files = PLACES[place]()
    make = in_git(files) if command in NEEDS_GIT else files
    return Attack(
        f"{command} {format}: {place}",
        GROUP,
        make,
        arguments,
        (STATUS[command],),
        git=command in NEEDS_GIT,
        # `why` and Markdown list the first alone.
        found="" if command in ("impact", "why") or format == "markdown" or "--launch" in arguments else None,
        snapshot=False,
        refusable="rosimpact.toml" if "toml" in place else "",
    )


def in_git(files: dict[str, str | bytes]) -> Callable[[Place], None]:
    """Committed in two states, of which the second publishes under other conditions."""

    def make(place: Place) -> None:
        before = {
            name: text.replace("count_ > 3", "count_ > 9").replace("if a ==", "if a !=")
            if isinstance(text, str)
            else text
            for name, text in files.items()
        }
        write(place.ws, before)
        committed(place, "::error::evil\n\n@evil", 1_700_000_200)
        write(place.ws, files)
        committed(place, "evil \x1b[2J ##[group] <img src=x onerror=evil()>", 1_700_000_300)

    return make


def committed(place: Place, message: str, time: int) -> None:
    """With git's own command where pygit2 does not take the names."""
    import os
    import subprocess

    environment = {
        **os.environ,
        "GIT_AUTHOR_NAME": "@evil ::error::",
        "GIT_AUTHOR_EMAIL": "evil@evil.example",
        "GIT_COMMITTER_NAME": "evil",
        "GIT_COMMITTER_EMAIL": "evil",
        "GIT_AUTHOR_DATE": f"{time} +0000",
        "GIT_COMMITTER_DATE": f"{time} +0000",
        "HOME": str(place.home),
        "GIT_CONFIG_NOSYSTEM": "1",
    }
    for command in (["add", "-A"], ["commit", "-q", "--allow-empty", "-m", message]):
        subprocess.run(
            ["git", "-c", "core.quotepath=off", *command],
            cwd=place.ws,
            env=environment,
            check=True,
            capture_output=True,
        )


def everywhere(names: dict[str, str]) -> dict[str, str | bytes]:
    return {**folders(), **dependencies(), **quoted_lines()} if names else {}


def fixable() -> dict[str, str | bytes]:
    beside = next(kind.beside for kind in KINDS if kind.name == "cpp")
    lines = "".join(
        f"// {text}\n#include <tf2_geometry_msgs/tf2_geometry_msgs.h>\n// {text}\n" for text in TEXTS.values()
    )
    return {**beside, "src/bad/src/node.cpp": lines}


# -- what is asked for is quoted in errors -----------------------------------------------------------------------------

ERRORS = (
    "workflow command",
    "wide space and command",
    "line feed",
    "carriage return",
    "escape",
    "C1",
    "direction",
    "group",
)
OPTIONS: dict[str, tuple[str, ...]] = {
    "check --target": ("check", "{ws}", "-q", "-t", "TEXT"),
    "check --rev": (*COMMANDS["check"], "--rev", "TEXT"),
    "check --base": (*COMMANDS["check"], "--base", "TEXT"),
    "check --base of a path": (*COMMANDS["check"], "--base", "TEXT=main"),
    "check --select": (*COMMANDS["check"], "--select", "TEXT"),
    "check --format": (*COMMANDS["check"], "--format", "TEXT"),
    "check --fail-on": (*COMMANDS["check"], "--fail-on", "TEXT"),
    "check --baseline": (*COMMANDS["check"], "--baseline", "{ws}/TEXT"),
    "check --config": (*COMMANDS["check"], "--config", "TEXT"),
    "check --install": (*COMMANDS["check"], "--install", "TEXT"),
    "check --output": (*COMMANDS["check"], "--output", "{out}/nowhere/TEXT/x"),
    "check of a path": ("check", "{ws}/TEXT", "-t", "jazzy"),
    "graph --launch": (*COMMANDS["graph"], "--launch", "TEXT"),
    "graph --set": (*COMMANDS["graph"], "--launch", "healthy.launch.py", "--set", "TEXT"),
    "graph --node": (*COMMANDS["graph"], "--node", "TEXT"),
    "graph --around": (*COMMANDS["graph"], "--around", "TEXT"),
    "graph --rev": (*COMMANDS["graph"], "--rev", "TEXT"),
    "graph --format": (*COMMANDS["graph"], "--format", "TEXT"),
    "impact --base": ("impact", "{ws}", "--base", "TEXT"),
    "impact --package": (*COMMANDS["impact"], "--package", "TEXT"),
    "upgrade --from": ("upgrade", "{ws}", "--from", "TEXT", "--to", "jazzy"),
    "upgrade --to": ("upgrade", "{ws}", "--from", "jazzy", "--to", "TEXT"),
    "upgrade --packages": (*COMMANDS["upgrade"], "--packages", "TEXT"),
    "logic --range": (*COMMANDS["logic"], "--range", "TEXT"),
    "logic --since": (*COMMANDS["logic"], "--since", "TEXT"),
    "logic of a path": ("logic", "{ws}/TEXT"),
    "why": ("why", "TEXT", "{ws}", "-t", "jazzy"),
    "why --target": ("why", "OpenCV", "{ws}", "-t", "TEXT"),
    "env diff": ("env", "diff", "TEXT", "jazzy"),
    "surface show": ("surface", "show", "TEXT"),
    "surface show of a version": ("surface", "show", "rclcpp@TEXT"),
    "surface diff": ("surface", "diff", "rclcpp", "TEXT", "jazzy"),
    "explain": ("explain", "TEXT"),
    "triage of a text": ("triage", "TEXT"),
    "triage --model": ("triage", "it fails", "--model", "TEXT"),
    "corpus stats --labels": ("corpus", "stats", "--labels", "TEXT"),
    "corpus status --store": ("corpus", "status", "--store", "{ws}/TEXT"),
    "an unknown command": ("TEXT",),
    "an unknown option": ("check", "--TEXT"),
    "an unknown value of -j": ("check", "-j", "TEXT"),
}


def arguments() -> list[Attack]:
    """All hostile texts that an argument can hold, one after another as one argument: any of them may show."""
    found = []
    for name, command in OPTIONS.items():
        for label, chosen in (
            ("commands", ("workflow command", "group", "wide space and command")),
            ("controls", ("line feed", "carriage return", "escape", "C1", "direction")),
        ):
            text = "".join(SPEECH[each] for each in chosen)
            found.append(
                Attack(
                    f"{name}: {label}",
                    GROUP,
                    {},
                    tuple(part.replace("TEXT", text) for part in command),
                    (0, 1, 2),
                    found="",
                    git="impact" in name or "logic" in name or "rev" in name or "base" in name,
                )
            )
    return found


# -- errors of rosimpact.toml quote its values -------------------------------------------------------------------------


def toml_errors() -> list[Attack]:
    values = {
        "unknown table": "[TEXT]\na = 1\n",
        "unknown key": "[check]\nTEXT = 1\n",
        "fail_on": "[check]\nfail_on = TEXT\n",
        "rule": "[check]\nselect = [TEXT]\n",
        "rule to ignore": "[check]\nignore = [TEXT]\n",
        "severity": "[check]\nseverity = {removed-header = TEXT}\n",
        "severity of": "[check]\nseverity = {TEXT = 'off'}\n",
        "target asked for": "[check]\ntargets = [TEXT]\n",
        "distro": "[targets.a]\ndistro = TEXT\n",
        "target's file": "[targets.a]\nfile = TEXT\n",
        "date": "[targets.a]\ndistro = 'humble'\ndate = TEXT\n",
        "target": "[targets.TEXT]\ndate = 1\n",
        "key of a target": "[targets.a]\ndistro = 'humble'\nTEXT = 1\n",
        "path": "[paths.TEXT]\nignore = ['x']\n",
        "underlay": "[workspace]\nunderlays = [TEXT]\n",
        "repos": "[workspace]\nrepos = [TEXT]\n",
        "sources": "[workspace]\nrosdep_sources = [TEXT]\n",
        "index": "[workspace]\nindex = TEXT\n",
        "syntax": "TEXT\n= 1\n",
        "a string that does not end": "[check]\nfail_on = 'TEXT\n",
    }
    found = []
    for name, text in values.items():
        for label, chosen in (
            ("commands", ("workflow command", "group")),
            ("controls", ("line feed", "escape", "C1", "direction")),
        ):
            speech = "".join(SPEECH[each] for each in chosen)
            literal = json.dumps(speech)
            arguments = ("check", "{ws}", "-q") if "target" in name or name in ("distro", "date") else COMMANDS["check"]
            found.append(
                Attack(
                    f"rosimpact.toml, {name}: {label}",
                    GROUP,
                    {"rosimpact.toml": text.replace("TEXT", literal)},
                    arguments,
                    (0, 1, 2),
                    found="",
                )
            )
    for format in ("json", "sarif", "github", "markdown", "html"):
        text = "[check]\nselect = [" + json.dumps("".join(SPEECH[each] for each in ERRORS)) + "]\n"
        found.append(
            Attack(
                f"rosimpact.toml, rule in {format}",
                GROUP,
                {"rosimpact.toml": text},
                (*COMMANDS["check"], "-f", format),
                (2,),
                found="",
            )
        )
    return found


# -- branches, authors, messages ---------------------------------------------------------------------------------------


def git_names() -> list[Attack]:
    found = []
    for format in FORMATS["logic"]:
        found.append(
            Attack(
                f"logic {format}: authors and messages",
                GROUP,
                authors,
                (*COMMANDS["logic"], "-f", format),
                (0,),
                git=True,
                snapshot=False,
            )
        )
    for format in FORMATS["check"]:
        found.append(
            Attack(
                f"check {format}: branch",
                GROUP,
                branches,
                (*COMMANDS["check"], "-f", format, "--base", "evil/::error::x"),
                (0, 1, 2),
                git=True,
                found="",
                snapshot=False,
            )
        )
    return found


def authors(place: Place) -> None:
    repository = pygit2.Repository(str(place.ws))
    for number, text in enumerate(TEXTS.values()):
        source = (place.ws / "src/healthy/src/node.cpp").read_text()
        write(place.ws, {"src/healthy/src/node.cpp": source.replace(f"> {number + 3})", f"> {number + 4})")})
        repository.index.add_all()
        name = "".join(letter for letter in text if letter not in "<>\n\0") or "evil"
        who = pygit2.Signature(name, name.replace(" ", ""), 1_700_001_000 + number, 0)
        repository.create_commit(
            "HEAD", who, who, text + "\n\n" + text, repository.index.write_tree(), [repository.head.target]
        )
    write(place.ws, {})


def branches(place: Place) -> None:
    repository = pygit2.Repository(str(place.ws))
    head = place.ws / ".git/refs/heads/evil"
    write(head, {"::error::x": f"{repository.head.target}\n", "@evil<img src=x>": f"{repository.head.target}\n"})
    write(place.ws, {".git/HEAD": "ref: refs/heads/evil/@evil<img src=x>\n"})


# -- the other commands ------------------------------------------------------------------------------------------------


def clone(place: Place) -> None:
    """A clone whose header, version tags and names are hostile, for `surface`."""
    folder = place.ws / "clone"
    first = "".join(
        f"// {text}\nvoid f{n}();\n#define X{n} {cpp_literal(text)}\n" for n, text in enumerate(TEXTS.values())
    )
    second = "".join(
        f"[[deprecated({cpp_literal(text)})]] void f{n}();\n" for n, text in enumerate(TEXTS.values()) if n % 2
    )
    beside = {
        "CMakeLists.txt": cmake(
            "cloned",
            "add_library(cloned x.cpp)\ninstall(DIRECTORY include/ DESTINATION include)\nament_export_targets(cloned)",
        ),
        "package.xml": manifest("cloned", *map(xml_text, TEXTS.values())).replace(
            ">d<", f">{xml_text(SPEECH['mask'])}<"
        ),
    }
    headers = {f"include/cloned/{text[:30]}.hpp": "void g();\n" for text in NAMES.values()}
    write(
        folder,
        {
            **beside,
            **headers,
            "include/cloned/a.hpp": first,
            "msg/Bad.msg": "".join(f"int32 X{n}={text}\n" for n, text in enumerate(TEXTS.values())),
        },
    )
    committed(place_of(place, folder), "one", 1_700_000_000)
    repository = pygit2.Repository(str(folder))
    repository.create_reference("refs/tags/1.0.0", repository.head.target)
    write(folder, {"include/cloned/a.hpp": second})
    for text in list(NAMES.values())[::2]:
        (folder / f"include/cloned/{text[:30]}.hpp").unlink()
    committed(place_of(place, folder), "two", 1_700_000_100)
    repository.create_reference("refs/tags/2.0.0", repository.head.target)


class _Elsewhere:
    def __init__(self, ws, home) -> None:
        self.ws, self.home = ws, home


def place_of(place: Place, folder) -> Place:
    import subprocess

    if not (folder / ".git").exists():
        subprocess.run(
            ["git", "init", "-q", "-b", "main", str(folder)],
            check=True,
            env={"PATH": "/usr/bin:/bin", "HOME": str(place.home)},
        )
    return _Elsewhere(folder, place.home)  # pyright: ignore[reportReturnType]


def others() -> list[Attack]:
    found: list[Attack] = []
    for format in ("text", "json", "markdown"):
        found.append(
            Attack(
                f"surface diff {format}: a hostile clone",
                GROUP,
                clone,
                ("surface", "diff", "{ws}/clone", "1.0.0", "2.0.0", "-f", format, "--all"),
                (0, 1, 2),
                found="",
                snapshot=False,
            )
        )
        found.append(
            Attack(
                f"surface show {format}: a hostile clone",
                GROUP,
                clone,
                ("surface", "show", "cloned@2.0.0", "--repos", "{ws}", "-f", format, "--all"),
                (0, 2),
                found="",
                snapshot=False,
            )
        )
        found.append(
            Attack(
                f"surface show {format}: a hostile prefix",
                GROUP,
                prefix,
                ("surface", "show", "cloned@{ws}/install", "-f", format, "--all"),
                (0, 2),
                found="",
                snapshot=False,
            )
        )
    report = "\n".join(TEXTS.values())
    lines = "".join(json.dumps({"id": text, "title": text, "body": text}) + "\n" for text in TEXTS.values())
    broken = "".join(json.dumps({"id": text, "title": {"a": text}, "body": 1}) + "\n" for text in TEXTS.values())
    for format in ("text", "json"):
        found.append(
            Attack(
                f"triage {format}: a hostile report",
                GROUP,
                {"r.txt": report},
                ("triage", "{ws}/r.txt", "-f", format),
                (0, 1, 2),
                found="",
                seconds=8,
            )
        )
        found.append(
            Attack(
                f"triage {format}: hostile lines",
                GROUP,
                {"r.jsonl": lines},
                ("triage", "{ws}/r.jsonl", "--jsonl", "-f", format),
                (0, 1, 2),
                found="",
                seconds=8,
            )
        )
        found.append(
            Attack(
                f"corpus stats {format}: hostile labels",
                GROUP,
                {"l.jsonl": labels()},
                ("corpus", "stats", "--labels", "{ws}/l.jsonl", "-f", format),
                (0, 1, 2),
                found="",
            )
        )
    found.append(
        Attack(
            "triage: lines of wrong types",
            GROUP,
            {"r.jsonl": broken},
            ("triage", "{ws}/r.jsonl", "--jsonl"),
            (0, 1, 2),
            found="",
            seconds=8,
        )
    )
    found.append(
        Attack(
            "triage: lines from input",
            GROUP,
            {"r.jsonl": lines},
            ("triage", "-"),
            (0, 1, 2),
            found="",
            stdin="{ws}/r.jsonl",
            seconds=8,
        )
    )
    found.append(
        Attack(
            "triage: text from input",
            GROUP,
            {"r.txt": report},
            ("triage", "-"),
            (0, 1, 2),
            found="",
            stdin="{ws}/r.txt",
            seconds=8,
        )
    )
    found.append(
        Attack(
            "corpus label --list: hostile reports",
            GROUP,
            {"r.jsonl": lines, "l.jsonl": ""},
            ("corpus", "label", "--list", "--reports", "{ws}/r.jsonl", "--labels", "{ws}/l.jsonl"),
            (0, 1, 2),
            found="",
        )
    )
    found.append(
        Attack(
            "corpus label --list: hostile annotator",
            GROUP,
            {"r.jsonl": lines, "l.jsonl": ""},
            (
                "corpus",
                "label",
                "--list",
                "--annotator",
                SPEECH["line feed"],
                "--reports",
                "{ws}/r.jsonl",
                "--labels",
                "{ws}/l.jsonl",
            ),
            (0, 1, 2),
            found="",
        )
    )
    machine = json.dumps(
        {
            "rosimpact_target": 1,
            "distro": "humble",
            "name": SPEECH["line feed"],
            "date": SPEECH["escape"],
            "packages": {text: text for text in TEXTS.values()},
        }
    )
    for name, content in {
        "names": machine,
        "distro": json.dumps({"rosimpact_target": 1, "distro": "".join(TEXTS.values())}),
        "syntax": '{"' + SPEECH["line feed"],
    }.items():
        for command in (
            ("check", "{ws}", "-t", "{ws}/m.json"),
            ("env", "diff", "{ws}/m.json", "jazzy", "{ws}"),
            ("upgrade", "{ws}", "--from", "{ws}/m.json", "--to", "jazzy"),
            ("why", "OpenCV", "{ws}", "-t", "{ws}/m.json"),
        ):
            found.append(
                Attack(
                    f"{command[0]}: hostile machine, {name}", GROUP, {"m.json": content}, command, (0, 1, 2), found=""
                )
            )
    listing = (
        "".join(f"ii  {text}  {text}  amd64  {text}\n" for text in TEXTS.values())
        + "ii  ros-humble-rclcpp  16.0.1-1jammy  amd64  x\n"
    )
    for command in (("check", "{ws}", "-t", "{ws}/m.dpkg.txt"), ("env", "diff", "{ws}/m.dpkg.txt", "jazzy", "{ws}")):
        found.append(
            Attack(f"{command[0]}: hostile listing", GROUP, {"m.dpkg.txt": listing}, command, (0, 1, 2), found="")
        )
    repos = "repositories:\n" + "".join(
        f"  {quoted(text)}: {{type: git, url: {quoted(text)}, version: {quoted(text)}}}\n" for text in TEXTS.values()
    )
    found.append(
        Attack(
            "check: hostile pinned repositories",
            GROUP,
            {"m.repos": repos},
            (*COMMANDS["check"], "--base", "{ws}/m.repos"),
            (0, 1, 2),
            found="",
            git=True,
        )
    )
    known = json.dumps(
        {
            "schema": 1,
            "findings": [
                {"fingerprint": text, "rule": text, "file": text, "message": text, "count": 1}
                for text in TEXTS.values()
            ],
        }
    )
    found.append(
        Attack(
            "check: hostile baseline",
            GROUP,
            {"k.json": known},
            (*COMMANDS["check"], "--baseline", "{ws}/k.json"),
            (0, 1, 2),
            found="",
        )
    )
    found.append(
        Attack(
            "check: hostile install space",
            GROUP,
            prefix,
            (*COMMANDS["check"], "--notes", "--install", "{ws}/install"),
            (0, 1),
            snapshot=False,
        )
    )
    found.append(
        Attack(
            "check: hostile names of libraries",
            GROUP,
            libraries,
            (*COMMANDS["check"], "--notes", "--install", "{ws}/install"),
            (0, 1),
            snapshot=False,
        )
    )
    return found


def labels() -> str:
    return "".join(
        json.dumps(
            {
                "id": text,
                "annotator": text,
                "source": text,
                "labels": {text: text},
                "kind": text,
                "phase": text,
                "url": text,
            }
        )
        + "\n"
        for text in TEXTS.values()
    )


def prefix(place: Place) -> None:
    files: dict[str, str | bytes] = {
        "install/share/cloned/package.xml": manifest("cloned", *map(xml_text, TEXTS.values())),
        "install/share/ament_index/resource_index/packages/cloned": "",
        "install/setup.sh": f"# {SPEECH['mask']}\n",
    }
    files |= {f"install/include/cloned/cloned/{text[:30]}.hpp": f"// {text}\nvoid f();\n" for text in NAMES.values()}
    files |= {f"install/lib/{text[:30]}.so": b"\x7fELF" + b"\0" * 100 for text in NAMES.values()}
    files |= {f"install/share/cloned/msg/{text[:30]}.msg": f"{text}\n" for text in NAMES.values()}
    write(place.ws, files)


def libraries(place: Place) -> None:
    import importlib.util
    from pathlib import Path

    spec = importlib.util.spec_from_file_location("_the_conftest", Path(__file__).parents[1] / "conftest.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    wanted = [text.replace("\0", "") for text in TEXTS.values()]
    needed = [text.encode("utf-8", "surrogateescape").decode("latin-1") for text in wanted]
    ascii_needed = [text for text in needed if text.isascii()]
    write(
        place.ws,
        {"install/lib/libbad.so": module.elf_bytes("EM_X86_64", ascii_needed, "evil\x1b[2J", "/evil\n::error::evil")},
    )
