"""libFuzzer and KLEE on the same harness that is replayed."""

import subprocess

import pytest
from harness_workspaces import Prepared, needs_clang, needs_fuzzer, write_workspace
from rosimpact.impact.values.harness.fuzzing import run_fuzzer
from rosimpact.impact.values.harness.replay import is_confirmed
from rosimpact.impact.values.harness.toolchain import find_clang
from rosimpact.impact.values.outcomes import CodeLine, CrashKind, Reaction

NODE = """
#include <ros/ros.h>
#include <std_msgs/Int16.h>
ros::Publisher pub;
int calls = 0;
void on_period(const std_msgs::Int16::ConstPtr &msg) {
  ++calls;
  if (msg->data < 0) return;
  std_msgs::Int16 out;
  out.data = 1000 / (msg->data & 7);  // DIVISION
  pub.publish(out);
}
int main(int argc, char **argv) {
  ros::init(argc, argv, "node");
  ros::NodeHandle nh;
  pub = nh.advertise<std_msgs::Int16>("out", 1);
  ros::Subscriber sub = nh.subscribe("period", 1, on_period);
  while (ros::ok()) ros::spinOnce();
}
"""
PATH = "machine/src/node.cpp"


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    root = write_workspace(tmp_path_factory.mktemp("ws"), 1, {"src/node.cpp": NODE}, "src/node.cpp")
    return Prepared(root, tmp_path_factory.mktemp("built"), ("subscriber",))


@needs_fuzzer
def test_fuzzer_finds_a_crash_that_a_replay_confirms(prepared):
    found = run_fuzzer(prepared.by_name["on_period"], 4)
    line = CodeLine(PATH, prepared.find_line(PATH, "DIVISION"))
    assert [(one.witness.result, one.witness.crash, one.witness.place) for one in found] == [
        (Reaction.CRASH, CrashKind.DIVISION, line)
    ]
    assert is_confirmed(found[0].witness, found[0].replayed)
    assert found[0].witness.values["msg.data"] & 7 == 0


KLEE_HEADER = """
#pragma once
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
void klee_make_symbolic(void *address, size_t size, const char *name);
void klee_assume(uintptr_t condition);
void klee_warning_once(const char *message);
__attribute__((noreturn)) void klee_silent_exit(int status);
__attribute__((noreturn)) void klee_report_error(const char *file, int line, const char *message, const char *suffix);
#ifdef __cplusplus
}
#endif
"""


@needs_clang
def test_klee_is_given_bitcode(prepared, tmp_path):
    """KLEE's own header and tools are stood for: what is run is the script as it is written."""
    written = prepared.by_name["on_period"].emit_klee(tmp_path / "written")
    include = tmp_path / "include" / "klee"
    include.mkdir(parents=True)
    (include / "klee.h").write_text(KLEE_HEADER)
    calls = tmp_path / "calls"
    for name in ("link", "klee"):
        (tmp_path / name).write_text(f'#!/bin/sh\necho {name} "$@" >> {calls}\n')
        (tmp_path / name).chmod(0o755)
    environment = {
        "PATH": "/usr/bin:/bin", "CLANG": find_clang(), "LLVM_LINK": str(tmp_path / "link"),
        "KLEE": str(tmp_path / "klee"), "KLEE_INCLUDE": str(tmp_path / "include"),
    }  # fmt: skip
    done = subprocess.run(["sh", str(written.script)], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (written.folder / "harness.bc").stat().st_size > 1000
    assert (written.folder / "klee_runtime.bc").stat().st_size > 1000
    assert calls.read_text().splitlines()[0] == "link harness.bc klee_runtime.bc -o whole.bc"
    assert "--libc=klee" in calls.read_text()


@needs_clang
def test_klee_is_told_sizes_one_by_one_and_reports_reactions(prepared, tmp_path):
    written = prepared.by_name["on_period"].emit_klee(tmp_path / "written")
    assert "--ubsan-runtime" in written.script.read_text()
    runtime = (written.folder / "klee_runtime.cpp").read_text()
    assert [word for word in ("handled.err", "log.err", "ignored.err") if f'"{word}"' not in runtime] == []
