"""Generated workspaces, pruned: they build, and say what they said. The small form of benchmarks/prune_property.py."""

import importlib.util
import subprocess
import sys
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
CPP = (0, 2, 4, 5)
pytestmark = pytest.mark.skipif(not has_generators(), reason="the generators genpy and gencpp of ROS 1 are not there")


def judge(language: str, number: int, root: Path, builder) -> object:
    return BENCHMARK.compare_versions(BENCHMARK.prune_case(BENCHMARK.Case(number, language), root), builder)


@pytest.mark.parametrize("number", range(12))
def test_python(number, tmp_path):
    outcome = judge("python", number, tmp_path, BENCHMARK.Builder(tmp_path))
    assert (outcome.state, outcome.detail) == ("equal" if outcome.pruned else "refused", "")
    assert bool(outcome.pruned) == (number != 11)


@pytest.mark.skipif(not Path("/usr/include/ros/ros.h").exists(), reason="the headers of roscpp are not there")
def test_cpp(tmp_path):
    builder = BENCHMARK.Builder(tmp_path / "shared")
    builder.prepare_cpp()
    outcomes = [judge("cpp", number, tmp_path / str(number), builder) for number in CPP]
    assert [(one.name, one.state, one.detail) for one in outcomes] == [(f"cpp{number}", "equal", "") for number in CPP]
