"""`rosimpact triage`: one report, a stream of them, an address; what it prints and how it fails."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from rosimpact.classifier.triage import CHECKS, Post, is_address, list_checks, parse_post
from rosimpact.corpus.polite import Clock
from rosimpact.impact.cli.app import app
from typer.testing import CliRunner

UPDATE = "does not compile since the upgrade from humble to jazzy\nerror: undefined symbol after apt upgrade on jazzy"
ACTION = Path(__file__).parents[2] / "examples" / "triage-action" / "triage_issue.py"


def run(*arguments: str, input: str | bytes | None = None):
    return CliRunner().invoke(app, ["triage", *arguments], input=input)


class Server:
    """Answers as api.github.com and api.stackexchange.com do, and keeps what was asked."""

    def __init__(self) -> None:
        self.pages: dict[str, tuple[int, bytes]] = {}
        self.posted: list[tuple[str, dict, str]] = []
        outer = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                status, body = outer.pages.get(self.path.split("?")[0], (404, b'{"message": "Not Found"}'))
                self._answer(status, body)

            def do_POST(self):
                sent = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                outer.posted.append((self.path, sent, self.headers["Authorization"]))
                self._answer(200, json.dumps([{"name": name} for name in sent["labels"]]).encode())

            def _answer(self, status: int, body: bytes):
                self.send_response(status)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *unused):
                pass

        self.http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.address = f"http://127.0.0.1:{self.http.server_port}"
        threading.Thread(target=self.http.serve_forever, args=(0.01,), daemon=True).start()


@pytest.fixture
def server(monkeypatch):
    made = Server()
    monkeypatch.setenv("ROSIMPACT_GITHUB_API", made.address)
    monkeypatch.setenv("ROSIMPACT_STACK_EXCHANGE_API", made.address)
    monkeypatch.delenv("GITHUB_TOKEN", raising=False)
    yield made
    made.http.shutdown()
    made.http.server_close()


class TestOneReport:
    def test_text_names_label_reasons_like_reports_and_what_to_run(self):
        result = run(UPDATE)
        assert result.exit_code == 0
        assert result.stdout.startswith("library-update (")
        assert "what spoke for library-update:" in result.stdout
        assert result.stdout.count("https://") == 5
        assert "rosimpact check --target humble --target jazzy" in result.stdout

    def test_json_says_the_same(self):
        found = json.loads(run(UPDATE, "--format", "json").stdout)
        assert found["label"] == "library-update"
        assert found["abstained"] is False
        assert sum(found["probabilities"].values()) == pytest.approx(1, abs=1e-4)
        assert {"where", "what", "weight"} == set(found["reasons"][0])
        assert len(found["nearest"]) == 5
        assert found["run"] == ["rosimpact check --target humble --target jazzy"]

    def test_a_file_and_standard_input_give_what_the_text_gives(self, tmp_path):
        file = tmp_path / "issue.md"
        file.write_text(UPDATE)
        text = run(UPDATE).stdout
        assert run(str(file)).stdout == text
        assert run("-", input=UPDATE).stdout == text

    def test_a_report_without_a_word_is_one_it_is_unsure_of(self):
        assert run("zzqx wvyk").stdout.startswith("unsure: ")

    @pytest.mark.parametrize("text", ["\udcff bytes", "\u202e", "a" * 3000, "🤖" * 50, "{", "[1]", "null"])
    def test_any_text_is_answered(self, text, tmp_path):
        file = tmp_path / "x"
        file.write_bytes(text.encode("utf-8", "surrogateescape"))
        assert run(str(file)).exit_code == 0


class TestChecks:
    @pytest.mark.parametrize(
        ("label", "text", "calls"),
        [
            ("dependency", "fails on jazzy", ["rosimpact check --target jazzy"]),
            ("dependency", "no distro named", ["rosimpact check"]),
            ("dependency", "on hydro and Noetic", ["rosimpact check --target noetic"]),
            ("inconsistency", "", ["rosimpact graph", "rosimpact check"]),
            ("message-logic", "", ["rosimpact logic"]),
            ("other", "", []),
        ],
    )
    def test_what_to_run(self, label, text, calls):
        assert list_checks(label, Post("", text, "")) == calls

    def test_the_command_line_has_what_it_names(self):
        from typer.main import get_command

        commands = set(get_command(app).commands)
        for label in CHECKS:
            for call in list_checks(label, Post("", "", "")):
                assert call.split()[1] in commands

    def test_the_command_alone_says_what_to_run(self, say):
        """The program builds no more commands than the one that runs."""
        said = say("triage", "undefined symbol since the upgrade to jazzy")
        assert said.out.endswith("run next:\n  rosimpact check --target jazzy\n")


class TestStream:
    ROWS = "".join(
        json.dumps({"id": id, "title": title, "body": None}) + "\n"
        for id, title in (("a", "undefined symbol since the upgrade to noetic"), (7, "a dark theme would be nice"))
    )

    @pytest.mark.parametrize("arguments", [("-",), ("--jsonl", "-")])
    def test_lines_in_lines_out(self, arguments):
        result = run(*arguments, input=self.ROWS)
        found = [json.loads(line) for line in result.stdout.splitlines()]
        assert [row["id"] for row in found] == ["a", "7"]
        assert [row["label"] for row in found] == ["library-update", "other"]
        assert all(set(row) == {"id", "label", "probabilities", "abstained"} for row in found)

    @pytest.mark.parametrize("content", ["", "\n\n", "\ufeff"])
    def test_nothing_to_judge_is_an_error(self, content, tmp_path):
        file = tmp_path / "r.jsonl"
        file.write_text(content, encoding="utf-8")
        result = run("--jsonl", str(file))
        assert (result.exit_code, result.stdout) == (2, "")
        assert "holds no report" in result.stderr

    def test_a_byte_order_mark_is_no_part_of_the_first_line(self, tmp_path):
        file = tmp_path / "r.jsonl"
        file.write_text("\ufeff" + self.ROWS, encoding="utf-8")
        assert run("--jsonl", str(file)).stdout == run(str(file)).stdout == run("-", input=self.ROWS).stdout

    @pytest.mark.parametrize("arguments", [(), ("--jsonl",)])
    def test_a_file_without_end_is_refused(self, arguments, tmp_path):
        with open(tmp_path / "sparse", "wb") as file:
            file.truncate(3 << 30)
        result = run(*arguments, str(tmp_path / "sparse"))
        assert (result.exit_code, result.stdout) == (2, "")
        assert "sparse: cannot be read: larger than 8 MB" in result.stderr

    def test_a_file(self, tmp_path):
        file = tmp_path / "r.jsonl"
        file.write_text(self.ROWS)
        assert run(str(file)).stdout == run("-", input=self.ROWS).stdout

    def test_an_answer_comes_before_the_next_question(self):
        command = [sys.executable, "-c", "from rosimpact.impact.cli.app import main; main()", "triage", "--jsonl", "-"]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdin and process.stdout
            for id in ("1", "2"):
                process.stdin.write(json.dumps({"id": id, "title": "x"}) + "\n")
                process.stdin.flush()
                assert json.loads(process.stdout.readline())["id"] == id
            process.stdin.close()
            assert process.wait() == 0

    def test_whoever_reads_may_stop(self, tmp_path):
        (tmp_path / "r.jsonl").write_text(self.ROWS * 500)
        command = [sys.executable, "-c", "from rosimpact.impact.cli.app import main; main()", "triage"]
        with subprocess.Popen(
            [*command, tmp_path / "r.jsonl"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
        ) as process:
            assert process.stdout and process.stderr
            assert process.stdout.readline()
            process.stdout.close()
            assert process.stderr.read() == b""

    def test_a_broken_line_is_named_after_the_answers_before_it(self):
        result = run("--jsonl", "-", input=self.ROWS + '{"title": 3}\n')
        assert result.exit_code == 2
        assert len(result.stdout.splitlines()) == 2
        assert "standard input:3: is no JSON object" in result.stderr

    @pytest.mark.parametrize("line", ["", "3", "[]", "{}", '{"title": []}', "[" * 100_000, '{"id": {}, "title": ""}'])
    def test_what_is_no_report(self, line):
        assert parse_post(line) is None


class TestAddresses:
    def test_an_issue(self, server):
        page = {
            "title": "undefined symbol since the upgrade to noetic",
            "body": None,
            "number": 12,
            "url": f"{server.address}/repos/o/r/issues/12",
            "repository_url": f"{server.address}/repos/o/r",
            "html_url": "https://github.com/o/r/issues/12",
            "created_at": "2024-01-31T10:00:00Z",
            "updated_at": "2024-01-31T10:00:00Z",
            "labels": [],
            "user": {"login": "ann"},
        }
        server.pages["/repos/o/r/issues/12"] = (200, json.dumps(page).encode())
        for url in ("https://github.com/o/r/issues/12", "https://github.com/o/r/pull/12/files"):
            found = json.loads(run(url, "-f", "json").stdout)
            assert (found["id"], found["label"]) == ("o/r#12", "library-update")

    def test_a_question(self, server):
        question = {"question_id": 98, "creation_date": 1706700000, "title": "R&amp;D: no rosdep key for x"}
        question |= {"body": "<p>rosdep fails</p><pre>no key</pre>", "link": "https://robotics.stackexchange.com/q/98"}
        page = {"items": [question], "has_more": False, "quota_max": 300, "quota_remaining": 299}
        server.pages["/questions/98"] = (200, json.dumps(page).encode())
        found = json.loads(run("https://robotics.stackexchange.com/questions/98/no-key", "-f", "json").stdout)
        assert (found["id"], found["label"]) == ("robotics-se:98", "dependency")

    @pytest.mark.parametrize(
        ("status", "body", "says"),
        [
            (404, b"{}", "is not there, or not public"),
            (410, b"{}", "is not there, or not public"),
            (403, b"{}", "answered with status 403"),
            (429, b"{}", "the rate limit is reached, and says to come back at"),
            (502, b"<html>", "answered with status 502, 3 times in a row"),
            (200, b"<html>", "that is no JSON, 3 times in a row"),
            (200, b"[]", "is not there, or not public"),
        ],
    )
    def test_a_server_that_refuses(self, server, monkeypatch, status, body, says):
        monkeypatch.setattr(Clock, "sleep", lambda self, seconds: None)
        server.pages["/repos/o/r/issues/1"] = (status, body)
        result = run("https://github.com/o/r/issues/1")
        assert result.exit_code == 2
        assert result.stderr.startswith("rosimpact: https://github.com/o/r/issues/1: ")
        assert says in result.stderr
        assert "or give the text itself" in result.stderr

    def test_offline(self, monkeypatch):
        monkeypatch.setattr(Clock, "sleep", lambda self, seconds: None)
        monkeypatch.setenv("ROSIMPACT_GITHUB_API", "http://127.0.0.1:9")
        result = run("https://github.com/o/r/issues/1")
        assert result.exit_code == 2
        assert "cannot be reached" in result.stderr
        assert len(result.stderr.splitlines()) == 1

    @pytest.mark.parametrize(
        ("url", "says"),
        [
            ("https://answers.ros.org/question/1/x/", "answers.ros.org is gone"),
            ("https://example.org/x", "known are github.com and stackexchange.com"),
            ("https://bitbucket.org/o/r/issues/5", "known are github.com and stackexchange.com"),
            ("https://github.com.evil.example/o/r/issues/5", "known are github.com"),
            ("https://github.com@evil.example/o/r/issues/5", "without user name and port"),
            ("https://evil.example\\@github.com/o/r/issues/5", "without user name and port"),
            ("https://github.com:8443/o/r/issues/5", "without user name and port"),
            ("https://github.com:99999/o/r/issues/5", "cannot be read"),
            ("https://g\u0456thub.com/o/r/issues/5", "known are github.com"),
            ("https://github\uff0fcom/o/r/issues/5", "cannot be read"),
            ("https://meta.robotics.stackexchange.com/q/5", "known are github.com"),
            ("https://robotics.stackexchange.com.evil.example/q/5", "known are github.com"),
            ("https://127.0.0.1/o/r/issues/5", "known are github.com"),
            ("https://[::1/o/r/issues/5", "cannot be read"),
            ("ftp://github.com/o/r/issues/5", "is no address of a page"),
            ("file:///etc/passwd", "is no address of a page"),
            ("http://", "is no address of a page"),
            ("//github.com/o/r/issues/5", "there is no such file"),
            ("https://github.com/o/../issues/5", "is no issue, pull request or question"),
            ("https://github.com/o/r", "is no issue, pull request or question"),
        ],
    )
    def test_other_addresses(self, url, says, monkeypatch):
        def ask(self, *unused, **more):
            raise AssertionError("nobody may be asked")

        monkeypatch.delenv("ROSIMPACT_GITHUB_API", raising=False)
        monkeypatch.setattr("rosimpact.corpus.polite.Client._send_request", ask)
        result = run(url)
        assert result.exit_code == 2
        assert says in result.stderr
        assert len(result.stderr.splitlines()) == 1

    @pytest.mark.parametrize(
        ("named", "host", "api"),
        [
            ("", "github.com", "public"),
            ("", "ghe.example.org", ""),
            ("https://ghe.example.org/api/v3", "github.com", "public"),
            ("https://ghe.example.org/api/v3", "ghe.example.org", "https://ghe.example.org/api/v3"),
            ("https://api.octo.ghe.com", "octo.ghe.com", "https://api.octo.ghe.com"),
            ("https://ghe.example.org/api/v3", "other.example.org", ""),
            ("http://127.0.0.1:9", "github.com", "http://127.0.0.1:9"),
            ("http://127.0.0.1:9", "example.org", ""),
        ],
    )
    def test_which_server_is_asked(self, named, host, api, monkeypatch):
        from rosimpact.classifier.triage import _find_github_api

        monkeypatch.setenv("ROSIMPACT_GITHUB_API", named)
        assert _find_github_api(host, "public") == api

    def test_a_password_in_an_address_is_not_shown(self):
        result = run("https://ghp_s3cret:x@github.com/o/r/issues/5")
        assert result.exit_code == 2 and "s3cret" not in result.output

    def test_an_address_without_its_scheme_is_one_all_the_same(self):
        assert "answers.ros.org is gone" in run("answers.ros.org/question/1/x/").stderr
        assert "is no issue, pull request or question" in run("github.com/o/r").stderr

    def test_what_is_no_text_is_refused(self, tmp_path):
        (tmp_path / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR")
        (tmp_path / "late.dat").write_bytes(b"a title\nand then\0\0\0")
        for name in ("picture.png", "late.dat"):
            result = run(str(tmp_path / name))
            assert (result.exit_code, result.stdout) == (2, "")
            assert f"{name}: is no text" in result.stderr
        assert "is a folder" in run(str(tmp_path)).stderr

    @pytest.mark.parametrize("text", ["rviz crashes", "undefined", "see a/b.cpp", "http:// is refused", "tf2::x"])
    def test_what_is_a_text(self, text):
        assert run(text).exit_code == 0

    def test_a_text_that_holds_an_address_is_a_text(self):
        assert not is_address("see https://github.com/o/r/issues/1")


class TestErrors:
    @pytest.mark.parametrize(
        ("arguments", "says"),
        [
            (("x", "--format", "xml"), "--format xml: unknown"),
            (("missing.jsonl",), "missing.jsonl: there is no such file"),
            (("nosuch.log",), "nosuch.log: there is no such file"),
            (("logs/latest",), "logs/latest: there is no such file"),
            (("~/report",), "~/report: there is no such file"),
            (("/dev/zero",), "/dev/zero: is not a regular file"),
            (("--jsonl", "/dev/null"), "/dev/null: is not a regular file"),
            (("",), "the report is empty"),
            (("x", "--jsonl"), "--jsonl: needs a file"),
            (("x", "--model", "none.npz"), "none.npz: cannot be read"),
        ],
    )
    def test_one_line_and_status_2(self, arguments, says):
        result = run(*arguments)
        assert result.exit_code == 2
        assert says in result.stderr
        assert len(result.stderr.splitlines()) == 1

    def test_a_bad_model_is_named_before_an_address_is_asked(self, server):
        result = run("https://github.com/o/r/issues/1", "--model", "none.npz")
        assert "none.npz: cannot be read" in result.stderr

    @pytest.mark.parametrize(
        ("arguments", "says"),
        [
            (["train", "--reports", "none.jsonl"], "none.jsonl: cannot be read: No such file"),
            (["train", "--reports", "{tmp}/r.jsonl", "--labels", "none.jsonl"], "none.jsonl: cannot be read"),
            (
                ["train", "--reports", "{tmp}/r.jsonl", "-o", "{tmp}"],
                ": cannot be written: Is a directory; give another",
            ),
            (
                ["train", "--reports", "{tmp}/r.jsonl", "-o", "{tmp}/r.jsonl/m.npz"],
                "m.npz: cannot be written: Not a dir",
            ),
            (["evaluate", "--reports", "none.jsonl"], "none.jsonl: cannot be read: No such file"),
            (["evaluate", "--reports", "{tmp}/bad.jsonl"], "bad.jsonl:1: is no report"),
            (["evaluate", "--reports", "{tmp}/r.jsonl", "--format", "xml"], "--format xml: unknown"),
        ],
    )
    def test_training_is_refused_before_anything_slow_is_imported(self, arguments, says, tmp_path, monkeypatch):
        monkeypatch.setitem(sys.modules, "rosimpact.classifier.training", None)
        monkeypatch.setitem(sys.modules, "rosimpact.classifier.evaluate", None)
        (tmp_path / "r.jsonl").write_text("")
        (tmp_path / "bad.jsonl").write_text("[]\n")
        result = CliRunner().invoke(app, ["classifier", *(part.format(tmp=tmp_path) for part in arguments)])
        assert (result.exit_code, result.stdout) == (2, "")
        assert says in result.stderr and len(result.stderr.splitlines()) == 1

    def test_an_error_that_nobody_foresaw_is_a_line_too(self, monkeypatch):
        def broken(*unused):
            raise KeyError("a\nkey")

        monkeypatch.delenv("ROSIMPACT_DEBUG", raising=False)
        monkeypatch.setattr("rosimpact.classifier.triage.triage", broken)
        result = run("x")
        assert (result.exit_code, result.stdout) == (2, "")
        assert result.stderr.startswith("rosimpact: KeyError in test_triage.py:")
        assert result.stderr.endswith("; this is a fault of rosimpact, please report it\n")
        assert len(result.stderr.splitlines()) == 1

    @pytest.mark.parametrize("command", ["train", "evaluate"])
    def test_nor_does_one_in_training_show_a_traceback(self, command, tmp_path, monkeypatch):
        def broken(*unused):
            raise ZeroDivisionError

        monkeypatch.delenv("ROSIMPACT_DEBUG", raising=False)
        monkeypatch.setattr("rosimpact.classifier.training.read_examples", broken)
        (tmp_path / "reports.jsonl").write_text("")
        result = CliRunner().invoke(app, ["classifier", command, "--reports", str(tmp_path / "reports.jsonl")])
        assert result.exit_code == 2
        assert result.stderr.startswith("rosimpact: ZeroDivisionError in test_triage.py:")
        assert "Traceback" not in result.output

    def test_interrupted(self, monkeypatch):
        def stopped(*unused):
            raise KeyboardInterrupt

        monkeypatch.setattr("rosimpact.classifier.triage.triage", stopped)
        result = run("x")
        assert (result.exit_code, result.stderr) == (130, "rosimpact: interrupted\n")


class TestAction:
    def act(self, server, tmp_path, issue: dict):
        event = tmp_path / "event.json"
        event.write_text(json.dumps({"action": "opened", "issue": issue}))
        folder = Path(sys.executable).parent
        environment = {
            "PATH": f"{folder}:/usr/bin:/bin",
            "GITHUB_EVENT_PATH": str(event),
            "GITHUB_REPOSITORY": "o/r",
            "GITHUB_TOKEN": "secret",
            "GITHUB_API_URL": server.address,
        }
        return subprocess.run(
            [sys.executable, str(ACTION)], env=environment, capture_output=True, text=True, check=False
        )

    def test_a_new_issue_is_labelled(self, server, tmp_path):
        title, body = UPDATE.split("\n")
        done = self.act(server, tmp_path, {"number": 5, "title": title, "body": body})
        assert done.returncode == 0, done.stderr
        assert server.posted == [
            ("/repos/o/r/issues/5/labels", {"labels": ["triage: library-update"]}, "Bearer secret")
        ]

    def test_an_issue_it_is_unsure_of_is_left_alone(self, server, tmp_path):
        done = self.act(server, tmp_path, {"number": 5, "title": "zzqx wvyk", "body": None})
        assert done.returncode == 0, done.stderr
        assert server.posted == []
