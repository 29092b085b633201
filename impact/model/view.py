"""A workspace as one target sees it: what holds there, what is declared there, who provides what is used.

This is the join that most rules ask: model by target. Nothing here reads files.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator
from functools import cached_property, lru_cache
from typing import NamedTuple

from ..config import Config
from ..facts.condition import Condition
from ..targets.changes import transitive_includes
from ..targets.library import include_roots
from ..targets.stdlib import ever_stdlib, stdlib
from ..targets.target import Change, Provider, Target
from .build import At, Found
from .conditions import Environment, all_hold
from .package import role_of_folder
from .spelling import Names
from .workspace import Package, Workspace, snake

# Dependency kinds whose packages a machine has once the package itself is installed (bloom's mapping to Debian's
# Depends).
_INSTALLED_WITH = frozenset({"exec", "build_export", "buildtool_export"})
# Kinds that are on the machine that builds the package from source.
_BUILT_WITH = frozenset({"build", "buildtool", "build_export", "buildtool_export", "exec", "test", "doc"})
# On every machine that builds ROS packages (ros_buildfarm's base image and the dependencies of catkin and ament).
_ALWAYS = frozenset({
    "build-essential", "cmake", "pkg-config", "python", "python3", "python-dev", "python3-dev", "git", "g++-static",
    "libc6-dev",
})  # fmt: skip


class Need(NamedTuple):
    """Something a package uses of somebody else.

    how: find_package, component, pkg-config, include, import, launch, plugin or shell. subject: as written.
    providers: who could give it, best first. role: build, test, run or aside. certain: stands under no condition that
    is unknown on the target. required: its absence stops the configuration (find_package) or the program.
    """

    how: str
    subject: str
    providers: tuple[Provider, ...]
    at: At
    role: str
    certain: bool
    required: bool = True
    public: bool = False
    targets: tuple[str, ...] = ()


class Misnamed(NamedTuple):
    """Why an include path cannot be right, and what to write."""

    message: str
    help: str


# Metapackages whose name other packages' headers begin with (ros/ros.h is roscpp's).
_UMBRELLAS = frozenset({"ros", "moveit", "ecl", "pcl", "opencv2", "gazebo", "boost", "rtt", "visp", "flann"})
# Headers that the package's build writes from templates in some releases.
_GENERATED = ("rclcpp/node_interfaces/", "rclcpp/logging.hpp")
# System packages so broad that they bring half of ROS along.
_BROAD = frozenset({"mrpt"})
_CAMEL = re.compile(r"[A-Z][A-Za-z0-9]*\Z")

_UNCONFIGURED = Config()


class View:
    """One workspace on one target. providers answers for everything outside the workspace."""

    def __init__(self, workspace: Workspace, target: Target, providers, config: Config = _UNCONFIGURED):
        self.workspace, self.target, self.providers, self.config = workspace, target, providers, config
        self._closures: dict[tuple[str, frozenset[str]], dict[str, str]] = {}
        self._brought: dict[str, dict[str, str]] = {}
        self._needs: dict[str, tuple[Need, ...]] = {}
        self._headers: dict[str, tuple[Provider, ...]] = {}
        self._cmake: dict[str, tuple[Provider, ...]] = {}
        self._modules: dict[str, tuple[Provider, ...]] = {}
        self._debian: dict[str, frozenset[str]] = {}
        self._held: dict[tuple[Condition, ...], bool | None] = {}
        self._reached: dict[int, tuple[object, frozenset[str], set[str]]] = {}
        self._standard: dict[str, bool] = {}
        self._lost: dict[str, Misnamed | None] = {}
        self.unresolved: dict[str, set[str]] = {"include": set(), "cmake": set(), "import": set()}

    def __iter__(self) -> Iterator[Package]:
        """Packages of the workspace that are built on this target."""
        for package in self.workspace:
            if package.build_type.startswith("ament") and self.target.ros == 1:
                continue
            if package.build_type == "catkin" and self.target.ros == 2:
                continue
            yield package

    # -- conditions --------------------------------------------------------------------------------------------------

    @cached_property
    def environment(self) -> Environment:
        """What conditions are evaluated against."""
        target = self.target

        def version(name: str) -> str | None:
            return target.version(name) or target.library(name.lower())

        return Environment(
            ros_distro=target.distro,
            ros_version=str(target.ros),
            python=(2, 7) if target.python_major == 2 else (3, target.python) if target.python else None,
            codename=target.platform.split(" ")[-1],
            versions=version,
            headers=self._has_header,
            testing=True,
        )

    def _has_header(self, path: str) -> bool | None:
        """Whether the compiler finds a header on the target, for __has_include; None when that is not known."""
        if self.workspace.provides_header(path):
            return True
        for change in self.changes("header-renamed", "header-moved", "header-removed"):
            if change.old == path and change.state in ("removed", "deprecated"):
                return change.state == "deprecated"
            if change.new == path:
                return change.state != "absent"
        known = {
            self.providers.has_header(p.name, path, self.target.distro, version)
            for p in self.header(path) if p.kind == "ros" and (version := self.target.version(p.name))
        }  # fmt: skip
        return True if True in known else False if known == {False} else None

    def active(self, conditions: Iterable[Condition]) -> bool:
        """False only when a statement under these conditions surely does not count on the target."""
        conditions = tuple(conditions)
        return not conditions or self._hold(conditions) is not False

    def certain(self, conditions: Iterable[Condition]) -> bool:
        """True only when a statement under these conditions surely counts on the target."""
        conditions = tuple(conditions)
        return not conditions or self._hold(conditions) is True

    def _hold(self, conditions: tuple[Condition, ...]) -> bool | None:
        if conditions not in self._held:
            self._held[conditions] = all_hold(conditions, self.environment)
        return self._held[conditions]

    def active_manifest(self, condition: str) -> bool:
        """False only when the condition attribute of a dependency surely does not hold on the target."""
        return self.active((Condition("manifest", condition),))

    def manifest_place(self, package: Package, dependency) -> At:
        """Where a dependency is declared."""
        return At(package.digest.manifest_path, dependency.line, dependency.column)

    # -- what is known of the target -------------------------------------------------------------------------------

    @cached_property
    def known_names(self) -> Names:
        """Every name a manifest may declare here: packages of the workspace, released ones, rosdep keys."""
        return Names({*self.workspace.packages, *self.target.released_names(), *self.target.key_names()})

    def available(self, name: str) -> bool:
        """True when a package of this name is in the workspace, released on the target, or a rosdep key there."""
        target = self.target
        return name in self.workspace.packages or target.version(name) is not None or target.resolve(name) is not None

    @property
    def transitive(self):
        """Headers that compilers and libraries stopped bringing along, see targets/changes.py."""
        return transitive_includes()

    def successor(self, name: str) -> str:
        """What the known-changes table says to use instead of a package, as a cure; empty when it says nothing."""
        for change in self.changes("package-renamed", "package-removed"):
            if change.new and name in (change.old, change.package):
                return f"depend on `{change.new}`"
        return ""

    def last_distro(self, name: str) -> str:
        """The newest distro that has released a package, empty when none has."""
        return self.target.last_distro(name)

    @property
    def underlaid(self) -> bool:
        """True when the configuration names underlays or .repos files, whose packages are not looked into."""
        return bool(self.config.underlays or self.config.repos)

    def private(self, name: str) -> bool:
        """True for packages that the configuration calls one's own."""
        return name in self.config.private

    def is_standard(self, header: str) -> bool:
        """True for headers of the C and C++ standard libraries and of the operating system."""
        known = self._standard.get(header)
        if known is None:
            known = self._standard[header] = any(not p.name for p in self.providers.header(header))
        return known

    def lost_header(self, path: str) -> Misnamed | None:
        """What is wrong when every released package that has, or had, a header lacks it in its version here."""
        if path not in self._lost:
            self._lost[path] = self._lost_header(path)
        return self._lost[path]

    def _lost_header(self, path: str) -> Misnamed | None:
        target = self.target
        if path in self.workspace.broken_headers:
            return Misnamed(f"no package of the workspace has or generates `{path}`", "")
        if self.providers.system_has(path, target.platform) is False and all(
            p.kind == "system" for p in self.header(path)
        ):
            return Misnamed(f"no package of {target.platform} has `{path}`", "")
        owners = [p.name for p in self.header(path) if p.kind == "ros" and p.name not in self.workspace.packages]
        if not owners or any(p.kind != "ros" for p in self.header(path)):
            return None
        lacking = []
        for name in owners:
            version = target.version(name)
            if version is None:
                continue
            has = self.providers.has_header(name, path, target.distro, version)
            if has is not False:
                return None
            lacking.append((name, version))
        if not lacking:
            return None
        name, version = lacking[0]
        if any(self.nested_header(owner, path) for owner, _ in lacking) or path.startswith(_GENERATED):
            return None
        if not any(
            self.providers.has_header(name, header, target.distro, version)
            for header, _ in self.providers.headers_of(name)
        ):
            return None  # a release without any header in its tree gets them while it is built
        spans = self.providers.header_history(name, path)
        if not spans:
            head, _, rest = path.partition("/")
            if rest.startswith(head + "/") and self.providers.has_header(name, rest, target.distro, version):
                return Misnamed(f"`{path}` is not installed by {name} {version}", f"include `{rest}`")
            return None
        other = self._renamed(name, path, version)
        return Misnamed(f"`{path}` is not in {name} {version}", f"include `{other}`" if other else "")

    def has_released_header(self, package: str, path: str) -> bool | None:
        """Whether the target's release of a package has a header; None when its tree is not known."""
        version = self.target.version(package)
        return self.providers.has_header(package, path, self.target.distro, version) if version else None

    def nested_header(self, package: str, path: str) -> bool:
        """True when the release has the header in a subfolder that it exports too (xmlrpcpp/XmlRpc.h as XmlRpc.h)."""
        version = self.target.version(package)
        return (
            "/" not in path
            and bool(version)
            and bool(self.providers.has_header(package, f"{package}/{path}", self.target.distro, version))
        )

    def _renamed(self, name: str, path: str, version: str) -> str:
        """The same header under another ending that the version has."""
        stem = path.rpartition(".")[0]
        for ending in (".hpp", ".h", ".hh"):
            other = stem + ending
            if other != path and self.providers.has_header(name, other, self.target.distro, version):
                return other
        return ""

    def misnamed_interface(self, path: str) -> Misnamed | None:
        """What is wrong with the spelling of a generated header on this target's generation, None when nothing is."""
        head, _, rest = path.partition("/")
        if not rest or not self._generates_interfaces(head):
            return None
        parts = rest.split("/")
        name = parts[-1].rsplit(".", 1)[0]
        if self.target.ros == 2:
            if len(parts) == 1 and path.endswith(".h") and _CAMEL.match(name) and "_" not in name:
                folder = "srv" if name.endswith(("Request", "Response")) else "msg"
                return Misnamed(f"`{path}` is the ROS 1 name of a generated header",
                                f"include `{head}/{folder}/{snake(name)}.hpp`")  # fmt: skip
            if len(parts) == 2 and parts[0] in ("msg", "srv", "action") and name != name.lower():
                return Misnamed(f"generated headers are in lower case, so there is no `{path}`",
                                f"include `{head}/{parts[0]}/{snake(name).replace('__', '_')}.hpp`")  # fmt: skip
        elif len(parts) == 2 and parts[0] in ("msg", "srv", "action") and path.endswith(".hpp"):
            return Misnamed(f"`{path}` is the ROS 2 name of a generated header", f"include `{head}/<Name>.h`")
        return None

    def _generates_interfaces(self, name: str) -> bool:
        package = self.workspace.packages.get(name)
        if package is not None:
            return package.is_interface_package
        if not name.endswith(("_msgs", "_interfaces", "_srvs", "_actions")):
            return False
        return self.target.version(name) is not None

    def libraries_of(self, name: str) -> list[str]:
        """Platform libraries whose version a rosdep key or CMake name stands for."""
        folded = name.lower().removeprefix("lib").removesuffix("-dev").removesuffix("-all")
        known = self.target.library_names()
        return [n for n in dict.fromkeys((name.lower(), folded, folded.rstrip("0123456789"))) if n in known]

    def left_python(self, module: str) -> bool:
        """True for modules that Python's standard library once had and the target's has no longer."""
        return ever_stdlib(module) and not stdlib(module, self.target.python, self.target.python_major)

    @cached_property
    def _changes(self) -> dict[str, list[Change]]:
        found: dict[str, list[Change]] = {}
        for change in self.target.changes():
            found.setdefault(change.kind, []).append(change)
        return found

    def changes(self, *kinds: str) -> list[Change]:
        """Known upstream changes of these kinds that are in force on the target."""
        return [c for kind in kinds for c in self._changes.get(kind, ())]

    @cached_property
    def later(self) -> dict[str, Change]:
        """Changes of platform libraries and Python that the newest distro of this generation has and the target has not
        yet: what breaks when this machine, or a colleague's, is updated. By old name."""
        horizon = self.target.newest()
        if horizon is None:
            return {}
        here = {(c.kind, c.package, c.old) for c in self.target.changes() if c.state == "removed"}
        return {
            c.old: c for c in horizon.changes()
            if c.state == "removed" and c.library and (c.kind, c.package, c.old) not in here
        }  # fmt: skip

    def later_active(self, conditions: Iterable[Condition]) -> bool:
        """False when a statement under these conditions surely does not count on the newest distro."""
        conditions = tuple(conditions)
        return not conditions or all_hold(conditions, self._later_environment) is not False

    @cached_property
    def _later_environment(self) -> Environment:
        newest = self.target.newest() or self.target

        def version(name: str) -> str | None:
            return newest.version(name) or newest.library(name.lower())

        return Environment(
            ros_distro=newest.distro, ros_version=str(newest.ros), python=(3, newest.python) if newest.python else None,
            codename=newest.platform.split(" ")[-1], versions=version, testing=True,
        )  # fmt: skip

    @property
    def horizon(self) -> str:
        """Name of the newest distro of this generation."""
        newest = self.target.newest()
        return newest.distro if newest is not None else ""

    def concerned(self, package: Package, change: Change, path: str) -> bool:
        """True when a file can mean the changed package by a name: the package declares or includes something of it."""
        head = change.package
        if path.endswith(".py") or change.kind.startswith("python"):
            return True
        names = self.closure(package)
        if head in names or (any(head in (p.name, p.package) for p in self.cmake(head)) and head in names):
            return True
        roots = include_roots(head)
        return any(i.path.startswith(roots) for i in package.digest.includes) if roots else head in names

    # -- declared dependencies -----------------------------------------------------------------------------------------

    def declared(self, package: Package) -> dict[str, set[str]]:
        """Names the package declares on this target, with the kinds they are declared as."""
        found: dict[str, set[str]] = {}
        for dependency in package.manifest.dependencies:
            if dependency.kind in ("conflict", "replace", "group", "member_of_group"):
                continue
            if dependency.condition and not self.active([Condition("manifest", dependency.condition)]):
                continue
            found.setdefault(dependency.name, set()).add(dependency.kind)
        return found

    def installed_with(self, name: str) -> Iterable[str]:
        """Direct dependencies that come with a package or key when it is installed."""
        package = self.workspace.packages.get(name)
        if package is not None:
            return [n for n, kinds in self.declared(package).items() if kinds & _INSTALLED_WITH]
        released = self.target.dependencies(name) or self.target.similar_dependencies(name)
        if released is None:
            return ()
        return [d.name for d in released if d.kind in _INSTALLED_WITH]

    def closure(self, package: Package, kinds: frozenset[str] = _BUILT_WITH) -> dict[str, str]:
        """Everything on a machine that has just what the package declares: name to the declared name that brings it."""
        key = (package.name, kinds)
        known = self._closures.get(key)
        if known is None:
            start = [n for n, k in self.declared(package).items() if k & kinds]
            known = dict.fromkeys(_ALWAYS, "")
            known[package.name] = package.name
            known.update(self.spread(start))
            self._closures[key] = known
        return known

    def spread(self, names: Iterable[str]) -> dict[str, str]:
        """Transitive closure of installed_with over names, each with the start it was reached from."""
        found = {n: n for n in names}
        queue = deque(found)
        while queue:
            name = queue.popleft()
            for other in self._installed_with(name):
                if other not in found:
                    found[other] = found[name]
                    queue.append(other)
        return found

    @cached_property
    def _direct(self) -> dict[str, tuple[str, ...]]:
        return {}

    def brought_by(self, name: str) -> dict[str, str]:
        """Everything that a single package or key brings along, itself included."""
        known = self._brought.get(name)
        if known is None:
            known = self._brought[name] = self.spread([name])
        return known

    def _installed_with(self, name: str) -> tuple[str, ...]:
        known = self._direct.get(name)
        if known is None:
            known = self._direct[name] = tuple(self.installed_with(name))
        return known

    def blind(self, package: Package) -> list[str]:
        """Declared packages whose own dependencies are not known anywhere, so that the closure may lack something."""
        target = self.target
        return [
            n for n in self.closure(package)
            if n not in self.workspace.packages and n not in _ALWAYS and target.resolve(n) is None
            and not target.known_key(n)  # a key that the platform lacks brings nothing
            and target.dependencies(n) is None and target.similar_dependencies(n) is None
        ]  # fmt: skip

    def debian(self, name: str) -> frozenset[str]:
        """What a rosdep key installs here."""
        known = self._debian.get(name)
        if known is None:
            resolution = self.target.resolve(name)
            known = self._debian[name] = frozenset(resolution.packages if resolution else ())
        return known

    def answered(self, providers: Iterable[Provider], names: dict[str, str] | dict[str, set[str]] | set[str]) -> bool:
        """True when one of the providers is among the names, as itself, as a key that installs the same package, or as
        the package that vendors it."""
        for provider in providers:
            if not provider.name or provider.name in names:
                return True
        vendored, installed = self._reach(names)
        for provider in providers:
            if vendored and not vendored.isdisjoint(_stems(provider.name)):
                return True
            if provider.package in installed or not installed.isdisjoint(self.debian(provider.name)):
                return True
        return False

    def _reach(self, names) -> tuple[frozenset[str], set[str]]:
        """What a set of names vendors, and the system packages that its keys install."""
        known = self._reached.get(id(names))
        if known is None or known[0] is not names:
            vendored = frozenset(
                n.removesuffix("_vendor").removeprefix("rviz_") for n in names if n.endswith("_vendor")
            )
            installed: set[str] = set()
            for name in names:
                if name not in self.workspace.packages:
                    installed |= self.debian(name)
            known = self._reached[id(names)] = (names, vendored, installed)
        return known[1], known[2]

    # -- who provides --------------------------------------------------------------------------------------------------

    def header(self, path: str) -> tuple[Provider, ...]:
        """Who could answer an include path; empty when nobody is known to, a nameless one when the compiler does."""
        known = self._headers.get(path)
        if known is None:
            known = self._headers[path] = tuple(self._header(path))
        return known

    def _header(self, path: str) -> list[Provider]:
        if "/" not in path and self.is_standard(path):
            return [Provider("system", "")]
        own = self.workspace.provides_header(path)
        head = path.split("/", 1)[0]
        if (
            own
            and head not in own
            and path not in self.workspace.rooted_headers
            and self.target.version(head) is not None
        ):
            own = []  # a file of the workspace ends like this by chance
        if own:
            return [Provider("ros", name) for name in own]
        found = list(self.providers.header(path))
        if any(not p.name for p in found):
            return found
        if "/" in path and not any(p.name == head for p in found) and self._is_package(head) and head not in _UMBRELLAS:
            convention = Provider("ros", head, "", False)
            if self.target.version(head) is not None or not found or head in self.workspace.packages:
                found.insert(0, convention)
            else:
                found.append(convention)
        # A key that only depends on the package which has the header can satisfy a need, and is never its name.
        return [p for p in found if p.name not in _BROAD]

    def _is_package(self, name: str) -> bool:
        return name in self.workspace.packages or self.target.ever_released(name)

    def cmake(self, name: str) -> tuple[Provider, ...]:
        """Who could answer find_package(name)."""
        known = self._cmake.get(name)
        if known is None:
            own = self.workspace.provides_cmake.get(name)
            found = [Provider("ros", own)] if own else []
            if not own:
                # `x-config.cmake` answers to any spelling of X, and ROS packages name theirs so.
                for spelling in dict.fromkeys((name, name.lower())):
                    if self.target.version(spelling) is not None or spelling in self.workspace.packages:
                        found.append(Provider("ros", spelling))
                found.extend(self._cmake_elsewhere(name))
                if not found and self.target.ever_released(name):
                    found.append(Provider("ros", name, "", False))
            known = self._cmake[name] = tuple(found)
        return known

    def _cmake_elsewhere(self, name: str) -> list[Provider]:
        known = self.providers.cmake(name)
        if name != name.lower():
            # `x-config.cmake` answers to any spelling of X.
            known = known + [p for p in self.providers.cmake(name.lower()) if p not in known]
        found = [p for p in known if (p.name != name or p.kind != "ros") and p.name not in _BROAD]
        modules = [p for p in found if p.kind == "ros" and p.name in ("cmake_modules", "eigen3_cmake_module")]
        if modules and name in ("Eigen", "TinyXML", "TinyXML2", "NUMPY", "GSL", "UUID", "Xenomai"):
            # The library alone brings no find module of this name; catkin itself did until hydro.
            if self.target.distro in ("groovy", "hydro"):
                return [Provider("system", "")]
            return [
                p for p in found if p.kind == "ros" or (name == "TinyXML2" and p in self.providers.cmake(name.lower()))
            ]
        return found

    def module(self, module: str) -> tuple[Provider, ...]:
        """Who could answer `import module`."""
        head = module.split(".")[0]
        known = self._modules.get(module)
        if known is None:
            owners = self.workspace.modules.get(head, ())
            if head in owners:
                owners = [head]
            found = [Provider("ros", o) for o in owners]
            if not found and stdlib(module, self.target.python or 99, self.target.python_major):
                found = [Provider("system", "")]
            if not found and ever_stdlib(module):
                found = [Provider("system", "")]  # gone from Python, which python-version says; nobody else's module
            if not found:
                found = list(self.providers.module(module))
                if not any(p.name == head for p in found) and self._is_package(head):
                    found.insert(0, Provider("ros", head, "", False))
            known = self._modules[module] = tuple(found)
        return known

    # -- what is used --------------------------------------------------------------------------------------------------

    def needs(self, package: Package) -> tuple[Need, ...]:
        """Everything a package uses of others on this target."""
        known = self._needs.get(package.name)
        if known is None:
            known = self._needs[package.name] = tuple(self._collect(package))
        return known

    def _collect(self, package: Package) -> Iterator[Need]:
        digest = package.digest
        for found in package.build.found:
            if found.how == "pkg_check_modules" and self.active(found.conditions):
                yield from self._modules_asked(found)
            if found.how not in ("find_package", "catkin") or not self.active(found.conditions):
                continue
            if found.name in ("catkin", package.name) or package.name in self.workspace.find_modules.get(
                found.name, ()
            ):
                continue
            providers = self.cmake(found.name)
            if not providers:
                self.unresolved["cmake"].add(found.name)
                continue
            testing = any("TESTING" in c.text for c in found.conditions)
            certain = self.certain(found.conditions)
            yield Need(
                "find_package" if found.how == "find_package" else "component",
                found.name,
                providers,
                found.at,
                "test"
                if testing or role_of_folder(found.at.path[len(package.path) :].lstrip("/")) == "test"
                else "build",
                certain,
                found.required or found.how == "catkin",
            )
        for include in digest.includes:
            if not self.active(include.conditions):
                continue
            providers = self.header(include.path)
            if not providers:
                self.unresolved["include"].add(include.path)
                continue
            if any(not p.name for p in providers):
                continue
            yield Need("include", include.path, providers, include.at, include.role, self.certain(include.conditions),
                       True, include.public, include.targets)  # fmt: skip
        for item in digest.imports:
            if not self.active(item.conditions):
                continue
            providers = self.module(item.module)
            if not providers:
                self.unresolved["import"].add(item.module)
                continue
            if any(not p.name for p in providers):
                continue
            certain = self.certain(item.conditions)
            yield Need("import", item.module, providers, item.at, item.role, certain, certain and not item.lazy)
        for use in digest.references:
            reference = use.reference
            name = reference.package
            if not name and reference.kind == "plugin" and ".launch" in use.at.path:
                # Nodelets are called `package/Class`.
                name = reference.name.partition("/")[0] if "/" in reference.name else ""
            if not name or name == package.name or "$" in name or not self._is_package(name):
                continue
            how = {"plugin": "plugin", "command": "shell"}.get(reference.kind, "launch")
            yield Need(
                how,
                name,
                (Provider("ros", name),),
                use.at,
                use.role,
                not reference.conditional,
                not reference.conditional,
            )

    def _modules_asked(self, found: Found) -> Iterator[Need]:
        """What a call of pkg_check_modules asks for; modules that a package of the workspace may write are left out."""
        providers = tuple(self.providers.pkgconfig(re.split(r"[<>=]", found.name)[0]))
        if not providers or found.name in self.workspace.packages:
            return
        testing = any("TESTING" in c.text for c in found.conditions)
        yield Need(
            "pkg-config",
            found.name,
            providers,
            found.at,
            "test" if testing else "build",
            self.certain(found.conditions),
            found.required,
        )


@lru_cache(maxsize=10000)
def _stems(name: str) -> frozenset[str]:
    """What a package that vendors a key may be called after: `libogre-1.9-dev` gives `ogre`, `libyaml-cpp-dev` also
    `yaml_cpp`."""
    plain = name.removeprefix("lib").removesuffix("-dev")
    return frozenset({re.split(r"[-.]", plain)[0], plain.replace("-", "_")})


def interface_of(view: View, include: str) -> str | None:
    """The package whose interface an include path names by its form (`p/msg/x.hpp`, `p/X.h`), None for others."""
    head, _, rest = include.partition("/")
    package = view.workspace.packages.get(head)
    if package is not None:
        return head if package.is_interface_package and view.workspace.is_interface_header(head, rest) else None
    if not head.endswith(("_msgs", "_srvs", "_interfaces", "_actions")) and not rest.startswith(
        ("msg/", "srv/", "action/")
    ):
        return None
    return head
