"""What is looked for: find_package(), pkg-config, find_library() and its kin, fetched projects."""

import re

from ...facts.cmake import Command
from .blocks import CommandCall
from .build import FoundPackage
from .interpreter import Interpreter, handles
from .language import add_module
from .names import make_name_set, split_names
from .values import REFERENCE, CMakeValue, Word, group_by_keyword, merge, split_words, wrap

_VERSION = re.compile(r"\d[\d.]*(?:\.\.\.<?\d[\d.]*)?\Z")
_PKG_SPEC = re.compile(r"(.+?)\s*(>=|<=|=|>|<)\s*(\d.*)\Z")

_FLAGS = make_name_set(
    """
    EXACT QUIET REQUIRED MODULE CONFIG NO_MODULE NO_POLICY_SCOPE GLOBAL BYPASS_PROVIDER NO_DEFAULT_PATH
    NO_PACKAGE_ROOT_PATH NO_CMAKE_PATH NO_CMAKE_ENVIRONMENT_PATH NO_SYSTEM_ENVIRONMENT_PATH NO_CMAKE_PACKAGE_REGISTRY
    NO_CMAKE_BUILDS_PATH NO_CMAKE_SYSTEM_PATH NO_CMAKE_INSTALL_PREFIX NO_CMAKE_SYSTEM_PACKAGE_REGISTRY
    CMAKE_FIND_ROOT_PATH_BOTH ONLY_CMAKE_FIND_ROOT_PATH NO_CMAKE_FIND_ROOT_PATH
    """
)
_LISTS = make_name_set(
    """
    NAMES CONFIGS HINTS PATHS PATH_SUFFIXES REGISTRY_VIEW COMPONENTS OPTIONAL_COMPONENTS DOC ENV VALIDATOR
    """
)


@handles("find_package", "find_dependency", least=1)
def find_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """find_package() in all its signatures; each component of catkin is a package of its own."""
    first = call.templates[0]
    if first.kind == REFERENCE and not run.silent:
        value = run.lookup("", first.name)
        if value is not None and not value.sure and len(value.words) > 1 and len(value.chosen) == 1:
            for name in value.words:
                _find(run, call, name, args[1:])
            return
    _find(run, call, args[0], args[1:])


def is_unknown(text: str) -> bool:
    """True for a text that holds a variable nobody could read."""
    return "${" in text or "$ENV{" in text


def _find(run: Interpreter, call: CommandCall, name: Word, rest: list[Word]) -> None:
    flags: set[str] = set()
    components: list[Word] = []
    optional: list[Word] = []
    sought: list[Word] = []  # instead of the name
    versions: dict[str, None] = {}
    section = ""
    for item in rest:
        if item in _FLAGS:
            flags.add(item)
            section = (
                "COMPONENTS" if item == "REQUIRED" else ("" if section in ("HINTS", "PATHS", "NAMES") else section)
            )
        elif item in _LISTS:
            section = str(item)
        elif section == "OPTIONAL_COMPONENTS":
            optional.append(item)
        elif section == "COMPONENTS":
            components.append(item)
        elif section == "NAMES":
            sought.append(item)
        elif not section and _VERSION.match(item):
            versions[str(item)] = None
        elif not section and is_unknown(item):
            continue
        elif not section and flags:
            components.append(item)
    if is_unknown(name):
        run.give_up(name.at, f"find_package({name}): its name is not known")
        return
    # Several are the values that a variable has in branches; which of them goes with this name is not known.
    version = next(iter(versions)) if len(versions) == 1 else ""
    components = [item for item in components if not is_unknown(item)]
    required = "REQUIRED" in flags
    quiet = "QUIET" in flags
    conditions = run.merge_with(name)
    add_module(run, f"Find{name}")
    of_catkin = name == "catkin" or (bool(components) and _is_wrapper_of_catkin(run, str(name)))
    if of_catkin:
        run.add_found(FoundPackage(name="catkin", how="find_package", at=run.locate(name.at), required=required,
                            quiet=quiet,
                            version=version, conditions=conditions))  # fmt: skip
        for component in split_words(components):
            held, place = merge(conditions, component.conditions), run.locate(component.at)
            run.add_found(FoundPackage(str(component), "catkin", place, required, quiet, conditions=held))
            run.extend(component, component.at)
    if sought:
        run.renamed.add(str(name))
    placed = not {"HINTS", "PATHS"}.isdisjoint(rest) or any(
        (held := run.get(variable)) is not None and held.text
        for variable in (f"{name}_DIR", f"{name}_ROOT", "CMAKE_PREFIX_PATH")
    )
    for one in split_words(sought) or ([name] if name != "catkin" else []):
        if is_unknown(one):
            continue
        alone = len(sought) < 2  # else any of them will do
        run.add_found(
            FoundPackage(
                str(one),
                "find_package",
                run.locate(one.at),
                required and alone,
                quiet or not alone,
                version,
                "EXACT" in flags,
                tuple((str(component), run.locate(component.at)) for component in components),
                tuple(str(component) for component in optional),
                "",
                conditions,
                placed=placed,
            )
        )
    if not (sought or flags & {"CONFIG", "NO_MODULE"}):
        if required:
            run.use_feature(f"Find{name}", name.at)
            run.use_dropped(f"Find{name}", name.at)
        _run_module(run, call, str(name))
    if required:
        found = CMakeValue((wrap("1", call.at),))
        run.assign(run.scope, f"{name}_FOUND", found)
        if name.upper() != name:
            run.assign(run.scope, f"{name.upper()}_FOUND", found)
    run.extend(str(name), name.at)
    if of_catkin:
        _set_catkin_variables(run, call)


def _is_wrapper_of_catkin(run: Interpreter, name: str) -> bool:
    """Whether a configuration or find module of the tree answers that finds catkin itself: the components that it is
    given are then packages of catkin."""
    places = ((f"{name}_DIR", f"{name}Config.cmake"), (f"{name}_DIR", f"{name.lower()}-config.cmake"))
    for variable, file in (*places, ("CMAKE_MODULE_PATH", f"Find{name}.cmake")):
        held = run.get(variable)
        for directory in held.words if held is not None else ():
            path = run.make_relative(run.resolve(f"{directory}/{file}")) if directory else None
            facts = run.read(path) if path is not None else None
            if facts is not None and any(_is_search_for_catkin(command) for command in facts.commands):
                return True
    return False


def _is_search_for_catkin(command: Command) -> bool:
    return command.name == "find_package" and [one.text for one in command.arguments[:1]] == ["catkin"]


def _run_module(run: Interpreter, call: CommandCall, name: str) -> None:
    """Runs the find module of the tree that answers, for the targets and commands that it makes. What it looks for is
    its own affair, and its variables are set to what is not known."""
    held = run.get("CMAKE_MODULE_PATH")
    for directory in held.words if held is not None else ():
        path = run.make_relative(run.resolve(f"{directory}/Find{name}.cmake")) if directory else None
        if path is None or run.load(path) is None or path in run.including:
            continue
        before = run.scope
        run.push(dict(before))
        run.silent += 1
        try:
            run.run_file(path, call.at)
            after = run.scope
        finally:
            run.silent -= 1
            run.pop()
        for variable, value in after.items():
            if before.get(variable) is not value and not variable.startswith(("CMAKE_", "_")):
                run.set_unknown(variable, call.at)
        return


@handles("gz_find_package", "ign_find_package", least=1)
def find_gz_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """find_gz_package() of gz-cmake: a name, VERSION, REQUIRED and COMPONENTS count."""
    given = group_by_keyword(args[1:], _GZ)
    version = given.get("VERSION", [])[:1]
    extra = [item for item in args[1:] if item in ("REQUIRED", "QUIET", "EXACT")]
    keyword = [item for item in args if item == "COMPONENTS"]
    _find(run, call, args[0], [*version, *extra, *keyword, *given.get("COMPONENTS", [])])


_GZ = make_name_set(
    """
    REQUIRED EXACT QUIET CONFIG BUILD_ONLY PKGCONFIG_IGNORE VERSION PRETTY PURPOSE EXTRA_ARGS PKGCONFIG PKGCONFIG_LIB
    PKGCONFIG_VER_COMPARISON REQUIRED_BY PRIVATE_FOR COMPONENTS OPTIONAL_COMPONENTS
    """
)


def _set_catkin_variables(run: Interpreter, call: CommandCall) -> None:
    """What find_package(catkin) sets; destinations as documented for catkin_package()."""
    package = run.installed_name
    values = {
        "CATKIN_PACKAGE_BIN_DESTINATION": f"lib/{package}",
        "CATKIN_PACKAGE_ETC_DESTINATION": f"etc/{package}",
        "CATKIN_PACKAGE_INCLUDE_DESTINATION": f"include/{package}",
        "CATKIN_PACKAGE_LIB_DESTINATION": "lib",
        "CATKIN_PACKAGE_PYTHON_DESTINATION": f"lib/python3/dist-packages/{package}",
        "CATKIN_PACKAGE_SHARE_DESTINATION": f"share/{package}",
        "CATKIN_GLOBAL_BIN_DESTINATION": "bin",
        "CATKIN_GLOBAL_ETC_DESTINATION": "etc",
        "CATKIN_GLOBAL_INCLUDE_DESTINATION": "include",
        "CATKIN_GLOBAL_LIB_DESTINATION": "lib",
        "CATKIN_GLOBAL_LIBEXEC_DESTINATION": "lib",
        "CATKIN_GLOBAL_PYTHON_DESTINATION": "lib/python3/dist-packages",
        "CATKIN_GLOBAL_SHARE_DESTINATION": "share",
    }
    for name, text in values.items():
        run.assign(run.scope, name, CMakeValue((wrap(text, call.at),)))


@handles("catkin_destinations")
def set_catkin_destinations(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """catkin_destinations() sets what find_package(catkin) and project() set together, and where targets are built from
    there on."""
    if not run.catkin_destinations and not run.silent:
        run.catkin_destinations = True
        opposite = {(held.text, not held.negated) for held in run.conditions}
        run.before_catkin_destinations = tuple(
            target.name
            for target in run.targets.finish()
            if not any((held.text, held.negated) in opposite for held in target.conditions)
        )
    _set_catkin_variables(run, call)


_PKG_FLAGS = make_name_set(
    """
    REQUIRED QUIET IMPORTED_TARGET GLOBAL NO_CMAKE_PATH NO_CMAKE_ENVIRONMENT_PATH STATIC_TARGET
    """
)
_PKG_VARIABLES = split_names(
    """
    LIBRARIES LINK_LIBRARIES LIBRARY_DIRS LDFLAGS LDFLAGS_OTHER INCLUDE_DIRS CFLAGS CFLAGS_OTHER VERSION PREFIX
    INCLUDEDIR LIBDIR
    """
)


@handles("pkg_check_modules", "pkg_search_module", least=2)
def check_pkgconfig_modules(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """check_pkgconfig_modules() and pkg_search_module(), with version bounds."""
    prefix = str(args[0])
    flags = {str(item) for item in args[1:] if item in _PKG_FLAGS}
    modules = split_words(item for item in args[1:] if item not in _PKG_FLAGS)
    required = "REQUIRED" in flags
    entries: list[tuple[Word, str, str, bool]] = []
    for item in modules:
        if is_unknown(item):
            run.give_up(item.at, f"{call.name}({item}): its name is not known")
            continue
        spec = _PKG_SPEC.match(item)
        if spec is None:
            entries.append((item, str(item), "", False))
        else:
            operator = spec.group(2)
            version = spec.group(3) if operator in ("=", ">=") else operator + spec.group(3)
            entries.append((item, spec.group(1), version, operator == "="))
    alternatives = call.name == "pkg_search_module"
    for item, name, version, exact in entries[:1] if alternatives else entries:
        others = tuple(other for _, other, _, _ in entries[1:]) if alternatives else ()
        run.add_found(
            FoundPackage(
                name,
                "pkg_check_modules",
                run.locate(item.at),
                required,
                "QUIET" in flags,
                version,
                exact,
                (),
                others,
                prefix,
                run.merge_with(item),
            )
        )
    for suffix in _PKG_VARIABLES:
        run.set_unknown(f"{prefix}_{suffix}", call.at)
    if required:
        run.set_text(f"{prefix}_FOUND", "1", call.at)
    elif run.get(f"{prefix}_FOUND") is not None:
        run.set_unknown(f"{prefix}_FOUND", call.at)
    if "IMPORTED_TARGET" in flags:
        run.ensure_target(f"PkgConfig::{prefix}", "imported", args[0].at)


_LOCATE_STOPS = make_name_set(
    """
    HINTS PATHS PATH_SUFFIXES DOC NO_CACHE REQUIRED NO_DEFAULT_PATH NO_PACKAGE_ROOT_PATH NO_CMAKE_PATH
    NO_CMAKE_ENVIRONMENT_PATH NO_SYSTEM_ENVIRONMENT_PATH NO_CMAKE_SYSTEM_PATH NO_CMAKE_INSTALL_PREFIX
    CMAKE_FIND_ROOT_PATH_BOTH ONLY_CMAKE_FIND_ROOT_PATH NO_CMAKE_FIND_ROOT_PATH NAMES_PER_DIR VALIDATOR REGISTRY_VIEW
    """
)


@handles("find_library", "find_path", "find_program", "find_file", least=2)
def locate(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """find_library(), find_path(), find_program() and find_file(): the variable is set to what is not known."""
    variable = str(args[0])
    names: list[Word] = []
    explicit = args[1] == "NAMES"
    for item in args[2:] if explicit else args[1:]:
        if item in _LOCATE_STOPS or (not explicit and names and item.startswith("/")):
            break
        names.append(item)
        if not explicit and len(args) > 2 and call.name == "find_file":
            break
    run.set_unknown(variable, call.at)
    if not names or call.name == "find_file":
        return
    names = [name for name in names if not is_unknown(name)]
    if not names:
        return
    first = names[0]
    run.add_found(
        FoundPackage(
            str(first),
            call.name,
            run.locate(first.at),
            "REQUIRED" in args,
            optional_components=tuple(str(name) for name in names[1:]),
            prefix=variable,
            conditions=run.merge_with(first),
        )
    )


@handles("fetchcontent_declare", least=1)
def declare_fetched_content(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """FetchContent_Declare(): names a project that is downloaded while configuring."""
    run.properties[f"FETCH {args[0].lower()}"] = CMakeValue((args[0],))
    run.add_tools(args)


@handles("fetchcontent_makeavailable", "fetchcontent_populate", "fetchcontent_getproperties")
def make_content_available(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """FetchContent_MakeAvailable(): the project's targets are there, but cannot be seen."""
    for name in args if call.name == "fetchcontent_makeavailable" else args[:1]:
        lower = name.lower()
        for suffix in ("SOURCE_DIR", "BINARY_DIR"):
            run.set_unknown(f"{lower}_{suffix}", call.at)
        if call.name == "fetchcontent_getproperties":
            for variable in args[2::2]:
                run.set_unknown(variable, call.at)
        else:
            draft = run.ensure_target(name, "fetched", name.at)
            draft.alias_of = ""


@handles("externalproject_add", least=1)
def add_external_project(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ExternalProject_Add(): a custom target that downloads and builds."""
    run.ensure_target(args[0], "external", args[0].at)
    run.add_tools(args)


@handles("externalproject_get_property")
def get_external_property(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ExternalProject_Get_Property(): folders that are not known before the build."""
    for name in args[1:]:
        run.set_unknown(name, call.at)
