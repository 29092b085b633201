"""unlinked-beside: a program includes a header of a compiled library and is not linked to it, as another target is.

What it does
    Compares the programs of a package that use what is compiled into a platform library, such as yaml-cpp: one that is
    not linked to it, where another one is.

Why it breaks
    The linker reports undefined references.

Example
    target_link_libraries(writer yaml-cpp)      # and reader.cpp of the program `reader` calls YAML::LoadFile() too

Use instead
    target_link_libraries(reader yaml-cpp)

Not reported
    Targets that are given something that cannot be seen; libraries.
"""

from collections.abc import Collection

from ...model.cmake.links import is_opaque
from ...targets.platform import strip_separators
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .compiled_uses import LibraryUse, find_library_include, list_library_uses


@rule(
    severity="warning",
    group="library-component",
    texts=Text(
        "`{target}` uses `{name}` of `{header}` but does not link `{subject}`, as `{other}` does",
        "link to `{target}` what `{other}` links",
    ),
)
def unlinked_beside(view: TargetView, package: Package):
    targets = {t.name: t for t in package.build.targets}
    links: dict[str, set[str] | None] = {}
    by_library: dict[str, dict[str, LibraryUse]] = {}
    compiling = dict(package.linked.source_targets)
    for use in list_library_uses(package):
        for name in compiling.get(use.path, ()):
            by_library.setdefault(use.library, {}).setdefault(name, use)
    for library, users in by_library.items():
        if len(users) < 2:
            continue
        for name in users.keys() - links.keys():
            links[name] = package.build.list_linked_items(name) if name in targets else None
        own = {n for n, use in users.items() if _links(links[n], use.words)}
        for name, use in users.items():
            target, items = targets.get(name), links[name]
            if not own or name in own or target is None or items is None:
                continue
            if target.kind not in ("executable", "test") or not view.is_sure(
                c for c in target.conditions if "TESTING" not in c.text
            ):
                continue
            include = find_library_include(view, package, use, name)
            if include is None or any(map(is_opaque, items)):
                continue
            data = {"target": name, "header": include.path, "name": use.name, "other": min(own)}
            yield Diagnostic(target.at, library, package.name, data, doubts=(Doubt.INCOMPLETE,))
            break


def _links(items: Collection[str] | None, words: Collection[str]) -> bool:
    return any(word in strip_separators(item) for item in items or () for word in words)
