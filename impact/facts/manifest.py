"""package.xml to facts: places from our own scan, the verdict on what is out of the ordinary from catkin_pkg."""

import re

import msgspec

from .markup import Document, Element, decode, scan
from .place import Problem


class Dependency(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One dependency as one kind.

    kind: build, build_export, buildtool, buildtool_export, exec, test, doc, conflict, replace, group, member_of_group.
    A tag that means several kinds (`depend`, format 1's `run_depend`, `build_depend`) gives one Dependency for each.
    tag: the tag as written. condition: its attribute, as written. bounds: pairs such as ("version_gte", "1.2.0").
    """

    name: str
    kind: str
    tag: str
    line: int
    column: int = 0
    condition: str = ""
    bounds: tuple[tuple[str, str], ...] = ()


class Export(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One element of <export>: tag, attributes, text. line: of its tag; column: of its text where that stands in this
    line, else of the tag. places: lines and columns of the attributes' values."""

    tag: str
    attributes: dict[str, str]
    text: str
    line: int
    column: int = 0
    places: dict[str, tuple[int, int]] = {}


class Manifest(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A package.xml. `build_types` holds (type, condition) pairs as in the export section; none means catkin.

    problems: why catkin_pkg, and with it every build tool, refuses the file. warnings: what it accepts but advises
    against. unknown_tags: (tag, text, line, column) of children of <package> that the format does not know; each is a
    problem too. member_of_group and group_depend are dependencies of the kinds `member_of_group` and `group`. line,
    column: of the name.
    """

    name: str
    version: str
    format: int
    line: int
    dependencies: tuple[Dependency, ...] = ()
    build_types: tuple[tuple[str, str], ...] = ()
    exports: tuple[Export, ...] = ()
    metapackage: bool = False
    deprecated: bool = False
    problems: tuple[Problem, ...] = ()
    unknown_tags: tuple[tuple[str, str, int, int], ...] = ()
    warnings: tuple[Problem, ...] = ()
    column: int = 0


# What a tag means, by REP 127 (format 1), REP 140 (format 2) and REP 149 (format 3).
_IN_ALL_FORMATS = {
    **{f"{kind}_depend": (kind,) for kind in ("build", "buildtool", "test")},
    "conflict": ("conflict",),
    "replace": ("replace",),
}
FORMAT_1 = {**_IN_ALL_FORMATS, "run_depend": ("build_export", "exec")}
FORMAT_2 = {
    **_IN_ALL_FORMATS,
    "depend": ("build", "build_export", "exec"),
    **{f"{kind}_depend": (kind,) for kind in ("build_export", "buildtool_export", "exec", "doc")},
}
FORMAT_3 = {**FORMAT_2, "group_depend": ("group",), "member_of_group": ("member_of_group",)}
TAGS = {1: FORMAT_1, 2: FORMAT_2, 3: FORMAT_3}
ANY_FORMAT = {**FORMAT_1, **FORMAT_3}
GROUPS = frozenset({"group_depend", "member_of_group"})
TEXT_TAGS = frozenset({"name", "version", "description", "maintainer", "license", "url", "author", "export"})

BOUNDS = ("version_lt", "version_lte", "version_eq", "version_gte", "version_gt")
DEPENDENCY_ATTRIBUTES = frozenset({*BOUNDS, "condition"})
CONDITION_ONLY = frozenset({"condition"})
BOUNDS_ONLY = frozenset(BOUNDS)
TEXT_ATTRIBUTES = {
    "version": frozenset({"compatibility"}),
    "maintainer": frozenset({"email"}),
    "author": frozenset({"email"}),
    "url": frozenset({"type"}),
    "license": frozenset({"file"}),
}
NO_ATTRIBUTES: frozenset[str] = frozenset()

NAME = re.compile(r"[a-z][a-z0-9_-]*\Z")
VERSION = re.compile(r"(?:0|[1-9][0-9]*)\.(?:0|[1-9][0-9]*)\.(?:0|[1-9][0-9]*)\Z")
NO_DESCRIPTION = re.compile(r"<description[^>]*(?:/>|>\s*</description)")
EMAIL = re.compile(r"[\w%+-]+(?:\.[\w%+-]+)*@[a-zA-Z0-9%-]+(?:\.[a-zA-Z0-9%-]+)*\.[a-zA-Z]{2,}\Z", re.ASCII)


def extract(data: bytes) -> Manifest:
    """Facts of a package.xml of format 1, 2 or 3; never raises.

    Where catkin_pkg would refuse the file, `problems` says why, with lines, and the rest of the facts hold what the
    text still tells. Conditions stay as written: whether they hold depends on the target.
    """
    document = scan(data)
    root = next((i for i, e in enumerate(document.elements) if e.name == "package"), -1)
    if root == -1:
        problems = document.problems or (Problem(1, "has no `<package>` element"),)
        return Manifest("", "", 1, 1, problems=problems)
    children, exported = _list_children(document, root)
    format_text = document.elements[root].get("format", "1").strip()
    format_ = int(format_text) if format_text in ("1", "2", "3") else 0
    tags = TAGS.get(format_, FORMAT_3)

    name = _find_first(children, "name")
    version = _find_first(children, "version")
    dependencies: list[Dependency] = []
    unknown: list[tuple[str, str, int, int]] = []
    found: list[Problem] = []
    empty: list[Problem] = []
    for child in children:
        tag = child.name
        kinds = tags.get(tag)
        if kinds is None:
            if tag in TEXT_TAGS:
                continue
            line, column = document.locate(child.offset + 1)
            unknown.append((tag, child.text, line, column))
            found.append(Problem(line, _describe_unknown_tag(tag, format_, tags), column))
            kinds = ANY_FORMAT.get(tag.replace("-", "_").lower())
            if kinds is None:
                continue
        line, column = document.locate(child.text_offset)
        if not child.text:
            empty.append(Problem(line, f"`<{tag}>` names nothing", column))
            continue
        bounds: tuple[tuple[str, str], ...] = ()
        condition = ""
        for attribute in child.attributes:
            if attribute.name == "condition":
                condition = attribute.value
            elif attribute.name in BOUNDS:
                bounds = (*bounds, (attribute.name, attribute.value))
        for kind in kinds:
            dependencies.append(Dependency(child.text, kind, tag, line, column, condition, bounds))

    exports = tuple(_make_export(document, element) for element in exported)
    warnings: tuple[Problem, ...] = ()
    if document.problems:
        problems = document.problems + tuple(found)
    elif not unknown and _is_plain(document, format_, children, exported, dependencies):
        problems = ()
    else:
        problems, warnings = _validate_manifest(data, document, children, found)
    line, column = document.locate(name.text_offset if name is not None else document.elements[root].offset)
    return Manifest(
        name.text if name is not None else "",
        version.text if version is not None else "",
        format_ or 3,
        line,
        tuple(dependencies),
        tuple((e.text, e.attributes.get("condition", "")) for e in exports if e.tag == "build_type" and e.text),
        exports,
        any(e.tag == "metapackage" for e in exports),
        any(e.tag == "deprecated" for e in exports),
        problems,
        tuple(unknown),
        warnings + tuple(empty),
        column,
    )


def _list_children(document: Document, root: int) -> tuple[list[Element], list[Element]]:
    """Children of <package>, and those of its <export>. In a file that is not well-formed, where a closing tag may be
    missing, a dependency counts at any depth."""
    top = document.elements[root]
    exported = [inner for child in top.children if child.name == "export" for inner in child.children]
    if not document.problems:
        return top.children, exported
    inside = set(exported)
    below = (element for element in document.elements[root + 1 :] if element not in inside)
    return [element for element in below if element.parent == root or element.name in ANY_FORMAT], exported


def _make_export(document: Document, element: Element) -> Export:
    line, column = document.locate(element.offset + 1)
    at = document.locate(element.text_offset) if element.text else (0, 0)
    values = {attribute.name: attribute.value for attribute in element.attributes}
    places = {attribute.name: document.locate(attribute.offset) for attribute in element.attributes}
    return Export(element.name, values, element.text, line, at[1] if at[0] == line else column, places)


def _find_first(children: list[Element], tag: str) -> Element | None:
    return next((child for child in children if child.name == tag), None)


def _describe_unknown_tag(tag: str, format_: int, tags: dict[str, tuple[str, ...]]) -> str:
    said = f"`<{tag}>` is no tag of manifest format {format_ or 3}"
    if tag == "run_depend":
        return f"{said}, which calls it `<exec_depend>`"
    plain = tag.replace("-", "_").lower()
    if plain in ANY_FORMAT and plain not in tags:
        needed = 2 if plain in FORMAT_2 else 3
        return f"{said}, it needs format {needed}"
    if plain in tags or plain in TEXT_TAGS:
        return f"{said}; `<{plain}>` is"
    from difflib import get_close_matches

    close = get_close_matches(plain, [*tags, *TEXT_TAGS], 1, 0.8)
    return f"{said}; `<{close[0]}>` is" if close else said


def _is_plain(
    document: Document, format_: int, children: list[Element], exported: list[Element], dependencies: list[Dependency]
) -> bool:
    """True when a manifest is so ordinary that catkin_pkg accepts it without a word.

    Importing catkin_pkg costs as much as reading hundreds of manifests here, so it is asked about the others alone.
    """
    root = document.elements[0]
    if not format_ or root.name != "package" or any(a.name != "format" for a in root.attributes):
        return False
    # catkin_pkg takes CDATA for no text, and allows elements in the description and the export section alone
    if "<![CDATA[" in document.text or any(
        child.children and child.name not in ("description", "export") for child in root.children
    ):
        return False
    count = {"name": 0, "version": 0, "description": 0, "maintainer": 0, "license": 0, "export": 0}
    dependency_attributes = DEPENDENCY_ATTRIBUTES if format_ > 2 else BOUNDS_ONLY
    own = ""
    for child in children:
        tag = child.name
        if tag in count:
            count[tag] += 1
        if tag not in TEXT_TAGS:
            allowed = CONDITION_ONLY if tag in GROUPS else dependency_attributes
            if not child.text or any(a.name not in allowed for a in child.attributes):
                return False
            continue
        if child.attributes:
            allowed = TEXT_ATTRIBUTES.get(tag, NO_ATTRIBUTES)
            if any(a.name not in allowed or (a.name == "file" and format_ < 3) for a in child.attributes):
                return False
        if tag == "name":
            own = child.text
            if not NAME.match(own):
                return False
        elif tag == "version":
            compatibility = child.get("compatibility", "0.0.0")
            if not VERSION.match(child.text) or not VERSION.match(compatibility):
                return False
        elif tag in ("maintainer", "author"):
            email = child.get("email", "none")
            if not child.text or (email == "none" and tag == "maintainer"):
                return False
            if email != "none" and not EMAIL.match(email):
                return False
        elif (tag == "license" and not child.text) or (
            tag == "description" and NO_DESCRIPTION.match(document.text, child.offset)
        ):
            return False
    one = count["name"] == count["version"] == count["description"] == 1
    if not one or not count["maintainer"] or not count["license"] or count["export"] > 1:
        return False
    if any(e.name == "metapackage" for e in exported) and (
        {d.name for d in dependencies if d.kind == "buildtool"} != {"catkin"}
        or any(d.kind in ("build", "test") for d in dependencies)
    ):
        return False
    seen: dict[tuple[str, str], str] = {}
    for dependency in dependencies:
        if dependency.name == own:
            return False
        before = seen.setdefault((dependency.name, dependency.kind), dependency.tag)
        if before != dependency.tag:
            return False
    generic = [d.name for d in dependencies if d.tag == "depend" and d.kind == "build"]
    if len(generic) != len(set(generic)):
        return False
    if format_ == 1:
        tested = {d.name for d in dependencies if d.kind == "test"}
        return not any(d.name in tested for d in dependencies if d.kind in ("build", "exec"))
    return not (
        {d.name for d in dependencies if d.kind == "group"}
        & {d.name for d in dependencies if d.kind == "member_of_group"}
    )


def _validate_manifest(
    data: bytes, document: Document, children: list[Element], found: list[Problem]
) -> tuple[tuple[Problem, ...], tuple[Problem, ...]]:
    """What catkin_pkg says about a manifest: problems and warnings, each with the line it most likely speaks of."""
    from catkin_pkg.package import InvalidPackage, parse_package_string

    warnings: list[str] = []
    problems = list(found)
    try:
        parse_package_string(decode(data).lstrip("\ufeff").encode(), warnings=warnings)
    except InvalidPackage as error:
        for message in error.msg.splitlines():
            message = message.strip().removeprefix("- ")
            if message and message != "Error(s):" and not SAID_BEFORE.search(message):
                problems.append(_make_problem(message, document, children))
        if not problems:
            problems.append(Problem(1, "catkin_pkg refuses it"))
    except AssertionError:
        given = document.elements[0].get("format")
        problems.append(Problem(1, f"manifest format `{given}` is none of 1, 2 and 3"))
    except MemoryError:
        raise
    except Exception as error:  # whatever else a hostile file makes it raise is a fact about that file
        problems.append(Problem(1, f"catkin_pkg cannot read it: {type(error).__name__}: {error}"[:200]))
    noted = tuple(_make_problem(warning, document, children) for warning in warnings)
    return tuple(sorted(problems, key=lambda p: p.line)), noted


# Unknown tags have a problem each, with its line.
SAID_BEFORE = re.compile(r"must not contain the following tags|^Please replace <|^Either update to a newer format")


def _format_message(message: str) -> str:
    """catkin_pkg's sentence as a clause with names in backticks."""
    message = re.sub(r"(?<!\w)[\"']([^\"']*)[\"'](?!\w)", r"`\1`", message).strip().rstrip(".")
    return message[:1].lower() + message[1:] if message[1:2].islower() else message


QUOTED = re.compile(r"[\"'`]([^\"'`]+)[\"'`]")


def _make_problem(message: str, document: Document, children: list[Element]) -> Problem:
    line, column = _find_place(message, document, children)
    return Problem(line, _format_message(message), column)


def _find_place(message: str, document: Document, children: list[Element]) -> tuple[int, int]:
    """Line and column of the child whose text or tag a message quotes, else those of the manifest's start."""
    for quoted in QUOTED.findall(message):
        for child in children:
            if child.name != "name" and (child.text == quoted or child.get("email") == quoted):
                return document.locate(child.text_offset)
    for quoted in (*QUOTED.findall(message), *message.lower().split()):
        for child in children:
            if child.name == quoted or child.name + "s" == quoted:
                return document.locate(child.text_offset)
    return document.locate(document.elements[0].offset) if document.elements else (1, 0)
