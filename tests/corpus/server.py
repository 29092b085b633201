"""A server of this machine that behaves as GitHub, the Stack Exchange API, an Askbot and the archive's files do.

What it serves was written for the tests, in the services' own formats. Its faults are queued: `fail(...)` has the next
request, or the next one of a path, end badly; then it behaves again.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import re
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime, timezone
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlencode, urlsplit


@dataclass
class Fault:
    """One bad answer. part: of the body's bytes to send before the connection is closed. pause: seconds between the
    bytes of the body."""

    status: int = 200
    headers: dict[str, str] = field(default_factory=dict)
    body: bytes | None = None
    part: float = 1.0
    pause: float = 0.0
    path: str = ""


@dataclass
class Asked:
    """One request as it came."""

    path: str
    query: dict[str, str]
    headers: dict[str, str]


class Services:
    """All of them under one address. `issues[repository]` and the like may be changed between requests."""

    def __init__(self) -> None:
        self.issues: dict[str, list[dict[str, Any]]] = {}
        self.moved: dict[str, str] = {}
        self.gone: dict[str, int] = {}
        self.questions: list[dict[str, Any]] = []
        self.askbot: list[dict[str, Any]] = []
        self.files: dict[str, bytes] = {}
        self.asked: list[Asked] = []
        self.faults: list[Fault] = []
        self.quota = 10_000
        self.search_limit = 1_000
        self.incomplete = 0
        self.backoff: int | None = None
        self.after: Callable[[Asked], None] = lambda asked: None
        self.date: Callable[[], float] = time.time
        self._server = _Server(("127.0.0.1", 0), self._handler())
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.02,), daemon=True)
        self._thread.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.server_address[1]}"

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()

    def fail(self, *faults: Fault) -> None:
        self.faults.extend(faults)

    def paths(self) -> list[str]:
        return [asked.path for asked in self.asked]

    def answer(self, asked: Asked) -> tuple[int, dict[str, str], bytes]:
        """What a request gets when nothing goes wrong."""
        path = asked.path = asked.path.removeprefix("/api/v3")  # where GitHub Enterprise has its API
        if path == "/rate_limit":
            core = {"limit": 5000, "remaining": self.quota, "reset": 2_000_000_000, "used": 0, "resource": "core"}
            return _json({"resources": {"core": core, "search": core}, "rate": core})
        if path == "/search/issues":
            return self._search(asked)
        if found := re.fullmatch(r"/repos/([\w.-]+/[\w.-]+)/issues(?:/(\d+))?", path):
            return self._github(asked, found[1], found[2])
        if path == "/2.3/questions" or path.startswith("/2.3/questions/"):
            return self._stack_exchange(asked)
        if found := re.fullmatch(r"/api/v1/questions/", path):
            return self._askbot(asked)
        if path.lstrip("/") in self.files:
            return 200, {"Content-Type": "application/octet-stream"}, self.files[path.lstrip("/")]
        return _json({"message": "Not Found", "documentation_url": "https://docs.github.com/rest"}, 404)

    def _github(self, asked: Asked, repository: str, number: str | None) -> tuple[int, dict[str, str], bytes]:
        if repository in self.moved:
            rest = asked.path.partition(repository)[2]
            # GitHub redirects to /repositories/ID/...; the query goes with it
            query = f"?{urlencode(asked.query)}" if asked.query else ""
            place = f"{self.url}/repos/{self.moved[repository]}{rest}{query}"
            return 301, {"Location": place, "Content-Type": "application/json"}, b'{"message": "Moved Permanently"}'
        rows = next((rows for name, rows in self.issues.items() if name.lower() == repository.lower()), None)
        if rows is None:
            return _json({"message": "Not Found"}, 404)
        if number is not None:
            if f"{repository}#{number}" in self.gone:
                return _json({"message": "This issue was deleted"}, self.gone[f"{repository}#{number}"])
            row = next((row for row in rows if row["number"] == int(number)), None)
            return _conditional(asked, row) if row else _json({"message": "Not Found"}, 404)
        since = asked.query.get("since", "")
        size, page = int(asked.query.get("per_page", "30")), int(asked.query.get("page", "1"))
        chosen = sorted((row for row in rows if row["updated_at"] >= since), key=lambda row: row["updated_at"])
        if asked.query.get("sort") != "updated" or asked.query.get("direction") != "asc":
            chosen.reverse()
        last = max(1, -(-len(chosen) // size))
        links = {}
        if page < last:
            links = {"next": page + 1, "last": last}
        if page > 1:
            links |= {"first": 1, "prev": page - 1}
        here = f"{self.url}{asked.path}"
        link = ", ".join(
            f'<{here}?{urlencode({**asked.query, "page": number})}>; rel="{name}"' for name, number in links.items()
        )
        status, headers, body = _conditional(asked, chosen[(page - 1) * size : page * size])
        return status, headers | ({"Link": link} if link else {}), body

    def _search(self, asked: Asked) -> tuple[int, dict[str, str], bytes]:
        query = asked.query["q"]
        size, page = int(asked.query.get("per_page", "30")), int(asked.query.get("page", "1"))
        if page * size > self.search_limit:
            message = f"Only the first {self.search_limit} search results are available"
            return _json({"message": message, "documentation_url": "https://docs.github.com/v3/search/"}, 422)
        repository = re.search(r"repo:(\S+)", query)
        since = re.search(r"created:>=(\S+)", query)
        rows = [
            row
            for name, rows in self.issues.items()
            for row in rows
            if (not repository or repository[1] == name)
            and (not since or row["created_at"] >= since[1])
            and ("is:issue" not in query or "pull_request" not in row)
        ]
        rows.sort(key=lambda row: row["created_at"])
        if asked.query.get("order") != "asc":
            rows.reverse()
        incomplete = self.incomplete > 0
        self.incomplete -= incomplete
        part = rows[(page - 1) * size : page * size]
        return _json({"total_count": len(rows), "incomplete_results": incomplete, "items": [] if incomplete else part})

    def _stack_exchange(self, asked: Asked) -> tuple[int, dict[str, str], bytes]:
        """Always packed with gzip, as the API does; its errors have status 400."""
        headers = {"Content-Type": "application/json; charset=utf-8", "Content-Encoding": "gzip"}
        if self.quota <= 0:
            wrong = {
                "error_id": 502,
                "error_name": "throttle_violation",
                "error_message": "too many requests from this IP, more requests available in 41234 seconds",
            }
            return 400, headers, gzip.compress(json.dumps(wrong).encode())
        self.quota -= 1
        ids = asked.path.removeprefix("/2.3/questions").strip("/")
        if ids:
            rows = [row for row in self.questions if str(row["question_id"]) in ids.split(";")]
        else:
            since = int(asked.query.get("fromdate", "0"))
            tag = asked.query.get("tagged", "")
            rows = [row for row in self.questions if row["creation_date"] >= since and (not tag or tag in row["tags"])]
        rows.sort(key=lambda row: row["creation_date"], reverse=asked.query.get("order") != "asc")
        size, page = int(asked.query.get("pagesize", "30")), int(asked.query.get("page", "1"))
        part = rows[(page - 1) * size : page * size]
        wrapper: dict[str, Any] = {
            "items": part if asked.query.get("filter") == "withbody" else [{**row, "body": None} for row in part],
            "has_more": page * size < len(rows),
            "quota_max": 300,
            "quota_remaining": self.quota,
        }
        if self.backoff is not None:
            wrapper["backoff"], self.backoff = self.backoff, None
        return 200, headers, gzip.compress(json.dumps(wrapper).encode())

    def _askbot(self, asked: Asked) -> tuple[int, dict[str, str], bytes]:
        pages = max(1, -(-len(self.askbot) // 50))
        page = int(asked.query.get("page", "1"))
        if page > pages:
            page = 1  # as Askbot does: beyond the end comes the first page again
        rows = sorted(self.askbot, key=lambda row: int(row["added_at"]), reverse=asked.query.get("sort") != "age-asc")
        return _json({"count": len(rows), "pages": pages, "questions": rows[(page - 1) * 50 : page * 50]})

    def _handler(services) -> type[BaseHTTPRequestHandler]:
        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"
            wbufsize = -1
            disable_nagle_algorithm = True  # a body larger than the buffer leaves after its head, 40 ms later

            def do_GET(self) -> None:
                parts = urlsplit(self.path)
                query = {name: values[-1] for name, values in parse_qs(parts.query).items()}
                asked = Asked(parts.path, query, {name.lower(): value for name, value in self.headers.items()})
                services.asked.append(asked)
                fault = next((fault for fault in services.faults if fault.path in parts.path), None)
                if fault is not None:
                    services.faults.remove(fault)
                status, headers, body = services.answer(asked)
                if fault is not None and (fault.status != 200 or fault.body is not None):
                    status, headers = fault.status, {"Content-Type": "application/json"}
                    body = b'{"message": "a fault"}' if fault.body is None else fault.body
                headers = headers | (fault.headers if fault else {})
                self._send(status, headers, body, fault)
                services.after(asked)

            def _send(self, status: int, headers: dict[str, str], body: bytes, fault: Fault | None) -> None:
                self.send_response(status)
                for name, value in headers.items():
                    self.send_header(name, value)
                self.send_header("Content-Length", str(0 if status == 304 else len(body)))
                self.end_headers()
                if status == 304:
                    return
                try:
                    if fault is not None and fault.pause:
                        for byte in body:
                            self.wfile.write(bytes([byte]))
                            self.wfile.flush()
                            time.sleep(fault.pause)
                        return
                    self.wfile.write(body[: int(len(body) * (fault.part if fault else 1.0))])
                    if fault is not None and fault.part < 1:
                        self.close_connection = True
                except OSError:
                    self.close_connection = True  # who asked has given up, which is what they should do

            def date_time_string(self, timestamp: float | None = None) -> str:
                return super().date_time_string(services.date() if timestamp is None else timestamp)

            def log_message(self, *arguments: object) -> None:
                pass

        return Handler


class _Server(ThreadingHTTPServer):
    def handle_error(self, request: Any, client_address: Any) -> None:
        """Who asked was killed, or has given up: nothing that a test need print."""


def _json(value: Any, status: int = 200) -> tuple[int, dict[str, str], bytes]:
    return status, {"Content-Type": "application/json; charset=utf-8"}, json.dumps(value).encode()


def _conditional(asked: Asked, value: Any) -> tuple[int, dict[str, str], bytes]:
    status, headers, body = _json(value)
    tag = f'W/"{hashlib.sha1(body).hexdigest()}"'
    if asked.headers.get("if-none-match") == tag:
        return 304, {"ETag": tag}, b""
    return status, headers | {"ETag": tag}, body


def issue(
    repository: str, number: int, *, day: str = "", url: str = "https://github.com", **more: Any
) -> dict[str, Any]:
    """An issue as GitHub's API gives it, people's data included. day: both of its times, unless given in `more`."""
    moment = day or f"2024-01-01T00:{number // 60 % 60:02}:{number % 60:02}Z"
    user = {
        "login": "robotnik",
        "id": 4711,
        "node_id": "MDQ6VXNlcjQ3MTE=",
        "avatar_url": "https://avatars.githubusercontent.com/u/4711?v=4",
        "gravatar_id": "",
        "url": "https://api.github.com/users/robotnik",
        "html_url": "https://github.com/robotnik",
        "type": "User",
        "site_admin": False,
        "email": "robotnik@example.org",
    }
    api = f"https://api.github.com/repos/{repository}"
    return {
        "url": f"{api}/issues/{number}",
        "repository_url": api,
        "labels_url": f"{api}/issues/{number}/labels{{/name}}",
        "html_url": f"{url}/{repository}/issues/{number}",
        "id": 1_000_000 + number,
        "node_id": "I_kwDO",
        "number": number,
        "title": f"Report {number}",
        "user": user,
        "labels": [{"id": 1, "name": "bug", "color": "d73a4a", "default": True}],
        "state": "open",
        "locked": False,
        "assignees": [user],
        "comments": 0,
        "created_at": moment,
        "updated_at": moment,
        "closed_at": None,
        "author_association": "NONE",
        "body": f"Node {number} dies.\r\n\r\n```\r\n[ERROR] [{number}]: no transform\r\n```",
        "closed_by": None,
        "reactions": {"url": f"{api}/issues/{number}/reactions", "total_count": 0},
        "performed_via_github_app": None,
        **more,
    }


def pull(repository: str, number: int, **more: Any) -> dict[str, Any]:
    """A pull request as it stands in a list of issues."""
    page = f"https://github.com/{repository}/pull/{number}"
    api = f"https://api.github.com/repos/{repository}/pulls/{number}"
    return issue(
        repository,
        number,
        **{"html_url": page, "pull_request": {"url": api, "html_url": page, "merged_at": None}, **more},
    )


def question(number: int, body: str = "<p>It stops.</p>", **more: Any) -> dict[str, Any]:
    """A question as the Stack Exchange API gives it with filter=withbody."""
    return {
        "tags": ["ros2", "navigation"],
        "owner": {
            "account_id": 99,
            "reputation": 11,
            "user_id": 37001,
            "user_type": "registered",
            "profile_image": "https://www.gravatar.com/avatar/0123?s=256",
            "display_name": "J&#252;rgen",
            "link": "https://robotics.stackexchange.com/users/37001/j%c3%bcrgen",
        },
        "is_answered": False,
        "view_count": 5,
        "answer_count": 0,
        "score": 0,
        "last_activity_date": 1_700_000_000 + number,
        "creation_date": 1_700_000_000 + number,
        "question_id": number,
        "content_license": "CC BY-SA 4.0",
        "link": f"https://robotics.stackexchange.com/questions/{number}/it-stops",
        "title": "It stops &amp; says &quot;no map&quot;",
        "body": body,
        **more,
    }


def askbot_item(number: int, **more: Any) -> dict[str, Any]:
    """A question as Askbot's JSON API gives it."""
    return {
        "id": number,
        "title": f"Question {number}",
        "url": f"https://answers.example.org/question/{number}/question/",
        "summary": f"<p>Question {number}</p><pre><code>rosrun a b\n</code></pre>",
        "tags": ["tf", "rviz"],
        "author": {"id": 22, "username": "martin"},
        "added_at": str(1_300_000_000 + number),
        "last_activity_at": "1400000000",
        "last_activity_by": {"id": 22, "username": "martin"},
        "answer_count": 0,
        "answer_ids": [],
        "accepted_answer_id": None,
        "view_count": 12,
        "score": 1,
        **more,
    }


def archived(number: int, *, title: str = "tf2 lookup fails", body: str = "It fails.", site: str = "answers.ros.org",
             migrated: int | None = None, day: str = "2013-11-11T18:27:27Z") -> bytes:  # fmt: skip
    """A file of the archive of ROS Answers."""
    moved = f"migrated_url: https://robotics.stackexchange.com/questions/{migrated}/slug\n" if migrated else ""
    return (
        "---\nanswers:\n- accepted: true\n  body_markdown: |-\n    Source your workspace.\n  comments: []\n"
        f"  creation_date: '{day}'\n  original_post_id: {number + 1}\n  owner_display_name: fergs\n  owner_id: 84\n"
        f"  owner_karma: 13902\n  owner_profile_url: https://{site}/users/84/fergs/\n  owner_user_id: 32806\n"
        f"  upvote_count: 1\ncomments: []\ncreation_date: '{day}'\n{moved}original_post_id: {number}\n"
        f'original_post_url: https://{site}/question/{number}/slug-"odd/\nowner_display_name: "Martin G\\xFCnther"\n'
        f"owner_id: 22\nowner_karma: 31\nowner_profile_url: https://{site}/users/22/martin/\ntags: tf2,catkin\n"
        f"title: {title}\nupvote_count: 1\n---\n{body}\n"
    ).encode()


def stamp(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
