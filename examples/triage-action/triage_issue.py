"""Labels the issue of a GitHub event with what it is about; leaves it alone when unsure, or when it is `other`.

Reads GITHUB_EVENT_PATH, GITHUB_REPOSITORY, GITHUB_TOKEN and GITHUB_API_URL, as GitHub sets them in a workflow.
"""

import json
import os
import subprocess
import sys

import requests

PREFIX = "triage: "


def judged(issue: dict) -> dict:
    """What `rosimpact triage` says of an issue."""
    line = json.dumps({"id": issue["number"], "title": issue["title"], "body": issue["body"] or ""})
    command = ["rosimpact", "triage", "--jsonl", "-"]
    done = subprocess.run(command, input=line, capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode:
        raise SystemExit(f"triage failed: {done.stderr.strip()}")
    return json.loads(done.stdout)


def main() -> int:
    with open(os.environ["GITHUB_EVENT_PATH"], encoding="utf-8") as file:
        issue = json.load(file)["issue"]
    answer = judged(issue)
    sure = f"{100 * max(answer['probabilities'].values()):.0f} %"
    if answer["abstained"] or answer["label"] == "other":
        print(f"#{issue['number']}: no label ({answer['label']}, {sure}{', unsure' if answer['abstained'] else ''})")
        return 0
    api = os.environ.get("GITHUB_API_URL", "https://api.github.com")
    label = PREFIX + answer["label"]
    reply = requests.post(
        f"{api}/repos/{os.environ['GITHUB_REPOSITORY']}/issues/{issue['number']}/labels",
        json={"labels": [label]},
        headers={
            "Authorization": f"Bearer {os.environ['GITHUB_TOKEN']}",
            "Accept": "application/vnd.github+json",
        },
        timeout=30,
    )
    if not reply.ok:
        print(
            f"#{issue['number']}: GitHub refused the label `{label}` with status {reply.status_code}", file=sys.stderr
        )
        return 1
    print(f"#{issue['number']}: {label} ({sure})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
