"""Which files the message flow reads: code of packages, tests left out, before any package is known."""

from __future__ import annotations

import pytest
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.file_selection import make_code_selector
from rosimpact.impact.model.flow.workspace import link_for_flow, list_code
from rosimpact.impact.tree import WorkingTree

MANIFEST = "<package format='3'><name>{}</name><version>1.0.0</version></package>"
WANTED = {
    "dock/src/crane.cpp": "flow_cpp",
    "dock/include/dock/crane.hpp": "flow_cpp",
    "dock/scripts/lift.py": "flow_python",
    "dock/scripts/lift": "flow_script",
    "dock/launch/dock.launch.xml": None,
    "dock/test/test_crane.cpp": None,
    "dock/src/test_crane.cpp": None,
    "dock/test/fixtures/ship/src/ship.cpp": "flow_cpp",
    "dock/test/fixtures/ship/test/ship.cpp": None,
    "test/quay/src/quay.cpp": "flow_cpp",
    "test/quay/tests/quay.py": None,
    "loose/loose.cpp": None,
}


@pytest.fixture
def tree(tmp_path):
    packages = ("dock", "dock/test/fixtures/ship", "test/quay")
    for path in (*WANTED, *(f"{package}/package.xml" for package in packages)):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(MANIFEST.format(path.split("/")[-2]) if path.endswith("package.xml") else "")
    return WorkingTree(tmp_path)


def test_kinds_by_path(tree):
    wanted = make_code_selector(tree)
    assert {path: wanted(path) for path in WANTED} == WANTED


def test_no_code_of_a_package_is_left_out(tree, tmp_path):
    """What packages own in the end is less than what is read: the fixture within a package's tests is no package."""
    with Store(tmp_path / "cache") as store:
        workspace = link_for_flow(tree, store)
        assert list_code(workspace) == {
            "dock/include/dock/crane.hpp": "dock",
            "dock/scripts/lift": "dock",
            "dock/scripts/lift.py": "dock",
            "dock/src/crane.cpp": "dock",
            "test/quay/src/quay.cpp": "quay",
        }
        assert workspace.extraction.second.kinds.keys() >= list_code(workspace).keys()


def test_the_module_of_a_package_may_be_called_like_tests(tmp_path):
    files = {
        "package.xml": MANIFEST.format("test_rig"), "test_rig/__init__.py": "", "test_rig/drive.py": "",
        "test/__init__.py": "", "test/test_drive.py": "", "test_other/__init__.py": "", "test_other/drive.py": "",
    }  # fmt: skip
    for path, text in files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    tree = WorkingTree(tmp_path)
    wanted = make_code_selector(tree)
    assert {path for path in files if wanted(path)} == {"test_rig/__init__.py", "test_rig/drive.py"}
    with Store(tmp_path / ".cache") as store:
        assert set(list_code(link_for_flow(tree, store))) == {"test_rig/__init__.py", "test_rig/drive.py"}


def test_a_path_of_any_depth(tmp_path):
    (tmp_path / "package.xml").write_text(MANIFEST.format("deep"))
    wanted = make_code_selector(WorkingTree(tmp_path))
    assert wanted("a/" * 2000 + "a.cpp") == "flow_cpp"
