"""Generated workspaces, pruned: they build, and say what they said. The small form of benchmarks/prune_property.py."""

import importlib.util
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def load_benchmark():
    spec = importlib.util.spec_from_file_location("prune_property", ROOT / "benchmarks" / "prune_property.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def has_generators() -> bool:
    """Whether the Python of ROS 1 has its generators of messages."""
    try:
        return not subprocess.run(["/usr/bin/python3", "-c", "import genpy, gencpp"], check=False).returncode
    except OSError:
        return False


BENCHMARK = load_benchmark()
# Of these one declares its publishers together, and one has topics that share a lighter message.
CPP = (11, 12)
PYTHON = {1: "equal", 2: "equal", 3: "equal", 4: "refused", 6: "equal", 11: "equal"}
pytestmark = pytest.mark.skipif(not has_generators(), reason="the generators genpy and gencpp of ROS 1 are not there")


def judge(language: str, numbers: Sequence[int], root: Path, builder) -> list:
    """What becomes of workspaces: pruned one after another, built and run two at a time."""
    pruned = [BENCHMARK.prune_case(BENCHMARK.Case(each, language), root / str(each)) for each in numbers]
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(lambda one: BENCHMARK.compare_versions(one, builder), pruned))


def test_python(tmp_path):
    outcomes = judge("python", tuple(PYTHON), tmp_path, BENCHMARK.Builder(tmp_path))
    assert [(one.name, one.state, one.detail) for one in outcomes] == [
        (f"python{number}", state, "") for number, state in PYTHON.items()
    ]


@pytest.mark.skipif(not Path("/usr/include/ros/ros.h").exists(), reason="the headers of roscpp are not there")
def test_cpp(tmp_path):
    builder = BENCHMARK.Builder(tmp_path / "shared")
    builder.prepare_cpp()
    outcomes = judge("cpp", CPP, tmp_path, builder)
    assert [(one.name, one.state, one.detail) for one in outcomes] == [(f"cpp{number}", "equal", "") for number in CPP]
