"""misplaced-header: an install rule puts headers where dependants do not find them by the path that they include.

What it does
    Reports a folder `include` that is installed into another `include` or below it, and headers that are installed
    under another folder name than code includes them by, or one folder too deep.

Why it breaks
    The package itself builds, from the source tree. Its dependants do not find the headers.

Severity
    error where dependants of an ament package miss such a header; warning otherwise.

Example
    install(DIRECTORY include DESTINATION include)

Use instead
    install(DIRECTORY include/ DESTINATION include)

Not reported
    Folders whose name contains a variable that is not known.
"""

import posixpath
import re

from ...model.cmake.build import Install
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .dependants import list_compiled_elsewhere
from .install_rules import is_installed, read_installs


@rule(
    group="misplaced-install",
    texts={
        "doubled": Text(
            "the folder `include` is installed into `{destination}`, so headers end up in {destination}/include",
            "write `{instead}` with a slash at its end",
        ),
        "nested": Text(
            "the folder `{name}` is installed into `{destination}`, so headers end up in {destination}/{name}",
            "write `{instead}` with a slash at its end",
        ),
        "renamed": Text(
            "headers that are included as `{name}/...` are installed into `{destination}`",
            "install them into `{place}`",
        ),
    },
)
def misplaced_header(view: TargetView, package: Package):
    exported = _list_exported(view, package)
    for install in read_installs(view, package) or ():
        root, include, tail = install.destination.rstrip("/").rpartition("include")
        usual = tail == f"/{package.name}" and package.build_type == "catkin"
        named = "CATKIN_PACKAGE_INCLUDE_DESTINATION" if usual else install.destination
        for item in install.items if install.kind == "directory" and include else ():
            # How others include what lies outside of the workspace is not known.
            folder = _FOLDER.search(item) if "$" not in item else None
            if tail[:1] in ("", "/") and root[-1:] in ("", "/") and item.rpartition("/")[2] == "include":
                kind, subject, lost, place = "doubled", "include", item, install.destination.rstrip("/")
                if any(one.rstrip("/").endswith(f"{place}/include") for one in exported):
                    continue
                instead = f"include{tail.rstrip('/')}/" if package.build_type == "catkin" else "include/"
                data = {"destination": place, "instead": instead}
            elif not root and "$" not in item and item.endswith(f"/{include}{tail}") and tail.count("/") == 1:
                kind, subject, lost = "nested", named, posixpath.dirname(item)
                unknown = package.build_type != "catkin" and any("$" in one for one in exported)
                if unknown or any(one.rstrip("/").endswith(f"{include}{tail}") for one in exported):
                    continue
                if _is_taken_too(package, install, item):
                    continue
                data = {"destination": install.destination, "name": tail[1:], "instead": f"{include}{tail}/"}
            elif folder is not None and not root and tail.count("/") == 1 and tail != f"/{folder[1]}":
                kind, subject, lost = "renamed", named, item.rstrip("/").removesuffix(folder[1])
                place = f"{'${CATKIN_GLOBAL_INCLUDE_DESTINATION}' if usual else 'include'}/{folder[1]}"
                data = {"name": folder[1], "destination": install.destination, "place": place}
            else:
                continue
            doubts = (_is_lost(view, package, install, lost, exported) or Doubt.DISTURBS,)
            yield Diagnostic(install.at, subject, package.name, data, kind, doubts)


def _is_taken_too(package: Package, install: Install, folder: str) -> bool:
    """Whether another rule takes a header of a folder."""
    others = [one for one in package.build.installs if one is not install and one.kind in ("directory", "files")]
    return any(is_installed(others, header) for header in package.linked.headers if header.startswith(f"{folder}/"))


_FOLDER = re.compile(r"(?:^|/)include/([\w-]+)/\Z")


def _list_exported(view: TargetView, package: Package) -> list[str]:
    """The folders that dependants search for headers."""
    exported = [e.item for e in package.build.exports if "include" in e.how and view.is_sure(e.conditions)]
    return [*exported, *(place for target in package.build.targets for place in target.installed_includes)]


def _is_lost(view: TargetView, package: Package, install: Install, folder: str, exported: list[str]) -> bool:
    """True when another package of the workspace compiles a header of the folder, or the package exports the place
    where its headers should lie, and no other rule installs them there; not of catkin, whose devel space has them."""
    if not view.is_sure(install.conditions) or package.build.unresolved or package.build.catkin_package is not None:
        return False
    folder = posixpath.normpath(folder)
    if any("$" in item for item in exported) or _is_taken_too(package, install, folder):
        return False
    headers = {h[len(folder) + 1 :] for h in package.linked.headers if h.startswith(f"{folder}/")}
    if headers and any(item.rstrip("/") in ("include", install.destination.rstrip("/")) for item in exported):
        return True
    return any(path in headers for _, path in list_compiled_elsewhere(view, package))
