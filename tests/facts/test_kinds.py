"""File names to kinds, and facts to bytes and back."""

import msgspec
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from rosimpact.databuild.extract import cpp, parameters, python
from rosimpact.edges.limits import Limits, format_size
from rosimpact.impact.facts import kinds
from rosimpact.impact.facts.kinds import (
    EXTRACTORS,
    SEARCHES,
    FileFacts,
    decode,
    encode,
    extract,
    find_kind,
    find_size_limit,
    make_version,
)

NAMES = [
    ("package.xml", "manifest"),
    ("src/a/package.xml", "manifest"),
    ("src/a/package_ROS2.xml", "manifest_variant"),
    ("src/a/package.ros1.xml", "manifest_variant"),
    ("src/a/package.xml.ros2", "manifest_variant"),
    ("src/a/manifest.xml", "xml"),
    ("CMakeLists.txt", "cmake"),
    ("cmake/FindX.cmake", "cmake"),
    ("cmake/a-extras.cmake.in", "cmake"),
    ("notes.txt", None),
    ("Dockerfile.ci", "dockerfile"),
    ("wheel_Dockerfile", "dockerfile"),
    ("Dockerfile-dev", "dockerfile"),
    ("make_dockerfile.py", "python"),
    ("msg/Pose.msg", "msg"),
    ("srv/Set.srv", "srv"),
    ("action/Dock.action", "action"),
    ("msg/Pose.idl", "idl"),
    ("a.h", "cpp"),
    ("a.hpp", "cpp"),
    ("a.tpp", "cpp"),
    ("a.cu", "cpp"),
    ("config.h.in", "cpp"),
    ("config.txt.in", None),
    ("Main.CPP", "cpp"),
    ("a.py", "python"),
    ("setup.py", "setup_py"),
    ("setup.cfg", "setup_cfg"),
    ("pyproject.toml", "pyproject"),
    ("cfg/Tune.cfg", "script"),
    ("scripts/run", "script"),
    ("LICENSE", None),
    (".gitignore", "gitignore"),
    ("launch/a.launch", "launch_xml"),
    ("launch/a.launch.xml", "launch_xml"),
    ("launch/a_launch.xml", "launch_xml"),
    ("launch/a.launch.py", "python"),
    ("launch/a.launch.yaml", "launch_yaml"),
    ("test/a.test", "launch_xml"),
    ("config/a.yaml", "params"),
    ("urdf/a.urdf.xacro", "xacro"),
    ("worlds/a.world", "xacro"),
    ("my_plugins.xml", "plugin_xml"),
    ("nodelet_plugins.xml", "plugin_xml"),
    ("nodelets.xml", "plugin_xml"),
    ("trees/a.xml", "xml"),
    ("run.sh", "shell"),
    ("a.rviz", None),
    ("mesh.dae", None),
    ("", None),
    ("folder/", None),
]


@pytest.mark.parametrize(("path", "kind"), NAMES)
def test_name_gives_kind(path, kind):
    assert find_kind(path) == kind


SCRIPTS = [
    (b"#!/usr/bin/env python3\nimport os\n", "python"),
    (b"#!/bin/bash\nrosrun a b\n", "shell"),
    (b"#! /bin/sh -e\n", "shell"),
    (b"gen = ParameterGenerator()\n", "python"),
    (b"#!/usr/bin/perl\n", "script"),
    (b"plain words", "script"),
    (b"", "script"),
]


@pytest.mark.parametrize(("data", "kind"), SCRIPTS)
def test_first_line_tells_scripts_apart(data, kind):
    facts = extract("script", data)
    assert facts.kind == kind
    assert (facts.facts is None) == (kind == "script")
    assert decode("script", encode(facts)) == facts


KINDS = {*EXTRACTORS, cpp.__name__, python.__name__, *map(parameters.make_kind, parameters.LIMITS)}
LIMITS = ("manifest", "cmake", "interface", "cpp", "python", "launch", "parameters", "script", "settings")


@pytest.mark.parametrize(
    ("kind", "limit"),
    [
        ("manifest", "manifest"), ("cmake", "cmake"), ("colcon_cmake", "cmake"), ("msg", "interface"),
        ("cpp", "cpp"), ("flow_cpp", "cpp"), ("called_cpp", "cpp"), ("python", "python"), ("setup_py", "python"),
        ("flow_launch_python", "python"), ("launch_xml", "launch"), ("flow_launch_xml", "launch"),
        ("params", "parameters"), ("script", "script"), ("shell", "script"), ("pyproject", "settings"),
        (cpp.__name__, "cpp"), (python.__name__, "python"),
        *((parameters.make_kind(language), limit) for language, limit in parameters.LIMITS.items()),
    ],
)  # fmt: skip
def test_each_kind_has_its_limit(kind, limit, monkeypatch):
    given = Limits(**{name: number for number, name in enumerate(LIMITS)})
    monkeypatch.setattr(kinds, "get_limits", lambda: given)
    assert LIMITS[find_size_limit(kind)] == limit


@pytest.mark.parametrize("kind", sorted(KINDS - {"script", "flow_script"} - SEARCHES))
def test_what_is_too_large_is_named_and_not_read(kind):
    facts = extract(kind, b"#" * (find_size_limit(kind) + 1))
    assert [p.message for p in facts.facts.problems] == [f"larger than {format_size(find_size_limit(kind))}"]
    assert decode(kind, encode(facts)) == facts


@pytest.mark.parametrize("kind", sorted(KINDS - SEARCHES))
@given(data=st.binary(max_size=300))
@example(data=b"?")  # a YAML mapping whose only key is null
@example(data=b"1: 2\nname: 3\n")
def test_any_bytes_give_facts_that_survive_the_store(kind, data):
    facts = extract(kind, data)
    assert isinstance(facts, FileFacts)
    assert decode(kind, encode(facts)) == facts


@pytest.mark.parametrize("kind", ["manifest", "script"])
@given(data=st.binary(max_size=60))
def test_bytes_that_are_no_facts_are_refused(kind, data):
    try:
        facts = decode(kind, data)
    except msgspec.DecodeError:
        return
    assert encode(facts)


def test_a_failing_extractor_is_contained(monkeypatch):
    from rosimpact.impact.facts import manifest

    def fails(data):
        raise RuntimeError("broken on purpose")

    monkeypatch.setattr(manifest, "extract", fails)
    facts = extract("manifest", b"<package/>").facts
    assert facts.name == ""
    assert [p.message for p in facts.problems] == ["cannot be read: RuntimeError: broken on purpose"]


@pytest.mark.parametrize("error", [MemoryError(), OSError(12, "Cannot allocate memory"), ImportError("failed to map")])
def test_what_is_no_fault_of_the_file_gives_no_facts(monkeypatch, error):
    from rosimpact.impact.facts import manifest

    def fails(data):
        raise error

    monkeypatch.setattr(manifest, "extract", fails)
    with pytest.raises(type(error)):
        extract("manifest", b"<package/>")


def test_a_setup_py_is_a_python_file_too():
    facts = extract("setup_py", b"from distutils.core import setup\nsetup(packages=['a'])\n").facts
    assert facts.packages == ("a",)
    assert [i.module for i in facts.python.imports] == ["distutils.core"]


def test_a_setup_py_of_python_2_is_not_a_mistake():
    facts = extract("setup_py", b"print 'a'\nsetup(packages=['a'])\n").facts
    assert (facts.problems, facts.unresolved, facts.packages) == ((), (), ("a",))
    assert facts.python.python2_only


def test_allow_comments_come_with_the_facts():
    found = extract("msg", b"int32 x  # rosimpact: allow(removed-field)\n").allows
    assert [(a.line, a.rules, a.own_line) for a in found] == [(1, ("removed-field",), False)]


def test_versions_differ_between_kinds():
    assert len({make_version(kind) for kind in EXTRACTORS}) == len(EXTRACTORS)
