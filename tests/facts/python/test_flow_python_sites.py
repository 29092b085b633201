"""Sites of real rospy and rclpy nodes, as a person read them, against what the extractor says.

The repositories are read from bare mirrors in the folder that ROSIMPACT_MIRROR names, one folder `owner+name` each."""

import json
import os
import subprocess
from pathlib import Path

import pytest
from rosimpact.impact.facts.python.flow import extract

READ = [
    json.loads(line) for line in (Path(__file__).parent / "data" / "python_sites_read.jsonl").read_text().splitlines()
]
MIRROR = os.environ.get("ROSIMPACT_MIRROR", "")
# Where topic, type and callback stand in a call: place, or name of the keyword.
PLACES = {
    "rospy.Publisher": (0, 1, None),
    "rospy.Subscriber": (0, 1, 2),
    "message_filters.Subscriber": (2, 1, None),
    "create_publisher": (1, 0, None),
    "create_subscription": (1, 0, 2),
}


def git_folder(repository):
    folder = Path(MIRROR) / repository.replace("/", "+")
    places = (folder, *sorted(folder.glob("*")))
    return next((place for place in places if (place / "HEAD").exists() or (place / ".git").exists()), None)


def shown(expr):
    """An expression much as Python writes it."""
    inside = ", ".join(shown(part) for part in expr.parts)
    if expr.kind == "text":
        return repr(expr.text)
    if expr.kind == "keyword":
        return f"{expr.text}={inside}"
    if expr.kind == "list":
        return f"({inside})"
    if expr.kind in ("call", "make"):
        return f"{expr.text}({inside})"
    return expr.text if not expr.parts else f"{expr.kind}({inside})"


def guards_of(function, place):
    chain = []
    while place >= 0:
        guard = function.guards[place]
        chain.append(("early " if guard.early else "") + f"{guard.kind} {guard.text}")
        place = guard.outer
    return chain[::-1]


def told(found, site):
    """What the facts say about the site's line, in the words of the reading."""
    for function in found.functions:
        for call in function.calls:
            receiver, _, name = call.callee.rpartition(".")
            if call.line != site["line"]:
                continue
            guards = guards_of(function, call.guard)
            if site["what"] == "publish":
                if name == "publish":
                    return {"on": receiver, "message": ", ".join(map(shown, call.arguments)), "guards": guards}
                continue
            places = PLACES.get(call.callee) or PLACES.get(name)
            if places is not None:
                given = [shown(argument) for argument in call.arguments]
                words = zip(("topic", "type", "callback"), places, strict=True)
                answer = {word: "" if place is None else given[place] for word, place in words}
                if site["what"] == "publisher":
                    del answer["callback"]
                return {**answer, "guards": guards}
    return None


def test_the_reading_is_of_both_generations_and_many_repositories():
    assert len(READ) == 60
    assert len({site["repository"] for site in READ}) >= 20
    assert {site["what"] for site in READ} == {"publish", "publisher", "subscriber"}
    assert sum(bool(site["guards"]) for site in READ) >= 20


@pytest.mark.skipif(not MIRROR, reason="ROSIMPACT_MIRROR names no folder of mirrors")
def test_sites_are_told_as_a_person_reads_them():
    missing, wrong, right = [], [], 0
    for site in READ:
        folder = git_folder(site["repository"])
        command = ["git", "-C", str(folder), "cat-file", "blob", f"{site['commit']}:{site['path']}"]
        blob = subprocess.run(command, capture_output=True, check=False) if folder else None
        if blob is None or blob.returncode:
            missing.append(f"{site['repository']} {site['path']}")
            continue
        expected = {
            word: site[word] for word in ("on", "message", "topic", "type", "callback", "guards") if word in site
        }
        answer = told(extract(blob.stdout), site)
        if answer == expected:
            right += 1
        else:
            wrong.append((site["repository"], site["path"], site["line"], expected, answer))
    if missing and not right and not wrong:
        pytest.skip("none of the repositories is mirrored")
    assert right >= 0.95 * (right + len(wrong)), wrong
