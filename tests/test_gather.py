"""From a tree to facts: each content parsed once, whatever fails named, whatever was parsed kept."""

import os
import signal
import subprocess
import sys
import time

import pygit2
import pytest
from rosimpact.edges import processes
from rosimpact.impact import tree as tree_module
from rosimpact.impact.facts import extract as gather_module
from rosimpact.impact.facts import kinds
from rosimpact.impact.facts.extract import extract_all
from rosimpact.impact.facts.store import Store
from rosimpact.impact.facts.usage import UsageTable
from rosimpact.impact.tree import GitTree, PathProblem, WorkingTree

LAUNCH = "<launch><node pkg='p' exec='n'/></launch>"
MANIFEST = "<package format='3'><name>p</name><version>1.0.0</version></package>"
FILES = {
    "p/package.xml": MANIFEST,
    "p/CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\nproject(p)\n",
    "p/src/node.cpp": "#include <rclcpp/rclcpp.hpp>\nint main() {}\n",
    "p/src/same.cpp": "#include <rclcpp/rclcpp.hpp>\nint main() {}\n",
    "p/msg/A.msg": "int32 a\n",
    "p/mesh.stl": "solid\n",
}


def write(root, files):
    for path, text in files.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text)
    return root


def sources(count):
    return {f"src/f{n}.cpp": f"#include <a{n}.h>\n" + f"int f{n}() {{ return {n}; }}\n" * 40 for n in range(count)}


@pytest.fixture(autouse=True)
def later(monkeypatch):
    """Lets the tree believe that time has passed since the files were written, so that it remembers their ids."""
    monkeypatch.setattr(time, "time_ns", lambda: int((time.time() + 100) * 1e9))


@pytest.fixture
def small_chunks(monkeypatch):
    """Work in processes, in many chunks, for little input."""
    monkeypatch.setattr(gather_module, "ALONE_BYTES", 0)
    monkeypatch.setattr(gather_module, "_CHUNK_BYTES", 3000)


@pytest.fixture
def short_time(monkeypatch):
    """A fifth of a second of processor time for a file."""
    monkeypatch.setattr(processes, "compute_seconds", lambda size: 0.2)


def test_facts_by_path(tmp_path):
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(write(tmp_path / "ws", FILES)), store)
        assert list(extraction.kinds) == sorted(FILES.keys() - {"p/mesh.stl"})
        assert extraction.get_facts("p/package.xml").facts.name == "p"
        assert extraction.get_facts("p/src/node.cpp").facts.includes[0].path == "rclcpp/rclcpp.hpp"
        assert extraction.get_facts("p/msg/A.msg").facts.sections[0].fields[0].name == "a"
        assert extraction.list_paths("cpp", "msg") == ["p/msg/A.msg", "p/src/node.cpp", "p/src/same.cpp"]
        assert extraction.problems == []
        with pytest.raises(KeyError):
            extraction.get_facts("p/mesh.stl")


def test_equal_contents_are_parsed_once_and_shared(tmp_path):
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(write(tmp_path / "ws", FILES)), store)
        assert extraction.extracted == 4
        assert extraction.get_facts("p/src/node.cpp") is extraction.get_facts("p/src/same.cpp")


def test_a_second_run_reads_and_parses_nothing(tmp_path, monkeypatch):
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        first = extract_all(WorkingTree(tmp_path / "ws"), store)
    monkeypatch.setattr(kinds, "extract", None)
    tree = WorkingTree(tmp_path / "ws")
    monkeypatch.setattr(tree, "read_with_id", None)
    monkeypatch.setattr(tree, "read", None)
    with Store(tmp_path / "cache") as store:
        second = extract_all(tree, store)
        second.preload(["p/package.xml", "p/mesh.stl", "nowhere"])
        assert second.extracted == 0 and second.ids == first.ids and second.kinds == first.kinds
        assert second.get_facts("p/package.xml") == first.get_facts("p/package.xml")


def test_only_what_changed_is_parsed(tmp_path):
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        extract_all(WorkingTree(tmp_path / "ws"), store)
    write(tmp_path / "ws", {"p/src/node.cpp": "#include <new.h>\n", "p/src/more.cpp": "#include <more.h>\n"})
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        assert extraction.extracted == 2
        assert extraction.get_facts("p/src/node.cpp").facts.includes[0].path == "new.h"
        assert extraction.get_facts("p/src/same.cpp").facts.includes[0].path == "rclcpp/rclcpp.hpp"


def test_a_commit_and_a_directory_share_their_facts(tmp_path):
    repo = pygit2.init_repository(str(write(tmp_path / "ws", FILES)))
    repo.index.add_all()
    who = pygit2.Signature("t", "t@example.org", 1_600_000_000, 0)
    repo.create_commit("HEAD", who, who, "all", repo.index.write_tree(), [])
    with Store(tmp_path / "cache") as store:
        assert extract_all(WorkingTree(tmp_path / "ws"), store).extracted == 4
        extraction = extract_all(GitTree(tmp_path / "ws"), store)
        assert extraction.extracted == 0
        assert extraction.get_facts("p/package.xml").facts.name == "p"


def test_a_new_version_of_an_extractor_parses_its_files_again(tmp_path, monkeypatch):
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        extract_all(WorkingTree(tmp_path / "ws"), store)
    version_of = kinds.make_version
    monkeypatch.setattr(kinds, "make_version", lambda kind: version_of(kind) + (".next" if kind == "cpp" else ""))
    gather_module._find_version.cache_clear()
    try:
        with Store(tmp_path / "cache") as store:
            assert extract_all(WorkingTree(tmp_path / "ws"), store).extracted == 1
    finally:
        gather_module._find_version.cache_clear()


@pytest.mark.parametrize("forks", [True, False])
def test_processes_find_what_one_process_finds(tmp_path, monkeypatch, small_chunks, forks):
    write(tmp_path / "ws", sources(30) | FILES)
    monkeypatch.setattr(processes, "may_fork", lambda: forks)
    with Store(tmp_path / "one") as one, Store(tmp_path / "two") as two:
        alone = extract_all(WorkingTree(tmp_path / "ws"), one, jobs=1)
        together = extract_all(WorkingTree(tmp_path / "ws"), two, jobs=2)
        assert together.kinds == alone.kinds and together.ids == alone.ids
        assert together.extracted == alone.extracted == 34
        for path in alone.kinds:
            assert together.get_facts(path) == alone.get_facts(path)


def test_a_scheduler_chosen_through_joblib_is_used(tmp_path, small_chunks, monkeypatch):
    import joblib

    write(tmp_path / "ws", sources(30))
    monkeypatch.setattr(gather_module, "_extract_in_workers", None)
    with Store(tmp_path / "cache") as store, joblib.parallel_config(backend="threading", n_jobs=2):
        assert extract_all(WorkingTree(tmp_path / "ws"), store, jobs=2).extracted == 30


@pytest.mark.parametrize("jobs", [1, 2])
def test_progress_rises_to_the_end(tmp_path, small_chunks, jobs):
    seen = []
    files = sources(20)
    files["src/broken.cpp"] = "version https://git-lfs.github.com/spec/v1\noid sha256:0\n"
    write(tmp_path / "ws", files)
    with Store(tmp_path / "cache") as store:
        extract_all(
            WorkingTree(tmp_path / "ws"), store, jobs=jobs, progress=lambda done, total: seen.append((done, total))
        )
    total = sum(len(text) for text in files.values())
    assert seen == sorted(seen) and len(seen) > 3
    assert seen[-1] == (total, total)


def test_a_large_file_is_not_read(tmp_path, monkeypatch):
    write(tmp_path / "ws", FILES)
    with open(tmp_path / "ws/p/src/generated.hpp", "wb") as file:
        file.truncate(50_000_000)
    tree = WorkingTree(tmp_path / "ws")
    read = tree.read_with_id
    monkeypatch.setattr(
        tree, "read_with_id", lambda path, limit: pytest.fail(path) if "generated" in path else read(path, limit)
    )
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(tree, store)
    assert "p/src/generated.hpp" not in extraction.kinds
    assert [problem.path for problem in extraction.problems] == ["p/src/generated.hpp"]
    assert "larger than 8 MB" in extraction.problems[0].message
    assert len(extraction.kinds) == 5


def test_a_git_lfs_pointer_is_no_source(tmp_path):
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"
    write(tmp_path / "ws", {**FILES, "p/src/data.cpp": pointer})
    for _ in ("cold", "warm"):
        with Store(tmp_path / "cache") as store:
            extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        assert "p/src/data.cpp" not in extraction.kinds and "p/src/data.cpp" not in extraction.ids
        assert [problem.path for problem in extraction.problems] == ["p/src/data.cpp"]
        assert "git lfs pull" in extraction.problems[0].message


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (PermissionError(13, "Permission denied"), "cannot be read: permission denied"),
        (FileNotFoundError(2, "No such file or directory"), "cannot be read: no such file or directory"),
        (OSError(5, "Input/output error"), "cannot be read: input/output error"),
    ],
)
def test_a_file_that_cannot_be_read(tmp_path, monkeypatch, error, message):
    tree = WorkingTree(write(tmp_path / "ws", FILES))
    read = tree.read_with_id

    def refuse(path, limit):
        if path == "p/src/node.cpp":
            raise error
        return read(path, limit)

    monkeypatch.setattr(tree, "read_with_id", refuse)
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(tree, store)
        assert extraction.problems == [PathProblem("p/src/node.cpp", message)]
        assert extraction.get_facts("p/src/same.cpp").facts.includes[0].path == "rclcpp/rclcpp.hpp"
        assert "p/src/node.cpp" not in extraction.kinds


def failing(how):
    extract = kinds.extract

    def fail(kind, data):
        if b"POISON" in data:
            how()
        return extract(kind, data)

    return fail


def raises():
    raise ValueError("odd input")


def dies():
    os.kill(os.getpid(), signal.SIGKILL)


def segfaults():
    os.kill(os.getpid(), signal.SIGSEGV)


def runs_away():
    while True:
        pass


def needs_all_memory():
    return bytearray(1 << 40)


@pytest.mark.parametrize(
    ("how", "jobs", "message"),
    [
        (raises, 1, "odd input"),
        (raises, 2, "odd input"),
        (dies, 1, "crashed on this file"),
        (dies, 2, "crashed on this file"),
        (segfaults, 1, "crashed on this file"),
        (segfaults, 2, "crashed on this file"),
        (runs_away, 2, "needed too much time on this file"),
        (needs_all_memory, 1, "needed more than 768 MB of memory on this file"),
        (needs_all_memory, 2, "needed more than 768 MB of memory on this file"),
    ],
)
@pytest.mark.usefixtures("short_time")
def test_a_file_that_its_extractor_fails_on(tmp_path, monkeypatch, small_chunks, how, jobs, message):
    files = sources(25)
    files["src/f5.cpp"] = files["src/copy.cpp"] = "// POISON 1"
    files["src/f9.cpp"] = "// POISON 2"
    write(tmp_path / "ws", files)
    monkeypatch.setattr(kinds, "extract", failing(how))
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store, jobs=jobs)
        poisoned = ["src/copy.cpp", "src/f5.cpp", "src/f9.cpp"]
        assert [problem.path for problem in extraction.problems] == poisoned
        assert all(message in problem.message for problem in extraction.problems)
        assert sorted(extraction.kinds) == sorted(files.keys() - set(poisoned)) == sorted(extraction.ids)
        assert extraction.extracted == 23
        assert extraction.get_facts("src/f6.cpp").facts.includes[0].path == "a6.h"


def second_look(path):
    return kinds.FLOW.get(kinds.find_kind(path) or "")


@pytest.mark.parametrize("jobs", [1, 2])
def test_two_looks_at_a_file_take_one_visit(tmp_path, monkeypatch, small_chunks, jobs):
    write(tmp_path / "ws", {**FILES, **sources(10)})
    tree = WorkingTree(tmp_path / "ws")
    read = []
    read_with_id = tree.read_with_id
    monkeypatch.setattr(tree, "read_with_id", lambda path, limit: read.append(path) or read_with_id(path, limit))
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(tree, store, jobs=jobs, second=second_look)
        second = extraction.second
        assert len(read) == len(set(read)) == 15
        assert extraction.extracted == 4 + 10 + 1 + 10
        assert extraction.kinds["p/src/node.cpp"] == "cpp" and second.kinds["p/src/node.cpp"] == "flow_cpp"
        assert "p/package.xml" in extraction.kinds and "p/package.xml" not in second.kinds
        assert extraction.get_facts("src/f1.cpp").facts.includes[0].path == "a1.h"
        assert second.get_facts("src/f1.cpp").facts.functions[0].name == "f1"
        assert second.get_facts("p/src/node.cpp") is second.get_facts("p/src/same.cpp")


def test_only_the_look_that_is_new_is_taken(tmp_path):
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        extract_all(WorkingTree(tmp_path / "ws"), store)
        first = extract_all(WorkingTree(tmp_path / "ws"), store, second=second_look)
        again = extract_all(WorkingTree(tmp_path / "ws"), store, second=second_look)
        assert (first.extracted, again.extracted) == (1, 0)
        assert first.second.kinds == again.second.kinds and first.second.ids == again.second.ids


def test_a_second_look_alone(tmp_path):
    with Store(tmp_path / "cache") as store:
        tree = WorkingTree(write(tmp_path / "ws", FILES))
        extraction = extract_all(tree, store, kind_of=lambda path: None, second=second_look)
        assert not extraction.kinds and sorted(extraction.second.kinds) == ["p/src/node.cpp", "p/src/same.cpp"]


@pytest.mark.parametrize(
    ("how", "jobs", "message"),
    [(raises, 1, "odd input"), (raises, 2, "odd input"), (dies, 2, "crashed on this file")],
)
def test_a_look_that_fails_leaves_the_other(tmp_path, monkeypatch, small_chunks, how, jobs, message):
    files = sources(25)
    files["src/f5.cpp"] = "int f5();  // POISON"
    fail = failing(how)
    extract = kinds.extract
    write(tmp_path / "ws", files)
    monkeypatch.setattr(kinds, "extract", lambda kind, data: (fail if kind == "flow_cpp" else extract)(kind, data))
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store, jobs=jobs, second=second_look)
        assert extraction.problems == [] and sorted(extraction.kinds) == sorted(files)
        assert [problem.path for problem in extraction.second.problems] == ["src/f5.cpp"]
        assert message in extraction.second.problems[0].message
        assert sorted(extraction.second.kinds) == sorted(files.keys() - {"src/f5.cpp"})


def test_what_cannot_be_read_is_named_once(tmp_path):
    write(tmp_path / "ws", {"a.cpp": "version https://git-lfs.github.com/spec/v1\n"})
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store, second=second_look)
        assert [problem.path for problem in extraction.problems] == ["a.cpp"]
        assert not extraction.second.problems and not extraction.kinds and not extraction.second.kinds


def test_facts_that_the_store_lost_are_made_again(tmp_path):
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        store.close()
        for file in (tmp_path / "cache").iterdir():
            file.unlink()
        assert extraction.get_facts("p/package.xml").facts.name == "p"


def test_stored_facts_of_another_shape_are_made_again(tmp_path):
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        row = gather_module._make_key(extraction.ids["p/package.xml"], "manifest")
        for data in (b"-\x93\x01\x02\x03", b"z rubbish", b""):
            store.put([(row, data)])
            extraction.forget(["p/package.xml"])
            assert extraction.get_facts("p/package.xml").facts.name == "p"


def test_without_a_cache_folder(tmp_path, small_chunks):
    write(tmp_path / "ws", sources(20))
    write(tmp_path, {"file": ""})
    with Store(tmp_path / "file/cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store, jobs=2)
        assert extraction.get_facts("src/f3.cpp").facts.includes[0].path == "a3.h"
        assert len(store.notes) == 1


@pytest.mark.parametrize("jobs", [1, 2])
def test_interrupted_and_resumed(tmp_path, small_chunks, jobs):
    write(tmp_path / "ws", sources(60))

    def interrupt(done, total):
        if done > total / 2:
            raise KeyboardInterrupt

    with Store(tmp_path / "cache") as store, pytest.raises(KeyboardInterrupt):
        extract_all(WorkingTree(tmp_path / "ws"), store, jobs=jobs, progress=interrupt)
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store, jobs=jobs)
        assert 10 <= extraction.extracted <= 40, "what was parsed stays parsed"
        assert len(extraction.kinds) == 60


SLOW_RUN = """
import sys, time
from rosimpact.impact.facts import extract as module
from rosimpact.impact.facts import kinds
from rosimpact.impact.facts.store import Store
from rosimpact.impact.tree import WorkingTree
module.ALONE_BYTES, module._CHUNK_BYTES = 0, 3000
extract = kinds.extract
def slowly(kind, data):
    time.sleep(0.02)
    return extract(kind, data)
kinds.extract = slowly
with Store(sys.argv[2]) as store:
    module.extract_all(WorkingTree(sys.argv[1]), store, jobs=2, progress=lambda done, total: print(done, flush=True))
print("finished", flush=True)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_killed_and_resumed(tmp_path, how):
    write(tmp_path / "ws", sources(100))
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW_RUN, str(tmp_path / "ws"), str(tmp_path / "cache")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    for _ in range(5):
        assert process.stdout.readline().strip().isdigit()
    if how == signal.SIGINT:
        os.killpg(process.pid, how)  # as a terminal does: the workers get it too
    else:
        process.send_signal(how)
    output, errors = process.communicate(timeout=30)
    assert "finished" not in output
    assert errors.count("Traceback") <= (1 if how == signal.SIGINT else 0), errors
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        assert 0 < extraction.extracted < 100, "what was parsed stays parsed"
        assert extraction.get_facts("src/f99.cpp").facts.includes[0].path == "a99.h"
        assert store.notes == []


def test_runs_at_once(tmp_path):
    write(tmp_path / "ws", sources(40))
    command = [sys.executable, "-c", SLOW_RUN, str(tmp_path / "ws"), str(tmp_path / "cache")]
    processes = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    for process in processes:
        output, _ = process.communicate(timeout=60)
        assert output.endswith("finished\n")
    with Store(tmp_path / "cache") as store:
        assert extract_all(WorkingTree(tmp_path / "ws"), store).extracted == 0


def test_a_file_edited_while_it_is_read(tmp_path, monkeypatch):
    """The id under which facts are stored is that of the bytes they were made from."""
    write(tmp_path / "ws", FILES)
    with Store(tmp_path / "cache") as store:
        extract_all(WorkingTree(tmp_path / "ws"), store)
    (tmp_path / "ws/p/src/same.cpp").write_text("#include <first.h>\n")
    tree = WorkingTree(tmp_path / "ws")
    tree.list_entries()
    (tmp_path / "ws/p/src/same.cpp").write_text("#include <second.h>\n")
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(tree, store)
        assert extraction.get_facts("p/src/same.cpp").facts.includes[0].path == "second.h"
        assert extraction.ids["p/src/same.cpp"] == tree_module.compute_blob_id(b"#include <second.h>\n")


def test_an_empty_tree(tmp_path):
    with Store(tmp_path / "cache") as store:
        (tmp_path / "ws").mkdir()
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        assert (extraction.kinds, extraction.ids, extraction.problems, extraction.extracted) == ({}, {}, [], 0)


@pytest.mark.skipif(not processes.may_fork(), reason="processes are forked on Linux only")
def test_memory_that_another_file_took_is_not_held_against_a_file(tmp_path, monkeypatch):
    extract, taken = kinds.extract, []

    def fill(kind, data):
        if taken:
            raise MemoryError
        if b"POISON" in data:
            taken.append(data)
        return extract(kind, data)

    monkeypatch.setattr(kinds, "extract", fill)
    files = {"src/a.cpp": "// POISON " + "x" * 1000, "src/b.cpp": "// innocent"}
    write(tmp_path / "ws", files)
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store, jobs=1)
    assert extraction.problems == []
    assert sorted(extraction.kinds) == sorted(files)


def test_other_facts_are_made_once_and_when_asked_for(tmp_path, monkeypatch):
    write(tmp_path / "ws", {"a.launch": LAUNCH, "b.launch": LAUNCH, "c.launch": "<launch/>"})
    taken = []
    extract = kinds.extract
    monkeypatch.setattr(kinds, "extract", lambda kind, data: taken.append(kind) or extract(kind, data))
    for _ in range(2):
        with Store(tmp_path / "cache") as store:
            extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
            found = extraction.look(["a.launch", "b.launch", "nothing.launch"], "flow_launch_xml")
            assert sorted(found) == ["a.launch", "b.launch"]
            assert [action.kind for action in found["b.launch"].actions] == ["node"]
            assert extraction.look(["a.launch"], "flow_launch_xml")["a.launch"] is found["a.launch"]
    assert [kind for kind in taken if kind.startswith("flow_")] == ["flow_launch_xml"]


def test_searches_are_kept_by_what_they_look_for(tmp_path, monkeypatch):
    write(tmp_path / "ws", {"a.cpp": "int changed; int other;\n"})
    taken = []
    search = kinds.search
    monkeypatch.setattr(kinds, "search", lambda *given: taken.append(given[3]) or search(*given))
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        for words in (["changed"], ["other"], ["changed"]):
            (found,) = extraction.look(["a.cpp"], "searched_cpp", UsageTable({}, words)).values()
            assert [word.text for word in found.words] == words
    assert [table.words for table in taken] == [{"changed"}, {"other"}]


def test_what_can_no_longer_be_read_is_left_out(tmp_path):
    write(tmp_path / "ws", {"a.launch": LAUNCH, "b.launch": "<launch/>"})
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        (tmp_path / "ws/a.launch").unlink()
        assert list(extraction.look(["a.launch", "b.launch"], "flow_launch_xml")) == ["b.launch"]


def test_what_was_written_to_meanwhile_is_not_kept_under_its_old_content(tmp_path):
    write(tmp_path / "ws", {"a.launch": LAUNCH})
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        (tmp_path / "ws/a.launch").write_text("<launch/>")
        assert extraction.look(["a.launch"], "flow_launch_xml")["a.launch"].actions == ()
    write(tmp_path / "ws", {"a.launch": LAUNCH})
    with Store(tmp_path / "cache") as store:
        extraction = extract_all(WorkingTree(tmp_path / "ws"), store)
        assert len(extraction.look(["a.launch"], "flow_launch_xml")["a.launch"].actions) == 1
