"""unlinked-own-library: a target uses functions that a source of its package defines, and has no part in that source.

What it does
    Reports programs and shared libraries whose sources include a header of the package and use a function of a class in
    it that is defined in a source of another target (`arm.hpp` and `arm.cpp`), where the target neither compiles that
    source nor links a target that does, directly or indirectly; no target may compile it at all.

Why it breaks
    The linker reports undefined references for programs. A shared library is linked without an error, and fails where a
    program links or loads it.

Example
    add_library(arm SHARED src/arm.cpp)
    add_executable(wave src/wave.cpp)           # which includes arm/arm.hpp and calls functions of its class

Use instead
    target_link_libraries(wave arm)

Not reported
    Static libraries; sources that nothing compiles, where the target links libraries that are not known; libraries that
    other targets of the package always link together with the defining one; targets that link something whose value is
    unknown; functions that another class may have.
"""

from collections.abc import Collection

from ...model.cmake.links import resolve_package
from ...targets.platform import strip_separators
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule


@rule(
    severity="warning",
    preview=True,
    texts={
        "library": Text(
            "`{target}` uses `{function}` but does not link `{subject}`, which defines it",
            "target_link_libraries({target} {subject})",
        ),
        "source": Text(
            "`{target}` uses `{function}` but does not compile `{subject}`, which defines it",
            "add `{subject}` to the sources of `{target}`, or make a library of it that both link",
        ),
    },
)
def unlinked_own_library(view: TargetView, package: Package):
    if package.build.unresolved:
        return
    targets = {t.name: t for t in package.build.targets}
    compiling: dict[str, list[str]] = {}
    for target in package.build.targets:
        for source in target.sources:
            compiling.setdefault(source, []).append(target.name)
    links = {name: package.build.list_linked_items(name) for name in targets} if package.linked.own_calls else {}
    known = {name for f in package.build.found for name in (f.name, f.prefix)} | {"catkin"}
    seen = set()
    for source, other, function in package.linked.own_calls:
        if other.endswith(".in"):
            continue  # what CMake makes of it is compiled
        definers = set(compiling.get(other, ()))
        for name in compiling.get(source, ()):
            target = targets[name]
            if (name, other) in seen or target.static or target.kind not in ("executable", "library", "module", "test"):
                continue
            libraries = sorted(n for n in definers if targets[n].kind == "library" and n != name)
            programs = not libraries and all(targets[n].kind == "executable" for n in definers)
            if not (libraries or programs) or not view.is_sure(c for c in target.conditions if "TESTING" not in c.text):
                continue
            items = links[name]
            if items is None or any("$" in item and resolve_package(item) not in known for item in items):
                continue
            reached = package.build.find_linked(name) or ()
            words = [strip_separators(item) for item in items]
            if not definers.isdisjoint(reached) or any(strip_separators(n) in one for n in libraries for one in words):
                continue
            users = [given for given in links.values() if given is not None and name in given]
            if definers and users and not any(definers.isdisjoint(given) for given in users):
                continue  # whatever links this target links the definer too
            if not definers and any(_is_elsewhere(item, targets, known) for item in items):
                continue  # a library that somebody else built may have what is not compiled here
            seen.add((name, other))
            data = {"target": name, "function": function}
            tested = target.kind == "test" or any("TESTING" in c.text for c in target.conditions)
            doubts = (Doubt.INCOMPLETE, not tested or view.target.ros == 2 or Doubt.TEST)
            subject = libraries[0] if libraries else package.strip_path(other)
            kind = "library" if libraries else "source"
            yield Diagnostic(target.at, subject, package.name, data, kind, doubts, together=(Together(other),))
            break


_OF_SYSTEM = frozenset(("pthread", "-lpthread", "-pthread", "m", "dl", "rt", "stdc++fs"))


def _is_elsewhere(item: str, targets: Collection[str], known: Collection[str]) -> bool:
    """Whether what is linked is a library that was built elsewhere, and that no package brings which CMake finds."""
    if item in targets or item in known or item in _OF_SYSTEM or "$" in item:
        return False
    return item.partition("::")[0] not in known
