"""Finds commits in git histories that look like the fix of a broken build or dependency.

What it gives are candidates: commit, files, a guessed family and guessed names. Whether something was broken is for a
reader of the diff to say. No text of a commit is kept.

How a commit is judged: few files, no merge, a message or a change of lines that speaks of a fix (`_MESSAGE`, `judge`).
The change of lines counts more: dependencies of package.xml, calls of CMakeLists.txt, includes, a name that one other
name replaces in all places, message fields, Python that version 3 does not read.
"""

from __future__ import annotations

import random
import re
import subprocess
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

MOST_FILES = 12
MOST_LINES = 160
MOST_DIFFS = 2500
_SOURCES = (".c", ".cc", ".cpp", ".cxx", ".h", ".hh", ".hpp", ".hxx", ".ipp", ".cu")
_MESSAGES = (".msg", ".srv", ".action")
ROS1 = ("groovy", "hydro", "indigo", "jade", "kinetic", "lunar", "melodic", "noetic")
ROS2 = (
    *("ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy", "galactic", "humble", "iron", "jazzy", "kilted"),
    *("lyrical", "rolling"),
)
_MESSAGE = re.compile(
    r"""\b(?:fix|repair|correct|resolv|unbreak|restor|workaround|add|declar|missing|forgot)\w*\b.{0,40}\b
        (?:buil[dt]\w*|compil\w*|link\w*|install\w*|dep(?:s|end\w*)?|includ\w*|header\w*|cmake\w*|package\.?xml|manifest|
           export\w*|catkin|ament\w*|rosdep\w*|colcon|jenkins|build_?farm|import\w*|find_package|ci)\b
      | \bmissing\b | undefined\ (?:reference|symbol) | no\ such\ file | not\ found | (?:cannot|can't|could\ not)\ find
      | (?:doesn't|does\ not|do\ not|won't)\ (?:build|compile|link)
      | (?:build|compil\w*|link\w*)\ (?:fail|err|issue|break|problem)
      | (?:fail\w*|broken|break\w*)\ (?:to\ )?(?:build|compil\w*|link) | \bport\w*\ to\b | migrat\w+ | deprecat\w+
      | \b(?:gcc|clang|opencv|boost|pcl|eigen|qt|fmt|yaml-?cpp|tinyxml|protobuf|python)\W{0,2}\d
      | c\+\+\ ?\d\d | py(?:thon)?\ ?3
      | \b(?:ubuntu|focal|bionic|jammy|noble|bookworm|trusty|xenial|"""
    + "|".join(ROS1 + ROS2)
    + r""")\b
      | \b(?:renamed?|moved?|removed|api|compat\w*)\b""",
    re.IGNORECASE | re.VERBOSE,
)
_STATED = re.compile(
    r"\b(?:fix|repair|unbreak|resolv)\w*\b.{0,30}\b(?:buil[dt]|compil|link|cmake|depend|includ|install|export|import)"
    r"|missing.{0,20}(?:dep|includ|header|find_package|install|export|link|import)|undefined (?:reference|symbol)"
    r"|no such file|(?:build|compil\w*|link\w*) (?:fail|err|issue|break)|(?:broken|failing) build"
    r"|(?:doesn't|does not|won't) (?:build|compile|link)",
    re.IGNORECASE,
)
_UPSTREAM = re.compile(
    r"deprecat|\bapi\b|migrat|\bport|compat|upstream|changed? in|release"
    r"|\b(?:gcc|clang|opencv|boost|qt|gazebo|gz|moveit|nav2)"
    r"|\b(?:foxy|galactic|humble|iron|jazzy|kilted|lyrical|rolling|indigo|jade|kinetic|melodic|noetic)",
    re.IGNORECASE,
)
_UNWANTED = re.compile(
    r"^\s*(?:revert|changelog|bump|prepar\w+ (?:for )?release|release|initial|first commit|\d+\.\d+\.\d+\s*$|merge"
    r"|wip)\b"
    r"|\b(?:uncrustify|cpplint|clang-?format|clang-?tidy|linters?|flake8|typos?|readme|docs?|copyright|licen[sc]e)\b"
    r"|maintainer|pre-commit|unneeded|unused|unnecessary|not needed|obsolete|redundant|clean(?:ed)?[ -]?up"
    r"|update version",
    re.IGNORECASE,
)
_FEATURE = re.compile(r"\b(?:implement|feature|feat|support for|new |introduc|improv|refactor)\w*", re.IGNORECASE)
_DEPEND = re.compile(r"<((?:\w+_)?depend)\b[^>]*>\s*([\w.+-]+)\s*</")
_INCLUDE = re.compile(r"^\s*#\s*include\s*[<\"]([^>\"]+)[>\"]")
_FIND = re.compile(r"\bfind_package\s*\(\s*([\w+.-]+)", re.IGNORECASE)
_CALL = re.compile(r"^\s*(\w+)\s*\(\s*([^)\n]*)")
_WORD = re.compile(r"[A-Za-z_][\w.-]*(?:::[\w.-]+)*")
_TOKEN = re.compile(r"[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*|\S")
_QUOTED = re.compile(r"\"(?:\\\\.|[^\"\\\\])*\"|//.*|/\*.*|^\s*\*.*")
_NAME = re.compile(r"[A-Za-z_][\w:]*")
_KEYWORDS = frozenset(
    """auto bool break case catch char class const continue def double else false float for from if import int long
    namespace new not null nullptr override private public return self short size_t static string struct switch template
    this throw true try typename unsigned using virtual void while None True False print len str range""".split()  # noqa: SIM905
)
_INSTALLS = re.compile(
    r"\b(?:install|ament_export_\w+|catkin_package|catkin_install_python|ament_python_install_\w+|ament_package|"
    r"pluginlib_export_plugin_description_file|rclcpp_components_register_node\w*)\b"
    r"|\b(?:DESTINATION|CATKIN_DEPENDS|data_files|entry_points|console_scripts|package_data|INCLUDES)\b"
)
_LINKS = re.compile(
    r"target_link|include_directories|ament_target_dependencies|link_directories|LIBRARIES|INCLUDE_DIR|::"
)
_STANDARD = re.compile(r"CXX_STANDARD|-std=c|cxx_std_|cmake_minimum_required|version_(?:gte|lte|eq|lt|gt)|_VERSION\b")
_PYTHON3 = re.compile(
    r"iteritems|itervalues|xrange|basestring|raw_input|\bunicode\b|print [\"']|except \w+, \w+|python3|urllib2|Queue|"
    r"Tkinter|cPickle|StringIO|setDaemon|distutils|\bimp\b|np\.(?:float|int|bool)\b|collections\.|yaml\.(?:safe_)?load"
)
_SYSTEM = re.compile(
    r"boost|opencv|\bcv2?\b|cv::|\bCV_|\bpcl|eigen|\bqt|yaml-?cpp|tinyxml|tbb|protobuf|\bfmt|fmt::|log4cxx|ogre|sdl|curl|"
    r"pthread|threads|ceres|glog|gflags|openmp|\bstd::|gtest|gmock|assimp|ffmpeg|avcodec|libav|nlohmann|python3?-|lib\w+-dev|"
    r"\bnumpy|asio|suitesparse|hdf5|vtk|glut|opengl|glfw|gstreamer|zmq|sqlite|libusb",
    re.IGNORECASE,
)
_CMAKE_WORDS = re.compile(
    r"set|option|if|else|elseif|endif|foreach|endforeach|install|include|src|launch|config|message|project|lib|share|bin|from|import"
    r"|(?:set|add|target|find|install|include|link|pkg|ament_target|ament_export|ament_python|catkin_install)_[a-z_]+"
    r"|ament_package|catkin_package|catkin_LIBRARIES|(?:CMAKE|CATKIN|PROJECT)_\w+|[A-Z_]+|[\d._]+"
)
_DEFINES = (
    r"(?:\b(?:class|struct|enum|def|define|using|typedef\b.*)\s+{0}\b)"
    r"|(?:^[\w:<>,&*\s]*[\w>&*]\s+[&*]?(?:\w+::)*{0}\s*\([^;]*\)?[^;]*[{{]?$)"
)
_STD_HEADER = re.compile(r"^(?:c?[a-z_]+|sys/\w+\.h|std\w+\.h|math\.h|unistd\.h)$")
_GENERATION = (
    (2, re.compile(r"ament_\w+|rclcpp|rclpy|rosidl_default")),
    (1, re.compile(r"<buildtool_depend[^>]*>\s*catkin\b|roscpp|rospy|message_generation")),
)


class Clone:
    """A git repository at hand, bare or not."""

    def __init__(self, name: str, folder: Path) -> None:
        self.name, self.folder = name, folder

    def read(self, *command: str, given: str | None = None) -> str:
        """What a git command prints. Raises subprocess.CalledProcessError if it fails."""
        done = subprocess.run(
            ["git", "--git-dir", str(self.folder), *command],
            input=None if given is None else given.encode(),
            capture_output=True,
            check=True,
        )
        return done.stdout.decode("utf-8", "replace")

    def list_files(self, commit: str) -> list[str]:
        return self.read("ls-tree", "-r", "-z", "--name-only", "--full-tree", commit).split("\0")[:-1]

    def show(self, commit: str, path: str) -> str:
        """The text of a file at a commit, empty if the clone has not got it."""
        try:
            return self.read("show", f"{commit}:{path}")
        except subprocess.CalledProcessError:
            return ""


def find_clones(root: Path, names: Iterable[str]) -> list[Clone]:
    """The repositories OWNER/NAME that lie below root as OWNER+NAME/repo, OWNER+NAME or OWNER/NAME."""
    found = []
    for name in names:
        for at in (name.replace("/", "+") + "/repo", name.replace("/", "+"), name):
            git = next((g for g in (root / at, root / at / ".git") if (g / "HEAD").exists()), None)
            if git:
                found.append(Clone(name, git))
                break
    return found


def find_known(clones: Iterable[Clone], commits: Iterable[str]) -> set[str]:
    """Those of the commits that one of the clones has: two repositories can have a part of their history in common."""
    asked = "".join(f"{commit}\n" for commit in commits)
    answers = "".join(clone.read("cat-file", "--batch-check", given=asked) for clone in clones).splitlines()
    return {answer.split()[0] for answer in answers if answer.split()[1] == "commit"}


class Commit(NamedTuple):
    """A commit without merge: date (of the author, YYYY-MM-DD), message, files that it changes."""

    fix: str
    parent: str
    date: str
    message: str
    files: tuple[str, ...]


class Change(NamedTuple):
    """Lines that one file loses and gets."""

    path: str
    removed: list[str]
    added: list[str]
    is_new: bool = False


class Judgement(NamedTuple):
    family: str
    names: tuple[str, ...]
    weight: int


def list_commits(clone: Clone, since: str) -> Iterator[Commit]:
    """Commits of all branches that change at most MOST_FILES files, one of each subject and set of files (the oldest),
    since a date YYYY-MM-DD."""
    text = clone.read(
        "log", "--branches", "--no-merges", "--reverse", "--name-only", "-z", "--no-renames",
        f"--since={since}", "--format=%x1e%H%x1f%P%x1f%as%x1f%B%x1f",
    )  # fmt: skip
    seen = set()
    for record in text.split("\x1e")[1:]:
        fix, parents, date, message, names = record.split("\x1f", 4)
        files = tuple(name for name in names.strip("\0\n").split("\0") if name.strip())
        key = (message.strip().split("\n")[0].split(" (#")[0], files)
        if len(parents.split()) == 1 and 0 < len(files) <= MOST_FILES and key not in seen:
            seen.add(key)
            yield Commit(fix, parents, date, message, tuple(name.strip("\n") for name in files))


def read_changes(clone: Clone, commits: list[Commit]) -> Iterator[tuple[Commit, list[Change]]]:
    """The lines that each commit changes, in the order of the commits. Left out: long diffs, and commits with a file
    that the clone has not got, at which git stops."""
    left = commits
    while left:
        part = left[:250]
        command = ("diff-tree", "--stdin", "-r", "-p", "-U0", "--no-renames", "--no-color", "--no-ext-diff")
        done = subprocess.run(
            ["git", "--git-dir", str(clone.folder), *command],
            input="".join(f"{commit.fix}\n" for commit in part).encode(),
            capture_output=True,
            check=False,
        )
        by_id = {commit.fix: at for at, commit in enumerate(part)}
        blocks = re.split(r"(?m)^(?=[0-9a-f]{40}$)", done.stdout.decode("utf-8", "replace"))
        read = [(by_id[block[:40]], block) for block in blocks if block[:40] in by_id]
        for at, block in read[:-1] if done.returncode else read:
            changes = list(read_diff(block))
            if 0 < sum(len(c.added) + len(c.removed) for c in changes) <= MOST_LINES:
                yield part[at], changes
        left = left[len(part) if not done.returncode else read[-1][0] + 1 if read else 1 :]


def read_diff(text: str) -> Iterator[Change]:
    """The files of a diff without context."""
    for block in re.split(r"(?m)^diff --git ", text)[1:]:
        head, _, body = block.partition("\n@@")
        path = re.search(r"(?m)^\+\+\+ b/(.+?)\t?$", head)
        if path:
            lines = body.split("\n")[1:]
            yield Change(
                path[1],
                [line[1:] for line in lines if line.startswith("-")],
                [line[1:] for line in lines if line.startswith("+")],
                "\n--- /dev/null" in head,
            )


def judge(commit: Commit, changes: list[Change]) -> Judgement | None:
    """What a commit looks like, by the strongest sign of its lines, or None if nothing speaks of a fix. The weight
    grows with the signs: a message that states a break, a small change, no other work beside it."""
    subject = commit.message.strip().split("\n")[0]
    if _UNWANTED.search(subject):
        return None
    size = sum(len(c.added) + len(c.removed) for c in changes)
    sign = find_sign(changes)
    if sign and sign.family == "upstream-api-change" and not _MESSAGE.search(commit.message):
        return None
    if sign is None:
        if not _STATED.search(commit.message) or size > 60 or not any(is_built(c.path) for c in changes):
            return None
        sign = Judgement("other-build", tuple(find_replacements(changes)[:3]), 0)
    weight = sign.weight + (3 if _STATED.search(commit.message) else 1 if _MESSAGE.search(commit.message) else 0)
    if sign.family in ("upstream-api-change", "header-moved", "message-change"):
        weight += 2 * bool(_UPSTREAM.search(commit.message))
    weight += (size <= 12) + (size <= 40) - (size > 90)
    weight -= 2 * bool(_FEATURE.search(subject)) + 2 * any(c.is_new for c in changes)
    return sign._replace(weight=weight) if weight >= 4 else None


def is_built(path: str) -> bool:
    name = path.rsplit("/", 1)[-1]
    return name in ("CMakeLists.txt", "package.xml", "setup.py", "setup.cfg") or path.endswith(
        (*_SOURCES, *_MESSAGES, ".cmake", ".py", ".in")
    )


def find_sign(changes: list[Change]) -> Judgement | None:
    """The family that the changed lines point to, the names, and how much they say (1 to 3)."""
    manifests = [c for c in changes if c.path.rsplit("/", 1)[-1] == "package.xml"]
    cmake = [c for c in changes if c.path.endswith(("CMakeLists.txt", ".cmake", ".cmake.in"))]
    sources = [c for c in changes if c.path.endswith(_SOURCES)]
    python = [c for c in changes if c.path.endswith((".py", "setup.cfg")) or "/scripts/" in c.path]
    messages = [c for c in changes if c.path.endswith(_MESSAGES)]
    only_manifests = not (sources or python or messages)
    return (
        judge_includes(sources, only=len(sources) == len(changes))
        or judge_manifests(manifests, alone=only_manifests)
        or judge_cmake(cmake, alone=only_manifests)
        or judge_python(python)
        or judge_messages(messages, bool(sources or python))
        or judge_renames(sources + python)
    )


def judge_includes(sources: list[Change], only: bool) -> Judgement | None:
    """Includes that were changed, where little else was."""
    gone, come, other = set(), set(), 0
    for change in sources:
        for lines, into in ((change.removed, gone), (change.added, come)):
            for line in lines:
                include = _INCLUDE.match(line)
                if include:
                    into.add(include[1])
                elif line.strip() and not line.strip().startswith(("//", "/*", "*", "#")):
                    other += 1
    moved, new = gone - come, come - gone
    if not new or other > 3 * (len(new) + len(moved)) or (not only and other):
        return None
    weight = 3 if not other else 1
    if moved:
        names = tuple(sorted(moved))[:4]
        system = any(_SYSTEM.search(name) for name in names)
        return Judgement("system-library" if system else "header-moved", names, weight)
    names = tuple(sorted(new))[:4]
    system = _STD_HEADER.match(names[0]) or _SYSTEM.search(names[0])
    return Judgement("system-library" if system else "other-build", names, weight)


def judge_manifests(manifests: list[Change], alone: bool) -> Judgement | None:
    """Dependencies that package.xml gets, renames, or asks for at another time."""
    gone = Counter(m.groups() for c in manifests for line in c.removed for m in _DEPEND.finditer(line))
    come = Counter(m.groups() for c in manifests for line in c.added for m in _DEPEND.finditer(line))
    new = {name for _, name in come} - {name for _, name in gone}
    old = {name for _, name in gone} - {name for _, name in come}
    weight = 3 if alone else 1
    if new and old and len(new) <= 4 and len(old) <= 4:
        return Judgement("unreleased-or-renamed-dep", tuple(sorted(old))[:4], weight)
    if new and len(new) <= 4:
        names = tuple(sorted(new))
        messages = all(re.search(r"_(?:msgs|srvs|interfaces|actions)$|^message_|^rosidl_", name) for name in names)
        system = all(_SYSTEM.search(name) for name in names)
        family = "undeclared-message-dep" if messages else "system-library" if system else "missing-package-dep"
        return Judgement(family, names, weight)
    kinds = {name for _, name in (come - gone)}
    if kinds and len(kinds) <= 4:
        return Judgement("missing-package-dep", tuple(sorted(kinds)), weight)
    if old and len(old) <= 3:
        return Judgement("unreleased-or-renamed-dep", tuple(sorted(old)), weight - 1)
    if any(_STANDARD.search(line) for c in manifests for line in c.added):
        return Judgement("version-constraint", (), weight - 1)
    return None


def judge_cmake(cmake: list[Change], alone: bool) -> Judgement | None:
    """Calls of CMakeLists.txt: what is searched, linked, installed, exported, waited for."""
    gone = [line for c in cmake for line in c.removed if not line.lstrip().startswith("#")]
    come = [line for c in cmake for line in c.added if not line.lstrip().startswith("#")]
    if not gone and not come:
        return None
    weight = 3 if alone else 1
    found, lost = set(_FIND.findall("\n".join(come))), set(_FIND.findall("\n".join(gone)))
    before, after = (Counter(word for line in lines for word in _WORD.findall(line)) for lines in (gone, come))
    words = after - before
    names = tuple([w for w in (*words, *(before - after)) if not _CMAKE_WORDS.fullmatch(w)][:4])
    text = "\n".join(gone + come)
    if _INSTALLS.search(text):
        return Judgement("install-or-export", names or ("install",), weight - (not come))
    if "add_dependencies" in text or "EXPORTED_TARGETS" in text or "_generate_messages" in text:
        return Judgement("undeclared-message-dep", names, weight)
    if _STANDARD.search(text):
        return Judgement("version-constraint", names, weight)
    if found != lost and (found | lost):
        names = tuple(sorted(found ^ lost))[:4]
        system = any(_SYSTEM.search(name) for name in names)
        return Judgement("system-library" if system else "missing-find-package", names, weight)
    if _LINKS.search(text):
        return Judgement("system-library" if _SYSTEM.search(" ".join(names) or text) else "other-build", names, weight)
    if words and len(come) + len(gone) <= 8:
        listed = all(re.fullmatch(r"\s*[\w.-]+\)?\s*", line) for line in come)
        return Judgement("missing-find-package" if listed else "other-build", names, weight - 1)
    return None


def judge_python(python: list[Change]) -> Judgement | None:
    """Python that a newer interpreter or library does not read, and what setup.py installs."""
    lines = [line for c in python for line in c.added + c.removed]
    setup = [c for c in python if c.path.rsplit("/", 1)[-1] in ("setup.py", "setup.cfg")]
    if setup and len(setup) == len(python) and _INSTALLS.search("\n".join(lines)):
        return Judgement("install-or-export", tuple(find_replacements(setup)[:3]), 2)
    said = Counter(m[0] for line in lines for m in _PYTHON3.finditer(line))
    if said:
        return Judgement("python-api-or-py3", tuple(name for name, _ in said.most_common(3)), 1)
    imports = [line for line in lines if re.match(r"\s*(?:from|import) ", line)]
    if imports and len(imports) * 2 >= len([line for line in lines if line.strip()]):
        gone = [w for c in python for line in c.removed if line in imports for w in _WORD.findall(line)]
        come = [w for c in python for line in c.added if line in imports for w in _WORD.findall(line)]
        names = tuple((Counter(gone) - Counter(come)) or (Counter(come) - Counter(gone)))
        names = tuple(name for name in names if name not in ("from", "import", "as"))[:3]
        return Judgement("python-api-or-py3", names, 2) if names else None
    return None


def judge_messages(messages: list[Change], used: bool) -> Judgement | None:
    """A field's type or name that was changed in a message."""
    names = [w for c in messages for line in c.removed for w in _WORD.findall(line.split("#")[0])]
    return Judgement("message-change", tuple(dict.fromkeys(names))[:3], 2 if used else 1) if names else None


def judge_renames(sources: list[Change]) -> Judgement | None:
    """One name that another replaces, as most of what changes."""
    pairs = find_replacements(sources)
    lines = sum(len(c.removed) for c in sources)
    if not pairs or lines > 60 or sum(len(c.added) for c in sources) > 2 * lines:
        return None
    names = tuple(dict.fromkeys(pairs))[:4]
    system = any(_SYSTEM.search(name) for name in names)
    return Judgement("system-library" if system else "upstream-api-change", names, 2 if len(pairs) * 2 >= lines else 1)


def find_replacements(changes: list[Change]) -> list[str]:
    """The names in removed lines that differ from the added line at the same place, the most frequent first."""
    found: Counter[str] = Counter()
    for change in changes:
        if len(change.removed) != len(change.added):
            continue
        for old, new in zip(change.removed, change.added, strict=True):
            old, new = (_QUOTED.sub("", line) for line in (old, new))
            before, after = Counter(_TOKEN.findall(old)), Counter(_TOKEN.findall(new))
            lost = [t for t in (before - after) if _NAME.fullmatch(t) and len(t) > 2 and t not in _KEYWORDS]
            used = [t for t in lost if re.search(rf"(?:\.|->|::){t}\b|\b{t}\s*(?:\(|<|::|\.)|::", old)]
            if len(lost) <= 2 and sum((before & after).values()) * 2 >= sum(before.values()):
                found.update(used)
    return [name for name, _ in found.most_common()]


def find_packages(clone: Clone, commit: str, files: Iterable[str]) -> tuple[list[dict[str, str]], int | None]:
    """The packages whose folders hold the files, as name and path, and their ROS generation at a commit: 1, 2, or None
    if their manifests do not say it. No packages are given where a build tool is told to skip the folder."""
    tree = clone.list_files(commit)
    manifests = {path[: -len("package.xml")].rstrip("/") for path in tree if path.rsplit("/", 1)[-1] == "package.xml"}
    skipped = {p.rpartition("/")[0] for p in tree if p.endswith(("COLCON_IGNORE", "CATKIN_IGNORE", "AMENT_IGNORE"))}
    packages, generations = {}, Counter()
    for file in files:
        parts = file.split("/")[:-1]
        above = ["/".join(parts[:n]) for n in range(len(parts), -1, -1)]
        folder = next((at for at in above if at in manifests), None)
        if folder is None or folder in packages or skipped.intersection(above):
            continue
        text = clone.show(commit, f"{folder}/package.xml".lstrip("/"))
        name = re.search(r"<name>\s*([\w-]+)\s*</name>", text)
        if name:
            packages[folder] = name[1]
            generations.update(ros for ros, pattern in _GENERATION if pattern.search(text))
    ros = generations.most_common(1)[0][0] if generations else None
    return [{"name": name, "path": at or "."} for at, name in packages.items()], ros


def is_supported(clone: Clone, commit: Commit, judgement: Judgement, packages: list[dict[str, str]]) -> bool:
    """False where the parent shows that the guess is wrong: a dependency that nothing in the package uses but its
    manifest, a renamed name that the repository itself defines."""
    names = [name.rsplit("::", 1)[-1] for name in judgement.names]
    words = ("-I", "-w", "-F", *(part for name in names for part in ("-e", name)), commit.parent, "--")
    try:
        if names and judgement.family == "upstream-api-change":
            lines = clone.read("grep", "-h", *words, "*.h*", "*.c*", "*.py", "*.i*").split("\n")
            defines = re.compile("|".join(_DEFINES.format(re.escape(name)) for name in names))
            return not any(defines.search(line) for line in lines)
        if names and judgement.family in ("missing-package-dep", "undeclared-message-dep"):
            files = clone.read("grep", "-l", *words, *(package["path"] for package in packages)).split()
            texts = ("package.xml", ".md", ".rst", ".txt")
            return any(not file.endswith(texts) or "CMakeLists" in file for file in files)
    except subprocess.CalledProcessError:
        return False
    return True


def mine(clone: Clone, since: str, per_family: int, seed: int) -> list[dict]:
    """Candidates of one repository: at most `per_family` of each guessed family, drawn with a seed so that those with
    stronger signs are likelier, recent ones too. Each is a record of facts and guesses, ready for a line of JSON."""
    chance = random.Random(f"{seed} {clone.name}")
    commits = [c for c in list_commits(clone, since) if any(is_built(path) for path in c.files)]
    if len(commits) > MOST_DIFFS:
        commits = [c for c in commits if _MESSAGE.search(c.message)]
        commits = chance.sample(commits, min(len(commits), MOST_DIFFS))
    families: dict[str, list[tuple[float, Commit, Judgement]]] = defaultdict(list)
    for commit, changes in read_changes(clone, commits):
        judgement = judge(commit, changes)
        if judgement:
            likely = 2.0 ** (judgement.weight - 4) * (2 if commit.date >= "2022" else 1)
            families[judgement.family].append((chance.random() ** (1 / likely), commit, judgement))
    records = []
    for family, found in sorted(families.items()):
        kept = 0
        for _, commit, judgement in sorted(found, key=lambda item: (-item[0], item[1].fix)):
            packages, ros = find_packages(clone, commit.parent, commit.files)
            if kept < per_family and packages and is_supported(clone, commit, judgement, packages):
                kept += 1
                records.append(
                    {
                        "id": f"{clone.name.split('/')[1]}-{commit.fix[:8]}",
                        "repo": clone.name,
                        "fix": commit.fix,
                        "parent": commit.parent,
                        "date": commit.date,
                        "ros": ros,
                        "packages": packages,
                        "files": list(commit.files),
                        "guessed_family": family,
                        "guessed_names": list(judgement.names),
                        "weight": judgement.weight,
                    }
                )
            elif kept >= per_family:
                break
    return records


def select(records: list[dict], number: int, seed: int, share_recent: float, share_ros2: float) -> list[dict]:
    """At most `number` of the candidates in shuffled order, so that at least `share_recent` are of 2022 or later and
    `share_ros2` of ROS 2, as far as there are enough. Repositories take turns, and within a repository the guessed
    families; of a family the candidates with stronger signs are likelier."""
    chance = random.Random(seed)
    turns: dict[str, Counter[str]] = defaultdict(Counter)
    order = []
    for record in sorted(records, key=lambda r: -(chance.random() ** (2.0 ** (4 - r["weight"])))):
        of_family = turns[record["repo"]]
        order.append((of_family[record["guessed_family"]], record["weight"] < 5, chance.random(), record))
        of_family[record["guessed_family"]] += 1
    of_repo: Counter[str] = Counter()
    queue = []
    for *key, record in sorted(order, key=lambda item: item[:3]):
        queue.append((of_repo[record["repo"]], *key, record))
        of_repo[record["repo"]] += 1
    chosen, old, ros1 = [], 0, 0
    for *_, record in sorted(queue, key=lambda item: item[:4]):
        is_old, is_ros1 = record["date"] < "2022", record["ros"] != 2
        fits = old + is_old <= number * (1 - share_recent) and ros1 + is_ros1 <= number * (1 - share_ros2)
        if fits and len(chosen) < number:
            chosen.append(record)
            old, ros1 = old + is_old, ros1 + is_ros1
    chance.shuffle(chosen)
    return chosen
