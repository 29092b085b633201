"""What requirements of Python packages (`numpy<1.24; python_version < "3.9"`) mean on a target."""

from packaging.markers import InvalidMarker, UndefinedEnvironmentName
from packaging.requirements import InvalidRequirement, Requirement
from packaging.specifiers import InvalidSpecifier, SpecifierSet
from packaging.utils import canonicalize_name
from packaging.version import InvalidVersion, Version

from .distro.distro import DistroTarget
from .platform import PYTHON_LIBRARIES


def read_requirement(text: str) -> Requirement | None:
    """A requirement as it is written; None for what is none."""
    try:
        return Requirement(text)
    except InvalidRequirement:
        return None


def normalize_name(name: str) -> str:
    """One spelling for the name of a package on PyPI, which minds neither case nor `-`, `_` and `.`."""
    return canonicalize_name(name)


def find_refused_python(target: DistroTarget, specifier: str) -> str:
    """The version of the target's Python 3 where a specifier (`>=3.8,<3.11`) does not accept it; empty where it does,
    or that is not known."""
    version = target.find_library("python") or ""
    return version if target.python and _is_refused(specifier, version) else ""


def find_refused_library(target: DistroTarget, requirement: Requirement) -> str:
    """The version of a library on the target's platform, under the name that it has on PyPI too, where a requirement
    that counts there does not accept it; empty in all other cases."""
    name = normalize_name(requirement.name)
    if name not in PYTHON_LIBRARIES or not target.python or not _counts(target, requirement):
        return ""
    version = target.find_library(name) or ""
    return version if _is_refused(str(requirement.specifier), version) else ""


def _is_refused(specifier: str, version: str) -> bool:
    try:
        return not SpecifierSet(specifier).contains(Version(version), prereleases=True)
    except (InvalidSpecifier, InvalidVersion):
        return False


def _counts(target: DistroTarget, requirement: Requirement) -> bool:
    """Whether the marker of a requirement holds with the target's Python; False for one that nobody can tell."""
    if requirement.marker is None:
        return True
    full = target.find_library("python") or f"3.{target.python}.0"
    about = {
        "python_version": f"3.{target.python}", "python_full_version": full, "sys_platform": "linux",
        "platform_system": "Linux", "os_name": "posix", "platform_machine": "x86_64", "extra": "",
        "implementation_name": "cpython", "platform_python_implementation": "CPython",
    }  # fmt: skip
    try:
        return requirement.marker.evaluate(about)
    except (InvalidMarker, UndefinedEnvironmentName):
        return False
