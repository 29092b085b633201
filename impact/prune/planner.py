"""What pruning a workspace changes: which topics get a lighter message, and every edit that this takes."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from ...edges.groups import group_pairs
from ..analysis.fields import read_section
from ..analysis.fix import apply, declare_dependency
from ..facts.flow import DataMember
from ..facts.interface import PRIMITIVES, TIMES, extract, make_full_name
from ..model.fields.reading import Reading, select_parameters
from ..model.fields.report import FieldReport, TopicFields
from ..model.fields.shapes import Path
from ..model.fields.topics import TopicReader
from ..model.flow.code import Fn, Variable, get_tail
from ..model.flow.endpoints import Site, Statement
from ..model.flow.graph import Endpoint
from ..model.wire import LayoutError, build_layout, compute_size
from ..model.workspace import Workspace
from ..rules.fix_actions import Edit
from .conversions import Conversion, list_python_types, write_cpp, write_python
from .cpp_source import CppEditor, EditRefused, find_header
from .light import LightDefinition, LightenError, lighten
from .package_files import list_messages, order_after, use_package, write_package
from .python_source import PythonEditor
from .shape import LightField, keep_fields, list_fields, list_paths, name_nested

_PLAIN = frozenset(("roscpp", "rclcpp", "rospy", "rclpy", "rclcpp_lifecycle"))
_ASKED = frozenset(
    ("publish", "getNumSubscribers", "get_num_connections", "get_subscription_count", "getTopic", "get_topic_name",
     "shutdown", "reset", "on_activate", "on_deactivate", "is_activated", "isLatched", "unregister",
     "get_intra_process_subscription_count")
)  # fmt: skip
_UNSURE = frozenset(("default", "partly", "unresolved"))
_NAME = re.compile(r"[A-Za-z0-9]+")
SiteKey = tuple[str, int, str]


class TopicPlan(NamedTuple):
    """A lighter message. topics: that get it. light: `package/Name`. keep, dropped: fields of the full one, by path.
    files: that change. full_bytes, light_bytes: of a message whose strings and arrays have the length that was asked
    for, 0 where that is not known."""

    topics: tuple[str, ...]
    type: str
    light: str
    keep: tuple[str, ...]
    dropped: tuple[str, ...]
    files: tuple[str, ...]
    full_bytes: int = 0
    light_bytes: int = 0


class Refusal(NamedTuple):
    """A topic that keeps its message. reason: a clause."""

    topic: str
    type: str
    reason: str


class PrunePlan(NamedTuple):
    """changed: new bytes by path; created: of files that are not there yet."""

    plans: tuple[TopicPlan, ...]
    refusals: tuple[Refusal, ...]
    changed: dict[str, bytes]
    created: dict[str, bytes]


class _Made(NamedTuple):
    """What one lighter message takes: edits, and new files."""

    plan: TopicPlan
    edits: list[Edit]
    created: dict[str, bytes]


class Planner:
    """Plans for a workspace. report: its fields, with topics closed as the user knows. closed: these topics.
    read: the bytes of a path, None where it cannot be read. length: of strings and arrays, to tell sizes.
    find_definition: gives the text of the message `package/Name`."""

    def __init__(
        self, workspace: Workspace, topics: TopicReader, report: FieldReport, closed: Collection[str],
        read: Callable[[str], bytes | None], length: int, find_definition: Callable[[str], bytes | None],
    ):  # fmt: skip
        self.workspace, self.topics, self.report = workspace, topics, report
        self.closed, self.read, self.length, self.find_definition = closed, read, length, find_definition
        self.code, self.join = topics.join.code, topics.join
        # Lighter messages by the full one and what is kept.
        self._made: dict[tuple[str, tuple[str, ...]], dict[str, LightDefinition]] = {}
        self._named: set[str] = set()
        # The edits that make a CMakeLists.txt know the new package, which several messages need.
        self._using: dict[str, list[Edit]] = {}
        # Topics that share code with topics of another type.
        self._blocked: dict[tuple[str, str], str] = {}

    def plan(self, wanted: Collection[str] = ()) -> PrunePlan:
        """The plan for some topics, all where none is named."""
        able: list[tuple[str, tuple[Sequence[TopicFields], _Made]]] = []
        refusals: list[Refusal] = []
        for group in self._list_groups():
            names = [topic.topic for topic in group]
            if wanted and not any(name in wanted for name in names):
                continue
            one = self._find_obstacle(group) or self._make_or_explain(group)
            if isinstance(one, str):
                refusals += _refuse(group, one)
            else:
                able.append((one.plan.light, (group, one)))
        made: list[_Made] = []
        for sharing in group_pairs(able).values():
            # Made at once, so that a file which uses the message for several topics defines its functions once.
            groups = [group for group, _ in sharing]
            one = sharing[0][1]
            if len(groups) > 1:
                together = self._make_or_explain([topic for group in groups for topic in group])
                if isinstance(together, str):
                    refusals += (row for group in groups[1:] for row in _refuse(group, together))
                else:
                    one = together
            made.append(one)
        originals: dict[str, bytes | None] = {}

        def read(path: str) -> bytes | None:
            if path not in originals:
                originals[path] = self.read(path)
            return originals[path]

        applied = apply([one.edits for one in made], read)
        lost = {edit.path: why for edit, why in applied.refused}
        plans: list[TopicPlan] = []
        created: dict[str, bytes] = {}
        for one in made:
            clash = next((f"{path}: {lost[path]}" for path in one.plan.files if path in lost), "")
            if clash:
                refusals += [Refusal(topic, one.plan.type, clash) for topic in one.plan.topics]
            else:
                plans.append(one.plan)
                created.update(one.created)
        if lost:
            kept = [one.edits for one in made if one.plan in plans]
            applied = apply(kept, read)
        created.update(self._write_new_package(one for one in made if one.plan in plans))
        return PrunePlan(tuple(plans), tuple(refusals), applied.files, created)

    def _make_or_explain(self, group: Sequence[TopicFields]) -> _Made | str:
        """The lighter message of a group, or why it cannot be made."""
        try:
            return self._make(group)
        except (EditRefused, LightenError) as error:
            return str(error)

    # Topics that go together

    def _list_groups(self) -> Iterator[list[TopicFields]]:
        """Topics that share code which makes their endpoints, calls or publishes: they get one message, or none."""
        every = {(one.topic, one.type): one for one in self.report.topics}
        parent = {key: key for key in every}

        def find(key: tuple[str, str]) -> tuple[str, str]:
            while parent[key] != key:
                key = parent[key]
            return key

        for place, keys in self._list_shared(every):
            first, *others = keys
            for other in others:
                if other[1] == first[1]:
                    parent[find(other)] = find(first)
                else:
                    why = f"{place} is shared with {{}}, which is of another type"
                    self._blocked.setdefault(first, why.format(other[0]))
                    self._blocked.setdefault(other, why.format(first[0]))
        groups = group_pairs((find(key), every[key]) for key in sorted(every))
        yield from groups.values()

    def _list_shared(
        self, every: Mapping[tuple[str, str], TopicFields]
    ) -> Iterable[tuple[str, list[tuple[str, str]]]]:
        """Topics by what they share, in words."""
        at: dict[str, list[tuple[str, str]]] = {}
        for endpoint in self.topics.graph.endpoints:
            key = endpoint.topic, endpoint.type
            if key not in every or endpoint.role not in ("publisher", "subscriber"):
                continue
            at.setdefault(f"the {endpoint.role} at {endpoint.path}:{endpoint.line}", []).append(key)
            at.setdefault(f"the name {endpoint.topic}", []).append(key)
            for site in self.topics.sites.get((endpoint.path, endpoint.line), ()):
                for path, member in self.list_members(site.variable) if site.role == endpoint.role else ():
                    # A declaration that names the message is of one type for all that it declares.
                    if "<" in member.type:
                        at.setdefault(f"`{member.type}` at {path}:{member.line}", []).append(key)
            if endpoint.role == "subscriber":
                for fn in self.topics.list_callbacks(endpoint):
                    at.setdefault(f"the callback at {fn.source.path}:{fn.facts.line}", []).append(key)
        for publish in self.topics.graph.publishes:
            if (publish.topic, publish.type) in every:
                place = f"the statement at {publish.path}:{publish.line}"
                at.setdefault(place, []).append((publish.topic, publish.type))
        return at.items()

    def list_members(self, variable: Variable | None) -> Iterator[tuple[str, DataMember]]:
        """The declarations of a member, each with the path of its file."""
        if variable is not None and variable.kind == "member":
            for cls in self.code.list_class_bodies(variable.owner):
                yield from ((cls.source.path, one) for one in cls.facts.members if one.name == variable.name)

    def _find_obstacle(self, group: Sequence[TopicFields]) -> str:
        """Why the topics of a group keep their message, empty where nothing is seen yet."""
        for topic in group:
            if topic.open:
                return f"{topic.open[0]}; if nobody else reads {topic.topic}, say --assume-closed {topic.topic}"
            if not topic.publishers and not any(self.list_endpoints(topic, "publisher")):
                return "nobody here publishes it, so that nobody could fill a lighter message"
        if not self._list_dropped(group):
            rows = (one for topic in group for one in topic.subscribers)
            whole = [escape for one in rows for escape in one.escapes if not escape.field]
            if whole:
                return f"the whole message is handed on: {whole[0].reason}, {whole[0].path}:{whole[0].line}"
            return "every field is read"
        return next((self._blocked[key] for topic in group if (key := (topic.topic, topic.type)) in self._blocked), "")

    def _list_dropped(self, group: Sequence[TopicFields]) -> list[str]:
        return [leaf for leaf in group[0].fields if all(leaf in topic.unread for topic in group)]

    def _list_named(self, group: Sequence[TopicFields]) -> set[str]:
        """Fields that are kept for the code that names them, or what they are a part of, without reading them."""
        found: set[str] = set()
        dropped = set(self._list_dropped(group))
        for topic in group:
            for endpoint in self.list_endpoints(topic, "subscriber"):
                for path in self.topics.read(self.topics.list_callbacks(endpoint), endpoint, topic.type).named:
                    below = [leaf for leaf in topic.fields if _split(leaf)[: len(path)] == path]
                    if all(leaf in dropped and leaf not in found for leaf in below):
                        found.update(sorted(below, key=lambda leaf: ("[]" in leaf, below.index(leaf)))[:1])
        return found

    def _check_types(self, group: Sequence[TopicFields], partial: Collection[Path]) -> None:
        """Raises EditRefused where code asks for the class of what gets another one. partial: fields that get one."""
        for topic in group:
            for endpoint in self.list_endpoints(topic, "subscriber"):
                typed = self.topics.read(self.topics.list_callbacks(endpoint), endpoint, topic.type).typed
                for path, place in typed.items():
                    if not path or path in partial:
                        raise EditRefused(f"{place.path}:{place.line} asks for the class of the message")

    def list_endpoints(self, topic: TopicFields, role: str) -> Iterator[Endpoint]:
        """The endpoints of a topic, publishers or subscribers."""
        for one in self.topics.graph.endpoints:
            if one.topic == topic.topic and one.type == topic.type and one.role == role:
                yield one

    # One message

    def _make(self, group: Sequence[TopicFields]) -> _Made:
        """The lighter message of a group, with all that has to change. Raises EditRefused and LightenError."""
        type_ = group[0].type
        dropped = set(self._list_dropped(group))
        dropped -= self._list_named(group)
        leaves = [_split(leaf) for leaf in group[0].fields if leaf not in dropped]
        fields = keep_fields(self.find_definition, type_, leaves)
        if fields is None:
            raise EditRefused(f"the definition of {type_} cannot be read")
        paths = tuple(list_paths(fields))
        gone = [leaf for leaf in group[0].fields if not any(_is_below(leaf, path) for path in paths)]
        if not paths:
            raise EditRefused("no field is read; take the subscribers away, or send an Empty")
        if not gone:
            raise EditRefused("what is not read is in a part that is kept whole")
        made = self._lighten(type_, paths, [topic.topic for topic in group])
        package = self._find_home(type_)
        light = f"{package}/{next(iter(made))}"
        texts = {f"{package}/{name}": one.text for name, one in made.items()}
        fields = name_nested(fields, light, texts.get)
        work = _Work(self, group, type_, light, fields)
        self._check_types(group, work.partial)
        edits = work.collect()
        created = self._put_definitions(type_, made, edits)
        files = tuple(sorted({edit.path for edit in edits} | created.keys()))
        sizes = [self._measure(one, texts) for one in (type_, light)]
        plan = TopicPlan(tuple(topic.topic for topic in group), type_, light, paths, tuple(gone), files, *sizes)
        return _Made(plan, edits, created)

    def _lighten(self, type_: str, paths: tuple[str, ...], topics: Sequence[str]) -> dict[str, LightDefinition]:
        known = self._made.get((type_, paths))
        if known is None:
            package, _, name = type_.partition("/")
            topic = "".join(part[:1].upper() + part[1:] for part in _NAME.findall(topics[0].rpartition("/")[2]))
            base = f"{name}Light" if topic in ("", name) else f"{name}{topic}Light"
            home = self.workspace.packages.get(package)
            own = {one.name: self.read(one.path) or b"" for one in home.linked.interfaces} if home is not None else {}
            # A script may import messages of several packages by their names.
            every = (one.name for each in self.workspace for one in each.linked.interfaces)
            taken = {other.lower() for other in (*every, *self._named)}
            chosen, number = base, 2
            while chosen.lower() in taken:
                chosen, number = f"{base}{number}", number + 1
            known = lighten(self.find_definition, type_, paths, chosen, own, self._find_home(type_))
            self._named.update(known)
            self._made[type_, paths] = known
        return known

    def _put_definitions(
        self, type_: str, made: Mapping[str, LightDefinition], edits: list[Edit]
    ) -> dict[str, bytes]:
        """The new files, and into the edits the lines of CMakeLists.txt that name them. Raises EditRefused."""
        package, _, name = type_.partition("/")
        found = self.workspace.packages.get(package)
        if found is None:
            self._use_new_package(package, edits)
            folder = f"{self._find_new_folder(edits)}/msg"
            return {f"{folder}/{each}.msg": one.text for each, one in made.items()}
        at = next(one.path for one in found.linked.interfaces if one.name == name and one.path.endswith(".msg"))
        folder = at.rpartition("/")[0]
        build = f"{found.path}/CMakeLists.txt".lstrip("/")
        data = self.read(build)
        listed = list_messages(build, data, name, list(made)) if data is not None else None
        if listed is None:
            raise EditRefused(f"{build} does not name {name}.msg, so that a message beside it cannot be added")
        edits += listed
        return {f"{folder}/{each}.msg".lstrip("/"): one.text for each, one in made.items()}

    def _find_home(self, type_: str) -> str:
        """The package that the lighter message of a message belongs into."""
        package = type_.partition("/")[0]
        return package if package in self.workspace.packages else self._new_package

    @cached_property
    def _new_package(self) -> str:
        name, number = "light_msgs", 2
        while name in self.workspace.packages:
            name, number = f"light_msgs{number}", number + 1
        return name

    def _find_new_folder(self, edits: Sequence[Edit]) -> str:
        """The folder of the new package: beside the packages that use it. Raises EditRefused."""
        paths = [found.path for found in self.workspace if found.path]
        if len(paths) < len(self.workspace.packages):
            raise EditRefused("the whole workspace is one package, so that there is no place for one of messages")
        beside = sorted(path.rpartition("/")[0] for path in paths)
        return f"{beside[0]}/{self._new_package}".lstrip("/")

    def _use_new_package(self, old: str, edits: list[Edit]) -> None:
        """Adds to edits what the packages need that use a message of the new package. old: that of the full message.
        Raises EditRefused."""
        ros, touched = self.workspace.ros, {edit.path for edit in edits}
        for package in self.workspace:
            own = touched.intersection(package.linked.files)
            if not own:
                continue
            manifest, build = (f"{package.path}/{name}".lstrip("/") for name in ("package.xml", "CMakeLists.txt"))
            data = self.read(manifest)
            if data is not None:
                edits += declare_dependency(data, self._new_package, "depend", manifest)
            compiled = any(self.find_language(path) == "cpp" for path in own)
            data = self.read(build)
            if data is None or not compiled:
                continue
            if build not in self._using:
                found = use_package(build, data, old, self._new_package, ros)
                if found is None:
                    raise EditRefused(f"{build} does not name {old}, so that a package beside it cannot be found there")
                self._using[build] = found
            edits += self._using[build]
            if ros == 1:
                edits += order_after(build, data, (target.name for target in package.build.targets))

    def find_language(self, path: str) -> str:
        """`cpp` or `python`."""
        return next((one.facts.language for one in self.code.sources if one.path == path), "cpp")

    def _write_new_package(self, made: Iterable[_Made]) -> dict[str, bytes]:
        """The files of the new package besides its messages, where there are any."""
        texts = {
            path: data
            for one in made
            if one.plan.light.partition("/")[0] == self._new_package
            for path, data in one.created.items()
        }
        if not texts:
            return {}
        folder = next(iter(texts)).rpartition("/msg/")[0]
        names = [path.rpartition("/")[2].removesuffix(".msg") for path in texts]
        needs = set[str]()
        for data in texts.values():
            for field in extract(data, "msg").sections[0].fields:
                plain = field.type.partition("<=")[0]
                if plain not in PRIMITIVES and plain not in TIMES:
                    needs.add(make_full_name(plain, self._new_package).partition("/")[0])
        files = write_package(self._new_package, self.workspace.ros, names, needs - {self._new_package})
        return {f"{folder}/{name}": data for name, data in files.items()}

    def _measure(self, type_: str, texts: Mapping[str, bytes]) -> int:
        def find_section(name: str):
            return read_section(texts.get(name) or self.find_definition(name))

        encoding = "ros1" if self.workspace.ros == 1 else "cdr"
        try:
            return compute_size(build_layout(find_section, type_, encoding), {}, encoding, self.length)
        except LayoutError:
            return 0


def _refuse(group: Iterable[TopicFields], reason: str) -> list[Refusal]:
    return [Refusal(topic.topic, topic.type, reason) for topic in group]


def _split(leaf: str) -> Path:
    return tuple(leaf.replace("[]", ".[]").split("."))


def _is_below(leaf: str, path: str) -> bool:
    plain = leaf.replace("[]", "")
    return plain == path or plain.startswith(f"{path}.")


class _Work:
    """The edits for one lighter message."""

    def __init__(
        self, planner: Planner, group: Sequence[TopicFields], type_: str, light: str, fields: tuple[LightField, ...]
    ):
        self.planner, self.topics, self.code = planner, planner.topics, planner.code
        self.group, self.type, self.light, self.fields = group, type_, light, fields
        self.names = {topic.topic for topic in group}
        self.ros = planner.workspace.ros
        self.editors: dict[str, CppEditor | PythonEditor] = {}
        # The files in C++ whose publish statements are wrapped, by whether pointers are published; and those whose
        # callbacks are given the full message.
        self.pointers: dict[str, bool] = {}
        self.widened: list[str] = []
        # The names of publishers and subscriptions whose types change.
        self.variables = set[str]()
        self.partial = {path for path in _list_partial(fields, ())}
        stem = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", light.partition("/")[2]).lower()
        own = ", ".join(sorted(self.names))
        self.fill = Conversion(f"fill_{stem}", type_, light, own, fields)
        self.widen = Conversion(f"widen_{stem}", type_, light, own, fields, True)

    def collect(self) -> list[Edit]:
        """All edits. Raises EditRefused."""
        sites = self._list_sites()
        self.variables = {site.variable.name for site in sites if site.variable is not None}
        for site in sites:
            self._retype_site(site)
        done: set[Fn] = set()
        for site in sites:
            for fn in site.callbacks if site.role == "subscriber" else ():
                if fn not in done:
                    done.add(fn)
                    self._retype_callback(fn)
        self._wrap_statements({site for site in sites if site.role == "publisher"})
        self._add_functions(self.fill, list(self.pointers), any(self.pointers.values()))
        self._add_functions(self.widen, self.widened, False)
        self._add_headers()
        return [edit for editor in self.editors.values() for edit in editor.finish()]

    def _add_functions(self, one: Conversion, paths: Sequence[str], pointers: bool) -> None:
        """Writes a function into the files that call it; once for all where some may be included together."""
        text = write_cpp(one, self.ros, pointers)
        own = list(dict.fromkeys(paths))
        if len(own) > 1 and any(self.code.includes(source.path, path) for source in self.code.sources for path in own):
            guard = f"{self.light.partition('/')[0]}_{one.name}_defined".upper()
            text = f"#ifndef {guard}\n#define {guard}\n{text}#endif\n"
        for path in own:
            self._get_cpp(path).add_block(text)

    def _add_headers(self) -> None:
        """Includes the lighter message where the full one is, and where no such file is included."""
        full = find_header(self.type, self.ros)
        editors = {path: one for path, one in self.editors.items() if isinstance(one, CppEditor) and one.edits}
        having = {path for path, one in editors.items() if one.has_header(full)}
        for path, editor in editors.items():
            if path in having or not any(self.code.includes(path, other) for other in having):
                editor.add_header(find_header(self.light, self.ros), full)

    def _list_sites(self) -> list[Site]:
        """Where the code makes the endpoints of the topics. Raises EditRefused where they may be others too."""
        found: dict[SiteKey, Site] = {}
        for topic in self.group:
            for role in ("subscriber", "publisher"):
                for endpoint in self.planner.list_endpoints(topic, role):
                    where = f"{endpoint.path}:{endpoint.line}"
                    if endpoint.implied or endpoint.framework not in _PLAIN:
                        raise EditRefused(f"{where} is made by {endpoint.framework or 'a framework'}, not by the code")
                    if endpoint.how in _UNSURE and topic.topic not in self.planner.closed:
                        raise EditRefused(
                            f"the name at {where} is the default of a parameter, so that another may be given; if it "
                            f"is not, say --assume-closed {topic.topic}"
                        )
                    sites = self.topics.sites.get((endpoint.path, endpoint.line), ())
                    own = [site for site in sites if site.role == role]
                    if len(own) != 1:
                        raise EditRefused(f"{where} makes several endpoints")
                    found[endpoint.path, endpoint.line, role] = own[0]
        for key in found:
            self._check_names(key)
        return list(found.values())

    def _check_names(self, key: SiteKey) -> None:
        for one in self.topics.graph.endpoints:
            if (one.path, one.line, one.role) == key and one.topic not in self.names:
                name = one.topic or "a topic whose name is not known"
                raise EditRefused(f"{one.path}:{one.line} is {name} too")

    def _get_editor(self, path: str) -> CppEditor | PythonEditor:
        if path not in self.editors:
            data = self.planner.read(path)
            if data is None:
                raise EditRefused(f"{path} cannot be read")
            python = self.planner.find_language(path) == "python"
            self.editors[path] = PythonEditor(path, data) if python else CppEditor(path, data, self.ros)
        return self.editors[path]

    def _get_cpp(self, path: str) -> CppEditor:
        editor = self._get_editor(path)
        assert isinstance(editor, CppEditor)
        return editor

    # Endpoints

    def _retype_site(self, site: Site) -> None:
        use = site.use
        path, call = use.fn.source.path, use.call
        where = f"{path}:{call.line}"
        editor = self._get_editor(path)
        if isinstance(editor, PythonEditor):
            editor.retype_call(call.line, get_tail(call.callee), self.type, self.light)
        else:
            count = editor.retype_call(call.line, call.column, self.type, self.light)
            if not count and (self.ros == 2 or site.role == "publisher"):
                raise EditRefused(f"{where} names its type otherwise")
        if site.role == "publisher" and site.variable is not None:
            self._check_uses(site.variable, where)
            self._check_readable(site.variable, path)
        if site.variable is not None and not isinstance(editor, PythonEditor):
            self._retype_variable(site.variable, use.fn)

    def _check_uses(self, variable: Variable, where: str) -> None:
        """Raises EditRefused where a publisher is handed to what is not followed."""
        for place in self.topics.reader.uses.list_uses(variable):
            use = place.use
            fine = use.how in ("test", "write", "size", "change") or (use.how == "method" and use.to in _ASKED)
            if not fine:
                raise EditRefused(
                    f"the publisher of {where} is handed on at {place.fn.source.path}:{use.line}, which is not followed"
                )

    def _check_readable(self, variable: Variable, path: str) -> None:
        """Raises EditRefused where macros, or lines that did not parse, may publish too."""
        paths = {path}
        for cls in self.code.list_class_bodies(variable.owner) if variable.kind == "member" else ():
            paths |= {cls.source.path, *(fn.source.path for fn in self.code.list_functions(cls))}
        name = re.compile(rb"\b" + re.escape(get_tail(variable.name).encode()) + rb"\b")
        for each in sorted(paths & self.topics.reader.uses.files.keys()):
            file = self.topics.reader.uses.files[each]
            if variable.name in file.macros:
                raise EditRefused(f"a macro of {each} names `{variable.name}`, which is not followed")
            lines = (self.planner.read(each) or b"").split(b"\n") if file.unread else []
            for first, last in file.unread:
                if name.search(b"\n".join(lines[first - 1 : last])):
                    raise EditRefused(f"lines {first} to {last} of {each} name `{variable.name}`, and are not parsed")

    def _retype_variable(self, variable: Variable, fn: Fn) -> None:
        """Changes the type that a publisher or subscription is declared with, where it names the message."""
        if variable.kind == "member":
            for path, member in self.planner.list_members(variable):
                self._retype_declared(path, member.line, member.name)
        elif variable.kind == "local":
            for each in fn.assigned.get(variable.name, ()):
                if each.type and "<" in each.type:
                    self._retype_declared(fn.source.path, each.line, variable.name)
        else:
            for constant, source in self.code.list_constants(variable, fn):
                self._retype_declared(source.path, constant.line, constant.name)

    def _retype_declared(self, path: str, line: int, name: str) -> None:
        self._get_cpp(path).retype_member(line, name, self.type, self.light, self.variables)

    # Callbacks

    def _retype_callback(self, fn: Fn) -> None:
        if fn.source.facts.language == "python":
            return  # it takes whatever has the fields
        name = get_tail(fn.name) if not fn.is_lambda else "a lambda"
        where = f"`{name}` at {fn.source.path}:{fn.facts.line}"
        callers = self.code.callers.get(fn, ())
        if callers:
            caller, call = callers[0]
            raise EditRefused(f"{where} is called at {caller.source.path}:{call.line} too")
        names = select_parameters(fn, self.type, self.code)
        if not names:
            return
        if len(names) > 1:
            raise EditRefused(f"{where} has several parameters that may be the message")
        place = next(n for n, one in enumerate(fn.facts.parameters) if one.name == names[0])
        editor = self._get_cpp(fn.source.path)
        function = editor.find_function(fn.facts.line, fn.name)
        reading = self.topics.reader.read_parameter(fn, names, self.type)
        if self._is_reader_alone(fn, names[0], reading):
            generic = "auto" in fn.facts.parameters[place].type
            editor.retype_parameter(function, place, self.type, self.light, generic)
        else:
            editor.widen_parameter(function, place, names[0], self.type, self.light, self.widen.name)
            self.widened.append(fn.source.path)
        if not fn.is_lambda:
            self._retype_declarations(fn, place, where)

    def _is_reader_alone(self, fn: Fn, parameter: str, reading: Reading) -> bool:
        """Whether a callback does nothing but read fields, so that it need not know which message it is given."""
        for holder in reading.holders:
            if holder.variable == Variable("local", fn.place, parameter):
                continue
            if (not holder.base or holder.base in self.partial) and not self._is_auto(holder.variable, fn):
                return False
        return True

    def _is_auto(self, variable: Variable, fn: Fn) -> bool:
        """Whether a variable is local, and takes the type of what it is given."""
        if variable.kind != "local":
            return False
        functions = self.code.functions_in.get(variable.owner.split(":", 1)[0], ())
        owner = next((one for one in functions if one.place == variable.owner), fn)
        text = self.code.find_declared_type(variable, owner)[0]
        declared = [each.type for each in owner.assigned.get(variable.name, ()) if each.type]
        return bool(re.search(r"\bauto\b", text or " ".join(declared)))

    def _retype_declarations(self, fn: Fn, place: int, where: str) -> None:
        """Changes where a function is declared without its body."""
        owner = self.code.find_owner(fn)
        tail, inside = get_tail(fn.name), get_tail(owner.name) if owner is not None else ""
        files = {cls.source.path for cls in self.code.list_class_bodies(owner.key)} if owner is not None else {
            source.path for source in self.code.sources
            if source.package == fn.source.package and source.facts.language == "cpp"
        }  # fmt: skip
        wanted = self.type.partition("/")[2].encode()
        for path in sorted(files):
            data = self.planner.read(path)
            if data is None or tail.encode() not in data or wanted not in data:
                continue
            editor = self._get_cpp(path)
            for declarator in editor.list_declarations(tail, inside):
                if editor.count_parameters(declarator) != len(fn.facts.parameters):
                    continue
                editor.retype_parameter(declarator, place, self.type, self.light, True)
                whole = declarator.parent.text if declarator.parent is not None else b""
                if whole is not None and (b"override" in whole or b"virtual" in whole):
                    raise EditRefused(f"{where} is virtual")

    # Publish statements

    def _wrap_statements(self, sites: set[Site]) -> None:
        places = {(site.use.fn.source.path, site.use.call.line) for site in sites}
        for statement in self.planner.join.sites.statements:
            hit = [(one.use.fn.source.path, one.use.call.line) in places for one in statement.sites]
            if any(hit):
                where = f"{statement.use.fn.source.path}:{statement.use.call.line}"
                if not all(hit):
                    raise EditRefused(f"{where} publishes on other topics too")
                if not statement.through:
                    self._wrap(statement)

    def _wrap(self, statement: Statement) -> None:
        use = statement.use
        path, call = use.fn.source.path, use.call
        editor = self._get_editor(path)
        if isinstance(editor, PythonEditor):
            if len(list_fields(self.planner.find_definition, self.type) or ()) == 1:
                raise EditRefused(f"{path}:{call.line} may publish the one field that {self.type} has")
            editor.wrap_argument(call.line, get_tail(call.callee), self.fill.name)
            editor.add_import(self.light)
            for type_ in list_python_types(self.fields):
                editor.add_import(type_)
            editor.add_block(write_python(self.fill))
        else:
            pointer = editor.wrap_argument(call.line, call.column, self.fill.name)
            self.pointers[path] = self.pointers.get(path, False) or pointer


def _list_partial(fields: Iterable[LightField], outer: Path) -> Iterator[Path]:
    """The messages of which some fields are kept, by path."""
    for field in fields:
        if field.members:
            path = (*outer, field.name)
            yield path
            inner = (*path, "[]") if field.array else path
            if field.array:
                yield inner
            yield from _list_partial(field.members, inner)
