"""rosdep: which packages a key installs on an operating system, by the rules of REP 111."""

from collections.abc import Iterator

import msgspec

from ..target import Resolution

INSTALLERS: dict[str, tuple[str, ...]] = {
    "ubuntu": ("apt", "pip", "gem", "npm", "source"),
    "debian": ("apt", "pip", "gem", "npm", "source"),
    "fedora": ("pip", "dnf", "yum", "source"),
    "rhel": ("pip", "dnf", "yum", "source"),
}
"""Package managers of an operating system, in the order in which rosdep looks for them. Source: rosdep 0.27."""

_DEFAULT = {"ubuntu": "apt", "debian": "apt", "fedora": "dnf", "rhel": "dnf", "centos": "yum"}
_ANY = ("apt", "dnf", "yum", "pip", "gem", "npm", "source", "homebrew", "macports", "pacman", "portage", "snap")


def resolve_rule(rule: object, os_name: str, release: str) -> Resolution | None:
    """What a key installs there, None when it is not to be had.

    rule: the value below the operating system's name in a rosdep file (text, list, or mapping by installer or release;
    None means "not available"). release: codename (`jammy`) or version (`9`). A release named in the mapping wins over
    `*`; a null there means "not on this release" and does not fall back to `*`. An empty list means nothing is needed.
    """
    manager = _find_default_manager(os_name, release)
    if isinstance(rule, dict):
        chosen = _find_installer(rule, os_name)
        if chosen is None:
            if release not in rule and "*" not in rule:
                return None
            rule = rule[release if release in rule else "*"]
            chosen = _find_installer(rule, os_name) if isinstance(rule, dict) else None
        if chosen is not None:
            manager, rule = chosen, rule[chosen]  # type: ignore[index]
        if isinstance(rule, dict):
            rule = rule.get("packages", [])
    names = _parse_names(rule)
    return None if names is None else Resolution(manager, names)


def _find_default_manager(os_name: str, release: str) -> str:
    if os_name in ("rhel", "fedora") and release.isdigit() and int(release) < (8 if os_name == "rhel" else 22):
        return "yum"
    return _DEFAULT.get(os_name, "")


def _find_installer(rule: dict, os_name: str) -> str | None:
    return next((name for name in INSTALLERS.get(os_name, _ANY) if name in rule), None)


def _parse_names(value: object) -> tuple[str, ...] | None:
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


def iterate_texts(rule: object) -> Iterator[str]:
    """All texts of a rule's values: the packages that it installs on some release."""
    if isinstance(rule, str):
        yield rule
    elif isinstance(rule, (dict, list)):
        for value in rule.values() if isinstance(rule, dict) else rule:
            yield from iterate_texts(value)
