"""rosdep: which packages a key installs on an operating system, by the rules of REP 111."""

import msgspec

from .target import Resolution

INSTALLERS: dict[str, tuple[str, ...]] = {
    "ubuntu": ("apt", "pip", "gem", "source", "snap", "npm"),
    "debian": ("apt", "pip", "gem", "source", "npm"),
    "fedora": ("dnf", "yum", "pip", "gem", "source"),
    "rhel": ("dnf", "yum", "pip", "gem", "source"),
    "centos": ("dnf", "yum", "pip", "gem", "source"),
}
"""Package managers of an operating system, the default one first. Source: rosdep's documentation of its installers."""

_ANY = ("apt", "pip", "gem", "source", "dnf", "yum", "homebrew", "macports", "pacman", "portage", "npm", "snap")


def resolve_rule(rule: object, os_name: str, release: str, python_major: int = 3) -> Resolution | None:
    """What a key installs there, None when it is not to be had.

    rule: the value below the operating system's name in a rosdep file (text, list, or mapping by installer or release;
    None means "not available"). release: codename (`jammy`) or version (`9`). A release named in the mapping wins over
    `*`; a null there means "not on this release" and does not fall back to `*`. An empty list means nothing is needed.
    """
    installers = INSTALLERS.get(os_name, _ANY)
    manager = installers[0]
    if isinstance(rule, dict):
        chosen = _installer(rule, installers)
        if chosen is None:
            # rosdep tries `jammy_python3` where ROS_PYTHON_VERSION is 3.
            for name in (*([f"{release}_python3"] if python_major == 3 else []), release, "*"):
                if name in rule:
                    rule = rule[name]
                    break
            else:
                return None
            if isinstance(rule, dict):
                chosen = _installer(rule, installers)
                if chosen is None:
                    return None
        if chosen is not None:
            manager, rule = chosen, rule[chosen]  # type: ignore[index]
            if isinstance(rule, dict):
                rule = rule.get("packages", [])
    names = _names(rule)
    return None if names is None else Resolution(manager, names)


def _installer(rule: dict, installers: tuple[str, ...]) -> str | None:
    return next((name for name in installers if name in rule), next((name for name in _ANY if name in rule), None))


def _names(value: object) -> tuple[str, ...] | None:
    if value is None:
        return None
    if isinstance(value, str):
        # A multi-line text is a script of old rosdep files; its words are no package names.
        return tuple(value.split()) if "\n" not in value.strip() else ()
    if isinstance(value, list):
        return tuple(str(name) for name in value)
    return None


def split_platform(platform: str) -> tuple[str, str]:
    """`ubuntu jammy` → (`ubuntu`, `jammy`); a missing release gives an empty one."""
    os_name, _, release = platform.strip().lower().partition(" ")
    return os_name, release.strip()


def decode_rule(text: str | None) -> object:
    """A stored rule as Python value. None for a dropped key."""
    return None if text is None else msgspec.json.decode(text)
