"""Launch XML and YAML, xacro, URDF, plugin descriptions, parameter YAML and shell scripts: what they refer to."""

import re
from collections.abc import Callable, Iterator
from functools import partial

import msgspec
from msgspec import structs

from ..condition import UNDECIDED, Condition
from ..distro_branches import VARIABLE, BranchedName, ComparedDistro
from ..markup import TOKEN, Attribute, Document, Element, decode, find_xml_problems, scan
from ..place import Problem, Reference
from ..words import list_words
from .distro_tests import list_branched, list_compared, read_machine_test
from .documents import find_generation, read_document


class PluginClass(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A <class> of a plugin description: lookup name, C++ type, base type, library path it lies in."""

    name: str
    type: str
    base: str
    library: str
    line: int

    @property
    def library_name(self) -> str:
        """What CMake calls the library."""
        return self.library.rpartition("/")[2].removeprefix("lib").removesuffix(".so")


class ControlledJoint(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A joint, sensor or gpio that a robot description gives to ros2_control. name: as written, variables included.
    commands, states: its interfaces, those under conditions too. whole: it has no others, as far as is to be seen."""

    name: str
    commands: tuple[str, ...]
    states: tuple[str, ...]
    whole: bool
    line: int


class ReferenceFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Any file whose only interest is what it mentions. plugins is filled for plugin descriptions. unresolved: mentions
    whose package is only known when the file runs (`$(find-pkg-share $(var robot))`), as written. words: of launch
    files, YAML and robot descriptions, see list_words().

    Besides the kinds of Reference in general, `model` is a `model://` path (Gazebo finds it on its own search path).
    joints: of robot descriptions. trees: behaviour trees that a file of BehaviorTree.CPP defines, which others include
    by their name; modelled: nodes of which it lists the ports for editors.
    generation: of a launch file, as LaunchFile has it; of a script, the one whose commands alone it calls, else 0.
    branched, compared: of launch files, see distro_tests.py.
    """

    references: tuple[Reference, ...]
    plugins: tuple[PluginClass, ...] = ()
    problems: tuple[Problem, ...] = ()
    unresolved: tuple[Problem, ...] = ()
    words: str = ""
    generation: int = 0
    trees: tuple[str, ...] = ()
    modelled: tuple[str, ...] = ()
    joints: tuple[ControlledJoint, ...] = ()
    branched: tuple[BranchedName, ...] = ()
    compared: tuple[ComparedDistro, ...] = ()


PACKAGE = re.compile(r"[A-Za-z][A-Za-z0-9_-]*\Z")
CLASS = re.compile(r"[A-Za-z_]\w*(?:(?:::|/)[A-Za-z_]\w*)+\Z")
PATH = r"[^\s\"'`<>$,;:()\[\]{}|&?*]*"
# Substitutions of roslaunch (http://wiki.ros.org/roslaunch/XML), launch_xml and xacro, and resource URLs.
MENTION = re.compile(
    rf"\$\(\s*(?P<verb>find-pkg-share|find-pkg-prefix|find|exec-in-pkg)\s+(?P<args>[^()]*)\)(?P<rest>/{PATH})?"
    rf"|(?P<scheme>package|model)://(?P<host>[A-Za-z][\w-]*)(?P<path>/{PATH})?"
    r"|(?<!\w)find\(\s*['\"](?P<eval>[A-Za-z][\w-]*)['\"]\s*\)"
    r"|\$\(\s*(?P<dynamic>find-pkg-share|find-pkg-prefix|find)\s+\$[({]"
    r"|\$\(\s*command\s+['\"]?(?P<command>[A-Za-z][\w.-]*)(?=[\s'\"])"
)
_BY_DISTRO = re.compile(
    r"\$\(\s*(?:find|find-pkg-share)\s+(?P<package>[A-Za-z][\w-]*)\s*\)(?P<before>/[\w./-]*)"
    r"\$\(\s*(?:opt)?env\s+ROS_DISTRO[^()]*\)(?P<after>[\w./-]+)"
)
MARKS = ("$(", "://", "find(")


class _Found:
    """What has been found in one file so far."""

    def __init__(self, locate: Callable[[int], tuple[int, int]]):
        self.locate = locate
        self.references: list[Reference] = []
        self.unresolved: list[Problem] = []
        # What the include that is being read gives.
        self.arguments: tuple[str, ...] | None = None
        # Under which it stands, as Reference has them.
        self.conditions: tuple[Condition, ...] = ()
        self.macro = ""

    def add(self, kind: str, package: str, name: str, offset: int, conditional: bool) -> None:
        line, column = self.locate(offset)
        arguments = self.arguments if kind == "file" else None
        self.references.append(
            Reference(kind, package, name, line, column, conditional, arguments, self.conditions, self.macro)
        )

    def stand_under(self, conditions: tuple[Condition, ...]) -> bool:
        """Sets the conditions of what follows; returns whether there are any."""
        self.conditions = conditions if any(condition is not UNDECIDED for condition in conditions) else ()
        return bool(conditions)

    def mentions(self, text: str, offset: int, conditional: bool) -> None:
        """All substitutions and resource URLs of a text; offset: where it starts in the file."""
        for m in MENTION.finditer(text) if any(mark in text for mark in MARKS) else ():
            at = offset + m.start()
            verb = m["verb"]
            if verb is not None:
                self._add_substitution(verb, m["args"].split(), m["rest"], text[m.end() :], at, conditional)
            elif m["scheme"] == "package":
                self._add_path(m["host"], m["path"], text[m.end() :], at, conditional)
            elif m["scheme"] == "model":
                self.add("model", "", m["host"] + (m["path"] or ""), at, conditional)
            elif m["eval"] is not None:
                self.add("package", m["eval"], "", at, conditional)
            elif m["command"] is not None:
                self.add("command", "", m["command"], at, conditional)
            else:
                self.unresolved.append(Problem(self.locate(at)[0], text[m.start() : m.start() + 80]))
        for m in _BY_DISTRO.finditer(text) if "ROS_DISTRO" in text else ():
            name = f"{m['before'].lstrip('/')}{{distro}}{m['after']}"
            self.add("distro file", m["package"], name, offset + m.start(), conditional)

    def _add_substitution(
        self, verb: str, args: list[str], rest: str | None, after: str, at: int, conditional: bool
    ) -> None:
        names = [arg.strip("'\"") for arg in args]
        if not names or not PACKAGE.match(names[-1]):
            if names and "$" in names[-1]:
                self.unresolved.append(Problem(self.locate(at)[0], f"$({verb} {' '.join(args)})"[:80]))
            return
        package = names[-1]
        if verb == "exec-in-pkg":
            self.add("executable", package, names[0] if len(names) == 2 else "", at, conditional)
        elif verb == "find-pkg-prefix":
            parts = (rest or "").strip("/").split("/")
            if parts[:2] == ["lib", package] and len(parts) == 3 and after[:1] != "$":
                self.add("executable", package, parts[2], at, conditional)
            else:
                self.add("package", package, "", at, conditional)
        else:
            self._add_path(package, rest, after, at, conditional)

    def _add_path(self, package: str, path: str | None, after: str, at: int, conditional: bool) -> None:
        """A file of a package where its path is all literal, else the folder that is, or the package alone."""
        parts = [part for part in (path or "").split("/") if part not in ("", ".")]
        # What goes on with a variable, or is cut by a character no plain path has, is not the file's whole name.
        cut = after[:1] in ("$", "{", "*", "?", "[")
        folder = parts if (path or "").endswith("/") else parts[:-1]
        if cut and folder and ".." not in parts:
            self.add("place", package, "/".join(folder), at, conditional)
        elif not parts or cut or ".." in parts:
            self.add("package", package, "", at, conditional)
        else:
            self.add("file", package, "/".join(parts), at, conditional)

    def make_file(self, *problems: Problem, plugins: tuple[PluginClass, ...] = ()) -> ReferenceFile:
        return ReferenceFile(tuple(self.references), plugins, problems, tuple(self.unresolved))


def extract(data: bytes, kind: str) -> ReferenceFile:
    """References of a file of the kind launch_xml, launch_yaml, xacro, plugin_xml, xml, params or shell; never raises.

    XML that is not well-formed is a problem, and is read on; `xml` and `plugin_xml` are told by their root element, so
    that XML of other trades (GUI layouts, feeds) gives nothing at all.
    """
    facts = READERS[kind](data)
    return structs.replace(facts, words=list_words(data)) if kind in _SPOKEN else facts


# What sets parameters or names plugins, as far as its name tells.
_SPOKEN = frozenset(("launch_xml", "launch_yaml", "params", "xacro"))


def _read_xml(data: bytes) -> ReferenceFile:
    root = _find_root(data)
    if root in ("class_libraries", "library"):
        return _read_plugin_description(data)
    if root == "launch":
        return _read_launch(data)
    if root in ("robot", "sdf", "gazebo", "world", "model"):
        return _read_robot_description(data)
    return _read_behavior_trees(data) if root == "root" else ReferenceFile(())


def _read_plugin_xml(data: bytes) -> ReferenceFile:
    return _read_xml(data) if data.strip() else ReferenceFile((), (), (Problem(1, "is empty"),))


def _read_test(data: bytes) -> ReferenceFile:
    """A .launch or .test file; one that has no <launch> is something else of the same name."""
    if _find_root(data) == "launch":
        return _read_launch(data)
    document = scan(data)
    return ReferenceFile((), (), document.problems or (Problem(1, "has no `<launch>` element"),))


def _find_root(data: bytes) -> str:
    """Name of the first element, found without reading on."""
    for token in TOKEN.finditer(decode(data[:65536])):
        name = token["name"]
        if name is not None and not token["close"]:
            return name
    return ""


_ARGUMENT = re.compile(r"\s*\$\((?:arg|var)\s+([\w.-]+)\s*\)\s*\Z")


def _find_presets(document: Document) -> dict[str, str]:
    """What the arguments of a file are when it is started without any, as far as one element alone says so."""
    found: dict[str, set[str]] = {}
    for element in document.elements:
        if element.name in ("arg", "let") and (preset := element.find("default", "value")) is not None:
            plain = element.parent < 0 or document.elements[element.parent].name == "launch"
            if plain and not any(a.name in ("if", "unless") for a in element.attributes):
                found.setdefault(element.get("name"), set()).add(preset.value)
    return {name: values.pop() for name, values in found.items() if len(values) == 1}


def _find_conditions(document: Document, presets: dict[str, str]) -> list[tuple[Condition, ...]]:
    """For each element, the if and unless of it and those around it that keep it from running when the file is started
    without arguments, or that cannot be known."""

    def resolve_text(text: str) -> str:
        argument = _ARGUMENT.match(text)
        return (presets.get(argument.group(1), "") if argument is not None else text).strip().lower()

    found: list[tuple[Condition, ...]] = []
    for element in document.elements:
        conditions = found[element.parent] if element.parent >= 0 else ()
        if element.name in ("xacro:if", "xacro:unless"):
            if element.get("value").strip().lower() not in ("true", "1", "${true}"):
                conditions = (*conditions, UNDECIDED)
        else:
            for attribute in element.attributes:
                passed = {"if": ("true", "1"), "unless": ("false", "0")}.get(attribute.name)
                if passed is not None and resolve_text(attribute.value) not in passed:
                    test = read_machine_test(attribute.value, attribute.name == "unless", presets)
                    conditions = (*conditions, test)
        found.append(conditions)
    return found


def _add_all_mentions(found: _Found, element: Element, conditional: bool) -> None:
    """Mentions in all attributes and the text of an element."""
    for attribute in element.attributes:
        found.mentions(attribute.value, attribute.offset, conditional)
    found.mentions(element.text, element.text_offset, conditional)


NODES = frozenset({"node", "test", "node_container", "lifecycle_node", "composable_node_container"})


def _read_launch(data: bytes, kind: str = "launch_xml") -> ReferenceFile:
    document = read_document(data, kind)
    if kind == "launch_yaml" and not document.elements:  # arguments or parameters, called like a launch file
        return structs.replace(_read_yaml(data), problems=document.problems)
    found = _Found(document.locate)
    presets = _find_presets(document)
    under = _find_conditions(document, presets)
    for element, conditions in zip(document.elements, under, strict=True):
        name, conditional = element.name, found.stand_under(conditions)
        found.arguments = _list_include_arguments(element) if name == "include" else None
        if name in NODES:
            _add_node(found, element, conditional)
        elif name in ("composable_node", "load_composable_node"):
            package, plugin = _find_package(found, element), element.find("plugin")
            if plugin is not None and CLASS.match(plugin.value):
                known = package.value if package is not None else ""
                found.add("plugin", known, plugin.value, plugin.offset, conditional)
        elif name == "executable":
            _add_command(found, element.find("cmd"), conditional)
        elif name == "param":
            _add_command(found, element.find("command"), conditional)
            value = element.find("value")
            if value is not None and PLUGIN_KEY.search(element.get("name")):
                for m in re.finditer(r"[^\s,\[\]'\"]+", value.value):
                    if CLASS.match(m.group()):
                        found.add("plugin", "", m.group(), value.offset + m.start(), conditional)
        _add_all_mentions(found, element, conditional)
        if name == "rosparam" and element.text and "plugin" in element.text:
            _add_plugin_values(found, element.text, element.text_offset, conditional)
    generation = find_generation(document) if kind == "launch_xml" else 0
    made = structs.replace(found.make_file(*document.problems), generation=generation)
    if VARIABLE not in document.text:
        return made
    branched = tuple(list_branched(document, under, (*NODES, "include", "executable", "load_composable_node")))
    return structs.replace(made, branched=branched, compared=tuple(list_compared(document, presets)))


def _list_include_arguments(include: Element) -> tuple[str, ...] | None:
    """Names of the arguments that an `<include>` gives; None for one that gives all that it knows itself."""
    names = tuple(child.get("name") for child in include.children if child.name in ("arg", "let"))
    passes_all = include.get("pass_all_args").strip().lower() in ("true", "1")
    return None if passes_all or any("$" in name for name in names) else names


def _find_package(found: _Found, element: Element) -> Attribute | None:
    """The attribute that names an element's package; one that only running tells is unresolved, and None."""
    package = element.find("pkg")
    if package is None or PACKAGE.match(package.value):
        return package
    if "$" in package.value:
        found.unresolved.append(Problem(found.locate(package.offset)[0], package.value[:80]))
    return None


def _add_node(found: _Found, element: Element, conditional: bool) -> None:
    package = _find_package(found, element)
    executable = element.find("exec", "type")
    if package is None:
        return
    if executable is None or "$" in executable.value or not executable.value.strip():
        found.add("package", package.value, "", package.offset, conditional)
        return
    found.add("executable", package.value, executable.value.strip(), package.offset, conditional)
    arguments = element.find("args")
    if package.value == "nodelet" and arguments is not None:
        loaded = re.match(r"\s*(?:load|standalone)\s+(\S+)", arguments.value)
        if loaded is not None and CLASS.match(loaded.group(1)):
            found.add("plugin", "", loaded.group(1), arguments.offset + loaded.start(1), conditional)


def _add_command(found: _Found, attribute: Attribute | None, conditional: bool) -> None:
    """The program that a command line starts with, where it is named by itself and not by a path; the node or launch
    file that a command of ROS starts."""
    if attribute is None:
        return
    started = SHELL.match(attribute.value.lstrip())
    if started is not None:
        start = attribute.offset + len(attribute.value) - len(attribute.value.lstrip())
        _add_shell_command(found, started, start, conditional)
        return
    first = re.match(r"\s*([A-Za-z][\w.-]*)(?=\s|$)", attribute.value)
    if first is not None:
        found.add("command", "", first.group(1), attribute.offset + first.start(1), conditional)


def _read_robot_description(data: bytes) -> ReferenceFile:
    document = scan(data)
    found = _Found(document.locate)
    macros = _list_macros(document)
    for element, conditions, found.macro in zip(document.elements, _find_conditions(document, {}), macros, strict=True):
        conditional = found.stand_under(conditions)
        if element.name.startswith("xacro:") and element.name not in _OF_XACRO:
            found.add("macro", "", element.name.removeprefix("xacro:"), element.offset, conditional)
        elif element.name == "plugin":
            library = element.find("filename")
            if library is not None and library.value and not any(c in library.value for c in "$/{"):
                found.add("plugin", "", library.value, library.offset, conditional)
            elif element.text and CLASS.match(element.text):
                found.add("plugin", "", element.text, element.text_offset, conditional)
        elif (
            element.name == "type" and element.text.startswith("transmission_interface/") and CLASS.match(element.text)
        ):
            found.add("plugin", "", element.text, element.text_offset, conditional)
        _add_all_mentions(found, element, conditional)
    # xacro reads with Python's strict parser, URDF and SDF are read with TinyXML
    problems = document.problems if "xacro" in document.text else _drop_tolerated(data, document.problems)
    return structs.replace(found.make_file(*problems), joints=tuple(_list_controlled_joints(document)))


# Elements of xacro itself; any other calls the macro of its name. Source: xacro/__init__.py, eval_all().
_OF_XACRO = frozenset(
    f"xacro:{name}"
    for name in ("arg", "attribute", "call", "element", "if", "include", "insert_block", "macro", "property", "unless")
)


def _list_macros(document: Document) -> list[str]:
    """For each element, the innermost macro that it stands in; empty outside of all."""
    found: list[str] = []
    for element in document.elements:
        around = document.elements[element.parent] if element.parent >= 0 else None
        outer = found[element.parent] if element.parent >= 0 else ""
        found.append(around.get("name") if around is not None and around.name == "xacro:macro" else outer)
    return found


_INTERFACES = {"command_interface": "commands", "state_interface": "states"}
_WITHIN_JOINT = frozenset(("param", "xacro:if", "xacro:unless", "min", "max", "initial_value", "limits"))


def _list_controlled_joints(document: Document) -> Iterator[ControlledJoint]:
    """The joints, sensors and gpios with interfaces of ros2_control, in macros too."""
    if "_interface" not in document.text:
        return
    # The joint around each element, by its number; -1 outside of all.
    around: list[int] = []
    interfaces: dict[int, dict[str, list[str]]] = {}
    open_: set[int] = set()
    for number, element in enumerate(document.elements):
        parent = around[element.parent] if element.parent >= 0 else -1
        if parent < 0 and element.name in ("joint", "sensor", "gpio") and element.get("name"):
            parent = number
        elif parent >= 0 and (kind := _INTERFACES.get(element.name)):
            interfaces.setdefault(parent, {}).setdefault(kind, []).append(element.get("name"))
        elif parent >= 0 and element.name not in _WITHIN_JOINT:
            open_.add(parent)
        around.append(parent)
    for number, found in interfaces.items():
        element = document.elements[number]
        names = found.get("commands", []), found.get("states", [])
        whole = number not in open_ and all(name and "$" not in name for same in names for name in same)
        line = document.locate(element.offset)[0]
        yield ControlledJoint(element.get("name"), tuple(names[0]), tuple(names[1]), whole, line)


# What an element is called that names its node by `ID`; any other is called like its node.
_EXPLICIT = frozenset(("Action", "Condition", "Control", "Decorator"))
_PARTS_OF_NODES = frozenset(("remap", "Metadata"))


def _read_behavior_trees(data: bytes) -> ReferenceFile:
    """The nodes of trees of BehaviorTree.CPP, version 3 or 4."""
    document = scan(data)
    found = _Found(document.locate)
    trees: list[str] = []
    modelled: list[str] = []
    inside: list[str] = []
    for element in document.elements:
        above = inside[element.parent] if element.parent >= 0 else ""
        inside.append(element.name if element.name in ("BehaviorTree", "TreeNodesModel") else above)
        if element.name == "BehaviorTree":
            trees.append(element.get("ID"))
        elif above == "TreeNodesModel" and (name := element.get("ID")):
            modelled.append(name)
        elif above == "BehaviorTree" and element.name not in _PARTS_OF_NODES:
            attribute = element.find("ID") if element.name in _EXPLICIT else None
            name, offset = (attribute.value, attribute.offset) if attribute else (element.name, element.offset + 1)
            if name not in _EXPLICIT and _TREE_NODE.match(name):
                found.add("tree node", "", name, offset, False)
                _add_ports(found, document.text, element, name)
    return structs.replace(found.make_file(), trees=tuple(trees), modelled=tuple(modelled))


_TREE_NODE = re.compile(r"\w[\w .-]*\Z")
_NO_PORTS = frozenset(("name", "ID"))
# What begins with an underscore is read by the parser itself.
_TREE_PORT = re.compile(r"[A-Za-z][\w.-]*\Z")


def _add_ports(found: _Found, text: str, element: Element, node: str) -> None:
    """The ports that an element gives a value; of a subtree they are whatever that uses."""
    for attribute in element.attributes if not node.startswith("SubTree") else ():
        if attribute.name not in _NO_PORTS and _TREE_PORT.match(attribute.name):
            offset = text.rfind(attribute.name, element.offset, attribute.offset)
            found.add("tree port", "", f"{node} {attribute.name}", offset, False)


def _read_plugin_description(data: bytes) -> ReferenceFile:
    document = scan(data)
    classes: list[PluginClass] = []
    library = ""
    for element in document.elements:
        if element.name == "library":
            library = element.get("path")
        elif element.name == "class":
            type_ = element.get("type")
            line = document.locate(element.offset)[0]
            # pluginlib takes the type for the name of a class that has none
            classes.append(
                PluginClass(element.get("name", type_), type_, element.get("base_class_type"), library, line)
            )
    return ReferenceFile((), tuple(classes), _drop_tolerated(data, document.problems))


COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
DECLARATION = re.compile(rb"<\?xml[^>]*\?>")
VALUE = re.compile(rb"=\s*\"[^\"\n]*\"")


def _drop_tolerated(data: bytes, problems: tuple[Problem, ...]) -> tuple[Problem, ...]:
    """Problems less those that TinyXML, which pluginlib, urdfdom and sdformat read with, does not mind: `--` in
    comments, several roots, `<` in values, a misspelt or late XML declaration."""
    if not problems:
        return ()
    # What stands behind the last comment that is closed need not be looked through for each that is opened there.
    closed = data.rfind(b"-->") + 3 if b"-->" in data else 0
    blanked = COMMENT.sub(lambda m: b"\n" * m.group().count(b"\n"), data[:closed]) + data[closed:]
    if "declaration" in problems[0].message:
        blanked = DECLARATION.sub(lambda m: b"\n" * m.group().count(b"\n"), blanked, count=1)
    blanked = VALUE.sub(lambda m: m.group().replace(b"<", b"&lt;"), blanked)
    found = (p for p in find_xml_problems(blanked) if "junk after document element" not in p.message)
    return tuple(Problem(p.line, p.message) for p in found)  # columns are those of what is blanked


PLUGIN_KEY = re.compile(r"(?:plugins?|kinematics_solver|_adapters|_layer)\Z")
# Values of YAML that name classes: `plugin: "a::B"`, `type: some_controllers/SomeController`, also within braces.
CLASS_VALUE = re.compile(
    r"(?<![\w/:.-])(?P<key>[A-Za-z_][\w.]*)[\"']?[ \t]*:[ \t]*[\"']?"
    r"(?P<value>[A-Za-z_]\w*(?:(?:::|/)[A-Za-z_]\w*)+)(?=[\"']?[ \t]*(?:[\r\n,}\]#]|\Z))"
)
CLASS_LIST = re.compile(
    r"^[ \t]*(?:-[ \t]+)?(?P<key>[A-Za-z_][\w.]*(?:plugins|adapters))[\"']?[ \t]*:[ \t]*(?:[>|][+-]?)?[ \t]*\r?\n"
    r"(?P<items>(?:[ \t]*(?:-[ \t]+)?[\"']?[A-Za-z_]\w*(?:(?:::|/)[A-Za-z_]\w*)+[\"']?[ \t]*(?:\#[^\n]*)?\r?"
    r"(?:\n|\Z))+)",
    re.MULTILINE,
)
ITEM = re.compile(r"^[ \t]*(?:-[ \t]+)?[\"']?(?P<value>[A-Za-z_][\w:/]*)", re.MULTILINE)
# OMPL's planners (`type: geometric::RRT`) look like classes and are none of a plugin's.
TYPE_OF_CLASS = re.compile(
    r"(?!geometric::|control::).*(?:::|/\w*(?:Controller|Broadcaster|Filter|Hardware|Layer)\w*\Z|controllers?/)"
)


def _add_plugin_values(found: _Found, text: str, offset: int, conditional: bool) -> None:
    for m in CLASS_VALUE.finditer(text):
        key, value = m["key"].rpartition(".")[2], m["value"]
        if not (PLUGIN_KEY.search(key) or (key == "type" and TYPE_OF_CLASS.match(value))):
            continue
        if "#" in text[text.rfind("\n", 0, m.start()) + 1 : m.start()]:
            continue
        found.add("plugin", "", value, offset + m.start("value"), conditional)
    for m in CLASS_LIST.finditer(text):
        for item in ITEM.finditer(m["items"]):
            found.add("plugin", "", item["value"], offset + m.start("items") + item.start("value"), conditional)


# Libraries of nodes of behaviour trees, which Nav2 and others load: a list in one line, or of an item each.
LIBRARIES = re.compile(r"[ \t]*[\"']?[\w.]{0,100}plugin_lib(?:_name|rarie)?s[\"']?[ \t]*:(?P<rest>.*)")
LIBRARY = re.compile(r"[\w.-]+")
LIBRARY_ITEM = re.compile(r"[ \t]*-[ \t]+[\"']?(?P<name>[\w.-]+)[\"']?[ \t]*(?:#.*)?\r?\Z")


def _add_libraries(found: _Found, text: str) -> None:
    """The libraries that lists of them name."""
    offset = 0
    reading = ""
    for line in text.split("\n"):
        start, offset = offset, offset + len(line) + 1
        opened = LIBRARIES.match(line)
        if opened is not None:
            line, start = opened["rest"].partition("#")[0], start + opened.start("rest")
            reading = "inline" if line.strip().startswith("[") else "items" if not line.strip() else ""
        item = LIBRARY_ITEM.match(line) if reading == "items" else None
        if reading == "inline":
            for name in LIBRARY.finditer(line.partition("#")[0].partition("]")[0]):
                _add_library(found, name.group(), start + name.start())
            reading = "" if "]" in line else reading
        elif item is not None:
            _add_library(found, item["name"], start + item.start("name"))
        elif opened is None and line.strip() and not line.lstrip().startswith("#"):
            reading = ""


def _add_library(found: _Found, name: str, offset: int) -> None:
    found.add("library", "", name.removeprefix("lib").removesuffix(".so"), offset, False)


def _read_params(data: bytes) -> ReferenceFile:
    if data[:4096].lstrip().startswith(b"launch:"):
        return _read_launch(data, "launch_yaml")
    return _read_yaml(data)


def _read_yaml(data: bytes) -> ReferenceFile:
    """References of YAML that is no launch file."""
    # Most YAML of a workspace (calibration, CI, statistics) mentions nothing; a search is cheaper than a reading.
    if not YAML_WORTH_READING.search(data):
        return ReferenceFile(())
    text = decode(data)
    found = _Found(Document(text).locate)
    _add_plugin_values(found, text, 0, False)
    if "plugin_lib" in text:
        _add_libraries(found, text)
    for m in re.finditer(r"^.*(?:\$\(|://).*$", text, re.MULTILINE):
        line = m.group()
        comment = re.search(r"(?:^|\s)#", line)
        found.mentions(line[: comment.start()] if comment is not None else line, m.start(), False)
    found.references.sort(key=lambda r: (r.line, r.column))
    return found.make_file()


YAML_WORTH_READING = re.compile(rb"plugin|type|adapters|kinematics_solver|_layer|package://|model://|\$\(find")


# A command where a command can stand: at a line's start, after a separator, or inside a substitution. Text in quotes
# (messages, usage) is none of these.
SHELL = re.compile(
    r"(?:^|[;&|(`!]|\b(?:then|do|else|exec|sudo|nohup|time|eval|coproc)\s)[ \t]*(?:[A-Za-z_]\w*=\S*[ \t]+)*"
    r"(?P<command>rosrun|roslaunch|rostest|rospack[ \t]+find|roscd|ros2[ \t]+(?:run|launch|pkg[ \t]+prefix|component"
    r"[ \t]+standalone))\b(?P<args>[^;&|)`<>\n#]*)"
)
WORTH_READING = re.compile(rb"ros(?:run|launch|test|pack|cd|2)\b|package://")
HEREDOC = re.compile(r"<<-?\s*\\?['\"]?([A-Za-z_]\w*)['\"]?")
LITERAL = re.compile(r"[A-Za-z0-9_.:+/-]+\Z")
WITH_VALUE = frozenset({"--prefix", "-p", "--port", "--log", "--skip-log-check"})


def _read_shell(data: bytes) -> ReferenceFile:
    if not WORTH_READING.search(data):
        return ReferenceFile(())
    text = decode(data)
    found = _Found(Document(text).locate)
    heredoc = ""
    depth = 0
    offset = 0
    generations: set[int] = set()
    for line in text.split("\n"):
        start, offset = offset, offset + len(line) + 1
        stripped = line.strip()
        if heredoc:
            if stripped == heredoc:
                heredoc = ""
            continue
        if not stripped or stripped[0] == "#":
            continue
        opened = HEREDOC.search(line)
        if opened is not None and "<<<" not in line:
            heredoc = opened.group(1)
        if re.match(r"(?:if|case)\b", stripped):
            depth += 1
        for m in SHELL.finditer(line):
            generations.add(2 if m["command"].startswith("ros2") else 1)
            _add_shell_command(found, m, start, depth > 0)
        for m in re.finditer(r"package://[^\s\"']+", line):
            found.mentions(m.group(), start + m.start(), depth > 0)
        if re.search(r"(?:^|;)\s*(?:fi|esac)\b", stripped):
            depth = max(depth - 1, 0)
    return msgspec.structs.replace(found.make_file(), generation=generations.pop() if len(generations) == 1 else 0)


def _add_shell_command(found: _Found, match: re.Match[str], start: int, conditional: bool) -> None:
    command = " ".join(match["command"].split())
    words = [(w.group(), w.start()) for w in re.finditer(r"\S+", match["args"])]
    plain: list[tuple[str, int]] = []
    skip = False
    for word, at in words:
        if skip:
            skip = False
        elif word.startswith("-") and not plain:
            skip = word in WITH_VALUE
        else:
            plain.append((word.strip("\"'"), at))
    if not plain:
        return
    (package, at), *rest = plain
    offset = start + match.start("args") + at
    if not PACKAGE.match(package):
        if "$" in package:
            found.unresolved.append(Problem(found.locate(offset)[0], f"{command} {package}"[:80]))
        return
    name = rest[0][0] if rest and LITERAL.match(rest[0][0]) else ""
    if command in ("rosrun", "ros2 run") and name:
        found.add("executable", package, name, offset, conditional)
    elif command in ("roslaunch", "ros2 launch", "rostest"):
        if rest and name and re.search(r"\.(?:launch|test|xml|py|ya?ml)\Z", name):
            found.add("sought", package, name, offset, conditional)
        elif rest and "$" in rest[0][0]:
            found.add("package", package, "", offset, conditional)
    elif command == "ros2 component standalone" and CLASS.match(name):
        found.add("plugin", package, name, offset, conditional)
    elif command in ("rospack find", "roscd", "ros2 pkg prefix", "rosrun", "ros2 run"):
        found.add("package", package, "", offset, conditional)


READERS: dict[str, Callable[[bytes], ReferenceFile]] = {
    "launch_xml": _read_test,
    "launch_yaml": partial(_read_launch, kind="launch_yaml"),
    "xacro": _read_robot_description,
    "plugin_xml": _read_plugin_xml,
    "xml": _read_xml,
    "params": _read_params,
    "shell": _read_shell,
}
