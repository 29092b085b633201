"""Makes synthetic reports, gathers and stores them, and prints the time for each 10,000 and the peak of memory.

usage: corpus.py [--reports 100000] [--from github|archive|stack-exchange] [--folder DIR]

The reports are written from a seed in the services' own formats (about 2 kB each: prose, a log, a list) and served by a
local server in a process of its own, or laid down as an archive folder. The gatherer is one process, `rosimpact corpus
gather`, whose own peak memory and wall time are measured; the time for each 10,000 is taken from its store, where every
report has the second of its arrival. Then the store is read as a stream, exported, and gathered a second time with
nothing new.
"""

from __future__ import annotations

import argparse
import itertools
import json
import multiprocessing
import os
import random
import sqlite3
import subprocess
import sys
import tempfile
import time
from bisect import bisect_left
from datetime import datetime, timezone
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlencode, urlsplit

STEP = 10_000
REPOSITORY = "ros-navigation/navigation2"
PACKAGES = ("tf2_ros", "nav2_costmap_2d", "cv_bridge", "moveit_core", "rclcpp", "image_transport", "gazebo_ros_pkgs")
SENTENCE = (
    "after upgrading to Jazzy the build of my workspace stops since the header is not found although the package is "
    "installed and sourced on my laptop it works but on the robot the transform between map and base_link is missing "
    "and the publisher uses best effort while the subscriber asks for reliable so nothing arrives"
)
WORDS = SENTENCE.split()


def body(number: int) -> str:
    """About 2 kB of a report, the same for the same number."""
    chance = random.Random(number)
    prose = " ".join(chance.choices(WORDS, k=120))
    package = chance.choice(PACKAGES)
    log = "\n".join(
        f"[ERROR] [{1_600_000_000 + number + line}.{line:03}] [{package}]: {' '.join(chance.choices(WORDS, k=9))}"
        for line in range(12)
    )
    version = f"{chance.randint(0, 4)}.{chance.randint(0, 30)}.0"
    return f"{prose}\n\n```\n{log}\n```\n\n- `{package}` {version}\n- Ubuntu 24.04\n"


def stamp(number: int) -> str:
    return datetime.fromtimestamp(1_500_000_000 + 60 * number, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def issue(number: int) -> dict:
    page = f"https://github.com/{REPOSITORY}/issues/{number}"
    user = {"login": f"user{number % 997}", "id": number, "avatar_url": "https://avatars.githubusercontent.com/u/1"}
    return {
        "url": f"https://api.github.com/repos/{REPOSITORY}/issues/{number}", "html_url": page, "number": number,
        "title": f"Report {number}", "user": user | {"html_url": f"https://github.com/user{number % 997}"},
        "labels": [{"name": "bug", "color": "d73a4a"}], "state": "open", "locked": False, "assignees": [user],
        "comments": 3, "created_at": stamp(number), "updated_at": stamp(number), "closed_at": None,
        "body": body(number),
    }  # fmt: skip


def question(number: int) -> dict:
    text = body(number).split("\n\n```\n")
    log, _, rest = text[1].partition("\n```\n")
    html = f"<p>{text[0]}</p>\n<pre><code>{log}\n</code></pre>\n<ul><li>{rest.strip()}</li></ul>"
    return {
        "question_id": number, "title": f"Report {number}", "body": html, "tags": ["ros2"],
        "creation_date": 1_500_000_000 + 60 * number, "link": f"https://robotics.stackexchange.com/questions/{number}",
        "owner": {"display_name": f"user{number % 997}"}, "content_license": "CC BY-SA 4.0",
    }  # fmt: skip


def archived(number: int) -> str:
    return (
        f"---\nanswers: []\ncomments: []\ncreation_date: '{stamp(number)}'\noriginal_post_id: {number}\n"
        f"original_post_url: https://answers.ros.org/question/{number}/report/\n"
        f"owner_display_name: user{number % 997}\n"
        f"owner_karma: 31\ntags: tf2,catkin\ntitle: Report {number}\nupvote_count: 0\n---\n{body(number)}"
    )


def serve(count: int, port) -> None:
    """Issues and questions 1 to count, a page at a time, made when they are asked for."""
    stamps = [stamp(number) for number in range(1, count + 1)]

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"
        wbufsize = -1
        disable_nagle_algorithm = True

        def do_GET(self) -> None:
            parts = urlsplit(self.path)
            query = {name: values[-1] for name, values in parse_qs(parts.query).items()}
            headers = {"Content-Type": "application/json"}
            page = int(query.get("page", "1"))
            if parts.path.endswith("/issues"):
                first = bisect_left(stamps, query.get("since", "")) + 100 * (page - 1)
                answer: object = [issue(number) for number in range(first + 1, min(first + 100, count) + 1)]
                if first + 100 < count:
                    last = page + -(-(count - first) // 100) - 1
                    links = {
                        name: f"http://{self.headers['Host']}{parts.path}?{urlencode({**query, 'page': to})}"
                        for name, to in (("next", page + 1), ("last", last))
                    }
                    headers["Link"] = ", ".join(f'<{url}>; rel="{name}"' for name, url in links.items())
            else:
                since = int(query.get("fromdate", "0"))
                first = max(0, -(-(since - 1_500_000_000) // 60) - 1) + 100 * (page - 1)
                items = [question(number) for number in range(first + 1, min(first + 100, count) + 1)]
                answer = {"items": items, "has_more": first + 100 < count, "quota_remaining": 9_999}
            data = json.dumps(answer).encode()
            self.send_response(200)
            for name, value in headers.items():
                self.send_header(name, value)
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

        def log_message(self, *arguments: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    port.send(server.server_address[1])
    server.serve_forever()


def measured(arguments: list[str], environment: dict[str, str]) -> tuple[float, float, int]:
    """Wall seconds, seconds of CPU and peak memory in MB of one `rosimpact` process."""
    start = time.perf_counter()
    command = [sys.executable, "-c", "from rosimpact.impact.cli.app import main; main()", *arguments]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env=environment)
    _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        raise SystemExit(f"rosimpact {' '.join(arguments)} failed with status {os.waitstatus_to_exitcode(status)}")
    return time.perf_counter() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024


def paces(store: Path) -> list[float]:
    """Seconds for each 10,000 reports, in the order of their arrival."""
    with sqlite3.connect(store) as db:
        arrived = [row[0] for row in db.execute("SELECT first FROM report ORDER BY first")]
    marks = [*arrived[::STEP], arrived[-1]]
    return [later - earlier for earlier, later in itertools.pairwise(marks)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--reports", type=int, default=100_000)
    parser.add_argument("--from", dest="source", choices=("github", "archive", "stack-exchange"), default="github")
    parser.add_argument("--folder", type=Path, help="where store and archive are made; a temporary one when left out")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=args.folder) as scratch:
        store = Path(scratch, "corpus.sqlite")
        environment = {**os.environ, "ROSIMPACT_CORPUS": str(store)}
        environment["PYTHON_KEYRING_BACKEND"] = "keyring.backends.null.Keyring"
        ours, theirs = multiprocessing.Pipe()
        server = multiprocessing.Process(target=serve, args=(args.reports, theirs), daemon=True)
        if args.source == "archive":
            folder = Path(scratch, "archive", "content", "question")
            folder.mkdir(parents=True)
            for number in range(1, args.reports + 1):
                (folder / f"{number}.md").write_text(archived(number))
            what = ["ros-answers", "--archive", str(Path(scratch, "archive"))]
        else:
            server.start()
            address = f"http://127.0.0.1:{ours.recv()}"
            what = (
                [f"github:{REPOSITORY}", "--api", address]
                if args.source == "github"
                else ["stack-exchange", "--tag", "ros2", "--api", f"{address}/2.3"]
            )
        print(f"{args.reports:,} synthetic reports from {args.source}; {os.cpu_count()} cores")
        took, cpu, peak = measured(["corpus", "gather", *what, "--quiet"], environment)
        print(
            f"gather      {took:7.1f} s   CPU {cpu:6.1f} s   peak {peak} MB   store {store.stat().st_size / 1e6:.0f} MB"
        )
        print(f"  for each {STEP:,}: {' '.join(f'{pace:.1f}' for pace in paces(store))} s")
        took, cpu, peak = measured(["corpus", "gather", *what, "--quiet"], environment)
        print(f"again       {took:7.1f} s   CPU {cpu:6.1f} s   peak {peak} MB   nothing new")
        for suffix in (".jsonl", ".parquet"):
            took, cpu, peak = measured(["corpus", "export", str(Path(scratch, f"out{suffix}"))], environment)
            print(f"{suffix:<11} {took:7.1f} s   CPU {cpu:6.1f} s   peak {peak} MB")
        with Path(scratch, "out.jsonl").open("rb") as file:
            count = sum(1 for _ in file)
        if count != args.reports:
            raise SystemExit(f"{count:,} reports came out of {args.reports:,}")
        if server.is_alive():
            server.terminate()


if __name__ == "__main__":
    main()
