"""Reports written for the tests, in the manner of real ones; no text of the corpus is in here."""

from __future__ import annotations

import json
from pathlib import Path

_TEXTS = {
    "library-update": [
        (
            "{pkg} no longer compiles after upgrading to {new}",
            "It worked on {old}. Since the upgrade to {new}: error: 'CV_BGR2GRAY' was not declared in this scope",
        ),
        (
            "undefined symbol in {pkg} on {new}",
            "After apt upgrade the node dies: symbol lookup error: lib{pkg}.so: "
            "undefined symbol: _ZN3fooEv. {old} is fine.",
        ),
    ],
    "dependency": [
        (
            "missing dependency of {pkg} in package.xml",
            "find_package(catkin) cannot find {dep}; it is not declared. rosdep install does not bring it.",
        ),
        (
            "no rosdep key for {dep}",
            "ERROR: the following packages could not have their rosdep keys resolved: {pkg}: "
            "Cannot locate rosdep definition for [{dep}]",
        ),
    ],
    "inconsistency": [
        (
            "wrong frame_id in {pkg} messages",
            "The header has frame base_link while the driver publishes laser; the tf tree does not connect them.",
        ),
        (
            "{pkg} publishes degrees, consumers expect radians",
            "The values of the topic are in degrees; REP 103 wants radians, so the filter diverges.",
        ),
    ],
    "other": [
        (
            "{pkg} crashes when the window is closed",
            "Segmentation fault in the destructor; backtrace attached. Closing the GUI twice does it.",
        ),
        ("feature request: a dark theme for {pkg}", "It would be nice to have a dark theme. How could I add one?"),
    ],
}
_DISTROS = [("noetic", "melodic"), ("jazzy", "humble"), ("humble", "foxy"), ("kinetic", "indigo")]


def rows(repositories: int = 8) -> tuple[list[dict], list[dict]]:
    """Reports and their labels: every text once a repository."""
    reports, labels = [], []
    for number in range(repositories):
        new, old = _DISTROS[number % len(_DISTROS)]
        names = {"pkg": f"robot_{'abcdefghij'[number]}", "dep": f"tools_{'klmnopqrst'[number]}", "new": new, "old": old}
        count = 0
        for label, texts in _TEXTS.items():
            for title, body in texts:
                count += 1
                id = f"lab{number}/{names['pkg']}#{count}"
                url = f"https://github.com/lab{number}/{names['pkg']}/issues/{count}"
                reports.append({"id": id, "url": url, "source": "github", "date": "2024-05-01",
                                "title": title.format(**names), "body": body.format(**names)})  # fmt: skip
                kind = {"library-update": "ros", "dependency": "undeclared", "inconsistency": "value"}.get(label)
                labels.append({"id": id, "label": label, "kind": kind, "phase": "none", "why": f"about {label}",
                               "annotators": [label], "decided": "single"})  # fmt: skip
    return reports, labels


def write(file: Path, values: list[dict]) -> Path:
    file.write_text("".join(json.dumps(value) + "\n" for value in values), encoding="utf-8")
    return file
