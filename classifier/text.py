"""A report's text as the classifier reads it: its parts, and the words of each part.

Title, prose, logs with code, and the lines in them that name an error are told apart, since a word means something else
in each. Addresses, paths, versions and numbers are replaced by what they are, as they differ from report to report.
Words are read in two ways: as they stand, and with names of packages, distros, classes and identifiers replaced too and
endings cut, so that what was learnt on one repository holds in another.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from ..corpus.distros import DISTROS

LONGEST = 30_000
"""Characters of a body that are read; the cause is told before that, and what follows is log."""

_PLATFORMS = (
    "lucid maverick natty oneiric precise quantal raring saucy trusty utopic vivid wily xenial yakkety zesty artful "
    "bionic focal jammy noble resolute wheezy jessie stretch buster bullseye bookworm trixie ubuntu debian raspbian "
    "fedora rhel centos gentoo archlinux opensuse macos osx homebrew windows yocto openembedded nixos conda"
)
PLATFORMS = tuple(_PLATFORMS.split())

_FENCED = re.compile(
    r"```.*?(?:```|\Z)|~~~.*?(?:~~~|\Z)|\{\{\{.*?(?:\}\}\}|\Z)|<pre>.*?(?:</pre>|\Z)|<code>.*?(?:</code>|\Z)",
    re.DOTALL | re.IGNORECASE,
)
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_LOG_LINE = re.compile(
    r"(?:    |\t)|\s*(?:\[(?: ?INFO| ?WARN|ERROR|FATAL|DEBUG|\d)|\$ |#include|make|CMake|Traceback|  File|E: |-- "
    r"|[\w./+-]+:\d+(?::\d+)?:|import |from \w+ import|\w+Error:|/\S+:|<\w+|Call Stack|sudo "
    r"|ros(?:run|launch|dep|topic|make) )"
)
_ERROR = re.compile(
    r"error|not found|no such|could not|cannot|can't|no module|undefined|unable|failed|fatal|missing|warn|wants|unknown"
    r"|unresolved|no definition|mismatch|exception"
)
_URL = re.compile(r"https?://\S+")
_PATH = re.compile(r"(?<![\w/])/(?:[\w.+-]{1,80}/){1,30}([\w.+-]{1,80})")
_HASH = re.compile(r"\b[0-9a-f]{7,40}\b")
_VERSION = re.compile(r"\bv?\d+\.\d+(?:\.\d+){0,4}(?:-\w+)?\b")
_NUMBER = re.compile(r"\b\d+\b")
_WORD = re.compile(r"\w[\w+]*")
_LONGEST_WORD = 40
_TOKEN = re.compile(r"[A-Za-z_][\w+]*(?:::\w+)*|[?]|\d+(?:\.\d+)+|\d+")
_CLASS = re.compile(r"[A-Z][a-z0-9]+[A-Z]\w*\Z")
_ENDING = re.compile(r"(?:ations?|ings?|edly|ed|es|s|ly|ment|able|ies|y)$")
_REPLACED = dict.fromkeys(DISTROS, "<distro>") | dict.fromkeys(PLATFORMS, "<platform>")


class Parts(NamedTuple):
    """A report taken apart. errors: the lines of `code` that name an error, each once."""

    title: str
    prose: str
    code: str
    errors: str


def split_parts(title: str, body: str) -> Parts:
    """Takes a report apart; any text will do."""
    body = _COMMENT.sub(" ", body[:LONGEST].replace("\r\n", "\n"))
    code: list[str] = []

    def take(block: re.Match[str]) -> str:
        code.append(block.group())
        return "\n"

    prose: list[str] = []
    for line in _FENCED.sub(take, body).split("\n"):
        (code if line.strip() and _LOG_LINE.match(line) else prose).append(line)
    logs = "\n".join(code)
    errors = dict.fromkeys(line.strip()[:240] for line in logs.split("\n") if _ERROR.search(line.lower()))
    return Parts(title[:1_000], "\n".join(prose), logs, "\n".join(errors))


def list_plain_words(text: str) -> list[str]:
    """Words as they stand, in lower case; addresses, paths, hashes, versions and numbers by what they are."""
    text = _URL.sub(" urlx ", text)
    text = _PATH.sub(r" pathx \1 ", text)
    text = _HASH.sub(" hashx ", text)
    text = _NUMBER.sub(" numx ", _VERSION.sub(" verx ", text))
    return [word for word in _WORD.findall(text.lower()) if len(word) <= _LONGEST_WORD]


def list_general_words(text: str) -> list[str]:
    """Words without endings; names of packages, distros, platforms, classes and identifiers by what they are."""
    text = _HASH.sub(" hashx ", _PATH.sub(r" \1 ", _URL.sub(" urlx ", text)))
    found: list[str] = []
    for token in _TOKEN.findall(text):
        word = token.lower()
        if token[0].isdigit():
            found.append("<version>" if "." in token else "<number>")
        elif "::" in token:
            found.append("<scoped>")
            if len(word) <= _LONGEST_WORD:
                found.append(word)
        elif word in _REPLACED:
            found.append(_REPLACED[word])
        elif word.endswith("_msgs"):
            found.append("<interfaces>")
        elif "_" in word.strip("_"):
            found.append("<name>")
        elif _CLASS.match(token):
            found.append("<class>")
        elif len(word) <= _LONGEST_WORD:
            found.append(_stem(word))
    return found


def list_letter_runs(text: str) -> list[str]:
    """Runs of three to five letters or signs inside each word, its ends marked by blanks: what is left of a word in
    names, paths and messages of compilers."""
    found: list[str] = []
    for word in text.lower().encode("utf-8", "ignore").decode().split():
        marked = f" {word[:_LONGEST_WORD]} "
        for length in (3, 4, 5):
            if len(marked) <= length:
                found.append(marked)
                break
            found.extend(marked[start : start + length] for start in range(len(marked) - length + 1))
    return found


def make_n_grams(words: list[str], longest: int) -> list[str]:
    """All runs of one to `longest` words, joined by a space."""
    found = list(words)
    for length in range(2, longest + 1):
        found.extend(" ".join(words[start : start + length]) for start in range(len(words) - length + 1))
    return found


def _stem(word: str) -> str:
    if len(word) <= 4:
        return word[:-1] if len(word) == 4 and word.endswith("s") and not word.endswith("ss") else word
    cut = _ENDING.sub("", word)
    return cut if len(cut) >= 3 else word
