"""unresolvable-key: a declared dependency is neither a package nor a rosdep key on a target.

What it does
    Reports dependencies of a manifest that are not in the workspace, not released on the target, and that rosdep cannot
    turn into something installable on the target's platform, although the name is known elsewhere, is that of a
    package of Debian, CMake or pkg-config which a key installs, is one edit away from a known one, is that of a
    repository whose packages are called after it, or that of a target of the package itself. Also reports keys of a
    module of Python 2 where the target has Python 3, and keys that only pip resolves, in packages that have been
    released.

Why it breaks
    `rosdep install` stops with "No definition of [x] for OS version", and bloom refuses to release the package, as it
    does where a key is not one of the platform's own packages. Python 3 does not find the modules of Python 2.

Severity
    error, since `rosdep install` stops; note for names that are not known in public, which may belong to a private
    repository or to a submodule that was not read; warning for unknown names that nothing in the package uses or that
    have the form of a key (`python3-x`, `libx-dev`, `x-pip`, `x_1.2`), for a name `x` or `x2` if exactly one package or
    key such as `x_vendor` or `libx-dev` exists, for one that differs from a package of the workspace in the ending of a
    word, is a target of the package that declares it or is called after that, and for keys of Python 2 or pip.

Example
    <depend>Eigen3</depend>

Use instead
    <depend>eigen</depend>

Not reported
    Packages that some distro has released (unreleased-package reports them), dependencies under a condition that does
    not hold on the target, and names listed in `[workspace] private` or `installed`.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.misspelling import is_slip
from ...model.package import BUILD_TOOLS
from ...model.unknown_contents import is_called_after
from ...targets.target import Resolution
from ..vocabulary import Diagnostic, Doubt, Package, Remove, Replace, TargetView, Text, rule
from .used_names import list_used_names, shows_uses, stands_in_cmake

_HELP = "declare a key that exists on the target, or put a condition on the dependency"


@rule(
    texts={
        "no rule": Text("rosdep has no rule for `{subject}` on {platform}", _HELP),
        "no rule, similar": Text("rosdep has no rule for `{subject}` on {platform}", "declare `{replacement}`"),
        "misspelt": Text("`{subject}` is neither a package nor a rosdep key", "declare `{replacement}`"),
        "system package": Text("`{subject}` is a system package, not a rosdep key", "declare `{replacement}`"),
        "own target": Text("`{subject}` is a target of `{package}`, not a package or rosdep key", "remove it"),
        "repository": Text(
            "`{subject}` is neither a package nor a rosdep key, but {packages} are packages",
            "declare the packages that are used",
        ),
        "unused": Text(
            "`{subject}` is not a public package or rosdep key, and nothing in `{package}` uses it",
            "remove it, or correct the name",
        ),
        "called after": Text(
            "`{subject}` is called after `{package}` but is neither in the workspace nor a public package",
            "remove it, correct the name, or add it to `[workspace] private` in rosimpact.toml",
        ),
        "python 2": Text(
            "`{subject}` installs a module of Python 2, but {platform} runs ROS with Python 3",
            "declare `{replacement}`",
        ),
        "pip": Text(
            "rosdep installs `{subject}` with pip alone, so bloom cannot release `{package}` as a Debian package",
            "declare a key that apt resolves, or treat the module as optional",
        ),
        "build type": Text("`{subject}` is a build type, not a package or rosdep key", "declare it as build_type only"),
        "unread": Text(
            "`{subject}` is not a public package or rosdep key, and may be in a submodule that was not read: {unread}",
            "run `git submodule update --init`, or, if it is your own, add it to `[workspace] private`",
        ),
        "unknown": Text(
            "`{subject}` is not a public package or rosdep key",
            "if it is your own, add it to `[workspace] private` in rosimpact.toml",
        ),
    },
)
def unresolvable_key(view: TargetView, package: Package):
    target = view.target
    seen = set()
    for dependency in view.list_dependencies(package):
        name = dependency.name
        if name in seen or name in view.workspace.packages or target.find_version(name) is not None:
            continue
        seen.add(name)
        if view.is_private(name):
            continue
        at = view.find_place(package, dependency)
        if view.unknown_contents.is_of_submodule(name):
            if not target.was_ever_released(name) and not target.knows_key(name):
                yield _diagnose_unread(view, package, at, name)
            continue
        resolution = target.resolve(name)
        if resolution is not None:
            yield from _list_unfit(view, package, at, name, resolution)
        elif target.was_ever_released(name):
            continue  # unreleased-package says it
        elif target.knows_key(name):
            if not target.has_rosdep_rules():
                continue
            instead = next(iter(target.find_replacement_keys(name)), "")
            meant = _find_installing(view, package, name) if not instead else ""
            fix = _replace(view, package, name, meant) if meant else ()
            data = {"platform": target.platform, "replacement": instead or meant}
            kind = "no rule, similar" if instead or meant else "no rule"
            yield Diagnostic(at, name, package.name, data, kind=kind, fix=fix)
        elif meant := _find_installing(view, package, name):
            kind = "system package" if target.find_keys(name) else "misspelt"
            fix = _replace(view, package, name, meant)
            yield Diagnostic(at, name, package.name, {"replacement": meant}, kind=kind, fix=fix)
        elif any(made.name == name and made.kind in _MADE for made in package.build.targets):
            fix = (Remove(at.path, name),)
            yield Diagnostic(at, name, package.name, kind="own target", doubts=(Doubt.AMBIGUOUS,), fix=fix)
        elif (guess := view.known_names.find_nearest(name)) and view.is_available(guess):
            fix = _make_fix(view, package, name, guess)
            yield Diagnostic(at, name, package.name, {"replacement": guess}, kind="misspelt", fix=fix)
        elif longer := _find_parts(view, name):
            yield Diagnostic(at, name, package.name, {"packages": tuple(longer[:2])}, kind="repository")
        elif relative := _find_namesake(view, package, name) or _find_reworded(view, name):
            data = {"replacement": relative}
            yield Diagnostic(at, name, package.name, data, kind="misspelt", doubts=(Doubt.AMBIGUOUS,))
        else:
            yield _diagnose_unknown(view, package, at, name)


_MADE = frozenset(("executable", "library", "interface", "module"))


def _find_installing(view: TargetView, package: Package, name: str) -> str:
    """The key that installs what a name stands for elsewhere: a package of the platform, else a library that
    find_package() or pkg-config finds; empty where there is none, or where a module of Python may be meant."""
    if keys := view.target.find_keys(name):
        return min(keys, key=lambda key: len(view.list_debs(key)))
    if not package.build.targets and _find_namesake(view, package, name):
        return ""
    providers = (*view.find_cmake(name), *view.providers.find_pkgconfig(name))
    return next((p.name for p in providers if p.kind == "system" and p.sure and view.target.resolve(p.name)), "")


def _list_unfit(view: TargetView, package: Package, at, name: str, found: Resolution) -> Iterator[Diagnostic]:
    """A key that is installed, and does not serve: the module of another Python, or what no Debian package may need."""
    target = view.target
    if found.manager == "pip" and target.was_ever_released(package.name):
        yield Diagnostic(at, name, package.name, kind="pip", doubts=(Doubt.DISTURBS,))
    instead = name.replace("python-", "python3-", 1)
    of_python2 = found.manager == "apt" and found.packages and all(p.startswith("python-") for p in found.packages)
    if of_python2 and target.python_major >= 3 and target.resolve(instead) is not None and instead != name:
        data = {"platform": target.platform, "replacement": instead}
        yield Diagnostic(at, name, package.name, data, "python 2", (Doubt.LATE,))


# How keys are called, and packages are not: names with dots, and those of packages of Debian or pip.
_KEY = re.compile(r"python3?-[a-z0-9.+-]+|lib[a-z0-9.+-]+-dev|[a-z0-9.+-]+-pip|\w+\.[\w.+-]+")


def _diagnose_unknown(view: TargetView, package: Package, at, name: str) -> Diagnostic:
    """A name that nobody knows in public. Those of private packages are used by whoever declares them."""
    if name in BUILD_TOOLS:
        return Diagnostic(at, name, package.name, kind="build type", fix=(Remove(at.path, name),))
    if _KEY.fullmatch(name):
        return Diagnostic(at, name, package.name, kind="unknown", doubts=(Doubt.AMBIGUOUS,))
    if view.workspace.outside.unread_submodules:
        return _diagnose_unread(view, package, at, name)
    if name.startswith(f"{package.name}_"):
        return Diagnostic(at, name, package.name, kind="called after", doubts=(Doubt.AMBIGUOUS,))
    hidden = package.build.unresolved or not shows_uses(package)
    if hidden or stands_in_cmake(package, name) or name in list_used_names(view, package):
        return Diagnostic(at, name, package.name, kind="unknown", doubts=(Doubt.PRIVATE,))
    return Diagnostic(at, name, package.name, kind="unused", doubts=(Doubt.AMBIGUOUS,))


def _diagnose_unread(view: TargetView, package: Package, at, name: str) -> Diagnostic:
    """A name that nobody knows in public, where submodules were not read: those that it is called after, or all."""
    unread = view.workspace.outside.unread_submodules
    after = [path for path in unread if is_called_after(name, path.rpartition("/")[2])]
    return Diagnostic(at, name, package.name, {"unread": tuple(after or unread)}, "unread", (Doubt.PRIVATE,))


def _find_namesake(view: TargetView, package: Package, name: str) -> str:
    """The one package or key that a library's bare name, with or without its version, may stand for, by what those of
    ROS and Debian are called: the library for what is compiled, else the module. Empty where there is none, or
    several."""
    name = name.rstrip(".0123456789")
    key = f"lib{name}-dev" if package.build.targets else f"python3-{name}"
    found = [f"{name}_vendor", f"ros_{name}", key] if len(name) > 3 else []
    found = [known for known in found if view.is_available(known)]
    return found[0] if len(found) == 1 else ""


_STEM = 5
"""Letters that two forms of a word begin with (simulator, simulation)."""


def _find_reworded(view: TargetView, name: str) -> str:
    """The package of the workspace that differs from a name in the ending of one of several words alone; empty where
    there is none, or several."""
    words, found = name.split("_"), []
    for other in view.workspace.packages:
        pairs = [pair for pair in zip(words, other.split("_"), strict=False) if pair[0] != pair[1]]
        alike = len(words) > 1 and other.count("_") == len(words) - 1 and len(pairs) == 1
        if alike and posixpath.commonprefix(pairs[0])[_STEM - 1 :]:
            found.append(other)
    return found[0] if len(found) == 1 else ""


def _find_parts(view: TargetView, name: str) -> list[str]:
    """Released packages that are called after a name, two at least, where all are of one repository, or its name is
    that."""
    if len(name) < 4:
        return []
    alike = [n for n in sorted(view.target.list_released()) if n.startswith(f"{name}_") and view.is_available(n)]
    homes = {n: _find_repository_stem(view, n) for n in alike}
    found = [n for n in alike if homes[n] == name] if len(set(homes.values())) > 1 else alike
    return found if len(found) > 1 else []


def _find_repository_stem(view: TargetView, package: str) -> str:
    """The name of the repository that releases a package, without what only tells the generation (`moveit2`)."""
    repository = view.target.find_repository(package)
    return re.sub(r"[-_]*(?:ros)?\d?\Z", "", repository[0]).replace("-", "_") if repository is not None else ""


def _make_fix(view: TargetView, package: Package, name: str, guess: str) -> tuple[Replace | Remove, ...]:
    """Writes the name that was surely meant, or takes the wrong one out where that is declared beside it."""
    # A digit tells versions apart.
    if _normalize(name) != _normalize(guess) and not (len(name) > 5 and is_slip(name, guess)):
        return ()
    return _replace(view, package, name, guess)


def _replace(view: TargetView, package: Package, name: str, guess: str) -> tuple[Replace | Remove, ...]:
    path = package.digest.manifest_path
    declared = view.collect_declared(package)
    if guess in declared:
        return (Remove(path, name),) if declared[name] <= declared[guess] else ()
    places = dict.fromkeys((d.line, d.column) for d in package.manifest.dependencies if d.name == name)
    return tuple(Replace(path, line, column, name, guess) for line, column in places)


def _normalize(name: str) -> str:
    return re.sub(r"[-_.\s]", "", name.lower())
