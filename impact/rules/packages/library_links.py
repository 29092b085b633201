"""Programs that use a compiled library and are not linked to it: of OpenCV by what they call, of others by what another
target of the package links for the same headers."""

from collections.abc import Iterator

from ...model.cmake.build import for_tests
from ...model.cmake.links import linked_items
from ...model.package import IncludeUse
from ...model.view import View
from ...targets.providers.library import OPENCV_FUNCTIONS
from ..rule import Diagnostic
from ..severity import Doubt
from ..text import Text
from .catkin_links import BRING_NOTHING, PACKAGE_VARIABLE, Exported, linked_packages, list_linked, plain, stem_of

TEXTS = {
    "elsewhere": Text(
        "`{target}` includes `{header}` but does not link `{subject}`, as `{other}` does",
        "link to `{target}` what `{other}` links",
    ),
    "opencv": Text(
        "`{target}` uses `{function}` but does not link `opencv_{library}`",
        "find_package(OpenCV REQUIRED) and target_link_libraries({target} ${{OpenCV_LIBRARIES}})",
    ),
}

COMPILED = (
    ("yaml-cpp/", "yamlcpp"),
    ("tinyxml2.h", "tinyxml2"),
    ("tinyxml.h", "tinyxml"),
    ("json/json.h", "jsoncpp"),
    ("jsoncpp/", "jsoncpp"),
    ("curl/curl.h", "curl"),
    ("glog/logging.h", "glog"),
    ("libusb-1.0/", "usb"),
)
"""How the include paths of compiled libraries begin, and a word of every name that each is linked by, without
separators. Source: the libraries' documentation. Kept by hand: no stored index tells whether a header can be used
without the library, which none of these can."""
# The same of libraries of which some headers can be used alone, so that another target has to show that it is linked.
_PARTLY_COMPILED = (
    ("GeographicLib/", "geographiclib"), ("assimp/", "assimp"), ("glog/", "glog"), ("ceres/", "ceres"),
    ("SDL2/", "sdl2"),
)  # fmt: skip


def list_linked_elsewhere(view: View, package) -> Iterator[Diagnostic]:
    """Programs that include a library's header and are not linked to it, beside a target that is."""
    targets = {t.name: t for t in package.build.targets}
    links: dict[str, set[str] | None] = {}
    seen = set()
    for root, word in (*COMPILED, *_PARTLY_COMPILED):
        users: dict[str, IncludeUse] = {}
        for include in package.digest.includes:
            if include.path.startswith(root) and view.certain(include.conditions):
                for name in include.targets:
                    users.setdefault(name, include)
        if len(users) < 2:
            continue
        for name in users.keys() - links.keys():
            links[name] = linked_items(package, name) if name in targets else None
        own = {n for n in users if any(word in plain(item) for item in links[n] or ())}
        for name, include in users.items():
            target, items = targets.get(name), links[name]
            if not own or name in own or target is None or items is None or word in seen:
                continue
            if target.kind not in ("executable", "test") or not view.certain(
                c for c in target.conditions if "TESTING" not in c.text
            ):
                continue
            if any("$" in item and not PACKAGE_VARIABLE.match(item) for item in items):
                continue
            seen.add(word)
            subject = root.partition("/")[0].removesuffix(".h")
            data = {"target": name, "header": include.path, "other": min(own)}
            yield Diagnostic(target.at, subject, package.name, data, "elsewhere", (Doubt.INCOMPLETE,))


# Distros whose cv_bridge hands on every library of OpenCV.
_WITH_ALL_OF_OPENCV = frozenset({"groovy", "hydro", "indigo", "jade"})


def list_unlinked_opencv(view: View, package) -> Iterator[Diagnostic]:
    """Programs that call functions of OpenCV which lie in libraries that nothing they are linked to hands on."""
    build = package.build
    if package.build_type != "catkin" or view.target.ros != 1 or build.unresolved:
        return
    calls = [
        use
        for use in package.digest.names
        if use.text in OPENCV_FUNCTIONS and use.role == "build" and view.certain(use.conditions)
    ]
    if not calls or any("$" in f.name for f in build.found):
        return
    exported = Exported(view)
    for target in build.targets:
        if target.kind != "executable" or for_tests(target.conditions) or not view.certain(target.conditions):
            continue
        linked = list_linked(package, target.name)
        if linked is None or any("opencv" in item.lower() for item in linked):
            continue
        if not all(stem_of(item) in BRING_NOTHING or view.is_package(stem_of(item)) for item in linked if "$" in item):
            continue
        call = next((use for use in calls if use.at.path in target.sources), None)
        brought = exported.closure(linked_packages(view, package, linked)) if call is not None else None
        if call is None or brought is None:
            continue
        bringing = {name for name in brought if name != "OpenCV" and exported.may_bring(name, "opencv")}
        if not bringing <= {"cv_bridge"} or (bringing and view.target.distro in _WITH_ALL_OF_OPENCV):
            continue
        data = {"target": target.name, "function": call.text, "library": OPENCV_FUNCTIONS[call.text]}
        yield Diagnostic(call.at, "OpenCV", package.name, data, "opencv")
        return
