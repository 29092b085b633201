"""Which folders of a tree are packages, as colcon finds them, and which package a file belongs to.

Source: colcon-core 0.21, colcon-recursive-crawl 0.2.3, colcon-ros 0.5, colcon-cmake 0.2.30, colcon-metadata 0.3.1,
colcon-python-setup-py 0.2.9, colcon-defaults 0.2.9, colcon-package-selection 0.2.10. Ignore markers are the tree's
business: what they hide is in no tree.

Differences, so that no manifest is overlooked: colcon does not look below a plain CMake or Python package; catkin does,
and so do we, and `hidden_by` says where colcon would stop. A folder that holds only package_ROS1.xml and
package_ROS2.xml, to be copied by a script before the build, is a package, and so is one whose manifest is broken. A
package that is reached on two ways is generations where it really lies.
"""

import fnmatch
import posixpath
import re
from collections.abc import Iterable
from typing import Any

import msgspec

from ...edges.patterns import PatternError, compute_cost, matches
from ..facts.colcon import ColconFile
from ..facts.extract import ExtractedFacts
from ..facts.manifest import Manifest
from ..targets.default_distros import StatedVersion
from ..tree import PathProblem, Tree, normalize_path

_FILES = frozenset(
    ("package.xml", "CMakeLists.txt", "setup.py", "setup.cfg", "pyproject.toml", "colcon.pkg", "manifest.xml")
)
# Where workspaces that bring their own settings let COLCON_HOME and COLCON_DEFAULTS_FILE point, and colcon's own name.
_DEFAULTS = (".colcon/defaults.yaml", "defaults.yaml", "colcon_defaults.yaml")
_VARIANT = re.compile(
    r"package[._-]?(?:[\w-]*[._-])?(?:ros|v)?[._-]?([12])\.xml$|package\.xml[._-](?:ros|v)?[._-]?([12])$", re.I
)
# Where the name of a Python package is looked for, in this order.
_PYTHON_NAMES = {
    "setup.cfg": "colcon_setup_cfg", "setup.py": "colcon_setup_py", "pyproject.toml": "colcon_pyproject",
}  # fmt: skip
# How many globs of base-paths are tried on every folder, and what matching names with regular expressions may cost.
_GLOBS_AT_MOST = 100
_MATCHING_AT_MOST = 5_000_000
_DEPENDENCY_KEYS = ("dependencies", "build-dependencies", "run-dependencies", "test-dependencies")


class PackagePlace(msgspec.Struct, frozen=True, gc=False):
    """A package's folder.

    path: relative to the tree, `` for its root. manifest_path: its package.xml, or the variant that stands in for it
    (the one for ROS 2 where there is one), empty for a package without manifest.
    name: as colcon calls it; the folder's name where nothing tells. kind: `ros`, or `cmake` and `python` for packages
    without manifest, or the type that colcon.pkg or colcon.meta sets.
    variants: (ROS generation, path) of package_ROS1.xml and the like beside the manifest. nested: manifests below,
    which are no packages. repository: the git repository the folder lies in, relative to the tree, None without one.
    hidden_by: name of the package without manifest around it, below which colcon, unlike catkin, does not look.
    extra_dependencies: names that colcon.pkg or colcon.meta adds. ignored: why colcon leaves the package out, or empty.
    """

    path: str
    manifest_path: str
    name: str
    kind: str = "ros"
    variants: tuple[tuple[int, str], ...] = ()
    nested: tuple[str, ...] = ()
    repository: str | None = None
    hidden_by: str = ""
    extra_dependencies: tuple[str, ...] = ()
    ignored: str = ""


class Discovered:
    """What was found.

    packages: with a manifest, sorted by path. foreign: without. ignored: found, and left out as colcon is told to.
    duplicates: (name, path, path) of packages of one name, which colcon refuses to build. problems: configuration files
    that could not be read. lists_repositories: a file of vcstool or wstool names sources that are put beside these, or
    they are submodules that are not checked out.
    """

    def __init__(
        self, places: Iterable[PackagePlace], problems: Iterable[PathProblem] = (), lists_repositories: bool = False
    ):
        every = sorted(places, key=lambda place: place.path)
        self.packages = tuple(place for place in every if place.manifest_path and not place.ignored)
        self.foreign = tuple(place for place in every if not place.manifest_path and not place.ignored)
        self.ignored = tuple(place for place in every if place.ignored)
        self.problems = tuple(problems)
        self.lists_repositories = lists_repositories
        first: dict[str, str] = {}
        duplicates = []
        for place in (*self.packages, *self.foreign):
            if place.name in first:
                duplicates.append((place.name, first[place.name], place.path))
            first.setdefault(place.name, place.path)
        self.duplicates = tuple(duplicates)
        self._owners: dict[str, PackagePlace | None] = {"": None}
        self._owners.update((place.path, place) for place in self.packages)

    @property
    def repositories(self) -> dict[str, str | None]:
        """The git repository of each package, by the package's path; both relative to the tree."""
        return {place.path: place.repository for place in (*self.packages, *self.foreign)}

    def find_owner(self, path: str) -> PackagePlace | None:
        """The innermost of `packages` that a file or folder lies in; None where there is none."""
        owners = self._owners
        if path in owners:
            return owners[path]
        folder = path
        passed = []
        while True:
            folder = folder.rpartition("/")[0]
            if folder in owners:
                break
            passed.append(folder)
        owner = owners[folder]
        for known in passed:
            owners[known] = owner
        return owner



# What stands for a name in templates of cookiecutter, Jinja, CMake, empy and shells; colcon passes over such packages.
_PLACEHOLDER = re.compile(r"[{}$@<>%]")
REPOSITORY_LISTS = (".repos", ".rosinstall")
"""How files of vcstool and wstool end, which name repositories and their versions."""


def discover(tree: Tree, extraction: ExtractedFacts) -> Discovered:
    """Finds the packages of a tree from its paths and the facts of its manifests.

    A manifest without a usable name still makes a package, so that what is wrong with it can be generations; one that
    could not be read at all makes none, and is among the problems of `extraction`.
    """
    return _Search(tree, extraction).run()


class _Search:
    def __init__(self, tree: Tree, extraction: ExtractedFacts):
        self.tree = tree
        self.extraction = extraction
        extraction.preload(extraction.list_paths("manifest", "manifest_variant"))
        self.problems: list[PathProblem] = []
        self.unmatched: set[PathProblem] = set()
        self.files: dict[str, set[str]] = {}
        self.lists_repositories = any(problem.is_submodule for problem in tree.problems)
        for entry in tree.list_entries():
            folder, _, name = entry.path.rpartition("/")
            self.lists_repositories = self.lists_repositories or name.endswith(REPOSITORY_LISTS)
            if name in _FILES or (name[:7].lower() == "package" and _VARIANT.match(name)):
                self.files.setdefault(folder, set()).add(name)
        self.repositories = tree.repositories
        self.defaults = self._read_defaults()
        self.meta = self._read_meta()
        self.matching_left = _MATCHING_AT_MOST
        self.left_out = {
            key: (frozenset(_list_strings(names)), tuple(dict.fromkeys(_list_strings(patterns))), path, regex_path)
            for key in ("packages-ignore", "packages-skip")
            for names, path in (self.defaults.get(key, (None, "")),)
            for patterns, regex_path in (self.defaults.get(key + "-regex", (None, "")),)
        }

    def run(self) -> Discovered:
        found_bases, only = self._list_bases()
        bases = frozenset(found_bases)
        places: dict[str, PackagePlace] = {}
        foreign: dict[str, PackagePlace] = {}
        nested: dict[str, list[str]] = {}
        real_paths: set[str] = set()
        blocked: set[str] = set()
        # parents sort before their children; folders reached through a link come last, the real place has precedence
        order = sorted(self.files, key=lambda folder: (self._resolve_alias(folder) is not None, folder))
        for folder in order:
            names = self.files[folder]
            above = self._find_above(folder, places)
            if above is not None:
                if "package.xml" in names:
                    nested.setdefault(above, []).append(posixpath.join(folder, "package.xml"))
                continue
            if not (_is_crawled(folder, bases) or folder in only):
                continue
            real = self._resolve_alias(folder) or folder
            if real in real_paths:
                continue
            stop = self._find_above(folder, foreign)
            place = self._make_with_manifest(folder, names, "" if stop is None else foreign[stop].name)
            if place is not None:
                places[folder] = place
                real_paths.add(real)
            elif stop is None and self._find_above(folder, blocked) is None:
                if "manifest.xml" in names:
                    blocked.add(folder)  # rosbuild's; colcon leaves such a folder alone
                    continue
                place = self._make_without_manifest(folder, names)
                if place is not None:
                    foreign[folder] = place
                    real_paths.add(real)
        found = []
        for place in (*places.values(), *foreign.values()):
            inner, path, ignored = tuple(nested.get(place.path, ())), place.path, self._explain_ignored(place.name)
            repository = path if path in self.repositories else self._find_above(path, self.repositories)
            found.append(msgspec.structs.replace(place, nested=inner, repository=repository, ignored=ignored))
        return Discovered(found, self.problems, self.lists_repositories)

    def _find_above(self, folder: str, places: Iterable[str]) -> str | None:
        """The nearest of the places above the folder."""
        if not places:
            return None
        while folder:
            folder = folder.rpartition("/")[0]
            if folder in places:
                return folder
        return None

    def _resolve_alias(self, folder: str) -> str | None:
        """The real path of a folder that was reached through a link."""
        aliases = self.tree.aliases
        link = folder if aliases else ""
        while link and link not in aliases:
            link = link.rpartition("/")[0]
        return aliases[link] + folder[len(link) :] if link else None

    def _make_with_manifest(self, folder: str, names: set[str], hidden_by: str) -> PackagePlace | None:
        matches = ((name, _VARIANT.match(name)) for name in names)
        variants = sorted((int(m[1] or m[2]), posixpath.join(folder, name)) for name, m in matches if m)
        usual = "package.xml" in names
        path = posixpath.join(folder, "package.xml") if usual else variants[-1][1] if variants else ""
        manifest = find_manifest(self.extraction, path)
        if manifest is None or not (usual or manifest.name):
            return None
        given = self._read_settings(folder, names)
        name = _convert_to_text(given.get("name")) or manifest.name or _get_folder_name(folder, self.tree)
        given = {**self.meta[0].get(name, {}), **given}
        return PackagePlace(
            path=folder,
            manifest_path=path,
            name=name,
            kind=_convert_to_text(given.get("type")) or "ros",
            variants=tuple(variants),
            hidden_by=hidden_by,
            extra_dependencies=_list_extra_dependencies(given),
        )

    def _make_without_manifest(self, folder: str, names: set[str]) -> PackagePlace | None:
        given = self._read_settings(folder, names)
        kind = _convert_to_text(given.get("type"))
        name = _convert_to_text(given.get("name"))
        if kind in ("", "cmake") and "CMakeLists.txt" in names:
            found = self._read_project_name(folder)
            if found is None:
                return None
            kind, name = "cmake", name or found
        elif kind in ("", "python") and "setup.py" in names:
            found = self._read_python_name(folder, names)
            if not (name or found):
                return None
            kind, name = "python", name or found
        if not (kind and name):
            return None
        given = {**self.meta[0].get(name, {}), **given}
        return PackagePlace(folder, "", name, kind, extra_dependencies=_list_extra_dependencies(given))

    def _read_project_name(self, folder: str) -> str | None:
        """The name in project(), else the folder's; None for the file that catkin puts above all packages."""
        file = self._read(posixpath.join(folder, "CMakeLists.txt"), "colcon_cmake")
        return None if file.is_top else file.name or _get_folder_name(folder, self.tree)

    def _read_python_name(self, folder: str, names: set[str]) -> str:
        for name, kind in _PYTHON_NAMES.items():
            if name in names and (found := self._read(posixpath.join(folder, name), kind).name):
                return found
        return ""

    def _read(self, path: str, kind: str) -> ColconFile:
        for file in self.extraction.look((path,), kind, on_error=self._note_unreadable).values():
            return file
        return ColconFile()

    def _note_unreadable(self, path: str, error: OSError) -> None:
        self.problems.append(PathProblem(path, f"cannot be read: {(error.strerror or '').lower()}"))

    def _read_yaml(self, path: str) -> dict[str, Any]:
        file = self._read(path, "colcon_settings")
        self.problems += [
            PathProblem(path, f"{problem.message}, so colcon's settings in it are not known")
            for problem in file.problems
        ]
        return file.settings

    def _read_defaults(self) -> dict[str, Any]:
        """Colcon's default arguments for building, from the files a workspace keeps them in."""
        merged: dict[str, Any] = {}
        for path in _DEFAULTS:
            if not self.tree.exists(path):
                continue
            data = self._read_yaml(path)
            for verb in ("", "build"):
                section = data.get(verb)
                if isinstance(section, dict):
                    merged.update((str(key), (value, path)) for key, value in section.items())
        return merged

    def _read_meta(self) -> tuple[dict[str, dict], dict[str, dict]]:
        """(by package name, by path) of the workspace's colcon.meta files."""
        by_name: dict[str, dict] = {}
        by_path: dict[str, dict] = {}
        wanted = [*_list_strings(self.defaults.get("metas", (None, ""))[0])] or ["colcon.meta"]
        for name in wanted:
            path = normalize_path(name)
            if path is None or not self.tree.exists(path):
                continue
            if self.tree.is_dir(path):
                path = posixpath.join(path, "colcon.meta")
                if not self.tree.exists(path):
                    continue
            data = self._read_yaml(path)
            for key, into in (("names", by_name), ("paths", by_path)):
                section = data.get(key)
                for subject, values in section.items() if isinstance(section, dict) else ():
                    place = str(subject) if key == "names" else normalize_path(str(subject))
                    if place is not None and isinstance(values, dict):
                        into.setdefault(place, {}).update(values)
        return by_name, by_path

    def _read_settings(self, folder: str, names: set[str]) -> dict[str, Any]:
        """What colcon.pkg and colcon.meta say of a folder; the latter weighs more."""
        given = self._read_yaml(posixpath.join(folder, "colcon.pkg")) if "colcon.pkg" in names else {}
        return {**given, **self.meta[1].get(folder, {})}

    def _list_bases(self) -> tuple[list[str], set[str]]:
        """(folders that are searched, folders that are only looked at themselves)."""
        bases, path = self.defaults.get("base-paths", (None, ""))
        only, _ = self.defaults.get("paths", (None, ""))
        return self._list_folders(bases, path) or [""], set(self._list_folders(only, path))

    def _list_folders(self, patterns: Any, path: str) -> list[str]:
        found = []
        globs = 0
        for pattern in dict.fromkeys(_list_strings(patterns)):
            clean = normalize_path(pattern)
            if clean is None:
                self.problems.append(PathProblem(path, f"`{pattern}` lies outside of the workspace and is not read"))
            elif re.search(r"[*?\[]", clean):
                globs += 1
                if globs > _GLOBS_AT_MOST:
                    self.problems.append(PathProblem(path, f"more than {_GLOBS_AT_MOST} globs, the rest is left out"))
                    break
                levels = clean.count("/")
                found += sorted({
                    folder
                    for each in self.files
                    for folder in ("/".join(each.split("/")[: levels + 1]),)
                    if folder.count("/") == levels and fnmatch.fnmatchcase(folder, clean)
                })  # fmt: skip
            else:
                found.append(clean)
        return found

    def _explain_ignored(self, name: str) -> str:
        if _PLACEHOLDER.search(name):
            return f"its name, `{name}`, is a placeholder: a template that packages are made of"
        for key, (names, patterns, path, regex_path) in self.left_out.items():
            if name in names:
                return f"{key} in {path}"
            if any(self._matches(pattern, name, f"{key}-regex", regex_path) for pattern in patterns):
                return f"{key}-regex in {regex_path}"
        return ""

    def _matches(self, pattern: str, name: str, key: str, path: str) -> bool:
        """Whether a regular expression of colcon's settings matches a package's name; what is not matched is named."""
        if self.matching_left < 0:
            return False
        try:
            self.matching_left -= compute_cost(pattern, name)
            if self.matching_left < 0:
                self.problems.append(PathProblem(path, f"{key}: takes too long, the rest of it is not matched"))
                return False
            return matches(pattern, name)
        except PatternError as error:
            problem = PathProblem(path, f"{key}: `{pattern[:80]}` is not matched: {error}")
            if problem not in self.unmatched:
                self.unmatched.add(problem)
                self.problems.append(problem)
            return False


def _is_crawled(folder: str, bases: frozenset[str]) -> bool:
    """True when colcon gets to a folder from one of the base paths: it enters no hidden folder."""
    while folder not in bases:
        above, _, name = folder.rpartition("/")
        if not folder or name.startswith("."):
            return False
        folder = above
    return True


def _get_folder_name(folder: str, tree: Tree) -> str:
    return folder.rpartition("/")[2] or tree.name


def _convert_to_text(value: Any) -> str:
    return value if isinstance(value, str) else ""


def _list_strings(value: Any) -> list[str]:
    if isinstance(value, str):
        return value.split()
    return [str(item) for item in value] if isinstance(value, (list, tuple)) else []


def _list_extra_dependencies(given: dict[str, Any]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(name for key in _DEPENDENCY_KEYS for name in _list_strings(given.get(key))))


def find_manifest(extraction: ExtractedFacts, path: str) -> Manifest | None:
    """What a manifest says; None where there is none, or it could not be read."""
    if path not in extraction.kinds:
        return None
    facts = extraction.get_facts(path).facts
    return facts if isinstance(facts, Manifest) else None


def list_versions(discovered: Discovered, extraction: ExtractedFacts) -> list[StatedVersion]:
    """The packages of a tree, each with the version that its manifest states."""
    manifests = ((place, find_manifest(extraction, place.manifest_path)) for place in discovered.packages)
    return [
        StatedVersion(place.path, place.repository, place.name, manifest.version)
        for place, manifest in manifests
        if manifest is not None
    ]


def detect_generation(discovered: Discovered, extraction: ExtractedFacts) -> int:
    """1 or 2: which ROS generation most packages of the tree are written for, 2 where none tells."""
    manifests = (find_manifest(extraction, place.manifest_path) for place in discovered.packages)
    generations = [ros for manifest in manifests if manifest is not None and (ros := _classify_generation(manifest))]
    return 1 if generations.count(2) * 2 < len(generations) else 2


def _classify_generation(manifest: Manifest) -> int:
    """1 or 2, what a manifest's build tools tell; 0 for plain CMake, which either may have. Packages for both are
    taken to be written for 2."""
    names = {d.name for d in manifest.dependencies} | {t for t, _ in manifest.build_types}
    if any(name.startswith("ament") or name == "ros2" for name in names):
        return 2
    return 1 if "catkin" in names or not manifest.build_types else 0
