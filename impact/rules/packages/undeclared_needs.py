"""What packages use and do not declare, as the rules on it ask for it."""

import re
from typing import NamedTuple

from ....edges.memory import cache_in_derived
from ...model.cmake.links import list_given_items
from ...model.misspelling import fold_name, is_one_edit
from ...targets.platform import strip_to_letters
from ..vocabulary import Declare, Need, Package, TargetView, Text, translate_tag
from .clean_machine import TEST_HEADERS

_COMPILED = (".cpp", ".cc", ".cxx", ".c", ".h", ".hpp", ".hh")
DECLARE = "add `<{tag}>{subject}</{tag}>`[[ and `<{also}>{subject}</{also}>`]] to {manifest}"
"""The help that names what to declare, with the data of describe_need()."""
_USES = {
    "tool": "packages of its build type are built with `{used}`",
    "find_package": "CMake looks for `{used}`",
    "part": "CMake looks for the component `{used}`",
    "component": "CMake asks catkin for `{used}`",
    "program": "CMake runs `{used}`",
    "environment": "CMake reads the environment variable `{used}`",
    "pkg-config": "pkg-config is asked for `{used}`",
    "include": "`{used}` is included",
    "import": "`{used}` is imported",
    "launch": "`{used}` is used when launching",
    "look up": "`{used}` is looked up at run time",
    "plugin": "a plugin of `{used}` is loaded",
    "shell": "the program `{used}` is run",
    "setting": "settings or a description name something of `{used}`",
}


def make_texts(rest: str, help: str = DECLARE, kind: str = "") -> dict[str, Text]:
    """Texts by kind that say how a package uses something and then the rest, with the data of describe_need(). kind:
    what find_kind() is given."""
    return {f"{how}{kind}": Text(f"{use}, but {rest}", help) for how, use in _USES.items()}


def find_kind(need: Need, kind: str = "") -> str:
    """Which of these texts describes a need."""
    looked_up = need.how == "launch" and need.at.path.endswith(_COMPILED)
    return f"{'look up' if looked_up else need.how}{kind}"


class Undeclared(NamedTuple):
    """Needs of a package that it does not declare, by the name to declare. missing: nothing that it declares brings
    them. borrowed: something does."""

    missing: dict[str, list[Need]]
    borrowed: dict[str, list[Need]]


@cache_in_derived
def find_undeclared(view: TargetView, package: Package) -> Undeclared:
    """The needs of a package that no dependency of its manifest answers."""
    closure, declared = view.build_environment(package), view.collect_declared(package)
    found = Undeclared({}, {})
    environment = package.build.makes_environment
    elsewhere = {d.name for d in package.manifest.dependencies if not view.is_available(d.name)}  # for other distros
    for need in view.list_needs(package):
        if view.is_met(need.providers, declared) or (need.subject.startswith(TEST_HEADERS) and need.role == "test"):
            continue
        name = choose_name(view, package, need)
        if name is None or name == package.name or name in elsewhere:
            continue
        if need.how == "include" and any(view.may_have_released_header(one, need.subject) for one in declared):
            continue  # a package of the workspace has it, too: for the other generation, or as a copy
        system = need.providers[0].kind == "system"
        if system and environment and need.how == "import":
            continue
        if need.how == "include" and view.unknown_contents.may_install_folder(package, need.subject):
            continue
        carried = system and need.how != "import"
        if carried and need.how == "include" and _may_lie_on_machine(package, need):
            continue
        guessed = carried or not need.providers[0].sure
        if not (guessed and view.unknown_contents.is_likely(package, need.subject)):
            kind = found.borrowed if view.is_met(need.providers, closure) else found.missing
            kind.setdefault(name, []).append(need)
    return found


def _may_lie_on_machine(package: Package, need: Need) -> bool:
    """Whether what compiles an include searches a folder of the machine that is none of the platform's packages."""
    if not need.targets:
        searched = [path.path for path in package.build.list_paths() if path.how == "include"]
    else:
        searched = list(list_given_items(package, need.targets))
    return any(_OF_MACHINE.match(item) for item in searched)


# Not the folders that compilers search anyway, or that packages of the platform and of ROS install into.
_OF_MACHINE = re.compile(r"/(?!usr/(?:local/)?include/?\Z|usr/(?:include|lib|share)/|opt/ros/).*\binclude\b")


def list_sources(view: TargetView, package: Package, need: Need) -> tuple[str, ...]:
    """What a package declares that brings what answers a need."""
    declared = view.collect_declared(package)
    return tuple(one for one in declared if view.is_met(need.providers, view.list_transitive([one])))


def choose_name(view: TargetView, package: Package, need: Need) -> str | None:
    """The name a person would put into the manifest for a need: the first provider that can be had on the target, or
    the package that is named by its form, wherever it comes from. Of those that bring a module, what is called as the
    first is, for some version of it or of Python: the others are packages that use it."""
    other = "python3-" if view.target.python_major == 2 else "python-"
    first = need.providers[0]
    own = _strip_python(first.package) if need.how == "import" and first.kind == "system" else ""
    for provider in sorted(need.providers, key=lambda p: p.name.startswith(other)):
        if own and provider.kind == "system" and _strip_python(provider.package) != own:
            continue
        if provider.name and view.is_available(provider.name):
            return provider.name
    by_form = need.how in ("launch", "setting", "find_package", "component", "import", "include")
    if not by_form or first.kind != "ros" or not first.sure:
        return None
    if first.name != re.split(r"[./]", need.subject)[0]:
        return None
    # A launch file in Python is of ROS 2, whoever has ported what it starts, and so is the form of some headers.
    launched = need.how == "launch" and need.at.path.endswith(".py")
    ported = view.target.ros == 2 and (launched or view.includes_interfaces_of(package, first.name))
    ported = ported and not view.find_reviewed("package", first.name)
    return first.name if ported or not view.target.is_other_generation(first.name) else None


def _strip_python(package: str) -> str:
    return strip_to_letters(re.sub(r"\Apython3?-|-pip\Z", "", package))


def describe_need(package: Package, need: Need) -> dict[str, str]:
    """The data of make_texts() and of DECLARE."""
    tag, *also = translate_tag(_tag(need), package.manifest.format)
    return {
        "used": need.subject,
        "tag": tag,
        "also": also[0] if also else "",
        "manifest": package.linked.manifest_path,
    }


def declare_need(view: TargetView, package: Package, need: Need, name: str) -> tuple[Declare, ...]:
    """Declares what answers a need; nothing where the manifest has the name with a letter wrong, which another rule
    repairs."""
    if any(
        (fold_name(d) == fold_name(name) or is_one_edit(d, name)) and not view.is_available(d)
        for d in view.collect_declared(package)
    ):
        return ()
    if view.is_circular(package, name) or not view.is_available(name):
        return ()
    return (Declare(package.linked.manifest_path, name, _tag(need)),)


# How packages of CMake functions are called, with which packages are built (REP 149, buildtool_depend).
_BUILD_TOOLS = ("ament_cmake", "rosidl_default_generators")


def _tag(need: Need) -> str:
    if need.role == "test":
        return "test_depend"
    if need.how == "environment":
        return "build_depend"
    if need.how == "tool" or (need.how == "find_package" and need.subject.startswith(_BUILD_TOOLS)):
        return "buildtool_depend"
    if need.how in ("import", "launch", "plugin", "shell", "setting"):
        return "exec_depend"
    return "depend"
