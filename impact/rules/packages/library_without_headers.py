"""library-without-headers: the declared key of a library brings no headers, and the code includes them.

What it does
    Reports rosdep keys of platform libraries whose Debian packages hold the library alone (`libtinyxml2-6`), where
    built code, or an installed header, includes its headers.

Why it breaks
    The compiler misses the headers, here or in packages that include the installed header.

Severity
    error where nothing that is declared brings the headers that compiled code includes; warning otherwise.

Example
    <depend>libopencv-core</depend>

Use instead
    <depend>libopencv-dev</depend>

Not reported
    Keys beside another one that brings the headers, and what the library's headers only bring along.
"""

import re
from collections.abc import Iterable, Mapping

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule, translate_tag
from .dependency_kinds import FOR_RUN, fix_kind


@rule(
    group="wrong-dependency-kind",
    texts={
        "bare": Text(
            "`{declared}` brings no headers, but `{header}` needs those of `{subject}`", "declare `{subject}`"
        ),
        "public bare": Text(
            "an installed header includes `{header}`, but dependants get `{declared}`, which has no headers",
            "declare `{subject}` as `<{tag}>`",
        ),
    },
)
def library_without_headers(view: TargetView, package: Package):
    declared = view.collect_declared(package)
    bare = {
        name: debian
        for name in declared
        if name.startswith("lib") and (debian := view.list_debs(name)) and not any(d.endswith("-dev") for d in debian)
    }
    for name in view.unknown_contents.list_opaque(package) if bare else ():
        bare.pop(name, None)  # a collection of which nobody knows what it brings
    seen = set()
    for need in view.sort_needs(package) if bare else ():
        if need.how == "include" and need.public and need.certain:
            yield from _list_handed_on(view, package, declared, bare, need, seen)
        if need.how not in ("find_package", "component", "include", "pkg-config") or need.role != "build":
            continue
        if not need.certain or view.is_met(need.providers, declared) or need.providers[0].name in seen:
            continue
        # The others bring it along, as every library does that asks pkg-config.
        own = (p.name for p in need.providers if p.kind == "system" and p.package == need.providers[0].package)
        wanted = (debian for key in own for debian in view.list_debs(key))
        name = _find_bare(bare, (debian for debian in wanted if debian.endswith("-dev")))
        right = next((p.name for p in need.providers if view.is_available(p.name)), None)
        if name is None or right is None:
            continue
        seen.add(need.providers[0].name)
        data, doubts = {"declared": name, "header": need.subject}, (_lacks(view, package, need) or Doubt.INCOMPLETE,)
        yield Diagnostic(view.find_place(package, name), right, package.name, data, "bare", doubts)


def _lacks(view: TargetView, package: Package, need) -> bool:
    """True when compiled code is sure not to find the headers: nothing that is declared brings them in turn."""
    if need.how == "include" and not need.targets:
        return False
    return need.required and not view.unknown_contents.may_hold(package, need.subject, need.providers)


def _list_handed_on(view: TargetView, package: Package, declared, bare, need, seen):
    """A library whose headers are declared for building, and without headers for whoever includes the public header."""
    right = next((p.name for p in need.providers if declared.get(p.name) == {"build"}), None)
    if right is None or right in seen:
        return
    name = _find_bare(bare, view.list_debs(right))
    if name is None or name.startswith("libboost") or not declared[name] & FOR_RUN:
        return
    seen.add(right)
    data = {"declared": name, "header": need.subject, "tag": translate_tag("depend", package.manifest.format)[-1]}
    fix = fix_kind(view, package, right, "depend", declared[right])
    at = view.find_place(package, name)
    together = (Together(f"`{name}` without headers", everywhere=True),)
    yield Diagnostic(at, right, package.name, data, "public bare", (Doubt.DISTURBS,), fix=fix, together=together)


def _find_bare(bare: Mapping[str, Iterable[str]], wanted: Iterable[str]) -> str | None:
    """The declared library without headers that belongs to one of the Debian packages with them."""
    stems = {re.sub(r"(-all)?-dev\Z", "", debian) for debian in wanted}
    return next((name for name, has in bare.items() if any(_is_same(d, s) for d in has for s in stems)), None)


def _is_same(installed: str, stem: str) -> bool:
    """True when a package without headers belongs to the library: `libboost-thread1.71.0` to `libboost`."""
    rest = installed[len(stem) :]
    return len(stem) > 4 and installed.startswith(stem) and (not rest or rest[0] in "-0123456789.")
