"""What a version of a package offers to CMake and at run time: targets, headers, commands, programs, plugins, launch
files; and what changed.

All of it is read from the build of one repository state. What hangs on a condition, or on what only CMake knows, is
marked or listed as unknown, never guessed.
"""

from __future__ import annotations

import fnmatch
import posixpath
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import msgspec

from ...impact.facts.cmake import CMakeFile
from ...impact.facts.kinds import HEADER_ENDINGS
from ...impact.facts.kinds import find_kind as kind_by_name
from ...impact.facts.launch.actions import Action, find_literal
from ...impact.model.cmake.build import Install, is_for_tests
from ...impact.model.cmake.installed import list_copied_files
from ...impact.model.flow.started import classify_launch_file
from ...impact.model.package import find_folder_role
from ...impact.targets.surface.fields import make_snake_case
from ...impact.targets.surface.surface import (
    BuildSurface,
    ExportedTarget,
    Header,
    InstalledLaunchFile,
    InstalledProgram,
    Plugin,
)

if TYPE_CHECKING:
    from ...impact.model.workspace import Package, Workspace

KINDS = frozenset((
    "manifest", "manifest_variant", "cmake", "setup_py", "setup_cfg", "pyproject", "plugin_xml", "xml",
    "msg", "srv", "action", "idl",
))  # fmt: skip
"""The kinds of facts that a surface of the build needs."""


def build_surface(workspace: Workspace, package: Package) -> BuildSurface:
    """The surface of a package as the state of the workspace builds it. The workspace needs no facts besides KINDS;
    its tree is read for the arguments of launch files."""
    return _Surface(workspace, package).make_surface()


_CONFIGURATION = re.compile(r"(.+?)(?:-config|Config)\.cmake(?:\.in)?\Z")
_LIBRARIES = frozenset(("library", "interface", "module", "imported", "generated", "external"))
# Where files that are made while building lie.
_BUILT = ("${CMAKE_BINARY_DIR}", "${CATKIN_DEVEL_PREFIX}")
_FOLLOWED = 30


class _Surface:
    def __init__(self, workspace: Workspace, package: Package):
        self.workspace, self.package, self.build = workspace, package, package.build
        self.prefix = f"{package.path}/" if package.path else ""
        self.name = self.build.project or package.name
        self.unknown: dict[tuple[str, str], None] = {}
        self.targets = {target.name: target for target in self.build.targets}
        # Packages of catkin that DEPENDS names are taken for CATKIN_DEPENDS.
        self.of_catkin = frozenset(found.name for found in self.build.found if found.how == "catkin")
        self.installs = [install for install in self.build.installs if not is_for_tests(install.conditions)]
        self.exports = [export for export in self.build.exports if not is_for_tests(export.conditions)]
        self.generated = [made for made in self.build.generated if made.offered]
        self.folders = [made for made in self.build.made if made.endswith("/")]  # that CMake makes or copies into

    def make_surface(self) -> BuildSurface:
        package, manifest = self.package, self.package.manifest
        commands, variables = self.collect_extras()
        targets = tuple(self.list_exported_targets())
        return BuildSurface(
            package.name,
            manifest.version,
            package.build_type,
            tuple(self.list_cmake()),
            targets,
            _deduplicate(self.list_libraries()),
            _deduplicate(self.list_roots()),
            _deduplicate(self.list_dependencies()),
            _deduplicate(e.item for e in self.exports if e.how == "system_depends" and e.item not in self.of_catkin),
            tuple(sorted(commands)),
            tuple(sorted(variables)),
            max((target.standard for target in targets), default=0),
            tuple(
                sorted(set(self.list_programs()), key=msgspec.structs.astuple)
            ),  # what is sure comes last, and counts
            tuple(sorted(set(self.list_plugins()), key=msgspec.structs.astuple)),
            tuple(self.list_launch_files()),
            tuple(sorted(set(self.list_headers()), key=msgspec.structs.astuple)),
            tuple(self.unknown),
        )

    def strip_prefix(self, path: str) -> str:
        return path.removeprefix(self.prefix)

    def note(self, part: str, why: str) -> None:
        self.unknown[part, why] = None

    # -- CMake

    def list_cmake(self) -> Iterator[str]:
        if self.build.ament_package is not None or self.build.catkin_package is not None:
            yield self.name
        given = {posixpath.basename(item) for install in self.installs for item in install.items}
        found = set()
        for file in self.build.files:
            if not file.startswith(self.prefix):
                continue
            for command in self.get_commands(file):
                if command.name in ("configure_package_config_file", "configure_file") and len(command.arguments) > 1:
                    given.update(posixpath.basename(a.text) for a in command.arguments[:2])
        for text in given:
            made = _CONFIGURATION.match(text.replace("${PROJECT_NAME}", self.name).replace("@PROJECT_NAME@", self.name))
            if made is not None and not made[1].startswith("$") and made[1] != self.name:
                found.add(made[1])
            elif made is not None and made[1] == self.name and not self.build.ament_package:
                found.add(self.name)
        yield from sorted(found - ({self.name} if self.build.catkin_package is not None else set()))

    def list_exported_targets(self) -> Iterator[ExportedTarget]:
        """Targets of export sets that install(EXPORT) or ament_export_targets() give away."""
        spaces: dict[str, tuple[str, bool]] = {}
        for export in self.exports:
            if export.how == "ament_export_targets":
                spaces[export.item] = (export.context or f"{self.name}::", not export.conditions)
        for install in self.installs:
            if install.kind == "export":
                for item in install.items:
                    spaces.setdefault(item, (install.namespace, not install.conditions))
        members: dict[str, bool] = {}
        seen: set[str] = set()
        for install in self.installs:
            if install.kind != "targets" or not install.export:
                continue
            seen.add(install.export)
            if install.export not in spaces:
                continue
            space, sure = spaces[install.export]
            for item in install.items:
                target = self.targets.get(item)
                kind = target.kind if target is not None else "unknown"
                name = f"{space}{(target.export_name if target is not None else '') or item}"
                if "$" in name:
                    self.note("targets", f"`{name}` is exported")
                elif name not in members:
                    certain = sure and not install.conditions and not (target is not None and target.conditions)
                    members[name] = certain
                    yield ExportedTarget(name, kind, target.public_standard if target is not None else 0, certain)
        for made in self.generated:
            if made.how == "rosidl":
                # The other type supports are those that are installed where the package is built.
                for support in ("rosidl_typesupport_c", "rosidl_typesupport_cpp"):
                    yield ExportedTarget(f"{self.name}::{made.target}__{support}", "generated", 0, not made.conditions)
                self.note("targets", f"`{self.name}::{made.target}__*` is generated")
        for missing in sorted(set(spaces) - seen):
            if not any(made.target == missing for made in self.generated):
                self.note("targets", f"the export set `{missing}`")

    def list_libraries(self) -> Iterator[str]:
        for export in self.exports:
            if export.how not in ("libraries", "ament_export_libraries"):
                continue
            if "$" in export.item:
                self.note("libraries", f"`{export.item}`")
            else:
                yield export.item

    def list_roots(self) -> Iterator[str]:
        """Folders of the prefix that dependants search for headers."""
        for export in self.exports:
            if export.how == "ament_export_include_directories" and "$" not in export.item:
                yield export.item.removeprefix("./").rstrip("/")
            elif export.how == "include_dirs":
                yield "include"
        for install in self.installs:
            yield from (one.rstrip("/") for one in install.includes if "$" not in one)
        for target in self.build.targets:
            for folder in target.installed_includes:
                root = folder.replace("${CMAKE_INSTALL_INCLUDEDIR}", "include").strip("/")
                if "$" not in root:
                    yield root

    def list_dependencies(self) -> Iterator[str]:
        for export in self.exports:
            of_catkin = export.how == "system_depends" and export.item in self.of_catkin
            if of_catkin or export.how in ("ament_export_dependencies", "catkin_depends"):
                yield export.item
        # In catkin the packages that messages come from are declared again; rosidl exports them by itself.
        yield from (name for made in self.generated if made.how == "rosidl" for name, _ in made.dependencies)

    # -- what the package's CMake files define

    def get_commands(self, path: str):
        """The commands of a CMake file of the workspace."""
        extraction = self.workspace.extraction
        if extraction.kinds.get(path) != "cmake":
            return ()
        file = extraction.get_facts(path).facts
        return file.commands if isinstance(file, CMakeFile) else ()

    def collect_extras(self) -> tuple[set[str], set[str]]:
        """Commands and variables that come with find_package()."""
        cmake = {path for path in self.package.linked.files if kind_by_name(path) == "cmake"}
        by_name: dict[str, list[str]] = {}
        for path in cmake:
            by_name.setdefault(re.sub(r"\.(?:in|em)\Z", "", posixpath.basename(path)), []).append(path)
        wanted: list[str] = []
        for export in self.exports:
            if export.how == "cfg_extras":
                wanted += self.find_extra_file(export.item, cmake, by_name)
        for path in cmake:
            if _CONFIGURATION.match(posixpath.basename(path)) and find_folder_role(self.strip_prefix(path)) is None:
                wanted.append(path)
        commands: set[str] = set()
        variables: set[str] = set()
        read: set[str] = set()
        while wanted and len(read) < _FOLLOWED:
            path = wanted.pop(0)
            if path in read:
                continue
            read.add(path)
            inner = 0
            for command in self.get_commands(path):
                arguments = [a.text.replace("@PROJECT_NAME@", self.name) for a in command.arguments]
                first = arguments[0] if arguments else ""
                if command.name in ("function", "macro"):
                    inner += 1
                    if "$" in first or "@" in first:
                        self.note("commands", f"`{first}` is defined")
                    elif first and not first.startswith("_"):
                        commands.add(first.lower())
                elif command.name in ("endfunction", "endmacro"):
                    inner -= 1
                elif inner > 0:
                    continue
                elif command.name == "set" and first and not re.search(r"[$@]", first) and not first.startswith("_"):
                    variables.add(first)
                elif command.name == "include" and first:
                    wanted += by_name.get(posixpath.basename(first), ())
                elif any("FIND_COMPONENTS" in argument for argument in arguments):
                    self.note("targets", "what there is hangs on COMPONENTS")
        return commands, variables

    def find_extra_file(self, item: str, cmake: set[str], by_name: dict[str, list[str]]) -> list[str]:
        """The file of the package that an extra is made from."""
        for path in (item, f"{item}.in", f"{item}.em"):
            if path in cmake:
                return [path]
        found = by_name.get(re.sub(r"\.(?:in|em)\Z", "", posixpath.basename(item)), [])
        if len(found) != 1:
            self.note("commands", f"`{item}` comes with it")
        return found[:1]

    # -- headers

    def list_headers(self) -> Iterator[Header]:
        roots = sorted({*self.list_roots(), "include"}, key=len, reverse=True)
        for install in self.installs:
            destination = posixpath.normpath(install.destination.replace("${CMAKE_INSTALL_INCLUDEDIR}", "include"))
            if "$" in destination and install.kind in ("files", "directory"):
                if any(item.endswith(HEADER_ENDINGS) or item.rstrip("/").endswith("include") for item in install.items):
                    self.note("headers", f"`{install.destination}` is where they go")
                continue
            if not f"{destination}/".startswith("include/") or install.kind not in ("files", "directory", "programs"):
                continue
            sure = not install.conditions
            for source, installed in self.list_copied_files(install, destination):
                if installed.endswith(HEADER_ENDINGS):
                    include, certain = _find_include_path(installed, roots)
                    yield Header(include, installed, source, sure and certain)
        yield from self.list_generated_headers(roots)

    def list_copied_files(self, install: Install, destination: str) -> Iterator[tuple[str, str]]:
        """(source, path in the prefix) of the files that an install rule copies."""
        for item in install.items:
            made = install.kind != "directory" and item.startswith(_BUILT)
            if made:
                yield "", f"{destination}/{install.rename or posixpath.basename(item)}"
            elif "$" in item:
                self.note("headers" if destination.startswith("include") else "launches", f"`{item}` is installed")
            elif install.kind == "directory" and any(f"{item.rstrip('/')}/".startswith(one) for one in self.folders):
                self.note("headers", f"`{item}` is filled while CMake runs")
        for path, installed in list_copied_files(install, destination, self.package.linked.files):
            yield self.strip_prefix(path), installed

    def list_generated_headers(self, roots: list[str]) -> Iterator[Header]:
        for made in self.generated:
            sure = not made.conditions
            for path in made.files if made.how != "protobuf" else ():
                stem, ending = posixpath.splitext(posixpath.basename(path))
                if made.how == "rosidl":
                    folder = posixpath.basename(posixpath.dirname(path)) or ending.lstrip(".")
                    for end in (".hpp", ".h"):
                        yield _make_header(f"{self.name}/{folder}/{make_snake_case(stem)}{end}", sure)
                elif made.how == "catkin":
                    for end in _ROS1.get(ending, ()):
                        yield _make_header(f"{self.name}/{stem}{end}.h", sure)
                elif made.how == "reconfigure":
                    yield _make_header(f"{self.name}/{stem}Config.h", sure)
            if made.how == "parameters":
                yield _make_header(f"{self.name}/{made.target}.hpp", False)
                yield _make_header(f"{made.target}.hpp", False)
            elif made.how == "protobuf":
                self.note("headers", f"`{made.target}` is generated")

    # -- programs, plugins, launch files

    def list_programs(self) -> Iterator[InstalledProgram]:
        package = self.package
        places = ("bin", f"lib/{package.name}", f"lib/{self.name}")
        components = {export.executable for export in self.exports if export.how == "component" and export.executable}
        for install in self.installs:
            destination = install.destination.rstrip("/").replace("${PROJECT_NAME}", self.name)
            if "$" in destination and install.kind in ("targets", "programs"):
                self.note("programs", f"`{install.destination}` is where they go")
            if destination not in places:
                continue
            sure = not install.conditions
            for item in install.items:
                target = self.targets.get(item)
                if install.kind == "targets" and target is not None and target.kind == "executable":
                    how = "component" if item in components else "binary"
                    yield InstalledProgram(target.output_name or item, destination, how, sure and not target.conditions)
                elif install.kind in ("programs", "files") and "$" not in item:
                    name = install.rename or posixpath.basename(item)
                    if install.kind == "programs" or item.endswith(".py"):
                        yield InstalledProgram(name, destination, "script", sure)
            if install.kind == "directory":
                for _, installed in self.list_copied_files(install, destination):
                    yield InstalledProgram(posixpath.basename(installed), destination, "script", False)
        if package.build_type == "ament_python" or any(i.kind == "python" for i in self.installs):
            yield from self.list_entry_points()

    def list_entry_points(self) -> Iterator[InstalledProgram]:
        files = {path: file for path, file in self.package.linked.setup}
        folders = (folder for f in files.values() for command, folder, _ in f.script_folders if command == "install")
        place = next(folders, "bin").removeprefix("$base/")
        for name in ("setup.py", "setup.cfg", "pyproject.toml"):
            file = files.get(f"{self.prefix}{name}")
            if file is None:
                continue
            for entry, *_ in file.entry_points:
                yield InstalledProgram(entry, place, "entry point")
            for script in file.scripts:
                yield InstalledProgram(posixpath.basename(script), place, "script")
            for clause in file.unresolved:
                if clause.startswith(("entry_points", "scripts")):
                    self.note("programs", clause)
                elif clause.startswith("data_files"):
                    self.note("launches", clause)

    def list_plugins(self) -> Iterator[Plugin]:
        for path, plugin in self.package.linked.plugins:
            if find_folder_role(self.strip_prefix(path)) is None:
                yield Plugin(plugin.name or plugin.type, plugin.type, plugin.base)
        for export in self.exports:
            if export.how == "component" and "$" not in export.item:
                yield Plugin(export.item, export.item, "rclcpp_components", not export.conditions)

    def list_launch_files(self) -> Iterator[InstalledLaunchFile]:
        """Installed launch files, by the path below share/<package>."""
        found: dict[str, str] = {}
        share = (f"share/{self.package.name}", f"share/{self.name}")
        for install in self.installs:
            destination = install.destination.rstrip("/")
            if install.kind not in ("directory", "files", "programs"):
                continue
            if not f"{destination}/".startswith((f"{share[0]}/", f"{share[1]}/")):
                continue
            for source, installed in self.list_copied_files(install, destination):
                found[installed.split("/", 2)[2]] = source
        for path, file in self.package.linked.setup:
            if path not in (f"{self.prefix}setup.py", f"{self.prefix}setup.cfg"):
                continue
            for destination, pattern, _ in file.data_files:
                if f"{destination}/".startswith((f"{share[0]}/", f"{share[1]}/")):
                    wanted = re.compile(fnmatch.translate(pattern.replace("**/", "*")))
                    for source in map(self.strip_prefix, self.package.linked.files):
                        if wanted.match(source) and source.count("/") >= pattern.count("/"):
                            folder = destination.rstrip("/").split("/", 2)[2:]
                            found["/".join([*folder, posixpath.basename(source)])] = source
        for path, source in sorted(found.items()):
            kind = classify_launch_file(source)
            # A folder of Python holds more than launch files.
            if kind and ("launch" in path) and not path.endswith("__init__.py"):
                yield InstalledLaunchFile(path, tuple(self.list_launch_arguments(f"{self.prefix}{source}", kind)))

    def list_launch_arguments(self, path: str, kind: str) -> Iterator[tuple[str, str | None]]:
        for facts in self.workspace.extraction.look((path,), f"flow_{kind}").values():
            yield from launch_arguments(facts.actions)


def launch_arguments(actions: Iterable[Any]) -> Iterator[tuple[str, str | None]]:
    """Name and default of each argument that a launch file takes, as LaunchFile has them."""
    seen: set[str] = set()
    for action in _flatten_actions(actions):
        name = find_literal(action.get("name"))
        if action.kind != "argument" or name is None or name in seen or action.get("value") is not None:
            continue
        seen.add(name)
        default = action.get("default")
        text = find_literal(default)
        yield name, None if default is None else "?" if text is None else text


_ROS1 = {
    ".msg": ("",),
    ".srv": ("", "Request", "Response"),
    ".action": ("Action", "ActionGoal", "ActionResult", "ActionFeedback", "Goal", "Result", "Feedback"),
}


def _make_header(include: str, sure: bool) -> Header:
    return Header(include, f"include/{include}", "", sure)


def _flatten_actions(actions: Iterable[Action]) -> Iterator[Action]:
    for action in actions:
        yield action
        if action.kind == "group":
            yield from _flatten_actions(action.children)


def _find_include_path(installed: str, roots: list[str]) -> tuple[str, bool]:
    """What dependants write for a header: its path below the longest exported folder that leaves it in a folder, as
    they all are called after their package; and whether that is the longest folder of all. Roots come longest first."""
    rests = [installed[len(root) + 1 :] for root in roots if installed.startswith(f"{root}/")]
    chosen = next((rest for rest in rests if "/" in rest), rests[-1] if rests else installed)
    return chosen, not rests or chosen == rests[0]


def _deduplicate(items: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(items))


# -- what changed ------------------------------------------------------------------------------------------------------

