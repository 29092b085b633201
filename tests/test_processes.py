"""Several processes find what one finds, whatever becomes of them."""

import os
import signal
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from rosimpact.edges import processes
from rosimpact.edges.limits import get_limits
from rosimpact.impact.analysis import run_rules as judge
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.model import workspace
from rosimpact.impact.rules.rule import load_rules
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.providers.providers import load_providers

needs_fork = pytest.mark.skipif(not processes.may_fork(), reason="processes are forked on Linux only")

MANIFEST = """<package format="3"><name>{name}</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
{depends}<export><build_type>ament_cmake</build_type></export></package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
find_package({other} REQUIRED)
find_package(not_to_be_found_{name} REQUIRED)
add_library({name} src/a.cpp)
target_include_directories({name} PUBLIC include)
ament_package()
"""


def ring(folder, count):
    """A workspace whose packages depend on each other in a ring, each with a header, and each with faults."""
    for place in range(count):
        name, other = f"link_{place}", f"link_{(place + 1) % count}"
        package = folder / name
        (package / "src").mkdir(parents=True)
        (package / f"include/{name}").mkdir(parents=True)
        depends = f"<depend>{other}</depend><depend>no_such_key_{place}</depend>"
        (package / "package.xml").write_text(MANIFEST.format(name=name, depends=depends))
        (package / "CMakeLists.txt").write_text(CMAKE.format(name=name, other=other))
        (package / f"include/{name}/{name}.hpp").write_text(
            f"#include <{other}/{other}.hpp>\n#include <tf2/LinearMath/Vector3.h>\n"
        )
        (package / "src/a.cpp").write_text(
            f"#include <{name}/{name}.hpp>\n#include <unheard_of_{place}.h>\nuint32_t a;\n"
        )
    return folder


def told(report):
    return [f._replace(fingerprint="") for f in report.findings], report.coverage, report.failure


@pytest.fixture
def at_once(monkeypatch):
    """However small a workspace is, processes are started."""
    monkeypatch.setattr(workspace, "_ALONE_FILES", 0)
    monkeypatch.setattr(judge, "_ALONE", 0)


@needs_fork
def test_a_file_name_that_is_no_utf8_comes_back_from_a_process(tmp_path, at_once):
    ws = ring(tmp_path / "ws", 3)
    before = check(ws, Options(("jazzy",), jobs=3, cache=tmp_path / "cache"))
    Path(os.fsdecode(os.fsencode(ws / "link_0/src") + b"/caf\xe9.txt")).write_text("")
    after = check(ws, Options(("jazzy",), jobs=3, cache=tmp_path / "cache"))
    assert before.findings and after.failure == ""
    # What was not read may have the packages that nobody is known to have.
    kept = [f for f in before.findings if not f.subject.startswith("not_to_be_found")]
    assert [f for f in after.findings if f.rule != "unreadable-file"] == kept


@needs_fork
def test_processes_report_what_one_reports(tmp_path, at_once):
    ws = ring(tmp_path / "ws", 9)
    targets = ("humble", "jazzy")
    alone = check(ws, Options(targets, jobs=1, cache=tmp_path / "one"))
    together = check(ws, Options(targets, jobs=3, cache=tmp_path / "three"))
    again = check(ws, Options(targets, jobs=3, cache=tmp_path / "three"))
    rules = {finding.rule for finding in alone.findings}
    assert {"dependency-cycle", "undeclared-package", "unknown-dependency"} <= rules
    assert sum(finding.rule == "dependency-cycle" for finding in alone.findings) == 1
    assert alone.coverage.unresolved["include"] >= 9
    assert told(alone) == told(together) == told(again)


@needs_fork
def test_a_rule_that_fails_on_one_package_is_named_once(tmp_path, at_once, monkeypatch):
    ws = ring(tmp_path / "ws", 9)
    rule = load_rules()["unresolvable-key"]

    def run(view):
        for package in view:
            if package.name == "link_4":
                raise RuntimeError("no such luck")
            yield from ()

    rules = {**load_rules(), "unresolvable-key": rule._replace(run=run)}
    monkeypatch.setattr("rosimpact.impact.rules.rule.load_rules", lambda: rules)
    report = check(ws, Options(("humble", "jazzy"), jobs=2, cache=tmp_path / "cache"))
    assert report.failure.count("the rule unresolvable-key failed on humble, jazzy: RuntimeError") == 1
    assert any(finding.rule == "undeclared-package" for finding in report.findings)


def _doubled(factor, number):
    return factor * number


def _dies(parent, number):
    if number == 3 and os.getpid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def _raises(number):
    raise KeyError(number)


@needs_fork
def test_every_result_comes_with_its_task():
    assert dict(processes.run_forked(_doubled, range(20), 3, 2)) == {n: 2 * n for n in range(20)}


@needs_fork
def test_a_task_that_ends_its_process_comes_without_result():
    found = dict(processes.run_forked(_dies, range(8), 2, os.getpid()))
    assert found.pop(3) == processes.Died("crashed")
    assert found == {number: number for number in range(8) if number != 3}


def _dies_the_first_time(folder, number):
    mark = folder / str(number)
    if not mark.exists() and number > 4:
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number


@needs_fork
def test_a_task_is_tried_again_in_a_new_process(tmp_path):
    found = dict(processes.run_forked(_dies_the_first_time, range(6), 1, tmp_path))
    assert found == {number: number for number in range(6)}


_LEFT = []


def _leaves_memory(size):
    processes.reset_memory()
    _LEFT.append(size)
    return os.getpid()


@needs_fork
def test_a_process_that_has_grown_too_much_hands_tasks_to_another(monkeypatch):
    limits = replace(get_limits(), memory=50)
    monkeypatch.setattr(processes, "get_limits", lambda: limits)
    monkeypatch.setattr(processes, "_measure_memory", lambda: 1_000 + sum(_LEFT))
    allowed = []
    monkeypatch.setattr(processes, "_allow_further", allowed.append)
    run_by = dict(processes.run_forked(_leaves_memory, range(30, 36), 1))
    # Two tasks leave more than one may need.
    assert all(isinstance(one, int) for one in run_by.values())
    assert 3 <= len({*run_by.values()}) < 6
    assert max(Counter(run_by.values()).values()) == 2


def _cannot_be_copied(number):
    raise _Odd(number, 2)


class _Odd(Exception):
    def __init__(self, one, two):
        super().__init__(f"{one} {two}")


@needs_fork
def test_an_error_that_cannot_be_copied_is_told_in_words():
    with pytest.raises(RuntimeError, match="_Odd: 0 2"):
        dict(processes.run_forked(_cannot_be_copied, [0], 1))


@needs_fork
def test_a_message_may_be_larger_than_a_pipe():
    things = [bytes([n]) * 3_000_000 for n in range(4)]
    assert dict(processes.run_forked(_doubled, things, 2, 2)) == {thing: 2 * thing for thing in things}


def children():
    return Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()


@needs_fork
@pytest.mark.parametrize("size", [1, 1_000_000])
def test_processes_that_end_before_they_take_a_thing_are_no_endless_row(monkeypatch, size):
    monkeypatch.setattr(processes, "_limit_memory", lambda: os._exit(1))
    assert [result for _, result in processes.run_forked(len, [b"x" * size], 1)] == [processes.Died("crashed")]


@needs_fork
def test_no_process_and_no_descriptor_is_left():
    before, born_before = sorted(os.listdir("/proc/self/fd")), children()
    for _ in processes.run_forked(_doubled, range(20), 3, 2):
        break
    with pytest.raises(KeyError):
        dict(processes.run_forked(_raises, range(3), 2))
    assert sorted(os.listdir("/proc/self/fd")) == before
    assert children() == born_before


@needs_fork
def _slowly(thing):
    time.sleep(0.05)
    return thing


def _tell_steps_left(_):
    return len(processes._MEANWHILE)


@needs_fork
def test_steps_are_taken_while_others_work(tmp_path):
    gate = tmp_path / "gate"
    taken = []

    def steps():
        for number in range(3):
            taken.append(number)
            yield
        gate.touch()
        yield

    def wait_for_gate(_):
        while not gate.exists():
            time.sleep(0.001)
        return "done"

    with processes.run_meanwhile(steps()):
        assert dict(processes.run_forked(wait_for_gate, [1, 2], 2)) == {1: "done", 2: "done"}
    assert taken == [0, 1, 2] and not processes._MEANWHILE


@needs_fork
def test_steps_are_not_taken_by_the_others():
    with processes.run_meanwhile(iter(range(5))):
        assert dict(processes.run_forked(_tell_steps_left, [1], 1)) == {1: 0}


@needs_fork
def test_a_step_that_fails_ends_the_steps_and_nothing_else():
    taken = []

    def steps():
        taken.append("failing")
        raise ValueError("no step")
        yield

    with processes.run_meanwhile(iter([])), processes.run_meanwhile(steps()):
        assert dict(processes.run_forked(_slowly, [1, 2], 1)) == {1: 1, 2: 2}
    assert taken == ["failing"]


@needs_fork
def test_an_interrupt_in_a_step_leaves_no_process():
    def steps():
        raise KeyboardInterrupt
        yield

    born_before = children()
    with pytest.raises(KeyboardInterrupt), processes.run_meanwhile(steps()):
        list(processes.run_forked(_endless, [1, 2], 2))
    assert children() == born_before and not processes._MEANWHILE


def test_what_a_task_raises_is_raised_here():
    with pytest.raises(KeyError):
        dict(processes.run_forked(_raises, range(3), 2))


@needs_fork
def test_a_process_that_dies_once_loses_nothing(tmp_path, at_once, monkeypatch):
    ws = ring(tmp_path / "ws", 9)
    alone = check(ws, Options(("jazzy",), jobs=1, cache=tmp_path / "one"))
    died = tmp_path / "died"

    def dying(run):
        def task(*arguments):
            if not died.exists() and arguments[-1] != "link_0":
                died.touch()
                os.kill(os.getpid(), signal.SIGKILL)
            return run(*arguments)

        return task

    # The processes are forked, so they know what these names stand for in this one's memory.
    join = workspace._join
    monkeypatch.setattr(workspace, "_join", dying(join))
    together = check(ws, Options(("jazzy",), jobs=1, cache=tmp_path / "two"))
    assert died.exists() and told(alone) == told(together)
    died.unlink()
    monkeypatch.setattr(workspace, "_join", join)
    monkeypatch.setattr(judge, "_run_part", dying(judge._run_part))
    together = check(ws, Options(("jazzy",), jobs=2, cache=tmp_path / "three"))
    assert died.exists() and told(alone) == told(together)


def _dying_on(function, thing):
    def task(*arguments):
        if thing(*arguments):
            os.kill(os.getpid(), signal.SIGSEGV)
        return function(*arguments)

    return task


@needs_fork
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_package_that_ends_its_process_is_named_and_loses_no_other(tmp_path, monkeypatch, jobs):
    ws = ring(tmp_path / "ws", 9)
    whole = check(ws, Options(("jazzy",), jobs=1, cache=tmp_path / "one"))
    monkeypatch.setattr(workspace, "_join", _dying_on(workspace._join, lambda *arguments: arguments[-1] == "link_4"))
    report = check(ws, Options(("jazzy",), jobs=jobs, cache=tmp_path / "two"))
    assert [f.message for f in report.findings if f.rule == "unreadable-file"] == [
        "the package could not be analysed: its analysis crashed"
    ]
    assert not report.failure

    def of_others(report):
        # What its neighbours say of it depends on it.
        return [
            f for f in report.findings if f.package not in ("link_3", "link_4", "link_5") and "link_4" not in f.message
        ]

    assert of_others(report) == of_others(whole)


def names_of(opened, task):
    """The packages that a task is about."""
    return [name for group, start, end in task.slices for name in opened.workspace.groups[group][start:end]]


@needs_fork
def test_rules_that_end_their_process_on_a_package_are_named_and_lose_no_other(tmp_path, at_once, monkeypatch):
    ws = ring(tmp_path / "ws", 9)
    whole = check(ws, Options(("jazzy",), jobs=1, cache=tmp_path / "one"))

    def of_link_4(opened, rules, task, failed):
        return "link_4" in names_of(opened, task)

    monkeypatch.setattr(judge, "_run_part", _dying_on(judge._run_part, of_link_4))
    report = check(ws, Options(("jazzy",), jobs=2, cache=tmp_path / "two"))
    assert "the check of `link_4` crashed" in report.failure
    found = [f for f in report.findings if f.package != "link_4" and "link_4" not in f.message]
    assert found == [f for f in whole.findings if f.package != "link_4" and "link_4" not in f.message]


def _endless(*_):
    while True:
        pass


@needs_fork
def test_a_rule_that_comes_to_no_end_costs_its_package_alone(tmp_path, monkeypatch):
    """In a workspace that is too small for several processes."""
    ws = ring(tmp_path / "ws", 3)
    whole = check(ws, Options(("jazzy",), cache=tmp_path / "one"))
    part = judge._run_part

    def of_link_1(opened, rules, task, failed):
        return part(opened, endless if "link_1" in names_of(opened, task) else rules, task, failed)

    endless = [rule._replace(run=_endless) for rule in load_rules().values()]
    monkeypatch.setattr(judge, "_run_part", of_link_1)
    monkeypatch.setattr(judge, "_estimate_bytes", lambda workspace, packages: -900_000)
    monkeypatch.setattr(judge, "_PACKAGE_BYTES", 0)
    report = check(ws, Options(("jazzy",), cache=tmp_path / "two"))
    assert "the check of `link_1` needed too much time" in report.failure
    found = [f for f in report.findings if f.package != "link_1" and "link_1" not in f.message]
    assert found
    assert found == [f for f in whole.findings if f.package != "link_1" and "link_1" not in f.message]


@needs_fork
def test_a_message_flow_that_comes_to_no_end_costs_its_rules_alone(tmp_path, monkeypatch):
    ws = ring(tmp_path / "ws", 3)
    whole = check(ws, Options(("jazzy",), cache=tmp_path / "one"))
    monkeypatch.setattr(judge, "_run_flow_part", lambda *arguments: os.kill(os.getpid(), signal.SIGSEGV))
    report = check(ws, Options(("jazzy",), preview=True, cache=tmp_path / "two"))
    assert report.failure.endswith("failed: the check of the message flow crashed")
    names = {f.rule for f in whole.findings}
    assert [f for f in report.findings if f.rule in names] == list(whole.findings)


def _answers(target, providers, header):
    return (
        [p.name for p in providers.find_header(header)],
        target.find_version("rclcpp"),
        target.resolve("eigen") is not None,
    )


@needs_fork
def test_the_shipped_data_is_read_by_many_processes_at_once():
    headers = [f"{name}/{name}.hpp" for name in ("rclcpp", "tf2", "pluginlib", "nav2_util", "angles", "cv_bridge")] * 20
    target, providers = DistroTarget("jazzy"), load_providers()
    expected = {header: _answers(target, providers, header) for header in sorted(set(headers))}
    fresh = type(providers)()
    fresh.find_header("ros/ros.h")  # opened here before the others are forked
    for header, answer in processes.run_forked(_answers, headers, 4, DistroTarget("jazzy"), fresh):
        assert answer == expected[header]


@needs_fork
def test_no_number_of_jobs_brings_the_machine_down():
    with processes.Workers(_doubled, 100_000, 2) as workers:
        given = 0
        while workers.free and given < 1000:
            workers.give(given)
            given += 1
    assert given == max(64, 4 * processes.count_cores())
