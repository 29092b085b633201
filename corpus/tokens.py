"""Access tokens: from the environment or the keyring, and to nobody but the service they are for."""

from __future__ import annotations

import os
from collections.abc import Mapping
from urllib.parse import urlsplit

KEYRING_SERVICE = "rosimpact"
_LOOPBACK = ("localhost", "127.0.0.1", "::1")


def find_github_token(api: str, environment: Mapping[str, str] = os.environ) -> str:
    """The token for a GitHub API address, or an empty string.

    GITHUB_TOKEN or GH_TOKEN for api.github.com and for the host of $GITHUB_API_URL (GitHub's own runners set it);
    GH_ENTERPRISE_TOKEN or GITHUB_ENTERPRISE_TOKEN for any other host, as the `gh` command has it; else the keyring's
    password of service `rosimpact` and user `github@HOST`. None goes out unencrypted except to this machine.
    """
    parts = urlsplit(api)
    host = (parts.hostname or "").lower()
    if parts.scheme != "https" and host not in _LOOPBACK:
        return ""
    own = ("api.github.com", _parse_host(environment.get("GITHUB_API_URL", "")))
    names = ("GITHUB_TOKEN", "GH_TOKEN") if host in own else ("GH_ENTERPRISE_TOKEN", "GITHUB_ENTERPRISE_TOKEN")
    return _find_first(names, environment) or _read_keyring(f"github@{host}")


def find_stack_exchange_key(api: str, environment: Mapping[str, str] = os.environ) -> str:
    """The key for a Stack Exchange API address, from STACK_EXCHANGE_KEY or the keyring, or an empty string."""
    parts = urlsplit(api)
    host = (parts.hostname or "").lower()
    if host not in _LOOPBACK and (parts.scheme, host) != ("https", "api.stackexchange.com"):
        return ""
    return _find_first(("STACK_EXCHANGE_KEY",), environment) or _read_keyring(f"stack-exchange@{host}")


def _parse_host(address: str) -> str:
    try:
        return (urlsplit(address).hostname or "").lower()
    except ValueError:  # half of an IPv6 address
        return ""


def _find_first(names: tuple[str, ...], environment: Mapping[str, str]) -> str:
    return next((value for name in names if (value := environment.get(name, "").strip())), "")


def _read_keyring(user: str) -> str:
    """The keyring's password; an empty string where there is no keyring, or it cannot be opened."""
    try:
        import keyring

        return (keyring.get_password(KEYRING_SERVICE, user) or "").strip()
    except Exception:  # whatever a keyring of the system may raise, it only means that there is no token
        return ""
