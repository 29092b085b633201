"""unlinked-beside: a program includes a header of a compiled library and is not linked to it, as another target is.

What it does
    Compares the programs of a package that include headers of a compiled library, such as yaml-cpp: one that is not
    linked to it, where another one is.

Why it breaks
    The linker reports undefined references.

Example
    target_link_libraries(writer yaml-cpp)      # and reader.cpp of the program `reader` includes yaml-cpp/yaml.h too

Use instead
    target_link_libraries(reader yaml-cpp)

Not reported
    Targets that are given something that cannot be seen; libraries.
"""

from ...model.cmake.links import is_opaque
from ...model.package import IncludeUse
from ...targets.platform import strip_separators
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .unlinked_library import COMPILED

# Beside those that are always linked, libraries of which some headers can be used alone: another target has to show
# that they are linked.
_LIBRARIES = (
    *COMPILED,
    ("GeographicLib/", "geographiclib"), ("assimp/", "assimp"), ("glog/", "glog"), ("ceres/", "ceres"),
    ("SDL2/", "sdl2"),
)  # fmt: skip
_ROOTS = tuple(root for root, _ in _LIBRARIES)


@rule(
    severity="warning",
    group="library-component",
    texts=Text(
        "`{target}` includes `{header}` but does not link `{subject}`, as `{other}` does",
        "link to `{target}` what `{other}` links",
    ),
)
def unlinked_beside(view: TargetView, package: Package):
    targets = {t.name: t for t in package.build.targets}
    links: dict[str, set[str] | None] = {}
    seen = set()
    includes = [i for i in package.linked.includes if i.path.startswith(_ROOTS) and view.is_sure(i.conditions)]
    for root, word in _LIBRARIES if includes else ():
        users: dict[str, IncludeUse] = {}
        for include in includes:
            for name in include.targets if include.path.startswith(root) else ():
                users.setdefault(name, include)
        if len(users) < 2:
            continue
        for name in users.keys() - links.keys():
            links[name] = package.build.list_linked_items(name) if name in targets else None
        own = {n for n in users if any(word in strip_separators(item) for item in links[n] or ())}
        for name, include in users.items():
            target, items = targets.get(name), links[name]
            if not own or name in own or target is None or items is None or word in seen:
                continue
            if target.kind not in ("executable", "test") or not view.is_sure(
                c for c in target.conditions if "TESTING" not in c.text
            ):
                continue
            if any(map(is_opaque, items)):
                continue
            seen.add(word)
            subject = root.partition("/")[0].removesuffix(".h")
            data = {"target": name, "header": include.path, "other": min(own)}
            yield Diagnostic(target.at, subject, package.name, data, doubts=(Doubt.INCOMPLETE,))
