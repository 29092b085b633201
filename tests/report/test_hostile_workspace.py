"""A workspace whose names are commands, in every format and encoding: nothing of it begins a line or is obeyed."""

import io
import json
import os
import re
import sys

import pytest
from rosimpact.impact.cli import app as cli

NAMES = ("::add-mask::x", "##[group]y", "\x1b[2Jz", "a\n::stop-commands::t", "\u202eb`c`d@team", "caf\udce9")
FORMATS = ("text", "json", "sarif", "github", "markdown", "html")
CPP = "#include <tf2_geometry_msgs/tf2_geometry_msgs.h>  // \x1b[2J ##[group]x \u202e ::error::x\n"
MANIFEST = '<package format="3"><name>{}</name><version>1.0.0</version><description>d</description>\
<maintainer email="a@b.org">m</maintainer><license>l</license></package>'


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    root = tmp_path_factory.mktemp("hostile")
    for name in NAMES:
        package = root / "src" / name
        package.mkdir(parents=True)
        given = name if name.isprintable() else "p"
        (package / "package.xml").write_text(MANIFEST.format(given), encoding="utf-8")
        (package / "CMakeLists.txt").write_text(
            "project(p)\nfind_package(ament_cmake REQUIRED)\nadd_executable(n n.cpp)\nament_package()\n"
        )
        (package / "n.cpp").write_text(CPP, encoding="utf-8")
    (root / "rosimpact.toml").write_text('[targets."::error::t"]\ndistro = "jazzy"\n')
    return root


def printed(monkeypatch, cache, encoding, arguments):
    """Status, what is printed and what is said, of one run."""
    out = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    err = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    monkeypatch.setattr(sys, "argv", ["rosimpact", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    return ended.value.code, out.buffer.getvalue(), err.buffer.getvalue()


def lines_are_ours(text, format):
    for line in re.split("[\r\n\x0b\x0c\x85\u2028\u2029]", text):
        assert not re.search(r"##[A-Za-z]{0,20}\[", line), line
        if line.lstrip().startswith("::"):
            assert format == "github" and re.match(r"::(error|warning|notice) (file=[^:,]*,)?title=[^:,]*", line), line
        assert not re.search("[\x00-\x08\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]", line), line
        assert not line.startswith(("##", "p ", "p\t", "src/", "::error::t")), line


@pytest.mark.parametrize("encoding", ["utf-8", "ascii", "utf-16"])
@pytest.mark.parametrize("format", FORMATS)
def test_check(workspace, cache, monkeypatch, format, encoding):
    status, out, err = printed(monkeypatch, cache, encoding, ["check", workspace, "-f", format, "-q"])
    assert status == 1, err
    assert b"fault of rosimpact" not in err
    text = out.decode("utf-8" if format in ("html", "github") else encoding)
    lines_are_ours(text, format)
    lines_are_ours(err.decode(encoding), "text")
    if format in ("json", "sarif"):
        assert json.loads(out) == json.loads(text)
    if format == "json":
        paths = {os.fsencode(finding["path"]) for finding in json.loads(out)["findings"]}
        assert b"src/caf\xe9/n.cpp" in paths, "names of any bytes come back"
        assert {
            path for path in paths if path and not os.path.exists(os.path.join(os.fsencode(workspace), path))
        } == set()


@pytest.mark.parametrize(
    "arguments",
    [
        ["why", "tf2_geometry_msgs"], ["graph"], ["graph", "-f", "dot"], ["graph", "-f", "json"],
        ["upgrade", "--from", "::error::t", "--to", "rolling"], ["env", "diff", "humble", "::error::t"],
    ],
    ids=" ".join,
)  # fmt: skip
def test_other_commands(workspace, cache, monkeypatch, arguments):
    status, out, err = printed(monkeypatch, cache, "utf-8", [*arguments, workspace])
    assert status in (0, 1, 2) and b"fault of rosimpact" not in err, err
    for stream in (out, err):
        lines_are_ours(stream.decode(), "text")


def test_a_patch_is_right_or_is_not_printed(tmp_path, cache, monkeypatch):
    package = tmp_path / "src" / "p"
    package.mkdir(parents=True)
    manifest = MANIFEST.format("p").replace("<license>", "<!--\n  ::add-mask::x\n-->\n<license>")
    (package / "package.xml").write_text(manifest.replace("</license>", "</license>\n"))
    (package / "CMakeLists.txt").write_text("project(p)\nfind_package(ament_cmake REQUIRED)\nadd_executable(n n.cpp)\n")
    (package / "n.cpp").write_text("#include <tf2_geometry_msgs/tf2_geometry_msgs.h>\n")
    command = ["check", tmp_path, "-t", "jazzy", "--diff", "-q"]
    status, out, err = printed(monkeypatch, cache, "utf-8", command)
    whole = tmp_path / "patch"
    printed(monkeypatch, cache, "utf-8", [*command, "-o", whole])
    assert "::add-mask::x" in whole.read_text(), "a file has all of it"
    assert b"add-mask" not in out and b"package.xml" not in out
    assert status == 2 and b"package.xml: its changes are not printed" in err
