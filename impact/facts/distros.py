"""Distros that files name: folders of an installed one (`/opt/ros/humble`), in shell scripts, Dockerfiles and CI files
also Debian packages, and in the latter two base images."""

import re
from collections.abc import Iterable, Iterator

import msgspec

from .markup import decode
from .place import Problem


class DistroUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A folder of a distro, `/opt/ros/humble`, or a Debian package of one, `ros-humble-desktop`. tested: a condition
    around it may tell whether it is there."""

    distro: str
    text: str
    line: int
    column: int = 0
    tested: bool = False


class DistroFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a file names: folders and packages, and the lower-case words that may be the names of other distros."""

    uses: tuple[DistroUse, ...] = ()
    words: str = ""


class ContainerPart(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A stage of a Dockerfile or a job of a CI file. images, distros: the images that it runs in and the distros that
    it is set to, all literal. open: variables, or conditions, decide on one of them."""

    images: tuple[str, ...]
    distros: tuple[str, ...]
    uses: tuple[DistroUse, ...]
    open: bool = False


class ContainerFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The parts of a Dockerfile or CI file."""

    parts: tuple[ContainerPart, ...]
    problems: tuple[Problem, ...] = ()


_MARK = b"/opt/ros/"
_LONG_LINE = 2000
_FOLDER = re.compile(r"/opt/ros/([a-z]{4,12})(?![\w$*?{\[-])")
_PACKAGE = re.compile(r"(?<![\w/.-])ros-([a-z]{4,12})-[a-z0-9-]*[a-z0-9](?![\w$*?{./:-])")
_WORD = re.compile(r"[a-z]{4,12}")
# Comments over several lines, of XML, C++ and Python.
_LONG_COMMENT = re.compile(
    r"<!--.*?(?:-->|\Z)|(?<![\w/])/\*.*?(?:\*/|\Z)|\"\"\".*?(?:\"\"\"|\Z)|'''.*?(?:'''|\Z)", re.DOTALL
)
# Before a path on its line: a comment, or text for a person.
_PROSE = re.compile(
    r"(?:^|\s)#(?!\s*include)|(?<!:)//|^\s*(?:\*|%)|\b(?:echo|printf?|message|raise|throw|help|usage|description)\b"
    r"|(?i:log|warn|error|info)[\w.:]{0,30}\s?[(<]"
)
_TEST = re.compile(
    r"\b(?:if|elif|elseif|case|when|test|unless|while|for|try|except|else)\b|exist|is_?(?:dir|file)|\[ |\|\|",
    re.IGNORECASE,
)
_HEAD = re.compile(
    r"\s*(?:\}\s*)?(?:#\s*)?(?:if|ifdef|elif|elseif|else|case|for|foreach|while|try|except)\b", re.IGNORECASE
)
_OPENS = re.compile(r"\s*(?:if|case|#\s*if(?:def)?)\b", re.IGNORECASE)
_CLOSES = re.compile(r"\s*(?:fi|esac|endif|#\s*endif)\b", re.IGNORECASE)
# How tools head what they write.
_GENERATED = re.compile(r"\s*(?:#|//|/\*)[ ]?(?:auto-?)?generated (?:from|by)\b", re.IGNORECASE)
_ASKS = re.compile(r"(?:\$\{?|ENV\{|env[ (]+)ROS_DISTRO|(?:environ|getenv)\W.{0,9}ROS_DISTRO|ROS_VERSION")


def find_distros(data: bytes, kind: str) -> DistroFile | None:
    """The folders of distros that the code of a file names, and in shell scripts their Debian packages, None for none:
    not in comments, messages and files that a tool has generated."""
    if _MARK not in data and (kind != "shell" or b"ros-" not in data):
        return None
    patterns = (_FOLDER, _PACKAGE) if kind == "shell" else (_FOLDER,)
    text = decode(data)
    if _GENERATED.match(text):
        return None
    text = _LONG_COMMENT.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    asks = _ASKS.search(text) is not None
    uses: list[DistroUse] = []
    around: list[tuple[int, bool]] = []
    depth = 0
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip():
            continue
        indent = len(line) - len(line.lstrip())
        while around and around[-1][0] >= indent:
            around.pop()
        depth += bool(_OPENS.match(line))
        for m in filter(None, (pattern.search(line[:_LONG_LINE]) for pattern in patterns)):
            if not _PROSE.search(line[: m.start()]):
                tested = asks or depth > 0 or any(head for _, head in around) or _TEST.search(line) is not None
                uses.append(DistroUse(m[1], m[0], number, m.start() + 1, tested))
        depth = max(0, depth - bool(_CLOSES.match(line)))
        around.append((indent, _HEAD.match(line) is not None))
    return DistroFile(tuple(uses), " ".join(sorted(set(_WORD.findall(text))))) if uses else None


def list_installed_distros(text: str) -> list[str]:
    """The distros whose folders or Debian packages a text names, in order."""
    matches = sorted((m.start(), m[1]) for pattern in (_FOLDER, _PACKAGE) for m in pattern.finditer(text))
    return list(dict.fromkeys(distro for _, distro in matches))


def extract(data: bytes, kind: str) -> ContainerFile:
    """The parts of a file of the kind dockerfile or ci; never raises."""
    lines = [
        (number, "" if line.lstrip().startswith("#") else line[:_LONG_LINE])
        for number, line in enumerate(decode(data).split("\n"), 1)
    ]
    return ContainerFile(tuple(_list_stages(lines) if kind == "dockerfile" else _list_jobs(lines)))


_FROM = re.compile(r"\s*FROM\s+(?:--\S+\s+)*(\S+)(?:\s+AS\s+(\S+))?", re.IGNORECASE)
_IMAGE = re.compile(r"\s*-?\s*(?:container|image)\s*:\s*[\"']?([\w./:@${}-]+)")
_SET = re.compile(
    r"\b(?:ROS_DISTRO|ros_distro|ros-distro|required-ros-distributions|target-ros[12]-distro)[\"']?[ ]?[:= ][ ]?(\S+)"
)
_DECIDES = re.compile(r"\bif\s+(?:\[|test\b|!)|\bcase\s|\bmatrix\b|\bparallel\s*:|\bfor\s+\w+\s+in\b")


def _list_stages(lines: Iterable[tuple[int, str]]) -> Iterator[ContainerPart]:
    """A part for each FROM; one that builds on another stage has its image."""
    parts: list[list[tuple[int, str]]] = []
    for number, line in lines:
        if _FROM.match(line):
            parts.append([])
        if parts and not re.match(r"\s*(?:COPY|ADD|LABEL)\b", line):
            parts[-1].append((number, line))
    named: dict[str, str] = {}
    for part in parts:
        start = _FROM.match(part[0][1])
        if start is not None:
            image = named.get(start[1].lower(), start[1])
            if start[2]:
                named[start[2].lower()] = image
            yield _read_part(part[1:], [image])


def _list_jobs(lines: list[tuple[int, str]]) -> Iterator[ContainerPart]:
    """A part for each job of GitHub's workflows, else for each key of the file."""
    jobs = next((at for at, (_, line) in enumerate(lines) if re.match(r"jobs\s*:", line)), -1)
    lines = lines[jobs + 1 :]
    indent = next((len(line) - len(line.lstrip()) for _, line in lines if line.strip()), 0)
    head = re.compile(rf"[ ]{{{indent}}}[\w.\"'-]+\s*:")
    parts: list[list[tuple[int, str]]] = [[]]
    for row in lines:
        if head.match(row[1]):
            parts.append([])
        parts[-1].append(row)
    for part in parts:
        yield _read_part(part, [m[1] for _, line in part if (m := _IMAGE.match(line))])


def _read_part(lines: list[tuple[int, str]], images: list[str]) -> ContainerPart:
    distros = [m[1].strip("\"',]") for _, line in lines for m in _SET.finditer(line)]
    uses = tuple(
        DistroUse(m[1], m[0], number, m.start() + 1)
        for number, line in lines
        for pattern in (_FOLDER, _PACKAGE)
        for m in pattern.finditer(line)
        if not re.search(r"\b(?:echo|name)\b|\s#", line[: m.start()])
    )
    is_open = any("$" in name for name in (*images, *distros)) or any(_DECIDES.search(line) for _, line in lines)
    return ContainerPart(tuple(images), tuple(distros), uses, is_open)
