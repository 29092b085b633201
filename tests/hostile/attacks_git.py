"""Repositories that are damaged or made to deceive."""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable
from pathlib import Path

import pygit2

from .attacks_bombs import commit_blob
from .harness import COMMANDS, Attack, Place, cmake, commit, remove, write

GROUP = "git"
CHECK = (*COMMANDS["check"], "--notes", "-f", "json")
RUNS: dict[str, tuple[str, ...]] = {
    "check --rev": (*CHECK, "--rev", "HEAD"),
    "check --base": (*CHECK, "--base", "HEAD~1"),
    "impact": COMMANDS["impact"],
    "logic": COMMANDS["logic"],
}


def objects(place: Place) -> dict[str, Path]:
    """Where the loose objects lie of what a revision is made of."""
    repository = pygit2.Repository(str(place.ws))
    head = repository.head.peel(pygit2.Commit)
    names = {
        "commit": head.id,
        "parent": head.parents[0].id,
        "tree": head.tree.id,
        "folder": head.tree["src/bad"].id,
        "blob": head.tree["src/bad/CMakeLists.txt"].id,
    }
    return {kind: place.ws / ".git/objects" / str(name)[:2] / str(name)[2:] for kind, name in names.items()}


def _unpacked(path: Path) -> bytes:
    return zlib.decompress(path.read_bytes())


HARM: dict[str, Callable[[bytes], bytes | None]] = {
    "gone": lambda raw: None,
    "empty": lambda raw: b"",
    "cut off": lambda raw: zlib.compress(raw)[: len(zlib.compress(raw)) // 2],
    "of another kind": lambda raw: zlib.compress(b"tag " + raw.partition(b" ")[2]),
    "with a wrong length": lambda raw: zlib.compress(
        raw.partition(b" ")[0] + b" 99999999999999999999\0" + raw.partition(b"\0")[2]
    ),
    "of garbage": lambda raw: b"\x78\x01" + b"garbage" * 20,
    "of other content": lambda raw: zlib.compress(raw.partition(b" ")[0] + b" 3\0abc"),
}


def harmed(kind: str, harm: Callable[[bytes], bytes | None]) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        path = objects(place)[kind]
        data = harm(_unpacked(path))
        path.chmod(0o644)
        path.unlink()
        if data is not None:
            path.write_bytes(data)

    return make


def git_file(name: str, data: bytes | str) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        remove(place.ws / ".git" / name)
        write(place.ws / ".git", {name: data})

    return make


def config(text: str) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        path = place.ws / ".git/config"
        path.write_text(path.read_text() + place.filled(text) + "\n")
        script = place.ws / "run.sh"
        script.write_text(f"#!/bin/sh\ntouch {place.marker}\n")
        script.chmod(0o755)

    return make


def odd_commit(**changes: object) -> Callable[[Place], None]:
    """A commit whose raw text has wrong fields."""

    def make(place: Place) -> None:
        repository = pygit2.Repository(str(place.ws))
        raw = repository.read(repository.head.target)[1].decode()
        for name, value in changes.items():
            lines = [f"{name} {value}" if line.startswith(name + " ") else line for line in raw.split("\n")]
            raw = "\n".join(lines)
        target = repository.write(pygit2.GIT_OBJECT_COMMIT, raw.encode("utf-8", "surrogateescape"))
        write(place.ws, {".git/refs/heads/main": f"{target}\n"})

    return make


def parents(count: int) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        repository = pygit2.Repository(str(place.ws))
        raw = repository.read(repository.head.target)[1].decode()
        line = next(each for each in raw.split("\n") if each.startswith("parent"))
        target = repository.write(pygit2.GIT_OBJECT_COMMIT, raw.replace(line, "\n".join([line] * count)).encode())
        write(place.ws, {".git/refs/heads/main": f"{target}\n"})

    return make


def tree_with(*entries: tuple[str, int, str]) -> Callable[[Place], None]:
    """A commit with entries that git itself would refuse: (mode and name as bytes are written by hand)."""

    def make(place: Place) -> None:
        repository = pygit2.Repository(str(place.ws))
        blob = repository.create_blob(place.filled(entries[0][2]).encode())
        raw = repository.read(repository.head.peel(pygit2.Commit).tree.id)[1]
        for name, mode, _ in entries:
            raw += f"{mode:o} ".encode() + place.filled(name).encode("utf-8", "surrogateescape") + b"\0" + blob.raw
        tree = repository.write(pygit2.GIT_OBJECT_TREE, raw)
        text = repository.read(repository.head.target)[1].decode()
        old = text.split("\n")[0]
        parent = f"parent {repository.head.target}"
        lines = [line for line in text.split("\n") if not line.startswith("parent")]
        text = "\n".join([f"tree {tree}", parent, *lines[1:]])
        assert old.startswith("tree")
        target = repository.write(pygit2.GIT_OBJECT_COMMIT, text.encode())
        write(place.ws, {".git/refs/heads/main": f"{target}\n"})

    return make


def tree_of_itself(place: Place) -> None:
    """No tree can hold itself by its name; a file of the object database that lies about its name can."""
    path = objects(place)["folder"]
    name = path.parent.name + path.name
    raw = b"40000 again\0" + bytes.fromhex(name)
    path.chmod(0o644)
    path.write_bytes(zlib.compress(f"tree {len(raw)}".encode() + b"\0" + raw))


def commit_of_itself(place: Place) -> None:
    path = objects(place)["parent"]
    name = path.parent.name + path.name
    raw = _unpacked(path).partition(b"\0")[2].decode()
    text = raw.split("\n", 1)[0] + f"\nparent {name}\n" + raw.split("\n", 1)[1]
    path.chmod(0o644)
    path.write_bytes(zlib.compress(f"commit {len(text)}".encode() + b"\0" + text.encode()))


def refs_in_a_circle(place: Place) -> None:
    write(
        place.ws, {".git/refs/heads/main": "ref: refs/heads/other\n", ".git/refs/heads/other": "ref: refs/heads/main\n"}
    )


def many_refs(place: Place) -> None:
    repository = pygit2.Repository(str(place.ws))
    lines = "".join(f"{repository.head.target} refs/heads/b{n:06}\n" for n in range(100_000))
    write(place.ws, {".git/packed-refs": "# pack-refs with: peeled fully-peeled sorted\n" + lines})


def many_commits(place: Place) -> None:
    repository = pygit2.Repository(str(place.ws))
    who = pygit2.Signature("a", "a@b.org", 1_700_000_300, 0)
    tree = repository.head.peel(pygit2.Commit).tree.id
    last = repository.head.target
    for number in range(3_000):
        last = repository.create_commit(None, who, who, str(number), tree, [last])
    write(place.ws, {".git/refs/heads/main": f"{last}\n"})


def packed(spoil: Callable[[bytes], bytes], ending: str) -> Callable[[Place], None]:
    """All objects in a pack, of which the pack or its index is spoiled."""

    def make(place: Place) -> None:
        import subprocess

        environment = {"PATH": os.environ["PATH"], "HOME": str(place.home)}
        subprocess.run(
            ["git", "gc", "-q", "--prune=now"], cwd=place.ws, env=environment, check=True, capture_output=True
        )
        path = next((place.ws / ".git/objects/pack").glob(f"*.{ending}"))
        path.chmod(0o644)
        path.write_bytes(spoil(path.read_bytes()))

    return make


def _flipped(data: bytes) -> bytes:
    changed = bytearray(data)
    for index in range(40, len(changed), 97):
        changed[index] ^= 0x55
    return bytes(changed)


def hooks(place: Place) -> None:
    for name in ("post-checkout", "pre-commit", "fsmonitor-watchman", "post-index-change", "reference-transaction"):
        path = place.ws / ".git/hooks" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/sh\ntouch {place.marker}\n")
        path.chmod(0o755)


def submodule(url: str) -> Callable[[Place], None]:
    """A submodule whose repository lies where .gitmodules says, with a config that would run something."""

    def make(place: Place) -> None:
        write(
            place.ws,
            {
                ".gitmodules": f'[submodule "a"]\n\tpath = {url}\n\turl = {place.url}/x.git\n\tupdate = !touch '
                f"{place.marker}\n",
            },
        )
        repository = pygit2.Repository(str(place.ws))
        commit_blob(repository, "src/sub", repository.head.target, pygit2.GIT_FILEMODE_COMMIT)

    return make


REVISIONS = (
    "HEAD:src",
    "HEAD^{tree}",
    "HEAD^{blob}",
    ":/one",
    "HEAD@{yesterday}",
    "@{-1}",
    "HEAD~99999999999",
    "HEAD^99",
    "0" * 40,
    "f" * 40,
    "-x",
    "--upload-pack=x",
    "HEAD..HEAD",
    "../../outside/secret.txt",
    "refs/heads/../../config",
    "a" * 10_000,
    "HEAD^{/(a+)+$}",
    ":/" + "(a+)+" * 20,
    "HEAD:src/bad/package.xml",
    "",
)


def rows() -> list[Attack]:
    found: list[Attack] = []
    for kind in ("commit", "tree", "folder", "blob"):
        for name, harm in HARM.items():
            for run in ("check --rev", "logic") if kind != "blob" else RUNS:
                # What is broken above the packages hides them all; the text must say so.
                found.append(
                    Attack(
                        f"{run}: {kind} {name}",
                        GROUP,
                        harmed(kind, harm),
                        RUNS[run],
                        (0, 1, 2),
                        git=True,
                        found=None if (kind, run) in (("blob", "check --rev"), ("folder", "check --rev")) else "",
                        after=said_or_done,
                    )
                )
    for name, harm in HARM.items():
        found.append(
            Attack(
                f"check --base: parent {name}",
                GROUP,
                harmed("parent", harm),
                RUNS["check --base"],
                (0, 1, 2),
                git=True,
                found="",
            )
        )
    files: dict[str, tuple[str, bytes | str]] = {
        "HEAD of garbage": ("HEAD", b"\xff\0" * 100),
        "HEAD empty": ("HEAD", b""),
        "HEAD of nothing": ("HEAD", "ref: refs/heads/none\n"),
        "HEAD outside": ("HEAD", "ref: ../../../outside/secret.txt\n"),
        "HEAD long": ("HEAD", "ref: refs/heads/" + "a" * 1_000_000),
        "index of garbage": ("index", b"DIRC" + b"\xff" * 1000),
        "index of many entries": ("index", b"DIRC\0\0\0\2\xff\xff\xff\xff" + b"\0" * 1000),
        "index empty": ("index", b""),
        "config of garbage": ("config", b"\xff\0[[["),
        "config empty": ("config", b""),
        "config of an unknown format": ("config", "[core]\n\trepositoryformatversion = 99\n"),
        "config of SHA-256": (
            "config",
            "[core]\n\trepositoryformatversion = 1\n[extensions]\n\tobjectformat = sha256\n",
        ),
        "config of partial clones": (
            "config",
            '[core]\n\trepositoryformatversion = 1\n[extensions]\n\tpartialclone = evil\n[remote "evil"]\n'
            "\turl = {url}/x\n\tpromisor = true\n",
        ),
        "packed-refs of garbage": ("packed-refs", b"\xff\0" * 1000),
        "shallow of garbage": ("shallow", b"xyz\n"),
        "shallow of commits": ("shallow", "0" * 40 + "\n"),
        "ref of garbage": ("refs/heads/main", b"xyz"),
        "ref of a blob": ("refs/heads/main", "e69de29bb2d1d6434b8b29ae775ad8c2e48c5391\n"),
        "alternates in a circle": ("objects/info/alternates", "../objects\n"),
        "alternates of garbage": ("objects/info/alternates", b"\0\xff\n" * 1000),
        "commit-graph of garbage": ("objects/info/commit-graph", b"CGPH\1\1\4\0" + b"\xff" * 1000),
        "a pack of garbage": ("objects/pack/pack-" + "a" * 40 + ".pack", b"PACK\0\0\0\2\xff\xff\xff\xff"),
        "an index of a pack of garbage": (
            "objects/pack/pack-" + "a" * 40 + ".idx",
            b"\xfftOc\0\0\0\2" + b"\xff" * 2000,
        ),
        "replace of HEAD": ("refs/replace/" + "a" * 40, "b" * 40 + "\n"),
        "grafts": ("info/grafts", "x y z\n"),
        "a ref named to deceive": ("refs/heads/::error::evil", "x\n"),
    }
    for name, (path, data) in files.items():
        for run in ("check --rev", "logic"):
            found.append(
                Attack(
                    f"{run}: {name}",
                    GROUP,
                    git_file(path, data),
                    RUNS[run],
                    (0, 1, 2),
                    git=True,
                    found="",
                    after=said_or_done,
                )
            )
    for name in (
        "index of garbage",
        "config of garbage",
        "HEAD of garbage",
        "config of an unknown format",
        "index of many entries",
    ):
        path, data = files[name]
        found.append(Attack(f"check of the files: {name}", GROUP, git_file(path, data), CHECK, (1,), git=True))
        found.append(Attack(f"graph: {name}", GROUP, git_file(path, data), COMMANDS["graph"], (0,), git=True))
    runs_nothing = {
        "fsmonitor": "[core]\n\tfsmonitor = {ws}/run.sh",
        "hooks path": "[core]\n\thooksPath = {ws}",
        "pager": "[core]\n\tpager = {ws}/run.sh",
        "ssh": "[core]\n\tsshCommand = {ws}/run.sh",
        "filter": '[filter "x"]\n\tclean = {ws}/run.sh\n\tsmudge = {ws}/run.sh\n\tprocess = {ws}/run.sh',
        "text conversion": '[diff "x"]\n\ttextconv = {ws}/run.sh\n\texternal = {ws}/run.sh\n\tcommand = {ws}/run.sh',
        "credentials": "[credential]\n\thelper = !{ws}/run.sh",
        "alias": "[alias]\n\tlog = !{ws}/run.sh\n\tdiff = !{ws}/run.sh",
        "editor": "[core]\n\teditor = {ws}/run.sh",
        "signatures": "[gpg]\n\tprogram = {ws}/run.sh\n[log]\n\tshowSignature = true",
        "alternate refs": "[core]\n\talternateRefsCommand = {ws}/run.sh",
        "uploads": "[uploadpack]\n\tpackObjectsHook = {ws}/run.sh",
    }
    for name, text in runs_nothing.items():
        for run in ("check --base", "logic"):
            make = config(text)
            if name in ("filter", "text conversion"):
                make = with_attributes(make)
            found.append(
                Attack(
                    f"{run}: config runs something: {name}",
                    GROUP,
                    make,
                    RUNS[run],
                    (0, 1),
                    git=True,
                    found="" if "base" in run else None,
                )
            )
    found.append(Attack("hooks", GROUP, hooks, RUNS["check --base"], (0, 1), git=True, found=""))
    found.append(Attack("logic: hooks", GROUP, hooks, RUNS["logic"], (0,), git=True))
    for text in REVISIONS:
        label = text if len(text) < 40 else text[:12] + "..."
        found.append(
            Attack(
                f"--rev {label}", GROUP, {}, (*CHECK, "--rev", text), (0, 1, 2), git=True, found="", after=said_or_done
            )
        )
        found.append(
            Attack(
                f"--base {label}",
                GROUP,
                {},
                (*CHECK, "--base", text),
                (0, 1, 2),
                git=True,
                found="",
                after=said_or_done,
            )
        )
    for text in ("HEAD:src", "HEAD..", "..", "a..b..c", "HEAD~1...HEAD", "-x", "HEAD^{tree}"):
        found.append(
            Attack(
                f"logic --range {text}", GROUP, {}, (*COMMANDS["logic"], "--range", text), (0, 2), git=True, found=""
            )
        )
    for text in ("9999-99-99", "0000-01-01", "99999-01-01", "-1", "1e400", "2024-02-30"):
        found.append(
            Attack(
                f"logic --since {text}", GROUP, {}, (*COMMANDS["logic"], "--since", text), (0, 2), git=True, found=""
            )
        )
    who = "a <a@b.org>"
    people = {
        "a year over 9999": f"{who} 999999999999 +0000",
        "a year before 1970": f"{who} -99999999999 +0000",
        "a time beyond 64 bits": f"{who} 99999999999999999999999 +0000",
        "a zone of 99 hours": f"{who} 1700000000 +9999",
        "no time": who,
        "no name": "<> 1700000000 +0000",
        "bytes": "\udcff\udcfe <\udcff> 1700000000 +0000",
        "a zone that overflows": f"{who} 1700000000 -99999999999",
    }
    for name, value in people.items():
        for run in ("logic", "check --rev", "impact"):
            found.append(
                Attack(
                    f"{run}: commit by {name}",
                    GROUP,
                    odd_commit(author=value, committer=value),
                    RUNS[run],
                    (0, 1, 2),
                    git=True,
                    found="",
                    after=said_or_done,
                )
            )
        found.append(
            Attack(
                f"logic json: commit by {name}",
                GROUP,
                odd_commit(author=value, committer=value),
                (*COMMANDS["logic"], "-f", "json"),
                (0, 2),
                git=True,
                found="",
            )
        )
    trees = {
        "..": ("..", 0o100644, "x"),
        ".git": (".git", 0o100644, "x"),
        "a slash": ("a/../../x", 0o100644, "x"),
        "no name": ("", 0o100644, "x"),
        "an absolute path": ("{outside}/x", 0o100644, "x"),
        "a mode of a device": ("dev", 0o60000, "x"),
        "a mode of a pipe": ("pipe", 0o10000, "x"),
        "a blob as a folder": ("zzz", 0o40000, "x"),
        "a blob as a submodule": ("zzz", 0o160000, "x"),
        "a link to /": ("zzz", 0o120000, "/"),
        "a link to outside": ("rosimpact.toml", 0o120000, "{outside}/secret.txt"),
        "a link of null bytes": ("zzz", 0o120000, "a\0b"),
        "a link of 1 MB": ("zzz", 0o120000, "a/" * 500_000),
        "a link to itself": ("package.xml", 0o120000, "package.xml"),
        "bytes": ("\udcff\udcfe.cpp", 0o100644, "x"),
        "controls": ("a\n::error::\x1b[2J.cpp", 0o100644, "x"),
        "mode 0": ("zzz", 0, "x"),
        "a huge mode": ("zzz", 0o7777777777, "x"),
    }
    for name, entry in trees.items():
        for run in ("check --rev", "logic"):
            make = tree_with(entry)
            found.append(
                Attack(
                    f"{run}: tree with {name}",
                    GROUP,
                    make,
                    RUNS[run],
                    (0, 1, 2),
                    git=True,
                    found="",
                    after=said_or_done,
                )
            )
    for run in RUNS:
        found += [
            Attack(f"{run}: a tree that holds itself", GROUP, tree_of_itself, RUNS[run], (0, 1, 2), git=True, found=""),
            Attack(
                f"{run}: a commit that is its own parent",
                GROUP,
                commit_of_itself,
                RUNS[run],
                (0, 1, 2),
                git=True,
                found="",
            ),
            Attack(
                f"{run}: a commit of 3,000 times the same parent",
                GROUP,
                parents(3_000),
                RUNS[run],
                (0, 1, 2),
                git=True,
                found="",
            ),
            Attack(f"{run}: refs in a circle", GROUP, refs_in_a_circle, RUNS[run], (0, 1, 2), git=True, found=""),
            Attack(
                f"{run}: a pack that is spoiled",
                GROUP,
                packed(_flipped, "pack"),
                RUNS[run],
                (0, 1, 2),
                git=True,
                found="",
            ),
            Attack(
                f"{run}: a pack that is cut off",
                GROUP,
                packed(lambda data: data[:200], "pack"),
                RUNS[run],
                (0, 1, 2),
                git=True,
                found="",
            ),
            Attack(
                f"{run}: an index of a pack that is spoiled",
                GROUP,
                packed(_flipped, "idx"),
                RUNS[run],
                (0, 1, 2),
                git=True,
                found="",
            ),
            Attack(
                f"{run}: a submodule outside", GROUP, submodule("../outside"), RUNS[run], (0, 1, 2), git=True, found=""
            ),
        ]
    found += [
        Attack("100,000 branches", GROUP, many_refs, RUNS["check --base"], (0, 1), git=True, found=""),
        Attack("logic: 3,000 commits that change nothing", GROUP, many_commits, RUNS["logic"], (0,), git=True),
        Attack("a submodule by an absolute path", GROUP, submodule("{outside}"), CHECK, git=True),
        Attack("a submodule by a URL", GROUP, submodule("src/sub"), RUNS["check --rev"], git=True),
        Attack("a bare repository in the tree", GROUP, bare_inside, CHECK),
        Attack(
            "installed command: tree gone",
            GROUP,
            harmed("tree", HARM["gone"]),
            RUNS["check --rev"],
            (2,),
            git=True,
            found="",
            direct=True,
        ),
        Attack(
            "installed command: config runs something",
            GROUP,
            config("[core]\n\tfsmonitor = {ws}/run.sh"),
            RUNS["check --base"],
            (0, 1),
            git=True,
            found="",
            direct=True,
        ),
    ]
    return found


def with_attributes(make: Callable[[Place], None]) -> Callable[[Place], None]:
    def both(place: Place) -> None:
        write(place.ws, {".gitattributes": "* filter=x diff=x merge=x\n"})
        commit(place.ws, "attributes")
        make(place)

    return both


def bare_inside(place: Place) -> None:
    repository = pygit2.init_repository(str(place.ws / "src/bad/inner"), bare=True)
    repository.config["core.fsmonitor"] = f"touch {place.marker}"
    write(place.ws, {"src/bad/inner/src/package.xml": cmake("x")})


def said_or_done(place: Place, ended) -> list[str]:
    """A status of 2 comes with one line that says why."""
    lines = [line for line in ended.err.decode("utf-8", "replace").splitlines() if line.strip()]
    out = ended.out.strip()
    if ended.status == 2 and not lines and not out:
        return ["fails without a word"]
    return []
